"""Dead reckoning of bases that turn their wheels otherwise than by two sides."""

from __future__ import annotations

import abc
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from simkit.plugins.drives.odometry import LONGEST, MEAN_STEPS, BodyTwist, DeadReckoning
from simkit.pose import Pose

if TYPE_CHECKING:
    from simkit.runtime import Joint

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
    qpos: Any = joints[0]._sim.physics.data.qpos
    return tuple(qpos.item(joint._one_qpos) for joint in joints)
