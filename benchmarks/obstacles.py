"""5000 static obstacles: a step of the world with them beside one of the world without. Aim: at most 2.

python benchmarks/obstacles.py [--rounds N]
"""

from __future__ import annotations

from measure import arguments

import simkit
from simkit.cli.bench_figures import time_interleaved
from worlds import obstacles

COUNT, STEPS = 5000, 200


def main() -> None:
    rounds = arguments(__doc__, rounds=15).rounds
    with simkit.load(obstacles(COUNT)) as full, simkit.load(obstacles(0)) as empty:
        for sim in (full, empty):
            sim.run(1.0)
            # nothing due: the plugins' and sensors' share is the same in both
            sim.engine.scheduler.clear()
            sim.engine.scheduler.rewind(sim.tick)
        many, none = time_interleaved([lambda: full.step(STEPS), lambda: empty.step(STEPS)], rounds)
    print(
        f"a step with {COUNT} static obstacles {many / STEPS * 1e6:.1f} us, without {none / STEPS * 1e6:.1f} us, "
        f"ratio {many / none:.2f}   aim <= 2"
    )


if __name__ == "__main__":
    main()
