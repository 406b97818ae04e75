"""PID loops of effort on light links: they do not oscillate at the step of the world."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from control_robots import files, reported_messages

import simkit

LEG = """<robot name="leg"><link name="world"/>
<link name="shin"><inertial><mass value="0.1"/><inertia ixx="1e-4" iyy="{inertia}" izz="1e-4" ixy="0" ixz="0" iyz="0"/>
</inertial></link>
<joint name="knee" type="revolute"><parent link="world"/><child link="shin"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="1" effort="25" velocity="10"/></joint>
<transmission name="t"><type>transmission_interface/SimpleTransmission</type><joint name="knee">
<hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface></joint>
<actuator name="m"/></transmission>
<gazebo><plugin filename="libgazebo_ros_control.so" name="control">
<robotNamespace>/</robotNamespace><simkit:parameters>arm.yaml</simkit:parameters></plugin></gazebo></robot>"""
TRAJECTORY = """
"":
  legs:
    type: effort_controllers/JointTrajectoryController
    joints: [knee]
    gains: {{knee: {{p: 180, i: 20, d: {d}}}}}
"""
ONE = """
legs:
  type: effort_controllers/JointPositionController
  joint: knee
  pid: {{p: 180, i: 20, d: {d}}}
"""


def largest_effort_at_rest(sim: simkit.Simulation) -> float:
    """Push the joint, and return its largest effort from 0.1 s to 0.2 s after it."""
    sim.joint("leg::knee").set_velocity(0.5)
    sim.run(0.1)
    efforts = []
    for _ in range(100):
        sim.step()
        efforts.append(abs(float(sim.joint("leg::knee").effort)))
    return max(efforts)


@pytest.mark.parametrize("yaml", [TRAJECTORY, ONE])
@pytest.mark.parametrize("d", [0.04, 0.09, 0.9, 50.0])
def test_a_light_link_comes_to_rest_with_any_damping(tmp_path: Path, yaml: str, d: float) -> None:
    with simkit.load(files(tmp_path, LEG.format(inertia=1e-4), yaml.format(d=d))) as sim:
        assert largest_effort_at_rest(sim) < 1.0


def test_gains_that_would_oscillate_are_reduced_with_a_warning(tmp_path: Path) -> None:
    with simkit.load(files(tmp_path, LEG.format(inertia=1e-4), TRAJECTORY.format(d=0.9))) as sim:
        (message,) = reported_messages(sim, "SK-CONTROL-062")
        assert "p = 180 and d = 0.9 of joint 'knee' would oscillate at a step of 1 ms" in message
        assert "p = 25 and d = 0.1 are used" in message


def test_gains_on_a_heavy_link_are_used_as_they_are(tmp_path: Path) -> None:
    with simkit.load(files(tmp_path, LEG.format(inertia=0.1), TRAJECTORY.format(d=0.9))) as sim:
        assert reported_messages(sim, "SK-CONTROL-062") == []
        sim.step(5)
        sim.joint("leg::knee").set_position(0.1)
        sim.step(2)
        assert float(sim.joint("leg::knee").effort) == pytest.approx(-18.0, abs=0.3)


def test_a_trajectory_is_followed_with_reduced_gains(tmp_path: Path) -> None:
    with simkit.load(files(tmp_path, LEG.format(inertia=1e-4), TRAJECTORY.format(d=0.9))) as sim:
        point = {"positions": [0.5], "time_from_start": {"sec": 1}}
        sim.publish("/legs/command", {"joint_names": ["knee"], "points": [point]})
        found = []
        for _ in range(150):
            sim.step(10)
            found.append(float(sim.joint("leg::knee").position))
        assert found[-1] == pytest.approx(0.5, abs=0.01)
        assert float(np.max(found)) < 0.52
