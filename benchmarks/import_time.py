"""`import simkit` in a fresh interpreter, less an empty one, and a run of an empty world beside `import mujoco`.

python benchmarks/import_time.py [--rounds N]

The run is measured in CPU time of its process, with all modules compiled to bytecode. Aims: below 0.3 s, at most 2.5.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys

from measure import arguments

from simkit.cli.bench_figures import measure_import_time

RUN = ("-m", "simkit", "run", "empty", "--duration", "0.001")
MUJOCO = ("-c", "import mujoco")


def cpu_time(words: tuple[str, ...]) -> float:
    """CPU time [s] of a Python process, with the processes that it starts."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    before = os.times()
    subprocess.run([sys.executable, *words], check=True, env=environment, capture_output=True)
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system


def main() -> None:
    rounds = arguments(__doc__, rounds=11).rounds
    print(f"import simkit {measure_import_time(rounds):.3f} s   aim < 0.3 s")
    cpu_time(RUN)
    rows = [(cpu_time(RUN), cpu_time(MUJOCO)) for _ in range(rounds)]
    run, mujoco = (statistics.median(column) for column in zip(*rows, strict=True))
    print(f"simkit run empty {run:.2f} s, import mujoco {mujoco:.2f} s, ratio {run / mujoco:.2f}   aim <= 2.5")


if __name__ == "__main__":
    main()
