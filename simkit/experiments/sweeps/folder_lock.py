"""Folder of a sweep, and locks that allow one writer for each block of its rows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from simkit.errors import InputError


def make_folder(folder: Path) -> None:
    """Make the folder of a sweep.

    Raises:
        InputError: SK-CLI-016 the folder cannot be written to.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / ".lock").touch()
    except OSError as error:
        raise InputError(f"SK-CLI-016 cannot write to {folder}: {error.strerror or error}", "SK-CLI-016") from None


_locked: set[tuple[Path, int]] = set()
"""Folders and blocks that this process has locked; the system's locks only exclude other processes."""


@contextmanager
def locked_blocks(folder: Path, blocks: Sequence[int]) -> Iterator[None]:
    """Allow one writer at a time for each block of a sweep, however it is divided into parts.

    The system releases the locks of a killed process.

    Raises:
        InputError: SK-SWEEP-010 another process writes one of the blocks.
    """
    text = f"SK-SWEEP-010 another process runs the sweep in {folder}"
    busy = InputError(f"{text}, or a part of it\n    help: wait for its end, or name another folder", "SK-SWEEP-010")
    own = {(folder.resolve(), block) for block in blocks}
    if own & _locked:
        raise busy
    with (folder / ".lock").open("r+b") as file:
        try:
            import fcntl

            for block in blocks:  # one byte of the file for each block; closing the file releases them
                fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB, 1, block)
        except ImportError:
            pass
        except OSError:
            raise busy from None
        _locked.update(own)
        try:
            yield
        finally:
            _locked.difference_update(own)
