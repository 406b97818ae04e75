"""`sim.why()`: contacts, joints, constraints and wheels at one moment."""

from __future__ import annotations

import json
import math

import pytest

import simkit
from simkit.runtime.moment.moment import Moment

INERTIA = "<inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia>"
ANGLE = math.radians(20.0)
WEIGHT = 9.8  # of 1 kg


def slope(mu: float) -> str:
    """Return a box of 1 kg on a slope of 20°."""
    surface = f"<surface><friction><ode><mu>{mu}</mu><mu2>{mu}</mu2></ode></friction></surface>"
    height = 0.15 / math.cos(ANGLE)
    return f"""<sdf version="1.9"><world name="slope"><gravity>0 0 -{WEIGHT}</gravity>
<model name="ramp"><static>true</static><pose>0 0 0 0 {ANGLE} 0</pose><link name="l"><collision name="top">
<geometry><box><size>20 20 0.1</size></box></geometry>{surface}</collision></link></model>
<model name="box"><pose>0 0 {height} 0 {ANGLE} 0</pose><link name="l">
<inertial><mass>1</mass>{INERTIA}</inertial><collision name="hull">
<geometry><box><size>0.4 0.4 0.2</size></box></geometry>{surface}</collision></link></model></world></sdf>"""


def moment_on_slope(mu: float) -> Moment:
    with simkit.load(slope(mu)) as sim:
        sim.run(0.5)
        return sim.why("box")


def test_a_box_on_a_slope_below_the_friction_angle_holds() -> None:
    moment = moment_on_slope(0.5)  # tan 20° = 0.36
    (pair,) = moment.contacts
    assert (pair.first, pair.second, pair.points) == ("box::l::hull", "ramp::l::top", 4)
    assert pair.normal_force == pytest.approx(WEIGHT * math.cos(ANGLE), rel=1e-3)
    assert pair.friction_force == pytest.approx(WEIGHT * math.sin(ANGLE), rel=1e-3)
    assert pair.friction_limit == pytest.approx(0.5 * WEIGHT * math.cos(ANGLE), rel=1e-3)
    assert pair.friction_use == pytest.approx(math.tan(ANGLE) / 0.5, rel=0.02)
    assert not pair.slides
    assert moment.findings == []


def test_a_box_on_a_slope_above_the_friction_angle_slides() -> None:
    moment = moment_on_slope(0.3)
    (pair,) = moment.contacts
    assert pair.slides
    assert pair.friction_force == pytest.approx(0.3 * WEIGHT * math.cos(ANGLE), rel=1e-3)
    speed = 0.5 * WEIGHT * (math.sin(ANGLE) - 0.3 * math.cos(ANGLE))
    assert pair.slip_speed == pytest.approx(speed, rel=0.02)
    assert moment.findings == [f"l::hull slides on ramp::l::top at {pair.slip_speed:.3g} m/s."]


def arm(effort: float, lower: float = -3.0) -> str:
    """Return a fixed arm of 1 kg at 0.5 m, which gravity turns with 4.9 N·m, with a servo."""
    return f"""<sdf version="1.9"><world name="w"><gravity>0 0 -{WEIGHT}</gravity><model name="arm">
<link name="base"/><joint name="fix" type="fixed"><parent>world</parent><child>base</child></joint>
<link name="bar"><inertial><pose>0.5 0 0 0 0 0</pose><mass>1</mass>{INERTIA}</inertial></link>
<joint name="elbow" type="revolute"><parent>base</parent><child>bar</child><axis><xyz>0 -1 0</xyz>
<limit><lower>{lower}</lower><upper>3</upper><effort>{effort}</effort></limit></axis></joint>
<plugin filename="gz-sim-joint-position-controller-system" name="gz::sim::systems::JointPositionController">
<joint_name>elbow</joint_name><p_gain>1000</p_gain><d_gain>50</d_gain><use_velocity_commands>false</use_velocity_commands>
<cmd_max>1e6</cmd_max><cmd_min>-1e6</cmd_min></plugin></model></world></sdf>"""


def test_a_joint_with_too_small_an_effort_limit_is_saturated() -> None:
    with simkit.load(arm(2.0)) as sim:
        sim.run(0.2)
        (joint,) = sim.why().joints
        assert joint.joint == "arm::elbow"
        assert joint.saturated
        assert joint.effort_limit == (2.0,)
        assert joint.effort[0] == pytest.approx(2.0)
        assert joint.steady_effort[0] == pytest.approx(0.5 * WEIGHT * math.cos(joint.position[0]), rel=1e-3)
        (finding,) = sim.why().findings
        needed = f"{joint.steady_effort[0]:.3g} N·m would keep its velocity"
        assert finding == f"Joint arm::elbow has its effort limit of 2 N·m; {needed}."


def test_a_joint_with_enough_effort_holds() -> None:
    with simkit.load(arm(20.0)) as sim:
        sim.run(1.0)
        (joint,) = sim.why().joints
        assert not joint.saturated
        assert joint.effort[0] == pytest.approx(0.5 * WEIGHT, rel=0.01)
        assert sim.why().findings == []


