"""Module `socket` of a program: it waits for other computers in simulated time, and connections to them are told.

A socket that waits is asked every 10 ms of simulated time. Other computers follow wall time, so a run with them is not
repeatable.
"""

from __future__ import annotations

import errno
import os
import select as _select
import socket as _python
from typing import Any, Final

from simkit_nodes.python_modules.thread_module import wait_for
from simkit_nodes.tasks import current_task

__all__ = ["create_connection", "create_server", "socket"]

_PAUSE: Final = 0.01  # [s] of simulated time between two questions to the operating system
_DEFAULT_TIMEOUT: Final[Any] = object()  # that of `socket.setdefaulttimeout`
_STARTED: Final = (errno.EINPROGRESS, errno.EWOULDBLOCK, errno.EALREADY)


class socket(_python.socket):
    """Real socket whose calls wait in simulated time."""

    def _wait(self, *, is_writable: bool = False) -> None:
        """Wait until the socket is readable or writable.

        Raises:
            TimeoutError: it was not within the time of `settimeout`.
        """
        task, left = current_task(), self.gettimeout()
        if task is None:
            return
        if left == 0:
            task.poll()
            return
        files: tuple[list[Any], list[Any]] = ([], [self]) if is_writable else ([self], [])
        while not any(_select.select(*files, [self], 0)):
            if left is not None and left <= 0:
                raise TimeoutError("timed out")
            pause = _PAUSE if left is None else min(_PAUSE, left)
            wait_for(lambda: False, pause)
            left = None if left is None else left - pause

    def recv(self, *args: Any) -> bytes:
        """Wait for bytes and return them."""
        self._wait()
        return super().recv(*args)

    def recv_into(self, *args: Any, **options: Any) -> int:
        """Wait for bytes and store them."""
        self._wait()
        return super().recv_into(*args, **options)

    def recvfrom(self, *args: Any) -> tuple[bytes, Any]:
        """Wait for a packet and return it with its sender."""
        self._wait()
        return super().recvfrom(*args)

    def recvfrom_into(self, *args: Any, **options: Any) -> tuple[int, Any]:
        """Wait for a packet, store it, and return its sender."""
        self._wait()
        return super().recvfrom_into(*args, **options)

    def accept(self) -> tuple[_python.socket, Any]:
        """Wait for a connection and return it."""
        self._wait()
        connection, address = super().accept()
        return type(self)(connection.family, connection.type, connection.proto, connection.detach()), address

    def connect(self, address: Any, /) -> None:
        """Connect, and tell it."""
        number = self.connect_ex(address)
        if number:
            raise OSError(number, os.strerror(number))

    def connect_ex(self, address: Any, /) -> int:
        """Connect, and tell it; return the number of an error, or 0."""
        _tell()
        timeout = self.gettimeout()
        if current_task() is None or timeout == 0:
            return super().connect_ex(address)
        self.settimeout(0)
        try:
            number = super().connect_ex(address)
        finally:
            self.settimeout(timeout)
        if number not in _STARTED:
            return number
        self._wait(is_writable=True)
        return int(self.getsockopt(_python.SOL_SOCKET, _python.SO_ERROR))

    def bind(self, address: Any, /) -> None:
        """Bind to an address, and tell it."""
        _tell()
        super().bind(address)

    def sendto(self, *args: Any) -> int:
        """Send a packet, and tell it."""
        _tell()
        return super().sendto(*args)


def _tell() -> None:
    task = current_task()
    if task is not None:
        task.program.tell("SK-NODE-051")


def create_connection(
    address: tuple[str | None, int],
    timeout: Any = _DEFAULT_TIMEOUT,
    source_address: Any = None,
    *,
    all_errors: bool = False,
) -> socket:
    """Connect to an address, and tell it.

    Raises:
        OSError: no address of the computer can be reached; the first reason, or all of them in an ExceptionGroup.
    """
    errors: list[Exception] = []
    for family, kind, protocol, _, place in _python.getaddrinfo(*address, 0, _python.SOCK_STREAM):
        connection = socket(family, kind, protocol)
        try:
            if timeout is not _DEFAULT_TIMEOUT:
                connection.settimeout(timeout)
            if source_address:
                connection.bind(source_address)
            connection.connect(place)
        except OSError as error:
            connection.close()
            errors.append(error)
        else:
            return connection
    if all_errors:
        raise ExceptionGroup("create_connection failed", errors)
    raise errors[0] if errors else OSError("getaddrinfo returns an empty list")


def create_server(address: Any, **options: Any) -> socket:
    """Listen at an address, and tell it."""
    _tell()
    server = _python.create_server(address, **options)
    return socket(server.family, server.type, server.proto, server.detach())
