"""Types that mypy and pyright find in users' programs: messages by their class, and sensors by theirs."""

from __future__ import annotations

import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = '''
from typing import Any, assert_type

import simkit
from simkit import live, msgs
from simkit.extend import GoalHandle, ServiceCall
from simkit.recording import ExportOptions, export_bag, open_bag_to_read
from simkit.sensors import Camera, DepthCamera, Imu, Lidar, Sensor


def switch(request: msgs.SetBool_Request) -> msgs.SetBool_Response:
    assert_type(request.data, bool)
    return msgs.SetBool_Response(success=request.data, message="")


def count(goal: GoalHandle[msgs.Fibonacci_Goal]) -> None:
    assert_type(goal.request.order, int)
    goal.publish_feedback({"sequence": [1]})
    goal.succeed({"sequence": [1, 1]})


class Echo(simkit.WorldPlugin):
    """Plugin that uses each kind of endpoint."""

    def load(self, parent: simkit.Simulation, params: simkit.Params) -> None:
        assert_type(self.subscribe("/scan", type=msgs.LaserScan).latest, msgs.LaserScan | Any)
        assert_type(self.advertise("/echo", msgs.String), simkit.Publisher[msgs.String])
        self.listen("/cmd_vel", msgs.Twist, lambda message: print(message.linear.x))
        self.offer("/lamp", msgs.SetBool_Request, lambda request: {"success": request.data})
        self.act("/count", msgs.Fibonacci_Goal, count)


class Push(simkit.ModelPlugin):
    """Plugin of a model."""

    def load(self, parent: simkit.Model, params: simkit.Params) -> None:
        assert_type(parent.links, dict[str, simkit.Link])


def plugins(sim: simkit.Simulation) -> None:
    assert_type(sim.plugins, dict[str, simkit.Plugin])
    push = sim.plugins["bot::Push"]
    if isinstance(push, Push):
        print(push.ros.topic("push"))


def topics(sim: simkit.Simulation) -> None:
    assert_type(sim.subscribe("/scan"), simkit.Subscription[Any])
    scans = sim.subscribe("/scan", type=msgs.LaserScan, callback=lambda scan: print(scan.ranges))
    assert_type(scans.latest, msgs.LaserScan | Any)
    assert_type(scans.messages, list[msgs.LaserScan])
    assert_type(sim.advertise("/chatter", msgs.String), simkit.Publisher[msgs.String])
    print(scans.latest.ranges.min(), sim.run_until("pose('bot').x > 0.5", timeout=5.0))


def sensors(sim: simkit.Simulation) -> None:
    assert_type(sim.sensors, dict[str, Sensor[Any]])
    assert_type(sim.sensor("lds"), Sensor[Any])
    assert_type(sim.sensor("lds").update_rate, float)
    assert_type(sim.sensor("lds", type=Lidar).latest, msgs.LaserScan | Any)
    assert_type(sim.sensor("imu", type=Imu).truth, msgs.Imu | Any)
    assert_type(sim.sensor("camera", type=Camera).latest, msgs.Image | Any)
    print(sim.sensor("lds", type=Lidar).hits[90], sim.sensor("depth", type=DepthCamera).depth[0, 0])


def joints(sim: simkit.Simulation) -> None:
    wheel = sim.joint("bot::wheel")
    assert_type(wheel.position, float | Any)
    print(round(wheel.position, 2), abs(wheel.velocity) < wheel.velocity_limit, f"{wheel.damping:.2f}")
    angle: float = wheel.position
    wheel.set_position(angle + 1)


def parameters(sim: simkit.Simulation, client: live.Client) -> None:
    mode = sim.declare("mode", "slow", choices=("slow", "fast"), on_change=lambda mode: print(mode.upper()))
    assert_type(mode.value, str)
    assert_type(client.declare("gain", 0.5).value, float)


def runs_and_bags(sim: simkit.Simulation) -> None:
    print(sim.run_spec.overrides)
    export_bag("run.mcap", "tables", ExportOptions(topics=("/scan",)))
    with open_bag_to_read("run.mcap") as bag:
        print([bag.decode(message) for message in bag.messages("/scan")])


def services(sim: simkit.Simulation) -> None:
    sim.offer("/lamp", msgs.SetBool_Request, switch)
    assert_type(sim.call("/lamp", msgs.SetBool_Request(True)), msgs.SetBool_Response)
    assert_type(sim.call("/lamp", {"data": True}, type=msgs.SetBool_Request), msgs.SetBool_Response)
    assert_type(sim.call("/reset", type=msgs.Trigger_Request), msgs.Trigger_Response)
    later = sim.call("/lamp", msgs.SetBool_Request(True), on_done=lambda call: print(call.response.message))
    assert_type(later, ServiceCall[msgs.SetBool_Response])
    assert_type(sim.call("/lamp", {"data": True}), Any)


def actions(sim: simkit.Simulation) -> None:
    sim.act("/count", msgs.Fibonacci_Goal, count)
    goal = sim.send_goal("/count", msgs.Fibonacci_Goal(3), on_feedback=lambda feedback: print(feedback.sequence))
    assert_type(goal, GoalHandle[msgs.Fibonacci_Goal])
    assert_type(goal.result, msgs.Fibonacci_Result | Any)
    assert_type(sim.send_goal("/count", {"order": 3}, type=msgs.Fibonacci_Goal).feedback, msgs.Fibonacci_Feedback | Any)
    assert_type(sim.send_goal("/count", {"order": 3}), GoalHandle[Any])


def client(client: live.Client) -> None:
    scans = client.subscribe("/scan", type=msgs.LaserScan)
    assert_type(next(scans).message, msgs.LaserScan)
    assert_type(client.advertise("/chatter", msgs.String), live.LivePublisher[msgs.String])
    client.listen("/cmd_vel", msgs.Twist, lambda message: print(message.linear.x))
    client.offer("/lamp", msgs.SetBool_Request, switch)
    client.act("/count", msgs.Fibonacci_Goal, lambda goal: {"sequence": [goal.request.order]})
    assert_type(client.call("/lamp", msgs.SetBool_Request(True)), msgs.SetBool_Response)
    assert_type(client.call("/lamp", {"data": True}, type=msgs.SetBool_Request), msgs.SetBool_Response)
    goal = client.send_goal("/count", {"order": 3}, type=msgs.Fibonacci_Goal)
    assert_type(goal, live.LiveGoal[msgs.Fibonacci_Goal])
    assert_type(goal.result, msgs.Fibonacci_Result | Any)


def messages() -> None:
    twist = msgs.make(msgs.Twist, linear={"x": 0.2})
    assert_type(twist, msgs.Twist)
    assert_type(msgs.deserialize(msgs.serialize(twist), msgs.Twist), msgs.Twist)
    assert_type(simkit.msgs.String("hello").data, str)
    assert_type(msgs.pose_message(simkit.Pose(), msgs.PoseStamped), msgs.PoseStamped)
    assert_type(msgs.definition("std_msgs/msg/String"), str)


def loaded() -> None:
    with simkit.load("world") as sim:
        assert_type(sim, simkit.Simulation)
        assert_type(sim.link("bot::base").pose, simkit.Pose)
        assert_type(sim.contacts()[0].first, str)
'''
MISTAKES = {
    "sim.subscribe('/scan', type=msgs.LaserScan).messages[0].rangs": "rangs",
    "sim.subscribe('/scan', lambda scan: print(scan.rangs), type=msgs.LaserScan)": "rangs",
    "sim.advertise('/chatter', msgs.String).publish(msgs.Bool(True))": "Bool",
    "sim.offer('/lamp', msgs.Trigger_Request, switch)": "offer",
    "sim.call('/lamp', msgs.SetBool_Request(True)).succes": "succes",
    "sim.call('/lamp', {'data': True}, type=msgs.LaserScan)": "call",
    "sim.act('/count', msgs.Fibonacci_Goal, lambda goal: print(goal.request.ordr))": "ordr",
    "sim.act('/count', msgs.Fibonacci_Goal, lambda goal: goal.succeed(msgs.Bool(True)))": "Bool",
    "sim.send_goal('/count', msgs.Fibonacci_Goal(3), lambda feedback: print(feedback.sequenc))": "sequenc",
    "client.call('/lamp', msgs.SetBool_Request(True)).succes": "succes",
    "sim.sensor('lds').ranges": "ranges",
    "sim.plugins['drive'].sped": "sped",
    "Push().load(sim, simkit.Params())": "Model",
    "simkit.load('world', plugins=Push())": "plugins",
    "msgs.definition(1)": "str",
    "client.declare('gain', 0.5).value.upper()": "upper",
}


