"""Steered bases: Ackermann geometry, and dead reckoning from the angles of wheels and steering."""

from __future__ import annotations

import abc
import math
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from simkit.params import Params
from simkit.plugins.drives.odometry import LONGEST, MEAN_STEPS, BodyTwist, DeadReckoning
from simkit.plugins.find_entities import find_axis_joint
from simkit.pose import Pose

if TYPE_CHECKING:
    from simkit.pose import Vector
    from simkit.runtime import Joint
    from simkit.scene import SceneJoint, SceneModel


Motion = tuple[float, float, float]
"""How far ahead [m], to the left [m] and round [rad] a base has gone, in its own axes."""


class TravelOdometry(abc.ABC):
    """Odometry from what the joints of a base say at the end of every step.

    Angles are only noted at a step; what they say is worked out when it is asked for. The twist is the mean over the
    last ten steps, or as many as there were, as Gazebo has it for most bases.

    Attributes:
        twist: over the last steps before that, in the base's axes.
    """

    stride = MEAN_STEPS
    """How many steps are taken for one arc."""

    mean_steps = MEAN_STEPS
    """How many steps the twist is the mean over."""

    def __init__(self, step: float) -> None:
        self._step = step
        self._reckoning = DeadReckoning()
        self.twist = BodyTwist()
        self._at: tuple[float, ...] | None = None
        self._noted: list[tuple[float, ...]] = []
        self._recent: list[tuple[float, ...]] = []

    @abc.abstractmethod
    def motion(self, before: Sequence[float], after: Sequence[float]) -> Motion:
        """What a change of angles [rad] says; it is additive along an arc."""

    @property
    def pose(self) -> Pose:
        """Of the base on the plane, as of the last `reckon`; it begins at zero."""
        return self._reckoning.pose

    def note(self, angles: tuple[float, ...]) -> None:
        """Before every step."""
        if len(self._noted) >= LONGEST:
            self._roll(angles)
        self._noted.append(angles)

    def reckon(self, angles: tuple[float, ...]) -> None:
        """After a step: brings pose and twist up to it."""
        self._roll(angles)
        elapsed = len(self._recent) * self._step
        totals = [0.0, 0.0, 0.0]
        for before, after in pairwise([*self._recent, angles]):
            totals = [a + b for a, b in zip(totals, self.motion(before, after), strict=True)]
        ahead, left, turn = (total / elapsed for total in totals)
        self.twist = BodyTwist((ahead, left, 0.0), (0.0, 0.0, turn))

    def _roll(self, angles: tuple[float, ...]) -> None:
        """Along all that was noted, and on to these angles."""
        noted = self._noted
        last = self._at if self._at is not None else (noted or [angles])[0]
        for point in (*noted[self.stride :: self.stride], angles):
            self._reckoning.go(*self.motion(last, point))
            last = point
        self._at = angles
        self._recent = [*self._recent, *noted][-self.mean_steps :] or [angles]
        self._noted = []


def joint_angles(joints: Sequence[Joint]) -> tuple[float, ...]:
    """Of joints with one axis [rad]: cheaper than their positions, for every step."""
    qpos: Vector = joints[0]._physics.data.qpos
    return tuple(qpos.item(joint._one_qpos) for joint in joints)


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


def find_drive_joint(scene: SceneModel, name: str, what: str, params: Params) -> SceneJoint | None:
    """A joint that is to be steered or turned; None after an error."""
    joint = find_axis_joint(scene, name, params)
    if joint is not None and joint.type == "prismatic":
        message = f"joint {name!r} is prismatic, it does not turn; a {what}'s is revolute or continuous"
        params.error("SK-PLUGIN-051", message)
        return None
    return joint
