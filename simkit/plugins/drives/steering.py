"""Bases that steer wheels: the geometry of Ackermann's, and the joints that a drive names."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from simkit.params import Params
from simkit.plugins.drives.travel import Motion, TravelOdometry
from simkit.plugins.lookups import find_axis_joint

if TYPE_CHECKING:
    from simkit.scene import SceneJoint, SceneModel


def steering_angles(slope: float, base: float, width: float) -> tuple[float, float]:
    """Angles of the left and right steered wheel, so that all wheels turn round one point [rad].

    Args:
        slope: tangent of the angle of a wheel in the middle; left is positive.
        base: between the axles [m].
        width: between the steered wheels' pivots [m].
    """
    half = width / 2 * slope
    return math.atan2(base * slope, base - half), math.atan2(base * slope, base + half)


class AckermannOdometry(TravelOdometry):
    """Of the mean of two wheels' turns and of two wheels' steering, in the middle of the unsteered axle.

    Values noted are angles of the left and right wheel and of the left and right steering. The twist is that of the
    last step, as Gazebo's.

    Args:
        radius: of the wheels [m].
        base: between the axles [m].
        step: from one noting to the next [s].
    """

    stride = mean_steps = 1

    def __init__(self, radius: float, base: float, step: float) -> None:
        super().__init__(step)
        self._radius, self._base = radius, base

    def motion(self, before: Sequence[float], after: Sequence[float]) -> Motion:
        """Along the arc that the steering says."""
        ahead = self._radius * ((after[0] - before[0]) + (after[1] - before[1])) / 2
        return ahead, 0.0, ahead * math.tan((after[2] + after[3]) / 2) / self._base


def find_turning(scene: SceneModel, name: str, what: str, params: Params) -> SceneJoint | None:
    """A joint that is to be steered or turned; None after an error."""
    joint: Any = find_axis_joint(scene, name, params)
    if joint is not None and joint.type == "prismatic":
        message = f"joint {name!r} is prismatic, it does not turn; a {what}'s is revolute or continuous"
        params.error("SK-PLUGIN-051", message)
        return None
    found: SceneJoint | None = joint
    return found
