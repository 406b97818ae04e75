"""One writer at a time, on every system: with `flock`, and with the locked byte that Windows has instead."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

pytest.importorskip("fcntl", reason="the stand-in for Windows' locks needs the locks of POSIX")

# Locks of Windows by those of POSIX: both belong to a range of bytes, and refuse another process at once.
MSVCRT = """
import errno, fcntl, os
LK_UNLCK, LK_LOCK, LK_NBLCK = 0, 1, 2
def locking(handle, mode, count):
    assert os.lseek(handle, 0, os.SEEK_CUR) >= 1 << 31, "a locked byte of the content could not be read on Windows"
    try:
        fcntl.lockf(handle, fcntl.LOCK_UN if mode == LK_UNLCK else fcntl.LOCK_EX | fcntl.LOCK_NB, count, 0, os.SEEK_CUR)
    except BlockingIOError:
        raise PermissionError(errno.EACCES, "Permission denied") from None
"""
WINDOWS = """
import sys
sys.path.insert(0, {folder!r})
import msvcrt
sys.modules["fcntl"] = None
"""
PROGRAM = """
import os, sys
from pathlib import Path
from simkit import file_lock
path = Path(sys.argv[1])
file = path.open("a+b")
def told():
    return sys.stdin.readline().strip()
while (asked := told()):
    if asked == "try":
        print(file_lock.try_lock(file.fileno()), flush=True)
    elif asked == "wait":
        print("waits", flush=True)
        file_lock.wait_for_lock(file.fileno())
        print("has it", flush=True)
    elif asked == "look":
        print(file_lock.is_locked(file.fileno()), flush=True)
    elif asked == "same":
        print(file_lock.is_same_file(file.fileno(), path), flush=True)
    elif asked == "write":
        file.write(b"written")
        file.flush()
        print(path.read_bytes(), file.tell(), flush=True)
    elif asked == "remove":
        file_lock.remove_locked_file(file, path)
        print(path.exists(), flush=True)
"""


class Other:
    """A process with the file open that does what it is told."""

    def __init__(self, program: str, path: Path) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-c", program, str(path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def ask(self, text: str) -> str:
        assert self.process.stdin is not None
        self.process.stdin.write(text + "\n")
        self.process.stdin.flush()
        return self.line()

    def line(self) -> str:
        assert self.process.stdout is not None
        return self.process.stdout.readline().strip()

    def end(self) -> None:
        self.process.kill()
        self.process.wait()
        for pipe in (self.process.stdin, self.process.stdout):
            assert pipe is not None
            pipe.close()


@pytest.fixture(params=["flock", "byte"])
def other(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Callable[[], Other]]:
    (tmp_path / "msvcrt.py").write_text(MSVCRT, encoding="utf-8")
    first = WINDOWS.format(folder=str(tmp_path)) if request.param == "byte" else ""
    started: list[Other] = []

    def start() -> Other:
        started.append(Other(first + PROGRAM, tmp_path / "lock"))
        return started[-1]

    yield start
    for one in started:
        if one.process.poll() is None:
            one.end()


def test_only_one_process_has_the_lock_and_its_death_releases_it(other: Callable[[], Other]) -> None:
    first, second = other(), other()
    assert first.ask("try") == "True"
    assert second.ask("try") == "False"
    assert second.ask("look") == "True"
    first.end()
    assert second.ask("look") == "False"
    assert second.ask("try") == "True"


def test_a_process_that_waits_gets_the_lock_when_the_other_one_ends(other: Callable[[], Other]) -> None:
    first, second = other(), other()
    assert first.ask("try") == "True"
    assert second.ask("wait") == "waits"
    first.end()
    assert second.line() == "has it"


def test_a_look_takes_no_lock(other: Callable[[], Other]) -> None:
    first, second = other(), other()
    assert first.ask("look") == second.ask("look") == "False"
    assert first.ask("try") == "True"


def test_the_lock_leaves_content_and_position_of_the_file_alone(other: Callable[[], Other], tmp_path: Path) -> None:
    first = other()
    assert first.ask("try") == "True"
    assert first.ask("write") == "b'written' 7"
    assert (tmp_path / "lock").stat().st_size == 7


def test_a_removed_file_is_noticed_by_a_process_that_has_it_open(other: Callable[[], Other]) -> None:
    first, second = other(), other()
    assert first.ask("try") == "True"
    assert second.ask("same") == "True"
    assert first.ask("remove") == "False"
    assert second.ask("same") == "False"
