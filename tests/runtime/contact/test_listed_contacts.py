"""Contacts of a model, listed by `sim.contacts`."""

from __future__ import annotations

import numpy as np
import pytest

import simkit
from simkit.runtime.engine.snapshot import state_hash

BOX = "<collision name='c'><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>"
WORLD = f"""<sdf version="1.9"><world name="w"><gravity>0 0 -10</gravity>
  <model name="ground"><static>true</static>
    <link name="l"><collision name="c"><geometry><plane/></geometry></collision></link></model>
  <model name="crate"><pose>0 0 0.1 0 0 0</pose><link name="l"><inertial><mass>2</mass></inertial>{BOX}</link></model>
  <model name="pair"><pose>1 0 0.1 0 0 0</pose><self_collide>true</self_collide>
    <link name="low"><inertial><mass>1</mass></inertial>{BOX}</link>
    <link name="high"><pose>0 0 0.2 0 0 0</pose><inertial><mass>3</mass></inertial>{BOX}</link></model></world></sdf>"""


def test_forces_of_a_resting_box_balance_its_weight() -> None:
    with simkit.load(WORLD) as sim:
        sim.run(1.0)
        found = sim.contacts("crate")
        assert {frozenset((c.first, c.second)) for c in found} == {frozenset(("ground::l::c", "crate::l::c"))}
        upward = sum(c.force if c.second == "crate::l::c" else -c.force for c in found)
        assert upward == pytest.approx([0, 0, 20], abs=0.05)
        for _, _, position, normal, _ in found:
            assert position[2] == pytest.approx(0, abs=1e-3) and np.linalg.norm(normal) == pytest.approx(1)


def test_contacts_of_a_model_with_itself_are_listed() -> None:
    with simkit.load(WORLD) as sim:
        sim.run(0.5)
        pairs = {frozenset((c.first, c.second)) for c in sim.contacts(sim.model("pair"))}
        assert frozenset(("pair::low::c", "pair::high::c")) in pairs
        inner = [c for c in sim.contacts("pair") if c.first.startswith("pair") and c.second.startswith("pair")]
        upward = sum(c.force if c.second == "pair::high::c" else -c.force for c in inner)
        assert upward[2] == pytest.approx(30, rel=0.01)


def test_all_contacts_are_those_of_all_models() -> None:
    with simkit.load(WORLD) as sim:
        sim.run(0.2)
        assert len(sim.contacts()) == len(sim.contacts("ground")) + sum(
            "ground" not in c.first + c.second for c in sim.contacts()
        )


def test_an_unknown_model_is_an_error_that_suggests_a_name() -> None:
    with simkit.load(WORLD) as sim, pytest.raises(KeyError, match="crate"):
        sim.contacts("crat")


def test_listing_contacts_changes_no_bit() -> None:
    with simkit.load(WORLD) as one, simkit.load(WORLD) as other:
        for _ in range(1500):  # longer than the bodies need to fall asleep
            one.step()
            other.step()
            if one.tick % 50 == 0:
                assert len(one.contacts()) >= 8
        assert state_hash(one) == state_hash(other)


def test_a_body_that_sleeps_changes_no_force_between_others() -> None:
    slippery = "</geometry><surface><friction><ode><mu>0.01</mu><mu2>0.01</mu2></ode></friction></surface>"
    slide = f"""<model name="slide"><pose>3 0 0.1 0 0 0</pose><link name="l"><inertial><mass>1</mass></inertial>
      {BOX.replace("</geometry>", slippery)}</link></model></world>"""
    with simkit.load(WORLD.replace("</world>", slide)) as sim:
        for _ in range(3000):
            sim.link("slide::l").set_velocity((2, 0, 0))
            sim.step()
        assert (sim.mj_data.tree_asleep >= 0).any()
        upward = sum(c.force[2] if c.second == "slide::l::c" else -c.force[2] for c in sim.contacts("slide"))
        assert upward == pytest.approx(10, rel=0.05)
