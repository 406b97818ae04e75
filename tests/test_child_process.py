"""A program in a process apart has a limit, keeps few words, and leaves nothing behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from simkit.child_process import ChildProcesses

ROOT = Path(__file__).resolve().parents[1]
HEAD = (
    "import os, subprocess, sys, time\nfrom simkit.child_process import exit_immediately, exit_with_parent\n"
    "exit_with_parent()\n"
)
SLEEPER = "print(subprocess.Popen(['sleep', '60']).pid, flush=True)\n"


def ended(folder: Path, body: str, **how: float):
    (folder / "part.py").write_text(HEAD + body)
    path = os.pathsep.join([str(folder), str(ROOT)])
    return ChildProcesses().run("part", [], environment={**os.environ, "PYTHONPATH": path}, **how)


def is_gone(pid: int) -> bool:
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        try:
            state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
        except FileNotFoundError:
            return True
        if state == "Z":
            return True
        time.sleep(0.01)
    return False


def test_the_last_lines_of_a_long_output_are_stored_and_the_process_does_not_block(tmp_path: Path) -> None:
    found = ended(tmp_path, "print('x' * 5_000_000)\nprint('last', sys.stdin.read())\nsys.exit(3)")
    assert found.code == 3 and found.last_lines(1) == ["last "] and len(found.output) <= 1 << 16


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="processes are looked at in /proc")
@pytest.mark.parametrize("body", ["time.sleep(60)", "exit_immediately(0)"], ids=["at its limit", "at its end"])
def test_processes_of_the_child_end_with_the_child(body: str, tmp_path: Path) -> None:
    is_limited = "60" in body
    for limit in (1.0, 4.0, 16.0) if is_limited else (60.0,):
        found = ended(tmp_path, SLEEPER + body, limit=limit)
        if found.output:  # a busy machine may need more than a second to start the child and its process
            break
    assert found.is_late == is_limited
    assert is_gone(int(found.output.split()[0]))


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="processes are looked at in /proc")
@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT, signal.SIGTERM])
def test_a_child_ends_with_its_parent_for_any_reason(how: signal.Signals, tmp_path: Path) -> None:
    file = tmp_path / "pid"
    (tmp_path / "part.py").write_text(
        f"{HEAD}open({str(file) + '.part'!r}, 'w').write(str(os.getpid()))\n"
        f"os.rename({str(file) + '.part'!r}, {str(file)!r})\ntime.sleep(60)"
    )
    script = "import signal\nsignal.signal(signal.SIGINT, signal.default_int_handler)\n"
    script += "from simkit.child_process import ChildProcesses\nChildProcesses().run('part', [])"
    path = os.pathsep.join([str(tmp_path), str(ROOT)])
    parent = subprocess.Popen([sys.executable, "-c", script], env={**os.environ, "PYTHONPATH": path}, stderr=-3)
    while not file.exists():
        assert parent.poll() is None
        time.sleep(0.01)
    parent.send_signal(how)
    parent.wait()
    assert is_gone(int(file.read_text()))
