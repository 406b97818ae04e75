"""Names of the ROS 2 package `launch_testing`, without a test: a launch file of a test starts what it describes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from simkit_launch.launch_modules.launch.action import Action

__all__ = ["KeepAliveProc", "ReadyToTest", "WaitForTopics", "keep_alive", "post_shutdown_test"]


class ReadyToTest(Action):
    """Begin of the tests; it does nothing here."""


class KeepAliveProc(Action):
    """Process that does nothing."""


class WaitForTopics:
    """Wait for topics; it does nothing here.

    Args:
        topic_tuples: pairs of a name and a type.
        options: accepted.
    """

    def __init__(self, topic_tuples: Any = (), **options: Any) -> None:
        del topic_tuples, options


def keep_alive(function: Any) -> Any:
    """Return a function as it is."""
    return function


def post_shutdown_test() -> Callable[[Any], object]:
    """Return a decorator that returns its class."""
    return keep_alive
