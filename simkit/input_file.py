"""Reading of files that a user names or that a user's file names: regular files only, with a limit on the size.

Every reader of simkit opens such files here. A named pipe, a device or a file of many gigabytes is refused
before it blocks the program or fills the memory.
"""

from __future__ import annotations

import errno
import os
import select
import stat
from io import BufferedReader
from pathlib import Path

from simkit.linked_files import hide_linked_text, is_below

TEXT_LIMIT = 8 << 20  # [bytes] of a text file that a person writes: YAML, a script, Python code
GIT_LFS_POINTER = b"version https://git-lfs"  # start of a file whose content Git LFS has not fetched
GIT_LFS_TEXT = "a pointer of Git LFS; the content was not fetched (git lfs pull)"
PIPE_TIMEOUT = 10.0  # [s] without data from the writer of a pipe


class FileTooLargeError(OSError):
    """The file is larger than its limit; `strerror` has the limit."""

    def __init__(self, path: Path, limit: int) -> None:
        size = f"{limit >> 20} MiB" if limit >= 1 << 20 else f"{limit} bytes"
        super().__init__(errno.EFBIG, f"it is larger than {size}", str(path))


def open_input(path: str | Path, *, inside: Path | None = None) -> BufferedReader:
    """Open a regular file for reading at any position. The size is not limited.

    Args:
        path: File.
        inside: See `read_input`.

    Raises:
        OSError: the file cannot be opened, or the path is a folder, a pipe or a device; or a link leads outside.
            `strerror` has the reason.
    """
    handle = _open_handle(Path(path), inside)
    try:
        _check_kind(handle, Path(path), allow_pipe=False)
        hide_linked_text(Path(path), inside)
        os.read(handle, 1)  # a file of the system, such as /proc/kmsg, has no content yet: BlockingIOError
        os.lseek(handle, 0, os.SEEK_SET)
    except OSError:
        os.close(handle)
        raise
    return os.fdopen(handle, "rb")


def read_input(path: str | Path, limit: int, *, allow_pipe: bool = False, inside: Path | None = None) -> bytes:
    """Return the content of a file.

    The pipe of a shell (`<(command)`) is always accepted. The reported size of a file is not used, because a file can
    grow while it is read.

    Args:
        path: File.
        limit: Largest size [bytes].
        allow_pipe: Accept a named pipe too.
        inside: Folder in which simkit found the file, or whose file names it. A symbolic link may not lead out of this
            folder, its project and the folders of the user. None for a file that the user names: it may be a link to
            any place, but no message shows its text then.

    Raises:
        FileTooLargeError: the file is larger than the limit.
        OSError: the file cannot be read, the path is a folder or a device, a pipe has no data for 10 s, or a link
            leads outside. `strerror` has the reason.
    """
    path = Path(path)
    handle = _open_handle(path, inside)
    with os.fdopen(handle, "rb", buffering=0):
        is_pipe = _check_kind(handle, path, allow_pipe=allow_pipe or str(path).startswith(("/dev/fd/", "/proc/self/")))
        hide_linked_text(path, inside)
        if not is_pipe and os.fstat(handle).st_size > limit:
            raise FileTooLargeError(path, limit)
        content = _read_pieces(handle, limit + 1, is_pipe=is_pipe)
    if len(content) > limit:
        raise FileTooLargeError(path, limit)
    return content


def read_input_text(
    path: str | Path, limit: int = TEXT_LIMIT, *, errors: str = "strict", inside: Path | None = None
) -> str:
    """Return the UTF-8 text of a file, with line feeds at the ends of lines; see `read_input`.

    Raises:
        OSError: see `read_input`.
        UnicodeDecodeError: the file is not UTF-8 text.
    """
    text = read_input(path, limit, inside=inside).decode("utf-8", errors)
    return text.replace("\r\n", "\n").replace("\r", "\n")


def read_failure(error: OSError | ValueError) -> str:
    """Return the reason why a file cannot be read, for a message: `cannot be read: REASON`."""
    if isinstance(error, UnicodeDecodeError):
        return f"it is not UTF-8 text (byte {error.start})"
    return getattr(error, "strerror", None) or str(error)


def _open_handle(path: Path, inside: Path | None) -> int:
    """Open a file without waiting for the writer of a named pipe."""
    try:
        _check_links(path, inside)
        return os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    except ValueError:
        raise OSError(errno.EINVAL, "the name has a zero byte", repr(str(path))) from None


def _check_links(path: Path, inside: Path | None) -> None:
    """Refuse a link of a folder that leads out of it.

    Raises:
        OSError: a link leads outside.
    """
    if inside is not None and not is_below(path, inside) and os.path.exists(path):  # noqa: PTH110
        target = os.path.dirname(os.path.realpath(path))  # noqa: PTH120
        reason = f"a symbolic link leads to {target}, outside the chosen folders; to allow it, set SIMKIT_RESOURCE_PATH"
        raise OSError(errno.EACCES, reason, str(path))


def _check_kind(handle: int, path: Path, *, allow_pipe: bool) -> bool:
    """Return True for a pipe, and False for a regular file; refuse everything else."""
    mode = os.fstat(handle).st_mode
    if stat.S_ISREG(mode) or (stat.S_ISFIFO(mode) and allow_pipe):
        return stat.S_ISFIFO(mode)
    if stat.S_ISDIR(mode):
        raise OSError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    kind = "pipe" if stat.S_ISFIFO(mode) else "device"
    raise OSError(errno.EINVAL, f"it is a {kind}, not a regular file", str(path))


def _read_pieces(handle: int, left: int, *, is_pipe: bool) -> bytes:
    pieces = []
    while left > 0:
        # on Windows, `select` accepts sockets only, and the read waits for the writer
        if is_pipe and os.name != "nt" and not select.select([handle], [], [], PIPE_TIMEOUT)[0]:
            raise OSError(errno.ETIMEDOUT, f"nothing came through the pipe for {PIPE_TIMEOUT:g} s")
        piece = os.read(handle, min(left, 1 << 24))
        if not piece:
            break
        pieces.append(piece)
        left -= len(piece)
    return b"".join(pieces)
