"""Server of the page: HTTP and WebSocket in a thread of its own, which never uses the simulation."""

from __future__ import annotations

import asyncio
import json
import mimetypes
import queue
import threading
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import dataclass, field
from http import HTTPStatus
from pathlib import Path
from typing import Final, TypeVarTuple

from websockets.asyncio.server import ServerConnection, broadcast, serve
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from simkit.bridges.live.request_fields import CODE, RequestRefused, read_field, read_identifier, read_json
from simkit.run_spec import JsonObject
from simkit_view.web.access import has_token, is_own_origin, quiet_logger, split_address

PAGE: Final = Path(__file__).parent / "page"
_PUBLIC: Final = ("/app.js", "/app.css", "/icon.svg")
_POLICY: Final = "; ".join(
    (
        "default-src 'none'",
        "script-src 'self'",
        "style-src 'self'",
        "img-src 'self' blob: data:",
        "connect-src 'self'",
        "base-uri 'none'",
        "form-action 'none'",
        "frame-ancestors 'self' http://127.0.0.1:* http://localhost:*",  # a notebook shows the page in a frame
    )
)
_LARGEST_REQUEST: Final = 1 << 20  # [bytes]
_MOST_CLIENTS: Final = 64
_MOST_REQUESTS: Final = 256  # requests of all clients that wait for the simulation; further ones are refused
_MOST_ANSWERS: Final = 512  # answers that wait for a client; a client that does not read them is disconnected
_FOR_ALL: Final = ("scene_changed", "state", "appearance")  # streams that each page gets, in this order

Arguments = TypeVarTuple("Arguments")
Wants = Mapping[str, object]


@dataclass(eq=False)
class PageClient:
    """Connection of one page.

    Attributes:
        wants: streams that the page shows, with their options.
        slots: newest packet of each stream that was not sent yet.
        answers: answers and notifications that were not sent yet.
        is_due: event that is set while something waits.
        is_busy: True while packets that have waited are being sent.
    """

    wants: Wants = field(default_factory=dict)
    slots: dict[str, bytes] = field(default_factory=dict)
    answers: list[str] = field(default_factory=list)
    is_due: asyncio.Event = field(default_factory=asyncio.Event)
    is_busy: bool = False


@dataclass(frozen=True, eq=False)
class PageRequest:
    """Request of a page, which the simulation's thread executes."""

    client: PageClient
    content: JsonObject


