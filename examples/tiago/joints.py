"""Torso, head and gripper each by itself, then the arm one joint at a time: `python joints.py`."""

from __future__ import annotations

import sys
from typing import Any, NamedTuple

from moves import ARM, FINGERS, Vector, move, picture_of, positions_of, tiago_in

TORSO, HEAD = ("torso_lift_joint",), ("head_1_joint", "head_2_joint")
EVERY = (*TORSO, *HEAD, *ARM, *FINGERS)
MOVES: tuple[tuple[str, dict[str, float], float], ...] = (
    ("torso", {"torso_lift_joint": 0.25}, 5.0),
    ("head", {"head_1_joint": 0.6}, 2.0),
    ("head", {"head_2_joint": -0.5}, 2.0),
    ("gripper", dict.fromkeys(FINGERS, 0.04), 2.0),
    ("gripper", dict.fromkeys(FINGERS, 0.01), 2.0),
    ("arm", {"arm_1_joint": 1.0}, 3.0),
    ("arm", {"arm_2_joint": -0.6}, 3.0),
    ("arm", {"arm_3_joint": -1.0}, 3.0),
    ("arm", {"arm_4_joint": 1.2}, 3.0),
    ("arm", {"arm_5_joint": 0.8}, 3.0),
    ("arm", {"arm_6_joint": -0.5}, 3.0),
    ("arm", {"arm_7_joint": 1.0}, 3.0),
)


class Moved(NamedTuple):
    """One move and what came of it.

    Attributes:
        wanted: position [rad or m] by joint.
        result: of the action.
        before, after: positions of `EVERY` joint [rad or m].
    """

    wanted: dict[str, float]
    result: Any
    before: Vector
    after: Vector


def run(seed: int = 0) -> list[Moved]:
    done = []
    with tiago_in("empty", seed=seed) as sim:
        sim.run(1.0)
        for controller, wanted, seconds in MOVES:
            before = positions_of(sim, EVERY)
            goal = move(sim, controller, wanted, seconds)
            sim.run(0.5)
            done.append(Moved(wanted, goal.result, before, positions_of(sim, EVERY)))
    return done


def main(arguments: list[str]) -> None:
    picture_of(__doc__ or "", arguments, draws=False)
    for moved in run():
        for name, wanted in moved.wanted.items():
            index = EVERY.index(name)
            print(f"{name:28s} {moved.before[index]:+.4f} -> {moved.after[index]:+.4f}, wanted {wanted:+.4f}")


if __name__ == "__main__":
    main(sys.argv[1:])
