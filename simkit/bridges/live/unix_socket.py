"""Unix sockets of running simulations: a file is the address, and the system reports the user of a caller."""

from __future__ import annotations

import errno
import os
import selectors
import socket
import struct
from contextlib import suppress
from pathlib import Path
from typing import Final

SUFFIX: Final = ".sock"
BACKLOG: Final = 64
_LIVING: Final = frozenset({errno.EAGAIN, errno.EINPROGRESS, errno.EACCES, errno.EPERM})


def is_available() -> bool:
    """Check whether this system's Python has Unix sockets."""
    return hasattr(socket, "AF_UNIX") and hasattr(os, "getuid")


class UnixListener:
    """Listening socket, accessible only to its user.

    Args:
        path: path of the socket, which does not exist yet.

    Raises:
        OSError: the socket cannot be opened.
    """

    def __init__(self, path: Path) -> None:
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            before = os.umask(0o177)
            try:
                self._socket.bind(str(path))
            finally:
                os.umask(before)
            self._socket.listen(BACKLOG)
            self._socket.setblocking(False)
        except OSError:
            self._socket.close()
            raise

    def register(self, selector: selectors.BaseSelector) -> None:
        """Register the socket: the selector reports it, with the data None, when `accept` has work to do."""
        selector.register(self._socket, selectors.EVENT_READ)

    def accept(self) -> socket.socket | None:
        """Return the next connection of this user; None if there is none."""
        while True:
            try:
                connection, _ = self._socket.accept()
            except OSError:  # no new connection, or no free file descriptor
                return None
            connection.setblocking(False)
            _, user = peer_credentials(connection)
            if user is None or user == os.getuid():
                return connection
            connection.close()

    def fileno(self) -> int:
        """Return the file descriptor of the socket; -1 after `close`."""
        return self._socket.fileno()

    def close(self) -> None:
        """Close the socket; its file stays."""
        self._socket.close()


def connect(path: Path, timeout: float) -> socket.socket:
    """Connect to a socket.

    Raises:
        BlockingIOError: the queue of callers is full.
        OSError: no process listens, or it does not answer.
    """
    caller = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        caller.settimeout(timeout)
        caller.connect(str(path))
    except BaseException:
        caller.close()
        raise
    return caller


def is_living(path: Path) -> bool:
    """Check whether a process listens at a socket."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as caller:
        caller.setblocking(False)
        try:
            caller.connect(str(path))
        except OSError as error:
            return error.errno in _LIVING
    return True


def peer_credentials(connection: socket.socket) -> tuple[int | None, int | None]:
    """Return process and user at the remote end of a connection; None for each that the system does not report."""
    option = getattr(socket, "SO_PEERCRED", None)
    if option is not None:
        pid, uid, _ = struct.unpack("3i", connection.getsockopt(socket.SOL_SOCKET, option, 12))
        return pid, uid
    with suppress(OSError, struct.error):  # struct xucred of the BSDs: version, user, …
        return None, struct.unpack_from("II", connection.getsockopt(0, 1, 76))[1]
    return None, None
