"""Services of a node of ROS are called by clients of the simulation, and by its plugins."""

from __future__ import annotations

import subprocess
import textwrap
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from simkit.live import Client, LiveError, connect

from .conftest import FOLDER, TIMEOUT, ros_environment

pytestmark = pytest.mark.ros

SERVER = """
    from rcl_interfaces.srv import GetParameterTypes
    from std_srvs.srv import SetBool, Trigger
    from lifecycle_msgs.srv import GetState
    from simkit_ros.opaque_types import service_class

    client = Client("lamp")
    lit = []

    def switch(request, response):
        lit.append(request.data)
        response.success, response.message = True, f"lit {lit}"
        return response

    def add(request, response):
        import struct
        a, b = struct.unpack("<qq", request.cdr[4:20])
        response.cdr = bytes([0, 1, 0, 0]) + struct.pack("<q", a + b)
        return response

    client.node.create_service(SetBool, "/lamp/switch", switch)
    client.node.create_service(service_class("example_interfaces/srv/AddTwoInts"), "/add", add)
    client.node.create_service(Trigger, "/pause_physics", lambda _, response: response)
    print("ready", flush=True)
    rclpy.spin(client.node)
"""
WORLD = '<sdf version="1.9"><world name="w"><plugin filename="caller.py:Caller" name="caller"/></world></sdf>'
CALLER = """
import simkit

class Caller(simkit.WorldPlugin):
    after_step_rate = 20.0

    def load(self, sim, params):
        self.calls, self.answers = 0, self.advertise("/answers", "std_msgs/msg/String", latched=True)

    def after_step(self):
        if not self.calls and "/add" in self.sim.communication.services.names():
            self.calls += 1
            self.sim.call("/add", {"a": 20, "b": 22}, on_done=self.on_done)

    def on_done(self, call):
        self.answers.publish({"data": str(call.error or call.response.sum)})
"""


@contextmanager
def serving(python: Path) -> Iterator[subprocess.Popen[str]]:
    """A node of ROS with three services."""
    command = [str(python), str(FOLDER / "ros_client.py"), textwrap.dedent(SERVER)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=ros_environment()) as process:
        try:
            assert process.stdout is not None
            assert process.stdout.readline() == "ready\n"
            yield process
        finally:
            process.kill()


def until(client: Client, condition: Callable[[], bool]) -> None:
    for _ in range(int(TIMEOUT / 0.1)):
        if condition():
            return
        client.receive(0.1)
    raise TimeoutError


def test_services_of_ros_appear_are_called_and_end(
    simkit_run: Callable[..., Any], ros_python: Path, tmp_path: Path
) -> None:
    (tmp_path / "caller.py").write_text(CALLER)
    (tmp_path / "w.sdf").write_text(WORLD)
    options = ("--rtf", "1", "--plugin-path", str(tmp_path), "--name", "lab")
    with simkit_run(str(tmp_path / "w.sdf"), *options) as run, connect("lab", wait=20.0) as client:
        before = client.services()
        with serving(ros_python) as process:
            until(client, lambda: {"/lamp/switch", "/add"} <= client.services().keys())
            found = client.services()
            assert {k: v for k, v in found.items() if k not in before} == {
                "/lamp/switch": "std_srvs/srv/SetBool",
                "/add": "example_interfaces/srv/AddTwoInts",
            }
            assert found["/pause_physics"] == before["/pause_physics"], "that of the simulation"
            assert client.call("/lamp/switch", {"data": True}).message == "lit [True]"
            assert client.call("/lamp/switch", {"data": False}).message == "lit [True, False]"
            assert client.call("/add", {"a": 2, "b": 40}).sum == 42
            answers = client.subscribe("/answers")
            answer = answers.get(20.0)
            assert answer is not None and answer.message.data == "42", "the answer to the plugin"
            process.kill()
            with pytest.raises(LiveError) as error:
                client.call("/lamp/switch", {"data": True}, timeout=60.0)
            assert error.value.code == "SK-SERVICE-010"
        until(client, lambda: "/lamp/switch" not in client.services())
        assert "left out" not in run.text
