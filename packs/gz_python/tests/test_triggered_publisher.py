"""TriggeredPublisher of Gazebo: outputs after matching messages, with delays, and service calls."""

from __future__ import annotations

from typing import Any

import pytest

import simkit
from simkit.errors import LoadError

KIND = 'filename="gz-sim-triggered-publisher-system" name="gz::sim::systems::TriggeredPublisher"'
OUT = '<output type="gz.msgs.Empty" topic="/out"/>'
GATE = """<plugin name="gz::sim" filename="dummy"><performer name="p"><ref>robot</ref><geometry><box><size>1 1 1</size>
</box></geometry></performer></plugin><model name="gate"><static>true</static><link name="l"/><plugin
filename="gz-sim-performer-detector-system" name="gz::sim::systems::PerformerDetector"><geometry><box><size>1 1 1</size>
</box></geometry></plugin></model>"""
ROBOT = """<model name="robot"><pose>5 0 0 0 0 0</pose><link name="l"><inertial><mass>1</mass><inertia><ixx>1</ixx>
<iyy>1</iyy><izz>1</izz></inertia></inertial></link></model>"""


def world(inner: str, more: str = "") -> str:
    return f"""<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>{ROBOT}{more}
    <plugin {KIND}>{inner}</plugin></world></sdf>"""


def listening(kind: str, *matches: str) -> str:
    return f'<input type="gz.msgs.{kind}" topic="/in">{"".join(matches)}</input>{OUT}'


def answers(sim: Any, topic: str = "/out") -> list[int]:
    ticks: list[int] = []
    sim.subscribe(topic, lambda _: ticks.append(sim.tick))
    return ticks


def count(kind: str, message: dict[str, Any], *matches: str) -> int:
    """Return the number of outputs after one message."""
    with simkit.load(world(listening(kind, *matches))) as sim:
        found = answers(sim)
        sim.publish("/in", message)
        sim.run(0.01)
        return len(found)


def test_without_a_match_every_message_triggers() -> None:
    with simkit.load(world(listening("Boolean"))) as sim:
        assert sim.topics()["/in"] == "std_msgs/msg/Bool"
        assert sim.topics()["/out"] == "std_msgs/msg/Empty"
        found = answers(sim)
        for _ in range(3):
            sim.publish("/in", {"data": False})
        sim.run(0.01)
        assert found == [0, 0, 0]


@pytest.mark.parametrize(
    ("kind", "message", "matches", "answered"),
    [
        ("Boolean", {"data": True}, ["<match>data: true</match>"], 1),
        ("Boolean", {"data": False}, ["<match>data: true</match>"], 0),
        ("Int32", {"data": 3}, ['<match logic_type="negative">data: 1</match>'] * 2, 1),
        ("Int32", {"data": 1}, ['<match logic_type="negative">data: 1</match>'], 0),
        ("Vector3d", {"x": 1.0, "y": 2.0}, ['<match field="x">1.0</match>', '<match field="y">2.0</match>'], 1),
        ("Vector3d", {"x": 1.0, "y": 2.5}, ['<match field="x">1.0</match>', '<match field="y">2.0</match>'], 0),
        ("Twist", {"linear": {"x": 0.25}}, ['<match field="linear.x" tol="0.1">0.3</match>'], 1),
        ("Twist", {"linear": {"x": 0.25}}, ['<match field="linear">{x: 0.25}</match>'], 1),
        ("Float", {"data": 0.1}, ['<match field="data">0.1</match>'], 1),
        ("Float_V", {"data": [1, 2, 3]}, ['<match field="data">[3, 1]</match>'], 1),
        ("BatteryState", {"power_supply_status": 1}, ['<match field="power_supply_status">CHARGING</match>'], 1),
        ("StringMsg", {"data": "go"}, ["<match>data: 'go'</match>"], 1),
    ],
)
def test_matches_work_as_in_gazebo(kind: str, message: dict[str, Any], matches: list[str], answered: int) -> None:
    assert count(kind, message, *matches) == answered


def test_several_outputs_with_their_contents() -> None:
    inner = """<input type="ignition.msgs.Empty" topic="in"/>
    <output type="gz.msgs.Twist" topic="/cmd">linear: {x: 3}, angular {z: -0.5}</output>
    <output type="gz.msgs.StringMsg" topic="say">data: "hello"</output>"""
    with simkit.load(world(inner)) as sim:
        commands, words = sim.subscribe("/cmd"), sim.subscribe("/say")
        sim.publish("/in", {})
        sim.run(0.01)
        assert (commands.latest.linear.x, commands.latest.angular.z) == (3.0, -0.5)
        assert words.latest.data == "hello"


def test_a_delay_counts_in_simulated_time() -> None:
    with simkit.load(world(listening("Empty") + "<delay_ms>250</delay_ms>")) as sim:
        found = answers(sim)
        sim.run(0.1)
        sim.publish("/in", {})
        sim.run(0.05)
        sim.publish("/in", {})
        sim.run(1.0)
        assert found == [350, 400]


