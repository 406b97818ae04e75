"""Statuses of the goals of actions."""

from __future__ import annotations

import enum


class GoalStatus(enum.IntEnum):
    """Status of a goal. The numbers are those of `action_msgs/msg/GoalStatus`; REJECTED is simkit's own.

    A goal is UNKNOWN until it reaches its plugin. It is UNKNOWN again after a restore to a time before it was sent.
    """

    REJECTED = -1
    UNKNOWN = 0
    ACCEPTED = 1
    EXECUTING = 2
    CANCELING = 3
    SUCCEEDED = 4
    CANCELED = 5
    ABORTED = 6

    @property
    def is_final(self) -> bool:
        """True if the goal was rejected, succeeded, was cancelled or aborted."""
        return self in _FINAL


_FINAL = frozenset({GoalStatus.REJECTED, GoalStatus.SUCCEEDED, GoalStatus.CANCELED, GoalStatus.ABORTED})
