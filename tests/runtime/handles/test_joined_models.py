"""Joints of a world between models: one that closes no loop can be set, and its other side moves as a whole."""

from __future__ import annotations

import numpy as np
import pytest

import simkit
from simkit.errors import InputError
from simkit.pose import Pose

INERTIA = "<inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>"


def model(name: str, x: float, more: str = "") -> str:
    return f'<model name="{name}"><pose>{x} 0 5 0 0 0</pose><link name="l">{INERTIA}</link>{more}</model>'


def joint(name: str, parent: str, child: str, kind: str = "revolute") -> str:
    return f"""<joint name="{name}" type="{kind}"><parent>{parent}</parent><child>{child}</child>
      <axis><xyz>0 0 1</xyz></axis></joint>"""


def load(content: str) -> simkit.Simulation:
    return simkit.load(f'<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>{content}</world></sdf>')


def test_a_joint_between_two_models_turns_the_child_and_what_hangs_on_it():
    chain = joint("j", "a::l", "b::l") + joint("k", "b::l", "c::l", "prismatic")
    with load(model("a", 0) + model("b", 2) + model("c", 3) + chain) as sim:
        sim.joint("j").set_position(np.pi / 2)
        sim.joint("j").set_velocity(2.0)
        sim.joint("k").set_position(0.5)
        np.testing.assert_allclose(sim.link("a::l").pose.position, (0, 0, 5), atol=1e-12)
        np.testing.assert_allclose(sim.link("b::l").pose.position, (2, 0, 5), atol=1e-12)
        np.testing.assert_allclose(sim.link("c::l").pose.position, (2, 1, 5.5), atol=1e-9)
        np.testing.assert_allclose(sim.link("c::l").linear_velocity, (-2, 0, 0), atol=1e-9)
        assert sim.joint("j").position == pytest.approx(np.pi / 2)
        assert sim.joint("j").velocity == pytest.approx(2.0)
        before = sim.time
        sim.run(0.01)
        assert sim.joint("j").position == pytest.approx(np.pi / 2 + 2.0 * (sim.time - before), abs=2e-3)


def test_the_parent_moves_if_the_child_is_held_by_the_world():
    held = model("b", 2, '<joint name="h" type="fixed"><parent>world</parent><child>l</child></joint>')
    with load(model("a", 0) + held + joint("j", "a::l", "b::l")) as sim:
        sim.joint("j").set_position(np.pi / 2)
        sim.joint("j").set_velocity(1.0)
        np.testing.assert_allclose(sim.link("b::l").pose.position, (2, 0, 5), atol=1e-12)
        np.testing.assert_allclose(sim.link("a::l").pose.position, (2, 2, 5), atol=1e-9)
        np.testing.assert_allclose(sim.link("a::l").angular_velocity, (0, 0, -1), atol=1e-9)
        assert sim.joint("j").position == pytest.approx(np.pi / 2)


def test_a_joint_that_closes_a_loop_of_models_cannot_be_set():
    loop = joint("j", "a::l", "b::l") + joint("k", "b::l", "c::l") + joint("m", "c::l", "a::l")
    with load(model("a", 0) + model("b", 2) + model("c", 4) + loop) as sim, pytest.raises(InputError, match="loop"):
        sim.joint("j").set_position(0.1)
    both = "".join(
        model(name, x, '<joint name="h" type="fixed"><parent>world</parent><child>l</child></joint>')
        for name, x in (("a", 0), ("b", 2))
    )
    with load(both + joint("j", "a::l", "b::l")) as sim, pytest.raises(InputError, match="loop"):
        sim.joint("j").set_position(0.1)


def test_a_model_that_is_joined_to_the_world_is_set_directly():
    with load(model("a", 0) + joint("j", "world", "a::l")) as sim:
        sim.joint("j").set_position(0.5)
        assert sim.link("a::l").pose.rpy[2] == pytest.approx(0.5)
        assert isinstance(sim.link("a::l").pose, Pose)
