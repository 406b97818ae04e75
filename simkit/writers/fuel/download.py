"""Download of a file over HTTP: with limits, resumed after a broken connection, and only from the named server."""

from __future__ import annotations

import ipaddress
import json
import os
import re
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from http.client import HTTPException, HTTPMessage
from io import BufferedRandom
from pathlib import Path
from typing import IO, Any
from urllib.error import HTTPError, URLError
from urllib.parse import urlsplit
from urllib.request import HTTPRedirectHandler, OpenerDirector, ProxyHandler, Request, build_opener

from simkit.input_file import read_input_text
from simkit.progress import Task
from simkit.version import __version__

MISSING, REFUSED, TOO_LARGE, NETWORK = "SK-FETCH-001", "SK-FETCH-002", "SK-FETCH-003", "SK-FETCH-006"
_CHUNK = 1 << 16  # [bytes]
_LEAST = 1024  # [bytes] that a server must send within the time limit
_MOST_ATTEMPTS = 10
_VERSION_HEADERS = ("X-Ign-Resource-Version", "X-Gz-Resource-Version")
_RANGE = re.compile(r"bytes (\d{1,18})-\d{1,18}/(\d{1,18})")


class DownloadError(Exception):
    """Failed download.

    Attributes:
        code: code of the diagnostic.
        hint: remedy.
        is_unreachable: true if the server gave no answer at all.
    """

    def __init__(self, code: str, message: str, hint: str = "", *, is_unreachable: bool = False) -> None:
        super().__init__(message)
        self.code, self.hint, self.is_unreachable = code, hint, is_unreachable


class _NoAnswerError(OSError):
    """Failure before the first line of an answer; `reason` is the original error."""

    def __init__(self, error: Exception) -> None:
        super().__init__(str(error))
        self.reason = error.reason if isinstance(error, URLError) else error


@dataclass(frozen=True)
class Connection:
    """Rules for connections to servers.

    Attributes:
        timeout: longest time without data [s].
        allow_http: allows connections without encryption to other computers.
    """

    timeout: float = 30.0
    allow_http: bool = False

    def check(self, address: str) -> None:
        """Check that a server may be used.

        Raises:
            DownloadError: the address is not encrypted and leads to another computer.
        """
        parts = urlsplit(address)
        if parts.scheme != "https" and not (self.allow_http or is_loopback(parts.hostname or "")):
            message = f"{parts.scheme}://{parts.netloc} is not encrypted: anybody on the way could change the files"
            raise DownloadError(REFUSED, message, "use an https URL, --server https://..., or allow it: --allow-http")

    def open(self, address: str, headers: Mapping[str, str]) -> Any:
        """Send a request; return the response.

        Raises:
            DownloadError: the server does not have the file, or redirects to another server.
            OSError, HTTPException: the server does not answer, or has an error of its own.
        """
        self.check(address)
        agent = {"User-Agent": f"simkit/{__version__}", "Accept-Encoding": "identity"}
        request = Request(address, headers={**agent, **headers})
        try:
            return _opener(address).open(request, timeout=self.timeout)
        except HTTPError as error:
            error.close()
            if error.code in (408, 416, 425, 429) or error.code >= 500:
                raise
            server = urlsplit(address).netloc
            reason = {404: "does not have it", 410: "does not have it any more", 401: "does not give it without login"}
            text = f"{server} {reason.get(error.code, 'does not give it')} (HTTP {error.code})"
            raise DownloadError(MISSING, text, "check the owner, the name and the version in the URL") from None
        except (OSError, HTTPException) as error:
            raise _NoAnswerError(error) from None


class _SameServer(HTTPRedirectHandler):
    """Handler of redirects that stays on the same server."""

    def redirect_request(
        self, req: Request, fp: IO[bytes], code: int, msg: str, headers: HTTPMessage, newurl: str
    ) -> Request | None:
        if urlsplit(newurl)[:2] != urlsplit(req.full_url)[:2]:
            message = f"{urlsplit(req.full_url).netloc} redirects to another server, {newurl:.200}"
            raise DownloadError(REFUSED, message, "name that server in the URL or with --server, if you trust it")
        return super().redirect_request(req, fp, code, msg, headers, newurl)


def is_loopback(host: str) -> bool:
    """Check whether a host name is this computer."""
    try:
        return host.lower() == "localhost" or ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def _opener(address: str) -> OpenerDirector:
    """Return an opener; a proxy of the environment is used, except for servers on this computer."""
    direct = [ProxyHandler({})] if is_loopback(urlsplit(address).hostname or "") else []
    return build_opener(_SameServer, *direct)


def remote_size(address: str, connection: Connection) -> tuple[int | None, int | None]:
    """Return the version and the size [bytes] of a file on a server, without downloading the file.

    Raises:
        DownloadError: the server does not have the file, or does not answer.
    """
    try:
        with connection.open(address, {"Range": "bytes=0-0"}) as response:
            found = _RANGE.fullmatch(response.headers.get("Content-Range", ""))
            return _version(response.headers), int(found[2]) if found else _length(response.headers)
    except (OSError, HTTPException) as error:
        raise _network_error(address, error, "") from None


