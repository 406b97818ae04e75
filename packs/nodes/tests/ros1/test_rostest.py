"""Tests: a program of ROS 1 that runs its own tests."""

from __future__ import annotations

from typing import Any

TESTS = """
    import rospy, rostest, unittest
    from std_msgs.msg import String
    class Chatter(unittest.TestCase):
        def test_a_message_arrives_in_time(self):
            self.assertEqual(rospy.wait_for_message("chatter", String, 1).data, "{data}")
    rospy.init_node("test")
    rostest.rosrun("talk", "chatter_test", Chatter)
"""


def test_a_test_that_passes_ends_the_program_with_0(sim: Any, add: Any) -> None:
    sim.advertise("/chatter", "std_msgs/msg/String", latched=True).publish({"data": "hello"})
    node = add(TESTS.format(data="hello"))
    sim.run(0.1)
    assert (node.done, node.exit_code) == (True, 0)
    assert node.log == ["[talk/chatter_test] 1 tests, 0 errors, 0 failures"]


def test_a_test_that_fails_ends_the_program_with_1(sim: Any, add: Any) -> None:
    sim.advertise("/chatter", "std_msgs/msg/String", latched=True).publish({"data": "bye"})
    node = add(TESTS.format(data="hello"))
    sim.run(0.1)
    assert node.exit_code == 1
    assert "AssertionError: 'bye' != 'hello'" in node.log
    assert node.log[-1] == "[talk/chatter_test] 1 tests, 0 errors, 1 failures"
