"""Topics, services and actions whose types are given by message classes."""

import pytest

import simkit
from simkit import msgs

WORLD = '<sdf version="1.9"><world name="w"/></sdf>'


def test_a_subscription_by_class_receives_the_messages_of_its_type():
    with simkit.load(WORLD) as sim:
        heard = []
        subscription = sim.subscribe("/words", heard.append, type=msgs.String)
        publisher = sim.advertise("/words", msgs.String)
        publisher.publish({"data": "hello"})
        assert publisher.type_name == "std_msgs/msg/String"
        assert subscription.latest.data == heard[0].data == "hello"


def test_a_subscription_by_class_to_a_topic_of_another_type_is_an_error():
    with simkit.load(WORLD) as sim:
        sim.advertise("/words", msgs.String)
        with pytest.raises(simkit.MessageError, match="has type std_msgs/msg/String, got sensor_msgs") as caught:
            sim.subscribe("/words", type=msgs.Imu)
        assert caught.value.code == "SK-MSG-001"


def test_a_later_publisher_of_another_type_than_a_subscription_is_an_error():
    with simkit.load(WORLD) as sim:
        subscription = sim.subscribe("/words", type=msgs.Imu)
        with pytest.raises(simkit.MessageError, match="subscription of type sensor_msgs/msg/Imu, got std_msgs/msg/Str"):
            sim.advertise("/words", msgs.String)
        subscription.close()
        sim.advertise("/words", msgs.String)


@pytest.mark.parametrize("cls", [int, simkit.Pose])
def test_a_class_that_is_no_message_is_an_error(cls):
    with simkit.load(WORLD) as sim:
        for call in (lambda: sim.subscribe("/words", type=cls), lambda: sim.offer("/words", cls, print)):
            with pytest.raises(simkit.MessageError, match="is not a class of messages"):
                call()


def test_a_service_and_an_action_have_the_type_of_their_request_and_goal_class():
    with simkit.load(WORLD) as sim:
        sim.offer("/lamp", msgs.SetBool_Request, lambda request: {"success": request.data})
        sim.act("/count", msgs.Fibonacci_Goal, lambda goal: {"sequence": [goal.request.order]})
        assert sim.call("/lamp", {"data": True}).success
        goal = sim.send_goal("/count", {"order": 3})
        sim.step()
        assert goal.result.sequence.tolist() == [3]
        with pytest.raises(simkit.MessageError, match="ends with _Goal"):
            sim.act("/more", msgs.SetBool_Request, print)


def test_a_call_and_a_goal_by_class_need_a_service_and_an_action_of_that_type():
    with simkit.load(WORLD) as sim:
        sim.offer("/lamp", msgs.SetBool_Request, lambda request: {"success": request.data})
        sim.act("/count", msgs.Fibonacci_Goal, lambda goal: {"sequence": [goal.request.order]})
        assert sim.call("/lamp", {"data": True}, type=msgs.SetBool_Request).success
        assert not sim.call("/lamp", type="std_srvs/srv/SetBool").success
        goal = sim.send_goal("/count", {"order": 3}, type=msgs.Fibonacci_Goal)
        sim.step()
        assert (goal.result.sequence.tolist(), goal.feedback) == ([3], None)
        with pytest.raises(simkit.MessageError, match="needs std_srvs/srv/SetBool_Request, got std_srvs/srv/Trigger"):
            sim.call("/lamp", type=msgs.Trigger_Request)
        with pytest.raises(simkit.MessageError, match="needs example_interfaces/action/Fibonacci_Goal, got tf2_msgs"):
            sim.send_goal("/count", type=msgs.LookupTransform_Goal)
        with pytest.raises(simkit.MessageError, match="ends with _Request"):
            sim.call("/lamp", type=msgs.SetBool_Response)
        with pytest.raises(simkit.MessageError, match="did you mean 'data'"):
            sim.call("/lamp", {"date": True}, type=msgs.SetBool_Request)


def test_a_message_is_made_and_decoded_by_class():
    twist = msgs.make(msgs.Twist, linear={"x": 0.2})
    assert (
        msgs.deserialize(msgs.serialize(twist), msgs.Twist)
        == twist
        == msgs.make("geometry_msgs/msg/Twist", linear={"x": 0.2})
    )
    with pytest.raises(simkit.MessageError, match="did you mean 'linear'"):
        msgs.make(msgs.Twist, liner={"x": 0.2})
    with pytest.raises(simkit.MessageError, match="is not a class of messages"):
        msgs.make(int)


class Listening(simkit.WorldPlugin):
    """Plugin that opens everything by class."""

    def load(self, parent, params):
        self.scans = self.subscribe("/scan", type=msgs.LaserScan)
        self.heard = []
        self.listen("/words", msgs.String, self.heard.append)
        self.echo = self.advertise("/echo", msgs.String)
        self.offer("lamp", msgs.SetBool_Request, lambda request: {"success": True})


def test_a_plugin_opens_topics_and_services_by_class():
    plugin = Listening()
    with simkit.load(WORLD, plugins=[plugin]) as sim:
        sim.publish("/words", {"data": "hello"})
        sim.step()
        assert plugin.heard[0].data == "hello"
        assert sim.topics()["/echo"] == "std_msgs/msg/String"
        with pytest.raises(simkit.MessageError):
            sim.advertise("/scan", msgs.Imu)
