"""Tests: `tf` and `tf2_ros` of programs of ROS 1."""

from __future__ import annotations

from typing import Any

SEND = """
    import rospy, tf, math
    rospy.init_node("sender")
    sender = tf.TransformBroadcaster()
    rate = rospy.Rate(10)
    while not rospy.is_shutdown():
        now = rospy.Time.now()
        turn = tf.transformations.quaternion_from_euler(0, 0, math.pi / 2)
        sender.sendTransform((now.to_sec(), 2, 0), turn, now, "robot", "world")
        rate.sleep()
"""


def test_a_listener_looks_up_the_pose_of_a_frame(sim: Any, add: Any, texts: Any) -> None:
    add(SEND, "sender")
    node = add(
        """
        import rospy, tf
        rospy.init_node("listener")
        listener = tf.TransformListener()
        try:
            listener.lookupTransform("world", "robot", rospy.Time(0))
        except (tf.LookupException, tf.ConnectivityException, tf.ExtrapolationException) as error:
            rospy.loginfo("%s", error)
        listener.waitForTransform("/world", "/robot", rospy.Time(), rospy.Duration(1))
        position, turn = listener.lookupTransform("/world", "/robot", rospy.Time(0))
        rospy.loginfo("%.1f %.1f %.1f", *position)
        rospy.loginfo("%.3f", tf.transformations.euler_from_quaternion(turn)[2])
        rospy.loginfo("%s", listener.frameExists("robot"))
        """,
        "listener",
    )
    sim.run(0.5)
    assert node.error is None
    assert texts(node) == [
        '"world" passed to lookupTransform argument target_frame does not exist. ',
        "0.1 2.0 0.0",
        "1.571",
        "True",
    ]


def test_a_wait_for_a_transform_in_the_future_ends_when_it_arrives(sim: Any, add: Any, texts: Any) -> None:
    add(SEND, "sender")
    node = add(
        """
        import rospy, tf
        rospy.init_node("listener")
        listener = tf.TransformListener()
        listener.waitForTransform("world", "robot", rospy.Time(0.25), rospy.Duration(1))
        rospy.loginfo("%.2f", listener.lookupTransform("world", "robot", rospy.Time(0.25))[0][0])
        try:
            listener.waitForTransform("world", "nowhere", rospy.Time(0), rospy.Duration(0.2))
        except tf.Exception as error:
            rospy.loginfo("%s", error)
        """,
        "listener",
    )
    sim.run(1.0)
    assert [line[7:20] for line in node.log] == ["[0.300000000]", "[0.500000000]"]
    assert texts(node)[0] == "0.25"
    assert "nowhere" in texts(node)[1]


def test_messages_are_transformed_into_other_frames(sim: Any, add: Any, texts: Any) -> None:
    add(SEND.replace("now.to_sec()", "1"), "sender")
    node = add(
        """
        import rospy, tf
        from geometry_msgs.msg import PointStamped, PoseStamped, QuaternionStamped, Vector3Stamped
        rospy.init_node("listener")
        listener = tf.TransformListener()
        listener.waitForTransform("world", "robot", rospy.Time(), rospy.Duration(1))
        point = PointStamped()
        point.header.frame_id, point.point.x = "robot", 3
        moved = listener.transformPoint("world", point)
        rospy.loginfo("%s %.1f %.1f", moved.header.frame_id, moved.point.x, moved.point.y)
        vector = Vector3Stamped()
        vector.header.frame_id, vector.vector.x = "robot", 3
        moved = listener.transformVector3("world", vector)
        rospy.loginfo("%.1f %.1f", moved.vector.x, moved.vector.y)
        pose = PoseStamped()
        pose.header.frame_id, pose.pose.position.x, pose.pose.orientation.w = "robot", 3, 1
        moved = listener.transformPose("world", pose)
        rospy.loginfo("%.1f %.1f %.3f", moved.pose.position.x, moved.pose.position.y, moved.pose.orientation.z)
        """,
        "listener",
    )
    sim.run(0.5)
    assert node.error is None
    assert texts(node) == ["world 1.0 5.0", "0.0 3.0", "1.0 5.0 0.707"]


def test_tf2_looks_up_static_and_moving_frames(sim: Any, add: Any, texts: Any) -> None:
    add(SEND.replace("now.to_sec()", "1"), "sender")
    node = add(
        """
        import rospy, tf2_ros, tf2_geometry_msgs
        from geometry_msgs.msg import PoseStamped, TransformStamped
        rospy.init_node("listener")
        static = TransformStamped()
        static.header.frame_id, static.child_frame_id = "robot", "camera"
        static.transform.translation.z, static.transform.rotation.w = 0.5, 1
        tf2_ros.StaticTransformBroadcaster().sendTransform(static)
        rospy.sleep(0.1)
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        pose = buffer.lookup_transform("world", "camera", rospy.Time(), rospy.Duration(1.0))
        place = pose.transform.translation
        rospy.loginfo("%s %s %.1f %.1f %.1f", pose.header.frame_id, pose.child_frame_id, place.x, place.y, place.z)
        pose = PoseStamped()
        pose.header.frame_id, pose.pose.orientation.w = "camera", 1
        rospy.loginfo("%.1f", buffer.transform(pose, "world", rospy.Duration(1)).pose.position.y)
        try:
            buffer.lookup_transform("world", "nowhere", rospy.Time(0))
        except tf2_ros.LookupException as error:
            rospy.loginfo("LookupException")
        """,
        "listener",
    )
    sim.run(0.5)
    assert node.error is None
    assert texts(node) == ["world camera 1.0 2.0 0.5", "2.0", "LookupException"]


def test_the_twist_of_a_frame_is_its_mean_velocity(sim: Any, add: Any, texts: Any) -> None:
    add(SEND, "sender")
    node = add(
        """
        import rospy, tf
        rospy.init_node("listener")
        listener = tf.TransformListener()
        rospy.sleep(1)
        linear, angular = listener.lookupTwist("robot", "world", rospy.Time(), rospy.Duration(0.4))
        rospy.loginfo("%.3f %.3f", linear[0], angular[2])
        """,
        "listener",
    )
    sim.run(1.5)
    assert texts(node) == ["1.000 0.000"]