def test_delayed_outputs_survive_a_restore_but_not_a_reset() -> None:
    with simkit.load(world(listening("Empty") + "<delay_ms>250</delay_ms>")) as sim:
        found = answers(sim)
        sim.publish("/in", {})
        sim.run(0.1)
        snapshot = sim.snapshot()
        sim.run(0.3)
        sim.restore(snapshot)
        sim.run(0.3)
        assert found == [250, 250]
        sim.restore(snapshot)
        sim.reset()
        sim.run(0.5)
        assert found == [250, 250]


def test_an_output_triggers_another_publisher_in_the_next_step_of_the_same_run() -> None:
    """No other callback is due between the two steps."""
    chain = f'<plugin {KIND}><input type="gz.msgs.Empty" topic="/out"/><output type="gz.msgs.Empty" topic="/end"/>'
    with simkit.load(world(listening("Empty"), f"{chain}</plugin>")) as sim:
        found = answers(sim, "/end")
        sim.publish("/in", {})
        sim.run(0.01)
        assert found == [1]


def test_services_are_called() -> None:
    inner = """<input type="gz.msgs.Empty" topic="/in"/><service name="/world/w/set_pose" reqType="gz.msgs.Pose"
    repType="gz.msgs.Boolean" timeout="3000" reqMsg="name: 'robot', position: {x: -3, z: 0.5}"/>"""
    with simkit.load(world(inner)) as sim:
        sim.publish("/in", {})
        sim.run(0.01)
        assert sim.model("robot").pose.position.tolist() == pytest.approx([-3, 0, 0.5])
        assert "SK-PLUGIN-122" not in [d.code for d in sim.diagnostics]


def test_a_missing_service_is_reported_once() -> None:
    inner = """<input type="gz.msgs.Empty" topic="/in"/><service name="/world/w/set_pos" reqType="gz.msgs.Pose"
    repType="gz.msgs.Boolean" timeout="3000" reqMsg="name: 'robot'"/>"""
    with simkit.load(world(inner)) as sim:
        for _ in range(2):
            sim.publish("/in", {})
            sim.run(0.01)
        (warning,) = [d for d in sim.diagnostics if d.code == "SK-PLUGIN-122"]
        assert "set_pose" in warning.hint


def test_the_header_of_a_performer_detector_is_matched() -> None:
    inner = f"""<input type="gz.msgs.Pose" topic="/model/gate/performer_detector/status">
    <match field="header.data">{{key: "state", value: "1"}}</match>
    <match field="header.data">{{key: "count", value: "1"}}</match></input>{OUT}"""
    with simkit.load(world(inner, GATE)) as sim:
        found = answers(sim)
        sim.run(0.01)
        sim.model("robot").set_pose(simkit.Pose((0, 0, 0)))
        sim.run(0.01)
        sim.model("robot").set_pose(simkit.Pose((5, 0, 0)))
        sim.run(0.01)
        assert found == [11]


@pytest.mark.parametrize(
    ("inner", "pattern"),
    [
        (OUT, "needs <input>"),
        ('<input type="gz.msgs.Empty" topic="/in"/>', "needs an <output> or a <service>"),
        (f'<input type="gz.msgs.Bolean" topic="/in"/>{OUT}', "did you mean 'Boolean'"),
        (f'<input type="gz.msgs.Empty"/>{OUT}', "topic="),
        (listening("Twist", '<match field="linear.w">1</match>'), "no field 'w'"),
        (listening("Twist", '<match logic_type="maybe">linear {}</match>'), "positive or negative"),
        (listening("Twist", '<match tol="-1">linear {}</match>'), "at least 0"),
        (listening("Twist", "<match/>"), "<match>"),
        ('<input type="gz.msgs.Empty" topic="/a"/><output type="gz.msgs.Twist" topic="/b">x: 1</output>', "no field"),
    ],
)
def test_invalid_elements_are_errors_with_their_line(inner: str, pattern: str) -> None:
    with pytest.raises(LoadError, match=pattern) as raised:
        simkit.load(world(inner))
    assert all(d.line for d in raised.value.diagnostics if d.severity == "error")


def test_all_problems_are_reported_in_one_load() -> None:
    inner = '<input type="gz.msgs.A" topic="/a"/><output type="gz.msgs.B" topic="/b"/><delay_ms>x</delay_ms>'
    with pytest.raises(LoadError) as raised:
        simkit.load(world(inner))
    assert len([d for d in raised.value.diagnostics if d.severity == "error"]) == 3


def test_an_idle_publisher_needs_no_callback() -> None:
    with simkit.load(world(listening("Empty") + "<delay_ms>5</delay_ms>")) as sim:
        sim.run(0.01)
        (plugin,) = [p for p in sim.engine.structure.all_plugins() if type(p).__name__ == "TriggeredPublisher"]
        assert plugin.before_step_rate == pytest.approx(0.0, abs=1e-6)
        sim.publish("/in", {})
        sim.run(0.002)
        assert plugin.before_step_rate is None
        sim.run(0.01)
        assert plugin.before_step_rate == pytest.approx(0.0, abs=1e-6)
