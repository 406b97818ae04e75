"""A process ends with its children on every system, and a dead process is told from a living one."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from simkit.process_control import has_ended, kill_process_tree

FAMILY = """
import subprocess, sys, time
child = subprocess.Popen([sys.executable, "-c", "import sys; sys.stdin.read()"], stdin=subprocess.PIPE)
print(child.pid, flush=True)
time.sleep(600)
"""
# Windows' program of this name ends the children of a process, found by their parent's number, and then the process.
TASKKILL = """#!{python}
import os, signal, sys
from pathlib import Path
assert sys.argv[1:4] == ["/F", "/T", "/PID"], sys.argv
number = int(sys.argv[4])
for child in Path(f"/proc/{{number}}/task/{{number}}/children").read_text().split():
    os.kill(int(child), signal.SIGKILL)
os.kill(number, signal.SIGKILL)
"""


def family() -> tuple[subprocess.Popen[bytes], int]:
    """A process with a child that has inherited its output: the pipe closes when both have ended."""
    process = subprocess.Popen([sys.executable, "-c", FAMILY], stdout=subprocess.PIPE, start_new_session=True)
    assert process.stdout is not None
    return process, int(process.stdout.readline())


def wait_for_both(process: subprocess.Popen[bytes]) -> None:
    assert process.stdout is not None
    assert process.stdout.read() == b"", "the pipe closes when the child has ended too"
    process.stdout.close()
    process.wait()


def test_a_process_ends_with_its_child() -> None:
    process, _ = family()
    kill_process_tree(process)
    wait_for_both(process)
    kill_process_tree(process)  # a second call finds nobody


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="the stand-in for `taskkill` reads /proc")
def test_without_process_groups_taskkill_ends_the_child_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program = tmp_path / "taskkill"
    program.write_text(TASKKILL.format(python=sys.executable), encoding="utf-8")
    program.chmod(0o755)
    monkeypatch.delattr(os, "killpg")
    monkeypatch.setenv("PATH", str(tmp_path))
    process, _ = family()
    kill_process_tree(process)
    wait_for_both(process)


def test_without_taskkill_the_process_alone_is_killed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(os, "killpg")
    monkeypatch.setenv("PATH", str(tmp_path))
    process = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
    kill_process_tree(process)
    assert process.wait() != 0


def test_a_process_has_ended_only_after_its_end() -> None:
    process = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    assert not has_ended(process.pid)
    process.communicate(b"\n")
    assert has_ended(process.pid)
    assert not has_ended(os.getpid())


@pytest.mark.parametrize("number", [0, -1, 1 << 70])
def test_a_number_of_no_process_is_never_signalled(number: int) -> None:
    assert not has_ended(number)


FIRST_CHILD = """
import multiprocessing, signal
from simkit.process_control import without_interrupts
child = multiprocessing.get_context("spawn").Process(target=signal.raise_signal, args=(signal.SIGINT,))
with without_interrupts():
    child.start()
child.join()
raise SystemExit(child.exitcode)
"""


@pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="this system cannot block a signal")
def test_ctrl_c_reaches_no_child_process_not_even_the_first_one() -> None:
    ended = subprocess.run([sys.executable, "-c", FIRST_CHILD], capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (0, "")
