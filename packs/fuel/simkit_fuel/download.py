"""Download of a file over HTTP: with limits, resumed after a broken connection, and only from the named server."""

from __future__ import annotations

import ipaddress
import json
import math
import os
import re
from collections.abc import Callable, Mapping
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from http.client import HTTPException, HTTPMessage
from io import BufferedRandom
from pathlib import Path
from typing import IO, Any
from urllib.error import HTTPError, URLError
from urllib.parse import urlsplit
from urllib.request import HTTPRedirectHandler, OpenerDirector, ProxyHandler, Request, build_opener

from simkit import __version__
from simkit.extend import counted
from simkit.input_file import read_input_text
from simkit.json_reader import parse_json
from simkit.progress import Task
from simkit_fuel.timed_request import RequestLimits, timed_handlers

MISSING, REFUSED, TOO_LARGE, NETWORK = "SK-FETCH-001", "SK-FETCH-002", "SK-FETCH-003", "SK-FETCH-006"
_CHUNK = 1 << 16  # [bytes]
_MOST_ATTEMPTS = 10
_MOST_VALIDATOR = 1000  # characters
_VERSION_HEADERS = ("X-Ign-Resource-Version", "X-Gz-Resource-Version")
_RANGE = re.compile(r"bytes (\d{1,18})-\d{1,18}/(\d{1,18})")


class DownloadError(Exception):
    """Failed download.

    Attributes:
        code: code of the diagnostic.
        hint: remedy.
        is_unreachable: true if the server gave no answer, or no complete one in time.
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
        timeout: longest time [s] until the headers of an answer are complete, and then for each 100 kB of content.
        allow_http: allows connections without encryption to other computers.
        end: time of `time.monotonic` at which all requests end.
    """

    timeout: float = 30.0
    allow_http: bool = False
    end: float = math.inf

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
        limits = RequestLimits(self.timeout, self.end)
        with ExitStack() as failure:
            failure.callback(limits.close)
            response = self._send(address, {**agent, **headers}, limits)
            failure.pop_all()
        limits.begin_content()
        return response

    def _send(self, address: str, headers: Mapping[str, str], limits: RequestLimits) -> Any:
        try:
            return _opener(address, limits).open(Request(address, headers=dict(headers)))
        except HTTPError as error:
            error.close()
            if error.code in (408, 416, 425, 429) or error.code >= 500:
                raise
            server = urlsplit(address).netloc
            reason = {404: "does not have it", 410: "does not have it any more", 401: "does not give it without login"}
            text = f"{server} {reason.get(error.code, 'does not give it')} (HTTP {error.code})"
            raise DownloadError(MISSING, text, "check the owner, the name and the version in the URL") from None
        except (OSError, HTTPException, ValueError) as error:  # a ValueError means an invalid address in a redirect
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


def _opener(address: str, limits: RequestLimits) -> OpenerDirector:
    """Return an opener; a proxy of the environment is used, except for servers on this computer."""
    direct = [ProxyHandler({})] if is_loopback(urlsplit(address).hostname or "") else []
    return build_opener(_SameServer, *timed_handlers(limits), *direct)


