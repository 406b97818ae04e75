"""Server on this computer that speaks the interface of Fuel, and helpers for tests of `simkit fetch`."""

from __future__ import annotations

import io
import json
import re
import threading
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from typer.testing import CliRunner, Result

from simkit.cli import app

BOX = """<sdf version="1.9"><model name="box"><static>true</static><link name="l"><collision name="c">
<geometry><box><size>1 1 1</size></box></geometry></collision>{}</link></model></sdf>"""


def archive(files: Mapping[str, str | bytes | tuple[zipfile.ZipInfo, bytes]]) -> bytes:
    """Return a ZIP archive."""
    target = io.BytesIO()
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as zipped:
        for name, content in files.items():
            if isinstance(content, tuple):
                zipped.writestr(*content)
            else:
                zipped.writestr(name, content)
    return target.getvalue()


def model(inside: str = "", **more: str | bytes) -> bytes:
    """Return the archive of a model: a box, with more text in its link and more files."""
    files = {"model.config": '<model><name>box</name><sdf version="1.9">model.sdf</sdf></model>'}
    return archive({**files, "model.sdf": BOX.format(inside), **more})


@dataclass
class Fuel:
    """State of the server.

    Attributes:
        archives: path of a resource such as `o/models/box` -> archives of its versions 1, 2, ...
        breaks: number of bytes after which the next answers end.
        headers: headers to add or to replace; None removes one.
        redirect: address to redirect to.
        requests: paths and `Range` headers of all requests.
        status: HTTP status of all answers; 0 for the usual ones.
        ignores_ranges: the server always sends whole files.
        silent: the server accepts requests and does not answer.
    """

    port: int = 0
    archives: dict[str, list[bytes]] = field(default_factory=dict)
    breaks: list[int] = field(default_factory=list)
    headers: dict[str, str | None] = field(default_factory=dict)
    redirect: str = ""
    status: int = 0
    requests: list[tuple[str, str]] = field(default_factory=list)
    ignores_ranges: bool = False
    silent: threading.Event = field(default_factory=threading.Event)

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    def downloads(self) -> list[str]:
        """Return the requests, as `name version`, with the first byte of a resumed one."""
        found = []
        for path, wanted in self.requests:
            _, _, kind, name, version, _ = unquote(path).strip("/").split("/")
            assert kind in ("models", "worlds")
            found.append(f"{name} {version} {wanted.removeprefix('bytes=')}".strip())
        return found


class Handler(BaseHTTPRequestHandler):
    """Answers to `/1.0/OWNER/models/NAME/VERSION/NAME.zip`."""

    fuel: Fuel

    def log_message(self, *_: object) -> None:
        pass

    def do_GET(self) -> None:
        fuel = self.fuel
        wanted = self.headers.get("Range", "")
        fuel.requests.append((self.path, wanted))
        if fuel.silent.is_set():
            self.connection.settimeout(20.0)
            self.connection.recv(1)  # until the client closes the connection
            return
        parts = unquote(self.path).strip("/").split("/")
        versions = fuel.archives.get("/".join(parts[1:4]).lower(), [])
        version = len(versions) if parts[4] == "tip" else int(parts[4])
        is_there = 0 < version <= len(versions) and parts[5] == f"{parts[3]}.zip"
        if fuel.redirect or fuel.status or not is_there:
            self.send_response(302 if fuel.redirect else fuel.status or 404)
            self.send_header("Location", fuel.redirect + (self.path if fuel.redirect.count("/") == 2 else ""))
            self.end_headers()
            if fuel.redirect.count("/") > 2:
                fuel.redirect = ""
            return
        self._send(versions[version - 1], version, wanted)

    def _send(self, content: bytes, version: int, wanted: str) -> None:
        fuel, tag = self.fuel, f'"{version}"'
        start, end = 0, len(content)
        if fuel.ignores_ranges:
            wanted = ""
        if (found := re.fullmatch(r"bytes=(\d+)-(\d*)", wanted)) and self.headers.get("If-Range", tag) == tag:
            start, end = int(found[1]), int(found[2] or len(content) - 1) + 1
        is_part = (start, end) != (0, len(content))
        headers: dict[str, Any] = {"X-Ign-Resource-Version": version, "ETag": tag, "Content-Length": end - start}
        if is_part:
            headers["Content-Range"] = f"bytes {start}-{end - 1}/{len(content)}"
        headers.update(fuel.headers)
        self.send_response(206 if is_part else 200)
        for name, value in headers.items():
            if value is not None:
                self.send_header(name, str(value))
        self.end_headers()
        content = content[start:end]
        self.wfile.write(content[: fuel.breaks.pop(0)] if fuel.breaks and len(content) > 1 else content)


@contextmanager
def served() -> Iterator[Fuel]:
    """Run a server."""
    state = Fuel()
    server = ThreadingHTTPServer(("127.0.0.1", 0), type("BoundHandler", (Handler,), {"fuel": state}))
    server.daemon_threads = True
    state.port = server.server_address[1]
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
    thread.start()
    yield state
    state.silent.clear()
    server.shutdown()
    server.server_close()
    thread.join()


def write_world(*uris: str, name: str = "w.sdf") -> None:
    """Write a world that includes models."""
    includes = "".join(f"<include><uri>{uri}</uri><name>m{i}</name></include>\n" for i, uri in enumerate(uris))
    Path(name).write_text(f'<sdf version="1.9"><world name="w">\n{includes}</world></sdf>')


def run(*words: str) -> Result:
    """Run a command of simkit."""
    return CliRunner().invoke(app, list(words), catch_exceptions=False)


def lock() -> dict[str, dict[str, Any]]:
    """Return the entries of the lock file by the last part of their names."""
    return {entry["name"].split("/")[-1]: entry for entry in json.loads(Path("simkit.lock").read_text())["entries"]}
