"""Transforms in programs: buffer, listener and broadcasters of `tf2_ros`, and messages in other frames."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from simkit_nodes.interfaces import ROS2
from simkit_nodes.message_transforms import transformed_covariance
from simkit_nodes.ros_modules.rclpy.duration import Duration
from simkit_nodes.ros_modules.rclpy.time import Time
from simkit_nodes.ros_modules.tf2_py import BufferCore, ExtrapolationException, LookupException

Run = Callable[..., list[str]]
Stamped = ROS2.message_class("geometry_msgs/msg/TransformStamped")


def transform(parent: str, child: str, seconds: float, x: float) -> object:
    message = Stamped()
    message.header.frame_id, message.child_frame_id = parent, child
    message.header.stamp = Time(seconds=seconds).to_msg()
    message.transform.translation.x = x
    return message


def test_a_core_returns_what_it_has_received() -> None:
    core = BufferCore()
    sent = transform("odom", "base", 1.0, 2.0)
    core.set_transform(sent, "test")
    assert core.lookup_transform_core("odom", "base", Time()) == sent
    assert core.get_latest_common_time("odom", "base") == Time(seconds=1)
    assert core.can_transform_core("odom", "base", Time(seconds=2))[0] is False


def test_times_are_those_of_rclpy_or_stamps_of_messages() -> None:
    core = BufferCore(Duration(seconds=5))
    for second in (1, 2):
        core.set_transform(transform("odom", "base", second, float(second)), "test")
    for time in (Time(seconds=1.5), Time(seconds=1.5).to_msg()):
        assert core.lookup_transform_core("odom", "base", time).transform.translation.x == pytest.approx(1.5)
    with pytest.raises(TypeError, match="time must have sec and nanosec, or nanoseconds"):
        core.lookup_transform_core("odom", "base", 1.5)
    with pytest.raises(TypeError, match="argument 1 must be str, not NoneType"):
        core.lookup_transform_core(None, "base", Time())  # type: ignore[arg-type]


def test_exceptions_have_the_names_of_tf2() -> None:
    core = BufferCore()
    with pytest.raises(LookupException) as caught:
        core.lookup_transform_core("a", "b", Time())
    assert f"{type(caught.value).__module__}.{type(caught.value).__name__}" == "tf2.LookupException"
    core.set_transform(transform("a", "b", 1.0, 0.0), "test")
    with pytest.raises(ExtrapolationException):
        core.lookup_transform_core("a", "b", Time(seconds=3))


def test_covariances_turn_with_the_pose() -> None:
    message = Stamped()
    message.transform.rotation.z = message.transform.rotation.w = 0.5**0.5
    covariance = [0.0] * 36
    covariance[0], covariance[35] = 4.0, 1.0
    turned = transformed_covariance(covariance, message)
    assert turned[7] == pytest.approx(4.0)
    assert turned[0] == pytest.approx(0.0, abs=1e-12)
    assert turned[35] == pytest.approx(1.0)


PAIR = """
    import rclpy
    from rclpy.node import Node
    from rclpy.duration import Duration
    from rclpy.executors import ExternalShutdownException
    from geometry_msgs.msg import PointStamped, PoseStamped, TransformStamped, Vector3Stamped
    from tf2_ros import Buffer, StaticTransformBroadcaster, TransformBroadcaster, TransformException, TransformListener

    class Sender(Node):
        def __init__(self):
            super().__init__("sender")
            self.moving, self.fixed = TransformBroadcaster(self), StaticTransformBroadcaster(self)
            self.fixed.sendTransform(self.transform("base", "laser", 0.5))
            self.create_timer(0.1, self.send)

        def transform(self, parent, child, x):
            message = TransformStamped()
            message.header.stamp = self.get_clock().now().to_msg()
            message.header.frame_id, message.child_frame_id = parent, child
            message.transform.translation.x = x
            message.transform.rotation.z = message.transform.rotation.w = 0.5 ** 0.5
            return message

        def send(self):
            now = self.get_clock().now().nanoseconds * 1e-9
            self.moving.sendTransform([self.transform("odom", "base", now)])
"""

MAIN = """
    rclpy.init()
    sender, reader = Sender(), Reader()
    executor = rclpy.executors.MultiThreadedExecutor(num_threads=3)
    executor.add_node(sender)
    executor.add_node(reader)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
