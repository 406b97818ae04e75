"""Facts about a plugin: its declared options and endpoints, and the literals of its source."""

from __future__ import annotations

import math
from typing import Any

import pytest

import simkit
from simkit import ModelPlugin, Params, WorldPlugin
from simkit.extend import Options, OptionsOf, listens, number, texts
from simkit.msgs.shipped_interfaces import shipped_parts
from simkit.plugins.discovery.find_plugin_class import plugin_kinds
from simkit.plugins.discovery.python_plugins import as_class
from simkit_authoring.catalogue import common_facts, facts_of
from simkit_authoring.plugin_facts import Facts, Parameter, Topic


def parameter(facts: Facts, name: str) -> Parameter:
    return next(p for p in facts.parameters if p.name == name)


def topics(facts: Facts) -> dict[str, Topic]:
    return {t.name: t for t in facts.topics}


def test_simkit_has_the_types_of_all_declared_topics_and_services() -> None:
    declared = {(cls.__name__, kind) for cls in plugin_kinds().values() for e in cls.endpoints for kind in e.types}
    assert not [pair for pair in sorted(declared) if "/" in pair[1] and not shipped_parts(pair[1])]


class Everything(ModelPlugin):
    def prepare(self, scene: Any, params: Params, builder: Any) -> None:
        self._joints = [element.value for element in params.all("joint")]

    def load(self, parent: Any, params: Params) -> None:
        self._gain = params.number("gain", 2.0, minimum=0.0, maximum=10)
        self._count = params.integer("count", required=True)
        self._mode = params.choice("mode", ("fast", "slow"), "slow")
        self._axis = params.vector3("axis", (0.0, 0.0, 1.0))
        self._pose = params.pose("offset")
        self._reach = params.number("reach", 0.5)  # [m] from the base
        noise = params.block("noise")
        self._noise = noise.number("stddev", 0.0)
        self._kind = noise.attribute("type", "none")
        if self._mode == "slow":
            read_rest(self, params)
        old = params.text("topicName", "")
        self._out = self.advertise(old if old else f"/{parent.name}/out", "std_msgs/msg/Float64", latched=True)
        self.listen(params.text("command_topic", "in"), ("std_msgs/msg/Float64", "std_msgs/msg/Int32"), print)
        self.offer(f"/model/{parent.name}/home", "std_srvs/srv/Trigger", print)
        self.act("~/reach", "control_msgs/action/FollowJointTrajectory", print)
        self._live = self.declare("damping", 0.1, minimum=0.0, description="of the hinge [N·m·s/rad]")


def read_rest(plugin: ModelPlugin, params: Params) -> None:
    for gain in params.all("gain_of"):
        gain.number("value", 0.0)
    general = params.number("speed", 1.0)
    params.number("turn_speed", general)


def test_every_kind_of_read_is_found_with_its_default_and_bounds() -> None:
    facts = facts_of(Everything)
    gain = parameter(facts, "gain")
    assert (gain.kind, gain.default, gain.minimum, gain.maximum, gain.required) == ("number", 2.0, 0.0, 10.0, False)
    assert parameter(facts, "count").required and parameter(facts, "count").kind == "integer"
    assert parameter(facts, "mode").choices == ("fast", "slow") and parameter(facts, "mode").default == "slow"
    assert parameter(facts, "axis").default == (0.0, 0.0, 1.0) and parameter(facts, "axis").size == 3
    assert parameter(facts, "offset").kind == "pose"
    assert parameter(facts, "joint").repeated and parameter(facts, "joint").kind == "text"


def test_reads_in_blocks_loops_and_other_functions_are_found() -> None:
    facts = facts_of(Everything)
    assert parameter(facts, "noise").kind == "block"
    assert parameter(facts, "noise/stddev").default == 0.0
    assert parameter(facts, "noise/@type").default == "none"
    assert parameter(facts, "gain_of").repeated and parameter(facts, "gain_of/value").kind == "number"


def test_a_default_that_is_another_element_names_it() -> None:
    turn = parameter(facts_of(Everything), "turn_speed")
    assert (turn.default, turn.instead) == (1.0, ("speed",))


def test_the_unit_comes_from_the_comment_the_description_or_the_name() -> None:
    facts = facts_of(Everything)
    assert parameter(facts, "reach").unit == "m"
    assert parameter(facts, "damping").unit == "N·m·s/rad" and parameter(facts, "damping").live
    drive = facts_of(plugin_kinds()["gz-sim-diff-drive-system"])
    units = {p.name: p.unit for p in drive.parameters}
    assert units["wheel_separation"] == "m" and units["odom_publish_frequency"] == "Hz"
    assert units["max_linear_velocity"] == "m/s" and units["max_angular_velocity"] == "rad/s"
    assert units["left_joint"] == ""


