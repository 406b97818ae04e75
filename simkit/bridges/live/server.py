"""Server that `simkit run` opens for clients in other processes. The run polls the server between two slices.

A slice is the group of steps between two polls. The server has no thread of its own. Commands of clients are processed
like calls in the process. The run's bits therefore depend only on the commands and on the ticks at which they arrived.
Reading changes no bits.
"""

from __future__ import annotations

import math
import os
import selectors
import socket
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.bridges.live import socket_files
from simkit.bridges.live.connection import ClientConnection
from simkit.bridges.live.message_reader import message_reader
from simkit.bridges.live.protocol import ASK, NUMBER, PROTOCOL, TELL, BadFrame, JsonObject
from simkit.bridges.live.topic_feed import TopicFeeds
from simkit.errors import SimkitError
from simkit.number_text import counted
from simkit.runtime.communication.command_queue import QUEUE_DEPTH
from simkit.version import __version__

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation

MOST_CLIENTS: Final = 64
_RESERVED_FILES = 16  # files that the run itself may still open: a recording, a module that is imported late
BUDGET: Final = 0.005  # [s] of wall time for clients between two slices
_SLICE, _BUSY_SLICE = 0.4, 0.08  # share of a slice's usual wall time with idle clients, and with busy clients
_REQUESTS_PER_TURN = 64  # frames that are read from one client before the turn of the next client
_LONGEST_HOLD = 0.2  # [s] of wall time, longest pause in reading from a client that avoids dropped commands
_SEND_BYTES = (
    1 << 20
)  # [bytes] of a connection's buffer: one image; in 200 KB, each image waited for its reader 5 times
_MOST_CALLERS = 16  # connections that are accepted in one poll


