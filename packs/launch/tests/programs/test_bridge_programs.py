"""Known programs that bridge topics of Gazebo and ROS: `parameter_bridge` and `image_bridge`."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from typer.testing import CliRunner

import simkit
from simkit import Simulation
from simkit.cli import app

FOLDER = Path(__file__).with_name("worlds")
WORLD = (FOLDER / "field.sdf").read_text()
ROBOT = (FOLDER / "cart.urdf").read_text()

BRIDGE = "ros_gz_bridge/parameter_bridge"
ODOMETRY = "/model/cart/odometry@nav_msgs/msg/Odometry[gz.msgs.Odometry"
COMMAND = "/model/cart/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist"
SCAN = "/world/field/model/cart/link/laser/sensor/lidar/scan"
DRIVER = """
import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("driver")
out = node.create_publisher(Twist, "/cmd_vel", 1)
twist = Twist()
twist.linear.x = 0.3
node.create_timer(0.1, lambda: out.publish(twist))
rclpy.spin(node)
"""


@pytest.fixture
def sim() -> Iterator[Simulation]:
    with simkit.load(WORLD) as simulation:
        yield simulation


def spawn(sim: Simulation) -> None:
    """Spawn the robot as a launch file does."""
    sim.add_node("ros_gz_sim/create", args=["-string", ROBOT])


def reports(sim: Simulation, code: str) -> list[str]:
    sim.check_nodes()
    return [report.message for report in sim.diagnostics if report.code == code]


def test_names_of_ros_drive_a_robot_that_is_spawned_later_and_read_it(sim: Simulation) -> None:
    remap = {"/model/cart/odometry": "/odom", "/model/cart/cmd_vel": "cmd_vel"}
    bridge = sim.add_node(BRIDGE, args=[ODOMETRY, COMMAND], remap=remap, namespace="/r1")
    odometry, scans = sim.subscribe("/odom"), sim.subscribe("/r1/cmd_vel")
    command = sim.advertise("/r1/cmd_vel", "geometry_msgs/msg/Twist")
    sim.run(0.5)
    spawn(sim)
    sim.run(0.1)
    command.publish({"linear": {"x": 0.3}})
    sim.run(1.0)
    assert odometry.latest.twist.twist.linear.x == pytest.approx(0.3, abs=0.01)
    assert sim.models["cart"].pose.position[0] > 0.2
    assert len(scans.messages) == 1
    assert "Creating ROS->GZ Bridge: [/model/cart/cmd_vel (geometry_msgs/msg/Twist) -> " in "\n".join(bridge.log)
    assert reports(sim, "SK-LAUNCH-062") == []


def test_two_robots_in_namespaces_do_not_share_topics(sim: Simulation) -> None:
    for number, name in enumerate(("r1", "r2")):
        sim.add_node("ros_gz_sim/create", args=["-string", ROBOT, "-name", name, "-y", str(number)], namespace=name)
        rules = [rule.replace("cart", name) for rule in (ODOMETRY, COMMAND)]
        remap = {f"/model/{name}/odometry": "odom", f"/model/{name}/cmd_vel": "cmd_vel"}
        sim.add_node(BRIDGE, args=rules, remap=remap, namespace=name)
    sim.run(0.1)
    first, second = sim.subscribe("/r1/odom"), sim.subscribe("/r2/odom")
    sim.publish("/r1/cmd_vel", {"linear": {"x": 0.3}})
    sim.publish("/r2/cmd_vel", {"linear": {"x": -0.2}})
    sim.run(1.0)
    speeds = [odometry.latest.twist.twist.linear.x for odometry in (first, second)]
    assert speeds == pytest.approx([0.3, -0.2], abs=0.01)


def test_a_run_after_a_reset_has_the_same_bits(sim: Simulation) -> None:
    spawn(sim)
    words = [f"{SCAN}@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan", COMMAND]
    sim.add_node(BRIDGE, args=words, remap={SCAN: "/scan", "/model/cart/cmd_vel": "/cmd_vel"})
    runs = []
    for _ in range(2):
        scans = sim.subscribe("/scan")
        sim.run(0.2)
        sim.publish("/cmd_vel", {"linear": {"x": 0.3}})
        sim.run(0.8)
        runs.append([*map(simkit.msgs.serialize, scans.messages), sim.models["cart"].pose.position.tobytes()])
        scans.close()
        sim.reset()
    assert runs[0] == runs[1] and len(runs[0]) >= 10


def test_a_bridge_from_gazebo_takes_no_commands_and_one_to_gazebo_gives_no_messages(sim: Simulation) -> None:
    spawn(sim)
    words = ["/model/cart/cmd_vel@geometry_msgs/msg/Twist[gz.msgs.Twist", ODOMETRY.replace("[", "]")]
    sim.add_node(BRIDGE, args=words, remap={"/model/cart/cmd_vel": "/cmd_vel", "/model/cart/odometry": "/odom"})
    sim.run(0.1)
    odometry = sim.subscribe("/odom")
    sim.advertise("/cmd_vel", "geometry_msgs/msg/Twist").publish({"linear": {"x": 0.3}})
    sim.run(0.5)
    assert odometry.messages == []
    assert sim.models["cart"].pose.position[0] == pytest.approx(0, abs=0.01)


def test_a_bridge_of_both_directions_sends_nothing_back(sim: Simulation) -> None:
    spawn(sim)
    sim.add_node(BRIDGE, args=[COMMAND.replace("]", "@")], remap={"/model/cart/cmd_vel": "/cmd_vel"})
    sim.run(0.1)
    ros, gazebo = sim.subscribe("/cmd_vel"), sim.subscribe("/model/cart/cmd_vel")
    sim.publish("/cmd_vel", {"linear": {"x": 0.3}})
    sim.run(0.1)
    assert (len(ros.messages), len(gazebo.messages)) == (1, 1)
    sim.publish("/model/cart/cmd_vel", {"linear": {"x": 0.1}})
    sim.run(0.1)
    assert (len(ros.messages), len(gazebo.messages)) == (2, 2)


@pytest.mark.parametrize("name", ["/cmd_vel", "/model/cart/cmd_vel"])
def test_stamped_commands_drive_a_robot_that_takes_plain_ones(sim: Simulation, name: str) -> None:
    spawn(sim)
    rule = COMMAND.replace("msg/Twist", "msg/TwistStamped")
    sim.add_node(BRIDGE, args=[rule], remap={"/model/cart/cmd_vel": name})
    sim.run(0.1)
    out = sim.advertise(name, "geometry_msgs/msg/TwistStamped")
    out.publish({"twist": {"linear": {"x": 0.3}}})
    sim.run(1.0)
    assert sim.models["cart"].pose.position[0] > 0.2
    assert reports(sim, "SK-LAUNCH-061") == []


def test_a_message_with_a_header_is_converted_to_one_without(sim: Simulation) -> None:
    spawn(sim)
    sim.add_node(
        BRIDGE, args=["/model/cart/tf@geometry_msgs/msg/PoseArray[gz.msgs.Pose_V"], remap={"/model/cart/tf": "/p"}
    )
    sim.run(0.1)
    poses = sim.subscribe("/p")
    sim.run(0.1)
    assert poses.latest.header.frame_id == "cart/odom" and len(poses.latest.poses) == 1


def test_frames_have_slashes_as_those_of_the_bridge(sim: Simulation) -> None:
    spawn(sim)
    sim.run(0.1)
    assert sim.sensor("cart::laser::lidar").frame_id == "cart::laser::lidar"
    sim.add_node(BRIDGE, args=[f"{SCAN}@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan"], remap={SCAN: "/scan"})
    scans = sim.subscribe("/scan")
    sim.run(0.5)
    assert scans.latest.header.frame_id == "cart/laser/lidar"


def test_a_topic_may_name_the_link_that_gazebo_has_after_it_merged_fixed_joints(sim: Simulation) -> None:
    merged = SCAN.replace("laser", "base_footprint")
    sim.add_node(BRIDGE, args=[f"{merged}@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan"])
    sim.run(0.1)
    spawn(sim)
    scans = sim.subscribe(merged)
    sim.run(0.5)
    assert scans.latest.header.frame_id == "cart/base_footprint/lidar"
    assert reports(sim, "SK-LAUNCH-062") == []


def test_a_topic_of_a_world_with_another_name_is_that_of_the_run(sim: Simulation) -> None:
    spawn(sim)
    other = SCAN.replace("field", "warehouse")
    sim.add_node(BRIDGE, args=[f"{other}@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan"])
    scans = sim.subscribe(other)
    sim.run(0.5)
    assert scans.messages and len(reports(sim, "SK-LAUNCH-060")) == 1


def test_topics_that_never_come_are_reported_at_the_end_with_the_closest_names(sim: Simulation) -> None:
    spawn(sim)
    words = ["/model/car/odometry@nav_msgs/msg/Odometry[gz.msgs.Odometry", COMMAND]
    sim.add_node(BRIDGE, args=words)
    sim.run(0.1)
    (text,) = reports(sim, "SK-LAUNCH-062")
    assert "/model/car/odometry" in text and "cmd_vel" not in text
    (hint,) = [report.hint for report in sim.diagnostics if report.code == "SK-LAUNCH-062"]
    assert "did you mean '/model/cart/odometry'?" in hint


def test_types_that_differ_are_reported_with_both_types(sim: Simulation) -> None:
    spawn(sim)
    words = [
        "/model/cart/odometry@sensor_msgs/msg/Imu[gz.msgs.IMU",
        "/model/cart/tf@std_msgs/msg/String[gz.msgs.Pose_V",
    ]
    bridge = sim.add_node(BRIDGE, args=words, remap={"/model/cart/odometry": "/imu"})
    sim.run(0.1)
    (text,) = reports(sim, "SK-LAUNCH-061")
    assert "[sensor_msgs/msg/Imu]" in text and "nav_msgs/msg/Odometry" in text
    lines = "\n".join(bridge.log)
    assert "gz.msgs.Pose_V is connected to geometry_msgs/msg/PoseArray or tf2_msgs/msg/TFMessage" in lines


@pytest.mark.parametrize(
    ("word", "text"),
    [
        ("/scan", "expected TOPIC@ROS_TYPE[GZ_TYPE"),
        ("/scan@sensor_msgs/msg/LaserScan", "expected a ROS type and a type of Gazebo"),
        ("/scan@sensor_msgs/msg/LaserScn[gz.msgs.LaserScan", "LaserScn"),
    ],
)
def test_a_word_that_is_no_rule_ends_the_bridge(sim: Simulation, word: str, text: str) -> None:
    bridge = sim.add_node(BRIDGE, args=[word])
    sim.run(0.1)
    assert bridge.exit_code == 255 and text in bridge.log[-1]


def test_a_file_has_names_types_and_directions(sim: Simulation, tmp_path: Path) -> None:
    file = tmp_path / "bridge.yaml"
    file.write_text(
        """
