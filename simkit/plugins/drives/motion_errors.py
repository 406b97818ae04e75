"""Relative errors of a base's motion by direction: of the odometry that a drive reports, or of the motion itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from simkit.plugins.options import Options, number

FAR: Final = 0.9
"""Largest relative error; at -1 there would be no motion."""


@dataclass(frozen=True, slots=True)
class MotionErrors:
    """Relative errors by direction: 0.05 is 5 % more than the true or commanded value.

    Attributes:
        forward, backward: Error of the motion along the heading.
        leftward, rightward: Error of the motion across the heading.
        left_turn, right_turn: Error of the rotation.
    """

    forward: float = 0.0
    backward: float = 0.0
    leftward: float = 0.0
    rightward: float = 0.0
    left_turn: float = 0.0
    right_turn: float = 0.0

    def apply(self, ahead: float, left: float, turn: float) -> tuple[float, float, float]:
        """Return a displacement or velocity in the base's axes with the errors of its directions."""
        return (
            ahead * (1.0 + (self.forward if ahead >= 0 else self.backward)),
            left * (1.0 + (self.leftward if left >= 0 else self.rightward)),
            turn * (1.0 + (self.left_turn if turn >= 0 else self.right_turn)),
        )


class MotionErrorOptions(Options):
    """Options of the `<actuation_error>` block of a drive, a simkit extension."""

    forward_error: float = number(0.0, minimum=-FAR, maximum=FAR)
    backward_error: float = number(0.0, minimum=-FAR, maximum=FAR)
    leftward_error: float = number(0.0, minimum=-FAR, maximum=FAR)
    rightward_error: float = number(0.0, minimum=-FAR, maximum=FAR)
    left_turn_error: float = number(0.0, minimum=-FAR, maximum=FAR)
    right_turn_error: float = number(0.0, minimum=-FAR, maximum=FAR)

    @property
    def motion_errors(self) -> MotionErrors | None:
        """Errors of the block; None if it is missing or has no error."""
        if not self.is_given:
            return None
        errors = MotionErrors(
            forward=self.forward_error,
            backward=self.backward_error,
            leftward=self.leftward_error,
            rightward=self.rightward_error,
            left_turn=self.left_turn_error,
            right_turn=self.right_turn_error,
        )
        return None if errors == MotionErrors() else errors


def with_errors(errors: MotionErrors | None, speeds: tuple[float, ...]) -> tuple[float, ...]:
    """Return the speeds that a drive really gets for its commands.

    Args:
        errors: Errors of the drive; None for none.
        speeds: Forward speed, for some drives the speed to the left, and turning rate.
    """
    if errors is None:
        return speeds
    left = speeds[1] if len(speeds) == 3 else 0.0
    ahead, left, turn = errors.apply(speeds[0], left, speeds[-1])
    return (ahead, left, turn) if len(speeds) == 3 else (ahead, turn)
