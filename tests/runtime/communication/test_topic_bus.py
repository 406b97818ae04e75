"""Topic bus: messages reach subscribers at once, and command inputs before the next step."""

import pytest

from simkit import msgs
from simkit.errors import MessageError
from simkit.runtime.communication.topic_bus import TopicBus


def test_a_subscriber_may_exist_before_the_publisher():
    bus = TopicBus()
    subscription = bus.subscribe("chatter")
    publisher = bus.advertise("/chatter", "std_msgs/msg/Float64")
    assert publisher.wanted
    publisher.publish(msgs.make("std_msgs/msg/Float64", data=2.0))
    assert subscription.latest.data == 2.0
    subscription.close()
    assert not publisher.wanted


def test_keep_limits_the_messages_of_a_subscription():
    bus = TopicBus()
    publisher = bus.advertise("/x", "std_msgs/msg/Float64")
    subscription = bus.subscribe("/x", keep=3)
    for i in range(10):
        publisher.publish(msgs.make("std_msgs/msg/Float64", data=float(i)))
    assert [m.data for m in subscription.messages] == [7.0, 8.0, 9.0]


def test_a_latched_topic_sends_its_last_message_to_later_subscribers():
    bus = TopicBus()
    bus.advertise("/x", "std_msgs/msg/Float64", latched=True).publish(msgs.make("std_msgs/msg/Float64", data=4.0))
    assert bus.subscribe("/x").latest.data == 4.0


def test_a_message_kept_on_a_latched_topic_is_made_when_a_subscriber_reads_it():
    bus, made, called = TopicBus(), [], []

    def make():
        made.append(msgs.make("std_msgs/msg/Float64", data=4.0))
        return made[-1]

    bus.advertise("/x", "std_msgs/msg/Float64", latched=True).publish_later(make)
    subscription = bus.subscribe("/x")
    assert made == []
    assert subscription.latest.data == 4.0
    bus.subscribe("/x", called.append)
    assert [len(made), *(m.data for m in called)] == [1, 4.0]


def test_a_publisher_accepts_a_dict_of_the_fields_of_its_type():
    bus = TopicBus()
    publisher = bus.advertise("/x", "geometry_msgs/msg/Twist")
    subscription = bus.subscribe("/x")
    publisher.publish({"linear": {"x": 0.2}})
    assert (subscription.latest.linear.x, subscription.latest.linear.y) == (0.2, 0.0)
    with pytest.raises(MessageError, match="linaer"):
        publisher.publish({"linaer": {"x": 0.2}})


def test_commands_arrive_in_order_and_only_when_delivered():
    bus, got = TopicBus(), []
    bus.listen("/cmd", ["std_msgs/msg/Float64"], lambda m: got.append(m.data))
    bus.publish("/cmd", {"data": 1.0})
    bus.publish("/cmd", {"data": 2.0})
    assert got == []
    bus.deliver_inputs()
    assert got == [1.0, 2.0]


def test_a_dict_becomes_a_message_of_the_type_whose_fields_fit():
    bus, got = TopicBus(), []
    bus.listen("/cmd_vel", ["geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"], got.append)
    bus.publish("/cmd_vel", {"linear": {"x": 0.2}})
    bus.publish("/cmd_vel", {"twist": {"linear": {"x": 0.3}}})
    bus.deliver_inputs()
    assert [msgs.type_name(m) for m in got] == ["geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"]
    assert bus.topics() == {"/cmd_vel": "geometry_msgs/msg/Twist"}


def test_the_error_for_an_unknown_topic_suggests_the_closest_name():
    bus = TopicBus()
    bus.listen("/cmd_vel", ["geometry_msgs/msg/Twist"], lambda m: None)
    with pytest.raises(MessageError, match="/cmd_vel"):
        bus.publish("/cmd_vl", {"linear": {"x": 1.0}})


def test_a_message_of_another_type_is_rejected():
    bus = TopicBus()
    bus.listen("/cmd_vel", ["geometry_msgs/msg/Twist"], lambda m: None)
    with pytest.raises(MessageError, match="Float64"):
        bus.publish("/cmd_vel", msgs.make("std_msgs/msg/Float64", data=1.0))


def test_deferred_messages_are_published_before_a_read_a_subscription_or_a_close():
    bus = TopicBus()
    publisher = bus.advertise("/x", "std_msgs/msg/Float64")
    waiting = []

    def hand_over():
        values, waiting[:] = waiting.copy(), []
        for value in values:
            publisher.publish(msgs.make("std_msgs/msg/Float64", data=value))

    publisher.pending = hand_over
    first = bus.subscribe("/x")
    waiting.append(1.0)
    second = bus.subscribe("/x")
    waiting.append(2.0)
    assert [m.data for m in first.messages] == [1.0, 2.0]
    assert [m.data for m in second.messages] == [2.0]
    waiting.append(3.0)
    second.close()
    waiting.append(4.0)
    assert first.latest.data == 4.0
    assert [m.data for m in second.messages] == [2.0, 3.0]


def test_patience_is_the_number_of_messages_that_the_subscribers_keep():
    bus = TopicBus()
    publisher = bus.advertise("/x", "std_msgs/msg/Float64")
    assert publisher.patience == 0
    bus.subscribe("/x", keep=3)
    revision = bus.revision
    bounded = publisher.patience
    bus.subscribe("/x", keep=7)
    assert (bounded, publisher.patience) == (3, 7)
    assert bus.revision != revision
    called = bus.subscribe("/x", lambda message: None)
    assert publisher.patience == 0
    assert publisher.is_live
    called.close()
    assert publisher.patience == 7
    bus.advertise("/x", "std_msgs/msg/Float64")
    assert publisher.patience == 0