class Server:
    """Server for other processes of the same user; a context manager.

    Args:
        sim: simulation to serve.
        name: name for clients; default: the world's name. If a simulation has the name, `_2`, `_3`, … is added.

    Attributes:
        name: name of the server, after the addition of a number.
        path: path of the socket.
        feeds: topics that clients subscribe to.
        peers: connections of clients, by file descriptor.
        client_topics: topics that clients created during the run, because nothing in the simulation used them.
        is_polling: True while `poll` processes data.
        client_types: types that clients defined during the run.
        open_view: function that shows the run in a browser and returns the address; None if the run cannot.

    Raises:
        NoSocketFolder: no folder can contain the socket; the message has the reason.
    """

    def __init__(self, sim: Simulation, name: str | None = None) -> None:
        self.sim = sim
        self._listening, self.name, self.path = socket_files.bind(name or sim.world.name)
        self._selector = selectors.DefaultSelector()
        self._listening.register(self._selector)
        self.feeds = TopicFeeds(sim)
        self.peers: dict[int, ClientConnection] = {}
        self.client_topics: set[str] = set()
        self.client_types: set[str] = set()
        self.open_view: Callable[[], str] | None = None
        self._busy: deque[ClientConnection] = deque()
        self._interest: dict[int, int] = {}
        self._numbers, self._first, self.is_polling = 0, 0, False
        self._taken: dict[str, int] = {}
        self._taken_at, self._taken_since = -1, 0.0
        self._fewest = 1  # smallest queue depth for the next step, over all topics
        self._pace = [(time.monotonic(), sim.tick)]

    # ------------------------------------------------------------------ between two slices

    def poll(self, wait: float = 0.0) -> bool:
        """Read the frames of clients, and send the data that is queued for them.

        Call this method repeatedly between two steps, while the simulation runs and while it is paused.

        Args:
            wait: longest wait for a frame [s], wall time.

        Returns:
            True if anything arrived.

        Raises:
            PluginError, SubscriberError, SimulationDiverged: error of a plugin, callback or step that a request caused.
        """
        if self.is_closed:
            return False
        if not self.peers and wait <= 0:
            return self._accept_callers()
        was_polling, self.is_polling = self.is_polling, True
        try:
            return self._exchange_data(wait)
        finally:
            self.is_polling = was_polling

    def _exchange_data(self, wait: float) -> bool:
        """Read and send data; return True if anything arrived."""
        self.feeds.deliver_ready()
        self._send_goal_states()
        for peer in list(self.peers.values()):
            peer.send_requests()
        self._release_held()
        until = time.perf_counter() + BUDGET
        waiting = [p for p in self.peers.values() if p.is_waiting]
        self._first = (self._first + 1) % max(1, len(waiting))  # another client begins each time
        for peer in waiting[self._first :] + waiting[: self._first]:
            self._write(peer, until)
        ready = self._selector.select(0.0 if self._busy else max(0.0, wait))
        for key, mask in ready:
            peer = key.data
            if peer is None:
                self._accept_callers()
                continue
            if mask & selectors.EVENT_WRITE:
                self._write(peer, until)
            if mask & selectors.EVENT_READ and peer.read() and peer not in self._busy:
                self._busy.append(peer)
            if peer.is_gone:
                self._disconnect(peer)
        if self._busy:
            self._serve_busy_clients(time.perf_counter() + BUDGET)
        return bool(ready)

    def fileno(self) -> int:
        """Return a file descriptor for `select`, except on Windows; it is readable when `poll` has work to do."""
        descriptor: int = self._selector.fileno()
        return descriptor

    def measured_rtf(self) -> float:
        """Return the real-time factor over about the last second of wall time."""
        now, tick = time.monotonic(), self.sim.tick
        began, first = self._pace[0]
        if now - self._pace[-1][0] > 0.5:
            self._pace = [self._pace[-1], (now, tick)]
        return max(0, tick - first) * self.sim.timestep / max(now - began, 1e-3)

    @property
    def is_closed(self) -> bool:
        """True if the server accepts no more connections."""
        return self._listening.fileno() < 0

    def slices(self, *lengths: float) -> tuple[float, ...]:
        """Return the lengths of the run's slices [s, wall time], adapted to the connected clients.

        Slices are shorter while clients are connected, and even shorter while clients send many requests.

        Args:
            *lengths: lengths of slices without clients [s, wall time].
        """
        if not self.peers:
            return lengths
        factor = _BUSY_SLICE if self._busy else _SLICE
        return tuple(length * factor for length in lengths)

    def _serve_busy_clients(self, until: float) -> None:
        """Process a few frames of each client in turn, until the time `until` or until no client has frames."""
        busy = self._busy
        try:
            while busy:
                peer = busy.popleft()
                if self._serve(peer, until) and not peer.is_gone:
                    busy.append(peer)
                if peer.is_waiting:
                    self._write(peer, until)
                if time.perf_counter() > until:
                    return
        finally:
            for peer in [p for p in self.peers.values() if p.is_gone]:
                self._disconnect(peer)

    def _serve(self, peer: ClientConnection, until: float) -> bool:
        """Process a few frames of one client, until the time `until`; return True if it may have more frames."""
        from simkit.bridges.live.answering import answer_request  # 4 ms, which a run without clients need not take

        try:
            take, publish = peer.reader.next, self._publish
            for _ in range(_REQUESTS_PER_TURN):
                if peer.is_held or peer.why is not None:
                    return False
                frame = None if peer.is_clogged else take()
                if frame is None:
                    return not peer.is_clogged and peer.read()
                kind, body = frame
                if kind == ASK:
                    answer_request(self, peer, body)
                    if time.perf_counter() > until:
                        return True
                else:
                    publish(peer, body)
        except BadFrame as error:
            self.refuse(peer, f"not a simkit client: {error}", "SK-LIVE-006")
            return False
        return True

    # ------------------------------------------------------------------ received frames

    def _publish(self, peer: ClientConnection, body: bytes) -> None:
        publisher = peer.publishers.get(NUMBER.unpack_from(body)[0] if len(body) >= 4 else -1)
        if publisher is None:
            raise BadFrame("a message without a publisher")
        try:
            message = message_reader(publisher.type_name)(body, 4)
        except Exception as error:
            if peer.is_bridge:
                peer.send_json(TELL, {"tell": "invalid", "topic": publisher.topic, "type": publisher.type_name})
                return
            raise BadFrame(f"the data on {publisher.topic!r} is not a valid {publisher.type_name}") from error
        self.feeds.memory.publishing = peer if peer.skips_own else None
        try:
            publisher.publish(message)
        finally:
            self.feeds.memory.publishing = None
        self._hold_back_if_full(peer, publisher.topic)

    def _hold_back_if_full(self, peer: ClientConnection, topic: str) -> None:
        """Pause reading from a client when the queue of its topic for the next step is full."""
        sim = self.sim
        if self._taken_at != sim.tick:
            self._taken, self._taken_at, self._taken_since = {}, sim.tick, time.monotonic()
            self._fewest = min((QUEUE_DEPTH, *sim.communication.bus.inbox.depths.values()))
        count = self._taken[topic] = self._taken.get(topic, 0) + 1
        if count < self._fewest:
            return
        if count >= sim.communication.bus.inbox.depths.get(topic, QUEUE_DEPTH) and not sim.paused:
            peer.is_held = time.monotonic() - self._taken_since < _LONGEST_HOLD
            self._update_interest(peer)

    def _release_held(self) -> None:
        """Resume reading from the clients whose reading was paused."""
        sim = self.sim
        if sim.tick != self._taken_at or sim.paused or time.monotonic() - self._taken_since >= _LONGEST_HOLD:
            for peer in self.peers.values():
                if peer.is_held:
                    peer.is_held = False
                    self._update_interest(peer)
                    if peer not in self._busy:
                        self._busy.append(peer)

    # ------------------------------------------------------------------ notifications

    def _send_goal_states(self) -> None:
        for peer in self.peers.values():
            if peer.goals:
                for number, (goal, sent_status) in list(peer.goals.items()):
                    if goal.status != sent_status:
                        self.send_goal_state(peer, number)

    def send_goal_state(self, peer: ClientConnection, number: int) -> None:
        """Send the status of a goal, and its result once the goal has ended."""
        goal, _ = peer.goals[number]
        update: JsonObject = {"tell": "goal", "number": number, "status": int(goal.status), "reason": goal.reason}
        data = b""
        if goal.is_done:
            del peer.goals[number]
            if goal.result is not None:
                update["type"], data = msgs.type_name(goal.result), msgs.serialize(goal.result)
        else:
            peer.goals[number] = goal, int(goal.status)
        peer.send_json(TELL, update, data)

    # ------------------------------------------------------------------ connections

    def _accept_callers(self) -> bool:
        """Accept new connections; return True if clients are connected."""
        for _ in range(_MOST_CALLERS):
            connection = self._listening.accept()
            if connection is None:
                return bool(self.peers)
            self._accept(connection)
        return True

    def _accept(self, connection: socket.socket) -> None:
        with suppress(OSError):  # the system allows less
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SEND_BYTES)
        self._numbers += 1
        peer = ClientConnection(connection, self._numbers)
        self.peers[connection.fileno()] = peer
        self._selector.register(connection, selectors.EVENT_READ, peer)
        self._interest[connection.fileno()] = selectors.EVENT_READ
        hello = {"name": self.name, "world": self.sim.world.name, "pid": os.getpid(), "version": __version__}
        peer.send_json(TELL, {"tell": "hello", "protocol": PROTOCOL, **hello})
        limit = os.sysconf("SC_OPEN_MAX") if hasattr(os, "sysconf") else 0  # Windows has no such limit
        if len(self.peers) > MOST_CLIENTS or 0 < limit <= connection.fileno() + _RESERVED_FILES:
            self.refuse(
                peer, f"{counted(len(self.peers) - 1, 'client')} connected to {self.name!r} already", "SK-LIVE-007"
            )
            self._disconnect(peer)
        else:
            self._write(peer)

    def refuse(self, peer: ClientConnection, why: str, code: str) -> None:
        """Send a client the reason and disconnect it."""
        if peer.why is None:
            peer.why = why
            peer.send_json(TELL, {"tell": "bye", "why": why, "code": code})
            peer.write()
            peer.is_gone = True

    def _write(self, peer: ClientConnection, until: float = math.inf) -> None:
        peer.write(until)
        if peer.is_gone:
            self._disconnect(peer)
            return
        if not peer.is_clogged and peer.reader.is_in_frame and peer not in self._busy:
            self._busy.append(peer)  # requests of this client may have waited for its answers
        self._update_interest(peer)

    def _update_interest(self, peer: ClientConnection) -> None:
        """Register a client for reading and for writing, as far as each is needed now."""
        handle = peer.socket.fileno()
        if handle < 0 or handle not in self._interest:
            return
        events = 0 if peer.is_held or peer.is_clogged else selectors.EVENT_READ
        events |= selectors.EVENT_WRITE if peer.is_waiting else 0
        before = self._interest[handle]
        if events == before:
            return
        self._interest[handle] = events
        if not before:
            self._selector.register(peer.socket, events, peer)
        elif events:
            self._selector.modify(peer.socket, events, peer)
        else:
            self._selector.unregister(peer.socket)

    def _disconnect(self, peer: ClientConnection) -> None:
        handle = peer.socket.fileno()
        if self.peers.get(handle) is not peer:
            return
        peer.is_gone = True
        del self.peers[handle]
        if self._interest.pop(handle):
            self._selector.unregister(peer.socket)
        with suppress(ValueError):
            self._busy.remove(peer)
        peer.socket.close()
        for subscribed in peer.subscriptions.values():
            self.feeds.remove(subscribed)
        for publisher in peer.publishers.values():
            self.sim.communication.bus.close(publisher)
        peer.clear()

    # ------------------------------------------------------------------ the end

    def close(self, why: str = "") -> None:
        """Send the end to all clients and close the socket. A second call does nothing."""
        if self.is_closed:
            return
        self.feeds.deliver_ready()
        for peer in self.peers.values():  # all first: other clients are told of their goals that are aborted now
            peer.close_endpoints()
        self._send_goal_states()
        for peer in list(self.peers.values()):
            self.refuse(peer, why or f"simulation {self.name!r} has ended", "SK-LIVE-005")
            self._disconnect(peer)
        self._selector.close()
        self._listening.close()
        with suppress(OSError):
            self.path.unlink()

    def __enter__(self) -> Server:
        return self

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        self.close(f"simulation {self.name!r} has ended: {error}" if isinstance(error, SimkitError) else "")


def serve(sim: Simulation, name: str | None = None) -> tuple[Server | None, str]:
    """Return a server and an empty text, or None and the reason as a one-line text."""
    try:
        return Server(sim, name), ""
    except socket_files.NoSocketFolder as fault:
        return None, f"note SK-LIVE-009: other terminals cannot reach this run: {fault}"