def found_by_mypy(folder: Path) -> list[tuple[int, str]]:
    """Return the line and the text of each error that mypy finds."""
    options = ["--strict", "--follow-imports=silent", "--no-pretty", "--hide-error-context", "--cache-dir", "cache"]
    command = [sys.executable, "-m", "mypy", *options, "--python-version", "3.11", "program.py"]
    done = subprocess.run(
        command, cwd=folder, env={**os.environ, "MYPYPATH": str(ROOT)}, capture_output=True, text=True, check=False
    )
    assert "program.py" in done.stdout or "Success" in done.stdout, done.stdout + done.stderr
    lines = [line.split(":", 3) for line in done.stdout.splitlines() if ": error:" in line]
    return [(int(number), text) for _, number, _, text in lines]


def found_by_pyright(folder: Path) -> list[tuple[int, str]]:
    """Return the line and the text of each error that pyright finds, with the settings of a new user."""
    settings = {"typeCheckingMode": "standard", "pythonVersion": "3.11", "extraPaths": [str(ROOT)]}
    (folder / "pyrightconfig.json").write_text(json.dumps(settings), encoding="utf-8")
    command = [sys.executable, "-m", "basedpyright", "--outputjson", "--pythonpath", sys.executable, "program.py"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    found = json.loads(done.stdout)
    assert found["summary"]["filesAnalyzed"] == 1, done.stdout
    errors = [each for each in found["generalDiagnostics"] if each["severity"] == "error"]
    return [(each["range"]["start"]["line"] + 1, each["message"]) for each in errors]


def needs(module: str) -> pytest.MarkDecorator:
    """Return the mark of a test that needs a module of the extra dev."""
    return pytest.mark.skipif(importlib.util.find_spec(module) is None, reason=f"needs {module}, of the extra dev")


CHECKERS = pytest.mark.parametrize(
    "found_by",
    [
        pytest.param(found_by_mypy, id="mypy", marks=needs("mypy")),
        pytest.param(found_by_pyright, id="pyright", marks=needs("basedpyright")),
    ],
)
pytestmark = pytest.mark.slow


@CHECKERS
def test_a_type_checker_knows_what_is_named_by_class(found_by, tmp_path: Path) -> None:
    (tmp_path / "program.py").write_text(PROGRAM, encoding="utf-8")
    assert found_by(tmp_path) == []


@CHECKERS
def test_a_type_checker_finds_misspelled_fields_and_messages_of_another_class(found_by, tmp_path: Path) -> None:
    head = "\n\ndef mistakes(sim: simkit.Simulation, client: live.Client) -> None:\n"
    (tmp_path / "program.py").write_text(PROGRAM + head + "".join(f"    {mistake}\n" for mistake in MISTAKES), "utf-8")
    first = (PROGRAM + head).count("\n") + 1
    found = found_by(tmp_path)
    for number, (mistake, text) in enumerate(MISTAKES.items(), first):
        assert any(line == number and text in problem for line, problem in found), (mistake, found)
    assert {line for line, _ in found} == set(range(first, first + len(MISTAKES)))
