"""WebSocket server of a simulation: one connection to the simulation for each client, and the simulation's graph."""

from __future__ import annotations

import asyncio
import os
import struct
import sys
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from http import HTTPStatus
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit.bridges.bridge_program import begin, run_until_end, tell
from simkit.bridges.live.protocol import LARGEST_IN, JsonObject, LiveClosed, LiveError
from simkit.bridges.live.request_fields import CODE, client_text
from simkit.bridges.simulation_link import DEPTH, Failed, SimulationLink, Then
from simkit.extend import counted
from simkit_view.web.access import has_token, is_known_origin, is_token, quiet_logger, split_address
from simkit_view.web.web_process import TOKEN_VARIABLE

if TYPE_CHECKING:
    from websockets.asyncio.server import ServerConnection
    from websockets.http11 import Request, Response

_GRAPH_PERIOD: Final = 0.25  # [s] between two looks at the simulation's graph
_CLOGGED_WAIT: Final = 0.01  # [s] between two looks at a connection that takes nothing
_MOST_BYTES: Final = 1 << 20  # [bytes] for the simulation above which nothing is read from the client
_MOST_ANSWERS: Final = 1000  # unsent data for the client above which nothing is read from it
_LAST_WAIT: Final = 1.0  # [s] for sending the last messages
_BATCH: Final = 1 << 16  # [bytes] of frames that are sent in one call of the system
_TEXT, _BINARY = 0x81, 0x82  # first byte of a whole frame
_LONGEST_REASON: Final = 100  # characters; a WebSocket has room for 123 bytes


def text_frame(text: str) -> bytes:
    """Return the WebSocket frame of a text for a client."""
    return _frame(_TEXT, text.encode())


def binary_frame(*parts: bytes) -> bytes:
    """Return the WebSocket frame of binary data for a client, given in parts."""
    return _frame(_BINARY, *parts)


def _frame(kind: int, *parts: bytes) -> bytes:
    size = sum(map(len, parts))
    if size < 126:
        head = bytes((kind, size))
    elif size < 1 << 16:
        head = struct.pack(">BBH", kind, 126, size)
    else:
        head = struct.pack(">BBQ", kind, 127, size)
    return b"".join((head, *parts))


class WebLink(SimulationLink):
    """Connection to the simulation that an event loop serves.

    An error in a callback, because the client asked for something odd, is reported to this client and ends nothing.

    Attributes:
        is_due: event that is set when data have arrived or are to be sent to the client.
        report_failure: function that receives the text of an error in a callback.
    """

    report_failure: Callable[[str], None] = staticmethod(lambda text: tell(note=text))

    def ask(
        self,
        question: str,
        args: JsonObject,
        data: bytes = b"",
        then: Then | None = None,
        failed: Failed | None = None,
    ) -> None:
        """Send a request; an error in `then` counts as an error of the request; see `SimulationLink.ask`."""

        def fail(error: LiveError) -> None:
            if failed is not None:
                failed(error)

        def end(text: str) -> None:
            if failed is None:
                self.report_failure(text)
            else:
                failed(LiveError(CODE, text))

        super().ask(question, args, data, self.guarded(then or (lambda *_: None), end), self.guarded(fail))

    def subscribe(
        self, topic: str, take: Callable[[int, str, bytes, int], None], failed: Failed, depth: int = DEPTH
    ) -> int:
        """Subscribe to a topic; return the number of the subscription."""
        return super().subscribe(topic, self.guarded(take), failed, depth)

    def guarded(self, call: Callable[..., None], end: Callable[[str], None] | None = None) -> Callable[..., None]:
        """Return a callback whose errors go to `end`, or to `report_failure`; that the simulation ends is no error."""

        def guarded_call(*args: object) -> None:
            try:
                call(*args)
            except LiveClosed:
                raise
            except Exception as error:  # noqa: BLE001 - the client may have asked for anything
                (end or self.report_failure)(client_text(error))

        return guarded_call

    def attach(self) -> None:
        """Begin to use the event loop that runs; requests before this call wait for their answers."""
        self._loop, self._outbox, self.is_due = asyncio.get_running_loop(), bytearray(), asyncio.Event()
        self._is_readable = False
        self._socket.setblocking(False)
        self._file = self._socket.fileno()
        self._loop.add_reader(self._file, self._note_data)

    def _note_data(self) -> None:
        self._loop.remove_reader(self._file)  # until the data are read: a client may take a long time for the last
        self._is_readable = True
        self.is_due.set()

    def receive_ready(self) -> None:
        """Process the data that have arrived.

        Raises:
            LiveClosed: the simulation has ended, or has closed the connection.
        """
        if self._is_readable:
            self._is_readable = False
            try:
                self.receive(0.0)
                self.dispatch_answers()
                if self.is_closed:
                    self.receive(0.0)  # raises the reason
            except LiveClosed:
                self._loop.remove_writer(self._file)  # at once, because another connection may get the number
                raise
            self._loop.add_reader(self._file, self._note_data)

    def send(self, frame: bytes) -> None:
        """Queue a whole frame; see `ServerLink.send`."""
        if not hasattr(self, "_outbox"):
            super().send(frame)
            return
        if self._closed is not None:
            raise self._closed
        if len(frame) > LARGEST_IN:
            raise LiveError("SK-LIVE-008", f"the message has {counted(len(frame), 'byte')}; the limit is {LARGEST_IN}")
        self._outbox += frame
        if len(self._outbox) == len(frame):
            self._flush()

    def _flush(self) -> None:
        try:
            while self._outbox:
                del self._outbox[: self._socket.send(self._outbox)]
        except BlockingIOError:
            self._loop.add_writer(self._file, self._flush)
            return
        except OSError:
            self._outbox.clear()  # the reason arrives with the next data
        self._loop.remove_writer(self._file)

    @property
    def is_full(self) -> bool:
        """True while the simulation does not take what was sent."""
        return len(self._outbox) > _MOST_BYTES

    def close(self) -> None:
        """Close the connection, with everything that was opened on it."""
        if not self.is_closed and hasattr(self, "_loop"):
            self._loop.remove_reader(self._file)
            self._loop.remove_writer(self._file)
        super().close()


