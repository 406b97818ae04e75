"""The server that `simkit run` opens for clients of other processes; the run polls it between two slices.

Nothing here runs beside the physics. What clients send takes the same way as what callers in the process do,
so that the run's bits depend only on what came at which tick; what they only read changes none.
"""

from __future__ import annotations

import os
import selectors
import socket
import time
from collections import deque
from contextlib import suppress
from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.bridges.live import socket_files
from simkit.bridges.live.connection import ClientConnection
from simkit.bridges.live.message_reader import message_reader
from simkit.bridges.live.protocol import ANSWER, ASK, NUMBER, PROTOCOL, TELL, BadFrame, JsonObject, read_json_frame
from simkit.bridges.live.requests import REQUESTS, Request, RequestRefused, Response
from simkit.bridges.live.topic_feed import TopicFeeds
from simkit.errors import PluginError, SimkitError, SimulationDiverged
from simkit.runtime.communication.command_queue import QUEUE_DEPTH
from simkit.version import __version__

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation

MOST_CLIENTS: Final = 64
BUDGET: Final = 0.005  # [s] of wall time that is spent on clients between two slices
_SLICE, _BUSY_SLICE = 0.4, 0.08  # of the wall time that a slice would take without clients, or while they are quiet
_REQUESTS_PER_TURN = 64  # frames that are taken of one client before it is the next one's turn
_LONGEST_HOLD = 0.2  # [s] of wall time for which a client is held back at most, so that none of its commands is dropped
_MOST_CALLERS = 16  # connections that are taken at one look


