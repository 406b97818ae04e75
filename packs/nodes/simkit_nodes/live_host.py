"""World around a program in a process of its own: wall time, real threads and a running simulation.

One thread exchanges data with the simulation. All threads of the program use the graph and the connection one at a
time, under the lock of `LiveHost`.
"""

from __future__ import annotations

import _thread
import hashlib
import os
import select
import signal
import socket
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, cast

from simkit.bridges.simulation_link import SimulationLink
from simkit.live import LiveClosed, LiveError
from simkit.msgs import type_of
from simkit_nodes.graph import Graph, GraphNode
from simkit_nodes.live_parameters import SharedParameterServer
from simkit_nodes.live_services import LiveActions, LiveServices
from simkit_nodes.live_topics import LiveTopics
from simkit_nodes.program_lock import ProgramLock, locked
from simkit_nodes.ros1_parameters import SERVER

if TYPE_CHECKING:
    from types import FrameType

    from simkit_nodes.programs import NodeProgram

_LOOK_PERIOD: Final = 0.05  # [s] between two looks at a condition; most changes of a condition call `wake`
_GRAPH_PERIOD: Final = 0.1  # [s] between two requests for the topics, services and actions of the simulation
_SEND_TIMEOUT: Final = 30.0  # [s] after which a simulation that reads nothing counts as stopped
_END_GRACE: Final = 3.0  # [s] that a program gets to end by itself after the simulation has ended
_MOST_PIECES: Final = 100  # pieces of received data between two looks at the clock

KILL: Final = "_kill"
"""Hidden service of each node, of the type `std_srvs/srv/Trigger`, which ends its program as Ctrl-C does."""
PING: Final = "_ping"
"""Hidden service of each node, of the type `std_srvs/srv/Trigger`, which responds with the process number."""
_TRIGGER: Final = "std_srvs/srv/Trigger"


class _Link(SimulationLink):
    """Connection to the simulation; what is sent after its end is lost."""

    def send(self, frame: bytes) -> None:
        """Send a whole frame."""
        with suppress(LiveClosed):  # the thread that receives will find it out
            super().send(frame)


class LiveThread:
    """Thread of a program.

    Attributes:
        is_done: True after the end of its function.
    """

    def __init__(self, function: Callable[[], object], name: str) -> None:
        self._function = function
        self.is_done = False
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    @property
    def ident(self) -> int | None:
        """Identifier of the thread."""
        return self._thread.ident

    def _run(self) -> None:
        try:
            self._function()
        finally:
            self.is_done = True


