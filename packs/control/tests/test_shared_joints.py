"""Wheels that a controller manager and a drive plugin command: the plugin that moves them in Gazebo moves them."""

from __future__ import annotations

from pathlib import Path

import pytest
from control_robots import files, interfaces, reported_messages

import simkit

GZ = '<plugin filename="libgz_ros2_control-system.so" name="control"><parameters>arm.yaml</parameters>{}</plugin>'
CLASSIC = '<plugin filename="libgazebo_ros2_control.so" name="control"><parameters>arm.yaml</parameters>{}</plugin>'
ROS_1 = '<plugin filename="libgazebo_ros_control.so" name="control">{}</plugin>'
GZ_DRIVE = """<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
<left_joint>left</left_joint><right_joint>right</right_joint><wheel_separation>0.4</wheel_separation><wheel_radius>0.1</wheel_radius>
<topic>cmd_vel</topic></plugin>"""
CLASSIC_DRIVE = """<plugin filename="libgazebo_ros_diff_drive.so" name="drive">{}<left_joint>left</left_joint>
<right_joint>right</right_joint><wheel_separation>0.4</wheel_separation><wheel_diameter>0.2</wheel_diameter>
<max_wheel_torque>20</max_wheel_torque></plugin>"""
INERTIAL = '<inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>'
NO_CONTROLLERS = "controller_manager:\n  ros__parameters: {update_rate: 100}\n"


def wheels(*plugins: str, interface: str = "velocity", kind: str = "") -> str:
    """Return a fixed base with two wheels; `kind` is a hardware interface of ROS 1."""
    parts = "".join(
        f'<link name="{n}_link">{INERTIAL}</link><joint name="{n}" type="continuous"><parent link="world"/>'
        f'<child link="{n}_link"/><origin xyz="0 {y} 0.1"/><axis xyz="0 1 0"/></joint>'
        for n, y in (("left", 0.2), ("right", -0.2))
    )
    joints = "".join(f'<joint name="{n}">{interfaces((interface,))}</joint>' for n in ("left", "right"))
    control = f'<ros2_control name="c" type="system">{joints}</ros2_control>'
    if kind:
        control = "".join(
            f'<transmission name="{n}"><type>transmission_interface/SimpleTransmission</type><joint name="{n}">'
            f"<hardwareInterface>hardware_interface/{kind}</hardwareInterface></joint>"
            f'<actuator name="m_{n}"/></transmission>'
            for n in ("left", "right")
        )
    return f'<robot name="base"><link name="world"/>{parts}{control}<gazebo>{"".join(plugins)}</gazebo></robot>'


def speed_and_warning(folder: Path, robot: str) -> tuple[float, str]:
    """Return the speed of the left wheel [rad/s] one second after a command of 0.5 m/s, and the warning."""
    with simkit.load(files(folder, robot, NO_CONTROLLERS)) as sim:
        topic = next(topic for topic in sim.topics() if topic.endswith("cmd_vel"))
        sim.publish(topic, {"linear": {"x": 0.5}})
        sim.run(1.0)
        (message,) = reported_messages(sim, "SK-CONTROL-004")
        return float(sim.joint("base::left").velocity), message


@pytest.mark.parametrize("is_later", [False, True])
def test_the_motor_of_a_classic_drive_prevails_over_held_wheels(tmp_path: Path, is_later: bool) -> None:
    plugins = [CLASSIC.format(""), CLASSIC_DRIVE.format("")]
    speed, message = speed_and_warning(tmp_path, wheels(*(plugins if is_later else plugins[::-1])))
    assert speed == pytest.approx(5.0, abs=0.01)
    assert "'drive' moves them, and 'control' has no effect on them" in message


def test_the_later_plugin_of_gz_prevails(tmp_path: Path) -> None:
    speed, message = speed_and_warning(tmp_path, wheels(GZ.format(""), GZ_DRIVE))
    assert speed == pytest.approx(5.0, abs=0.01)
    assert "'gz::sim::systems::DiffDrive' moves them" in message
    speed, message = speed_and_warning(tmp_path, wheels(GZ_DRIVE, GZ.format("")))
    assert speed == pytest.approx(0.0, abs=0.01)
    assert "the commands of 'gz::sim::systems::DiffDrive' have no effect, as in Gazebo" in message


def test_a_manager_that_does_not_hold_its_joints_leaves_them_to_the_drive(tmp_path: Path) -> None:
    speed, _ = speed_and_warning(tmp_path, wheels(GZ_DRIVE, GZ.format("<hold_joints>false</hold_joints>")))
    assert speed == pytest.approx(5.0, abs=0.01)


@pytest.mark.parametrize(
    ("kind", "ros", "speed"),
    [("EffortJointInterface", "", 5.0), ("VelocityJointInterface", "", 0.0), ("VelocityJointInterface", "<ros/>", 5.0)],
)
def test_ros_1_holds_wheels_with_a_velocity_interface(tmp_path: Path, kind: str, ros: str, speed: float) -> None:
    robot = wheels(ROS_1.format(""), CLASSIC_DRIVE.format(ros), kind=kind)
    assert speed_and_warning(tmp_path, robot)[0] == pytest.approx(speed, abs=0.01)


def test_the_velocity_of_a_run_goes_to_the_active_one_of_two_drives(tmp_path: Path) -> None:
    drive = "{left_wheel_names: [left], right_wheel_names: [right], wheel_separation: 0.4, wheel_radius: 0.1}"
    kind = "{type: diff_drive_controller/DiffDriveController}"
    controllers = f"""controller_manager: {{ros__parameters: {{update_rate: 100, base: {kind}, spare: {kind}}}}}
base: {{ros__parameters: {drive}}}
spare: {{ros__parameters: {drive}}}
"""
    with simkit.load(files(tmp_path, wheels(GZ.format("")), controllers)) as sim:
        assert sim.communication.bus.idle_topics() == {"/spare/cmd_vel"}
        state = sim.snapshot()
        request = {"activate_controllers": ["spare"], "deactivate_controllers": ["base"], "strictness": 2}
        assert sim.call("/controller_manager/switch_controller", request).ok
        sim.run(0.05)
        assert sim.communication.bus.idle_topics() == {"/base/cmd_vel"}
        sim.restore(state)
        assert sim.communication.bus.idle_topics() == {"/spare/cmd_vel"}
