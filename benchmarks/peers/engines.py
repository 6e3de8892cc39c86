"""Builds the chains and the arm in Pinocchio and MuJoCo.

usage: engines.py FOLDER CXX MARCH…

Appends lines to `manifest` in FOLDER, whose form `generate.py` tells. Neither engine counts its operations.
"""

import subprocess
import sys
from pathlib import Path
from sysconfig import get_paths

import mujoco
import numpy as np

import scenes

PACKAGES = Path(get_paths()["purelib"])
CHAINS = [scenes.rods(8), scenes.rods(16), scenes.rods(64), scenes.arm()]


def header():
    """The links of all chains as C."""
    flat = lambda rows: "{" + ", ".join(repr(float(x)) for x in np.ravel(rows)) + "}"
    text = "struct Link { int axis; double turn[9], place[3], mass, centre[3], inertia[9]; };\n"
    for chain in CHAINS:
        rows = [
            f"    {{{l.axis}, {flat(l.turn)}, {flat(l.place)}, {l.mass!r}, {flat(l.centre)}, {flat(l.inertia)}}},\n"
            for l in chain.links
        ]
        text += f"inline constexpr double {chain.name}_damping = {chain.damping!r};\n"
        text += f"inline constexpr Link {chain.name}[] = {{\n{''.join(rows)}}};\n"
    return text


def compiled(chain):
    """The chain as a model of MuJoCo, without anything that touches."""
    spec = mujoco.MjSpec()
    spec.option.gravity = [0.0, 0.0, -scenes.GRAVITY]
    spec.compiler.boundinertia = 0.0
    body = spec.worldbody
    for number, link in enumerate(chain.links):
        turn = np.zeros(4)
        mujoco.mju_mat2Quat(turn, np.ravel(link.turn))
        body = body.add_body(name=f"link{number}", pos=link.place, quat=turn)
        # The numbers proper are put in below, since the compiler rejects inertias that are none of a real body.
        body.mass, body.ipos, body.inertia, body.explicitinertial = link.mass, link.centre, [1.0] * 3, True
        axis = [float(i == link.axis) for i in range(3)]
        body.add_joint(type=mujoco.mjtJoint.mjJNT_HINGE, axis=axis, damping=[chain.damping, 0.0, 0.0])
    model = spec.compile()
    for number, link in enumerate(chain.links, 1):
        moments, axes = np.linalg.eigh(link.inertia)
        axes[:, 2] *= np.linalg.det(axes)
        model.body_inertia[number] = moments
        mujoco.mju_mat2Quat(model.body_iquat[number], np.ravel(axes))
        # Says that the frames of the body and of its inertia differ.
        model.body_sameframe[number] = 0
        model.body_simple[number] = 0
    return model


def main():
    folder, compiler, targets = Path(sys.argv[1]), sys.argv[2], sys.argv[3:]
    (folder / "links.h").write_text(header())
    for chain in CHAINS:
        mujoco.mj_saveModel(compiled(chain), str(folder / f"{chain.name}.mjb"))
    here = Path(__file__).parent
    flags = [compiler, "-std=c++20", "-O3", "-DNDEBUG", "-ffp-contract=fast", "-fPIC", "-shared", "-w"]
    prefix, engine = PACKAGES / "cmeel.prefix", PACKAGES / "mujoco"
    library = next(engine.glob("libmujoco.so*"))
    limits = ["LIST_SIZE=30", "VECTOR_SIZE=30"]
    commands = {
        "pinocchio": [f"-DBOOST_MPL_LIMIT_{limit}" for limit in limits]
        + ["-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS", "-DBOOST_FUSION_INVOKE_MAX_ARITY=12", "-I/usr/include/eigen3"]
        + ["-I", prefix / "include", "-I", folder, here / "pinocchio.cpp"],
        "mujoco": [f'-DMODELS="{folder.resolve()}"', "-I", engine / "include", here / "mujoco.cpp"]
        + [library, f"-Wl,-rpath,{engine}"],
    }
    lines = []
    for engine, rest in commands.items():
        library = f"{engine}.so"
        for target in targets:
            (folder / target).mkdir(exist_ok=True)
            subprocess.run([*flags, f"-march={target}", *rest, "-o", folder / target / library], check=True)
        for chain in CHAINS:
            ways = [("MuJoCo", "value", "forward")]
            if engine == "pinocchio":
                ways = [("Pinocchio", "value", way) for way in ("local", "world")]
                if chain.name == "arm":
                    ways.append(("Pinocchio", "jacobian", "derivatives"))
            for name, kind, way in ways:
                symbol = f"{engine}_{chain.name}_{kind}_{way}"
                lines.append(f"{chain.name} {kind} {name} {way} {library} {symbol} -\n")
    with (folder / "manifest").open("a") as manifest:
        manifest.writelines(lines)


if __name__ == "__main__":
    main()