def test_topics_services_and_actions_are_found_with_the_elements_that_name_them() -> None:
    facts = facts_of(Everything)
    out = topics(facts)["/{model}/out"]
    assert (out.types, out.published, out.latched) == (("std_msgs/msg/Float64",), True, True)
    assert out.elements == ("topicName",)
    heard = topics(facts)["in"]
    assert heard.types == ("std_msgs/msg/Float64", "std_msgs/msg/Int32") and not heard.published
    assert heard.elements == ("command_topic",)
    assert [(s.name, s.type, s.is_action) for s in facts.services] == [
        ("/model/{model}/home", "std_srvs/srv/Trigger", False),
        ("~/reach", "control_msgs/action/FollowJointTrajectory", True),
    ]


def test_a_sensor_plugin_publishes_the_sensors_products() -> None:
    imu = facts_of(plugin_kinds()["gazebo_ros_imu_sensor"])
    assert topics(imu)["~/out"].types == ("sensor_msgs/msg/Imu",)
    bumper = facts_of(plugin_kinds()["gazebo_ros_bumper"])  # it asks the contact sensor to publish
    assert topics(bumper)["bumper_states"].elements == ("bumperTopicName",)


class Base(WorldPlugin):
    def load(self, parent: Any, params: Params) -> None:
        self.advertise(self.params.text("topic", "from_base"), "std_msgs/msg/Bool")


class Derived(Base):
    def load(self, parent: Any, params: Params) -> None:
        super().load(parent, params)
        params.number("more", math.inf, finite=False)


def test_parameters_read_by_base_classes_are_found() -> None:
    facts = facts_of(Derived)
    assert [p.name for p in facts.parameters] == ["topic", "more"]
    assert list(topics(facts)) == ["from_base"]


class BrakeOptions(Options):
    force: float = number(3.0, "N", minimum=0.0)
    wheel_names: tuple[str, ...] = texts(element="wheel", required=True)
    weak_force: float = number(unit="N", instead="force")


class Brake(ModelPlugin):
    options = OptionsOf(BrakeOptions)
    endpoints = (listens("brake/{model}", "std_msgs/msg/Bool", named_by=("topic",)),)

    def load(self, parent: Any, params: Params) -> None:
        self._delay = params.number("delay", 0.0)  # [s]


def test_declared_options_and_endpoints_are_merged_with_the_source() -> None:
    facts = facts_of(Brake)
    assert [p.name for p in facts.parameters] == ["force", "wheel", "weak_force", "delay"]
    force, wheel, weak, delay = facts.parameters
    assert (force.kind, force.default, force.unit, force.minimum) == ("number", 3.0, "N", 0.0)
    assert wheel.repeated and wheel.required
    assert (weak.default, weak.instead, delay.unit) == (3.0, ("force",), "s")
    assert topics(facts)["brake/{model}"].elements == ("topic",)


class GzSystem:
    """System with the hooks of gz-sim."""

    def configure(self, entity: Any, sdf: Any, ecm: Any, event_manager: Any) -> None:
        self.gain, _ = sdf.get_double("gain", 2.5)
        self.name = sdf.get_string("frame_id")
        if sdf.has_element("limits"):
            self.on = sdf.find_element("limits").get_bool("on", True)[0]


def test_systems_of_gz_are_read_in_configure() -> None:
    cls = as_class(GzSystem)
    assert cls is not None
    facts = facts_of(cls)
    assert [(p.name, p.kind, p.default) for p in facts.parameters] == [
        ("gain", "number", 2.5),
        ("frame_id", "text", None),
        ("limits", "block", None),
        ("limits/on", "boolean", True),
    ]


@pytest.mark.slow
def test_every_plugin_can_be_scanned() -> None:
    for cls in dict.fromkeys(plugin_kinds().values()):
        facts = facts_of(cls)
        assert len({p.path for p in facts.parameters}) == len(facts.parameters)


@pytest.mark.parametrize("world", ["turtlebot3_world"])
def test_every_parameter_read_in_a_run_is_found_by_the_scan(world: str) -> None:
    common = {p.path[0] for p in common_facts().parameters}
    with simkit.load(world) as sim:
        read = [p for p in sim.engine.structure.all_plugins() if p.source is not None]
        assert read
        for plugin in read:
            found = {p.path[0] for p in facts_of(type(plugin)).parameters} | common
            assert plugin.params.asked <= found, type(plugin).__name__
