"""A replay has the topics, services, actions and parameters that a script opened, without the script."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import simkit
from simkit_verification.testing.bundles import keep, replay, write_bundle

CALLER = '''"""Plugin that asks a script for each velocity of its model."""

import simkit


class Caller(simkit.ModelPlugin):
    filenames = ("libcaller.so",)
    after_step_rate = 50.0

    def load(self, model, params):
        self.model, self.count = model, 0
        self.gain = None
        self.said = self.advertise("/said", "std_msgs/msg/Float64")

    def after_step(self):
        self.count += 1
        if self.count % 3 == 0:
            answer = self.sim.call("/add", {"a": self.count, "b": 1}).sum
            self.model.set_velocity((0.01 * answer, 0.0, 0.0), (0.0, 0.0, 0.0))
        if self.count % 3 == 1:
            self.sim.call("/add", {"a": self.count, "b": 5}, on_done=self.on_answer)
        if self.count == 5:
            self.sim.send_goal("/fibonacci", {"order": 4}, self.on_feedback, self.on_result)
        self.said.publish({"data": float(self.count)})

    def on_answer(self, call):
        self.model.set_velocity((0.0, 0.01 * call.response.sum, 0.0), (0.0, 0.0, 0.0))

    def on_feedback(self, feedback):
        self.model.set_velocity((0.0, 0.0, 0.1 * feedback.sequence[-1]), (0.0, 0.0, 0.0))

    def on_result(self, goal):
        self.model.set_velocity((1.0, 0.0, 0.01 * goal.result.sequence[-1]), (0.0, 0.0, 0.0))
'''
WORLD = """<sdf version="1.9"><world name="yard"><gravity>0 0 0</gravity>
<model name="cart"><pose>0 0 0.5 0 0 0</pose><link name="base"/><plugin filename="libcaller.so" name="caller"/></model>
<model name="box"><pose>2 0 1 0 0 0</pose><link name="l"/></model></world></sdf>"""


@pytest.fixture
def yard(tmp_path: Path) -> Path:
    """World with a plugin that calls a script."""
    (tmp_path / "plugins").mkdir()
    (tmp_path / "plugins" / "caller.py").write_text(CALLER)
    (tmp_path / "yard.sdf").write_text(WORLD)
    return tmp_path / "yard.sdf"


def test_a_run_with_servers_of_a_script_is_repeated_without_the_script(yard: Path) -> None:
    goals: list[Any] = []
    with simkit.load(yard, plugin_paths=[yard.parent / "plugins"]) as sim, keep(sim):

        def add(request: Any) -> dict[str, int]:
            sim.model("box").set_velocity((0.1 * request.a, 0.0, 0.0), (0.0, 0.0, 0.0))
            return {"sum": request.a + request.b}

        service = sim.offer("/add", "example_interfaces/srv/AddTwoInts", add)
        action = sim.act("/fibonacci", "example_interfaces/action/Fibonacci", goals.append, lambda _: False)
        gain = sim.declare("gain", 1.0, on_change=lambda value: sim.publish("/level", {"data": value}))
        sim.advertise("/level", "std_msgs/msg/Float64")
        sim.listen("/said", "std_msgs/msg/Float64", lambda m: sim.set_parameter("/script", "gain", m.data))
        sim.run(0.2)
        goals[0].publish_feedback({"sequence": [0, 1, 3]})
        sim.run(0.1)
        before = sim.snapshot()
        sim.run(0.1)
        sim.restore(before)
        sim.run(0.1)
        goals[0].succeed({"sequence": [7]})
        sim.run(0.1)
        last = sim.send_goal("/fibonacci")
        sim.run(0.02)
        last.cancel()
        action.close()
        sim.run(0.02)
        assert (last.reason, gain.value > 20.0) == ("the action was closed", True)
        found = replay(write_bundle(sim, yard.parent / "run.zip"), allow_code=True)
        service.close()
    assert found.is_same, (found.differences, found.refused)
    assert not found.refused
    assert not found.manifest.missing


def test_a_call_that_a_script_fails_to_answer_is_repeated(yard: Path) -> None:
    with simkit.load(yard, plugin_paths=[yard.parent / "plugins"]) as sim, keep(sim):
        sim.offer("/add", "example_interfaces/srv/AddTwoInts", lambda request: {"sum": 3 // request.b})
        assert sim.call("/add", {"b": 2}).sum == 1
        with pytest.raises(simkit.SimkitError, match="ZeroDivisionError"):
            sim.call("/add", {"b": 0})
        sim.run(0.02)
        found = replay(write_bundle(sim, yard.parent / "run.zip"), allow_code=True)
    assert found.is_same, (found.differences, found.refused)