- {ros_topic_name: odom, gz_topic_name: /model/cart/odometry, ros_type_name: nav_msgs/msg/Odometry,
   gz_type_name: gz.msgs.Odometry, direction: GZ_TO_ROS, lazy: true}
- {ros_topic_name: cmd_vel, ign_topic_name: /model/cart/cmd_vel, ros_type_name: geometry_msgs/Twist,
   ign_type_name: ignition.msgs.Twist, direction: ROS_TO_GZ}
- {topic_name: clock, ros_type_name: rosgraph_msgs/msg/Clock, gz_type_name: gz.msgs.Clock}
"""
    )
    spawn(sim)
    sim.add_node(BRIDGE, params={"config_file": str(file)}, namespace="/r1")
    sim.run(0.1)
    odometry = sim.subscribe("/r1/odom")
    sim.publish("/r1/cmd_vel", simkit.msgs.make("geometry_msgs/msg/Twist", linear={"x": 0.3}))
    sim.run(0.5)
    assert odometry.latest.twist.twist.linear.x == pytest.approx(0.3, abs=0.01)
    file.write_text("- {topic_name: clock, ros_type_name: rosgraph_msgs/msg/Clock, gz_type: gz.msgs.Clock}")
    wrong = sim.add_node(BRIDGE, params={"config_file": str(file)})
    sim.run(0.1)
    assert wrong.exit_code == 255 and "entry 1: unknown key 'gz_type'" in wrong.log[-1]


def test_names_of_gazebo_are_expanded_on_request(sim: Simulation) -> None:
    spawn(sim)
    rule = "odometry@nav_msgs/msg/Odometry[gz.msgs.Odometry"
    params = {"expand_gz_topic_names": True}
    sim.add_node(BRIDGE, args=[rule], params=params, namespace="/model/cart", remap={"odometry": "/odom"})
    sim.run(0.1)
    odometry = sim.subscribe("/odom")
    sim.run(0.1)
    assert odometry.messages


def test_a_service_gets_the_name_of_ros(sim: Simulation) -> None:
    sim.add_node(
        BRIDGE,
        args=["/world/field/control@ros_gz_interfaces/srv/ControlWorld"],
        remap={"/world/field/control": "/pause"},
    )
    sim.run(0.1)
    assert sim.call("/pause", {"world_control": {"pause": True}}).success
    assert sim.paused


def test_the_clock_has_one_publisher(sim: Simulation) -> None:
    sim.add_node(
        BRIDGE,
        args=["/world/field/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock"],
        remap={"/world/field/clock": "/clock"},
    )
    clock = sim.subscribe("/clock")
    sim.run(1.0)
    assert len(clock.messages) in (100, 101)


def test_a_camera_draws_for_the_image_bridge_only_while_somebody_subscribes(sim: Simulation) -> None:
    camera = '<sensor name="eye" type="camera"><topic>eye</topic><update_rate>10</update_rate></sensor>'
    sim.spawn(
        f'<sdf version="1.9"><model name="post"><static>true</static><link name="l">{camera}</link></model></sdf>'
    )
    sim.add_node("ros_gz_image/image_bridge", args=["/eye"], remap={"/eye": "/image"})
    sim.run(0.3)
    assert not sim.communication.bus.wanted("/eye")
    images = sim.subscribe("/image")
    sim.run(0.3)
    pictures = sim.subscribe("/image/compressed")
    sim.run(0.5)
    assert len(pictures.messages) >= 3 and pictures.latest.format.endswith("jpeg compressed bgr8")
    assert sim.communication.bus.wanted("/eye") and images.latest.header.frame_id == "post/l/eye"


def test_a_bundle_repeats_spawn_and_bridge_without_the_programs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("field.sdf").write_text(WORLD)
    Path("cart.urdf").write_text(ROBOT)
    Path("driver.py").write_text(DRIVER)
    nodes = [
        "ros_gz_sim/create -file cart.urdf",
        f"{BRIDGE} {COMMAND} --ros-args -r /model/cart/cmd_vel:=/cmd_vel",
        "driver.py",
    ]
    words = [word for node in nodes for word in ("--node", node)]
    done = CliRunner().invoke(app, ["bundle", "field.sdf", "-o", "b.zip", "--duration", "1", *words])
    assert done.exit_code == 0, done.output
    state = re.search(r"state \w+", done.output)
    Path("driver.py").unlink()
    again = CliRunner().invoke(app, ["replay", "b.zip"])
    assert again.exit_code == 0 and "identical" in again.output, again.output
    assert state is not None and state[0] in again.output