class LiveHost:
    """World around the program of this process; see `Host`.

    Args:
        path: path of the simulation's socket.
        name: name of the program in the simulation's node lists, until the program opens a node.

    Attributes:
        graph: topics, services and actions.
        simulation: None: the simulation is in another process.
        closed: reason for the end of the connection; None while the simulation runs.

    Raises:
        LiveError: the simulation does not answer.
    """

    def __init__(self, path: Path, name: str) -> None:
        self._link = _Link(path, self._report, name, is_bridge=False)
        self._link._socket.settimeout(_SEND_TIMEOUT)
        self.lock = ProgramLock()
        self.simulation = None
        self.closed: LiveClosed | None = None
        self._token = os.urandom(16).hex()
        self._topics = LiveTopics(self._link, self._report)
        self._services = LiveServices(self._link, self._report, self._take_refusal)
        self._actions = LiveActions(self._link, self._take_refusal, self._call_later)
        self._doubled_nodes: set[str] = set()
        arguments = self._topics, self._services, self._actions, self._actions.enqueue
        self._graph = _LiveGraph(*arguments, self, lambda: None)
        self._graph.has_simulated_time = False
        self.graph = cast("Graph", locked(self._graph, self.lock, self._note_calls))
        self._revision: object = None
        self._is_graph_requested, self._graph_due = False, 0.0
        self._is_closing = False
        self._alarm, self._alarm_in = socket.socketpair()
        self._alarm.setblocking(False)
        self._planned_ns = 0  # time until which the thread that receives waits at most
        self._program: NodeProgram | None = None
        self._thread = threading.Thread(target=self._exchange_data, name="simkit", daemon=True)

    def _report(self, problem: str, code: str = "SK-NODE-010") -> None:
        sys.stderr.write(f"warning {code}: {problem}\n")

    def _take_refusal(self, name: str, node: str, error: LiveError) -> None:
        """Report a service or action that the simulation has refused; once for a node whose name is used twice."""
        if name == f"{node}/{PING}":
            self._doubled_nodes.add(node)
            text = f"another program has a node {node!r}, which answers requests to its services and parameters"
            self._report(f"{text}\n    help: give this one another name with --ros-args -r __node:=NAME", "SK-NODE-071")
        elif node not in self._doubled_nodes or not name.startswith(f"{node}/"):
            self._report(str(error))

    # ------------------------------------------------------------------ world around the program

    def now_ns(self) -> int:
        """Return the time of the system's clock [ns]."""
        return time.time_ns()

    def wait(self, until_ns: int | None = None, is_ready: Callable[[], bool] | None = None) -> None:
        """Wait until a time of the system's clock [ns] or until a condition holds."""
        with self.lock:
            while not (is_ready is not None and is_ready()):
                left = _LOOK_PERIOD
                if until_ns is not None:
                    left = min(left, (until_ns - self.now_ns()) / 1e9)
                    if left <= 0.0:
                        return
                self.lock.wait(left)

    def poll(self) -> None:
        """Do nothing: time goes on by itself."""

    def wake(self) -> None:
        """Have the conditions of all waits asked again."""
        self.lock.notify()

    def call_outside(self, function: Callable[[], object]) -> Any:
        """Call a function and return its result: this process has no simulation."""
        return function()

    def start_thread(self, function: Callable[[], object], name: str) -> LiveThread:
        """Start a thread of the program."""
        return LiveThread(function, name)

    def seed_of(self, node: str) -> int:
        """Return a number that differs in each process and for each name."""
        return int.from_bytes(hashlib.sha256(f"{self._token}:{node}".encode()).digest()[:8], "little")

    def _call_later(self, duration: float, function: Callable[[], None]) -> None:
        self._graph.call_at(self.now_ns() + round(duration * 1e9), function)

    # ------------------------------------------------------------------ start and end

    def start(self, program: NodeProgram) -> None:
        """Exchange data with the simulation from now on, and let Ctrl-C end the program."""
        self._program = program
        self._graph.shared[SERVER] = SharedParameterServer(self.ask)
        signal.signal(signal.SIGINT, self._on_interrupt)
        with self.lock:
            self._request_graph()
            self._link.wait(self._has_graph, self._link.timeout)
        self._thread.start()

    def ask(self, question: str, **args: object) -> Any:
        """Send a request to the simulation and return its answer."""
        with self.lock:
            return self._link.request(question, args)[0]

    def close(self) -> None:
        """Send what waits, close the connection and stop the exchange of data."""
        with self.lock:
            self._is_closing = True
            if self._link.is_closed:
                return
            self._graph.clear()
            with suppress(LiveError):
                self._link.timeout = 1.0
                self._link.request("ping", {})  # the simulation has then processed everything that was sent
            self._link.close()
        self._ring()
        self._thread.join(1.0)
        self._alarm.close()
        self._alarm_in.close()

    def _on_interrupt(self, number: int, frame: FrameType | None) -> None:
        """End the program after Ctrl-C, as soon as its main thread does not hold the lock."""
        self.lock.call_when_free(self.interrupt)

    def interrupt(self) -> None:
        """Shut the communication of the program down and raise KeyboardInterrupt in its main thread."""
        assert self._program is not None
        self._program.interrupt(self._program.main_task)

    def kill(self) -> None:
        """End the program as Ctrl-C does."""
        if hasattr(signal, "pthread_kill"):
            signal.pthread_kill(cast("int", threading.main_thread().ident), signal.SIGINT)
        else:
            _thread.interrupt_main()

    # ------------------------------------------------------------------ exchange of data

    def _exchange_data(self) -> None:
        """Receive from the simulation until its end; the function of the thread for this."""
        try:
            while True:
                select.select([self._link.fileno(), self._alarm.fileno()], [], [], self._plan())
                with suppress(BlockingIOError):
                    self._alarm.recv(4096)
                with self.lock:
                    self._receive()
                    self.lock.notify()
        except LiveClosed as error:
            closed = error
        except (OSError, ValueError):
            reason = self._link.closed
            if reason is None:
                raise
            closed = reason  # another thread found out while it sent
        if not self._is_closing:
            self._end(closed)

    def _plan(self) -> float:
        """Return the longest wait for data [s]."""
        with self.lock:
            if self._link.is_closed:
                raise ValueError
            due_ns = self._graph.next_ns
            now_ns = self.now_ns()
            wait = max(0.0, self._graph_due - time.monotonic()) if not self._is_graph_requested else 1.0
            if due_ns is not None:
                wait = min(wait, max(0.0, (due_ns - now_ns) / 1e9))
            self._planned_ns = now_ns + round(wait * 1e9)
            return wait

    def _note_calls(self) -> None:
        """Shorten the wait for data if the graph has to do something earlier."""
        due_ns = self._graph.next_ns
        if due_ns is not None and due_ns < self._planned_ns:
            self._planned_ns = due_ns
            self._ring()

    def _ring(self) -> None:
        with suppress(OSError):
            self._alarm_in.send(b"\0")

    def _receive(self) -> None:
        for _ in range(_MOST_PIECES):
            if not self._link.receive(0.0):
                break
        self._link.dispatch_answers()
        if not self._is_graph_requested and time.monotonic() >= self._graph_due:
            self._request_graph()
        self._graph.deliver()

    def _has_graph(self) -> bool:
        self._link.dispatch_answers()
        return self._revision is not None

    def _request_graph(self) -> None:
        self._is_graph_requested = True
        self._link.ask("graph", {"revision": self._revision}, then=self._take_graph, failed=self._fail_graph)

    def _take_graph(self, answer: Any, _: bytes) -> None:
        self._is_graph_requested, self._graph_due = False, time.monotonic() + _GRAPH_PERIOD
        if answer["revision"] != self._revision:
            self._revision = answer["revision"]
            self._topics.update(answer)
            self._services.types, self._actions.types = answer["services"], answer["actions"]

    def _fail_graph(self, error: LiveError) -> None:
        self._is_graph_requested, self._graph_due = False, time.monotonic() + 1.0
        self._report(str(error))

    def _end(self, closed: LiveClosed) -> None:
        """End the program after the end of the simulation, or have it ended after some time."""
        self.closed = closed
        program = self._program
        assert program is not None
        for function in program.on_end:
            function()
        self.wake()
        timer = threading.Timer(_END_GRACE, self.kill)
        timer.daemon = True
        timer.start()


class _LiveGraph(Graph):
    """Graph of the program of this process, whose nodes can be pinged and ended from outside."""

    def open_node(self, program: NodeProgram, name: str) -> GraphNode:
        """Add a node, with its hidden services."""
        node = super().open_node(program, name)
        host = cast("LiveHost", program.host)
        for service, function in ((PING, lambda: None), (KILL, host.kill)):
            _offer_hidden(node, f"{name}/{service}", function)
        return node


def _offer_hidden(node: GraphNode, name: str, function: Callable[[], None]) -> None:
    """Open a service that responds at once with the number of the process, and then calls a function."""

    def answer() -> None:
        request = service.take()
        if request is not None:
            request.answer(type_of(f"{_TRIGGER}_Response")(success=True, message=str(os.getpid())))
            function()

    service = node.offer(name, _TRIGGER, answer)
