"""A simulation that runs in a thread, for the commands that talk to one; in a place of its own."""

from __future__ import annotations

import contextlib
import io
import math
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import typer

import simkit
from simkit.cli import app

ROVER = """<sdf version="1.9"><world name="yard">
  <physics type="ode"><max_step_size>0.002</max_step_size></physics>
  <model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry></collision>
  </link></model>
  <model name="rover"><pose>0 0 0.1 0 0 0</pose>
    <link name="base"><inertial><mass>5</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>
      <collision name="c"><pose>-0.15 0 -0.08 0 0 0</pose><geometry><sphere><radius>0.02</radius></sphere></geometry>
        <surface><friction><ode><mu>0</mu></ode></friction></surface></collision>
      <sensor name="imu" type="imu"><update_rate>50</update_rate><topic>/imu</topic><always_on>1</always_on></sensor>
    </link>
    <link name="left"><pose>0 0.2 0 0 0 0</pose><inertial><mass>1</mass></inertial><collision name="c">
      <pose>0 0 0 1.5708 0 0</pose><geometry><cylinder><radius>0.1</radius><length>0.05</length></cylinder></geometry>
      </collision></link>
    <link name="right"><pose>0 -0.2 0 0 0 0</pose><inertial><mass>1</mass></inertial><collision name="c">
      <pose>0 0 0 1.5708 0 0</pose><geometry><cylinder><radius>0.1</radius><length>0.05</length></cylinder></geometry>
      </collision></link>
    <joint name="left_wheel" type="revolute"><parent>base</parent><child>left</child><axis><xyz>0 1 0</xyz></axis>
    </joint>
    <joint name="right_wheel" type="revolute"><parent>base</parent><child>right</child><axis><xyz>0 1 0</xyz></axis>
    </joint>
    <plugin name="gz::sim::systems::DiffDrive" filename="gz-sim-diff-drive-system">
      <left_joint>left_wheel</left_joint><right_joint>right_wheel</right_joint>
      <wheel_separation>0.4</wheel_separation><wheel_radius>0.1</wheel_radius>
      <topic>/cmd_vel</topic><odom_topic>/odom</odom_topic><tf_topic>/tf</tf_topic>
      <frame_id>odom</frame_id><child_frame_id>base</child_frame_id>
    </plugin>
    <plugin name="gz::sim::systems::JointStatePublisher" filename="gz-sim-joint-state-publisher-system">
      <topic>/joint_states</topic></plugin>
  </model>
</world></sdf>
"""


class Countdown(simkit.WorldPlugin):
    """An action that counts down ten times a second."""

    after_step_rate = 10.0

    def load(self, parent: Any, params: Any) -> None:
        self.goal: Any = None
        self.act("/countdown", "example_interfaces/action/Fibonacci", self.on_goal, self.on_cancel)

    def on_goal(self, goal: Any) -> None:
        if goal.request.order < 1:
            goal.reject("nothing to count")
        else:
            self.goal, self.left = goal, goal.request.order

    def on_cancel(self, goal: Any) -> None:
        goal.canceled({"sequence": [self.left]})
        self.goal = None

    def after_step(self) -> None:
        if self.goal is None:
            return
        self.left -= 1
        self.goal.publish_feedback({"sequence": [self.left]})
        if self.left == 0:
            self.goal.succeed({"sequence": [0]})
            self.goal = None


class Tuner(simkit.WorldPlugin):
    """Live parameters of every type."""

    def load(self, parent: Any, params: Any) -> None:
        self.gain = self.declare("p_gain", 2.0, minimum=0.0, maximum=100.0, description="gain [N·m/rad]")
        self.count = self.declare("count", 3)
        self.mode = self.declare("mode", "fast", choices=("fast", "slow"))
        self.on = self.declare("on", True)
        self.offset = self.declare("frame.offset", (0.0, 0.5))
        self.offer("/lamp", "std_srvs/srv/SetBool", lambda request: {"success": request.data, "message": "lit"})


class Live:
    """A simulation that advances in a thread of its own, and answers.

    Attributes:
        sim: to be looked at while it is paused.
        steps_heard: how many steps with a subscriber it goes on before it ends by itself.
    """

    def __init__(self, sim: Any, name: str) -> None:
        from simkit.live import Server

        self.sim = sim
        self.steps_heard = math.inf
        self._server = Server(sim, name)
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        with self._server:
            while not self._over.is_set() and self.steps_heard > 0:
                if not self.sim.paused:
                    self.sim.step(5)
                    self.steps_heard -= 5 * any(peer.subscriptions for peer in self._server.peers.values())
                self._server.poll(0.02 if self.sim.paused else 0.001)

    def close(self) -> None:
        self._over.set()
        self._thread.join()


@contextmanager
def placed(monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A short folder for sockets that nobody else uses."""
    with tempfile.TemporaryDirectory(prefix="sk", dir="/tmp") as folder:
        monkeypatch.setenv("XDG_RUNTIME_DIR", folder)
        monkeypatch.setattr(tempfile, "tempdir", folder)
        monkeypatch.delenv("SIMKIT_SIM", raising=False)
        yield Path(folder)


@pytest.fixture(scope="session")
def folder_of_tests(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Made before anything changes where temporary files are."""
    return tmp_path_factory.getbasetemp()


@pytest.fixture
def place(monkeypatch: pytest.MonkeyPatch, folder_of_tests: Path) -> Iterator[Path]:
    with placed(monkeypatch) as folder:
        yield folder


def _begun(stack: ExitStack, name: str, paused: bool, world: str | None = None) -> Live:
    plugins = [] if world else [Countdown(), Tuner()]
    sim = stack.enter_context(simkit.load(world or ROVER, plugins=plugins))
    sim.run(0.1)
    sim.paused = paused
    live = Live(sim, name)
    stack.callback(live.close)
    return live


@pytest.fixture
def start(place: Path) -> Iterator[Callable[..., Live]]:
    """Starts the rover's world, or another one, under a name, as often as wanted."""
    with ExitStack() as stack:
        yield lambda name="yard", paused=False, world=None: _begun(stack, name, paused, world)


@pytest.fixture(scope="module")
def yard(folder_of_tests: Path) -> Iterator[Live]:
    """The rover's world, as it runs: one for all tests of a module, which leave it as it is."""
    with pytest.MonkeyPatch.context() as monkeypatch, placed(monkeypatch), ExitStack() as stack:
        yield _begun(stack, "yard", paused=False)


@pytest.fixture(scope="session")
def yard_world() -> str:
    """The world of those, as SDF."""
    return ROVER


@dataclass(frozen=True)
class Result:
    """What a command line did."""

    stdout: str
    stderr: str
    exit_code: int


@cache
def _command() -> Any:
    return typer.main.get_command(app)


@pytest.fixture(scope="session")
def simkit_line() -> Callable[..., Result]:
    """Runs a command line in this process."""

    def run(*words: str, stdin: str = "") -> Result:
        out, err, before = io.StringIO(), io.StringIO(), sys.stdin
        sys.stdin = io.StringIO(stdin)
        try:
            with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), pytest.raises(SystemExit) as ended:
                _command()(args=list(words), prog_name="simkit")
        finally:
            sys.stdin = before
        return Result(out.getvalue(), err.getvalue(), int(ended.value.code or 0))

    return run
