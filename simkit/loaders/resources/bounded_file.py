"""Reading of untrusted files, with a size limit and with a timeout for pipes."""

from __future__ import annotations

import errno
import os
import select
import stat
from pathlib import Path

PIPE_TIMEOUT = 10.0  # [s] longest wait for data from a pipe


def read_bounded(path: Path, most: int) -> bytes:
    """Return the content of a file or pipe, at most `most` + 1 bytes.

    One byte more than `most` means that the file is larger. The reported file size is not used, because a file can grow
    or be sparse. Devices (`/dev/zero`) are refused.

    Raises:
        OSError: the path cannot be read, is a folder or a device, or is a pipe without data for 10 s.
    """
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with os.fdopen(handle, "rb", buffering=0):
        mode = os.fstat(handle).st_mode
        if stat.S_ISREG(mode) or stat.S_ISFIFO(mode):
            return _read_pieces(handle, most, is_pipe=stat.S_ISFIFO(mode))
        if stat.S_ISDIR(mode):
            raise OSError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
        raise OSError(errno.EINVAL, "it is a device, not a file", str(path))


def _read_pieces(handle: int, most: int, *, is_pipe: bool) -> bytes:
    pieces, left = [], most + 1
    while left > 0:
        if is_pipe and not select.select([handle], [], [], PIPE_TIMEOUT)[0]:
            raise OSError(errno.ETIMEDOUT, f"the pipe had no data for {PIPE_TIMEOUT:g} s")
        piece = os.read(handle, min(left, 1 << 24))
        if not piece:
            break
        pieces.append(piece)
        left -= len(piece)
    return b"".join(pieces)
