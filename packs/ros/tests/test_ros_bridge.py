"""A run in ROS 2, seen by real nodes of rclpy with their default settings."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from simkit import msgs

pytestmark = pytest.mark.ros

SimkitRun = Callable[..., Any]
RosNode = Callable[[str], Any]


def test_a_node_receives_the_topics_of_a_robot_and_drives_it(simkit_run: SimkitRun, ros_node: RosNode) -> None:
    with simkit_run("turtlebot3_world", "--rtf", "1"):
        found = ros_node("""
            from geometry_msgs.msg import Twist
            from nav_msgs.msg import Odometry
            from rclpy.qos import qos_profile_sensor_data
            from sensor_msgs.msg import Imu, JointState, LaserScan

            client = Client()
            scans = client.hear("/scan", LaserScan, qos_profile_sensor_data)
            imus = client.hear("/imu", Imu, 10)
            joints, odometry = client.hear("/joint_states", JointState), client.hear("/odom", Odometry)
            publisher, command = client.node.create_publisher(Twist, "/cmd_vel", 10), Twist()
            command.linear.x = 0.2
            client.until(lambda: odometry)
            start = odometry[0].pose.pose.position.x
            distance = lambda: odometry[-1].pose.pose.position.x - start
            client.publish_until(publisher, command, lambda: distance() > 0.1 and len(imus) > 20 and len(scans) > 2)
            now, stamp = client.node.get_clock().now().nanoseconds, odometry[-1].header.stamp
            age_ns = now - stamp.sec * 10**9 - stamp.nanosec
            tell([len(scans[0].ranges), scans[0].header.frame_id, joints[0].name, age_ns])
        """)
    rays, frame, joints, age_ns = found
    assert (rays, frame, sorted(joints)) == (360, "base_scan", ["wheel_left_joint", "wheel_right_joint"])
    assert abs(age_ns) < 0.5e9  # the clock of a node with use_sim_time is the simulation's


def test_images_arrive_without_confirmation_too(simkit_run: SimkitRun, ros_node: RosNode) -> None:
    with simkit_run("turtlebot3_world", "--rtf", "0.3"):
        confirmed, unconfirmed = ros_node("""
            from rclpy.qos import qos_profile_sensor_data
            from sensor_msgs.msg import Image

            client = Client()
            found = client.hear("/camera/image_raw", Image)
            unconfirmed = []
            client.node.create_subscription(Image, "/camera/image_raw", unconfirmed.append, qos_profile_sensor_data)
            client.until(lambda: len(found) >= 20)
            tell([len(found), len(unconfirmed)])
        """)
    assert unconfirmed > confirmed / 2  # with a segment of 0.5 MB, one of ten


def test_a_late_node_receives_latched_messages_of_a_type_that_is_not_installed(
    simkit_run: SimkitRun, ros_node: RosNode
) -> None:
    with simkit_run("turtlebot3_world", "--rtf", "1"):
        names, data = ros_node("""
            from simkit_ros.opaque_types import message_class

            client = Client()
            found = client.hear("/tf_static", message_class("tf2_msgs/msg/TFMessage"), LATCHED, raw=True)
            names = lambda: [end.node_name for end in client.node.get_publishers_info_by_topic("/tf_static")]
            client.until(lambda: found and "simkit" in names())  # the name of a node arrives later than its topics
            tell([names(), list(found[0])])
        """)
    assert names == ["simkit"]
    transforms = msgs.deserialize(bytes(data), "tf2_msgs/msg/TFMessage").transforms
    assert "base_scan" in {t.child_frame_id for t in transforms}


def test_the_graph_has_the_published_type_hash_of_every_topic(simkit_run: SimkitRun, ros_node: RosNode) -> None:
    with simkit_run("turtlebot3_world", "--rtf", "1"):
        found = ros_node("""
            client = Client()
            info = client.node.get_publishers_info_by_topic
            is_there = lambda topic: "simkit" in [end.node_name for end in info(topic)]
            client.until(lambda: all(map(is_there, ("/scan", "/tf", "/clock"))))
            names = [name for name, _ in client.node.get_topic_names_and_types()]
            ours = [end for name in names for end in info(name) if end.node_name == "simkit"]
            tell({end.topic_type: "RIHS01_" + bytes(end.topic_type_hash.value).hex() for end in ours})
        """)
    found.pop("rcl_interfaces/msg/ParameterEvent", None)  # every node of rclpy publishes it
    assert {"tf2_msgs/msg/TFMessage", "sensor_msgs/msg/LaserScan", "rosgraph_msgs/msg/Clock"} <= set(found)
    assert found == {name: msgs.rihs(name) for name in found}


def test_a_robot_in_urdf_is_described(simkit_run: SimkitRun, ros_node: RosNode, tmp_path: Path) -> None:
    (tmp_path / "cart.urdf").write_text(CART)
    with simkit_run(str(tmp_path / "cart.urdf"), "--rtf", "1"):
        found = ros_node("""
            from std_msgs.msg import String

            client = Client()
            texts = client.hear("/robot_description", String, LATCHED)
            own = client.hear("/cart/robot_description", String, LATCHED)
            client.until(lambda: texts and own)
            tell([texts[0].data, own[0].data])
        """)
    assert found[0] == found[1]
    assert '<robot name="cart">' in found[0] and 'radius="0.25"' in found[0]


CART = """<robot name="cart"><link name="base"><inertial><mass value="1"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
<collision><geometry><sphere radius="0.25"/></geometry></collision></link></robot>"""


def test_services_answer_with_installed_and_with_missing_types(simkit_run: SimkitRun, ros_node: RosNode) -> None:
    with simkit_run("turtlebot3_world", "--rtf", "1") as run:
        found = ros_node("""
            from std_srvs.srv import Empty
            from simkit_ros.opaque_types import service_class

            client = Client()
            client.call(Empty, "/pause_physics")
            models = service_class("gazebo_msgs/srv/GetModelList")
            refused = client.call(models, "/get_model_list", models.Request())  # without its only byte
            answered = client.call(models, "/get_model_list", models.Request(bytes([0, 1, 0, 0, 0])))
            tell([list(refused.cdr), list(answered.cdr)])
        """)
        run.until("paused at")
        run.until("note SK-ROS-005: /get_model_list failed: SK-LIVE-008")
    refused = msgs.deserialize(bytes(found[0]), "gazebo_msgs/srv/GetModelList_Response")
    assert not refused.success and refused.model_names == []
    response = msgs.deserialize(bytes(found[1]), "gazebo_msgs/srv/GetModelList_Response")
    assert response.success and "turtlebot3" in response.model_names


def test_arms_move_by_an_action_client_and_controllers_have_parameters(
    simkit_run: SimkitRun, ros_node: RosNode
) -> None:
    with simkit_run("tiago_table", "--rtf", "1"):
        found = ros_node("""
            from rcl_interfaces.srv import GetParameters, ListParameters
            from rclpy.action import ActionClient
            from ros_actions import action_class
            from simkit import msgs
            from simkit_ros.opaque_types import service_class

            client, kind = Client(), "control_msgs/action/FollowJointTrajectory"
            actions = ActionClient(client.node, action_class(kind), "/head_controller/follow_joint_trajectory")
            client.until(actions.server_is_ready)
            feedback = []

            def send(joints, seconds):
                points = [{"positions": [0.3] * len(joints), "time_from_start": {"sec": seconds}}]
                goal = msgs.make(f"{kind}_Goal", trajectory={"joint_names": joints, "points": points})
                on_feedback = lambda f: feedback.append(f.feedback)
                return client.result(actions.send_goal_async(goal, feedback_callback=on_feedback))

            head = ["head_1_joint", "head_2_joint"]
            goal = send(head, 1)
            result = client.result(goal.get_result_async())
            reached = [float(p) for p in feedback[-1].actual.positions]
            long_goal = send(head, 60)
            answer = client.result(long_goal.cancel_goal_async())
            cancelled = client.result(long_goal.get_result_async())
            rejected = send(["no_joint"], 1)
            statuses = [goal.accepted, result.status, result.result.error_code, len(answer.goals_canceling),
                        cancelled.status, rejected.accepted]
            request = ListParameters.Request(prefixes=["constraints"], depth=0)
            names = client.call(ListParameters, "/head_controller/list_parameters", request).result.names
            request = GetParameters.Request(names=names)
            values = client.call(GetParameters, "/head_controller/get_parameters", request).values
            kind = service_class("controller_manager_msgs/srv/ListControllers")
            request = kind.Request(bytes([0, 1, 0, 0, 0]))
            controllers = client.call(kind, "/controller_manager/list_controllers", request).cdr
            nodes = [name for name, _ in client.node.get_node_names_and_namespaces()]
            tell([statuses, reached, dict(zip(names, [v.double_value for v in values])), nodes, list(controllers)])
        """)
    statuses, reached, parameters, nodes, controllers = found
    assert statuses == [True, 4, 0, 1, 5, False]
    assert reached == pytest.approx([0.3, 0.3], abs=0.05)
    assert parameters["constraints.goal_time"] > 0
    assert {"simkit", "head_controller", "arm_controller"} <= set(nodes)
    response = msgs.deserialize(bytes(controllers), "controller_manager_msgs/srv/ListControllers_Response")
    assert "head_controller" in {c.name for c in response.controller}


def test_a_navigator_in_a_plugin_is_an_action_of_nav2(simkit_run: SimkitRun, ros_node: RosNode, tmp_path: Path) -> None:
    (tmp_path / "navigator.py").write_text(NAVIGATOR)
    (tmp_path / "w.sdf").write_text(
        '<sdf version="1.9"><world name="w"><plugin filename="navigator.py:Navigator" name="n"/></world></sdf>'
    )
    with simkit_run(str(tmp_path / "w.sdf"), "--rtf", "1", "--plugin-path", str(tmp_path)):
        found = ros_node("""
            from rclpy.action import ActionClient
            from ros_actions import action_class
            from simkit import msgs

            client, kind = Client(), "nav2_msgs/action/NavigateToPose"
            actions = ActionClient(client.node, action_class(kind), "/navigate_to_pose")
            client.until(actions.server_is_ready)
            feedback = []
            goal = msgs.make(f"{kind}_Goal", pose={"pose": {"position": {"x": 2.5}}})
            on_feedback = lambda f: feedback.append(f.feedback)
            handle = client.result(actions.send_goal_async(goal, feedback_callback=on_feedback))
            result = client.result(handle.get_result_async())
            tell([result.status, float(feedback[-1].distance_remaining)])
        """)
    assert found == [4, 0.5]


NAVIGATOR = """
import simkit