"""


def test_a_listener_knows_moving_and_fixed_transforms(run_program: Run) -> None:
    lines = run_program(
        PAIR
        + """
    import tf2_geometry_msgs

    class Reader(Node):
        def __init__(self):
            super().__init__("reader")
            self.buffer = Buffer()
            self.listener = TransformListener(self.buffer, self)
            self.create_timer(0.25, self.read)

        def read(self):
            pose = self.buffer.lookup_transform("odom", "laser", rclpy.time.Time())
            position = pose.transform.translation
            self.get_logger().info(f"{position.x:.2f} {position.y:.2f} {pose.header.frame_id} {pose.child_frame_id}")
            for kind, field in ((PointStamped, "point"), (Vector3Stamped, "vector")):
                message = kind()
                message.header.frame_id = "base"
                getattr(message, field).x = 1.0
                moved = self.buffer.transform(message, "odom")
                value = getattr(moved, field)
                self.get_logger().info(f"{moved.header.frame_id} {value.x + 1e-9:.2f} {value.y:.2f}")
            pose = PoseStamped()
            pose.header.frame_id = "laser"
            pose.pose.orientation.w = 1.0
            self.get_logger().info(f"{self.buffer.transform(pose, 'base').pose.orientation.z:.3f}")
    """
        + MAIN,
        0.3,
    )
    assert lines == ["0.20 0.50 odom laser", "odom 0.20 1.00", "odom 0.00 1.00", "0.707"]


def test_a_type_is_transformable_after_the_import_of_its_package(run_program: Run) -> None:
    lines = run_program(
        """
        import rclpy, tf2_ros
        from geometry_msgs.msg import PointStamped
        rclpy.init()
        node = rclpy.create_node("n")
        buffer = tf2_ros.Buffer()
        try:
            buffer.transform(PointStamped(), "odom")
        except tf2_ros.TypeException as error:
            node.get_logger().info(str(error))
        import tf2_geometry_msgs
        try:
            buffer.transform(PointStamped(), "odom")
        except tf2_ros.TransformException as error:
            node.get_logger().info(str(error))
        """
    )
    assert lines == [
        "Type <class 'geometry_msgs.msg._point_stamped.PointStamped'> is not loaded or supported",
        '"odom" passed to lookupTransform argument target_frame does not exist. ',
    ]


def test_a_timeout_waits_in_simulated_time_while_another_thread_receives(run_program: Run) -> None:
    lines = run_program(
        PAIR
        + """
    class Reader(Node):
        def __init__(self):
            super().__init__("reader")
            self.buffer = Buffer()
            self.listener = TransformListener(self.buffer, self)
            self.timer = self.create_timer(0.05, self.read)

        def read(self):
            self.timer.cancel()
            log, clock = self.get_logger(), self.get_clock()
            self.buffer.lookup_transform("odom", "base", rclpy.time.Time(seconds=0.5), Duration(seconds=2))
            log.info(f"{clock.now().nanoseconds / 1e9:.2f}")
            known = self.buffer.can_transform("odom", "nowhere", rclpy.time.Time(), Duration(seconds=0.2))
            log.info(f"{known} {clock.now().nanoseconds / 1e9:.2f}")
    """
        + MAIN,
    )
    assert lines == ["0.51", "False 0.71"]


def test_a_listener_with_its_own_thread_receives_while_the_main_thread_waits(run_program: Run) -> None:
    lines = run_program(
        PAIR
        + """
    import threading
    rclpy.init()
    sender = Sender()
    threading.Thread(target=rclpy.spin, args=(sender,), daemon=True).start()
    reader = rclpy.create_node("reader")
    buffer = Buffer()
    listener = TransformListener(buffer, reader, spin_thread=True)
    buffer.lookup_transform("odom", "laser", rclpy.time.Time(), Duration(seconds=1))
    reader.get_logger().info(f"{reader.get_clock().now().nanoseconds / 1e9:.2f}")
    """,
    )
    assert lines == ["0.12"]


def test_a_coroutine_waits_for_a_transform(run_program: Run) -> None:
    lines = run_program(
        PAIR
        + """
    class Reader(Node):
        def __init__(self):
            super().__init__("reader")
            self.buffer = Buffer()
            self.listener = TransformListener(self.buffer, self)
            self.timer = self.create_timer(0.05, self.read)

        async def read(self):
            self.timer.cancel()
            pose = await self.buffer.lookup_transform_async("odom", "laser", rclpy.time.Time())
            self.get_logger().info(f"{pose.transform.translation.x:.1f}")
    """
        + MAIN,
    )
    assert lines == ["0.1"]


def test_the_service_tf2_frames_lists_the_frames(run_program: Run) -> None:
    lines = run_program(
        """
        import rclpy
        from tf2_msgs.srv import FrameGraph
        from tf2_ros import Buffer
        from geometry_msgs.msg import TransformStamped
        rclpy.init()
        node = rclpy.create_node("n")
        buffer = Buffer(node=node)
        message = TransformStamped(child_frame_id="base")
        message.header.frame_id = "odom"
        buffer.set_transform_static(message, "test")
        client = node.create_client(FrameGraph, "tf2_frames")
        client.wait_for_service()
        future = client.call_async(FrameGraph.Request())
        rclpy.spin_until_future_complete(node, future)
        node.get_logger().info(future.result().frame_yaml.splitlines()[1].strip())
        """
    )
    assert lines == ["parent: 'odom'"]
