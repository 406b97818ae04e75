"""Times and durations of ROS 1."""

from __future__ import annotations

from simkit_nodes.interfaces.ros1_time import Duration, Time, TVal

__all__ = ["Duration", "TVal", "Time"]
