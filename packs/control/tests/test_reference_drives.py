"""Steering and mecanum drives of ros2_control on wheels: distance and yaw that were asked for, and the odometry."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from control_robots import interfaces, reported_messages

import simkit

TOPICS = ("/base/reference", "/base/odometry")
RADIUS, BASE, TRACK = 0.1, 0.5, 0.4
LINK = """<link name="{name}">{shape}<inertial><mass value="{mass}"/>
<inertia ixx="{i}" iyy="{i}" izz="{i}" ixy="0" ixz="0" iyz="0"/></inertial></link>"""
JOINT = """<joint name="{name}" type="continuous"><origin xyz="{xyz}"/><parent link="{parent}"/><child link="{child}"/>
<axis xyz="{axis}"/></joint>"""
GROUND = """<sdf version="1.9"><world name="lab"><include><uri>{uri}</uri></include>
<model name="ground"><static>true</static>
<link name="l"><collision name="c"><geometry><plane/></geometry></collision></link></model></world></sdf>"""
SHAPE = '<collision><geometry><sphere radius="0.1"/></geometry></collision>'
ROLLERS = """<gazebo reference="{name}"><collision><surface><friction><ode><mu>1</mu><mu2>0</mu2>
<fdir1 gz:expressed_in="chassis">{direction}</fdir1></ode></friction></surface></collision></gazebo>"""


def wheel(name: str, x: float, y: float, *, steered: bool = False) -> str:
    """Return a wheel at the chassis; a steered wheel is on a vertical joint `<name>_steering`."""
    parent, place, found = "chassis", f"{x} {y} {RADIUS}", ""
    if steered:
        found = LINK.format(name=f"{name}_fork", shape="", mass=0.5, i=0.01)
        joint = JOINT.format(name=f"{name}_steering", xyz=place, parent="chassis", child=f"{name}_fork", axis="0 0 1")
        parent, place, found = f"{name}_fork", "0 0 0", found + joint
    axle = JOINT.format(name=f"{name}_wheel", xyz=place, parent=parent, child=name, axis="0 1 0")
    return found + LINK.format(name=name, shape=SHAPE, mass=1, i=0.005) + axle


def drive(
    folder: Path, wheels: str, driven: list[str], steered: list[str], kind: str, values: str
) -> simkit.Simulation:
    """Load a base on the ground with one controller called `base`."""
    hardware = "".join(f'<joint name="{j}_wheel">{interfaces(("velocity",))}</joint>' for j in driven)
    hardware += "".join(f'<joint name="{j}_steering">{interfaces(("position",))}</joint>' for j in steered)
    chassis = LINK.format(name="chassis", shape="", mass=10, i=0.5)
    chassis = chassis.replace("<inertial>", '<inertial><origin xyz="0.2 0 0.1"/>')
    robot = f"""<robot name="base" xmlns:gz="http://gazebosim.org/schema">{chassis}{wheels}
