"""Files that simkit writes: locks and logs are regular files, and nothing waits for a pipe without end."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

from simkit import output_file
from simkit.bridges.live.socket_files import _lock_folder
from simkit.errors import InputError
from simkit.output_file import open_regular, open_target
from simkit.testing.golden.store import _locked_file
from simkit.writers.atomic_output import write_atomically
from simkit_fuel.cache_entry import exclusive_file

pytestmark = pytest.mark.skipif(os.name == "nt", reason="named pipes of POSIX")
Make = Callable[[Path], object]


def device(path: Path) -> None:
    path.symlink_to("/dev/null")


def link(path: Path) -> None:
    (path.parent / "target").write_bytes(b"kept")
    path.symlink_to(path.parent / "target")


KINDS: dict[str, tuple[Make, str]] = {
    "pipe": (os.mkfifo, "it is a pipe"),
    "folder": (Path.mkdir, "it is a folder"),
    "link": (link, "it is a symbolic link"),
    "link to a device": (device, "it is a symbolic link"),
    "link to nowhere": (lambda path: path.symlink_to(path.parent / "new"), "it is a symbolic link"),
}


@pytest.mark.parametrize("kind", KINDS)
def test_only_a_regular_file_is_opened_as_a_lock_or_log(tmp_path: Path, kind: str) -> None:
    KINDS[kind][0](tmp_path / "x")
    with pytest.raises(OSError) as raised:
        open_regular(tmp_path / "x")
    assert raised.value.strerror is not None and KINDS[kind][1] in raised.value.strerror
    assert not (tmp_path / "new").exists()


def test_a_regular_file_is_appended_to(tmp_path: Path) -> None:
    for text in (b"a", b"b"):
        with open_regular(tmp_path / "x") as file:
            file.write(text)
    assert (tmp_path / "x").read_bytes() == b"ab"


@pytest.mark.parametrize("kind", KINDS)
def test_all_other_locks_are_regular_files(tmp_path: Path, kind: str) -> None:
    opened: dict[str, Callable[[Path], object]] = {
        "golden": lambda path: _locked_file(path).__enter__(),
        "fetch": lambda path: exclusive_file(path).__enter__(),
        "sockets": lambda path: _lock_folder(path.parent).__enter__(),
    }
    for name, opening in opened.items():
        folder = tmp_path / name
        folder.mkdir()
        KINDS[kind][0](folder / ".lock")
        with pytest.raises(OSError, match=KINDS[kind][1]):
            opening(folder / ".lock")


def test_a_pipe_without_a_reader_is_an_error_and_not_an_endless_wait(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(output_file, "PIPE_TIMEOUT", 0.2)
    os.mkfifo(tmp_path / "p")
    with pytest.raises(InputError, match=r"SK-CLI-016 .*nothing reads the pipe for 0\.2 s"):
        write_atomically(tmp_path / "p", b"x")
    with pytest.raises(OSError, match="nothing reads the pipe"):
        open_target(tmp_path / "p", overwrite=True)
    with pytest.raises(FileExistsError):
        open_target(tmp_path / "p")


def test_the_reader_of_a_pipe_gets_everything(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "p")
    got: list[bytes] = []
    reader = threading.Thread(target=lambda: got.append((tmp_path / "p").read_bytes()))
    reader.start()
    write_atomically(tmp_path / "p", bytes(1_000_000))
    reader.join()
    assert got == [bytes(1_000_000)]


@pytest.mark.slow
def test_a_recording_to_a_pipe_without_a_reader_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "w.sdf").write_text('<sdf version="1.9"><world name="w"/></sdf>')
    os.mkfifo(tmp_path / "p.mcap")
    result = subprocess.run(
        [sys.executable, "-m", "simkit", "run", "w.sdf", "--duration", "0.01", "--record", "p.mcap", "--force"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=100,
        check=False,
    )
    assert result.returncode == 2 and "SK-BAG-002 cannot write p.mcap: nothing reads the pipe" in result.stderr


def test_where_a_stranger_may_have_made_the_folder_a_link_is_replaced(tmp_path: Path) -> None:
    (tmp_path / "kept").write_bytes(b"kept")
    (tmp_path / "x").symlink_to(tmp_path / "kept")
    write_atomically(tmp_path / "x", b"new", follow_link=False)
    assert (tmp_path / "kept").read_bytes() == b"kept" and not (tmp_path / "x").is_symlink()
