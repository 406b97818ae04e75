"""Reasons for which there is no plan, with the error codes of Nav2's actions."""

from __future__ import annotations

from enum import IntEnum


class Reason(IntEnum):
    """Reasons for which there is no plan.

    The value is added to the code UNKNOWN of an action: 200 of `nav2_msgs/action/ComputePathToPose`, 300 of
    `nav2_msgs/action/ComputePathThroughPoses`.
    """

    UNKNOWN = 0
    INVALID_PLANNER = 1
    TF_ERROR = 2
    START_OUTSIDE_MAP = 3
    GOAL_OUTSIDE_MAP = 4
    START_OCCUPIED = 5
    GOAL_OCCUPIED = 6
    TIMEOUT = 7
    NO_VALID_PATH = 8
    NO_VIAPOINTS_GIVEN = 9


class PlanningError(Exception):
    """A path cannot be computed.

    Attributes:
        reason: reason, which decides about the error code.
    """

    def __init__(self, reason: Reason, text: str) -> None:
        super().__init__(text)
        self.reason = reason
