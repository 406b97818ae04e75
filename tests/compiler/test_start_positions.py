"""Initial positions of joints whose limits exclude 0, on robots with one to four legs."""

from __future__ import annotations

import numpy as np
import pytest

import simkit

_INERTIAL = (
    '<inertial><origin xyz="0 0 {z}"/><mass value="{mass}"/>'
    '<inertia ixx="{i}" iyy="{i}" izz="{i}" ixy="0" ixz="0" iyz="0"/></inertial>'
)
_LEG = """
<link name="thigh{n}">{thigh}</link><link name="calf{n}">{calf}<collision><origin xyz="0 0 -0.2"/>
<geometry><sphere radius="0.02"/></geometry></collision></link>
<joint name="hip{n}" type="revolute"><parent link="trunk"/><child link="thigh{n}"/><origin xyz="{x} {y} 0"/>
<axis xyz="0 1 0"/><limit lower="{lowest}" upper="4" effort="30" velocity="20"/></joint>
<joint name="knee{n}" type="revolute"><parent link="thigh{n}"/><child link="calf{n}"/><origin xyz="0 0 -0.2"/>
<axis xyz="0 1 0"/><limit lower="-2.7" upper="{upper}" effort="30" velocity="20"/></joint>
"""
_CONTROL = """<ros2_control name="c">{}</ros2_control>
<gazebo><plugin filename="libgazebo_ros2_control.so" name="control"/></gazebo>"""


def legged(upper: float = -0.9, *, lowest: float = -1.0, is_driven: bool = True, first: str = "", fix: str = "") -> str:
    """Return a robot with four legs; the limits of its knees are −2.7 rad and `upper`."""
    thigh, calf = _INERTIAL.format(z=-0.1, mass=1, i=0.005), _INERTIAL.format(z=-0.1, mass=0.2, i=0.001)
    corners = [(x, y) for x in (0.2, -0.2) for y in (0.1, -0.1)]
    legs = "".join(
        _LEG.format(n=n, thigh=thigh, calf=calf, x=x, y=y, upper=upper, lowest=lowest)
        for n, (x, y) in enumerate(corners)
    )
    inside = '<command_interface name="position"/><state_interface name="position">{}</state_interface>'
    joints = "".join(
        f'<joint name="{joint}{n}">{inside.format(first if joint == "knee" else "")}</joint>'
        for n in range(4)
        for joint in ("hip", "knee")
    )
    trunk = f'<link name="trunk">{_INERTIAL.format(z=0, mass=5, i=0.1)}</link>'
    control = _CONTROL.format(joints) if is_driven else ""
    return f'<robot name="dog">{fix}{trunk}{legs}{control}</robot>'


def angles(sim: simkit.Simulation, joint: str) -> list[float]:
    return [float(sim.joint(f"dog::{joint}{n}").position) for n in range(4)]


def codes(sim: simkit.Simulation) -> list[str]:
    return [d.code for d in sim.diagnostics]


def test_a_quadruped_whose_knees_cannot_be_straight_stands_on_its_feet() -> None:
    with simkit.load(legged(), model_world="ground") as sim:
        trunk = next(model for model in sim.models.values() if model.name == "dog")
        height = float(trunk.pose.position[2])
        fastest = 0.0
        for _ in range(200):
            sim.step(10)
            fastest = max(fastest, float(np.abs(sim.mj_data.qvel[:6]).max()))
        assert float(trunk.pose.position[2]) == pytest.approx(height, abs=0.01)
        assert fastest < 0.3


def test_overlaps_are_those_of_the_start_positions() -> None:
    """With straight knees the feet would be in the ground, but the robot starts with bent ones."""
    with simkit.load(legged(), model_world="ground") as sim:
        assert "SK-PHYS-024" not in codes(sim)


def test_a_joint_whose_limits_exclude_0_starts_at_its_nearest_limit_with_a_warning() -> None:
    with simkit.load(legged()) as sim:
        assert angles(sim, "knee") == pytest.approx([-0.9] * 4)
        assert codes(sim).count("SK-JOINT-007") == 4
        assert "it starts at -0.9" in next(d.message for d in sim.diagnostics if d.code == "SK-JOINT-007")


def test_the_hip_turns_back_until_the_foot_is_below_it() -> None:
    with simkit.load(legged()) as sim:
        hip = angles(sim, "hip")[0]
        # thigh and calf of 0.2 m each: half of the knee's angle
        assert hip == pytest.approx(0.45, abs=1e-6)
        assert codes(sim).count("SK-JOINT-018") == 4


def test_a_hip_that_cannot_turn_back_stays_at_0() -> None:
    with simkit.load(legged(lowest=0.0).replace('upper="4"', 'upper="0.1"')) as sim:
        assert angles(sim, "hip") == [0.0] * 4
        assert angles(sim, "knee") == pytest.approx([-0.9] * 4)


def test_an_arm_on_a_fixed_base_starts_at_the_limit_alone() -> None:
    fix = '<link name="world"/><joint name="fix" type="fixed"><parent link="world"/><child link="trunk"/></joint>'
    with simkit.load(legged(fix=fix)) as sim:
        assert angles(sim, "hip") == [0.0] * 4
        assert angles(sim, "knee") == pytest.approx([-0.9] * 4)


def test_a_robot_whose_limits_hold_0_starts_at_0() -> None:
    with simkit.load(legged(0.5)) as sim:
        assert angles(sim, "knee") == angles(sim, "hip") == [0.0] * 4
        assert not {"SK-JOINT-007", "SK-JOINT-018"} & set(codes(sim))


def test_initial_values_of_ros2_control_replace_the_limit() -> None:
    with simkit.load(legged(first='<param name="initial_value">-1.5</param>')) as sim:
        assert angles(sim, "knee") == pytest.approx([-1.5] * 4)


def test_a_reset_returns_to_the_starts_and_a_spawned_robot_has_them_too() -> None:
    with simkit.load(legged(is_driven=False), model_world="ground") as sim:
        sim.run(0.5)
        sim.reset()
        assert angles(sim, "knee") == pytest.approx([-0.9] * 4)
        sim.spawn(legged(is_driven=False), name="second", pose=simkit.Pose((2.0, 0.0, 1.0)))
        assert float(sim.joint("second::knee0").position) == pytest.approx(-0.9)
        assert float(sim.joint("second::hip0").position) == pytest.approx(0.45, abs=1e-6)
