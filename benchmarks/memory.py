"""Memory: what an hour of simulated time adds to the process, with all but images read; by default from a minute.

python benchmarks/memory.py [--world NAME] [--full]
"""

from __future__ import annotations

from measure import arguments

import simkit
from simkit.cli.bench_figures import measure_memory_growth


def main() -> None:
    args = arguments(__doc__, rounds=1)
    with simkit.load(args.world) as sim:
        growth = measure_memory_growth(sim, 3600.0 if args.full else 60.0)
    print(f"{growth * 3600 / 1e6:+.2f} MB a simulated hour")


if __name__ == "__main__":
    main()
