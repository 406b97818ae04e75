"""Known programs that start controllers: spawners and `ros2 control`."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

import simkit
from simkit import Simulation
from simkit_launch.mock_robot import mock_robot

ROBOT = """<robot name="arm">
<link name="world"/>
<link name="forearm"><inertial><origin xyz="0 0 0.2"/><mass value="1"/>
  <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="elbow" type="revolute"><parent link="world"/><child link="forearm"/><origin xyz="0 0 1"/>
  <axis xyz="0 1 0"/><limit lower="-1.5" upper="1.5" effort="50" velocity="2"/></joint>
<ros2_control name="arm" type="system"><hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
  <joint name="elbow"><command_interface name="position"/><state_interface name="position"/>
    <state_interface name="velocity"/></joint></ros2_control>
<gazebo><plugin filename="libgz_ros2_control-system.so" name="control"><parameters>arm.yaml</parameters></plugin>
</gazebo>
</robot>"""
CONTROLLERS = """
controller_manager:
  ros__parameters:
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
    arm_controller: {type: position_controllers/JointGroupPositionController}
arm_controller:
  ros__parameters: {joints: [elbow]}
"""
OTHER = """
other_controller:
  ros__parameters: {type: position_controllers/JointGroupPositionController, joints: [elbow]}
"""
BROADCASTER = "joint_state_broadcaster"


@pytest.fixture
def sim(tmp_path: Path) -> Iterator[Simulation]:
    (tmp_path / "arm.yaml").write_text(CONTROLLERS)
    (tmp_path / "other.yaml").write_text(OTHER)
    (tmp_path / "arm.urdf").write_text(ROBOT)
    with simkit.load(tmp_path / "arm.urdf") as simulation:
        yield simulation


def states(sim: Simulation) -> dict[str, str]:
    return {each.name: each.state for each in sim.call("/controller_manager/list_controllers").controller}


def test_without_a_spawner_all_declared_controllers_are_active(sim: Simulation) -> None:
    sim.run(0.1)
    assert states(sim) == {BROADCASTER: "active", "arm_controller": "active"}


def test_with_a_spawner_only_its_controllers_are_loaded(sim: Simulation) -> None:
    node = sim.add_node("controller_manager/spawner", args=[BROADCASTER])
    sim.run(0.5)
    assert states(sim) == {BROADCASTER: "active"}
    assert (node.done, node.exit_code) == (True, 0)
    assert node.log[-1].endswith(f"Configured and activated {BROADCASTER}")


def test_empty_words_are_options_that_are_not_set(sim: Simulation) -> None:
    """A launch file computes such words: "--unload-on-kill", or nothing."""
    words = [BROADCASTER, "-c", "controller_manager", "", "--controller-type", f"{BROADCASTER}/JointStateBroadcaster"]
    node = sim.add_node("controller_manager/spawner", args=words)
    sim.run(0.1)
    assert node.exit_code == 0, node.log
    assert states(sim) == {BROADCASTER: "active"}


def test_spawners_run_beside_each_other_and_a_spawned_controller_moves_the_joint(sim: Simulation) -> None:
    sim.add_node("controller_manager/spawner", args=[BROADCASTER])
    sim.add_node("controller_manager/spawner", args=["arm_controller", "-c", "/controller_manager"])
    sim.run(0.5)
    sim.publish("/arm_controller/commands", {"data": [0.5]})
    sim.run(2.0)
    assert states(sim) == {BROADCASTER: "active", "arm_controller": "active"}
    assert sim.joint("arm::elbow").position == pytest.approx(0.5, abs=0.01)


def test_inactive_controllers_are_configured_only(sim: Simulation) -> None:
    sim.add_node("controller_manager/spawner", args=["arm_controller", "--inactive"])
    sim.run(0.5)
    assert states(sim) == {"arm_controller": "inactive"}


def test_the_type_comes_from_the_parameter_file_of_the_spawner(sim: Simulation, tmp_path: Path) -> None:
    words = ["other_controller", "--param-file", str(tmp_path / "other.yaml")]
    sim.add_node("controller_manager/spawner", args=[*words, "--controller-ros-args", "-r ~/commands:=/go"])
    sim.run(0.5)
    assert states(sim) == {"other_controller": "active"}
    sim.publish("/go", {"data": [0.3]})
    sim.run(2.0)
    assert sim.joint("arm::elbow").position == pytest.approx(0.3, abs=0.01)


def test_a_group_is_activated_in_one_switch(sim: Simulation) -> None:
    node = sim.add_node("controller_manager/spawner", args=[BROADCASTER, "arm_controller", "--activate-as-group"])
    sim.run(0.5)
    assert node.log[-1].endswith(f"Configured and activated {BROADCASTER}, arm_controller")


def test_an_unknown_controller_ends_the_spawner_with_1(sim: Simulation) -> None:
    node = sim.add_node("controller_manager/spawner", args=["leg_controller"])
    sim.run(0.5)
    assert node.exit_code == 1
    assert "Failed loading controller leg_controller" in node.log[-1]


def test_a_spawner_waits_for_its_manager_and_ends_after_the_timeout(tmp_path: Path) -> None:
    with simkit.load('<sdf version="1.9"><world name="w"/></sdf>') as sim:
        words = [BROADCASTER, "--controller-manager-timeout", "2"]
        node = sim.add_node("controller_manager/spawner", args=words)
        sim.run(1.5)
        assert not node.done
        sim.run(1.0)
        assert (node.done, node.exit_code) == (True, 1)


def test_a_robot_that_is_spawned_later_waits_for_its_spawner(sim: Simulation, tmp_path: Path) -> None:
    with simkit.load('<sdf version="1.9"><world name="w"/></sdf>') as world:
        world.add_node("controller_manager/spawner", args=["arm_controller"])
        world.run(0.5)
        world.spawn(tmp_path / "arm.urdf", "arm")
        assert states(world) == {}
        world.run(1.0)
        assert states(world) == {"arm_controller": "active"}


def test_unspawner_unloads(sim: Simulation) -> None:
    node = sim.add_node("controller_manager/unspawner", args=["arm_controller"])
    sim.run(0.5)
    assert (node.exit_code, states(sim)) == (0, {BROADCASTER: "active"})


def test_ros2_control_loads_and_switches_controllers(sim: Simulation) -> None:
    load = ["control", "load_controller", "--set-state"]
    sim.add_node("command/ros2", args=[*load, "active", BROADCASTER])
    sim.add_node("command/ros2", args=[*load, "inactive", "arm_controller"])
    sim.run(0.5)
    assert states(sim) == {BROADCASTER: "active", "arm_controller": "inactive"}
    switch = ["control", "switch_controllers", "--activate", "arm_controller", "--deactivate", BROADCASTER]
    node = sim.add_node("command/ros2", args=switch)
    sim.run(0.5)
    assert node.exit_code == 0
    assert states(sim) == {BROADCASTER: "inactive", "arm_controller": "active"}


def test_two_runs_with_spawners_print_the_same(tmp_path: Path) -> None:
    logs = []
    (tmp_path / "arm.yaml").write_text(CONTROLLERS)
    (tmp_path / "arm.urdf").write_text(ROBOT)
    for _ in range(2):
        with simkit.load(tmp_path / "arm.urdf") as sim:
            nodes = [
                sim.add_node("controller_manager/spawner", args=[name]) for name in (BROADCASTER, "arm_controller")
            ]
            sim.run(0.5)
            logs.append([node.log for node in nodes])
    assert logs[0] == logs[1]


def test_a_mock_robot_without_a_link_world_is_fixed() -> None:
    text = ROBOT.replace('<link name="world"/>', '<link name="post"/>').replace('link="world"', 'link="post"')
    urdf = mock_robot(text, "controller_manager", "<ros/>")
    model = simkit.describe(urdf)["model"]
    assert [joint["name"] for joint in model["joints"]] == ["elbow", "world_to_post"]
    assert model["links"][0]["collisions"] == []


def test_after_a_reset_the_controllers_wait_for_their_spawner_again(sim: Simulation) -> None:
    sim.add_node("controller_manager/spawner", args=["arm_controller"])
    messages: list[int] = []
    sim.subscribe("/joint_states", lambda message: messages.append(sim.tick))
    sim.run(0.2)
    sim.reset()
    sim.run(0.2)
    assert states(sim) == {"arm_controller": "active"} and not messages


def test_the_spawner_of_ros_1_starts_the_controllers_that_it_could_load(tmp_path: Path) -> None:
    """PR2's launch file names controllers of the casters first, which do not run here."""
    transmission = """<transmission name="t"><type>transmission_interface/SimpleTransmission</type>
<joint name="elbow"><hardwareInterface>hardware_interface/PositionJointInterface</hardwareInterface></joint>
<actuator name="m"/></transmission><gazebo><plugin filename="libgazebo_ros_control.so" name="control">
<robotNamespace>/</robotNamespace></plugin></gazebo>"""
    begin, end = ROBOT.index("<ros2_control"), ROBOT.index("</robot>")
    (tmp_path / "arm.urdf").write_text(ROBOT[:begin] + transmission + ROBOT[end:])
    parameters = """
base_controller: {type: pr2_mechanism_controllers/Pr2BaseController}
arm_controller: {type: position_controllers/JointPositionController, joint: elbow}
"""
    (tmp_path / "arm.yaml").write_text(parameters)
    with simkit.load(tmp_path / "arm.urdf", params_files=[tmp_path / "arm.yaml"]) as sim:
        node = sim.add_node("pr2_controller_manager/spawner", args=["base_controller", "arm_controller"])
        sim.run(0.5)
        assert states(sim) == {"arm_controller": "running"}
        assert not node.done  # in ROS 1, the spawner stops its controllers when it ends
        assert any("base_controller" in line for line in node.log)