<ros2_control name="base" type="system"><hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
{hardware}</ros2_control>
<gazebo><plugin filename="gz_ros2_control-system" name="gz_ros2_control::GazeboSimROS2ControlPlugin">
<parameters>base.yaml</parameters></plugin></gazebo></robot>"""
    (folder / "base.urdf").write_text(robot, encoding="utf-8")
    (folder / "base.yaml").write_text(f"base: {{ros__parameters: {{type: {kind}, {values}}}}}", encoding="utf-8")
    (folder / "lab.sdf").write_text(GROUND.format(uri=folder / "base.urdf"), encoding="utf-8")
    return simkit.load(folder / "lab.sdf")


def steering(folder: Path, kind: str, values: str = "") -> simkit.Simulation:
    """Load a base with an axle at x = 0 and an axle at x = 0.5 m; `kind` names its kinematics."""
    rear = wheel("right", 0, -TRACK / 2) + wheel("left", 0, TRACK / 2)
    sizes = f"wheelbase: {BASE}, traction_wheels_radius: {RADIUS}, traction_track_width: {TRACK}"
    if kind == "ackermann":
        front = wheel("fr", BASE, -TRACK / 2, steered=True) + wheel("fl", BASE, TRACK / 2, steered=True)
        names = "traction_joints_names: [right_wheel, left_wheel], steering_joints_names: [fr_steering, fl_steering]"
        values = f"{names}, {sizes}, steering_track_width: {TRACK}, {values}"
        controller = "ackermann_steering_controller/AckermannSteeringController"
        return drive(folder, rear + front, ["right", "left"], ["fr", "fl"], controller, values)
    driven = ["f"] if kind == "front drive" else ["right", "left"]
    names = f"traction_joints_names: [{', '.join(f'{j}_wheel' for j in driven)}], steering_joints_names: [f_steering]"
    controller = "tricycle_steering_controller/TricycleSteeringController"
    front = wheel("f", BASE, 0, steered=True)
    return drive(folder, rear + front, driven, ["f"], controller, f"{names}, {sizes}, {values}")


def send(sim: simkit.Simulation, ahead: float, turn: float, left: float = 0.0, topic: str = TOPICS[0]) -> None:
    twist = {"linear": {"x": ahead, "y": left}, "angular": {"z": turn}}
    sim.publish(topic, simkit.msgs.make("geometry_msgs/msg/TwistStamped", twist=twist))


def driven_pose(
    sim: simkit.Simulation, ahead: float, turn: float, left: float = 0.0, topics: tuple[str, str] = TOPICS
) -> tuple[list[float], list[float]]:
    """Drive for 4 s; return x, y [m] and yaw [rad] of the base and of its odometry."""
    odometry = sim.subscribe(topics[1], keep=1)
    sim.run(0.2)
    for _ in range(8):
        send(sim, ahead, turn, left, topics[0])
        sim.run(0.5)
    link, message = sim.link("base::chassis"), odometry.messages[-1].pose.pose
    x, y, _ = link.pose.position
    w, _, _, z = link.pose.quaternion
    measured = [message.position.x, message.position.y, 2 * math.atan2(message.orientation.z, message.orientation.w)]
    return [float(x), float(y), 2 * math.atan2(float(z), float(w))], measured


@pytest.mark.parametrize("kind", ["ackermann", "front drive", "rear drive"])
@pytest.mark.parametrize(("ahead", "turn"), [(0.3, 0.0), (0.3, 0.3), (-0.3, 0.3)])
def test_a_steered_base_drives_the_distance_and_the_angle_that_were_asked_for(
    tmp_path: Path, kind: str, ahead: float, turn: float
) -> None:
    with steering(tmp_path, kind) as sim:
        found, measured = driven_pose(sim, ahead, turn)
    yaw = turn * 4
    wanted = [ahead / turn * math.sin(yaw), ahead / turn * (1 - math.cos(yaw)), yaw] if turn else [ahead * 4, 0, 0]
    # the wheels start and are steered within some hundredths of a second
    assert found == pytest.approx(wanted, abs=0.06)
    assert measured == pytest.approx(found, abs=0.03)


def test_a_tricycle_with_front_drive_turns_in_place(tmp_path: Path) -> None:
    with steering(tmp_path, "front drive", "reduce_wheel_speed_until_steering_reached: true") as sim:
        found, _ = driven_pose(sim, 0.0, 0.4)
    assert found == pytest.approx([0, 0, 1.6], abs=0.1)


def test_after_the_timeout_the_base_stops_and_stays_steered(tmp_path: Path) -> None:
    with steering(tmp_path, "ackermann", "reference_timeout: 0.3") as sim:
        send(sim, 0.3, 0.3)
        sim.run(1.0)
        inner, outer = (float(sim.joint(f"base::{name}_steering").position) for name in ("fl", "fr"))
        # the middle of the axle turns about a point 1 m to the left: tan = 0.5/(1 ∓ 0.2)
        assert (inner, outer) == pytest.approx((math.atan(0.5 / 0.8), math.atan(0.5 / 1.2)), abs=0.01)
        before = sim.link("base::chassis").pose.position
        sim.run(1.0)
        assert sim.link("base::chassis").pose.position == pytest.approx(before, abs=2e-3)


TRICYCLE = """traction_joint_name: f_wheel, steering_joint_name: f_steering, wheel_radius: 0.1, wheelbase: 0.5,
enable_odom_tf: true, cmd_vel_timeout: 600"""


def tricycle(folder: Path, values: str = "") -> simkit.Simulation:
    """Load a base whose front wheel is driven and steered by the tricycle controller."""
    wheels = wheel("right", 0, -TRACK / 2) + wheel("left", 0, TRACK / 2) + wheel("f", BASE, 0, steered=True)
    controller = "tricycle_controller/TricycleController"
    return drive(folder, wheels, ["f"], ["f"], controller, f"{TRICYCLE}, {values}")


@pytest.mark.parametrize(
    ("ahead", "turn", "x", "y"), [(0.3, 0.0, 1.2, 0.0), (0.3, 0.3, 0.932, 0.638), (0.0, 0.3, 0.0, 0.0)]
)
def test_a_tricycle_controller_drives_the_distance_and_the_angle(
    tmp_path: Path, ahead: float, turn: float, x: float, y: float
) -> None:
    with tricycle(tmp_path) as sim:
        found, measured = driven_pose(sim, ahead, turn, topics=("/base/cmd_vel", "/base/odom"))
        assert "/tf" in sim.topics()
    assert found == pytest.approx([x, y, turn * 4], abs=0.08)
    assert measured == pytest.approx(found, abs=0.03)


def test_limits_of_a_tricycle_bound_the_acceleration_and_the_steering(tmp_path: Path) -> None:
    limits = (
        "traction: {max_acceleration: 2.0, max_deceleration: 4.0}, steering: {max_position: 0.2, max_velocity: 0.5}"
    )
    with tricycle(tmp_path, limits) as sim:
        wheel_joint, steering_joint = sim.joint("base::f_wheel"), sim.joint("base::f_steering")
        send(sim, 0.3, 0.3, topic="/base/cmd_vel")
        sim.run(0.3)
        # 2 rad/s² and 0.5 rad/s for 0.3 s
        assert float(wheel_joint.velocity) == pytest.approx(0.6, abs=0.1)
        assert float(steering_joint.position) == pytest.approx(0.15, abs=0.02)
        sim.run(0.3)
        assert float(steering_joint.position) == pytest.approx(0.2, abs=0.01)
        sim.run(1.0)  # the command has expired
        assert float(wheel_joint.velocity) == pytest.approx(0.0, abs=0.02)
        assert float(steering_joint.position) == pytest.approx(0.0, abs=0.01)


def test_names_of_earlier_releases_give_the_same_motion(tmp_path: Path) -> None:
    values = f"front_steering: true, rear_wheels_radius: {RADIUS}, front_wheels_radius: {RADIUS}, wheelbase: {BASE}, "
    values += "rear_wheels_names: [right_wheel, left_wheel], front_wheels_names: [f_steering], wheel_track: 0.4"
    wheels = wheel("right", 0, -TRACK / 2) + wheel("left", 0, TRACK / 2) + wheel("f", BASE, 0, steered=True)
    controller = "tricycle_steering_controller/TricycleSteeringController"
    with drive(tmp_path, wheels, ["right", "left"], ["f"], controller, values) as sim:
        found, _ = driven_pose(sim, 0.3, 0.0)
        assert not reported_messages(sim, "SK-CONTROL-011")
    assert found == pytest.approx([1.2, 0, 0], abs=0.04)


@pytest.mark.parametrize(
    ("ahead", "left", "turn", "spelling"),
    [(0.3, 0, 0, "ros"), (0, 0.3, 0, "ros"), (0, 0, 0.4, "ros"), (0.2, 0.2, 0, "husarion")],
)
def test_a_mecanum_base_moves_forward_sideways_and_in_place(
    tmp_path: Path, ahead: float, left: float, turn: float, spelling: str
) -> None:
    places = {"fl": (0.25, 0.2, "1 -1 0"), "fr": (0.25, -0.2, "1 1 0"), "rl": (-0.25, 0.2, "1 1 0")}
    places["rr"] = (-0.25, -0.2, "1 -1 0")
    wheels = "".join(wheel(n, x, y) + ROLLERS.format(name=n, direction=d) for n, (x, y, d) in places.items())
    names = {"front_left": "fl", "front_right": "fr", "rear_left": "rl", "rear_right": "rr"}
    if spelling == "husarion":
        values = ", ".join(f"{place}_wheel_name: {joint}_wheel" for place, joint in names.items())
        values += f", cmd_vel_timeout: 1.0, wheel_radius: {RADIUS}, wheel_separation_x: 0.5, wheel_separation_y: 0.4"
    else:
        values = ", ".join(f"{place}_wheel_command_joint_name: {joint}_wheel" for place, joint in names.items())
        sizes = f"wheels_radius: {RADIUS}, sum_of_robot_center_projection_on_X_Y_axis: 0.45"
        values += f", reference_timeout: 1.0, kinematics: {{{sizes}}}"
    controller = "mecanum_drive_controller/MecanumDriveController"
    topics = ("/base/cmd_vel", "/base/odom") if spelling == "husarion" else ("/base/reference", "/base/odometry")
    with drive(tmp_path, wheels, list(places), [], controller, values) as sim:
        found, measured = driven_pose(sim, ahead, turn, left, topics)
    assert found == pytest.approx([4 * ahead, 4 * left, 4 * turn], abs=0.06)
    assert measured == pytest.approx(found, abs=0.04)


@pytest.mark.parametrize(
    ("ahead", "left", "turn", "more"),
    [
        (0.2, 0.1, 0.0, "cmd_vel_timeout: 5.0"),
        (0.0, 0.0, 0.3, "cmd_vel_timeout: 5.0, position_feedback: false"),
    ],
)
def test_three_omnidirectional_wheels_drive_and_turn_as_asked(
    tmp_path: Path, ahead: float, left: float, turn: float, more: str
) -> None:
    wheels = ""
    for index, angle in enumerate((math.radians(30), math.radians(150), math.radians(270))):
        x, y = math.cos(angle), math.sin(angle)
        one = wheel(f"w{index}", 0.3 * x, 0.3 * y).replace('<axis xyz="0 1 0"/>', f'<axis xyz="{x} {y} 0"/>')
        wheels += one + ROLLERS.format(name=f"w{index}", direction=f"{-y} {x} 0")
    names = "w0", "w1", "w2"
    values = f"wheel_names: [{', '.join(f'{name}_wheel' for name in names)}], wheel_offset: {math.radians(30)}, "
    values += f"robot_radius: 0.3, wheel_radius: {RADIUS}, {more}"
    controller = "omni_wheel_drive_controller/OmniWheelDriveController"
    with drive(tmp_path, wheels.replace('<origin xyz="0.2 0 0.1"/>', ""), list(names), [], controller, values) as sim:
        found, measured = driven_pose(sim, ahead, turn, left, ("/base/cmd_vel", "/base/odom"))
    assert found == pytest.approx([4 * ahead, 4 * left, 4 * turn], abs=0.06)
    assert measured == pytest.approx(found, abs=0.04)


def test_two_omnidirectional_wheels_are_too_few(tmp_path: Path) -> None:
    values = "wheel_names: [a_wheel, b_wheel], robot_radius: 0.3, wheel_radius: 0.1"
    wheels = wheel("a", 0.3, 0) + wheel("b", -0.3, 0)
    with pytest.raises(simkit.LoadError, match="SK-CONTROL-040: wheel_names names 2 joints"):
        drive(tmp_path, wheels, ["a", "b"], [], "omni_wheel_drive_controller/OmniWheelDriveController", values)


def test_the_ackermann_controller_of_ros_1_commands_both_sides_of_a_steer_bot(tmp_path: Path) -> None:
    front = wheel("fr", BASE, -TRACK / 2, steered=True) + wheel("fl", BASE, TRACK / 2, steered=True)
    wheels = wheel("right", 0, -TRACK / 2) + wheel("left", 0, TRACK / 2) + front
    values = (
        f"rear_wheel: middle_wheel, front_steer: middle_steering, wheel_separation_h: {BASE}, wheel_radius: {RADIUS}"
    )
    hardware = f"""virtual_rear_wheels: [right_wheel, left_wheel], virtual_front_steers: [fr_steering, fl_steering],
      wheel_separation_h: {BASE}, wheel_separation_w: {TRACK}"""
    values = f"{values}}}}}\nsteer_bot_hardware_gazebo: {{ros__parameters: {{{hardware}"
    kind = "ackermann_steering_controller/AckermannSteeringController"
    with drive(tmp_path, wheels, ["right", "left"], ["fr", "fl"], kind, values) as sim:
        odometry = sim.subscribe("/base/odom", keep=1)
        send(sim, 0.5, 0.5, topic="/base/cmd_vel")
        sim.run(0.5)
        base = sim.model("base")
        steer = math.atan(0.5 * BASE / 0.5)
        expected = [math.atan2(2 * BASE * math.tan(steer), 2 * BASE + s * TRACK / 2 * math.tan(steer)) for s in (1, -1)]
        angles = [base.joint(f"{side}_steering").position for side in ("fr", "fl")]
        assert angles == pytest.approx(expected, abs=0.01)
        speeds = [base.joint(f"{side}_wheel").velocity for side in ("right", "left")]
        assert speeds == pytest.approx([0.5 / RADIUS] * 2, rel=0.03)
        assert odometry.messages[-1].twist.twist.angular.z == pytest.approx(0.5, abs=0.05)


def test_a_wrong_number_of_joints_and_missing_sizes_are_errors(tmp_path: Path) -> None:
    values = "traction_joints_names: [right_wheel], steering_joints_names: [fr_steering, fr_steering]"
    wheels = wheel("right", 0, 0) + wheel("fr", BASE, 0, steered=True)
    controller = "ackermann_steering_controller/AckermannSteeringController"
    with pytest.raises(simkit.LoadError) as caught:
        drive(tmp_path, wheels, ["right"], ["fr"], controller, values)
    codes = [d.code for d in caught.value.diagnostics if d.severity == "error"]
    assert codes.count("SK-CONTROL-040") == 2 and "SK-CONTROL-041" in codes and "SK-PARAM-001" in codes


ROS_1 = """base:
  type: mecanum_drive_controller/MecanumDriveController
  front_left_wheel_joint: fl_wheel
  front_right_wheel_joint: fr_wheel
  back_left_wheel_joint: bl_wheel
  back_right_wheel_joint: br_wheel
  pose_covariance_diagonal: [0.001, 0.001, 1000000.0, 1000000.0, 1000000.0, 0.03]
  twist_covariance_diagonal: [0.001, 0.001, 0.001, 1000000.0, 1000000.0, 0.03]
