"""Socket files of running simulations, in a folder that only their user may enter.

The folder is `$XDG_RUNTIME_DIR/simkit`. Without that variable it is `simkit-<uid>` in the folder of temporary files.
"""

from __future__ import annotations

import errno
import os
import re
import socket
import stat
import struct
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

SUFFIX: Final = ".sock"
BACKLOG: Final = 64
_LONGEST_NAME = 48  # the path of a socket may have about 100 bytes
_LOCK_TIMEOUT = 2.0  # [s], longest wait for other simulations that start
_LIVING = frozenset({errno.EAGAIN, errno.EINPROGRESS, errno.EACCES, errno.EPERM})


class NoSocketFolder(Exception):
    """Error for a socket that has no usable folder; the message has the reason."""


def is_possible() -> bool:
    """Check whether this system's Python has local sockets."""
    return hasattr(socket, "AF_UNIX") and hasattr(os, "getuid")


def socket_folders() -> list[Path]:
    """Return the folders that sockets may be in, the preferred folder first."""
    if not is_possible():
        return []
    found = []
    with suppress(FileNotFoundError):  # there is no folder for temporary files, for example because the disk is full
        found.append(Path(tempfile.gettempdir()) / f"simkit-{os.getuid()}")
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    if runtime and Path(runtime).is_absolute():
        found.insert(0, Path(runtime) / "simkit")
    return found


def folder_fault(folder: Path) -> str:
    """Return the reason not to trust the sockets in a folder; empty for a trusted folder."""
    try:
        found = os.lstat(folder)
    except OSError as error:
        return f"{folder}: {error.strerror}"
    if not stat.S_ISDIR(found.st_mode):
        return f"{folder} is not a folder"
    if found.st_uid != os.getuid():
        return f"{folder} belongs to another user"
    if found.st_mode & 0o077:
        return f"{folder} is open to others (mode {stat.S_IMODE(found.st_mode):o}; expected 700)"
    return ""


def file_name(name: str) -> str:
    """Convert a name to a file name that every file system accepts."""
    return re.sub(r"[^A-Za-z0-9_.-]+", "_", name).strip(".")[:_LONGEST_NAME] or "simulation"


def bind(name: str) -> tuple[socket.socket, str, Path]:
    """Open a listening socket under a name. If a running simulation has the name, `_2`, `_3`, … is added.

    Raises:
        NoSocketFolder: no folder can contain the socket.
    """
    if not is_possible():
        raise NoSocketFolder("this system's Python has no local sockets")
    full: list[str] = []
    unusable: list[str] = []
    for folder in socket_folders():
        with suppress(OSError):
            folder.mkdir(0o700)
        fault = folder_fault(folder)
        if fault or not os.access(folder, os.W_OK):
            unusable.append(fault or f"{folder} is not writable")
            continue
        try:
            return _bind_in(folder, file_name(name))
        except OSError as error:
            full.append(f"{folder}: {error.strerror or error}")
    raise NoSocketFolder("; ".join((*full, *unusable)) or "there is no folder for temporary files")


def _bind_in(folder: Path, requested: str) -> tuple[socket.socket, str, Path]:
    """Open a listening socket in one folder.

    Raises:
        OSError: the folder cannot contain the socket.
    """
    with _lock_folder(folder):
        for path in folder.glob("*" + SUFFIX):
            if not is_living(path):
                with suppress(OSError):  # a file that cannot be deleted occupies its name
                    path.unlink(missing_ok=True)  # socket of a process that has ended
        for number in range(1, 1000):
            free = requested if number == 1 else f"{requested}_{number}"
            path = folder / (free + SUFFIX)
            if not os.path.lexists(path):
                return _listen_at(path), free, path
    raise OSError(f"every name from {requested} to {requested}_999 is in use")


def _listen_at(path: Path) -> socket.socket:
    listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        before = os.umask(0o177)
        try:
            listener.bind(str(path))
        finally:
            os.umask(before)
        listener.listen(BACKLOG)
        listener.setblocking(False)
    except OSError:
        listener.close()
        raise
    return listener


@contextmanager
def _lock_folder(folder: Path) -> Iterator[None]:
    """Lock the folder, so that two simulations that start at the same time do not choose the same name."""
    import fcntl

    handle = os.open(folder / ".lock", os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    try:
        end = time.monotonic() + _LOCK_TIMEOUT
        while True:
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
                break
            except BlockingIOError:
                if time.monotonic() >= end:
                    raise OSError("another simulation holds its lock and does not finish starting") from None
            time.sleep(0.01)
        yield
    finally:
        os.close(handle)


def is_living(path: Path) -> bool:
    """Check whether a process listens at a socket."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as caller:
        caller.setblocking(False)
        try:
            caller.connect(str(path))
        except OSError as error:
            return error.errno in _LIVING
    return True


def sockets() -> list[Path]:
    """Return the sockets in trusted folders, including those of processes that have ended."""
    found: dict[str, Path] = {}
    for folder in socket_folders():
        if not folder_fault(folder):
            for path in sorted(folder.glob("*" + SUFFIX)):
                found.setdefault(path.name, path)
    return [found[name] for name in sorted(found)]


def peer_credentials(connection: socket.socket) -> tuple[int | None, int | None]:
    """Return process and user at the remote end of a connection; None for each that the system does not report."""
    option = getattr(socket, "SO_PEERCRED", None)
    if option is not None:
        pid, uid, _ = struct.unpack("3i", connection.getsockopt(socket.SOL_SOCKET, option, 12))
        return pid, uid
    with suppress(OSError, struct.error):  # struct xucred of the BSDs: version, user, …
        return None, struct.unpack_from("II", connection.getsockopt(0, 1, 76))[1]
    return None, None
