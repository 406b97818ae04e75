"""Memory over a long run: what an hour of simulated time adds with all sensors but the camera read.

python benchmarks/memory.py [--world NAME] [--rounds MINUTES]
"""

from __future__ import annotations

import tracemalloc

from measure import arguments

import simkit


def main() -> None:
    args = arguments(__doc__, rounds=60)
    with simkit.load(args.world) as sim:
        for topic in sim.topics():
            if not topic.startswith("/camera"):
                sim.subscribe(topic, keep=10)
        sim.run(10.0)
        tracemalloc.start()
        first, _ = tracemalloc.get_traced_memory()
        for minute in range(1, args.rounds + 1):
            sim.run(60.0)
            now, _ = tracemalloc.get_traced_memory()
            if minute in (1, args.rounds) or minute % 10 == 0:
                print(f"{minute:4d} min of simulated time: {(now - first) / 1e6:+8.3f} MB")


if __name__ == "__main__":
    main()
