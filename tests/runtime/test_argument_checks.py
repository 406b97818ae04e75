"""Wrong arguments and closed simulations raise one clear error, and change nothing."""

from __future__ import annotations

import math
import pickle
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

import simkit
from simkit.errors import ArgumentTypeError, ArgumentValueError, InputError
from simkit.live import connect
from simkit.runtime.engine.snapshot import state_hash

WORLD = """<sdf version="1.9"><world name="w"><light name="sun" type="directional"/><model name="b">
<pose>0 0 1 0 0 0</pose><link name="l"><inertial><mass>1</mass></inertial><collision name="c"><geometry><box>
<size>.1 .1 .1</size></box></geometry></collision><sensor name="imu" type="imu"/></link><link name="m"/>
<joint name="j" type="revolute"><parent>l</parent><child>m</child><axis><xyz>0 0 1</xyz></axis></joint></model>
</world></sdf>"""
SPAWNED = '<sdf version="1.9"><model name="q"><link name="l"/></model></sdf>'
ORIGIN = (0.0, 0.0, 0.0)
NAN = (math.nan, 0.0, 0.0)


class Raising:
    """Object that raises an error if it is converted or printed."""

    def __getattr__(self, name: str) -> object:
        raise RuntimeError(name)

    def __repr__(self) -> str:
        raise RuntimeError


@pytest.fixture(scope="module")
def open_sim() -> Iterator[simkit.Simulation]:
    with simkit.load(WORLD) as sim:
        yield sim


