"""Beginning and end of the node in C++ that `moveit_commander` needs in ROS; nothing here."""

from __future__ import annotations

from collections.abc import Sequence

__all__ = ["roscpp_init", "roscpp_initialize", "roscpp_shutdown"]


def roscpp_initialize(args: Sequence[str]) -> None:
    """Accept the words of the command line; the commands use the node of `rospy`."""


roscpp_init = roscpp_initialize


def roscpp_shutdown() -> None:
    """Accept the end; the node of `rospy` goes on."""