"""


def ros_1_mecanum(folder: Path, values: str = "", shape: str = SHAPE) -> simkit.Simulation:
    """Load a mecanum base with the controller of ROS 1, which has no sizes in its parameters."""
    places = {"fl": (1, 1, "1 -1 0"), "fr": (1, -1, "1 1 0"), "bl": (-1, 1, "1 1 0"), "br": (-1, -1, "1 -1 0")}
    wheels = "".join(wheel(name, x * BASE / 2, y * TRACK / 2) for name, (x, y, _) in places.items())
    wheels = wheels.replace(SHAPE, shape)
    wheels += "".join(ROLLERS.format(name=name, direction=way) for name, (_, _, way) in places.items())
    wheels += "".join(
        f'<transmission name="t{name}"><type>transmission_interface/SimpleTransmission</type>'
        f'<joint name="{name}_wheel"><hardwareInterface>hardware_interface/VelocityJointInterface'
        "</hardwareInterface></joint>"
        f'<actuator name="m{name}"><mechanicalReduction>1</mechanicalReduction></actuator></transmission>'
        for name in places
    )
    chassis = LINK.format(name="chassis", shape="", mass=10, i=0.5)
    robot = f"""<robot name="base" xmlns:gz="http://gazebosim.org/schema">{chassis}{wheels}
