"""Sleep: resting boxes with and without it, alone and beside a robot; gz-sim's 3003 shapes awake, asleep, beside bare.

python benchmarks/sleeping.py [--rounds N]
"""

from __future__ import annotations

from measure import arguments

import simkit
from simkit.cli.bench_bare_mujoco import BareEngine
from simkit.cli.bench_figures import time_interleaved
from worlds import SHAPES, boxes

COUNT = 500


def resting_boxes(rounds: int, robot: bool) -> str:
    """One line: a step of `COUNT` boxes with and without sleep."""
    source = boxes(COUNT, robot)
    with simkit.load(source) as sleeper, simkit.load(source, sleep=False) as waker:
        for sim in (sleeper, waker):
            sim.run(1.0)
        steps = 20
        asleep, awake = time_interleaved([lambda: sleeper.step(steps), lambda: waker.step(steps)], rounds)
    who = f"{COUNT} resting boxes" + (" and a TurtleBot3" if robot else "")
    return (
        f"a step of {who}: asleep {asleep / steps * 1e6:.1f} us, awake {awake / steps * 1e6:.1f} us, "
        f"{awake / asleep:.0f} times   aim >= 15"
    )


def shapes(rounds: int) -> list[str]:
    """gz-sim's world: awake beside bare MuJoCo, and asleep."""
    steps = 10
    with simkit.load(SHAPES, sleep=False) as sim:
        sim.run(0.1)
        bare = BareEngine(sim)
        ours, theirs = time_interleaved([lambda: sim.step(steps), lambda: bare.step(steps)], rounds)
    lines = [
        f"3003 shapes awake: a step {ours / steps * 1e3:.2f} ms, bare {theirs / steps * 1e3:.2f} ms, "
        f"{theirs / ours:.3f} of bare stepping   aim >= 0.95"
    ]
    with simkit.load(SHAPES) as sim:
        sim.run(1.0)
        (second,) = time_interleaved([lambda: sim.run(10.0)], rounds)
    return [*lines, f"3003 shapes asleep: {10.0 / second:.0f} times real time   aim >= 100"]


def main() -> None:
    rounds = arguments(__doc__, rounds=9).rounds
    for robot in (False, True):
        print(resting_boxes(rounds, robot), flush=True)
    if SHAPES.is_file():
        for line in shapes(rounds):
            print(line, flush=True)
    else:
        print(f"{SHAPES.name} is not here")


if __name__ == "__main__":
    main()