class Navigator(simkit.WorldPlugin):
    def load(self, sim, params):
        self.goals = []
        self.act("/navigate_to_pose", "nav2_msgs/action/NavigateToPose", self.goals.append)

    def after_step(self):
        for goal in self.goals:
            goal.publish_feedback({"distance_remaining": goal.request.pose.pose.position.x - 2.0})
            goal.succeed({})
        self.goals.clear()
"""


def test_names_have_the_namespace_and_the_remappings(simkit_run: SimkitRun, ros_node: RosNode) -> None:
    with simkit_run(
        "turtlebot3_world", "--rtf", "1", "--ros-namespace", "lab", "--ros-args", "-r", "scan:=lidar", "--"
    ):
        found = ros_node("""
            client = Client()
            topics = lambda: {name for name, _ in client.node.get_topic_names_and_types()}
            client.until(lambda: {"/lab/lidar", "/lab/odom", "/clock"} <= topics())
            tell(sorted(topics()))
        """)
    assert "/scan" not in found and "/lab/scan" not in found


def test_unknown_arguments_of_ros_are_named(bridge_options: list[str], simkit_command: SimkitRun) -> None:
    with simkit_command("run", "turtlebot3_empty", "--ros", *bridge_options, "--ros-args", "--wrong") as run:
        assert run.end() == 2
        run.until(r"error: SK-ROS-002 .*: unknown arguments after --ros-args: \['--wrong'\]")


def test_messages_that_are_no_messages_are_dropped_with_a_note(simkit_run: SimkitRun, ros_node: RosNode) -> None:
    with simkit_run("turtlebot3_world", "--rtf", "1") as run:
        ros_node("""
            from geometry_msgs.msg import Twist
            from nav_msgs.msg import Odometry

            client = Client()
            odometry = client.hear("/odom", Odometry)
            publisher = client.node.create_publisher(Twist, "/cmd_vel", 10)
            client.until(lambda: publisher.get_subscription_count() and odometry)
            publisher.publish(bytes([0, 1, 0, 0, 255]))
            command = Twist()
            command.linear.x = 0.2
            client.publish_until(publisher, command, lambda: odometry[-1].twist.twist.linear.x > 0.1)
            tell(True)
        """)
        run.until(r"note SK-ROS-005: messages on /cmd_vel are dropped")


def test_a_message_from_ros_does_not_return_to_ros(simkit_run: SimkitRun, ros_node: RosNode) -> None:
    with simkit_run("turtlebot3_world", "--rtf", "1"):
        count = ros_node("""
            from geometry_msgs.msg import Twist
            from nav_msgs.msg import Odometry

            client = Client()
            commands, odometry = client.hear("/cmd_vel", Twist, 100), client.hear("/odom", Odometry)
            publisher = client.node.create_publisher(Twist, "/cmd_vel", 100)
            client.until(lambda: publisher.get_subscription_count() == 2 and odometry)
            for _ in range(20):
                publisher.publish(Twist())
            client.until(lambda: len(commands) >= 20)
            count = len(odometry)
            client.until(lambda: len(odometry) > count + 10)
            tell(len(commands))
        """)
    assert count == 20


def _state(run: Any) -> str:
    assert run.end() == 0, run.text
    return run.until(r"state (\w{64})")[1]


def test_the_state_is_the_same_with_and_without_a_node_that_reads(simkit_run: SimkitRun, ros_node: RosNode) -> None:
    arguments = "turtlebot3_world", "--duration", "4", "--rtf", "1", "--cmd-vel", "0.2,0.3"
    with simkit_run(*arguments, with_ros=False) as run:
        expected = _state(run)
    with simkit_run(*arguments) as run:
        received = ros_node("""
            from nav_msgs.msg import Odometry

            client = Client()
            found = client.hear("/odom", Odometry)
            client.until(lambda: len(found) > 10)
            tell(len(found))
        """)
        assert received > 10
        assert _state(run) == expected


def test_a_run_goes_on_bit_for_bit_when_its_bridge_is_killed(simkit_run: SimkitRun) -> None:
    arguments = "turtlebot3_world", "--duration", "2", "--rtf", "1"
    with simkit_run(*arguments, with_ros=False) as run:
        expected = _state(run)
    with simkit_run(*arguments) as run:
        os.kill(run.bridge(), signal.SIGKILL)
        run.until(r"warning SK-ROS-004: .*SIGKILL")
        assert _state(run) == expected


def test_a_node_that_floods_a_topic_changes_nothing_but_the_commands(simkit_run: SimkitRun, ros_node: RosNode) -> None:
    with simkit_run("turtlebot3_world", "--rtf", "1", "--duration", "8") as run:
        ros_node("""
            from contextlib import suppress
            from geometry_msgs.msg import Twist
            from rclpy._rclpy_pybind11 import RCLError

            client = Client()
            publisher = client.node.create_publisher(Twist, "/cmd_vel", 1000)
            client.until(publisher.get_subscription_count)
            for _ in range(30000):
                with suppress(RCLError):  # a reliable publisher refuses a message if the reader is behind for 100 ms
                    publisher.publish(Twist())
            tell(True)
        """)
        assert run.end() == 0
        assert float(run.until(r"simulated 8.000 s in ([\d.]+) s")[1]) < 30.0
        assert "SK-ROS-004" not in run.text


def test_a_bridge_ends_when_its_run_is_killed(simkit_run: SimkitRun) -> None:
    with simkit_run("turtlebot3_world", "--rtf", "1") as run:
        bridge = os.pidfd_open(run.bridge())
        run.process.kill()
        assert _is_ended(bridge)


def _is_ended(process: int) -> bool:
    import select

    try:
        return bool(select.select([process], [], [], 10.0)[0])
    finally:
        os.close(process)


def test_a_bridge_has_no_socket_outside_of_this_machine(simkit_run: SimkitRun, ros_node: RosNode) -> None:
    with simkit_run("turtlebot3_world", "--rtf", "1") as run:
        ros_node("""
            from nav_msgs.msg import Odometry

            client = Client()
            found = client.hear("/odom", Odometry)
            client.until(lambda: found)
            tell(True)
        """)
        addresses = _socket_addresses(run.bridge())
    assert addresses and all(address.startswith("127.") for address in addresses), addresses


def _socket_addresses(pid: int) -> list[str]:
    inodes = set()
    for link in Path(f"/proc/{pid}/fd").iterdir():
        target = str(link.readlink())
        if target.startswith("socket:["):
            inodes.add(target[8:-1])
    found = []
    for kind in ("udp", "udp6", "tcp", "tcp6", "raw", "raw6"):
        for line in Path(f"/proc/{pid}/net/{kind}").read_text().splitlines()[1:]:
            words = line.split()
            if words[9] in inodes:
                address = words[1].split(":")[0]
                is_v4 = len(address) == 8
                found.append(".".join(str(int(address[i : i + 2], 16)) for i in (6, 4, 2, 0)) if is_v4 else address)
    return found


def test_a_running_simulation_is_connected_and_disconnected_later(
    simkit_run: SimkitRun, simkit_command: SimkitRun, ros_node: RosNode, bridge_options: list[str]
) -> None:
    with simkit_run("turtlebot3_world", "--rtf", "1", "--name", "lab", "--duration", "60", with_ros=False) as run:
        while not (Path(os.environ["XDG_RUNTIME_DIR"]) / "simkit" / "lab.sock").exists():
            assert run.process.poll() is None
        for _ in range(2):
            with simkit_command("ros", "lab", *bridge_options) as attached:
                attached.until(r"ROS 2: .* in domain")
                ros_node("""
                    from nav_msgs.msg import Odometry

                    client = Client()
                    found = client.hear("/odom", Odometry)
                    client.until(lambda: found)
                    tell(True)
                """)
                attached.process.send_signal(signal.SIGINT)
                assert attached.end() == 130
        with simkit_command("ros", "lab", *bridge_options) as attached:
            attached.until(r"ROS 2: .* in domain")
            run.process.kill()
            assert attached.end() == 0
            attached.until("simulation 'lab' has ended")
