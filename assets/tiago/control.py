"""What controls the robots: `<ros2_control>` with its joints, sensors and transmissions, and Gazebo's plugins."""

from __future__ import annotations

from collections.abc import Iterator

from parts import PACKAGE, Plugin

ARM = tuple(f"arm_{k}_joint" for k in range(1, 8))
FINGERS = ("gripper_left_finger_joint", "gripper_right_finger_joint")
ALL = ("position", "velocity", "effort")
IMU = tuple(
    [f"orientation.{axis}" for axis in "xyzw"]
    + [f"{what}.{axis}" for what in ("angular_velocity", "linear_acceleration") for axis in "xyz"]
)
WRENCH = tuple(f"{what}.{axis}" for what in ("force", "torque") for axis in "xyz")


def wheel(name: str) -> Iterator[str]:
    yield f'<joint name="{name}">'
    yield '  <command_interface name="velocity">'
    yield '    <param name="min">-1</param>'
    yield '    <param name="max">1</param>'
    yield "  </command_interface>"
    yield '  <state_interface name="position"/>'
    yield '  <state_interface name="velocity"/>'
    yield "</joint>"


def joint(name: str, commands: tuple[str, ...]) -> Iterator[str]:
    yield f'<joint name="{name}">'
    yield from (f'  <command_interface name="{command}"/>' for command in commands)
    yield from (f'  <state_interface name="{state}"/>' for state in ALL)
    yield "</joint>"


def sensor(name: str, states: tuple[str, ...]) -> Iterator[str]:
    yield f'<sensor name="{name}">'
    yield from (f'  <state_interface name="{state}"/>' for state in states)
    yield "</sensor>"


def simple(name: str) -> Iterator[str]:
    """A transmission with one motor for one joint."""
    stem = name.removesuffix("_joint")
    yield f'<transmission name="{stem}_trans">'
    yield "  <plugin>transmission_interface/SimpleTransmission</plugin>"
    yield f'  <actuator name="{stem}_actuator" role="actuator1"/>'
    yield f'  <joint name="{name}" role="joint1">'
    yield "    <mechanical_reduction>1.0</mechanical_reduction>"
    yield "    <offset>0.0</offset>"
    yield "  </joint>"
    yield "</transmission>"


def wrist() -> Iterator[str]:
    """Two motors that move both joints of the wrist together."""
    yield '<transmission name="arm_6_arm_7_wrist_trans">'
    yield "  <plugin>transmission_interface/DifferentialTransmission</plugin>"
    for number, name, reduction in ((1, "arm_6", "-1.0"), (2, "arm_7", "1.0")):
        yield f'  <actuator name="{name}_actuator" role="actuator{number}">'
        yield f"    <mechanical_reduction>{reduction}</mechanical_reduction>"
        yield "  </actuator>"
    for number, name, reduction in ((1, "arm_6", "1.0"), (2, "arm_7", "-1.0")):
        yield f'  <joint name="{name}_joint" role="joint{number}">'
        yield f"    <mechanical_reduction>{reduction}</mechanical_reduction>"
        yield "    <offset>0.0</offset>"
        yield "  </joint>"
    yield "</transmission>"


def ros2_control(robot: str, torso_and_head: bool, arm: bool) -> tuple[str, ...]:
    """The element for base alone, base with torso and head, or all."""

    def inside() -> Iterator[str]:
        yield "<hardware>"
        yield "  <plugin>gazebo_ros2_control/GazeboSystem</plugin>"
        yield "</hardware>"
        for name in ("wheel_right_joint", "wheel_left_joint"):
            yield from wheel(name)
            yield from simple(name)
        yield from sensor("base_imu_sensor", IMU)
        for name in ("torso_lift_joint", "head_1_joint", "head_2_joint") if torso_and_head else ():
            yield from joint(name, ("position",))
            yield from simple(name)
        if not arm:
            return
        for name in ARM:
            yield from joint(name, ALL)
            if name not in ARM[-2:]:
                yield from simple(name)
        yield from wrist()
        for name in FINGERS:
            yield from joint(name, ("position",))
            yield from simple(name)
        yield from sensor("wrist_ft_sensor", WRENCH)

    opening = f'<ros2_control name="ros2_control_{robot}_system" type="system">'
    return (opening, *(f"  {line}" for line in inside()), "</ros2_control>")


def controllers(file: str) -> Plugin:
    lines = (f"<parameters>package://{PACKAGE}/config/{file}</parameters>",)
    return Plugin("gazebo_ros2_control", "libgazebo_ros2_control.so", lines)


def truth(name: str, topic: str, rate: int) -> Plugin:
    lines = (
        "<body_name>base_footprint</body_name>",
        "<always_on>true</always_on>",
        f"<update_rate>{rate}</update_rate>",
        f"<ros><remapping>odom:={topic}</remapping></ros>",
    )
    return Plugin(name, "libgazebo_ros_p3d.so", lines, f"Where the base really is, on /{topic}.")


def world_odometry() -> Plugin:
    lines = (
        "<frameName>base_footprint</frameName>",
        "<topicName>ground_truth_odom</topicName>",
        "<updateRate>100</updateRate>",
    )
    about = "Where the base really is, on /ground_truth_odom."
    return Plugin("gazebo_world_odometry", "libgazebo_world_odometry.so", lines, about)


def motions(file: str) -> Plugin:
    lines = (f"<motions>package://{PACKAGE}/motions/{file}</motions>",)
    return Plugin("play_motion2", "libsimkit_play_motion.so", lines, "Motions by name, on /play_motion2.")


def joint_frames() -> Plugin:
    lines = ("<publish_frequency>50</publish_frequency>",)
    about = "The links that joints move, on /tf."
    return Plugin("robot_state_publisher", "libsimkit_robot_state_publisher.so", lines, about)


def tiago_plugins(controllers_file: str, motions_file: str) -> tuple[Plugin, ...]:
    return (
        controllers(controllers_file),
        motions(motions_file),
        joint_frames(),
        truth("gazebo_ros_p3d", "ground_truth_odom", 100),
        truth("gazebo_ros_odometry", "floating_base_pose_simulated", 1000),
    )
