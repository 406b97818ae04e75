"""Files by which programs find the sockets of running simulations, in a folder that only their user may enter.

The folder is `$XDG_RUNTIME_DIR/simkit`. Without that variable it is `simkit-<uid>` in the folder of temporary files; on
Windows it is `simkit-running` in the user's folder for data of programs. A file is a Unix socket, or a token file with
the port of a local TCP socket. `SIMKIT_LOCAL_SOCKETS` chooses the kind for new simulations: `unix` or `tcp`. The
default is `unix` where Python has Unix sockets. Clients accept both kinds.
"""

from __future__ import annotations

import os
import re
import socket
import stat
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from simkit import file_lock
from simkit.bridges.live import loopback_socket, unix_socket
from simkit.bridges.live.loopback_socket import LoopbackListener
from simkit.bridges.live.unix_socket import UnixListener
from simkit.output_file import open_regular

KIND_VARIABLE: Final = "SIMKIT_LOCAL_SOCKETS"
SUFFIXES: Final = (unix_socket.SUFFIX, loopback_socket.SUFFIX)
Listener = UnixListener | LoopbackListener
_LONGEST_NAME = 48  # the path of a Unix socket may have about 100 bytes
_LOCK_TIMEOUT = 2.0  # [s], longest wait for other simulations that start


class NoSocketFolder(Exception):
    """Error for a socket that has no usable folder; the message has the reason."""


def _suffix_of_new_sockets() -> str:
    """Return the suffix of the files of new simulations.

    Raises:
        NoSocketFolder: this system has no sockets of the requested kind.
    """
    kind = os.environ.get(KIND_VARIABLE) or ("unix" if unix_socket.is_available() else "tcp")
    if kind not in ("unix", "tcp"):
        raise NoSocketFolder(f"{KIND_VARIABLE} is {kind!r}; expected unix or tcp")
    if kind == "unix" and not unix_socket.is_available():
        raise NoSocketFolder(f"this system's Python has no Unix sockets; expected {KIND_VARIABLE}=tcp")
    return unix_socket.SUFFIX if kind == "unix" else loopback_socket.SUFFIX


def socket_folders() -> list[Path]:
    """Return the folders that sockets may be in, the preferred folder first."""
    if not hasattr(os, "getuid"):
        local_data = os.environ.get("LOCALAPPDATA")
        return [Path(local_data) / "simkit-running"] if local_data and Path(local_data).is_absolute() else []
    folders = []
    with suppress(FileNotFoundError):  # there is no folder for temporary files, for example because the disk is full
        folders.append(Path(tempfile.gettempdir()) / f"simkit-{os.getuid()}")
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    if runtime and Path(runtime).is_absolute():
        folders.insert(0, Path(runtime) / "simkit")
    return folders


def folder_fault(folder: Path) -> str:
    """Return the reason not to trust the sockets in a folder; empty for a trusted folder."""
    try:
        status = os.lstat(folder)
    except OSError as error:
        return f"{folder}: {error.strerror}"
    if not stat.S_ISDIR(status.st_mode):
        return f"{folder} is not a folder"
    if not hasattr(os, "getuid"):  # Windows: access rights are those of the parent folder
        is_link = getattr(status, "st_file_attributes", 0) & stat.FILE_ATTRIBUTE_REPARSE_POINT
        return f"{folder} is a link" if is_link else ""
    if status.st_uid != os.getuid():
        return f"{folder} belongs to another user"
    if status.st_mode & 0o077:
        return f"{folder} is open to others (mode {stat.S_IMODE(status.st_mode):o}; expected 700)"
    return ""


def file_name(name: str) -> str:
    """Convert a name to a file name that every file system accepts."""
    return re.sub(r"[^A-Za-z0-9_.-]+", "_", name).strip(".")[:_LONGEST_NAME] or "simulation"


def bind(name: str) -> tuple[Listener, str, Path]:
    """Open a listening socket under a name. If a running simulation has the name, `_2`, `_3`, … is added.

    Raises:
        NoSocketFolder: no folder can contain the socket.
    """
    suffix = _suffix_of_new_sockets()
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
            return _bind_in(folder, file_name(name), suffix)
        except OSError as error:
            full.append(f"{folder}: {error.strerror or error}")
    raise NoSocketFolder("; ".join((*full, *unusable)) or "there is no folder for temporary files")


def _bind_in(folder: Path, requested: str, suffix: str) -> tuple[Listener, str, Path]:
    """Open a listening socket in one folder.

    Raises:
        OSError: the folder cannot contain the socket.
    """
    with _lock_folder(folder):
        for path in _files_in(folder):
            if not is_living(path):
                with suppress(OSError):  # a file that cannot be deleted occupies its name
                    path.unlink(missing_ok=True)  # socket of a process that has ended
        for number in range(1, 1000):
            free = requested if number == 1 else f"{requested}_{number}"
            if not any(os.path.lexists(folder / (free + each)) for each in SUFFIXES):
                path = folder / (free + suffix)
                listener = UnixListener(path) if suffix == unix_socket.SUFFIX else LoopbackListener(path)
                return listener, free, path
    raise OSError(f"every name from {requested} to {requested}_999 is in use")


@contextmanager
def _lock_folder(folder: Path) -> Iterator[None]:
    """Lock the folder, so that two simulations that start at the same time do not choose the same name."""
    with open_regular(folder / ".lock", 0o600) as file:
        end = time.monotonic() + _LOCK_TIMEOUT
        while not file_lock.try_lock(file.fileno()):
            if time.monotonic() >= end:
                raise OSError("another simulation holds its lock and does not finish starting")
            time.sleep(0.01)
        yield


def is_living(path: Path) -> bool:
    """Check whether a process listens at a socket."""
    if path.suffix == loopback_socket.SUFFIX:
        return loopback_socket.is_living(path)
    return unix_socket.is_available() and unix_socket.is_living(path)


def connect(path: Path, timeout: float) -> tuple[socket.socket, bytes]:
    """Connect to a simulation.

    Args:
        path: file of its socket.
        timeout: longest wait of the connection's operations [s], wall time.

    Returns:
        The connection, and the bytes that the simulation must send before its first frame.

    Raises:
        BlockingIOError: the simulation has not accepted its last callers yet.
        OSError: the simulation cannot be reached.
    """
    if path.suffix == loopback_socket.SUFFIX:
        return loopback_socket.connect(path, timeout)
    return unix_socket.connect(path, timeout), b""


def process_number(path: Path, connection: socket.socket) -> int:
    """Return the process of a simulation at the remote end of a connection; 0 if the system does not report it.

    Raises:
        OSError: the simulation has ended.
    """
    if path.suffix == loopback_socket.SUFFIX:
        return loopback_socket.read_token_file(path).pid
    return unix_socket.peer_credentials(connection)[0] or 0


def _files_in(folder: Path) -> list[Path]:
    return sorted(path for suffix in SUFFIXES for path in folder.glob("*" + suffix))


def sockets() -> list[Path]:
    """Return the sockets in trusted folders, including those of processes that have ended."""
    path_by_name: dict[str, Path] = {}
    for folder in socket_folders():
        if not folder_fault(folder):
            for path in _files_in(folder):
                path_by_name.setdefault(path.stem, path)
    return [path_by_name[name] for name in sorted(path_by_name)]
