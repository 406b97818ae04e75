"""Steps beside bare MuJoCo: nothing due, a plugin after each, the IMU read, the whole world read.

python benchmarks/stepping.py [--world NAME] [--rounds N]
"""

from __future__ import annotations

from measure import arguments, report

from simkit.cli.bench_figures import compare_with_bare_mujoco
from simkit.run_spec import RunSpec


def main() -> None:
    args = arguments(__doc__, rounds=15)
    report(f for f in compare_with_bare_mujoco(RunSpec(args.world), rounds=args.rounds, what="steps"))


if __name__ == "__main__":
    main()