Call = Callable[[simkit.Simulation], object]
WRONG_TYPES: dict[str, Call] = {
    "step text": lambda sim: sim.step("x"),
    "step None": lambda sim: sim.step(None),
    "run text": lambda sim: sim.run("x"),
    "run list": lambda sim: sim.run([1.0]),
    "run_until": lambda sim: sim.run_until(None, 1),
    "reset": lambda sim: sim.reset("x"),
    "reset with changes": lambda sim: sim.reset(keep_changes=np.zeros(3)),
    "restore": lambda sim: sim.restore(None),
    "model": lambda sim: sim.model(None),
    "visual": lambda sim: sim.visual(3),
    "spawn": lambda sim: sim.spawn(None),
    "spawn pose": lambda sim: sim.spawn(SPAWNED, pose=(0, 0, 1)),
    "remove": lambda sim: sim.remove([1]),
    "subscribe": lambda sim: sim.subscribe(None),
    "array as topic": lambda sim: sim.subscribe(np.zeros(2)),
    "callback": lambda sim: sim.subscribe("/x", 3),
    "publish topic": lambda sim: sim.publish(None, {}),
    "offer": lambda sim: sim.offer("/s", "std_srvs/srv/Trigger", None),
    "service type": lambda sim: sim.offer("/s", None, print),
    "on_done": lambda sim: sim.call("/world/w/control", on_done=3),
    "service timeout": lambda sim: sim.call("/world/w/control", timeout="x"),
    "act": lambda sim: sim.act("/a", "example_interfaces/action/Fibonacci", None),
    "on_cancel": lambda sim: sim.act("/a", "example_interfaces/action/Fibonacci", print, 3),
    "advertise": lambda sim: sim.advertise("/x", None),
    "advertise topic": lambda sim: sim.advertise(None, "std_msgs/msg/String"),
    "listen": lambda sim: sim.listen("/x", "std_msgs/msg/String", None),
    "listen types": lambda sim: sim.listen("/x", [3], print),
    "declare": lambda sim: sim.declare(None, 1.0),
    "parameter": lambda sim: sim.set_parameter(None, "a", 1),
    "model pose": lambda sim: sim.model("b").set_pose(None),
    "link pose": lambda sim: sim.link("b::l").set_pose(np.zeros(7)),
    "light pose": lambda sim: sim.light("sun").set_pose("x"),
    "velocity": lambda sim: sim.model("b").set_velocity(None),
    "wrench": lambda sim: sim.link("b::l").apply_wrench("abc"),
    "position": lambda sim: sim.joint("b::j").set_position("1"),
    "positions": lambda sim: sim.model("b").set_joint_positions(None),
    "limit": lambda sim: setattr(sim.joint("b::j"), "upper", None),
    "rate": lambda sim: sim.sensor("b::l::imu").set_rate("x"),
    "gravity": lambda sim: setattr(sim, "gravity", "x"),
    "velocity raises": lambda sim: sim.model("b").set_velocity(Raising()),
    "pose product": lambda _: simkit.Pose() @ 3,
    "pose text": lambda _: simkit.Pose(("x", 0, 0)),
    "pose raises": lambda _: simkit.Pose((0, 0, 0), Raising()),
    "angle": lambda _: simkit.Pose.from_rpy(0, 0, 0, b"1", 0, 0),
    "angle range": lambda _: simkit.Pose.from_rpy(0, 0, 0, 0, range(3), 0),
    "position of an angle": lambda _: simkit.Pose.from_rpy(Raising(), 0, 0, 0, 0, 0),
    "vector of texts": lambda _: simkit.Pose().rotate(("x", 0, 0)),
    "load None": lambda _: simkit.load(None),
    "load number": lambda _: simkit.load(123),
    "describe": lambda _: simkit.describe(None),
    "paths of describe": lambda _: simkit.describe(WORLD, plugin_paths=range(3)),
    "paths of check": lambda _: simkit.check(WORLD, plugin_paths="plugins"),
    "seed": lambda _: simkit.load(WORLD, seed="x"),
    "seed that is true": lambda _: simkit.load(WORLD, seed=True),
    "seed None": lambda _: simkit.load(WORLD, seed=None),
    "policy that is an array": lambda _: simkit.load(WORLD, on_error=np.zeros(2)),
    "renderer that is an array": lambda _: simkit.load(WORLD, renderer=np.zeros(2)),
    "contacts": lambda sim: sim.contacts(3),
    "choices": lambda sim: sim.declare("p", 1.0, choices=3),
    "on_change": lambda sim: sim.declare("p", 1.0, on_change=3),
    "axis": lambda sim: sim.joint("b::j").axis_velocity_limit("x"),
    "type that is a number": lambda _: simkit.msgs.full_name(3),
    "time of a message": lambda _: simkit.msgs.time("x"),
    "duration of a message": lambda _: simkit.msgs.duration(None),
    "name to connect to": lambda _: connect(3),
    "wait to connect": lambda _: connect("none", wait="x"),
    "one path": lambda _: simkit.load(WORLD, resource_paths="models"),
    "xacro_args": lambda _: simkit.load(WORLD, xacro_args=3),
    "pickled simulation": lambda sim: pickle.dumps(sim),
    "pickled link": lambda sim: pickle.dumps(sim.link("b::l")),
}
WRONG_VALUES: dict[str, Call] = {
    "step negative": lambda sim: sim.step(-1),
    "seed negative": lambda _: simkit.load(WORLD, seed=-1),
    "seed fraction": lambda _: simkit.load(WORLD, seed=1.5),
    "seed NaN": lambda _: simkit.load(WORLD, seed=math.nan),
    "seed of 200 bits": lambda _: simkit.load(WORLD, seed=2**200),
    "seed of 5000 digits": lambda _: simkit.load(WORLD, seed=10**5000),
    "seed of a reset": lambda sim: sim.reset(seed=-1),
    "policy of a subscription": lambda sim: sim.subscribe("/x", on_error=np.zeros(2)),
    "axis beyond the last": lambda sim: sim.joint("b::j").axis_velocity_limit(1),
    "wait NaN": lambda _: connect("none", wait=math.nan),
    "plugin path of load": lambda _: simkit.load(WORLD, plugin_paths=["no/such/folder"]),
    "plugin path of check": lambda _: simkit.check(WORLD, plugin_paths=[__file__]),
    "step fraction": lambda sim: sim.step(1.5),
    "step huge": lambda sim: sim.step(10**400),
    "run NaN": lambda sim: sim.run(math.nan),
    "run infinite": lambda sim: sim.run(math.inf),
    "run negative": lambda sim: sim.run(-1),
    "run huge": lambda sim: sim.run(1e300),
    "timeout": lambda sim: sim.run_until(lambda _: True, -1),
    "subscribe": lambda sim: sim.subscribe(""),
    "listen": lambda sim: sim.listen("/x", [], print),
    "advertise": lambda sim: sim.advertise("", "std_msgs/msg/String"),
    "declare": lambda sim: sim.declare("", 1.0),
    "service timeout": lambda sim: sim.call("/world/w/control", timeout=-1),
    "keep": lambda sim: sim.subscribe("/x", keep=-1),
    "velocity NaN": lambda sim: sim.model("b").set_velocity(NAN),
    "velocity length": lambda sim: sim.link("b::l").set_velocity((1, 2)),
    "wrench NaN": lambda sim: sim.link("b::l").apply_wrench(NAN),
    "torque infinite": lambda sim: sim.link("b::l").apply_wrench(ORIGIN, (math.inf, 0, 0)),
    "position NaN": lambda sim: sim.joint("b::j").set_position(math.nan),
    "positions": lambda sim: sim.model("b").set_joint_positions({"j": math.nan}),
    "joint velocity": lambda sim: sim.joint("b::j").set_velocity([1, 2]),
    "effort NaN": lambda sim: sim.joint("b::j").set_effort(math.nan),
    "limit": lambda sim: setattr(sim.joint("b::j"), "effort_limit", -1),
    "pose NaN": lambda _: simkit.Pose(NAN),
    "pose length": lambda _: simkit.Pose((1, 2)),
    "pose zero": lambda _: simkit.Pose(ORIGIN, (0, 0, 0, 0)),
    "quaternion huge": lambda _: simkit.Pose(ORIGIN, (1e200, 0, 0, 0)),
    "pose huge": lambda _: simkit.Pose((10**5000, 0, 0)),
    "angle huge": lambda _: simkit.Pose.from_rpy(0, 0, 0, 10**5000, 0, 0),
    "angle infinite": lambda _: simkit.Pose.from_rpy(0, 0, 0, 0, 0, math.inf),
    "vector to rotate": lambda _: simkit.Pose().rotate(3),
    "point None": lambda _: simkit.Pose().transform((0, None, 0)),
    "vector length": lambda _: simkit.Pose().rotate((1, 2)),
    "point huge": lambda _: simkit.Pose().transform((10**5000, 0, 0)),
    "seed": lambda _: simkit.load(WORLD, seed=1.5),
    "base": lambda _: simkit.load(WORLD, base="flying"),
}


