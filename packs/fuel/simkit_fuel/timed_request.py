"""HTTP requests with one time limit from the look-up of the server's name to the last byte of the answer.

The timeout of a socket limits only one call. A server that sends a header line every second, thousands of interim
answers or an endless redirect page would never reach it.
"""

from __future__ import annotations

import socket
import ssl
import threading
import time
from functools import partial
from http.client import HTTPConnection, HTTPException, HTTPResponse, HTTPSConnection
from typing import Any, Final
from urllib.request import BaseHandler, HTTPHandler, HTTPSHandler, Request

CONTENT_STEP: Final = 100_000
"""Content [bytes] that must come within the time limit."""
_MOST_HEADER_BYTES: Final = 1 << 20  # of one request, with interim answers, redirects and the answers of a proxy


class RequestLimits:
    """Limits of one request.

    Args:
        timeout: longest time [s] until the headers are complete, and then for each 100 kB of content.
        end: time of `time.monotonic` at which the request ends in any case.
    """

    def __init__(self, timeout: float, end: float) -> None:
        self._timeout, self._end = timeout, end
        self._deadline = time.monotonic() + timeout
        self._received = 0  # [bytes] of the headers, then of a step of the content
        self._is_content = False
        self._sockets: list[socket.socket] = []

    def close(self) -> None:
        """Close the connections of a request that failed.

        `urllib` leaves some of them to the garbage collector, with readers that would keep a closed one open.
        """
        for connection in self._sockets:
            handle = connection.detach()
            if handle >= 0:
                socket.close(handle)

    def keep(self, connection: socket.socket) -> None:
        """Note a connection for `close`."""
        self._sockets.append(connection)

    def begin_content(self) -> None:
        """Note that the headers are complete."""
        self._is_content = True
        self._received, self._deadline = 0, time.monotonic() + self._timeout

    def time_left(self) -> float:
        """Return the time [s] that is left.

        Raises:
            TimeoutError: no time is left.
        """
        left = min(self._deadline, self._end) - time.monotonic()
        if left <= 0:
            raise self.expired()
        return min(left, threading.TIMEOUT_MAX)

    def count(self, received: int) -> None:
        """Count bytes that were received.

        Raises:
            TimeoutError: no time is left.
            HTTPException: the headers are too large.
        """
        self.time_left()
        self._received += received
        if not self._is_content and self._received > _MOST_HEADER_BYTES:
            raise HTTPException(f"more than {_MOST_HEADER_BYTES >> 20} MiB came before the content")
        if self._is_content and self._received >= CONTENT_STEP:
            self._received, self._deadline = 0, time.monotonic() + self._timeout

    def expired(self) -> TimeoutError:
        """Return the error of a request without time."""
        if self._end <= self._deadline:
            return TimeoutError("timed out: the time of the whole run is over (--max-time)")
        what = f"less than {CONTENT_STEP // 1000} kB came" if self._is_content else "no complete answer"
        return TimeoutError(f"timed out: {what} in {self._timeout:g} s (--timeout)")

    def connect(self, address: tuple[str, int], *_: object) -> socket.socket:
        """Connect to a server; a replacement of `socket.create_connection`.

        Raises:
            OSError: no address of the server can be reached, or no time is left.
        """
        problem: OSError = OSError("the server has no address")
        for family, kind, protocol, _name, place in self._look_up(*address):
            connection = _TimedSocket(family, kind, protocol)
            connection.limits = self
            self.keep(connection)
            try:
                connection.settimeout(self.time_left())
                connection.connect(place)
                connection.settimeout(self.time_left())
            except TimeoutError:
                raise self.expired() from None
            except OSError as error:
                connection.close()
                problem = error
            else:
                return connection
        raise problem

    def _look_up(self, host: str, port: int) -> list[Any]:
        """Return the addresses of a server. The system's function has no time limit, so a thread waits for it."""
        addresses: list[Any] = []
        problems: list[Exception] = []

        def search() -> None:
            try:
                addresses.extend(socket.getaddrinfo(host, port, 0, socket.SOCK_STREAM))
            except (OSError, ValueError) as error:
                problems.append(error)

        thread = threading.Thread(target=search, name="simkit-name-look-up", daemon=True)
        thread.start()
        thread.join(self.time_left())
        self.time_left()
        for problem in problems:
            raise problem
        return addresses


class _TimedReading:
    """Part of a socket whose calls end at the end of a request."""

    limits: RequestLimits

    def recv_into(self, *args: Any, **options: Any) -> int:
        connection: Any = super()
        try:
            self.settimeout(self.limits.time_left())  # type: ignore[attr-defined]
            received: int = connection.recv_into(*args, **options)
        except TimeoutError:
            raise self.limits.expired() from None
        self.limits.count(received)
        return received


class _TimedSocket(_TimedReading, socket.socket):
    """Socket of a request."""


class _TimedTlsSocket(_TimedReading, ssl.SSLSocket):
    """Encrypted socket of a request."""


class _TimedConnection(HTTPConnection):
    def __init__(self, host: str, *, limits: RequestLimits, **options: Any) -> None:
        super().__init__(host, **options)
        self._create_connection = limits.connect


class _TimedTlsConnection(HTTPSConnection):
    def __init__(self, host: str, *, limits: RequestLimits, **options: Any) -> None:
        super().__init__(host, **options)
        self._create_connection, self._limits = limits.connect, limits

    def connect(self) -> None:
        try:
            super().connect()
        except TimeoutError:
            raise self._limits.expired() from None
        connection: Any = self.sock
        connection.limits = self._limits
        self._limits.keep(connection)


class _TimedHandler(HTTPHandler):
    def __init__(self, limits: RequestLimits) -> None:
        super().__init__()
        self._limits = limits

    def http_open(self, req: Request) -> HTTPResponse:
        return self.do_open(partial(_TimedConnection, limits=self._limits), req)


class _TimedTlsHandler(HTTPSHandler):
    def __init__(self, limits: RequestLimits) -> None:
        super().__init__()
        self._limits = limits

    def https_open(self, req: Request) -> HTTPResponse:
        context = ssl.create_default_context()
        context.set_alpn_protocols(["http/1.1"])
        context.sslsocket_class = _TimedTlsSocket
        return self.do_open(partial(_TimedTlsConnection, limits=self._limits, context=context), req)


def timed_handlers(limits: RequestLimits) -> tuple[BaseHandler, BaseHandler]:
    """Return the handlers of `http` and `https` for an opener of `urllib.request`."""
    return _TimedHandler(limits), _TimedTlsHandler(limits)
