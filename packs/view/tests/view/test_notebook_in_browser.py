"""The page in a notebook's frame, directly and behind a proxy that adds a prefix to its addresses."""

from __future__ import annotations

import socketserver
import threading
import time
from contextlib import suppress
from socket import SHUT_WR, create_connection, socket
from typing import Any

import pytest

import simkit
from packs.view.tests.view.conftest import YARD
from packs.view.tests.view.test_browser import TIMEOUT, browser  # noqa: F401 - a fixture

pytestmark = pytest.mark.browser
NOTEBOOK = """<!doctype html><html><head><title>notebook</title>
<script id="jupyter-config-data" type="application/json">{"baseUrl": "/user/ann/"}</script></head><body>"""


class Notebook(socketserver.ThreadingTCPServer):
    """Server of a notebook with one output; it may pass pages on as jupyter-server-proxy does, with their headers.

    Attributes:
        text: HTML of the notebook.
        passes_on: serve `/user/ann/proxy/PORT/…` from that port.
    """

    daemon_threads = True

    def __init__(self, output: str, passes_on: bool) -> None:
        self.text, self.passes_on = NOTEBOOK + output, passes_on
        super().__init__(("127.0.0.1", 0), Exchange)
        threading.Thread(target=self.serve_forever, args=(0.05,), daemon=True).start()


class Exchange(socketserver.StreamRequestHandler):
    """One connection of the browser."""

    server: Notebook

    def handle(self) -> None:
        lines = [self.rfile.readline()]
        while lines[-1] not in (b"\r\n", b""):
            lines.append(self.rfile.readline())
        method, path, version = lines[0].decode().split() if lines[0] else ("", "", "")
        if path == "/user/ann/lab":
            self._answer("200 OK", self.server.text.encode())
        elif path.startswith("/user/ann/proxy/") and self.server.passes_on:
            port, _, below = path.removeprefix("/user/ann/proxy/").partition("/")
            self._pass_on(int(port), f"{method} /{below} {version}\r\n".encode() + b"".join(lines[1:]))
        else:
            self._answer("404 Not Found", b"")

    def _answer(self, status: str, body: bytes) -> None:
        head = (
            f"HTTP/1.1 {status}\r\nContent-Type: text/html\r\nContent-Length: {len(body)}\r\nConnection: close\r\n\r\n"
        )
        self.wfile.write(head.encode() + body)

    def _pass_on(self, port: int, head: bytes) -> None:
        with create_connection(("127.0.0.1", port)) as page:
            page.sendall(head)
            threading.Thread(target=copy, args=(self.connection, page), daemon=True).start()
            copy(page, self.connection)


def copy(source: socket, target: socket) -> None:
    """Copy what arrives until one side closes."""
    with suppress(OSError):
        while data := source.recv(1 << 16):
            target.sendall(data)
        target.shutdown(SHUT_WR)


@pytest.mark.parametrize(
    "host, passes_on",
    [("hub.localhost", True), ("127.0.0.1", False)],
    ids=["behind a proxy under another name", "on this machine"],
)
def test_a_notebook_shows_the_live_page_in_a_frame(browser: Any, host: str, passes_on: bool) -> None:  # noqa: F811
    with simkit.load(YARD) as sim:
        address = sim.view()
        port = address.partition("127.0.0.1:")[2].partition("/")[0]
        errors: list[str] = []
        with Notebook(address._repr_html_(), passes_on) as notebook:
            page = browser.new_context().new_page()
            page.on("pageerror", lambda error: errors.append(str(error)))
            here = f"http://{host}:{notebook.server_address[1]}/user/ann/"
            page.goto(f"{here}lab")
            frame = page.frame_locator("iframe[title=simkit]")
            end = time.monotonic() + TIMEOUT / 1000
            while not frame.locator("#link.on").count() and time.monotonic() < end:
                sim.run(0.02)
                page.wait_for_timeout(20)
            assert frame.locator("#link.on").count() == 1
            root = f"{here}proxy/{port}/" if passes_on else f"http://127.0.0.1:{port}/"
            assert page.locator("iframe").get_attribute("src") == root + address[address.index("?") :]
            assert errors == []
            page.context.close()
            notebook.shutdown()
