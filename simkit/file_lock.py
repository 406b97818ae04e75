"""Locks of open files between processes, on every system.

A lock belongs to the open file. The system releases it when the file is closed, also when its process is killed. POSIX
systems lock with `flock`. Windows has no `flock`; there, a byte far behind the content is locked, because Windows
prevents other processes from reading a locked byte.
"""

from __future__ import annotations

import errno
import os
import time
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import IO, Any, Final

fcntl: Any
try:
    fcntl = import_module("fcntl")
except ImportError:  # Windows
    fcntl = None

_LOCKED_BYTE: Final = 1 << 40  # position of the byte that Windows locks; no lock file is that long
_WAIT: Final = 0.05  # [s] between two attempts on Windows, whose own waiting lock gives up after ten seconds
_PROBES: Final = 3
_BUSY: Final = (errno.EWOULDBLOCK, errno.EAGAIN, errno.EACCES, errno.EDEADLK)


def try_lock(handle: int) -> bool:
    """Lock an open file; return False if another open file has the lock.

    Args:
        handle: file descriptor of a file that is open for writing. On POSIX systems it may also be a folder.

    Raises:
        OSError: the file system has no locks.
    """
    return _lock_byte(handle) if fcntl is None else _flock(handle, fcntl.LOCK_EX)


def wait_for_lock(handle: int) -> None:
    """Lock an open file, and wait while another open file has the lock.

    Raises:
        OSError: the file system has no locks.
    """
    if fcntl is not None:
        fcntl.flock(handle, fcntl.LOCK_EX)
        return
    while not _lock_byte(handle):
        time.sleep(_WAIT)


def is_locked(handle: int) -> bool:
    """Check whether another open file has the lock of the same file.

    Two programs that check at the same time do not find each other: POSIX systems check with a shared lock. Windows has
    no shared lock for this, so there the check is repeated.

    Raises:
        OSError: the file system has no locks.
    """
    if fcntl is not None:
        if not _flock(handle, fcntl.LOCK_SH):
            return True
        fcntl.flock(handle, fcntl.LOCK_UN)
        return False
    for _ in range(_PROBES):
        if _lock_byte(handle):
            _apply_to_byte(handle, "LK_UNLCK")
            return False
        time.sleep(_WAIT)
    return True


def is_same_file(handle: int, path: Path) -> bool:
    """Check whether an open file is still the file at a path; another process may have removed or replaced it."""
    try:
        return os.path.samestat(os.fstat(handle), path.stat())
    except FileNotFoundError:
        return False


def remove_locked_file(file: IO[bytes], path: Path) -> None:
    """Remove a file while its lock is held. Windows removes no open file, so it is emptied, closed and then removed."""
    try:
        path.unlink(missing_ok=True)
    except OSError:
        with suppress(OSError):
            file.truncate(0)
        file.close()
        with suppress(OSError):  # another process has opened it meanwhile
            path.unlink(missing_ok=True)


def _flock(handle: int, kind: int) -> bool:
    try:
        fcntl.flock(handle, kind | fcntl.LOCK_NB)
    except OSError as error:
        if error.errno in _BUSY:
            return False
        raise
    return True


def _lock_byte(handle: int) -> bool:
    try:
        _apply_to_byte(handle, "LK_NBLCK")
    except OSError as error:
        if error.errno in _BUSY:
            return False
        raise
    return True


def _apply_to_byte(handle: int, action: str) -> None:
    """Call `msvcrt.locking` for the locked byte, and restore the position in the file."""
    import msvcrt

    system: Any = msvcrt
    before = os.lseek(handle, 0, os.SEEK_CUR)
    os.lseek(handle, _LOCKED_BYTE, os.SEEK_SET)
    try:
        system.locking(handle, getattr(system, action), 1)
    finally:
        os.lseek(handle, before, os.SEEK_SET)
