"""Local TCP sockets of running simulations, for systems whose Python has no Unix sockets.

Any program of the machine can connect to a TCP port. Therefore a file that only the user can read holds the port and
two random tokens. A caller sends the first token before anything else. Until then, the server answers nothing and reads
nothing behind the token. Then it sends the second token, by which the caller recognises the server. The server locks
its file until it ends, so that the file of a killed process is recognised.
"""

from __future__ import annotations

import errno
import json
import os
import selectors
import socket
import stat
import time
from contextlib import suppress
from dataclasses import dataclass
from hmac import compare_digest
from pathlib import Path
from typing import Final

from simkit import file_lock

SUFFIX: Final = ".port"
TOKEN_BYTES: Final = 32
BACKLOG: Final = 64
_HOST: Final = "127.0.0.1"
_MOST_WAITING: Final = 32  # callers without a token at a time; the oldest one is refused for the next one
_MOST_ACCEPTED: Final = 16  # callers that are accepted at once
_TOKEN_TIMEOUT: Final = 2.0  # [s] of wall time for a caller's token
_LARGEST_FILE: Final = 1024  # [bytes]


@dataclass(frozen=True)
class TokenFile:
    """Content of the file of a server.

    Attributes:
        port: TCP port on the loopback interface.
        pid: number of the server's process.
        caller_token: token that a caller sends.
        server_token: token that the server answers.
    """

    port: int
    pid: int
    caller_token: bytes
    server_token: bytes

    def encode(self) -> bytes:
        """Return the content of the file."""
        tokens = {"caller_token": self.caller_token.hex(), "server_token": self.server_token.hex()}
        return json.dumps({"port": self.port, "pid": self.pid, **tokens}).encode()


@dataclass
class _Caller:
    """Connection without a verified token: its first bytes, and the time of its end [s]."""

    connection: socket.socket
    until: float
    received: bytes = b""


class LoopbackListener:
    """Listening socket on the loopback interface, with its token file.

    Args:
        path: path of the token file, which does not exist yet.

    Raises:
        OSError: the socket or its file cannot be opened.
    """

    def __init__(self, path: Path) -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        self._selector: selectors.BaseSelector | None = None
        self._waiting: list[_Caller] = []
        try:
            exclusive = getattr(socket, "SO_EXCLUSIVEADDRUSE", None)
            if exclusive is not None:  # on Windows, another user could bind the same port
                self._socket.setsockopt(socket.SOL_SOCKET, exclusive, 1)
            self._socket.bind((_HOST, 0))
            self._socket.listen(BACKLOG)
            self._socket.setblocking(False)
            port, tokens = self._socket.getsockname()[1], (os.urandom(TOKEN_BYTES), os.urandom(TOKEN_BYTES))
            self._about = TokenFile(port, os.getpid(), *tokens)
            self._file = _write_token_file(path, self._about)
        except OSError:
            self._socket.close()
            raise

    def register(self, selector: selectors.BaseSelector) -> None:
        """Register the socket and its callers: the selector reports them, with the data None, for `accept`."""
        self._selector = selector
        selector.register(self._socket, selectors.EVENT_READ)

    def accept(self) -> socket.socket | None:
        """Return the next connection with the token; None if there is none. Other connections are closed."""
        for _ in range(_MOST_ACCEPTED):
            if not self._accept_waiting():
                break
        now = time.monotonic()
        for caller in list(self._waiting):
            is_open = _receive_token(caller)
            if len(caller.received) == TOKEN_BYTES and compare_digest(caller.received, self._about.caller_token):
                self._release(caller)
                with suppress(OSError):
                    caller.connection.send(self._about.server_token)  # the first bytes; they always have room
                    return caller.connection
                caller.connection.close()
            elif not is_open or len(caller.received) == TOKEN_BYTES or now > caller.until:
                self._refuse(caller)
        return None

    def _accept_waiting(self) -> bool:
        """Accept a new connection; return False if there is none."""
        try:
            connection, _ = self._socket.accept()
        except OSError:  # no new connection, or no free file descriptor
            return False
        connection.setblocking(False)
        with suppress(OSError):  # the caller may have ended
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        if len(self._waiting) >= _MOST_WAITING:
            self._refuse(self._waiting[0])
        self._waiting.append(_Caller(connection, time.monotonic() + _TOKEN_TIMEOUT))
        if self._selector is not None:
            self._selector.register(connection, selectors.EVENT_READ)
        return True

    def _release(self, caller: _Caller) -> None:
        self._waiting.remove(caller)
        if self._selector is not None:
            self._selector.unregister(caller.connection)

    def _refuse(self, caller: _Caller) -> None:
        self._release(caller)
        caller.connection.close()

    def fileno(self) -> int:
        """Return the file descriptor of the socket; -1 after `close`."""
        return self._socket.fileno()

    def close(self) -> None:
        """Close the socket and unlock its file; the file stays."""
        self._selector = None
        for caller in list(self._waiting):
            self._refuse(caller)
        if self._socket.fileno() >= 0:
            self._socket.close()
            os.close(self._file)


