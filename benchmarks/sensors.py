"""Whole samples: a scan beside raw `mj_multiRay`, a picture beside one raw colour-and-depth pass, the others alone.

python benchmarks/sensors.py [--world NAME] [--rounds N]
"""

from __future__ import annotations

from measure import arguments, report

from simkit.cli.bench_figures import compare_with_bare_mujoco
from simkit.run_spec import RunSpec


def main() -> None:
    args = arguments(__doc__, rounds=15)
    report(f for f in compare_with_bare_mujoco(RunSpec(args.world), rounds=args.rounds, what="sensors"))


if __name__ == "__main__":
    main()
