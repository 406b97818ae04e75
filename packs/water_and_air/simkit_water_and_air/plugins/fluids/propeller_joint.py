"""Joint of a rotor or propeller that reaches a commanded speed within a step."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from simkit.extend import JointAxis
from simkit.linear_algebra import matmul

if TYPE_CHECKING:
    from simkit.extend import SceneJoint, SceneModel


class PropellerJoint:
    """Joint that turns a light propeller at a commanded speed.

    The effort is J · Δω / step plus the load that acted in the last step. J is the propeller's own inertia: an armature
    as of other driven joints would turn the vehicle when the propeller changes its speed.

    Args:
        axis: axis of the joint.
        inertia: inertia of the propeller about the axis, from `propeller_inertia` [kg·m²].
        step: physics step [s].
    """

    def __init__(self, axis: JointAxis, inertia: float, step: float) -> None:
        self.axis = axis
        self._rate = inertia / step
        self._last: tuple[float, float] | None = None  # velocity [rad/s] and effort [N·m] of the last step

    def turn(self, target: float) -> None:
        """Push the joint so that its next velocity is `target` [rad/s], within its effort limit."""
        velocity, limit = self.axis.velocity, self.axis.effort_limit
        load = 0.0 if self._last is None else self._last[1] - self._rate * (velocity - self._last[0])
        effort = max(-limit, min(limit, self._rate * (target - velocity) + load))
        self._last = velocity, effort
        self.axis.push(effort)


def propeller_inertia(scene: SceneModel, joint: SceneJoint) -> float:
    """Return the inertia of a joint's child link about its first axis [kg·m²]; 0 if the model has no such link."""
    link = next((link for link in scene.all_links() if link.scoped == joint.child_link), None)
    if link is None:
        return 0.0
    into_link = link.pose_world.inverse()
    axis = into_link.rotate(joint.axes[0].xyz_world)
    arm = np.cross(axis, np.subtract(link.inertial.com, into_link.transform(joint.pose_world.position)))
    xx, yy, zz, xy, xz, yz = link.inertial.inertia
    tensor = np.array(((xx, xy, xz), (xy, yy, yz), (xz, yz, zz)))
    return float(matmul(axis, tensor, axis) + link.inertial.mass * matmul(arm, arm))
