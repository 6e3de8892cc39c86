"""Prints robots as models, and writes states at which to compare them with Pinocchio.

usage: robots.py FOLDER MBG_URDF

FOLDER gets NAME.mbg, a model `Robot` whose base is held or flies; NAME.joints, what Pinocchio is built of; NAME.cases; and
models.rs, which includes all models. Damping, friction and joints that mimic others are taken out of the files first: Pinocchio's
forward dynamics leave them out.

NAME.cases begins with the names of the states, and with how many inputs, positions and rates there are. Each line after it
has a state, an input and the derivative expected; how the first two change, and how the derivative does then; then the
position, the rates and the torques for Pinocchio.
"""

import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from sysconfig import get_paths

import numpy as np
import pinocchio as pin

DATA = Path(get_paths()["purelib"]) / "cmeel.prefix/share/example-robot-data/robots"
# Bases that are held, and those that fly: files in the order of their sizes.
HELD = """
    double_pendulum_description/urdf/double_pendulum ur_description/urdf/ur5_robot z1_description/urdf/z1
    so_arm_description/urdf/so100 kinova_description/robots/kinova xarm_description/urdf/xarm7
    panda_description/urdf/panda baxter_description/urdf/baxter allegro_hand_description/urdf/allegro_right_hand
    pr2_description/urdf/pr2 tiago_pro_description/robots/tiago_pro tiago_description/robots/tiago_dual
"""
FLYING = """
    hextilt_description/urdf/hextilt_flying_arm_5 bolt_description/robots/bolt solo_description/robots/solo12
    a1_description/urdf/a1 go2_description/urdf/go2 hyq_description/robots/hyq_no_sensors
    anymal_b_simple_description/robots/anymal b1_description/urdf/b1-z1 anymal_b_simple_description/robots/anymal-kinova
    icub_description/robots/icub_reduced simple_humanoid_description/urdf/simple_humanoid
    g1_description/urdf/g1_29dof_rev_1_0 romeo_description/urdf/romeo_small talos_data/robots/talos_reduced
    human_description/robots/human centauro_description/urdf/centauro
"""
LEFT_OUT = ["dynamics", "mimic", "visual", "collision"]
CASES = 64
FLIGHT = """1 world[6];
    Sf held[6] { flow: 0.0 } -> world;
    float: Free { orientation: quaternion } (world, base);
"""


def stripped(source, target):
    """The file without what is no part of the comparison."""
    tree = ElementTree.parse(source)
    for owner in tree.getroot():
        for tag in LEFT_OUT:
            for node in owner.findall(tag):
                owner.remove(node)
    tree.write(target)


def printed(urdf, converter, flies):
    """The robot as a model."""
    command = [converter, "--model", "Robot", urdf]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    text = text.replace("pub model Robot", "#[derivative]\npub model Robot")
    # Its coordinates are states already.
    text = re.sub(r"\n    output .*", "", text)
    if flies:
        text = text.replace("Sf ground[6] { flow: 0.0 } -> base;", FLIGHT.strip())
        text = text.replace("effort: effort }", "effort: effort, gravity_base: float.gravity_b }")
    return text


def joints(model):
    """A line per joint, as `pinocchio.cpp` reads it."""
    for number in range(1, model.njoints):
        joint, placement, body = model.joints[number], model.jointPlacements[number], model.inertias[number]
        axis = getattr(joint.extract(), "axis", np.zeros(3))
        numbers = [*axis, *placement.rotation.ravel(), *placement.translation, body.mass, *body.lever, *body.inertia.ravel()]
        yield f"{model.parents[number]} {joint.shortname()} {' '.join(repr(float(it)) for it in numbers)}\n"