class WebClient:
    """Client of a WebSocket server.

    Args:
        server: server.
        socket: WebSocket.
        link: connection to the simulation, for this client only.
        is_allowed: True if the client has sent the token, or needs none.
    """

    can_authenticate_later = False
    """True if a client may send the token in a message."""

    def __init__(self, server: WebServer, socket: ServerConnection, link: WebLink, *, is_allowed: bool) -> None:
        self.server, self.socket, self.link, self.is_allowed = server, socket, link, is_allowed
        self._waiting: deque[bytes] = deque()  # frames
        link.report_failure = self.report_error

    def report_error(self, text: str) -> None:
        """Send an error to the client."""
        raise NotImplementedError

    def take(self, data: str | bytes) -> None:
        """Process a message of the client."""
        raise NotImplementedError

    def apply_graph(self) -> None:
        """Process a change of the simulation's graph, `server.graph`."""

    def apply_time(self, time_ns: int) -> None:
        """Process the simulated time [ns], which the server asks for regularly."""

    def send(self, frame: bytes) -> None:
        """Queue a frame for the client, which `text_frame` or `binary_frame` has made."""
        self._waiting.append(frame)
        self.link.is_due.set()

    async def run(self) -> None:
        """Pass data in both directions until one side ends."""
        from websockets.exceptions import ConnectionClosed

        self.link.guarded(self.apply_graph)()
        tasks = [asyncio.create_task(self._read()), asyncio.create_task(self._write())]
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in tasks:
                task.cancel()
        for result in await asyncio.gather(*tasks, return_exceptions=True):
            if isinstance(result, LiveClosed):
                await self.socket.close(1001, str(result)[:_LONGEST_REASON])
            elif isinstance(result, Exception) and not isinstance(result, ConnectionClosed):  # the client has gone
                raise result

    async def _read(self) -> None:
        async for data in self.socket:
            while self.link.is_full or len(self._waiting) > _MOST_ANSWERS:
                await asyncio.sleep(_CLOGGED_WAIT)
            self.take(data)
            await asyncio.sleep(0)  # a client that floods must not stop the others

    async def _write(self) -> None:
        closed: LiveClosed | None = None
        while closed is None:
            try:
                self.link.receive_ready()
            except LiveClosed as error:
                closed = error
            # the simulation drops messages of each subscription while the client does not read these
            while self._waiting:
                await self._send_batch()
            if closed is None:
                await self.link.is_due.wait()
                self.link.is_due.clear()
        raise closed

    async def _send_batch(self) -> None:
        """Send the first waiting frames. `socket.send` would call the system for each, which also wakes the client."""
        waiting, frames, size = self._waiting, list[bytes](), 0
        while waiting and size < _BATCH:
            frames.append(waiting.popleft())
            size += len(frames[-1])
        async with self.socket.send_context():
            self.socket.transport.write(b"".join(frames))