class PageServer:
    """Server of the page.

    Args:
        host: address to bind to.
        port: port; 0 for a free one.
        token: token that the address of the page contains.

    Attributes:
        port: port in use.
        requests: requests that wait for the simulation.
        wants: options of each stream that a page shows, by stream; replaced as a whole.

    Raises:
        OSError: the address cannot be used.
    """

    def __init__(self, host: str, port: int, token: str) -> None:
        self._host, self._token = host, token
        self.port = port
        self.requests: queue.Queue[PageRequest] = queue.Queue(_MOST_REQUESTS)
        self.wants: Mapping[str, list[object]] = {}
        self._clients: dict[PageClient, ServerConnection] = {}
        self._newest: dict[str, bytes] = {}
        self._scene = self._recording = b""
        ready: Future[None] = Future()
        self._thread = threading.Thread(target=self._run, args=(ready,), name="simkit view", daemon=True)
        self._thread.start()
        ready.result()

    @property
    def client_count(self) -> int:
        """Number of connected pages."""
        return len(self._clients)

    # ------------------------------------------------------------------ called by the simulation's thread

    def set_scene(self, packed: bytes) -> None:
        """Set the scene, compressed with gzip, that pages load from now on."""
        self._scene = packed

    def set_recording(self, packed: bytes) -> None:
        """Set the recording, compressed with gzip, that pages play."""
        self._recording = packed

    def send(self, packets: Mapping[str, bytes]) -> None:
        """Send packets to the pages that show their streams; each replaces an older packet that waits."""
        self._call(self._offer, packets)

    def answer(self, client: PageClient, content: Mapping[str, object]) -> None:
        """Send an answer to one page, or a notification."""
        self._call(self._queue_answer, client, json.dumps(content, default=str))

    def close(self) -> None:
        """Disconnect all pages and end the thread."""
        self._call(self._end.set)
        self._thread.join(5)

    def _call(self, function: Callable[[*Arguments], object], *args: *Arguments) -> None:
        with suppress(RuntimeError):  # the thread has ended
            self._loop.call_soon_threadsafe(function, *args)

    # ------------------------------------------------------------------ the thread

    def _run(self, ready: Future[None]) -> None:
        try:
            asyncio.run(self._serve(ready))
        except BaseException as error:
            if ready.done():
                raise
            ready.set_exception(error)

    async def _serve(self, ready: Future[None]) -> None:
        self._loop, self._end = asyncio.get_running_loop(), asyncio.Event()
        server = await serve(
            self._talk,
            self._host,
            self.port,
            process_request=self._answer_http,
            max_size=_LARGEST_REQUEST,
            max_queue=16,
            write_limit=1 << 18,
            compression=None,
            close_timeout=1,
            logger=quiet_logger("simkit.view"),  # a port that is opened and closed is not worth a line
        )
        self.port = next(iter(server.sockets)).getsockname()[1]
        ready.set_result(None)
        await self._end.wait()
        server.close()
        await server.wait_closed()

    def _offer(self, packets: Mapping[str, bytes]) -> None:
        self._newest |= packets
        for client in self._clients:
            wanted = {s: packet for s, packet in packets.items() if s in client.wants or s in _FOR_ALL}
            if wanted and not self._send_at_once(client, wanted):
                client.slots |= wanted
                client.is_due.set()

    def _send_at_once(self, client: PageClient, packets: Mapping[str, bytes]) -> bool:
        """Send packets to a page for which nothing waits; return False otherwise. Waking its task would cost more."""
        socket = self._clients[client]
        if client.is_due.is_set() or client.is_busy or socket.transport.get_write_buffer_size():
            return False
        for packet in packets.values():
            broadcast((socket,), packet)
        return True

    def _queue_answer(self, client: PageClient, text: str) -> None:
        client.answers.append(text)
        client.is_due.set()
        if len(client.answers) > _MOST_ANSWERS and client in self._clients:
            client.answers.clear()
            self._clients[client].transport.abort()

    # ------------------------------------------------------------------ HTTP

    def _answer_http(self, connection: ServerConnection, request: Request) -> Response | None:
        """Return the answer to a request; None if the connection becomes a WebSocket."""
        hosts, origins = request.headers.get_all("Host"), request.headers.get_all("Origin")
        address = split_address(request.path)
        if address is None or len(hosts) > 1 or len(origins) > 1:
            return _response(HTTPStatus.BAD_REQUEST, b"the request is malformed\n")
        host, origin = "".join(hosts), origins[0] if origins else None
        if not is_own_origin(origin, host):  # the Host may be that of a proxy, so only the token protects the scene
            return _response(HTTPStatus.FORBIDDEN, b"requests of other pages are refused\n")
        path = address.path
        if path in _PUBLIC:
            return _file(path[1:])
        if not has_token(request.path, self._token):
            return _response(HTTPStatus.FORBIDDEN, b"the token is missing: open the address as simkit printed it\n")
        if path == "/ws":
            if len(self._clients) >= _MOST_CLIENTS:
                return _response(HTTPStatus.SERVICE_UNAVAILABLE, b"too many pages are open\n")
            return None
        if path == "/":
            return _file("index.html")
        if path == "/scene":
            return _response(HTTPStatus.OK, self._scene, "application/octet-stream", is_packed=True)
        if path == "/recording" and self._recording:
            return _response(HTTPStatus.OK, self._recording, "application/octet-stream", is_packed=True)
        return _response(HTTPStatus.NOT_FOUND, b"not found\n")

    # ------------------------------------------------------------------ WebSocket

    async def _talk(self, socket: ServerConnection) -> None:
        client = PageClient()
        self._clients[client] = socket
        client.slots |= {stream: packet for stream, packet in self._newest.items() if stream in _FOR_ALL}
        client.is_due.set()
        sender = asyncio.create_task(self._send(client, socket))
        try:
            async for text in socket:
                self._take(client, text)
                await asyncio.sleep(0)  # a page that floods does not stop the others
        finally:
            sender.cancel()
            del self._clients[client]
            self._note_wants()
            with suppress(queue.Full):
                self.requests.put_nowait(PageRequest(client, {"do": "left"}))

    async def _send(self, client: PageClient, socket: ServerConnection) -> None:
        while True:
            await client.is_due.wait()
            client.is_due.clear()
            answers, client.answers = client.answers, []
            slots, client.slots = client.slots, {}
            client.is_busy = True
            for data in (*answers, *slots.values()):
                await socket.send(data)
            client.is_busy = False

    def _take(self, client: PageClient, text: str | bytes) -> None:
        """Queue a request for the simulation, or answer it with an error."""
        try:
            content = read_json(text)
            if not isinstance(content, dict):
                raise RequestRefused("a request is a JSON object with the name `do`")
            name, number = read_field(content, "do", str), read_identifier(content)
        except RequestRefused as error:
            self._queue_answer(client, json.dumps({"error": str(error), "code": error.code}))
            return
        if name == "want":
            wants = content.get("streams")
            if isinstance(wants, dict):
                added = wants.keys() - client.wants.keys()
                client.wants = wants
                client.slots |= {s: self._newest[s] for s in added if s in self._newest}
                client.is_due.set()
                self._note_wants()
            return
        try:
            self.requests.put_nowait(PageRequest(client, content))
        except queue.Full:
            self._queue_answer(
                client, json.dumps({"id": number, "error": "the simulation is busy; try again", "code": CODE})
            )

    def _note_wants(self) -> None:
        wants: dict[str, list[object]] = {}
        for client in self._clients:
            for stream, options in client.wants.items():
                wants.setdefault(stream, []).append(options)
        for stream in [s for s in self._newest if s not in wants and s not in _FOR_ALL]:
            del self._newest[stream]
        self.wants = wants


def page_file(name: str) -> bytes:
    """Return a file of the page."""
    return (PAGE / name).read_bytes()


def _file(name: str) -> Response:
    kind = mimetypes.guess_type(name)[0] or "application/octet-stream"
    kind = {"app.js": "text/javascript; charset=utf-8", "index.html": "text/html; charset=utf-8"}.get(name, kind)
    return _response(HTTPStatus.OK, page_file(name), kind)


def _response(
    status: HTTPStatus, body: bytes, kind: str = "text/plain; charset=utf-8", *, is_packed: bool = False
) -> Response:
    headers = Headers()
    headers["Content-Type"] = kind
    headers["Content-Length"] = str(len(body))
    headers["Cache-Control"] = "no-store"
    headers["X-Content-Type-Options"] = "nosniff"
    headers["Referrer-Policy"] = "no-referrer"
    headers["Cross-Origin-Resource-Policy"] = "same-origin"
    headers["Content-Security-Policy"] = _POLICY
    headers["Connection"] = "close"
    if is_packed:
        headers["Content-Encoding"] = "gzip"
    return Response(status, status.phrase, headers, body)
