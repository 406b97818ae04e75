"""Exception of the package."""

from __future__ import annotations

__all__ = ["MoveItCommanderException"]


class MoveItCommanderException(Exception):
    """Invalid argument, or a target that the robot does not have."""
