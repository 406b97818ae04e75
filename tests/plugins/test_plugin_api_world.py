"""Changes of the world in hooks: motion, forces, lights, gravity, added sensors, spawning and removal."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from plugin_worlds import GROUND, rover, world

import simkit
from simkit import Params, Pose, WorldPlugin
from simkit.runtime import Simulation


def ball(name: str = "ball", pose: str = "0 0 1 0 0 0", inside: str = "") -> str:
    shape = "<collision name='c'><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>"
    link = f"<link name='l'><inertial><mass>2</mass></inertial>{shape}{inside}</link>"
    return f"<model name='{name}'><pose>{pose}</pose>{link}</model>"


def file(model: str) -> str:
    return f"<sdf version='1.9'>{model}</sdf>"


ARM = """<model name="arm"><link name="base"/><joint name="w" type="fixed"><parent>world</parent><child>base</child>
</joint><link name="rod"><inertial><mass>1</mass></inertial></link><joint name="j" type="revolute">
<parent>base</parent><child>rod</child><axis><xyz>0 0 1</xyz></axis></joint></model>"""
LAMP = "<light name='lamp' type='point'><pose>0 0 3 0 0 0</pose></light>"
IMU = "<sensor name='imu' type='imu'><update_rate>100</update_rate><topic>added</topic></sensor>"


class Once(WorldPlugin):
    """Calls a function once, in a hook at a given time."""

    def __init__(self, what: Callable[[Simulation], Any], at: float = 0.1, hook: str = "after_step") -> None:
        self.what, self.at, self.hook = what, at, hook
        self.is_done = False

    def load(self, parent: Simulation, params: Params) -> None:
        pass

    def before_step(self) -> None:
        self.do("before_step")

    def after_step(self) -> None:
        self.do("after_step")

    def do(self, hook: str) -> None:
        if hook == self.hook and not self.is_done and self.sim.time > self.at - 1e-9:
            self.is_done = True
            self.what(self.sim)


def bits(sim: Simulation, model: str = "rover") -> bytes:
    """Return pose and velocities of a model."""
    found = sim.model(model)
    parts = [np.asarray(v) for v in (found.pose.position, found.pose.quaternion)]
    parts += [np.asarray(j.velocity) for j in found.joints.values()]
    return b"".join(p.tobytes() for p in parts)


def run(plugin: WorldPlugin, *parts: str, until: float = 0.2) -> Simulation:
    sim = simkit.load(world(*parts), plugins=[plugin])
    sim.run(until)
    return sim


@pytest.mark.parametrize("hook", ["before_step", "after_step"])
def test_poses_velocities_joints_and_efforts_can_be_set_from_a_hook(hook: str) -> None:
    def act(sim: Simulation) -> None:
        sim.model("ball").set_pose(Pose((5, 6, 7)))
        sim.model("ball").set_velocity((0, 3, 0))
        sim.joint("arm::j").set_position(0.5)
        sim.joint("arm::j").set_velocity(2.0)
        sim.joint("arm::j").set_effort(1000.0)  # for one step of 1 ms on an inertia of 1: 1 rad/s more

    with run(Once(act, 0.1, hook), "<gravity>0 0 0</gravity>", ball(), ARM, until=0.2) as sim:
        passed = 0.1
        assert sim.model("ball").pose.position == pytest.approx([5, 6 + 3 * passed, 7], abs=1e-9)
        assert sim.joint("arm::j").velocity == pytest.approx(3.0, rel=1e-6)
        assert sim.joint("arm::j").position == pytest.approx(0.5 + 3.0 * passed, abs=2e-3)


def test_gravity_is_read_and_set_in_a_hook_and_restored() -> None:
    def turn(sim: Simulation) -> None:
        assert sim.gravity == pytest.approx([0, 0, -9.8])
        sim.gravity = (0, 0, 2.0)

    with run(Once(turn, 0.1), ball(), until=0.1) as sim:
        speed = sim.link("ball::l").linear_velocity[2]
        assert speed == pytest.approx(-0.98, rel=1e-6)
        before = sim.snapshot()
        sim.run(0.1)
        assert sim.link("ball::l").linear_velocity[2] - speed == pytest.approx(0.2, rel=1e-6)
        sim.gravity = (1.0, 0, 0)
        sim.restore(before)
        assert sim.gravity == pytest.approx([0, 0, 2.0])
        sim.reset()
        assert sim.gravity == pytest.approx([0, 0, -9.8])
        with pytest.raises(ValueError, match="3 finite numbers"):
            sim.gravity = (0, 0)


def test_a_resting_body_falls_when_gravity_turns() -> None:
    with simkit.load(world(GROUND, ball(pose="0 0 0.1 0 0 0"))) as sim:
        sim.run(5.0)
        sim.gravity = (0, 0, 9.8)
        sim.run(0.5)
        assert sim.model("ball").pose.position[2] == pytest.approx(0.1 + 0.5 * 9.8 * 0.25, rel=0.02)


def test_lights_move_and_change_from_a_hook() -> None:
    def dim(sim: Simulation) -> None:
        lamp = sim.light("lamp")
        lamp.set_pose(Pose((1, 2, 4)))
        lamp.change(replace(lamp.scene, diffuse=(0.5, 0.0, 0.0, 1.0)))

    with run(Once(dim), LAMP) as sim:
        assert sim.light("lamp").pose.position == pytest.approx([1, 2, 4])
        assert sim.mj_model.light_diffuse[0] == pytest.approx([0.5, 0, 0])
        sim.reset()
        assert sim.light("lamp").pose.position == pytest.approx([0, 0, 3])
        assert sim.mj_model.light_diffuse[0] != pytest.approx([0.5, 0, 0])


# ---------------------------------------------------------------------- sensors


@pytest.mark.parametrize("hook", ["before_step", "after_step"])
def test_a_sensor_added_in_a_hook_measures_from_then_on(hook: str) -> None:
    with simkit.load(
        world(GROUND, ball(), rover()), plugins=[Once(lambda sim: sim.contents.add_sensor("ball::l", IMU), 0.05, hook)]
    ) as sim:
        got = sim.subscribe("/added")
        sim.run(0.2)
        sensor = sim.sensor("ball::l::imu")
        stamps = [m.header.stamp.nanosec for m in got.messages]
        assert sim.topics()["/added"] == "sensor_msgs/msg/Imu"
        assert stamps[-3:] == [180_000_000, 190_000_000, 200_000_000]
        assert stamps[0] >= 50_000_000
        # in free fall it feels nothing
        assert abs(sensor.latest.linear_acceleration.z) < 1e-6


def test_adding_a_sensor_does_not_change_other_readings() -> None:
    ends = []
    for what in (lambda sim: None, lambda sim: sim.contents.add_sensor("ball::l", IMU)):
        with run(Once(what, 0.1), GROUND, ball(), rover(), until=0.5) as sim:
            ends.append(bits(sim) + bits(sim, "ball"))
    assert ends[0] == ends[1]


def test_snapshot_restore_reset_and_remove_include_an_added_sensor() -> None:
    with simkit.load(world(GROUND, ball())) as sim:
        sim.run(0.05)
        before = sim.snapshot()
        sim.contents.add_sensor("ball::l", IMU)
        with_it = sim.snapshot()
        sim.run(0.1)
        seen = sim.sensor("ball::l::imu").latest
        sim.restore(with_it)
        sim.run(0.1)
        assert sim.sensor("ball::l::imu").latest.header.stamp == seen.header.stamp
        sim.restore(before)
        assert not sim.contents.has_sensor("ball::l::imu") and "/added" not in sim.topics()
        sim.restore(with_it)
        assert sim.contents.has_sensor("ball::l::imu")
        sim.remove("ball")
        assert not sim.contents.has_sensor("ball::l::imu")
        sim.reset()
        assert not sim.contents.has_sensor("ball::l::imu") and "ball" in sim.models


def test_a_sensor_from_a_dict_equals_one_from_xml() -> None:
    noise = {"@type": "gaussian", "mean": 0.5, "stddev": 0.0}
    lidar = {
        "name": "scan",
        "type": "ray",
        "update_rate": 10,
        "topic": "scan",
        "pose": (0, 0, 0.5, 0, 0, 0),
        "lidar": {
            "scan": {"horizontal": {"samples": 5, "min_angle": -1, "max_angle": 1}},
            "range": {"min": 0.1, "max": 7},
            "noise": noise,
        },
    }
    with simkit.load(world(GROUND, rover())) as sim:
        sensor = sim.contents.add_sensor("rover::base", lidar)
        sim.run(0.2)
        assert sensor.pose.position[2] == pytest.approx(0.63, abs=0.02)
        assert len(sensor.latest.ranges) == 5 and sensor.latest.range_max == pytest.approx(7)


def test_a_sensor_can_be_added_to_a_joint() -> None:
    with simkit.load(world("<gravity>0 0 -10</gravity>", ARM)) as sim:
        sensor = sim.contents.add_sensor("arm::j", "<sensor name='ft' type='force_torque'/>")
        sim.run(0.1)
        assert abs(sensor.latest.wrench.force.z) == pytest.approx(10.0, rel=1e-3)


def test_an_invalid_sensor_is_reported_and_nothing_changes() -> None:
    with simkit.load(world(GROUND, ball())) as sim:
        for name, sensor, error, text in (
            ("ball::x", IMU, KeyError, "ball::l"),
            ("ball::l", {"name": "i"}, simkit.SimkitError, "'type'"),
            (
                "ball::l",
                "<sensor name='i' type='imu'><update_rate>fast</update_rate></sensor>",
                simkit.LoadError,
                "fast",
            ),
            ("ball::l", "<sensor name='i' type='nose'/>", simkit.LoadError, "nose"),
            ("ball::l", "<sensor name='i'", simkit.LoadError, "XML"),
            ("ball::l", "", simkit.SimkitError, "one <sensor>"),
        ):
            with pytest.raises(error, match=text):
                sim.contents.add_sensor(name, sensor)
            assert not sim.contents.sensors
        sim.contents.add_sensor("ball::l", IMU)
        with pytest.raises(simkit.SimkitError, match="already"):
            sim.contents.add_sensor("ball::l", IMU)
        sim.contents.add_sensor(
            "ball::l", IMU.replace("'imu'", "'two'", 1).replace("<topic>", "<tpic>").replace("</topic>", "</tpic>")
        )
        found = [d for d in sim.diagnostics if d.code == "SK-PARAM-003"]
        assert len(found) == 1 and "topic" in found[0].hint


# ---------------------------------------------------------------------- models


@pytest.mark.parametrize("hook", ["before_step", "after_step"])
def test_models_are_spawned_and_removed_from_hooks(hook: str) -> None:
    def change(sim: Simulation) -> None:
        sim.spawn(file(ball("new")), pose=Pose((0, 3, 1)))
        sim.remove("ball")

    with run(Once(change, 0.1, hook), GROUND, ball(), rover(), until=0.1 if hook == "after_step" else 0.101) as sim:
        assert set(sim.models) == {"ground", "rover", "new"}
        fallen = sim.model("new").pose.position[2]
        sim.run(0.2)
        assert fallen - sim.model("new").pose.position[2] == pytest.approx(0.5 * 9.8 * 0.04, rel=0.05)
        sim.reset()
        assert set(sim.models) == {"ground", "rover", "ball"}


def test_a_plugin_may_remove_its_own_model(tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text(
        "from simkit import ModelPlugin\n"
        "class Mine(ModelPlugin):\n"
        "    def load(self, parent, params):\n"
        "        self.said = []\n"
        "    def after_step(self):\n"
        "        if self.sim.time > 0.05:\n"
        "            self.sim.remove('ball')\n"
        "            self.said.append('still at work')\n"
    )
    model = ball().replace("</model>", "<plugin name='p' filename='mine.py'/></model>")
    with simkit.load(world(GROUND, model), plugin_paths=[tmp_path]) as sim:
        sim.run(0.2)
        assert "ball" not in sim.models
        sim.reset()
        assert "ball" in sim.models
        sim.run(0.2)
        assert "ball" not in sim.models


# ---------------------------------------------------------------------- the end of a plugin

CLOSER = """
from simkit import ModelPlugin, msgs
CLOSED = []
class Closer(ModelPlugin):
    def load(self, parent, params):
        self.out = self.advertise("out", "std_msgs/msg/Float64")
        self.offer("serve", "std_srvs/srv/Trigger", lambda request: None)
        self.gain = self.declare("gain", 1.0)
    def close(self):
        CLOSED.append(self.name)
