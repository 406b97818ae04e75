"""Folder of a sweep, and locks that allow one writer for each block of its rows."""

from __future__ import annotations

import errno
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Final

from simkit import file_lock
from simkit.errors import InputError
from simkit.output_file import open_regular

_LOCKS: Final = "locks"


def make_folder(folder: Path) -> None:
    """Make the folder of a sweep.

    Raises:
        InputError: SK-CLI-016 the folder cannot be written to.
    """
    try:
        for name in (_LOCKS, "rows", "timings"):  # a link in the folder would lead the rows to another folder
            if (folder / name).is_symlink():
                raise OSError(errno.ELOOP, "it is a symbolic link", str(folder / name))
        (folder / _LOCKS).mkdir(parents=True, exist_ok=True)
        open_regular(folder / _LOCKS / "folder.lock").close()
    except OSError as error:
        raise _not_writable(folder, error) from None


@contextmanager
def locked_blocks(folder: Path, blocks: Sequence[int]) -> Iterator[None]:
    """Allow one writer at a time for each block of a sweep, however it is divided into parts.

    Each block has its own lock file, which stays in the folder. The system releases the locks of a killed process.

    Raises:
        InputError: SK-SWEEP-010 another process writes one of the blocks; SK-CLI-016 a lock file cannot be written.
    """
    text = f"SK-SWEEP-010 another process runs the sweep in {folder}"
    busy = InputError(f"{text}, or a part of it\n    help: wait for its end, or name another folder", "SK-SWEEP-010")
    with ExitStack() as files:
        for block in blocks:
            try:
                file = files.enter_context(open_regular(folder / _LOCKS / f"{block:06d}.lock"))
                is_free = file_lock.try_lock(file.fileno())
            except OSError as error:
                raise _not_writable(folder, error) from None
            if not is_free:
                raise busy
        yield


def _not_writable(folder: Path, error: OSError) -> InputError:
    place = error.filename or folder
    return InputError(f"SK-CLI-016 cannot write to {place}: {error.strerror or error}", "SK-CLI-016")