@pytest.mark.parametrize("call", WRONG_TYPES.values(), ids=WRONG_TYPES)
def test_a_wrong_kind_is_a_type_error_and_changes_nothing(open_sim: simkit.Simulation, call: Call) -> None:
    before = state_hash(open_sim)
    with pytest.raises(ArgumentTypeError) as raised:
        call(open_sim)
    assert isinstance(raised.value, TypeError)
    assert raised.value.exit_code == 2
    assert state_hash(open_sim) == before


@pytest.mark.parametrize("call", WRONG_VALUES.values(), ids=WRONG_VALUES)
def test_a_wrong_value_is_a_value_error_and_changes_nothing(open_sim: simkit.Simulation, call: Call) -> None:
    before = state_hash(open_sim)
    with pytest.raises(ArgumentValueError) as raised:
        call(open_sim)
    assert isinstance(raised.value, ValueError)
    assert raised.value.code == "SK-INPUT-003"
    assert state_hash(open_sim) == before


def test_the_error_shows_what_was_found_and_what_is_allowed(open_sim: simkit.Simulation) -> None:
    with pytest.raises(ValueError, match=r"count must be a whole number from 0 to \d+, got -1"):
        open_sim.step(-1)
    with pytest.raises(TypeError, match=r"RunSpec"):
        pickle.dumps(open_sim)


def test_whole_floats_and_numpy_numbers_are_accepted(open_sim: simkit.Simulation) -> None:
    before = open_sim.tick
    open_sim.step(np.int64(2))
    open_sim.step(2.0)  # type: ignore[arg-type]
    open_sim.run(np.float64(0.002))
    assert open_sim.tick == before + 6


def test_a_snapshot_of_another_simulation_is_a_value_error(open_sim: simkit.Simulation) -> None:
    with simkit.load(WORLD) as other, pytest.raises(ArgumentValueError, match="another simulation"):
        open_sim.restore(other.snapshot())