"""


@pytest.fixture
def closer(tmp_path: Path) -> Path:
    (tmp_path / "closer.py").write_text(CLOSER)
    return tmp_path


def with_closer(name: str) -> str:
    return file(ball(name).replace("</model>", f"<plugin name='{name}' filename='closer.py'/></model>"))


def closed(sim: Simulation) -> list[str]:
    plugin = next(p for p in sim.contents.spawner.loaded_plugins if type(p).__name__ == "Closer")
    found: list[str] = type(plugin).load.__globals__["CLOSED"]
    return found


def test_a_plugin_of_a_removed_model_is_closed_and_freed_once_no_snapshot_has_it(closer: Path) -> None:
    with simkit.load(world(GROUND), plugin_paths=[closer]) as sim:
        sim.spawn(with_closer("a"))
        closed_names = closed(sim)
        loaded_count = len(sim.contents.spawner.loaded_plugins)
        plugin = weakref.ref(sim.contents.plugins["a::a"])
        snapshot = sim.snapshot()
        sim.remove("a")
        assert closed_names == []  # the snapshot has it
        sim.restore(snapshot)
        assert "/serve" in sim.communication.services.names()
        sim.remove("a")
        del snapshot
        sim.spawn(with_closer("b"))
        sim.remove("b")
        assert closed_names == ["a", "b"]
        assert len(sim.contents.spawner.loaded_plugins) == loaded_count - 1
        gc.collect()
        assert plugin() is None
        assert "/serve" not in sim.communication.services.names() and not sim.communication.parameters
    assert closed_names == ["a", "b"]


def test_a_plugin_of_the_file_is_closed_once_at_the_end(closer: Path) -> None:
    sim = simkit.load(world(with_closer("m")[len("<sdf version='1.9'>") : -len("</sdf>")]), plugin_paths=[closer])
    closed_names = closed(sim)
    sim.remove("m")
    sim.step()
    assert closed_names == []
    sim.reset()
    sim.close()
    sim.close()
    assert closed_names == ["m"]


def test_a_thousand_spawned_and_removed_models_leave_no_memory_behind(closer: Path) -> None:
    with simkit.load(world(GROUND), plugin_paths=[closer]) as sim:
        for i in range(20):
            sim.spawn(with_closer(f"n{i}"))
            sim.step()
            sim.remove(f"n{i}")
        owners = [p.owner for ends in sim.communication.bus._publishers.values() for p in ends if p.owner is not None]
        assert not [o for o in owners if type(o).__name__ == "Closer"]
        assert len(sim.contents.handles._by_scene) == 1


# ---------------------------------------------------------------------- what nobody read


def unread(sim: Simulation, code: str = "SK-PARAM-003") -> list[tuple[str, str, int | None]]:
    return [(d.message, d.hint, d.line) for d in sim.diagnostics if d.code == code]


READER = """
from simkit import WorldPlugin
class Reader(WorldPlugin):
    def load(self, parent, params):
        if params.choice("mode", ("pid", "open"), "open") == "pid":
            self.gain = params.number("p_gain", 1.0)
        for one in params.all("gain"):
            one.attribute("unit")
            one.block("limits").number("upper", 0.0)