<gazebo><plugin filename="libgazebo_ros_control.so" name="control"><robotNamespace>/</robotNamespace>
<simkit:parameters>base.yaml</simkit:parameters></plugin></gazebo></robot>"""
    (folder / "base.urdf").write_text(robot, encoding="utf-8")
    (folder / "base.yaml").write_text(ROS_1 + values, encoding="utf-8")
    (folder / "lab.sdf").write_text(GROUND.format(uri=folder / "base.urdf"), encoding="utf-8")
    return simkit.load(folder / "lab.sdf")


@pytest.mark.parametrize(
    ("twist", "expected"), [((0, 0.3, 0), (0, 0.6, 0)), pytest.param((0.2, 0, 0.5), None, marks=pytest.mark.slow)]
)
def test_the_mecanum_controller_of_ros_1_takes_its_sizes_from_the_model(
    tmp_path: Path, twist: tuple[float, float, float], expected: tuple[float, float, float] | None
) -> None:
    with ros_1_mecanum(tmp_path, "  cmd_vel_timeout: 100\n") as sim:
        odometry = sim.subscribe("/base/odom")
        sim.run(0.5)
        x, y, turn = twist
        command = {"linear": {"x": float(x), "y": float(y)}, "angular": {"z": float(turn)}}
        sim.publish("/base/cmd_vel", simkit.msgs.make("geometry_msgs/msg/Twist", **command))
        sim.run(2.0)
        assert len(odometry.messages) == pytest.approx(125, abs=2)  # 50 Hz
        pose = sim.model("base").pose
        if expected is None:  # an arc with the radius v / w
            radius = x / turn
            expected = (radius * math.sin(turn * 2), radius * (1 - math.cos(turn * 2)), turn * 2)
        assert (*pose.position[:2], pose.rpy[2]) == pytest.approx(expected, abs=0.03)
        measured = odometry.messages[-1].pose.pose
        assert (measured.position.x, measured.position.y) == pytest.approx(expected[:2], abs=0.03)


def test_the_mecanum_controller_of_ros_1_brakes_after_its_timeout(tmp_path: Path) -> None:
    with ros_1_mecanum(tmp_path) as sim:
        sim.publish("/base/cmd_vel", simkit.msgs.make("geometry_msgs/msg/Twist", linear={"x": 0.4}))
        sim.run(2.0)
        assert sim.model("base").pose.position[0] == pytest.approx(0.4 * 0.5, abs=0.02)


def test_the_mecanum_controller_of_ros_1_needs_round_wheels(tmp_path: Path) -> None:
    box = '<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>'
    with pytest.raises(simkit.InputError, match="SK-CONTROL-040.*cylinders or spheres"):
        ros_1_mecanum(tmp_path, shape=box)
