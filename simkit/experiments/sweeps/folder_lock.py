"""Folder of a sweep, and locks that allow one writer for each block of its rows."""

from __future__ import annotations

import errno
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import IO, Final

from simkit.errors import InputError

_LOCKS: Final = "locks"
_BUSY: Final = (errno.EWOULDBLOCK, errno.EAGAIN, errno.EACCES)


def make_folder(folder: Path) -> None:
    """Make the folder of a sweep.

    Raises:
        InputError: SK-CLI-016 the folder cannot be written to.
    """
    try:
        (folder / _LOCKS).mkdir(parents=True, exist_ok=True)
        (folder / _LOCKS / "folder.lock").touch()
    except OSError as error:
        raise _not_writable(folder, error) from None


_locked: set[tuple[Path, int]] = set()
"""Folders and blocks that this process has locked, for systems without `flock`."""


@contextmanager
def locked_blocks(folder: Path, blocks: Sequence[int]) -> Iterator[None]:
    """Allow one writer at a time for each block of a sweep, however it is divided into parts.

    Each block has its own lock file, which stays in the folder. The system releases the locks of a killed process.

    Raises:
        InputError: SK-SWEEP-010 another process writes one of the blocks; SK-CLI-016 a lock file cannot be written.
    """
    text = f"SK-SWEEP-010 another process runs the sweep in {folder}"
    busy = InputError(f"{text}, or a part of it\n    help: wait for its end, or name another folder", "SK-SWEEP-010")
    own = {(folder.resolve(), block) for block in blocks}
    if own & _locked:
        raise busy
    with ExitStack() as files:
        for block in blocks:
            try:
                _lock(files.enter_context((folder / _LOCKS / f"{block:06d}.lock").open("ab")))
            except OSError as error:
                raise (busy if error.errno in _BUSY else _not_writable(folder, error)) from None
        _locked.update(own)
        try:
            yield
        finally:
            _locked.difference_update(own)


def _lock(file: IO[bytes]) -> None:
    """Lock a file until it is closed; do nothing on a system without `flock`.

    A lock of `lockf` would also end when any other part of this process closes the same file.
    """
    try:
        import fcntl
    except ImportError:
        return
    fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _not_writable(folder: Path, error: OSError) -> InputError:
    return InputError(f"SK-CLI-016 cannot write to {folder}: {error.strerror or error}", "SK-CLI-016")
