"""The mobile base of TIAGo and PMB2: it stands, drives straight, turns true, and reaches its speeds."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import simkit

CMD, ODOM = "/mobile_base_controller/cmd_vel_unstamped", "/mobile_base_controller/odom"
GROUND = (
    "<model name='ground'><static>true</static><link name='link'><collision name='plane'><geometry><plane/></geometry>"
    "</collision></link></model>"
)
STEPS = (0.001, 0.002)


def opened(model: str, step: float, extra: str = "") -> simkit.Simulation:
    physics = f"<physics type='ode'><max_step_size>{step}</max_step_size></physics>"
    include = f"<include><uri>model://{model}</uri></include>"
    return simkit.load(f"<sdf version='1.9'><world name='w'>{physics}{GROUND}{include}{extra}</world></sdf>")


def drive(sim: simkit.Simulation, ahead: float, turn: float, seconds: float) -> float:
    """Repeats a command ten times a second, and lets it run out; how far the model turned [rad]."""
    model = next(m for name, m in sim.models.items() if name not in ("ground", "wall"))
    command = simkit.msgs.make("geometry_msgs/msg/Twist", linear={"x": ahead}, angular={"z": turn})
    turned, last = 0.0, model.pose.rpy[2]
    for k in range(round(seconds * 10) + 15):
        if k < round(seconds * 10):
            sim.publish(CMD, command)
        sim.run(0.1)
        yaw = model.pose.rpy[2]
        turned, last = turned + math.remainder(yaw - last, 2 * math.pi), yaw
    return turned


def told(odom: Any) -> tuple[float, float, float]:
    """x, y [m] and yaw [rad] of the last odometry."""
    pose = odom.latest.pose.pose
    return pose.position.x, pose.position.y, 2 * math.atan2(pose.orientation.z, pose.orientation.w)


@pytest.mark.parametrize(("model", "seconds"), [("pmb2", 60.0), ("tiago_no_arm", 10.0), ("tiago", 10.0)])
def test_it_stands_still(model: str, seconds: float) -> None:
    with opened(model, 0.002) as sim:
        sim.run(1.0)
        before = sim.model(model).pose
        sim.run(seconds)
        after = sim.model(model).pose
    # less than a millimetre a minute
    assert np.linalg.norm(after.position - before.position) < 1e-3 * seconds / 60
    assert math.degrees(abs(after.rpy[2] - before.rpy[2])) < 0.01


@pytest.mark.parametrize("step", STEPS)
def test_the_base_drives_straight_and_knows_how_far(step: float) -> None:
    with opened("pmb2", step) as sim:
        odom = sim.subscribe(ODOM)
        sim.run(0.5)
        turned = drive(sim, 0.5, 0.0, 2.0)
        x, y, _ = sim.model("pmb2").pose.position
        assert x == pytest.approx(1.075, abs=0.02)  # the last command holds for 0.25 s
        assert abs(y) < 1e-4 and abs(turned) < 1e-4
        np.testing.assert_allclose(told(odom), (x, y, turned), atol=5e-4)


@pytest.mark.parametrize("step", STEPS)
def test_with_the_arm_to_one_side_it_still_goes_straight(step: float) -> None:
    """At 1 m/s² the wheel on the arm's side is too weak for a moment; the other waits for it."""
    with opened("tiago", step) as sim:
        odom = sim.subscribe(ODOM)
        sim.run(0.5)
        turned = drive(sim, 0.2, 0.0, 5.0)
        x, y, _ = sim.model("tiago").pose.position
        assert x == pytest.approx(1.04, abs=0.02)
        assert abs(y) < 1.5e-3 and abs(turned) < 6e-3
        np.testing.assert_allclose(told(odom), (x, y, turned), atol=1.5e-3)


@pytest.mark.parametrize("step", STEPS)
def test_it_turns_about_its_middle_and_knows_by_how_much(step: float) -> None:
    with opened("pmb2", step) as sim:
        odom = sim.subscribe(ODOM)
        sim.run(0.5)
        turned = drive(sim, 0.0, 2.0, 3 * math.pi)
        assert turned == pytest.approx(6 * math.pi, rel=0.03)
        assert math.remainder(told(odom)[2] - turned, 2 * math.pi) == pytest.approx(0, abs=1e-3 * turned)
        assert np.linalg.norm(sim.model("pmb2").pose.position[:2]) < 1e-3


def test_it_reaches_its_limits_ahead_and_back() -> None:
    with opened("pmb2", 0.002) as sim:
        odom = sim.subscribe(ODOM)
        for wanted, reached in ((3.0, 1.0), (-3.0, -0.2)):
            for _ in range(25):
                sim.publish(CMD, simkit.msgs.make("geometry_msgs/msg/Twist", linear={"x": wanted}))
                sim.run(0.1)
            assert odom.latest is not None
            # going back the casters turn round, one after another, which costs a little
            assert odom.latest.twist.twist.linear.x == pytest.approx(reached, abs=0.02)
            assert sim.link("pmb2::base_footprint").linear_velocity[0] == pytest.approx(reached, abs=0.02)


def test_commands_at_three_hertz_keep_it_going_and_it_stops_when_they_stop() -> None:
    """The timeout of 0.25 s is shorter than a third of a second: it brakes for a moment between two commands."""
    with opened("pmb2", 0.002) as sim:
        for _ in range(9):
            sim.publish(CMD, simkit.msgs.make("geometry_msgs/msg/Twist", linear={"x": 0.3}))
            sim.run(1 / 3)
        moving = float(sim.model("pmb2").pose.position[0])
        assert 0.5 < moving < 0.9
        sim.run(1.0)
        stopped = float(sim.model("pmb2").pose.position[0])
        sim.run(5.0)
        assert float(sim.model("pmb2").pose.position[0]) == pytest.approx(stopped, abs=1e-4)


@pytest.mark.parametrize("step", STEPS)
def test_suspension_and_casters_keep_calm(step: float) -> None:
    with opened("pmb2", step) as sim:
        names = [f"pmb2::suspension_{side}_joint" for side in ("left", "right")]
        sim.run(0.5)
        drive(sim, 0.5, 1.0, 2.0)
        drive(sim, -0.2, -1.0, 2.0)
        travel = [float(sim.joint(name).position) for name in names]
        assert all(0 <= t < 1e-3 for t in travel)
        heights = []
        for _ in range(50):
            sim.step()
            heights.append(sim.model("pmb2").pose.position[2])
        assert np.ptp(heights) < 1e-7


def test_against_a_wall_it_pushes_no_more_once_the_command_ends() -> None:
    wall = (
        "<model name='wall'><static>true</static><pose>0.6 0 0.5 0 0 0</pose><link name='link'><collision name='c'>"
        "<geometry><box><size>0.2 4 1</size></box></geometry></collision></link></model>"
    )
    with opened("pmb2", 0.002, wall) as sim:
        sim.run(0.5)
        wheels = [sim.joint(f"pmb2::wheel_{side}_joint") for side in ("left", "right")]
        drive(sim, 0.3, 0.0, 3.0)
        sim.run(1.0)
        assert all(abs(float(wheel.effort)) < 0.5 for wheel in wheels)


def test_where_it_really_is_comes_as_odometry() -> None:
    with opened("pmb2", 0.002) as sim:
        truth = sim.subscribe("/ground_truth_odom")
        sim.run(0.5)
        drive(sim, 0.2, 0.3, 1.0)
        latest = truth.latest
        assert latest is not None
        np.testing.assert_allclose(
            [latest.pose.pose.position.x, latest.pose.pose.position.y], sim.model("pmb2").pose.position[:2], atol=1e-6
        )
