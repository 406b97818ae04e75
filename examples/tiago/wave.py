"""TIAGo waves and goes back to where its arm was: `python wave.py`.

The motion is one of its motion library's, `wave`; `simkit motion list tiago` tells the others. Before its first point
comes a slow way there, and a motion that would leave the limits or hit something is refused.
"""

from __future__ import annotations

import sys
from typing import Any, NamedTuple

import numpy as np
from moves import ARM, Vector, picture_of, positions_of, tiago_in, wait_for

import simkit

HOME = "home"
MOTION = "wave"


class Wave(NamedTuple):
    """What the arm did.

    Attributes:
        before, after: positions of its joints [rad], shape (7,): at home, and home again.
        times: [s], shape (n,).
        positions: while it waved [rad], shape (n, 7).
        results: of the three motions.
    """

    before: Vector
    after: Vector
    times: Vector
    positions: Vector
    results: list[Any]


def play(sim: simkit.Simulation, motion: str, timeout: float = 60.0) -> Any:
    """Plays a motion by its name and runs until it has ended; the goal."""
    return wait_for(sim, sim.send_goal("/play_motion2", {"motion_name": motion}), timeout)


def run(seed: int = 0) -> Wave:
    with tiago_in("empty", seed=seed) as sim:
        home = play(sim, HOME)
        sim.run(1.0)
        before = positions_of(sim, ARM)
        states = sim.subscribe("/joint_states", keep=10_000)
        waved = play(sim, MOTION)
        rows = [(m.header.stamp.sec + m.header.stamp.nanosec * 1e-9, arm_of(m)) for m in states.messages]
        back = play(sim, HOME)
        sim.run(1.0)
        times, positions = (np.array(column) for column in zip(*rows, strict=True))
        results = [goal.result for goal in (home, waved, back)]
        return Wave(before, positions_of(sim, ARM), times, positions, results)


def arm_of(message: Any) -> Vector:
    by_name = dict(zip(message.name, message.position, strict=True))
    return np.array([by_name[name] for name in ARM])


def main(arguments: list[str]) -> None:
    picture_of(__doc__ or "", arguments, draws=False)
    wave = run()
    swing = np.ptp(wave.positions[len(wave.positions) // 2 :, 3])
    print(f"arm_4 swung by {swing:.2f} rad; the arm is back within {np.abs(wave.after - wave.before).max():.4f} rad")


if __name__ == "__main__":
    main(sys.argv[1:])
