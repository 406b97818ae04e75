"""Gains of drives, from the inertias that a joint feels over its poses, and the rotors that make them calm."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from simkit.compiler.servo_gains import add_drive_armature, drive_gains, effective_inertias
from simkit.diagnostics import NOWHERE, Diagnostics

TWO_LINKS = """
<mujoco><option timestep="0.001"/><worldbody>
  <body><joint name="a" axis="0 1 0" limited="true" range="-2 2"/>
    <inertial pos="0 0 0.5" mass="1" diaginertia="0.01 0.01 0.01"/>
    <body pos="0 0 1"><joint name="b" axis="0 1 0" limited="true" range="-3 3"/>
      <inertial pos="0 0 0.5" mass="1" diaginertia="0.01 0.01 0.01"/></body></body>
  <body pos="3 0 0"><joint name="wheel" axis="0 1 0"/><inertial pos="0 0 0" mass="1" diaginertia="0.1 0.2 0.1"/></body>
</worldbody></mujoco>"""


def test_inertias_range_from_the_folded_to_the_stretched_arm() -> None:
    model = mujoco.MjModel.from_xml_string(TWO_LINKS)
    least, most = effective_inertias(model, [0, 1, 2])
    assert most[0] == pytest.approx(1 * 0.25 + 0.01 + 1 * 2.25 + 0.01, rel=1e-6)  # stretched, which is how it starts
    assert least[0] < 0.5
    assert most[1] == pytest.approx(0.26)
    assert (least[2], most[2]) == pytest.approx((0.2, 0.2))


def test_the_whole_effort_comes_a_hundredth_of_a_radian_off() -> None:
    heavy = np.array([2.0])
    kp, kv = drive_gains(np.array([43.0]), np.array([False]), heavy, heavy, 0.001)
    assert kp[0] == pytest.approx(4300.0)
    assert kv[0] == pytest.approx(2.0 * np.sqrt(4300.0 * 2.0))  # critically damped


@pytest.mark.parametrize("step", [0.001, 0.002, 0.01])
def test_no_gain_rings_where_the_joint_is_lightest(step: float) -> None:
    least, most = np.array([0.005, 1.0]), np.array([0.5, 1.0])
    kp, kv = drive_gains(np.array([26.0, np.inf]), np.array([False, True]), least, most, step)
    assert (kv * step / least <= 1.0 + 1e-12).all()
    assert (kp * step**2 / least <= 0.25 + 1e-12).all()
    assert (kv >= 2.0 * np.sqrt(kp * most) - 1e-9).all()  # and none swings where it is heaviest


@pytest.mark.parametrize(
    ("kind", "effort", "velocity", "expected"),
    [
        (mujoco.mjtJoint.mjJNT_HINGE, 26.0, 2.6, 0.1),
        (mujoco.mjtJoint.mjJNT_HINGE, np.inf, 2.6, 2e-3),
        (mujoco.mjtJoint.mjJNT_SLIDE, 16.0, 0.05, 1.0),
        (mujoco.mjtJoint.mjJNT_SLIDE, np.inf, np.inf, 2e-2),
    ],
)
def test_a_rotor_takes_ten_milliseconds_to_its_top_speed(
    kind: mujoco.mjtJoint, effort: float, velocity: float, expected: float
) -> None:
    spec, diagnostics = mujoco.MjSpec(), Diagnostics()
    joint = spec.worldbody.add_body().add_joint(type=kind)
    add_drive_armature(joint, effort, velocity, "arm::j", diagnostics, NOWHERE)
    assert joint.armature == pytest.approx(expected)
    assert [d.code for d in diagnostics] == ["SK-PHYS-010"]
    add_drive_armature(joint, effort, velocity, "arm::j", diagnostics, NOWHERE)
    assert len(list(diagnostics)) == 1
