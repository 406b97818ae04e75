"""Requests with malformed headers and addresses: a refusal, and no traceback in the output of the run."""

from __future__ import annotations

import re
import socket
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from simkit_view.view.page_server import PageServer
from simkit_view.web.access import has_token, is_known_origin, is_own_origin, is_token

ODD = (
    *("http://[::1", "http://[", "http://]", "http://[::1]:99999", "http://a:b", "http://[v1.x]", "http://[::1]]"),
    *("//[", "http://\udcff", "http://\u2100", "http://a:-1", "http://a:\u0661"),
)
LINES = (
    *("Origin: http://[::1", "Host: [::1", "Host: [", "Host: a:b", "Host: a:99999", "Host: ", "Host: \xff\xfe"),
    *("Host: 127.0.0.1\r\nHost: evil.example", "Origin: http://a\r\nOrigin: http://b", "Origin: http://[::1]:x"),
    *("Sec-WebSocket-Key: x", "Sec-WebSocket-Version: 99", "Connection: ,,,", "Upgrade: \x00", "Content-Length: -1"),
    *("Transfer-Encoding: chunked", ": no name", "no colon", "A: " + "x" * 20000, "\x00"),
    "Sec-WebSocket-Protocol: ,;,",
)
FIRST = (
    *("GET /ws?token=abc HTTP/1.1", "GET http://[::1/ws HTTP/1.1", "GET //[ HTTP/1.1", "POST / HTTP/1.1"),
    *("GET / HTTP/9.9", "GET", "", "\x00", "GET /" + "x" * 20000 + " HTTP/1.1", "GET /\xff HTTP/1.1"),
    "GET /?" + "a&" * 5000 + " HTTP/1.1",
)
REST = "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"


@pytest.mark.parametrize("text", ODD, ids=ascii)
def test_a_malformed_address_is_no_address(text: str) -> None:
    assert not is_known_origin(text) and not is_own_origin(text, "127.0.0.1:1")
    assert not has_token(text, "abc")


def test_a_token_that_is_no_text_is_wrong() -> None:
    assert not is_token("\udcff", "abc") and has_token("/?token=\udcff", "abc") is False
    assert has_token("/?" + "a=1&" * 1000 + "token=abc", "abc") is False


def _answer(port: int, first: str, line: str) -> str:
    """Send a request and return the first line of the answer; empty if the server closes the connection."""
    with socket.create_connection(("127.0.0.1", port), timeout=30) as link:
        own = "" if line.startswith("Host") else f"Host: 127.0.0.1:{port}\r\n"
        key = "" if line.startswith("Sec-WebSocket-Key") else "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
        try:
            link.sendall(f"{first}\r\n{own}{key}{REST}{line}\r\n\r\n".encode("latin-1"))
            return link.recv(200).decode("latin-1").partition("\r\n")[0]
        except ConnectionError:
            return ""


def _requests() -> list[tuple[str, str]]:
    return [(FIRST[0], line) for line in LINES] + [(first, "A: b") for first in FIRST[1:]]


def test_the_page_refuses_malformed_requests(capfd: pytest.CaptureFixture[str]) -> None:
    server = PageServer("127.0.0.1", 0, "abc")
    try:
        answers = {request: _answer(server.port, *request) for request in _requests()}
    finally:
        server.close()
    assert not [r for r, a in answers.items() if re.match(r"HTTP/1.1 5", a)], answers
    assert answers[FIRST[0], "Origin: http://[::1"].startswith("HTTP/1.1 403")
    out, errors = capfd.readouterr()
    assert not out and not errors


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["rosbridge", "foxglove"])
def test_the_web_servers_refuse_malformed_requests(kind: str, court: Path, start_run: Callable[..., Any]) -> None:
    with start_run(court, "--rtf", "1", f"--{kind}=0") as run:
        port = int(run.addresses[kind].rpartition(":")[2].strip("/"))
        answers = {request: _answer(port, *request) for request in _requests()}
        run.process.terminate()
        errors = run.end()[1]
    assert not [r for r, a in answers.items() if re.match(r"HTTP/1.1 5", a)], answers
    assert answers[FIRST[0], "Origin: http://[::1"].startswith("HTTP/1.1 403")
    assert "Traceback" not in errors and "failed" not in errors, errors[-2000:]
