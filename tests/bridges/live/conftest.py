"""A folder of their own for the sockets of these tests, and a simulation that is kept running for clients."""

from __future__ import annotations

import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

import simkit
from simkit.bridges.live.socket_files import KIND_VARIABLE
from simkit.live import Client, Server

COURT = """<sdf version="1.9"><world name="court">
<model name="ball"><pose>0 0 1 0 0 0</pose><link name="l"/></model>
<model name="rover"><pose>3 0 0.1 0 0 0</pose>
<link name="base"><collision name="c"><geometry><box><size>0.4 0.2 0.1</size></box></geometry></collision>
<sensor name="imu" type="imu"><always_on>true</always_on><update_rate>100</update_rate><topic>imu</topic>
<imu><angular_velocity><x><noise type="gaussian"><stddev>0.1</stddev></noise></x></angular_velocity></imu></sensor>
</link>
<plugin filename="gz-sim-velocity-control-system" name="gz::sim::systems::VelocityControl">
<topic>/cmd_vel</topic></plugin></model>
<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry></collision>
</link></model></world></sdf>"""


@pytest.fixture
def kind_of_sockets(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """The kind that new simulations use; files that are parametrised with it run with each kind."""
    kind = getattr(request, "param", "")
    if kind:
        monkeypatch.setenv(KIND_VARIABLE, kind)
    return kind


@pytest.fixture(autouse=True)
def sockets(monkeypatch: pytest.MonkeyPatch, kind_of_sockets: str) -> Iterator[Path]:
    """Where the sockets are; a short path, since that of a socket has room for about 100 bytes."""
    with tempfile.TemporaryDirectory(prefix="sk", dir="/tmp") as folder:
        monkeypatch.setenv("XDG_RUNTIME_DIR", folder)
        monkeypatch.setattr(tempfile, "tempdir", folder)
        monkeypatch.delenv("SIMKIT_SIM", raising=False)
        yield Path(folder) / "simkit"


class Counter(simkit.WorldPlugin):
    """Counts as an action, and has a parameter."""

    def load(self, sim: Any, params: Any) -> None:
        self.goals: list[Any] = []
        self.gain = self.declare("gain", 1.0, minimum=0.0, maximum=2.0, description="of nothing")
        self.act("/count", "example_interfaces/action/Fibonacci", self.on_goal, self.on_cancel)

    def on_goal(self, goal: Any) -> None:
        if goal.request.order > 50:
            goal.reject("too far")
            return
        self.goals.append((goal, [0, 1]))

    def on_cancel(self, goal: Any) -> bool:
        self.goals = [(g, s) for g, s in self.goals if g is not goal]
        goal.canceled({"sequence": [7]})
        return True

    def after_step(self) -> None:
        for goal, sequence in list(self.goals):
            sequence.append(sequence[-1] + sequence[-2])
            goal.publish_feedback({"sequence": sequence})
            if len(sequence) > goal.request.order:
                self.goals.remove((goal, sequence))
                goal.succeed({"sequence": sequence})


@contextmanager
def running(
    sim: simkit.Simulation,
    node: str | None = None,
    calls: list[Callable[[Server], None]] | None = None,
    may_fail: bool = False,
) -> Iterator[Client]:
    """A client of a simulation that another thread keeps running.

    Args:
        sim: the simulation.
        node: what it calls the client.
        calls: what is put in here is called by that thread.
        may_fail: whether the run may end with an error.
    """
    with Server(sim) as server:
        over = threading.Event()
        failed: list[BaseException] = []

        def run() -> None:
            try:
                while not over.is_set():
                    server.poll(0.001)
                    while calls:
                        calls.pop(0)(server)
                    if not sim.paused:
                        sim.control.pausing.advance(5)
            except BaseException as error:  # noqa: BLE001 - told by the thread of the test
                failed.append(error)
                server.close(f"ended: {error}")

        thread = threading.Thread(target=run)
        thread.start()
        try:
            with Client(server.path, node=node) as client:
                yield client
        finally:
            over.set()
            thread.join()
            if failed and not may_fail:
                raise failed[0]


@pytest.fixture(scope="session")
def court_text() -> str:
    """The file of the court."""
    return COURT


@pytest.fixture
def court() -> Iterator[simkit.Simulation]:
    """A ball, a rover that takes `/cmd_vel` and publishes `/imu`."""
    with simkit.load(COURT) as sim:
        yield sim


@pytest.fixture
def counting() -> Iterator[simkit.Simulation]:
    """The court with an action `/count` and a parameter `gain`."""
    with simkit.load(COURT, plugins=[Counter()]) as sim:
        yield sim


@pytest.fixture
def client(court: simkit.Simulation) -> Iterator[Client]:
    """A client of the court, which runs."""
    with running(court) as found:
        yield found


@pytest.fixture
def run() -> Callable[..., Any]:
    """`with run(sim) as client:`."""
    return running