def test_a_joint_on_its_stop_names_the_limit_and_its_effort() -> None:
    with simkit.load(arm(0.0, lower=-0.2)) as sim:
        sim.run(2.0)
        (joint,) = sim.why().joints
        assert joint.stop == "lower"
        assert joint.stop_effort == pytest.approx(0.5 * WEIGHT * math.cos(0.2), rel=0.01)
        assert sim.why().findings[-1].startswith("Joint arm::elbow touches its lower limit at -0.2")


FINGER = """<link name="{0}"><inertial><mass>0.1</mass>{1}</inertial></link>
<joint name="{0}_joint" type="prismatic"><parent>palm</parent><child>{0}</child><axis><xyz>0 1 0</xyz>
<limit><lower>-0.04</lower><upper>0.04</upper></limit>{2}</axis></joint>"""
MIMIC = "<mimic joint='left_joint'><multiplier>-1</multiplier><offset>0</offset><reference>0</reference></mimic>"
GRIPPER = f"""<sdf version="1.11"><world name="w"><model name="gripper"><link name="palm"/>
<joint name="fix" type="fixed"><parent>world</parent><child>palm</child></joint>
{FINGER.format("left", INERTIA, "")}{FINGER.format("right", INERTIA, MIMIC)}</model></world></sdf>"""


def test_the_fingers_of_a_gripper_show_the_error_of_their_mimic() -> None:
    with simkit.load(GRIPPER) as sim:
        sim.joint("gripper::left_joint").set_position(0.01)  # the other finger follows
        (mimic,) = sim.why(joint="right_joint").constraints
        assert (mimic.name, mimic.kind, mimic.unit) == ("gripper::right_joint#mimic0", "joint", "m")
        assert mimic.error == pytest.approx(0.0, abs=1e-9)
        sim.joint("gripper::right_joint").set_position(-0.014)
        (mimic,) = sim.why(joint="left_joint").constraints
        assert mimic.error == pytest.approx(0.004, rel=1e-6)
        assert mimic.force > 0.0
        assert sim.why("gripper").findings == ["Constraint right_joint#mimic0 has an error of 0.004 m."]


WALL = """<sdf version="1.9"><model name="wall"><static>true</static><pose>0.6 0 0.25 0 0 0</pose><link name="l">
<collision name="face"><geometry><box><size>1 1 0.5</size></box></geometry></collision></link></model></sdf>"""


@pytest.fixture(scope="module")
def blocked() -> Moment:
    """Return the moment at which a robot drives against a wall."""
    with simkit.load("turtlebot3_empty", seed=1) as sim:
        sim.spawn(WALL)
        sim.publish("/cmd_vel", {"linear": {"x": 0.2}})
        sim.run(0.7)
        return sim.why("turtlebot3")


def test_a_robot_that_drives_against_a_wall_slips(blocked: Moment) -> None:
    for wheel in blocked.wheels:
        assert wheel.rim_speed == pytest.approx(0.2, rel=0.01)
        assert wheel.axle_speed == pytest.approx(0.0, abs=1e-4)
        assert wheel.ratio == pytest.approx(1.0, abs=1e-3)
    text = "rim 0.2 m/s, axle 0 m/s, slip 0.2 m/s (100.0%)."
    assert blocked.findings == [f"Wheel wheel_{side}_joint slips: {text}" for side in ("left", "right")]
    wall = next(pair for pair in blocked.contacts if pair.second == "wall::l::face")
    friction = sum(pair.friction_force for pair in blocked.contacts if "wheel" in pair.first)
    assert wall.normal_force == pytest.approx(friction, rel=0.01)  # the wheels push the robot against the wall


def test_the_text_has_a_line_for_each_contact_joint_and_wheel(blocked: Moment) -> None:
    lines = str(blocked).splitlines()
    assert lines[0] == "turtlebot3_empty at t = 0.7 s (step 700), model turtlebot3"
    assert [line for line in lines if not line.startswith(" ")][1:] == ["contacts", "joints", "wheels"]
    count = len(blocked.findings) + len(blocked.contacts) + len(blocked.joints) + len(blocked.wheels)
    assert len(lines) == count + 4
    assert repr(blocked) == "<Moment t=0.7 s: 3 contacts, 4 joints, 2 wheels, 2 findings>"


def test_the_json_object_has_all_numbers(blocked: Moment) -> None:
    read = json.loads(json.dumps(blocked.as_dict(), allow_nan=False))
    assert read["wheels"][0]["slip"] == blocked.wheels[0].slip
    assert read["contacts"][0]["slides"] is blocked.contacts[0].slides
    assert read["joints"][0]["effort_limit"] == [20.0]
    assert read["findings"] == blocked.findings


def test_a_joint_limits_the_contents_to_its_link() -> None:
    with simkit.load("turtlebot3_empty") as sim:
        sim.run(0.2)
        moment = sim.why(joint="wheel_left_joint")
        assert [joint.joint for joint in moment.joints] == ["turtlebot3::wheel_left_joint"]
        assert [pair.first for pair in moment.contacts] == ["turtlebot3::wheel_left_link::tread"]
        assert len(moment.wheels) == 1


def test_an_unknown_name_suggests_the_closest_one() -> None:
    with simkit.load("turtlebot3_empty") as sim:
        with pytest.raises(KeyError, match="turtlebot3"):
            sim.why("turtlebot")
        with pytest.raises(KeyError, match="wheel_left_joint"):
            sim.why(joint="wheel_lft_joint")
