"""Servo gains."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest

from simkit.compiler import SpecBuilder
from simkit.diagnostics import Diagnostics
from simkit.pose import Pose
from simkit.scene import Axis, Inertial, SceneJoint

AXIS = (0.0, 0.0, 1.0)


def wheel(make, effort=math.inf, step=0.001):
    """A light wheel on a fixed hub."""
    hub = make.link("m::hub")
    rim = make.link("m::rim", inertial=Inertial(0.1, (0, 0, 0), (1e-5, 1e-5, 2e-5, 0, 0, 0)))
    hold = SceneJoint("hold", "m::hold", "fixed", "world", "m::hub", Pose())
    axle = SceneJoint("axle", "m::axle", "revolute", "m::hub", "m::rim", Pose(), (Axis(AXIS, AXIS, effort=effort),))
    return SpecBuilder(make.world(make.model("m", hub, rim, joints=(hold, axle)), step=step), Diagnostics())


@pytest.mark.parametrize("step", [0.001, 0.004])
def test_a_saturated_velocity_servo_on_a_light_wheel_does_not_ring(make, step):
    builder = wheel(make, step=step)
    ref = builder.add_velocity_servo("m::axle", max_effort=0.02, owner="drive")
    c = builder.compile()
    c.data.ctrl[c.names.actuator(ref)] = 20.0
    speeds = []
    for _ in range(round(4.0 / step)):
        mujoco.mj_step(c.model, c.data)
        speeds.append(float(c.data.qvel[0]))
    speeds = np.array(speeds)
    assert np.all(np.diff(speeds) > -1e-9)
    assert speeds.max() <= 20.0 + 1e-9
    assert speeds[-1] == pytest.approx(20.0, abs=1e-6)
    assert speeds[round(0.5 / step)] == pytest.approx(0.02 / 2.02e-3 * 0.5, rel=0.02)


def test_the_gain_follows_the_rule_and_the_armature_is_reported(make):
    builder = wheel(make)
    ref = builder.add_velocity_servo("m::axle", max_effort=20, owner="drive")
    c = builder.compile()
    number = c.names.actuator(ref)
    assert c.model.actuator_gainprm[number, 0] == pytest.approx(1.5 * (2e-5 + 2e-3) / 0.001, rel=1e-6)
    assert builder.spec.actuator(ref.name).gainprm[0] == c.model.actuator_gainprm[number, 0]
    assert [d.code for d in builder.diagnostics] == ["SK-PHYS-010"]


def test_the_joints_own_effort_limit_counts(make):
    builder = wheel(make, effort=0.5)
    ref = builder.add_velocity_servo("m::axle", max_effort=20, owner="drive")
    c = builder.compile()
    np.testing.assert_allclose(c.model.actuator_forcerange[c.names.actuator(ref)], (-0.5, 0.5))


def test_a_position_servo_reaches_its_target(make):
    builder = wheel(make)
    ref = builder.add_position_servo("m::axle", max_effort=1.0, owner="arm")
    c = builder.compile()
    c.data.ctrl[c.names.actuator(ref)] = 1.0
    mujoco.mj_step(c.model, c.data, 2000)
    assert c.data.qpos[0] == pytest.approx(1.0, abs=1e-6)


def test_a_motor_gives_the_effort_asked_for_and_adds_no_armature(make):
    builder = wheel(make)
    ref = builder.add_motor("m::axle", 0, 1e-3, owner="effort")
    c = builder.compile()
    c.data.ctrl[c.names.actuator(ref)] = 1.0
    mujoco.mj_step(c.model, c.data)
    assert c.data.qvel[0] == pytest.approx(1e-3 / 2e-5 * 0.001, rel=1e-6)


def test_an_axis_that_is_not_there_is_refused(make):
    with pytest.raises(KeyError, match="no axis 1"):
        wheel(make).add_velocity_servo("m::axle", axis=1, max_effort=1, owner="drive")