class Server:
    """Lets other processes of the same user talk to a simulation; a context manager.

    Args:
        sim: the simulation.
        name: by which it is connected to; else its world's. Where that is taken, `_2`, `_3`, … is added.

    Attributes:
        name: what it became.
        path: of the socket.
        feeds: the topics that clients subscribe to.
        peers: the clients.
        client_topics: topics that only clients had when they were opened, over the whole run.

    Raises:
        NoSocketFolder: there is no place for the socket; says why.
    """

    def __init__(self, sim: Simulation, name: str | None = None) -> None:
        self.sim = sim
        self._listening, self.name, self.path = socket_files.bind(name or sim.world.name)
        self._selector = selectors.DefaultSelector()
        self._selector.register(self._listening, selectors.EVENT_READ)
        self.feeds = TopicFeeds(sim)
        self.peers: dict[int, ClientConnection] = {}
        self.client_topics: set[str] = set()
        self._busy: deque[ClientConnection] = deque()
        self._interest: dict[int, int] = {}
        self._numbers = 0
        self._taken: dict[str, int] = {}
        self._taken_at, self._taken_since = -1, 0.0
        self._fewest = 1  # commands of a topic that are kept for the next step, of the topic of which fewest are
        self._pace = [(time.monotonic(), sim.tick)]

    # ------------------------------------------------------------------ between two slices

    def poll(self, wait: float = 0.0) -> bool:
        """Takes what clients have sent, and sends what waits for them; whether anything came.

        To be called between two steps, again and again, while the simulation runs and while it stands still.

        Args:
            wait: how long to wait for something to come [s], wall time.

        Raises:
            PluginError, SubscriberError, SimulationDiverged: what a client sent had somebody raise.
        """
        if self.is_closed:
            return False
        if not self.peers and wait <= 0:
            return self._accept_callers()
        self.feeds.deliver_ready()
        self._send_goal_states()
        self._release_held()
        for peer in [p for p in self.peers.values() if p.is_waiting]:
            self._write(peer)
        ready = self._selector.select(0.0 if self._busy else max(0.0, wait))
        for key, mask in ready:
            peer = key.data
            if peer is None:
                self._accept_callers()
                continue
            if mask & selectors.EVENT_WRITE:
                self._write(peer)
            if mask & selectors.EVENT_READ and peer.read() and peer not in self._busy:
                self._busy.append(peer)
            if peer.is_gone:
                self._disconnect(peer)
        if self._busy:
            self._serve_busy_clients(time.perf_counter() + BUDGET)
        return bool(ready)

    def fileno(self) -> int:
        """Something to wait for together with others: readable once `poll` has something to do."""
        found: int = self._selector.fileno()
        return found

    def measured_rtf(self) -> float:
        """Return the real-time factor of the last moments."""
        now, tick = time.monotonic(), self.sim.tick
        began, first = self._pace[0]
        if now - self._pace[-1][0] > 0.5:
            self._pace = [self._pace[-1], (now, tick)]
        return max(0, tick - first) * self.sim.timestep / max(now - began, 1e-3)

    @property
    def is_closed(self) -> bool:
        """Whether the server accepts no more connections."""
        return self._listening.fileno() < 0

    def slices(self, *lengths: float) -> tuple[float, ...]:
        """Return the lengths of the run's slices with clients, given those without [s, wall time].

        They are shorter with clients, and shorter still where there was no time for all that they sent.
        """
        if not self.peers:
            return lengths
        factor = _BUSY_SLICE if self._busy else _SLICE
        return tuple(length * factor for length in lengths)

    def _serve_busy_clients(self, until: float) -> None:
        """Takes frames, a few of each client in turn, as long as there is time."""
        busy = self._busy
        try:
            while busy:
                peer = busy.popleft()
                if self._serve(peer) and not peer.is_gone:
                    busy.append(peer)
                if peer.is_waiting:
                    self._write(peer)
                if time.perf_counter() > until:
                    return
        finally:
            for peer in [p for p in self.peers.values() if p.is_gone]:
                self._disconnect(peer)

    def _serve(self, peer: ClientConnection) -> bool:
        """Takes a few frames of one client; whether it may have more."""
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
                    self._answer(peer, body)
                else:
                    publish(peer, body)
        except BadFrame as error:
            self.refuse(peer, f"this is no client of simkit: {error}", "SK-LIVE-006")
            return False
        return True

    # ------------------------------------------------------------------ what clients send

    def _publish(self, peer: ClientConnection, body: bytes) -> None:
        publisher = peer.publishers.get(NUMBER.unpack_from(body)[0] if len(body) >= 4 else -1)
        if publisher is None:
            raise BadFrame("a message of no publisher")
        try:
            message = message_reader(publisher.type_name)(body, 4)
        except Exception as error:  # noqa: BLE001 - bytes from outside may lead a reader anywhere
            raise BadFrame(f"what was sent on {publisher.topic!r} is no {publisher.type_name}: {error!r}") from None
        publisher.publish(message)
        self._hold_back_if_full(peer, publisher.topic)

    def _hold_back_if_full(self, peer: ClientConnection, topic: str) -> None:
        """Holds a client back once as many commands of a topic wait for the next step as are kept for it."""
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
        """Takes from those again that were held back."""
        sim = self.sim
        if sim.tick != self._taken_at or sim.paused or time.monotonic() - self._taken_since >= _LONGEST_HOLD:
            for peer in self.peers.values():
                if peer.is_held:
                    peer.is_held = False
                    self._update_interest(peer)
                    if peer not in self._busy:
                        self._busy.append(peer)

    def _answer(self, peer: ClientConnection, body: bytes) -> None:
        words, data = read_json_frame(body)
        number, question = words.pop("id", None), words.pop("ask", None)
        if type(number) is not int or not isinstance(question, str):
            raise BadFrame("a question has an id and a name")
        raised: Exception | None = None
        answer: JsonObject = {"id": number}
        found = b""
        try:
            if question not in REQUESTS:
                raise RequestRefused(f"there is no question {question!r}")
            given = REQUESTS[question](Request(self, peer, words, data))
            if isinstance(given, Response):
                answer["type"], found = msgs.type_name(given.message), msgs.serialize(given.message)
            else:
                answer["ok"] = given
        except KeyError as error:
            answer |= {"error": str(error.args[0] if error.args else error), "code": "SK-LIVE-008"}
        except SimkitError as error:
            answer |= {"error": str(error), "code": error.code}
            if isinstance(error, (PluginError, SimulationDiverged)):
                raised = error  # it ends the run as it would if it were called from the process
        except Exception as error:  # noqa: BLE001 - a service that a script offers may raise anything
            answer |= {"error": f"{question} failed: {error!r}", "code": "SK-LIVE-008"}
            raised = error
        peer.send_json(ANSWER, answer, found)
        if raised is not None:
            peer.write()
            raise raised

    # ------------------------------------------------------------------ what is told

    def _send_goal_states(self) -> None:
        for peer in self.peers.values():
            if peer.goals:
                for number, (goal, told) in list(peer.goals.items()):
                    if goal.status != told:
                        self.send_goal_state(peer, number)

    def send_goal_state(self, peer: ClientConnection, number: int) -> None:
        """Tells how far a goal is, and with its end what came of it."""
        goal, _ = peer.goals[number]
        words: JsonObject = {"tell": "goal", "number": number, "status": int(goal.status), "reason": goal.reason}
        data = b""
        if goal.is_done:
            del peer.goals[number]
            if goal.result is not None:
                words["type"], data = msgs.type_name(goal.result), msgs.serialize(goal.result)
        else:
            peer.goals[number] = goal, int(goal.status)
        peer.send_json(TELL, words, data)

    # ------------------------------------------------------------------ connections

    def _accept_callers(self) -> bool:
        """Takes who calls."""
        for _ in range(_MOST_CALLERS):
            try:
                connection, _ = self._listening.accept()
            except OSError:  # nobody calls, or there is no room for more files
                return bool(self.peers)
            self._accept(connection)
        return True

    def _accept(self, connection: socket.socket) -> None:
        connection.setblocking(False)
        self._numbers += 1
        peer = ClientConnection(connection, self._numbers)
        _, user = socket_files.peer_credentials(connection)
        if user is not None and user != os.getuid():
            connection.close()
            return
        self.peers[connection.fileno()] = peer
        self._selector.register(connection, selectors.EVENT_READ, peer)
        self._interest[connection.fileno()] = selectors.EVENT_READ
        hello = {"name": self.name, "world": self.sim.world.name, "pid": os.getpid(), "version": __version__}
        peer.send_json(TELL, {"tell": "hello", "protocol": PROTOCOL, **hello})
        if len(self.peers) > MOST_CLIENTS:
            self.refuse(peer, f"{MOST_CLIENTS} clients are connected to {self.name!r} already", "SK-LIVE-007")
            self._disconnect(peer)
        else:
            self._write(peer)

    def refuse(self, peer: ClientConnection, why: str, code: str) -> None:
        """Tells a client why, and hangs up on it."""
        if peer.why is None:
            peer.why = why
            peer.send_json(TELL, {"tell": "bye", "why": why, "code": code})
            peer.write()
            peer.is_gone = True

    def _write(self, peer: ClientConnection) -> None:
        peer.write()
        if peer.is_gone:
            self._disconnect(peer)
            return
        if not peer.is_clogged and peer.reader.is_in_frame and peer not in self._busy:
            self._busy.append(peer)  # questions of it may have waited for its answers to leave
        self._update_interest(peer)

    def _update_interest(self, peer: ClientConnection) -> None:
        """Waits for what a client has to say, and for room to write to it, where either is of use."""
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
        """Says good-bye to everybody; does nothing the second time."""
        if self.is_closed:
            return
        self.feeds.deliver_ready()
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
    """A server, or why there is none, in one line."""
    try:
        return Server(sim, name), ""
    except socket_files.NoSocketFolder as fault:
        return None, f"note SK-LIVE-009: no other terminal can talk to this run: {fault}"
