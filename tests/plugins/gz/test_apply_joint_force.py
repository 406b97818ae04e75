"""Efforts on joints."""

from __future__ import annotations

import math

import pytest
from joint_worlds import INERTIA, codes, force, load, position, rotor

from simkit import LoadError

A = "<joint_name>j_a</joint_name>"
CMD = "/model/m/joint/j_a/cmd_force"


def test_an_effort_lasts_until_the_next_command() -> None:
    sim = load(rotor("a"), force(A))
    sim.step(100)
    assert sim.joint("m::j_a").velocity == 0.0
    sim.publish(CMD, {"data": 0.5})
    sim.step(200)
    assert sim.joint("m::j_a").velocity == pytest.approx(0.5 / INERTIA * 0.2, rel=1e-9)
    assert sim.joint("m::j_a").effort == pytest.approx(0.5)
    sim.publish(CMD, {"data": 0.0})
    sim.step(200)
    assert sim.joint("m::j_a").velocity == pytest.approx(0.5 / INERTIA * 0.2, rel=1e-9)


def test_the_effort_is_limited() -> None:
    sim = load(rotor("a", limit="<limit><effort>0.2</effort></limit>"), force(A))
    sim.publish(CMD, {"data": -5.0})
    sim.step(100)
    assert sim.joint("m::j_a").velocity == pytest.approx(-0.2 / INERTIA * 0.1, rel=1e-9)


def test_a_slider_is_pushed_in_newtons() -> None:
    sim = load(rotor("a", kind="prismatic"), force(A))
    sim.publish(CMD, {"data": 3.0})
    sim.step(100)
    assert sim.joint("m::j_a").velocity == pytest.approx(0.3, rel=1e-9)


def test_the_effort_adds_to_earlier_plugins_and_later_plugins_replace_it() -> None:
    hold = "<p_gain>0</p_gain><i_gain>0</i_gain><d_gain>0</d_gain><cmd_offset>0.3</cmd_offset>"
    ends = []
    for plugins in ((position(A + hold), force(A)), (force(A), position(A + hold)), (force(A), force(A))):
        sim = load(rotor("a"), *plugins)
        sim.step()
        sim.publish(CMD, {"data": 0.5})
        sim.step(100)
        ends.append(sim.joint("m::j_a").velocity * INERTIA / 0.1)
    assert ends == pytest.approx([0.8, 0.3, 1.0], rel=1e-9)


def test_only_the_first_axis_is_pushed() -> None:
    joint = """<link name="a"><inertial><mass>1</mass><inertia><ixx>0.2</ixx><iyy>0.2</iyy><izz>0.2</izz></inertia>
    </inertial></link><joint name="j_a" type="universal"><parent>world</parent><child>a</child><axis><xyz>1 0 0</xyz>
    </axis><axis2><xyz>0 1 0</xyz></axis2></joint>"""
    sim = load(joint, force(A))
    sim.publish(CMD, {"data": 0.5})
    sim.step(100)
    assert sim.joint("m::j_a").velocity == pytest.approx([0.25, 0.0], abs=1e-9)


def test_unusable_parameters_are_reported() -> None:
    sim = load(rotor("a"), rotor("b"), force(f"{A}<joint_name>j_b</joint_name>"))
    assert "'j_b' is not used" in codes(sim.diagnostics, "SK-PLUGIN-044")[0]
    sim.publish(CMD, {"data": math.inf})
    sim.step(2)
    assert "a finite number" in codes(sim.diagnostics, "SK-PLUGIN-041")[0]
    with pytest.raises(LoadError, match="no joint 'jA'"):
        load(rotor("a"), force("<joint_name>jA</joint_name>"))
    with pytest.raises(LoadError, match="needs <joint_name>"):
        load(rotor("a"), force(""))
    with pytest.raises(LoadError, match="is ball and has no axes"):
        load(rotor("a", kind="ball"), force(A))