class WebServer:
    """WebSocket server of a running simulation.

    Args:
        name: name of the server in the simulation's node lists.
        settings: `socket`, the path of the simulation's socket, `host`, `port` and `token`.
        client: class of the clients.
        subprotocols: WebSocket protocols, of which a client must name one; empty for none.

    Attributes:
        graph: topics, services, actions and robots of the simulation.
    """

    def __init__(
        self, name: str, settings: Mapping[str, str], client: type[WebClient], subprotocols: Sequence[str] = ()
    ) -> None:
        self._name, self._settings, self._class, self._subprotocols = name, settings, client, subprotocols
        self._link = self._connect()
        self.graph: JsonObject = self._link.request("graph", {})[0]
        self._clients: dict[WebClient, asyncio.Task[None]] = {}

    @property
    def has_many_clients(self) -> bool:
        """True if more than one client is connected."""
        return len(self._clients) > 1

    @property
    def simulation(self) -> JsonObject:
        """`name`, `world`, `pid` and `version` of the simulation."""
        return self._link.info

    def _connect(self) -> WebLink:
        return WebLink(Path(self._settings["socket"]), lambda text: tell(note=text), self._name)

    async def run(self) -> None:
        """Serve clients until the simulation ends.

        Raises:
            LiveClosed: the simulation has ended.
            SystemExit: the address cannot be used.
        """
        from websockets.asyncio.server import serve

        host, port = self._settings["host"], self._settings["port"]
        more = {"subprotocols": self._subprotocols} if self._subprotocols else {}
        self._link.attach()
        try:
            server = await serve(
                self._serve,
                host,
                port,
                process_request=self._check,
                max_size=LARGEST_IN,
                compression=None,
                close_timeout=1,
                logger=quiet_logger("simkit.web"),
                **more,
            )
        except OSError as error:
            tell(error=f"{host}:{port} cannot be used: {os.strerror(error.errno) if error.errno else error}")
            sys.exit(1)
        tell(ready=server.sockets[0].getsockname()[1])
        try:
            await self._follow_simulation()
        finally:
            if self._clients:
                await asyncio.wait(self._clients.values(), timeout=_LAST_WAIT)
            server.close()

    async def _follow_simulation(self) -> None:
        while True:
            self._is_answered = False
            self._link.ask("graph", {"revision": self.graph.get("revision")}, then=self._take_graph)
            while not self._is_answered:
                await self._link.is_due.wait()
                self._link.is_due.clear()
                self._link.receive_ready()
            with suppress(TimeoutError):
                await asyncio.wait_for(self._link.is_due.wait(), _GRAPH_PERIOD)

    def _take_graph(self, graph: JsonObject, _: bytes) -> None:
        self._is_answered = True
        if "topics" in graph:
            self.graph = graph
        self.graph["time_ns"] = graph["time_ns"]
        for client in tuple(self._clients):
            with suppress(LiveClosed):  # its own task ends a client whose connection to the simulation is closed
                if "topics" in graph:
                    client.link.guarded(client.apply_graph)()
                client.link.guarded(client.apply_time)(graph["time_ns"])

    # ------------------------------------------------------------------ clients

    def _has_token(self, path: str) -> bool | None:
        """Check the token in an address; None if the address has none."""
        return has_token(path, self._settings["token"])

    def is_token(self, text: str) -> bool:
        """Check a token that a client has sent in a message."""
        return is_token(text, self._settings["token"])

    def _check(self, connection: ServerConnection, request: Request) -> Response | None:
        """Return the refusal of a client without a right to connect; None for other clients."""
        if len(request.headers.get_all("Origin")) > 1 or split_address(request.path) is None:
            return connection.respond(HTTPStatus.BAD_REQUEST, "the request is malformed\n")
        if self._settings["token"]:
            has_token = self._has_token(request.path)
            if has_token or (has_token is None and self._class.can_authenticate_later):
                return None
            return connection.respond(HTTPStatus.UNAUTHORIZED, "the address needs ?token=TOKEN\n")
        if is_known_origin(request.headers.get("Origin")):
            return None
        text = f"pages of other servers need a token: set {TOKEN_VARIABLE} and add ?token=TOKEN to the address\n"
        return connection.respond(HTTPStatus.FORBIDDEN, text)

    async def _serve(self, socket: ServerConnection) -> None:
        try:
            link = await asyncio.to_thread(self._connect)
            link.attach()
        except LiveError as error:
            await socket.close(1013, str(error)[:_LONGEST_REASON])
            return
        is_allowed = not self._settings["token"] or bool(self._has_token(socket.request.path))
        client = self._class(self, socket, link, is_allowed=is_allowed)
        task = asyncio.current_task()
        assert task is not None
        self._clients[client] = task
        try:
            await client.run()
        finally:
            del self._clients[client]
            link.close()


def run_server(make: Callable[[], WebServer]) -> int:
    """Run a server in this process until the simulation ends; return the exit code."""
    begin()
    return run_until_end(lambda: asyncio.run(make().run()))
