"""`import simkit` in a fresh interpreter, less an empty one, and runs of no duration beside `import mujoco`.

python benchmarks/import_time.py [--rounds N]

The runs are measured in turn, in CPU time of their processes, with all modules compiled to bytecode. Aims: below 0.3 s;
for an empty world at most 1.7 times the time of `import mujoco` (1.5 if simkit is installed from a wheel), and for the
world of TurtleBot3 2.0 times.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys

from measure import arguments

from simkit.cli.bench_figures import measure_import_time

AIMS = {"empty": 1.7, "turtlebot3_world": 2.0}
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
    runs = [("-m", "simkit", "run", world, "--duration", "0") for world in AIMS]
    for words in runs:
        cpu_time(words)
    rows = [[cpu_time(words) for words in (MUJOCO, *runs)] for _ in range(rounds)]
    mujoco, *times = (statistics.median(column) for column in zip(*rows, strict=True))
    print(f"import mujoco {mujoco:.2f} s")
    for (world, aim), run in zip(AIMS.items(), times, strict=True):
        print(f"simkit run {world} {run:.2f} s, ratio {run / mujoco:.2f}   aim <= {aim}")


if __name__ == "__main__":
    main()
