"""Numbers that a program sets during a run act like those of the file, and outlive spawned models."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import simkit
from simkit.errors import InputError
from simkit.runtime.engine.snapshot import state_hash

WORLD = """
<sdf version="1.9"><world name="w"><gravity>0 0 -9.8</gravity>
  <model name="ground"><static>1</static><link name="l"><collision name="c"><geometry><plane/></geometry></collision>
  </link></model>
  <model name="sled"><pose>0 0 0.1 0 0 0</pose><link name="l"><inertial><mass>2</mass>
    <inertia><ixx>0.02</ixx><iyy>0.03</iyy><izz>0.04</izz></inertia></inertial>
    <collision name="c"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision></link></model>
  <model name="swing"><pose>3 0 2 0 0 0</pose>
    <link name="bob"><pose>0.3 0 0 0 0 0</pose><inertial><mass>1</mass>
      <inertia><ixx>0.02</ixx><iyy>0.03</iyy><izz>0.04</izz><ixy>0.002</ixy></inertia></inertial></link>
    <joint name="hinge" type="revolute"><parent>world</parent><child>bob</child><pose>-0.3 0 0 0 0 0</pose>
      <axis><xyz>0 1 0</xyz></axis></joint></model>
</world></sdf>
"""
BOX = '<sdf version="1.9"><model name="box"><pose>9 9 1 0 0 0</pose><link name="l"/></model></sdf>'


def push(sim: simkit.Simulation) -> None:
    sim.link("sled::l").set_velocity((1.0, 0.2, 0.0), (0.0, 0.0, 3.0))
    sim.run(2.0)


def set_mass(sim: simkit.Simulation) -> None:
    sim.link("swing::bob").mass = 2.5


def set_inertia(sim: simkit.Simulation) -> None:
    sim.link("swing::bob").inertia = (0.02, 0.03, 0.04, 0.001, 0.0, 0.0)


def set_friction(sim: simkit.Simulation) -> None:
    sim.link("sled::l").collisions["c"].friction = 0.2


def set_damping(sim: simkit.Simulation) -> None:
    sim.joint("swing::hinge").damping = 0.3


def set_stiction(sim: simkit.Simulation) -> None:
    sim.joint("swing::hinge").stiction = 0.1


def set_gravity(sim: simkit.Simulation) -> None:
    sim.gravity = (0.0, 0.0, -3.0)


CHANGES: list[tuple[Callable[[simkit.Simulation], None], str]] = [
    (set_mass, "swing::bob.mass=2.5"),
    (set_inertia, "swing::bob.inertial.inertia=0.02 0.03 0.04 0.001 0 0"),
    (set_friction, "sled::l::c.mu=0.2"),
    (set_damping, "swing::hinge.damping=0.3"),
    (set_stiction, "swing::hinge.axis.dynamics.friction=0.1"),
    (set_gravity, "world.gravity=0 0 -3"),
]


@pytest.mark.parametrize(("change", "override"), CHANGES, ids=[override for _, override in CHANGES])
def test_a_value_that_is_set_at_the_start_gives_the_bits_of_an_override(
    change: Callable[[simkit.Simulation], None], override: str
) -> None:
    with simkit.load(WORLD) as base, simkit.load(WORLD, overrides=[override]) as loaded, simkit.load(WORLD) as sim:
        change(sim)
        for one in (base, loaded, sim):
            push(one)
        assert state_hash(sim) == state_hash(loaded) != state_hash(base)
        sim.reset()
        push(sim)
        assert state_hash(sim) == state_hash(base)


def test_changes_outlive_a_spawn_and_a_removal() -> None:
    with simkit.load(WORLD) as plain, simkit.load(WORLD) as sim:
        for one in (plain, sim):
            for change, _ in CHANGES:
                change(one)
            one.run(0.5)
        sim.spawn(BOX)
        assert sim.link("swing::bob").mass == 2.5
        assert sim.link("sled::l").collisions["c"].friction == 0.2
        assert sim.joint("swing::hinge").damping == 0.3
        sim.remove("box")
        for one in (plain, sim):
            push(one)
        assert state_hash(sim) == state_hash(plain)


def test_a_snapshot_restores_changed_numbers_and_a_reset_may_keep_them() -> None:
    with simkit.load(WORLD) as sim:
        set_mass(sim)
        set_friction(sim)
        before = sim.snapshot()
        push(sim)
        after = state_hash(sim)
        sim.link("swing::bob").mass = 7.0
        sim.restore(before)
        assert sim.link("swing::bob").mass == 2.5
        push(sim)
        assert state_hash(sim) == after
        sim.reset(keep_changes=True)
        push(sim)
        assert state_hash(sim) == after
        sim.reset()
        assert sim.link("swing::bob").mass == 1.0
        assert sim.link("sled::l").collisions["c"].friction == 1.0


def test_the_inertia_follows_the_mass() -> None:
    with simkit.load(WORLD) as sim:
        link = sim.link("swing::bob")
        link.mass = 2.0
        assert link.inertia == pytest.approx((0.04, 0.06, 0.08, 0.004, 0.0, 0.0))
        body = sim.engine.names.link("swing::bob").body
        assert sim.mj_model.body_mass[body] == 2.0
        assert np.sum(sim.mj_model.body_inertia[body]) == pytest.approx(0.18)


def test_an_armature_slows_a_swing() -> None:
    with simkit.load(WORLD) as sim, simkit.load(WORLD) as heavy:
        heavy.joint("swing::hinge").armature = 1.0
        for one in (sim, heavy):
            one.run(0.1)
        ratio = heavy.joint("swing::hinge").velocity / sim.joint("swing::hinge").velocity
        inertia = 0.03 + 1.0 * 0.3**2
        assert ratio == pytest.approx(inertia / (inertia + 1.0), rel=0.05)


def test_a_light_is_set_and_outlives_a_spawn() -> None:
    lit = WORLD.replace("<model", '<light name="sun" type="directional"/><model', 1)
    with simkit.load(lit) as sim:
        light = sim.light("sun")
        light.intensity, light.diffuse, light.on = 0.5, (0.4, 0.6, 0.8), False
        sim.spawn(BOX)
        assert sim.mj_model.light_diffuse[0] == pytest.approx([0.2, 0.3, 0.4])
        assert not sim.mj_model.light_active[0]
        sim.reset(keep_changes=True)
        assert (light.intensity, light.diffuse, light.on) == (0.5, (0.4, 0.6, 0.8, 1.0), False)
        sim.reset()
        assert (light.intensity, light.on) == (1.0, True)
        assert sim.mj_model.light_diffuse[0] == pytest.approx([1.0, 1.0, 1.0])


def test_the_gain_of_a_wheel_servo_is_set_and_outlives_a_spawn() -> None:
    with simkit.load("turtlebot3_world") as sim:
        joint = sim.joint("turtlebot3::wheel_left_joint")
        gain = joint.kv
        joint.kv = gain / 2
        sim.spawn(BOX)
        assert joint.kv == gain / 2
        sim.reset()
        assert joint.kv == gain


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda sim: setattr(sim.link("ground::l"), "mass", 2.0), "mass or inertia of link 'ground::l' cannot change"),
        (lambda sim: setattr(sim.joint("swing::hinge"), "kv", 2.0), "has no position or velocity servo"),
    ],
)
def test_a_number_that_cannot_change_is_an_error(change: Callable[[simkit.Simulation], None], message: str) -> None:
    with simkit.load(WORLD) as sim, pytest.raises(InputError, match=message):
        change(sim)
