"""Error codes of MoveIt, and the exception that carries one."""

from __future__ import annotations

import importlib.util
from enum import IntEnum

from simkit.install_command import install_command


class Code(IntEnum):
    """Values of `moveit_msgs/msg/MoveItErrorCodes` that simkit uses."""

    SUCCESS = 1
    FAILURE = 99999
    PLANNING_FAILED = -1
    INVALID_MOTION_PLAN = -2
    CONTROL_FAILED = -4
    TIMED_OUT = -6
    PREEMPTED = -7
    START_STATE_IN_COLLISION = -10
    GOAL_IN_COLLISION = -12
    INVALID_GROUP_NAME = -15
    INVALID_GOAL_CONSTRAINTS = -16
    INVALID_ROBOT_STATE = -17
    INVALID_LINK_NAME = -18
    INVALID_OBJECT_NAME = -19
    FRAME_TRANSFORM_FAILURE = -21
    START_STATE_INVALID = -26
    GOAL_STATE_INVALID = -27
    NO_IK_SOLUTION = -31


class PlanningFailed(Exception):
    """Error: a request has no answer.

    Attributes:
        code: Reason.
    """

    def __init__(self, code: Code, text: str) -> None:
        super().__init__(text)
        self.code = code


def check_packages() -> None:
    """Check that the packages of the calculations are installed.

    Raises:
        PlanningFailed: `pin` or `coal` is missing.
    """
    for module, package in (("pinocchio", "pin"), ("coal", "coal")):
        if importlib.util.find_spec(module) is None:
            help_text = install_command("labs")
            raise PlanningFailed(Code.FAILURE, f"the package {package} is not installed; help: {help_text}")


def error_fields(error: PlanningFailed | None, source: str) -> dict[str, object]:
    """Return the fields of a `moveit_msgs/msg/MoveItErrorCodes`; None stands for success."""
    if error is None:
        return {"val": int(Code.SUCCESS), "source": source}
    return {"val": int(error.code), "message": str(error), "source": source}
