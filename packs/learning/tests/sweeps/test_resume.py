"""A sweep that is killed continues where it was: nothing runs twice, and nothing is lost."""

from __future__ import annotations

import faulthandler
import os
import signal
import subprocess
import sys
from collections import Counter
from contextlib import suppress
from pathlib import Path

import pytest
from sweep_worlds import BOX

HERE = Path(__file__).parent
SWEEP = """
world: box.sdf
duration: 0.01
set: ["world.gravity=0 0 {g}"]
parameters: {g: {uniform: [-5, -1]}}
seeds: COUNT
metrics: {z: pose('box').z, counted: {python: 'sweep_worlds.py:counted_height'}}
"""


def prepare(folder: Path, count: int) -> None:
    (folder / "box.sdf").write_text(BOX, encoding="utf-8")
    (folder / "sweep_worlds.py").write_bytes((HERE / "sweep_worlds.py").read_bytes())
    (folder / "sweep.yaml").write_text(SWEEP.replace("COUNT", str(count)), encoding="utf-8")


def start(folder: Path, output: str, jobs: int, kill_size: int = sys.maxsize) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "simkit", "sweep", "sweep.yaml", "-o", output, "--allow-code", "--jobs", str(jobs)]
    environment = {
        **os.environ,
        "SWEEP_TEST_LOG": str(folder / f"{output}.log"),
        "SWEEP_TEST_KILL_SIZE": str(kill_size),
        "PYTHONPATH": os.pathsep.join(sys.path),
    }
    return subprocess.Popen(command, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def finished_rows(folder: Path) -> int:
    """Return the number of stored rows; a log and its ordered copy may exist at the same time, or be replaced."""
    found: set[bytes] = set()
    for path in (folder / "rows").glob("0*"):
        with suppress(FileNotFoundError):
            found.update(line for line in path.read_bytes().splitlines(keepends=True) if line.endswith(b"\n"))
    return len(found)


def check_killed_sweep(folder: Path, count: int, kills: int) -> None:
    prepare(folder, count)
    whole = start(folder, "whole", 2)
    output, _ = whole.communicate()
    assert whole.returncode == 0, output
    for kill in range(kills):
        whole_log = (
            (folder / "whole.log").stat().st_size
        )  # the number of runs that are begun decides the time of the kill
        process = start(folder, "killed", 1 + kill % 2, (kill + 1) * whole_log // (kills + 2))
        process.communicate()
        assert process.returncode == -signal.SIGKILL
        assert finished_rows(folder / "killed") < count
    stored = finished_rows(folder / "killed")
    last = start(folder, "killed", 2)
    output, _ = last.communicate()
    assert last.returncode == 0 and b"of them before" in output, output
    assert (folder / "killed" / "results.csv").read_bytes() == (folder / "whole" / "results.csv").read_bytes()
    assert (folder / "killed" / "results.parquet").read_bytes() == (folder / "whole" / "results.parquet").read_bytes()
    # a run whose row was not stored when the process was killed runs again, a stored one never
    made = Counter((folder / "killed.log").read_text().split())
    assert len(made) == count and stored < count
    repeated = sum(number - 1 for number in made.values())
    assert repeated <= kills * 2 * 64, repeated


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="it needs SIGKILL")
def test_a_sweep_that_is_killed_equals_an_uninterrupted_one(tmp_path: Path) -> None:
    check_killed_sweep(tmp_path, 150, 1)


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="it needs SIGKILL")
def test_a_sweep_of_10000_runs_that_is_killed_five_times_equals_an_uninterrupted_one(tmp_path: Path) -> None:
    # 20,000 runs and 7 starts of a sweep take 40 s of processor time; the limit of all tests, 300 s, is short for a
    # slow machine that does other work too. pytest removes this limit after the test.
    faulthandler.dump_traceback_later(1500, exit=True)
    check_killed_sweep(tmp_path, 10_000, 5)
