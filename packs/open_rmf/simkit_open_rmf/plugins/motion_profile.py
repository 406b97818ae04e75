"""Speeds of doors, lifts and robots of Open-RMF, with limits of speed and acceleration.

The rules are those of rmf_building_sim_common and rmf_robot_sim_common. A motion accelerates with the nominal
acceleration. It begins to brake when the deceleration that ends it at the target reaches this nominal value.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from simkit import Params
    from simkit.compiler import ActuatorRef
    from simkit.extend import JointAxis

_LEAD: Final = 0.05
"""Largest distance of a reference before its joint [m or rad]."""


@dataclass(frozen=True, slots=True)
class MotionLimits:
    """Limits of a motion, in m or rad.

    Attributes:
        speed: largest speed [1/s].
        nominal: acceleration of a normal motion [1/s²].
        most: largest deceleration [1/s²].
    """

    speed: float
    nominal: float
    most: float


def read_limits(params: Params, speed: float, nominal: float, most: float, element: str) -> MotionLimits:
    """Return limits; with a warning, the largest deceleration is the nominal one if the file has a smaller one.

    Args:
        params: parameters of the plugin.
        speed: largest speed.
        nominal: acceleration of a normal motion.
        most: largest deceleration.
        element: element with the largest deceleration.
    """
    if most < nominal:
        message = f"<{element}> is {most:g}, below the nominal acceleration of {nominal:g}, which is used instead"
        params.child_or_self(element).warning(
            "SK-PLUGIN-111", message, "without it, the motion could not brake in time"
        )
    return MotionLimits(speed, nominal, max(most, nominal))


def speed_to_target(remaining: float, speed: float, limits: MotionLimits, step: float) -> float:
    """Return the next speed of a door or a lift.

    Args:
        remaining: signed distance to the target; zero ends the motion with the nominal deceleration.
        speed: present signed speed.
        limits: limits of the motion.
        step: time until the next call [s].
    """
    if remaining == 0.0:
        return speed - math.copysign(min(abs(speed), limits.nominal * step), speed)
    sign = math.copysign(1.0, remaining)
    remaining, speed = sign * remaining, sign * speed
    next_speed = min(remaining / step, limits.speed, limits.nominal * step + speed)
    if speed > 0.0:
        braking = min(speed * speed / (2.0 * remaining), limits.most)
        if limits.nominal <= braking:
            next_speed = speed - braking * step
    return sign * next_speed


class GuidedJoint:
    """Position reference of a servo that moves a joint to targets.

    The reference follows the limits of the motion. It waits while the joint is held back by more than 5 cm or 0.05 rad.

    Args:
        axis: joint.
        servo: position servo of the joint.
        limits: limits of the motion.
        within: distance from the target at which the joint has arrived.
    """

    def __init__(self, axis: JointAxis, servo: ActuatorRef, limits: MotionLimits, within: float) -> None:
        self.axis, self.servo, self._limits, self._within = axis, servo, limits, within
        self.speed = 0.0
        self.reference = axis.position

    def is_at(self, target: float) -> bool:
        """Check whether the joint has arrived at a target."""
        return abs(target - self.axis.position) < self._within

    def advance(self, target: float, step: float) -> float:
        """Return the reference of the next step of `step` [s]."""
        remaining = target - self.reference
        if abs(remaining) < self._within / 2:
            remaining = 0.0
        is_held = (self.reference - self.axis.position) * remaining > _LEAD * abs(remaining)
        self.speed = 0.0 if is_held else speed_to_target(remaining, self.speed, self._limits, step)
        self.reference += self.speed * step
        return self.reference


def drive_speed(
    remaining: float, speed: float, cruise: float, final: float, limits: MotionLimits, step: float
) -> float:
    """Return the next speed of a robot.

    Args:
        remaining: signed distance to the target; zero stops the robot with the largest deceleration.
        speed: present signed speed.
        cruise: speed of the way to the target, without a sign.
        final: speed at the target.
        limits: limits of the motion.
        step: time until the next call [s].
    """
    if remaining == 0.0 or speed * remaining < 0.0:
        return speed - math.copysign(min(abs(speed), limits.most * step), speed)
    needed = (final * final - speed * speed) / (2.0 * remaining)
    needed = math.copysign(min(abs(needed), limits.most), needed)
    if abs(needed) >= limits.nominal:
        return speed + needed * step
    change = math.copysign(min(cruise, limits.speed), remaining) - speed
    return speed + math.copysign(min(abs(change), limits.nominal * step), change)
