"""`libgazebo_ros_controller_manager.so`: PR2's controllers and transmissions."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import simkit

INERTIAL = (
    """<inertial><mass value="{}"/><inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/></inertial>"""
)
JOINTS = {  # child: parent, type, axis, lower, upper
    "torso_lift": ("base", "prismatic", "0 0 1", 0.0, 0.3),
    "wrist_flex": ("torso_lift", "revolute", "0 1 0", -2.0, 2.0),
    "wrist_roll": ("wrist_flex", "revolute", "1 0 0", -2.0, 2.0),
    "gripper": ("wrist_roll", "prismatic", "0 1 0", 0.0, 0.09),
    "finger": ("wrist_roll", "revolute", "0 0 1", 0.0, 0.5),
}
TRANSMISSIONS = """
  <transmission type="pr2_mechanism_model/SimpleTransmission" name="torso_trans"><actuator name="torso_motor"/>
    <joint name="torso_lift_joint"/><mechanicalReduction>-47641.53</mechanicalReduction></transmission>
  <transmission type="pr2_mechanism_model/WristTransmission" name="wrist_trans">
    <rightActuator name="r_motor" mechanicalReduction="60"/><leftActuator name="l_motor" mechanicalReduction="50"/>
    <flexJoint name="wrist_flex_joint" mechanicalReduction="-1"/>
    <rollJoint name="wrist_roll_joint" mechanicalReduction="2"/></transmission>
  <transmission type="pr2_mechanism_model/PR2GripperTransmission" name="gripper_trans"><actuator name="g_motor"/>
    <gap_joint name="gripper_joint" mechanical_reduction="1.0"/><passive_joint name="finger_joint"/></transmission>"""
CONTROLLERS = """
torso_controller:
  type: robot_mechanism_controllers/JointPositionController
  joint: torso_lift_joint
  pid: {p: 20000.0, d: 1000.0, i: 0.0, i_clamp: 0.0}
wrist_controller:
  type: robot_mechanism_controllers/JointTrajectoryActionController
  joints: [wrist_flex_joint, wrist_roll_joint]
  gains:
    wrist_flex_joint: {p: 300.0, d: 4.0, i: 0.0, i_clamp: 2.0}
    wrist_roll_joint: {p: 300.0, d: 4.0, i: 0.0, i_clamp: 2.0}
base_controller:
  type: pr2_mechanism_controllers/Pr2BaseController2
"""


def load(folder: Path) -> simkit.Simulation:
    """Load a small PR2 with a fixed base and its controllers."""
    parts = ['<link name="world"/><joint name="fixed" type="fixed"><parent link="world"/><child link="base"/></joint>']
    parts.append(f'<link name="base">{INERTIAL.format(10)}</link>')
    for name, (parent, kind, axis, low, high) in JOINTS.items():
        parts.append(f"""<link name="{name}">{INERTIAL.format(0.5)}</link><joint name="{name}_joint" type="{kind}">
          <parent link="{parent}"/><child link="{name}"/><axis xyz="{axis}"/>
          <limit lower="{low}" upper="{high}" effort="1000" velocity="10"/></joint>""")
    plugin = """<gazebo><plugin name="gazebo_ros_controller_manager" filename="libgazebo_ros_controller_manager.so">
      <alwaysOn>true</alwaysOn><updateRate>1000.0</updateRate></plugin></gazebo>"""
    file, controllers = folder / "pr2.urdf", folder / "controllers.yaml"
    file.write_text(f'<robot name="pr2">{"".join(parts)}{TRANSMISSIONS}{plugin}</robot>')
    controllers.write_text(CONTROLLERS)
    return simkit.load(file, params_files=[controllers])


@pytest.fixture
def robot(tmp_path: Path) -> simkit.Simulation:
    return load(tmp_path)


def test_the_joints_hold_without_a_command_and_joint_states_has_all_of_them(robot: simkit.Simulation) -> None:
    with robot as sim:
        states = sim.subscribe("/joint_states")
        sim.run(1.0)
        assert sorted(states.messages[-1].name) == sorted(f"{name}_joint" for name in JOINTS)
        assert len(states.messages) == pytest.approx(100, abs=1)
        assert sim.model("pr2").joint("torso_lift_joint").position == pytest.approx(0.0, abs=0.005)
        assert sim.model("pr2").joint("gripper_joint").position == pytest.approx(0.0, abs=0.001)


def test_controllers_of_pr2_follow_their_commands(robot: simkit.Simulation) -> None:
    with robot as sim:
        sim.publish("/torso_controller/command", simkit.msgs.make("std_msgs/msg/Float64", data=0.2))
        point = simkit.msgs.make(
            "trajectory_msgs/msg/JointTrajectoryPoint",
            positions=[0.5, -0.4],
            time_from_start=simkit.msgs.make("builtin_interfaces/msg/Duration", sec=1),
        )
        names = ["wrist_flex_joint", "wrist_roll_joint"]
        command = simkit.msgs.make("trajectory_msgs/msg/JointTrajectory", joint_names=names, points=[point])
        sim.publish("/wrist_controller/command", command)
        sim.run(3.0)
        model = sim.model("pr2")
        assert model.joint("torso_lift_joint").position == pytest.approx(0.2, abs=0.005)  # 2 kg · 9.8 / 20 000
        assert [model.joint(name).position for name in names] == pytest.approx([0.5, -0.4], abs=0.02)


def test_a_controller_of_the_casters_is_reported_with_what_drives_the_base(robot: simkit.Simulation) -> None:
    with robot as sim:
        (found,) = (d for d in sim.diagnostics if d.code == "SK-CONTROL-013")
        assert "libgazebo_ros_planar_move.so" in found.message


def test_the_motors_of_a_wrist_turn_with_both_of_its_joints(robot: simkit.Simulation) -> None:
    """a1 = n1 (m1 flex - m2 roll), a2 = -n2 (m1 flex + m2 roll), as in `wrist_transmission.cpp`."""
    from simkit_control.plugins.ros2_control.transmissions import transmission_laws

    with robot as sim:
        scene = sim.model("pr2").scene
        names = [f"{name}_joint" for name in JOINTS]
        laws = transmission_laws(scene.transmissions, names, simkit.extend.Diagnostics())
        wrist = next(law for law in laws if "r_motor" in law.actuators)
        flex, roll = 0.3, 0.1
        expected = [60 * (-flex - 2 * roll), -50 * (-flex + 2 * roll)]
        assert wrist.actuate("position", np.array([flex, roll])).tolist() == pytest.approx(expected)
