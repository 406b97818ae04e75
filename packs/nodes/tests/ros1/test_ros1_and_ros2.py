"""Tests: programs of ROS 1 and ROS 2 in one run talk to each other."""

from __future__ import annotations

from typing import Any


def test_a_listener_of_ros_2_hears_a_talker_of_ros_1_and_the_other_way_round(sim: Any, add: Any, texts: Any) -> None:
    old = add(
        """
        import rospy
        from geometry_msgs.msg import PointStamped
        from std_msgs.msg import String
        rospy.init_node("old")
        rospy.Subscriber("news", PointStamped, lambda m: rospy.loginfo("%s %s", m.header.stamp.to_sec(), m.point.x))
        publisher = rospy.Publisher("chatter", String, queue_size=1)
        rate = rospy.Rate(10)
        while not rospy.is_shutdown():
            publisher.publish("hello")
            rate.sleep()
        """,
        "old",
    )
    new = add(
        """
        import rclpy
        from geometry_msgs.msg import PointStamped
        from std_msgs.msg import String
        rclpy.init()
        node = rclpy.create_node("new")
        publisher = node.create_publisher(PointStamped, "news", 10)
        def heard(message):
            node.get_logger().info(message.data)
            point = PointStamped()
            point.header.stamp.sec = 5
            point.point.x = 2.0
            publisher.publish(point)
        node.create_subscription(String, "chatter", heard, 10)
        rclpy.spin(node)
        """,
        "new",
    )
    sim.run(0.25)
    assert (old.error, new.error) == (None, None)
    assert texts(new) == ["hello", "hello"]
    assert texts(old) == ["5.0 2.0", "5.0 2.0"]


def test_a_client_of_ros_1_calls_a_service_of_ros_2(sim: Any, add: Any, texts: Any) -> None:
    add(
        """
        import rclpy
        from example_interfaces.srv import AddTwoInts
        rclpy.init()
        node = rclpy.create_node("server")
        def add(request, response):
            response.sum = request.a + request.b
            return response
        node.create_service(AddTwoInts, "add", add)
        rclpy.spin(node)
        """,
        "server",
    )
    client = add(
        """
        import rospy
        from example_interfaces.srv import AddTwoInts
        rospy.init_node("client")
        rospy.wait_for_service("add", 1)
        rospy.loginfo("%d", rospy.ServiceProxy("add", AddTwoInts)(2, 3).sum)
        """,
        "client",
    )
    sim.run(0.2)
    assert texts(client) == ["5"]


def test_a_client_of_ros_1_sends_a_goal_to_an_action_of_ros_2(sim: Any, add: Any, texts: Any) -> None:
    add(
        """
        import rclpy
        from rclpy.action import ActionServer
        from actionlib_tutorials.action import Fibonacci
        rclpy.init()
        node = rclpy.create_node("server")
        def execute(goal):
            goal.publish_feedback(Fibonacci.Feedback(sequence=[1]))
            goal.succeed()
            return Fibonacci.Result(sequence=[1, 2])
        ActionServer(node, Fibonacci, "fibonacci", execute)
        rclpy.spin(node)
        """,
        "server",
    )
    client = add(
        """
        import actionlib, rospy
        from actionlib_tutorials.msg import FibonacciAction, FibonacciGoal
        rospy.init_node("client")
        client = actionlib.SimpleActionClient("fibonacci", FibonacciAction)
        client.wait_for_server()
        client.send_goal(FibonacciGoal(2), feedback_cb=lambda f: rospy.loginfo("%s", list(f.sequence)))
        client.wait_for_result()
        rospy.loginfo("%d %s", client.get_state(), list(client.get_result().sequence))
        """,
        "client",
    )
    sim.run(0.5)
    assert client.error is None
    assert texts(client) == ["[1]", "3 [1, 2]"]


def test_the_same_run_twice_has_the_same_log(sim: Any, add: Any) -> None:
    text = """
        import random, rospy, tf
        from geometry_msgs.msg import Twist
        rospy.init_node("random_walk", anonymous=True)
        publisher = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        rospy.Subscriber("cmd_vel", Twist, lambda m: rospy.loginfo("%s %r", rospy.get_name(), m.linear.x))
        rospy.Timer(rospy.Duration(0.1), lambda event: publisher.publish(Twist(angular=None)))
        rate = rospy.Rate(20)
        while not rospy.is_shutdown():
            twist = Twist()
            twist.linear.x = random.random()
            publisher.publish(twist)
            rate.sleep()
    """
    nodes = [add(text, "first"), add(text, "second")]
    sim.run(0.5)
    before = [list(node.log) for node in nodes]
    sim.reset()
    sim.run(0.5)
    assert [list(node.log) for node in nodes] == before
    assert len(before[0]) > 10
