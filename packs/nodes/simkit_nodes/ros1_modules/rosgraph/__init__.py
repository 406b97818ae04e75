"""Package `rosgraph` of ROS 1: names, and questions for the master."""

from __future__ import annotations

from typing import Any

from simkit_nodes.ros1_modules.rospy.msproxy import MasterProxy

__all__ = ["Master", "MasterError", "MasterException", "get_master_uri", "is_master_online"]


class MasterException(Exception):
    """The master cannot answer."""


class MasterError(MasterException):
    """The master refuses a request."""


class Master:
    """Questions for the master.

    Args:
        caller_id: name of the node that asks.
        master_uri: accepted as in ROS.
    """

    def __init__(self, caller_id: str, master_uri: str | None = None) -> None:
        self.caller_id = caller_id

    def __getattr__(self, name: str) -> Any:
        function = getattr(MasterProxy(), name)
        return lambda *args: function(*args)[2]


def is_master_online(master_uri: str | None = None) -> bool:
    """Check whether programs can talk to each other; always True."""
    return True


def get_master_uri(env: object = None, argv: object = None) -> str:
    """Return the address of ROS 1's master in its default form; simkit has none."""
    return "http://localhost:11311"
