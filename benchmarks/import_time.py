"""`import simkit` in a fresh interpreter, beside an empty one. Aim: below 0.3 s.

python benchmarks/import_time.py
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import time
from pathlib import Path

from measure import arguments

ROOT = Path(__file__).resolve().parents[1]


def seconds(statement: str, rounds: int) -> float:
    """Median wall time of an interpreter that runs one statement and leaves [s]."""
    taken = []
    for _ in range(rounds):
        start = time.perf_counter()
        subprocess.run([sys.executable, "-c", statement], check=True, cwd=ROOT)
        taken.append(time.perf_counter() - start)
    return statistics.median(taken)


def main() -> None:
    rounds = arguments(__doc__, rounds=7).rounds
    empty, ours = seconds("pass", rounds), seconds("import simkit", rounds)
    print(f"import simkit {ours - empty:.3f} s   (interpreter alone {empty:.3f} s)   aim < 0.3 s")


if __name__ == "__main__":
    main()
