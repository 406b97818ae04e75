"""Files that a launch file causes to be written for its run, such as parameters with substitutions."""

from __future__ import annotations

import hashlib
import os
import tempfile
from functools import cache
from pathlib import Path

_WRITABLE_BY_OTHERS = 0o022
_CLOCK_ERROR = 0.05  # [s] of the times of files


@cache
def folder_of_written_files() -> Path:
    """Return the folder of the files that are written for runs: the same in all runs of a user.

    It is another one in each process if another user could change the files in the usual one.
    """
    user = getattr(os, "getuid", int)()
    folder = Path(tempfile.gettempdir()) / f"simkit_launch_{user}"
    folder.mkdir(mode=0o700, exist_ok=True)
    state = folder.lstat()
    if os.name == "posix" and (state.st_uid != user or state.st_mode & _WRITABLE_BY_OTHERS or folder.is_symlink()):
        return Path(tempfile.mkdtemp(prefix="simkit_launch_"))
    return folder


def write_run_file(name: str, suffix: str, text: str) -> Path:
    """Write a file for a run; the same text has the same path, so that runs can be compared.

    Args:
        name: first part of the name.
        suffix: suffix, such as `.yaml`.
        text: content.
    """
    digest = hashlib.sha256(text.encode()).hexdigest()[:16]
    return write_shared_file(folder_of_written_files() / f"{name}_{digest}{suffix}", text)


def write_shared_file(path: Path, text: str, mode: int = 0o600) -> Path:
    """Write a file that other processes may write at the same time, unless it has the text; return its path.

    Args:
        path: file.
        text: content.
        mode: permissions.
    """
    if not path.is_file() or path.read_text(encoding="utf-8") != text:
        path.parent.mkdir(mode=0o700, exist_ok=True)
        own = path.with_name(f".{path.name}.{os.getpid()}")
        own.write_text(text, encoding="utf-8")
        own.chmod(mode)
        own.replace(path)
    return path


def run_file_of(file: Path, since: float) -> Path:
    """Return a copy for the run of a temporary file, whose name differs in each run; any other file as it is.

    A launch file in Python often writes a file of parameters with `tempfile`. The copy has the same path in all runs
    with the same content.

    Args:
        file: file.
        since: wall time of the begin of the launch file [s]; older files are not temporary.
    """
    folder = Path(tempfile.gettempdir())
    if file.parent != folder or not file.is_file() or file.stat().st_mtime < since - _CLOCK_ERROR:
        return file
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return file
    return write_run_file("temporary", file.suffix if "_" not in file.suffix else "", text)