class Coordinates:
    """Where the joints of a printed robot stand in Pinocchio's vectors."""

    def __init__(self, model, text, flies):
        self.model, self.flies = model, flies
        names = re.findall(r"^/// \d+\. `(.*)`$", text, re.MULTILINE)
        self.joints = [model.joints[model.getJointId(name)] for name in names]
        row = re.search(r"let coordinates\[\d+\] = \[(.*)\];", text)[1]
        self.angles = [f"robot.{name}" for name in row.split(", ")]
        self.rates = [re.sub(r"\.\w+$", ".rate.f", name) for name in self.angles]

    def names(self):
        """The names of the states."""
        base = [f"float.rotation.quaternion.{i}" for i in range(4)] if self.flies else []
        moved = [f"float.{it}.f.{axis}" for it in ("velocity", "rotation.rate") for axis in "xyz"] if self.flies else []
        return [*base, *self.angles, *moved, *self.rates]

    def drawn(self, random):
        """A state, an input and their derivative; then what Pinocchio calls them."""
        model, count = self.model, len(self.joints)
        angles, rates, torques = random.uniform(-1.5, 1.5, count), random.uniform(-2, 2, count), random.uniform(-5, 5, count)
        q, v, tau = pin.neutral(model), np.zeros(model.nv), np.zeros(model.nv)
        if self.flies:
            turn = random.normal(size=4)
            q[3:7] = turn / np.linalg.norm(turn)
            v[:6] = random.uniform(-2, 2, 6)
        for joint, angle, rate, torque in zip(self.joints, angles, rates, torques):
            both = [np.cos(angle), np.sin(angle)] if joint.nq == 2 else [angle]
            q[joint.idx_q : joint.idx_q + joint.nq] = both
            v[joint.idx_v], tau[joint.idx_v] = rate, torque
        data = model.createData()
        pin.computeABADerivatives(model, data, q, v, tau)
        dq, dv, dtau = random.normal(size=(3, model.nv))
        dtau[: 6 * self.flies] = 0.0
        acceleration = data.ddq
        change = data.ddq_dq @ dq + data.ddq_dv @ dv + data.Minv @ dtau
        own = lambda vector: [vector[joint.idx_v] for joint in self.joints]
        state, derivative = [*angles, *rates], [*rates, *own(acceleration)]
        changed, expected = [*own(dq), *own(dv)], [*own(dv), *own(change)]
        if self.flies:
            base = self.base(q, v, acceleration, dq, dv, change)
            lists = zip([state, derivative, changed, expected], base)
            state, derivative, changed, expected = [[*moved[:4], *it[:count], *moved[4:], *it[count:]] for it, moved in lists]
        return [*state, *torques, *derivative, *changed, *own(dtau), *expected, *q, *v, *tau]

    def base(self, q, v, acceleration, dq, dv, change):
        """What flies in four vectors: quaternion, velocity in the world and spin; their rates; how both change."""
        quaternion, turn = pin.Quaternion(q[3:7]), pin.Quaternion(q[3:7]).toRotationMatrix()
        half = lambda a, spin: np.array([-a[1:] @ spin, *(a[0] * spin + np.cross(a[1:], spin))]) / 2
        orientation = np.array([quaternion.w, quaternion.x, quaternion.y, quaternion.z])
        turned = dq[3:6]
        (velocity, spin), (dvelocity, dspin) = np.split(v[:6], 2), np.split(dv[:6], 2)
        (push, spin_rate), (dpush, dspin_rate) = np.split(acceleration[:6], 2), np.split(change[:6], 2)
        push = push + np.cross(spin, velocity)
        dpush = dpush + np.cross(dspin, velocity) + np.cross(spin, dvelocity)
        dorientation = half(orientation, turned)
        return (
            [*orientation, *(turn @ velocity), *spin],
            [*half(orientation, spin), *(turn @ push), *spin_rate],
            [*dorientation, *(turn @ (np.cross(turned, velocity) + dvelocity)), *dspin],
            [*(half(dorientation, spin) + half(orientation, dspin)), *(turn @ (np.cross(turned, push) + dpush)), *dspin_rate],
        )


def main():
    folder, converter = Path(sys.argv[1]), sys.argv[2]
    folder.mkdir(parents=True, exist_ok=True)
    modules, calls = [], []
    for file, flies in [(file, False) for file in HELD.split()] + [(file, True) for file in FLYING.split()]:
        name = re.sub(r"\W", "_", file.rsplit("/", 1)[1])
        urdf = folder / f"{name}.urdf"
        stripped(DATA / f"{file}.urdf", urdf)
        text = printed(urdf, converter, flies)
        (folder / f"{name}.mbg").write_text(text)
        root = [pin.JointModelFreeFlyer()] if flies else []
        model = pin.buildModelFromUrdf(str(urdf), *root)
        (folder / f"{name}.joints").write_text("".join(joints(model)))
        coordinates, random = Coordinates(model, text, flies), np.random.default_rng(1)
        rows = [" ".join(repr(float(it)) for it in coordinates.drawn(random)) for _ in range(CASES)]
        head = [" ".join(coordinates.names()), f"{len(coordinates.joints)} {model.nq} {model.nv}"]
        (folder / f"{name}.cases").write_text("\n".join([*head, *rows]) + "\n")
        modules.append(f'mod {name} {{\n    mbg_runtime::mbg! {{ include "{folder}/{name}.mbg"; }}\n}}\n')
        robot = f"{name}::Robot::new({name}::RobotParameters::default())?"
        calls.append(f'    comparison.compare("{name}", &{robot}, Default::default())?;\n')
    head = "fn compare_all(comparison: &Comparison<'_>) -> Result<(), Box<dyn Error>> {\n"
    (folder / "models.rs").write_text("".join([*modules, head, *calls, "    Ok(())\n}\n"]))


if __name__ == "__main__":
    main()
