"""Joint that an output channel of an autopilot moves by a PID, as in Gazebo's plugins for ArduPilot and PX4."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from simkit.extend import JointAxis
    from simkit.plugins.joints.pid import Pid

ChannelKind = Literal["velocity", "position", "effort"]


@dataclass(slots=True)
class JointChannel:
    """Joint of a channel.

    Attributes:
        axis: moved axis.
        pid: controller of the velocity or the position; not used for an effort.
        kind: meaning of the target.
    """

    axis: JointAxis
    pid: Pid
    kind: ChannelKind

    def push(self, target: float, step: float) -> None:
        """Push the joint for the next step.

        Args:
            target: velocity [rad/s or m/s], position [rad or m] or effort [N·m or N].
            step: physics step [s].
        """
        if self.kind == "effort":
            self.axis.push(target)
            return
        measured = self.axis.velocity if self.kind == "velocity" else self.axis.position
        self.axis.push(self.pid.update(measured - target, step))
