"""The scenes as numbers, and states at which they are evaluated."""

import math
import random
import re
from dataclasses import dataclass
from pathlib import Path

GRAVITY = 9.81
ROOT = Path(__file__).resolve().parents[2]


@dataclass
class Link:
    """A body on a hinge about an axis of its own frame, the frame at rest being `turn` and `place` in that of the link before."""

    axis: int
    turn: list
    place: list
    mass: float
    centre: list
    inertia: list


@dataclass
class Chain:
    """Hinged links in a row from a resting base; the state is all angles and then all rates."""

    name: str
    links: list
    damping: float

    @property
    def states(self):
        return 2 * len(self.links)

    @property
    def inputs(self):
        return len(self.links)


IDENTITY = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]


def rods(count):
    """Cylinders of 1 m and 1 kg, hinged about x and y in turn, one below the other."""
    across, along = 0.08395833333333334, 0.00125
    return Chain(
        f"chain{count}",
        [
            Link(
                axis=number % 2,
                turn=IDENTITY,
                place=[0.0, 0.0, -1.0 if number else 0.0],
                mass=1.0,
                centre=[0.0, 0.0, -0.5],
                inertia=[[across, 0.0, 0.0], [0.0, across, 0.0], [0.0, 0.0, along]],
            )
            for number in range(count)
        ],
        damping=0.1,
    )


def arm():
    """The 7-axis arm out of the file from which our model is included."""
    text = (ROOT / "examples/arm/panda.mbg").read_text()

    def numbers(pattern, of=text):
        found = re.search(pattern, of, re.S)
        return eval(found[1], {}) if found else None

    links = []
    for joint in range(1, 8):
        link = text[text.index(f"panda_link{joint}_body: Body") :]
        link = link[: link.index("}")]
        links.append(
            Link(
                axis=2,
                turn=numbers(rf"panda_joint{joint}_axes: Turn \{{\s*by: (.*?\]\])") or IDENTITY,
                place=numbers(rf"panda_joint{joint}_place: Offset \{{ by: (\[.*?\])") or [0.0] * 3,
                mass=numbers(r"mass: (.*?),\s*centre", link),
                centre=numbers(r"centre: (\[.*?\])", link),
                inertia=numbers(r"inertia: (\[\[.*?\]\])", link),
            )
        )
    return Chain("arm", links, damping=0.003)


# The four-bar: lengths, masses of crank, coupler and rocker.
BARS = {"lengths": [0.3, 0.9, 0.7], "masses": [1.0, 2.0, 1.5], "ground": 1.0, "damping": 0.01}

# The inertial navigation system.
INS = {"fuselage": [1e4, 1e4, 5e3], "drag": 1e3, "platform": 10.0, "stiffness": 1e-5, "damping": 1e-5}


def assembled(generator):
    """A state of the four-bar at which its loop is closed, and its torque."""
    crank, coupler, rocker = BARS["lengths"]
    angle = generator.uniform(-math.pi, math.pi)
    tip = [crank * math.cos(angle) - BARS["ground"], crank * math.sin(angle)]
    # From the rocker's pivot to the crank's tip, and the angle there by the law of cosines.
    far = math.hypot(*tip)
    inner = math.acos((rocker**2 + far**2 - coupler**2) / (2.0 * rocker * far))
    swing = math.atan2(tip[1], tip[0]) - inner
    end = [rocker * math.cos(swing) - tip[0], rocker * math.sin(swing) - tip[1]]
    along = math.atan2(end[1], end[0])
    rate = generator.uniform(-1.0, 1.0)
    # The tip's velocity, taken apart along those that coupler and rocker can give it.
    coupler_rate = -crank * rate * math.sin(angle - swing) / (coupler * math.sin(along - swing))
    rocker_rate = -crank * rate * math.sin(angle - along) / (rocker * math.sin(along - swing))
    state = [angle, along - angle, swing, rate, coupler_rate - rate, rocker_rate]
    return state + [generator.uniform(-1.0, 1.0)]


def samples(name, states, inputs, count):
    """Rows of a state and an input each, the same in every run."""
    generator = random.Random(f"benchmark {name}")
    if name == "fourbar":
        return [assembled(generator) for _ in range(count)]
    scales = [1.0] * (states + inputs)
    if name == "ins":
        scales = [1e3] * 3 + [10.0] * 3 + [0.5] * 3 + [100.0] * 3
    return [[generator.uniform(-scale, scale) for scale in scales] for _ in range(count)]
