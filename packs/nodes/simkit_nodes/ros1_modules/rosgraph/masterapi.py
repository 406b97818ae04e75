"""Questions for the master of ROS 1."""

from __future__ import annotations

from simkit_nodes.ros1_modules.rosgraph import Master, MasterError, MasterException

__all__ = ["Master", "MasterError", "MasterException"]
