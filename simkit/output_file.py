"""Files that are opened for writing in folders that strangers may have made, and pipes that are written to.

A named pipe without a reader would block the program for ever, and a symbolic link would lead the output out of the
folder.
"""

from __future__ import annotations

import errno
import os
import stat
import time
from contextlib import suppress
from io import BufferedRandom
from pathlib import Path
from typing import IO, Final

PIPE_TIMEOUT: Final = 10.0
"""Time [s] to wait for the reader of a named pipe."""
_PROBE_INTERVAL: Final = 0.02  # [s]
_MODE: Final = 0o666  # as `open`


def open_regular(path: Path, mode: int = _MODE) -> BufferedRandom:
    """Open a regular file for reading and appending; create the file if it does not exist.

    Args:
        path: file.
        mode: access rights of a new file, from which the process's umask is subtracted.

    Raises:
        OSError: the file cannot be opened, or the path is a symbolic link, a folder, a pipe or a device. `strerror` has
            the reason.
    """
    flags = os.O_RDWR | os.O_CREAT | os.O_APPEND
    for name in ("O_NOFOLLOW", "O_NONBLOCK", "O_NOCTTY", "O_CLOEXEC", "O_BINARY"):
        flags |= getattr(os, name, 0)
    try:
        handle = os.open(path, flags, mode)
    except OSError as error:
        raise OSError(error.errno, _reason(path) or os.strerror(error.errno or 0), str(path)) from None
    if not stat.S_ISREG(os.fstat(handle).st_mode) or (not hasattr(os, "O_NOFOLLOW") and path.is_symlink()):
        os.close(handle)
        raise OSError(errno.EINVAL, _reason(path) or "it is not a regular file", str(path))
    return os.fdopen(handle, "a+b")


def _reason(path: Path) -> str:
    """Return the reason why a path is not a regular file; empty if it is one or does not exist."""
    try:
        mode = path.lstat().st_mode
    except OSError:
        return ""
    if stat.S_ISREG(mode):
        return ""
    if stat.S_ISLNK(mode):
        return "it is a symbolic link, not a regular file"
    kind = "folder" if stat.S_ISDIR(mode) else "pipe" if stat.S_ISFIFO(mode) else "device"
    return f"it is a {kind}, not a regular file"


def open_target(path: Path, *, overwrite: bool = False) -> IO[bytes]:
    """Open a file that the user has named for writing; a pipe and a device are opened as by `open_special`.

    Args:
        path: file.
        overwrite: True to replace an existing file.

    Raises:
        FileExistsError: the file exists, and `overwrite` is not set.
        OSError: the file is not writable.
    """
    if overwrite and path.exists() and not path.is_file():
        return open_special(path)
    if overwrite and not path.is_symlink():
        with suppress(PermissionError):  # the file may be writable although its folder is not
            path.unlink(missing_ok=True)  # another run may still write to it
    return path.open("wb" if overwrite else "xb")


def open_special(path: Path) -> IO[bytes]:
    """Open a pipe or a device for writing. The reader of a named pipe must open it within 10 s.

    Raises:
        OSError: the path cannot be opened, or nothing reads the pipe.
    """
    end = time.monotonic() + PIPE_TIMEOUT
    while True:
        try:
            handle = os.open(path, os.O_WRONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0))
        except OSError as error:
            if error.errno != errno.ENXIO or not stat.S_ISFIFO(path.stat().st_mode):
                raise
            if time.monotonic() > end:
                reason = f"nothing reads the pipe for {PIPE_TIMEOUT:g} s"
                raise OSError(errno.ETIMEDOUT, reason, str(path)) from None
            time.sleep(_PROBE_INTERVAL)
        else:
            if os.name != "nt":
                os.set_blocking(handle, True)
            return os.fdopen(handle, "wb")
