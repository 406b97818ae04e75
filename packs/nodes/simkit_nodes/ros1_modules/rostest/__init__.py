"""Tests of ROS 1 nodes: a program runs the tests of a `unittest.TestCase` in simulated time."""

from __future__ import annotations

import sys
import unittest
from collections.abc import Sequence
from typing import Any

from simkit_nodes.ros1_modules.rospy.ros_node import ros_node

__all__ = ["is_publisher", "is_subscriber", "rosrun", "run", "unitrun"]


def rosrun(package: str, test_name: str, test: Any, sysargs: Sequence[str] | None = None) -> None:
    """Run the tests of a class, print the results, shut the node down, and exit with 1 if a test failed.

    Args:
        package: name of the package.
        test_name: name of the results.
        test: class of the tests, or name of a module or class.
        sysargs: accepted as in ROS.
    """
    loader = unittest.TestLoader()
    suite = loader.loadTestsFromName(test) if isinstance(test, str) else loader.loadTestsFromTestCase(test)
    result = unittest.TestResult()
    suite.run(result)
    node = ros_node()
    lines = [line for _, text in (*result.errors, *result.failures) for line in text.splitlines()]
    counts = f"{result.testsRun} tests, {len(result.errors)} errors, {len(result.failures)} failures"
    node.program.write_log([*lines, f"[{package}/{test_name}] {counts}"])
    node.shut_down("test complete")
    if not result.wasSuccessful():
        sys.exit(1)


run = unitrun = rosrun


def is_subscriber(topic: str, subscriber_id: str) -> bool:
    """Check whether a node subscribes to a topic."""
    node = ros_node()
    ends = node.host.graph.subscriptions(node.resolve(topic))
    return node.resolve(subscriber_id) in [end.node for end in ends]


def is_publisher(topic: str, publisher_id: str) -> bool:
    """Check whether a node publishes a topic."""
    node = ros_node()
    ends = node.host.graph.publishers(node.resolve(topic))
    return node.resolve(publisher_id) in [end.node for end in ends]