class Download:
    """Download of one address into a file that may hold the beginning from an earlier attempt.

    Args:
        address: HTTP address.
        file: file, opened for reading and appending.
        notes: file that describes the beginning in `file`, so that it is not joined with another version.
        limit: largest size [bytes].
        connection: rules for connections.
        is_needed: function that gets the version of the file; false ends the download.
        task: progress in MB.
    """

    def __init__(
        self,
        address: str,
        file: BufferedRandom,
        notes: Path,
        limit: int,
        connection: Connection,
        is_needed: Callable[[int | None], bool],
        task: Task,
    ) -> None:
        self.address, self.file, self.notes, self.limit, self.connection = address, file, notes, limit, connection
        self._is_needed, self._task = is_needed, task

    def run(self) -> tuple[int | None, bool]:
        """Download the file; resume after a broken connection, as long as each attempt brings new data.

        Returns:
            Version of the file, if the server tells it, and true if the file was needed and is complete.

        Raises:
            DownloadError: the file cannot be downloaded.
        """
        for attempt in range(_MOST_ATTEMPTS):
            before = self.file.seek(0, os.SEEK_END)
            try:
                return self._receive(before)
            except (OSError, HTTPException) as error:
                size = self.file.seek(0, os.SEEK_END)
                if isinstance(error, HTTPError) and error.code == 416 and before:
                    self.file.truncate(0)  # the beginning does not belong to the file that the server has now
                elif size <= before or attempt == _MOST_ATTEMPTS - 1:
                    raise _network_error(self.address, error, f" after {size} bytes" if size else "") from None
        raise AssertionError

    def _receive(self, at: int) -> tuple[int | None, bool]:
        """Request the part of the file that is not there yet, and append it."""
        notes = self._read_notes() if at else {}
        headers = {"Range": f"bytes={at}-"} if at else {}
        if notes.get("validator"):
            headers["If-Range"] = str(notes["validator"])
        with self.connection.open(self.address, headers) as response:
            version, length = _version(response.headers), _length(response.headers)
            if response.status == 206:
                found = _RANGE.fullmatch(response.headers.get("Content-Range", ""))
                if at and (not found or int(found[1]) != at or notes.get("version") != version):
                    self.file.truncate(0)
                    return self._receive(0)
            else:
                self.file.truncate(0)
                at = 0
                self._write_notes(version, response.headers)
            total = None if length is None else at + length
            self._check_size(total or at)
            if not self._is_needed(version):
                return version, False
            self._task.total = None if total is None else total / 1e6
            self._append(response, at, total)
        return version, True

    def _append(self, response: Any, at: int, total: int | None) -> None:
        window, received = time.monotonic(), 0
        while piece := response.read1(_CHUNK):
            self.file.write(piece)
            at, received = at + len(piece), received + len(piece)
            self._check_size(at)
            self._task.done = at / 1e6
            now = time.monotonic()
            if now - window > self.connection.timeout:
                if received < _LEAST:
                    raise TimeoutError(f"only {received} bytes came in {self.connection.timeout:g} s")
                window, received = now, 0
        self.file.flush()
        if total is not None and at != total:
            raise ConnectionError(f"the connection ended after {at} of {total} bytes")

    def _check_size(self, size: int) -> None:
        if size > self.limit:
            message = f"has more than {self.limit / 1e6:.6g} MB"
            raise DownloadError(TOO_LARGE, message, "raise the limits with --max-size MB and --max-total MB")

    def _read_notes(self) -> dict[str, Any]:
        with suppress(OSError, ValueError):
            found = json.loads(read_input_text(self.notes, 1 << 16))
            if isinstance(found, dict):
                return found
        return {}

    def _write_notes(self, version: int | None, headers: HTTPMessage) -> None:
        tag = headers.get("ETag", "")
        validator = tag if tag.startswith('"') else headers.get("Last-Modified", "")  # a weak tag is not allowed
        self.notes.write_text(json.dumps({"version": version, "validator": validator}), encoding="utf-8")


def _version(headers: HTTPMessage) -> int | None:
    texts = (headers.get(name, "").strip() for name in _VERSION_HEADERS)
    return next((int(t) for t in texts if t.isascii() and t.isdigit() and len(t) < 10 and int(t)), None)


def _length(headers: HTTPMessage) -> int | None:
    text = headers.get("Content-Length", "").strip()
    return int(text) if text.isascii() and text.isdigit() and len(text) < 19 else None


def _network_error(address: str, error: Exception, place: str) -> DownloadError:
    server = "://".join(urlsplit(address)[:2])
    if isinstance(error, HTTPError):
        return DownloadError(NETWORK, f"{server} answers with an error (HTTP {error.code})", "try again later")
    is_unreachable = isinstance(error, _NoAnswerError)
    reason = error.reason if isinstance(error, _NoAnswerError) else error
    text = getattr(reason, "strerror", None) or str(reason) or type(reason).__name__
    message = f"cannot reach {server}: {text}" if is_unreachable else f"the download broke off{place}: {text}"
    hint = (
        "run the command again: it continues where it stopped"
        if place
        else "run `simkit fetch` again when the network works"
    )
    return DownloadError(NETWORK, message, hint, is_unreachable=is_unreachable)
