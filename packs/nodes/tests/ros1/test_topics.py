"""Tests: publishers and subscribers of programs of ROS 1."""

from __future__ import annotations

from typing import Any

import simkit

TALK = """
    import rospy
    from std_msgs.msg import String
    rospy.init_node("talker")
    publisher = rospy.Publisher("chatter", String, queue_size=10)
    rate = rospy.Rate(10)
    count = 0
    while not rospy.is_shutdown():
        publisher.publish(f"hello {count}")
        count += 1
        rate.sleep()
"""
LISTEN = """
    import rospy
    from std_msgs.msg import String
    def heard(message, prefix=None):
        rospy.loginfo("%s %s", prefix, message.data)
    rospy.Subscriber("chatter", String, heard, "I heard", queue_size=1)
    rospy.init_node("listener")
    rospy.spin()
"""


def test_a_listener_hears_a_talker_after_the_discovery(sim: Any, add: Any, texts: Any) -> None:
    add(TALK, "talker")
    listener = add(LISTEN, "listener")
    sim.run(0.45)
    assert texts(listener) == ["I heard hello 1", "I heard hello 2", "I heard hello 3", "I heard hello 4"]
    assert listener.log[0] == "[INFO] [0.100000000] [listener]: I heard hello 1"


def test_the_simulation_sees_what_a_program_publishes(sim: Any, add: Any) -> None:
    add(TALK)
    messages: list[Any] = []
    sim.subscribe("/chatter", messages.append)
    sim.run(0.35)
    assert [message.data for message in messages] == ["hello 1", "hello 2", "hello 3"]


def test_a_program_hears_what_a_script_publishes(sim: Any, add: Any, texts: Any) -> None:
    node = add(LISTEN)
    publisher = sim.advertise("/chatter", "std_msgs/msg/String")
    sim.run(0.01)
    publisher.publish(simkit.msgs.make("std_msgs/msg/String", data="script"))
    sim.run(0.01)
    assert texts(node) == ["I heard script"]


def test_a_remapped_talker_talks_to_the_same_listener(sim: Any, add: Any, texts: Any) -> None:
    add(TALK, "talker", remap={"chatter": "/news"})
    listener = add(LISTEN, "listener", args=("chatter:=news",))
    sim.run(0.15)
    assert texts(listener) == ["I heard hello 1"]


def test_a_latched_message_reaches_a_subscriber_that_comes_later(sim: Any, add: Any, texts: Any) -> None:
    add(
        """
        import rospy
        from std_msgs.msg import Int32
        rospy.init_node("a")
        publisher = rospy.Publisher("map", Int32, latch=True, queue_size=1)
        publisher.publish(1)
        publisher.publish(2)
        rospy.spin()
        """,
        "latched",
    )
    node = add(
        """
        import rospy
        from std_msgs.msg import Int32
        rospy.init_node("b")
        rospy.sleep(0.5)
        rospy.Subscriber("map", Int32, lambda m: rospy.loginfo("%d %s", m.data, m._connection_header["latching"]))
        rospy.spin()
        """
    )
    sim.run(0.6)
    assert texts(node) == ["2 1"]


