"""Fixtures over resets, as training scripts use them, and readings that other plugins turn on."""

from __future__ import annotations

from typing import Any

import pytest

import simkit
from simkit_gz_python.msgs import message_class
from simkit_gz_python.plugins.gz_system_plugin import GzSystem
from simkit_gz_python.sim import Joint, Model, World, world_entity
from simkit_gz_python.sim.fixture import TestFixture
from simkit_gz_python.transport import Node

FILE = "gz-sim-joint-state-publisher-system"
STATES = f'<plugin filename="{FILE}" name="gz::sim::systems::JointStatePublisher">{{}}</plugin>'


def world(inside: str = "") -> str:
    inertial = "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>"
    ends = "<parent>base</parent><child>{0}</child><axis><xyz>0 0 1</xyz></axis>"
    joint = f'<joint name="at_{{0}}" type="revolute">{ends}</joint>'
    return f"""<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity><model name="m">
      <link name="base">{inertial}</link><link name="a">{inertial}</link><link name="b">{inertial}</link>
      {joint.format("a")}{joint.format("b")}{inside}</model></world></sdf>"""


def test_after_a_reset_the_callbacks_are_called_as_before() -> None:
    seen: list[int] = []
    fixture = TestFixture(world())
    fixture.on_post_update(lambda info, ecm: seen.append(info.iterations))
    server = fixture.finalize().server()
    server.reset_all()
    server.run(True, 2, False)
    server.reset_all()
    server.run(True, 2, False)
    assert seen == [1, 2, 1, 2]


@pytest.mark.parametrize(
    ("hook", "told"),
    [("on_post_update", [1, 2, 3, 1, 2, 3, 1, 2]), ("on_pre_update", [1, 2, 3, 2, 3, 2, 3, 2])],  # 3 becomes the new 1
)
def test_a_reset_within_a_callback_keeps_the_remaining_iterations(hook: str, told: list[int]) -> None:
    seen: list[int] = []
    fixture = TestFixture(world())
    control, boolean = message_class("WorldControl"), message_class("Boolean")

    def episode(info: Any, ecm: Any) -> None:
        seen.append(info.iterations)
        if info.iterations == 3:
            wanted = control(reset={"all": True})
            assert node.request("/world/w/control", wanted, control, boolean, 100)[1].data

    node = Node()
    getattr(fixture, hook)(episode)
    fixture.finalize().server().run(True, 8, False)
    assert seen == told


def readings(inside: str) -> list[tuple[Any, Any]]:
    found = []

    class Reader:
        def post_update(self, info: Any, ecm: Any) -> None:
            model = Model(World(world_entity(ecm)).model_by_name(ecm, "m"))
            found.append(tuple(Joint(entity).position(ecm) for entity in model.joints(ecm)))

    with simkit.load(world(inside), plugins=[GzSystem(Reader())]) as sim:
        sim.joint("m::at_a").set_position(0.5)
        sim.step()
    return found


def test_a_joint_state_publisher_enables_positions_for_all_systems() -> None:
    assert readings("") == [(None, None)]
    assert readings(STATES.format("")) == [([0.5], [0.0])]
    assert readings(STATES.format("<joint_name>at_a</joint_name>")) == [([0.5], None)]


def test_a_misspelt_method_of_a_handle_names_the_nearest() -> None:
    with pytest.raises(AttributeError, match=r"simkit's Joint has no enable_position_checks; did you mean 'enable_pos"):
        Joint(1).enable_position_checks  # noqa: B018
    assert not hasattr(Joint(1), "__array__")