"""


def reader(tmp_path: Path, body: str) -> Simulation:
    (tmp_path / "reader.py").write_text(READER)
    return simkit.load(world(f"<plugin name='r' filename='reader.py'>\n{body}</plugin>"), plugin_paths=[tmp_path])


def test_an_element_read_only_under_a_condition_is_reported_with_that_hint(tmp_path: Path) -> None:
    with reader(tmp_path, "<p_gain>3</p_gain>") as sim:
        ((message, hint, line),) = unread(sim)
        assert "<p_gain> is not used" in message and "reads <p_gain> only with other options" in hint and line
    with reader(tmp_path, "<mode>pid</mode><p_gain>3</p_gain>") as sim:
        assert not unread(sim)
    with reader(tmp_path, "<p_gian>3</p_gian>") as sim:
        ((_, hint, _),) = unread(sim)
        assert hint == "did you mean 'p_gain'?"


def test_unread_elements_of_a_spawned_model_are_reported(tmp_path: Path) -> None:
    text = READER.replace("WorldPlugin", "ModelPlugin")
    (tmp_path / "reader.py").write_text(text)
    extra = "<plugin name='r' filename='reader.py'><gian>1</gian></plugin></model>"
    with simkit.load(world(GROUND), plugin_paths=[tmp_path]) as sim:
        sim.spawn(file(ball().replace("</model>", extra)))
        ((message, hint, _),) = unread(sim)
    assert "<gian>" in message and "'gain'" in hint


def test_unread_attributes_are_reported_with_the_closest_name(tmp_path: Path) -> None:
    with reader(tmp_path, "<gain unti='rad' x:y='1'><limits lower='2'><upper>1</upper></limits></gain>") as sim:
        found = unread(sim, "SK-PARAM-007")
        assert ["'unti' of <gain>" in found[0][0], "'unit'" in found[0][1]] == [True, True]
        assert "'lower' of <limits>" in found[1][0] and len(found) == 2
        assert not unread(sim)


def test_a_plugin_of_a_removed_model_receives_nothing_until_a_restore_brings_it_back(tmp_path: Path) -> None:
    (tmp_path / "ear.py").write_text(
        "from simkit import ModelPlugin\n"
        "class Ear(ModelPlugin):\n"
        "    def load(self, parent, params):\n"
        "        answers = self.advertise('answers', 'std_msgs/msg/String')\n"
        "        self.subscribe('questions', lambda m: answers.publish({'data': m.data}), keep=0)\n"
    )
    model = ball("ear").replace("</model>", "<plugin name='p' filename='ear.py'/></model>")
    with simkit.load(world(GROUND), plugin_paths=[tmp_path]) as sim:
        questions, answers = sim.advertise("/questions", "std_msgs/msg/String"), sim.subscribe("/answers")

        def ask(text: str) -> list[str]:
            questions.publish({"data": text})
            return [message.data for message in answers.messages]

        sim.spawn(file(model))
        assert ask("spawned") == ["spawned"]
        with_model = sim.snapshot()
        sim.remove("ear")
        assert ask("removed") == ["spawned"] and questions.subscribers == 0
        sim.restore(with_model)
        assert ask("restored") == ["spawned", "restored"]
        sim.reset()
        assert ask("reset") == ["spawned", "restored"]
        sim.spawn(file(model))
        assert ask("again") == ["spawned", "restored", "again"]