def test_a_message_is_made_of_the_arguments_of_publish(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rospy
        from geometry_msgs.msg import Twist, Vector3, Vector3Stamped
        rospy.init_node("a")
        rospy.Subscriber("cmd_vel", Twist, lambda m: rospy.loginfo("%s %s", m.linear.x, m.angular.z))
        rospy.Subscriber("stamped", Vector3Stamped, lambda m: rospy.loginfo("seq %s", m.header.seq))
        publisher = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        stamped = rospy.Publisher("stamped", Vector3Stamped, queue_size=1)
        while not publisher.get_num_connections():
            rospy.sleep(0.1)
        publisher.publish(Vector3(1, 0, 0), Vector3())
        publisher.publish(angular=Vector3(z=2))
        message = Twist()
        message.linear.x = 3  # an int in a float field is right in ROS 1
        publisher.publish(message)
        stamped.publish(Vector3Stamped())
        stamped.publish(Vector3Stamped())
        try:
            publisher.publish(Vector3(), Vector3(), angular=Vector3())
        except TypeError as error:
            rospy.loginfo("%s", error)
        message.linear.x = "fast"
        try:
            publisher.publish(message)
        except rospy.ROSSerializationException as error:
            rospy.loginfo("%s", error)
        rospy.spin()
        """
    )
    sim.run(0.2)
    assert texts(node) == [
        "publish() can be called with arguments or keywords, but not both.",
        "field linear.x must be float type",
        "1.0 0.0",
        "0.0 2.0",
        "3.0 0.0",
        "seq 1",
        "seq 2",
    ]


def test_publish_before_init_node_is_an_error(sim: Any, add: Any) -> None:
    node = add(
        """
        import rospy
        from std_msgs.msg import String
        rospy.Publisher("a", String, queue_size=1).publish("x")
        """
    )
    sim.run(0.01)
    assert str(node.error) == "ROS node has not been initialized yet. Please call init_node() first"


def test_an_exception_in_a_callback_is_logged_and_the_subscriber_goes_on(sim: Any, add: Any) -> None:
    add(TALK, "talker")
    node = add(
        """
        import rospy
        from std_msgs.msg import String
        def heard(message):
            rospy.loginfo(message.data)
            if message.data.endswith("1"):
                raise ValueError("not one")
        rospy.init_node("listener")
        rospy.Subscriber("chatter", String, heard)
        rospy.spin()
        """
    )
    sim.run(0.25)
    assert node.error is None
    assert node.log[0].endswith("hello 1")
    assert node.log[1] == "[ERROR] [0.100000000] [listener]: bad callback: <function heard>"
    assert "ValueError: not one" in node.log
    assert node.log[-1].endswith("hello 2")


def test_a_subscriber_with_a_queue_of_one_drops_the_oldest_messages_while_its_callback_sleeps(
    sim: Any, add: Any, texts: Any
) -> None:
    add(TALK, "talker")
    node = add(
        """
        import rospy
        from std_msgs.msg import String
        def heard(message):
            rospy.loginfo(message.data)
            rospy.sleep(0.35)
        rospy.init_node("listener")
        rospy.Subscriber("chatter", String, heard, queue_size=1)
        rospy.spin()
        """
    )
    sim.run(0.85)
    assert texts(node) == ["hello 1", "hello 4", "hello 8"]


def test_a_callback_that_sleeps_does_not_stop_another_subscriber(sim: Any, add: Any, texts: Any) -> None:
    add(TALK, "talker")
    node = add(
        """
        import rospy
        from std_msgs.msg import String
        def sleeps(message):
            rospy.sleep(10)
        rospy.init_node("listener")
        rospy.Subscriber("chatter", String, sleeps)
        rospy.Subscriber("chatter", String, lambda message: rospy.loginfo(message.data))
        rospy.spin()
        """
    )
    sim.run(0.25)
    assert texts(node) == ["hello 1", "hello 2"]


def test_an_unregistered_subscriber_hears_nothing_more(sim: Any, add: Any, texts: Any) -> None:
    add(TALK, "talker")
    node = add(
        """
        import rospy
        from std_msgs.msg import String
        def heard(message):
            rospy.loginfo(message.data)
            subscriber.unregister()
        rospy.init_node("listener")
        subscriber = rospy.Subscriber("chatter", String, heard)
        rospy.spin()
        """
    )
    sim.run(0.35)
    assert texts(node) == ["hello 1"]


def test_wait_for_message_returns_one_message_or_raises_after_its_timeout(sim: Any, add: Any, texts: Any) -> None:
    add(TALK, "talker")
    node = add(
        """
        import rospy
        from std_msgs.msg import String
        rospy.init_node("listener")
        rospy.loginfo(rospy.wait_for_message("chatter", String).data)
        try:
            rospy.wait_for_message("silence", String, timeout=0.25)
        except rospy.ROSException as error:
            rospy.loginfo("%s", error)
        """
    )
    sim.run(0.5)
    assert node.log == [
        "[INFO] [0.100000000] [listener]: hello 1",
        "[INFO] [0.350000000] [listener]: timeout exceeded while waiting for message on topic silence",
    ]


def test_a_message_of_any_type_arrives_as_bytes_of_ros_1(sim: Any, add: Any, texts: Any) -> None:
    add(TALK, "talker")
    node = add(
        """
        import rospy
        def heard(message):
            rospy.loginfo("%s %r", message._connection_header["type"], message._buff)
        rospy.init_node("listener")
        rospy.Subscriber("chatter", rospy.AnyMsg, heard)
        rospy.spin()
        """
    )
    sim.run(0.15)
    assert texts(node) == [r"std_msgs/String b'\x07\x00\x00\x00hello 1'"]


def test_numpy_msg_has_arrays(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import numpy, rospy
        from rospy.numpy_msg import numpy_msg
        from std_msgs.msg import Float32MultiArray, UInt8MultiArray
        def heard(message):
            rospy.loginfo("%s %s", type(message.data).__name__, message.data * 2)
        rospy.init_node("a")
        for topic, kind in (("floats", Float32MultiArray), ("octets", UInt8MultiArray)):
            rospy.Subscriber(topic, numpy_msg(kind), heard)
        floats = rospy.Publisher("floats", numpy_msg(Float32MultiArray), queue_size=1)
        octets = rospy.Publisher("octets", UInt8MultiArray, queue_size=1)
        rospy.sleep(0.1)
        floats.publish(data=numpy.array([1.5, 2], dtype=numpy.float32))
        octets.publish(data=[3, 4])
        rospy.spin()
        """
    )
    sim.run(0.2)
    assert texts(node) == ["ndarray [3. 4.]", "ndarray [6 8]"]


def test_get_published_topics_lists_those_of_the_simulation_too(sim: Any, add: Any, texts: Any) -> None:
    add(TALK, "talker")
    node = add(
        """
        import rospy
        rospy.init_node("a")
        rospy.sleep(0.1)
        topics = dict(map(tuple, rospy.get_published_topics()))
        rospy.loginfo("%s %s", topics["/chatter"], topics["/clock"])
        """
    )
    sim.run(0.2)
    assert texts(node) == ["std_msgs/String rosgraph_msgs/Clock"]


def test_a_listener_of_subscriptions_hears_of_each_subscriber(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rospy
        from std_msgs.msg import String
        class Greeter(rospy.SubscribeListener):
            def peer_subscribe(self, topic, publish, publish_to_peer):
                publish_to_peer(String("welcome"))
        rospy.init_node("a")
        rospy.Publisher("chatter", String, Greeter(), queue_size=1)
        rospy.Subscriber("chatter", String, lambda message: rospy.loginfo(message.data))
        rospy.spin()
        """
    )
    sim.run(0.1)
    assert texts(node) == ["welcome"]