def _receive_token(caller: _Caller) -> bool:
    """Receive the bytes of a caller's token, and none behind it; return False after the end of the connection."""
    try:
        received = caller.connection.recv(TOKEN_BYTES - len(caller.received))
    except (BlockingIOError, InterruptedError):
        return True
    except OSError:
        return False
    caller.received += received
    return bool(received)


def connect(path: Path, timeout: float) -> tuple[socket.socket, bytes]:
    """Connect to the server of a token file, and send the caller's token.

    Returns:
        The connection, and the bytes that the server must send before anything else.

    Raises:
        OSError: no process listens, or it does not answer, or the file is not private to this user.
    """
    about = read_token_file(path)
    caller = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        caller.settimeout(timeout)
        caller.connect((_HOST, about.port))
        caller.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        caller.sendall(about.caller_token)
    except BaseException:
        caller.close()
        raise
    return caller, about.server_token


def is_living(path: Path) -> bool:
    """Check whether the process that has written a token file still runs."""
    try:
        handle = _open(path)
    except OSError:
        return False
    try:
        return file_lock.is_locked(handle)
    except OSError:
        return False
    finally:
        os.close(handle)


def read_token_file(path: Path) -> TokenFile:
    """Read the token file of a living server.

    Raises:
        OSError: the server has ended, or the file is damaged, or other users can read or have written it.
    """
    handle = _open(path)
    try:
        fault = _privacy_fault(os.fstat(handle))
        if fault:
            raise PermissionError(errno.EACCES, f"its file {path} {fault}")
        if not file_lock.is_locked(handle):  # the token of a dead process is sent to nobody
            raise ConnectionRefusedError(errno.ECONNREFUSED, os.strerror(errno.ECONNREFUSED))
        content = os.read(handle, _LARGEST_FILE)
    finally:
        os.close(handle)
    try:
        fields = json.loads(content)
        tokens = bytes.fromhex(fields["caller_token"]), bytes.fromhex(fields["server_token"])
        port, pid = int(fields["port"]), int(fields["pid"])
    except (ValueError, KeyError, TypeError):
        tokens, port, pid = (b"", b""), 0, 0
    if not 0 < port < 1 << 16 or {len(token) for token in tokens} != {TOKEN_BYTES}:
        raise OSError(errno.EINVAL, f"its file {path} is damaged")
    return TokenFile(port, pid, *tokens)


def _open(path: Path) -> int:
    """Open a token file for reading and for locks; a link is not followed, and a pipe is not waited for."""
    flags = (getattr(os, name, 0) for name in ("O_NOFOLLOW", "O_NONBLOCK", "O_CLOEXEC", "O_BINARY"))
    return os.open(path, os.O_RDWR | sum(flags))  # some systems lock only files that are open for writing


def _privacy_fault(status: os.stat_result) -> str:
    """Return the reason not to trust a token file; empty for a file of this user alone.

    On Windows, a file has the access rights of its folder, which is in the user's own folder for data of programs.
    """
    if not stat.S_ISREG(status.st_mode):
        return "is not a regular file"
    if hasattr(os, "getuid"):
        if status.st_uid != os.getuid():
            return "belongs to another user"
        if status.st_mode & 0o077:
            return f"is open to others (mode {stat.S_IMODE(status.st_mode):o}; expected 600)"
    return ""


def _write_token_file(path: Path, about: TokenFile) -> int:
    """Create a token file and lock it; return its file descriptor, which holds the lock."""
    flags = os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_BINARY", 0)
    handle = os.open(path, flags, 0o600)
    try:
        file_lock.wait_for_lock(handle)  # another program may look at the file just now
        os.write(handle, about.encode())
    except BaseException:
        os.close(handle)
        with suppress(OSError):
            path.unlink()
        raise
    return handle
