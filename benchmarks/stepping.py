"""Stepping beside bare MuJoCo on the same compiled model: nothing due, and one Python plugin at every step.

python benchmarks/stepping.py [--world NAME] [--rounds N]
"""

from __future__ import annotations

from typing import Any

import mujoco
from measure import arguments, median_times, report

import simkit

STEPS = 2000


class EveryStep(simkit.WorldPlugin):
    """The least that a plugin can do: it is called after every step."""

    def load(self, parent: Any, params: simkit.Params) -> None:
        self.calls = 0

    def after_step(self) -> None:
        self.calls += 1


def compare(title: str, sim: simkit.Simulation, rounds: int, limit: float) -> None:
    model = sim.mj_model
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = sim.mj_data.qpos, sim.mj_data.qvel
    sides = {"ours": lambda: sim.step(STEPS), "bare": lambda: mujoco.mj_step(model, data, STEPS)}
    times = median_times(sides, rounds)
    report(title, times["ours"] / STEPS, times["bare"] / STEPS, limit)


def main() -> None:
    args = arguments(__doc__, rounds=9)
    with simkit.load(args.world) as sim:
        sim.run(1.0)
        compare("one step, nobody listens", sim, args.rounds, 1.05)
    with simkit.load(args.world, plugins=[EveryStep()]) as sim:
        sim.run(1.0)
        compare("one step, a plugin after each", sim, args.rounds, 1.20)


if __name__ == "__main__":
    main()