def remote_size(address: str, connection: Connection) -> tuple[int | None, int | None]:
    """Return the version and the size [bytes] of a file on a server, without downloading the file.

    Raises:
        DownloadError: the server does not have the file, or does not answer.
    """
    try:
        with connection.open(address, {"Range": "bytes=0-0"}) as response:
            match = _RANGE.fullmatch(response.headers.get("Content-Range", ""))
            return _version(response.headers), int(match[2]) if match else _length(response.headers)
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
        attempts, has_restarted = 0, False
        while True:
            attempts += 1
            before = self.file.seek(0, os.SEEK_END)
            try:
                return self._receive(before)
            except (OSError, HTTPException) as error:
                size = self.file.seek(0, os.SEEK_END)
                if isinstance(error, HTTPError) and error.code == 416 and before and not has_restarted:
                    self.file.truncate(0)  # the beginning does not belong to the file that the server has now
                    has_restarted = True
                elif size <= before or attempts == _MOST_ATTEMPTS or isinstance(error, TimeoutError):
                    raise _network_error(
                        self.address, error, f" after {counted(size, 'byte')}" if size else ""
                    ) from None

    def _receive(self, at: int) -> tuple[int | None, bool]:
        """Request the part of the file that is not there yet, and append it."""
        notes = self._read_notes() if at else {}
        headers = {"Range": f"bytes={at}-"} if at else {}
        if notes.get("validator"):
            headers["If-Range"] = str(notes["validator"])
        with self.connection.open(self.address, headers) as response:
            version, length = _version(response.headers), _length(response.headers)
            total = None if length is None else at + length
            if response.status == 206:
                match = _RANGE.fullmatch(response.headers.get("Content-Range", ""))
                if not at:
                    raise ConnectionError("the server sends a part of the file instead of the whole file")
                here = {"version": version, "validator": _validator(response.headers) or notes.get("validator")}
                if not match or int(match[1]) != at or total not in (None, int(match[2])) or here != notes:
                    self.file.truncate(0)
                    return self._receive(0)
                total = int(match[2])
            else:
                self.file.truncate(0)
                at, total = 0, length
                self._write_notes(version, response.headers)
            self._check_size(total or at)
            if not self._is_needed(version):
                return version, False
            self._task.total = None if total is None else total / 1e6
            self._append(response, at, total)
        return version, True

    def _append(self, response: Any, at: int, total: int | None) -> None:
        while piece := response.read1(_CHUNK):
            self.file.write(piece)
            at += len(piece)
            self._check_size(at)
            self._task.done = at / 1e6
        self.file.flush()
        if total is not None and at != total:
            raise ConnectionError(f"the connection ended after {at} of {counted(total, 'byte')}")

    def _check_size(self, size: int) -> None:
        if size > self.limit:
            message = f"has more than {self.limit / 1e6:.6g} MB"
            raise DownloadError(TOO_LARGE, message, "raise the limits with --max-size MB and --max-total MB")

    def _read_notes(self) -> dict[str, Any]:
        with suppress(OSError, ValueError):
            notes = parse_json(read_input_text(self.notes, 1 << 16))
            if isinstance(notes, dict):
                return notes
        return {}

    def _write_notes(self, version: int | None, headers: HTTPMessage) -> None:
        self.notes.write_text(json.dumps({"version": version, "validator": _validator(headers)}), encoding="utf-8")


def _validator(headers: HTTPMessage) -> str:
    """Return the text that identifies the content of a file on the server; a weak tag does not."""
    tag = headers.get("ETag", "")
    text = tag if tag.startswith('"') else headers.get("Last-Modified", "")
    return text if text.isascii() and text.isprintable() and len(text) <= _MOST_VALIDATOR else ""


def _version(headers: HTTPMessage) -> int | None:
    texts = (headers.get(name, "").strip() for name in _VERSION_HEADERS)
    return next((int(t) for t in texts if t.isascii() and t.isdigit() and len(t) < 10 and int(t)), None)


def _length(headers: HTTPMessage) -> int | None:
    """Return the stated size of the content [bytes]; None if the server states no size.

    Raises:
        ConnectionError: the size is not a number, or has more than 18 digits.
    """
    text = headers.get("Content-Length", "").strip()
    if text and not (text.isascii() and text.isdigit() and len(text) < 19):
        raise ConnectionError(f"the server states the size {text!r:.40}")
    return int(text) if text else None


def _network_error(address: str, error: Exception, place: str) -> DownloadError:
    server = "://".join(urlsplit(address)[:2])
    if isinstance(error, HTTPError):
        return DownloadError(NETWORK, f"{server} answers with an error (HTTP {error.code})", "try again later")
    has_no_answer = isinstance(error, _NoAnswerError)
    reason = error.reason if isinstance(error, _NoAnswerError) else error
    text = getattr(reason, "strerror", None) or str(reason) or type(reason).__name__
    message = f"cannot reach {server}: {text}" if has_no_answer else f"the download broke off{place}: {text}"
    hint = (
        "run the command again: it continues where it stopped"
        if place
        else "run `simkit fetch` again when the network works"
    )
    is_unreachable = has_no_answer or isinstance(error, TimeoutError)
    return DownloadError(NETWORK, message, hint, is_unreachable=is_unreachable)
