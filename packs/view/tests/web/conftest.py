"""Runs with a server for WebSocket clients."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[4]
TIMEOUT = 60.0
PLUGIN = '''
import simkit


class Counter(simkit.WorldPlugin):
    """Counts as an action, one number per step, and has a parameter."""

    def load(self, sim, params):
        self.goals = []
        self.declare("gain", 1.0, minimum=0.0, maximum=2.0, description="of nothing")
        self.act("/count", "example_interfaces/action/Fibonacci", self.on_goal, self.on_cancel)
        self.offer("/add", "example_interfaces/srv/AddTwoInts", lambda r: {"sum": r.a + r.b})

    def on_goal(self, goal):
        if goal.request.order > 50:
            goal.reject("too far")
        else:
            self.goals.append((goal, [0, 1]))

    def on_cancel(self, goal):
        self.goals = [(g, s) for g, s in self.goals if g is not goal]
        goal.canceled({"sequence": [7]})
        return True

    def after_step(self):
        for goal, sequence in list(self.goals):
            if goal.request.order < 0:
                continue
            sequence.append(sequence[-1] + sequence[-2])
            goal.publish_feedback({"sequence": sequence})
            if len(sequence) > goal.request.order:
                self.goals.remove((goal, sequence))
                goal.succeed({"sequence": sequence})
'''
COURT = """<sdf version="1.9"><world name="court">
<plugin filename="counter.py" name="Counter"/>
<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry></collision>
<visual name="v"><geometry><mesh><uri>meshes/tetra.stl</uri></mesh></geometry></visual></link></model>
<model name="rover"><pose>3 0 0.1 0 0 0</pose>
<link name="base"><collision name="c"><geometry><box><size>0.4 0.2 0.1</size></box></geometry></collision>
<sensor name="imu" type="imu"><always_on>true</always_on><update_rate>100</update_rate><topic>imu</topic></sensor>
<sensor name="scan" type="gpu_lidar"><update_rate>10</update_rate><topic>scan</topic><lidar><scan><horizontal>
<samples>8</samples><resolution>1</resolution><min_angle>-1</min_angle><max_angle>1</max_angle></horizontal></scan>
<range><min>0.1</min><max>5</max></range></lidar></sensor>
</link>
<plugin filename="gz-sim-velocity-control-system" name="gz::sim::systems::VelocityControl">
<topic>/cmd_vel</topic></plugin>
<plugin filename="gz-sim-odometry-publisher-system" name="gz::sim::systems::OdometryPublisher">
<odom_topic>/odom</odom_topic></plugin></model></world></sdf>"""
TETRA = (
    "solid t\n"
    + "".join(
        "facet normal 0 0 1\nouter loop\n"
        + "".join(f"vertex {x} {y} {z}\n" for x, y, z in face)
        + "endloop\nendfacet\n"
        for face in (
            ((0, 0, 0), (0, 1, 0), (1, 0, 0)),
            ((0, 0, 0), (1, 0, 0), (0, 0, 1)),
            ((0, 0, 0), (0, 0, 1), (0, 1, 0)),
            ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
        )
    )
    + "endsolid t\n"
)


@pytest.fixture(scope="session")
def court(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A world with a rover that takes /cmd_vel, an action, a service, a parameter and a mesh."""
    folder = tmp_path_factory.mktemp("court")
    (folder / "counter.py").write_text(PLUGIN)
    (folder / "meshes").mkdir()
    (folder / "meshes" / "tetra.stl").write_text(TETRA)
    (folder / "meshes" / "secret.txt").write_text("private")
    (folder / "court.sdf").write_text(COURT)
    return folder / "court.sdf"


class Run:
    """A running simulation with its servers.

    Attributes:
        addresses: addresses of the servers, by kind.
    """

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self.process = process
        self.addresses: dict[str, str] = {}
        self.text = ""

    def read_addresses(self, count: int) -> None:
        """Read the output up to the last server's address."""
        assert self.process.stderr is not None
        while len(self.addresses) < count:
            line = self.process.stderr.readline()
            assert line, f"the run has ended:\n{self.text}"
            self.text += line
            if found := re.match(r"(foxglove|rosbridge): (ws://\S+)", line):
                self.addresses[found[1]] = found[2]

    def end(self) -> tuple[str, str]:
        """Wait for the end; return the output and the errors."""
        out, errors = self.process.communicate(timeout=TIMEOUT)
        return out, self.text + errors


@pytest.fixture(scope="session")
def start_run() -> Callable[..., Any]:
    """A context manager that starts `simkit run` with servers on free ports, and ends it."""
    pytest.importorskip("websockets", reason="needs the extra foxglove or rosbridge")

    @contextmanager
    def start(world: Path, *options: str, **environment: str) -> Iterator[Run]:
        with tempfile.TemporaryDirectory(prefix="sk", dir="/tmp") as sockets:
            process = subprocess.Popen(
                [sys.executable, "-m", "simkit", "run", str(world), "-q", "--plugin-path", str(world.parent), *options],
                cwd=ROOT,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
                env={**os.environ, "XDG_RUNTIME_DIR": sockets, **environment},
            )
            run = Run(process)
            try:
                run.read_addresses(sum(option.startswith(("--rosbridge", "--foxglove")) for option in options))
                yield run
            finally:
                if process.poll() is None:
                    process.terminate()
                    process.communicate(timeout=TIMEOUT)

    return start


@pytest.fixture(scope="module")
def running(court: Path, start_run: Callable[..., Any]) -> Iterator[Run]:
    """A run at real time with both servers, which the tests of a file share."""
    with start_run(court, "--rtf", "1", "--rosbridge=0") as run:
        yield run


class Socket:
    """A WebSocket client that sends and receives JSON."""

    def __init__(self, socket: Any) -> None:
        self.socket = socket

    def send(self, op: str, **words: Any) -> None:
        self.socket.send(json.dumps({"op": op, **words}))

    def until(self, matches: Callable[[Any], bool]) -> Any:
        """The next message that matches: the JSON of a text, else bytes."""
        while True:
            data = self.socket.recv(timeout=TIMEOUT)
            found = json.loads(data) if isinstance(data, str) else data
            if matches(found):
                return found

    def until_op(self, op: str) -> Any:
        """The next JSON message with that op."""
        return self.until(lambda found: isinstance(found, dict) and found["op"] == op)


@pytest.fixture
def connect() -> Iterator[Callable[..., Socket]]:
    """A function that opens a WebSocket, which the test's end closes."""
    from websockets.sync.client import connect as open_socket

    with ExitStack() as stack:
        yield lambda address, **options: Socket(
            stack.enter_context(open_socket(address, max_size=None, close_timeout=0.5, **options))
        )