def test_after_close_every_read_and_every_command_raises_one_error() -> None:
    sim = simkit.load(WORLD)
    model, link, joint = sim.model("b"), sim.link("b::l"), sim.joint("b::j")
    sensor, light, snapshot = sim.sensor("b::l::imu"), sim.light("sun"), sim.snapshot()
    sim.close()
    reads: list[tuple[Any, str]] = [
        *((model, name) for name in ("pose",)),
        *((link, name) for name in ("pose", "linear_velocity", "linear_acceleration", "mass", "collisions_enabled")),
        *((joint, name) for name in ("position", "velocity", "effort", "transmitted_wrench", "lower", "effort_limit")),
        *((sensor, name) for name in ("pose", "latest", "truth")),
        *((light, name) for name in ("pose", "direction", "on")),
        *((sim, name) for name in ("models", "gravity", "plugins")),
    ]
    calls: list[Callable[[], object]] = [
        *(lambda handle=handle: handle.set_pose(simkit.Pose()) for handle in (model, link, light)),
        *(lambda handle=handle: handle.set_velocity(ORIGIN) for handle in (model, link)),
        lambda: link.apply_wrench(ORIGIN),
        lambda: model.set_joint_positions({}),
        *(lambda name=name: getattr(joint, name)(0.0) for name in ("set_position", "set_velocity", "set_effort")),
        lambda: setattr(joint, "effort_limit", 1.0),
        lambda: sensor.set_rate(1.0),
        *(sim.step, sim.reset, sim.snapshot, sim.topics),
        *(lambda: sim.restore(snapshot), lambda: sim.run(0.0), lambda: sim.run_until(bool, 0.0)),
        *(lambda: sim.model("b"), lambda: sim.subscribe("/x"), lambda: sim.publish("/x", {}), lambda: sim.call("/x")),
        *(lambda: sim.spawn(SPAWNED), lambda: sim.remove("b"), sim.__enter__),
        *(lambda owner=owner, name=name: getattr(owner, name) for owner, name in reads),
    ]
    for call in calls:
        with pytest.raises(InputError, match="the simulation is closed"):
            call()
    sim.close()
    assert sim.time == 0.0


def test_a_topic_that_only_has_subscriptions_is_listed_and_can_be_published_on() -> None:
    with simkit.load(WORLD) as sim:
        heard = sim.subscribe("/chat")
        assert sim.topics()["/chat"] == ""
        sim.publish("/chat", {"data": "hello"})
        sim.publish("/chat", {"data": 2.0})
        assert [type(m).__name__ for m in heard.messages] == ["std_msgs__msg__String", "std_msgs__msg__Float64"]
        with pytest.raises(simkit.MessageError):
            sim.publish("/chat", 3)
        heard.close()
        assert "/chat" not in sim.topics()


def test_a_diagnostic_of_xml_text_names_a_string() -> None:
    text = WORLD.replace('<link name="m"/>', '<link name="m"/><nix/>')
    with simkit.load(text) as sim:
        found = next(d for d in sim.diagnostics if "nix" in d.message)
        assert (found.file, found.line) == ("world given as text", 3)
    with pytest.raises(simkit.LoadError):
        simkit.load(text, strict=True)


@pytest.mark.needs_packs
def test_the_state_hash_covers_actors() -> None:
    world = """<sdf version="1.9"><world name="w"><actor name="a"><script><trajectory id="0" type="walk">
    <waypoint><time>0</time><pose>0 0 1 0 0 0</pose></waypoint>
    <waypoint><time>4</time><pose>4 0 1 0 0 0</pose></waypoint></trajectory></script></actor></world></sdf>"""
    with simkit.load(world) as sim, simkit.load(world) as again:
        sim.run(1.0)
        again.run(1.0)
        first, snapshot = state_hash(sim), sim.snapshot()
        assert state_hash(again) == first
        sim.run(0.1)
        assert state_hash(sim) != first
        sim.restore(snapshot)
        assert state_hash(sim) == first
        sim.call("/a/play", {"data": False})
        assert state_hash(sim) != first


def test_models_that_come_and_go_leave_neither_handles_nor_endless_diagnostics(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("simkit.runtime.spawner.MOST_SPAWN_REPORTS", 5)
    source = SPAWNED.replace('<link name="l"/>', '<link name="l"/><plugin name="p" filename="libnix.so"/>')
    with simkit.load(WORLD) as sim:
        before = len(sim.diagnostics)
        for number in range(12):
            sim.spawn(source, name=f"q{number}")
            sim.remove(f"q{number}")
        assert sim.contents.handles.count == 1
        assert len(sim.diagnostics) <= before + 5
