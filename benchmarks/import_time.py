"""`import simkit` in a fresh interpreter, less an empty one. Aim: below 0.3 s.

python benchmarks/import_time.py
"""

from __future__ import annotations

from measure import arguments

from simkit.cli.bench_figures import measure_import_time


def main() -> None:
    print(f"import simkit {measure_import_time(arguments(__doc__, rounds=7).rounds):.3f} s   aim < 0.3 s")


if __name__ == "__main__":
    main()
