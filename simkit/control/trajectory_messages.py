"""Messages by which trajectory controllers tell what they do."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from simkit import msgs
from simkit.control.joint_group import JointGroup
from simkit.pose import Vector

TRAJECTORY: Final = "trajectory_msgs/msg/JointTrajectory"
_POINT: Final = "trajectory_msgs/msg/JointTrajectoryPoint"
_NO_POINT: Final = "trajectory_msgs/msg/MultiDOFJointTrajectoryPoint"
_FEEDBACK: Final = "control_msgs/action/FollowJointTrajectory_Feedback"


class StateMessages:
    """Makes them for one group of joints."""

    STATE: Final = "control_msgs/msg/JointTrajectoryControllerState"

    def __init__(self, group: JointGroup) -> None:
        self._group, self._names = group, list(group.joints)
        self._none = np.zeros(0)

    def __deepcopy__(self, memo: dict[int, Any]) -> StateMessages:
        return self

    def feedback(self, now: int, desired: Vector, state: Vector, errors: Vector) -> Any:
        """How far a goal is; arrays (3, n)."""
        measured = len(self._group.states)
        points = self._point(desired, 3), self._point(state, measured), self._point(errors, measured)
        none = (self._no_point() for _ in range(3))
        return msgs.type_of(_FEEDBACK)(msgs.header(now, ""), list(self._names), *points, [], *none)

    def state(self, now: int, desired: Vector, state: Vector, errors: Vector, commands: Vector) -> Any:
        """What the controller is at; arrays (3, n), and the values of its command interfaces."""
        measured = len(self._group.states)
        wanted, actual = self._point(desired, 3), self._point(state, measured)
        points = wanted, actual, self._point(errors, measured), self._output(commands), wanted, actual
        none = (self._no_point() for _ in range(6))
        return msgs.type_of(self.STATE)(msgs.header(now, ""), list(self._names), *points, [], *none)

    def _no_point(self) -> Any:
        return msgs.type_of(_NO_POINT)([], [], [], msgs.duration(0))

    def _point(self, motion: Vector, rows: int) -> Any:
        fields = [motion[k] if k < rows else self._none for k in range(3)]
        return msgs.type_of(_POINT)(*fields, self._none, msgs.duration(0))

    def _output(self, values: Vector) -> Any:
        count = len(self._group.commanded_joints)
        found = {kind: values[k * count : (k + 1) * count] for k, kind in enumerate(self._group.commands)}
        fields = [found.get(kind, self._none) for kind in ("position", "velocity", "acceleration", "effort")]
        return msgs.type_of(_POINT)(*fields, msgs.duration(0))
