"""ros2_control_node without a simulator: the robot of the description is added to the world and controlled."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

import simkit
from simkit import Simulation

JOINT = """<joint name="{name}" type="continuous"><parent link="{parent}"/><child link="{child}"/><axis xyz="0 1 0"/>
<origin xyz="0 {y} 0.5"/></joint>"""
INTERFACES = """<joint name="{name}"><command_interface name="{kind}"/><state_interface name="position"/>
<state_interface name="velocity"/></joint>"""


def robot(kind: str, *, is_flat: bool = False) -> str:
    second = "base" if is_flat else "upper"
    joints = JOINT.format(name="j1", parent="base", child="upper", y=0.2)
    joints += JOINT.format(name="j2", parent=second, child="lower", y=-0.2)
    hardware = "".join(INTERFACES.format(name=name, kind=kind) for name in ("j1", "j2"))
    return f"""<robot name="bot"><link name="base"/><link name="upper"/>
<link name="lower"><collision><geometry><box size="9 9 9"/></geometry></collision></link>{joints}
<ros2_control name="Bot" type="system"><hardware><plugin>mock_components/GenericSystem</plugin></hardware>
{hardware}</ros2_control></robot>"""


FORWARD = """
/**/controller_manager:
  ros__parameters:
    update_rate: 50
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
    forward: {type: forward_command_controller/ForwardCommandController}
forward:
  ros__parameters: {joints: [j1, j2], interface_name: position}
"""
TRAJECTORY = """
controller_manager:
  ros__parameters:
    arm: {type: joint_trajectory_controller/JointTrajectoryController}
arm:
  ros__parameters: {joints: [j1, j2], command_interfaces: [position], state_interfaces: [position, velocity]}
"""
DRIVE = """
controller_manager:
  ros__parameters:
    base_controller: {type: diff_drive_controller/DiffDriveController}
base_controller:
  ros__parameters:
    left_wheel_names: [j1]
    right_wheel_names: [j2]
    wheel_separation: 0.4
    wheel_radius: 0.1
    use_stamped_vel: false
    cmd_vel_timeout: 10.0
"""


@pytest.fixture
def sim() -> Iterator[Simulation]:
    with simkit.load('<sdf version="1.9"><world name="w"/></sdf>') as simulation:
        yield simulation


def start(sim: Simulation, folder: Path, text: str, controllers: str, *names: str, words: tuple[str, ...] = ()) -> None:
    """Start the node with a description and a parameter file, and spawn controllers."""
    (folder / "controllers.yaml").write_text(controllers)
    arguments = ["--ros-args", "--params-file", str(folder / "controllers.yaml"), *words]
    sim.add_node("controller_manager/ros2_control_node", params={"robot_description": text}, args=arguments)
    for name in names:
        sim.add_node("controller_manager/spawner", label=name, args=[name])
    sim.run(1.0)
    assert [node.error for node in sim.nodes] == [None] * len(sim.nodes), sim.nodes[-1].log


def test_forward_commands_move_the_joints_exactly(sim: Simulation, tmp_path: Path) -> None:
    words = ("-r", "/forward/commands:=/go")
    start(sim, tmp_path, robot("position"), FORWARD, "joint_state_broadcaster", "forward", words=words)
    states = sim.subscribe("/joint_states")
    sim.publish("/go", {"data": [0.5, -0.3]})
    sim.run(2.0)
    assert list(states.latest.position) == pytest.approx([0.5, -0.3], abs=1e-3)
    assert [each.code for each in sim.diagnostics if each.severity == "warning"] == []


def test_a_trajectory_is_followed(sim: Simulation, tmp_path: Path) -> None:
    start(sim, tmp_path, robot("position"), TRAJECTORY, "arm")
    points = [{"positions": [1.0, -1.0], "time_from_start": {"sec": 2}}]
    sim.publish("/arm/joint_trajectory", {"joint_names": ["j1", "j2"], "points": points})
    sim.run(3.0)
    assert sim.joint("bot::j1").position == pytest.approx(1.0, abs=0.01)


def test_a_differential_drive_publishes_its_odometry(sim: Simulation, tmp_path: Path) -> None:
    start(sim, tmp_path, robot("velocity", is_flat=True), DRIVE, "base_controller")
    odometry = sim.subscribe("/base_controller/odom")
    sim.publish("/base_controller/cmd_vel_unstamped", {"linear": {"x": 0.5}})
    sim.run(2.0)
    assert odometry.latest.pose.pose.position.x == pytest.approx(1.0, abs=0.05)


def test_the_description_comes_from_robot_state_publisher(sim: Simulation, tmp_path: Path) -> None:
    (tmp_path / "controllers.yaml").write_text(FORWARD)
    arguments = ["--ros-args", "--params-file", str(tmp_path / "controllers.yaml")]
    sim.add_node("controller_manager/ros2_control_node", args=arguments)
    sim.add_node("robot_state_publisher/robot_state_publisher", params={"robot_description": robot("position")})
    sim.run(0.5)
    assert list(sim.models) == ["bot"]
    assert "/controller_manager/list_controllers" in sim.communication.services.names()


def test_a_description_without_hardware_is_an_error(sim: Simulation) -> None:
    text = '<robot name="bot"><link name="base"/></robot>'
    node = sim.add_node("controller_manager/ros2_control_node", params={"robot_description": text})
    sim.run(0.5)
    assert node.exit_code == 1
    assert "has no <ros2_control>" in node.log[-1]
