"""Conditions that a run must meet, and tolerances for the comparison of two runs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal

from simkit.run_values import Texts

NO_FILE_POSITION: Final = ""
"""Position of an item that does not come from a file."""

CheckKind = Literal["goal", "always", "final", "apart", "rate"]
"""Kind of a check.

- "goal", "always", "final": an expression holds once, at all times, or at the end.
- "apart": models never touch.
- "rate": a topic has the required rate.
"""


@dataclass(frozen=True)
class Check:
    """One condition that a run must meet.

    Attributes:
        kind: kind of the condition. The kinds goal, always and final use `expression`, apart uses `models`, and rate
            uses `topic`, `rate` and `tolerance`.
        name: name in a report.
        expression: expression in the language of `docs/conditions.md`.
        by: simulated time by which a goal must be reached [s]; None for the end of the run.
        after: simulated time from which "always" and "apart" are checked [s].
        models: scoped names of models or links: two names that must not touch each other, or one name that may touch
            only the ground.
        rate: required rate [Hz] of simulated time; None for the rate that is set for the sensor or plugin.
        tolerance: allowed relative deviation of the rate.
        points: points for meeting the condition in an exercise.
        hint: text of a report if the condition does not hold.
        where: `file:line`, or NOWHERE.
    """

    kind: CheckKind
    name: str = ""
    expression: str = ""
    by: float | None = None
    after: float = 0.0
    models: tuple[str, ...] = ()
    topic: str = ""
    rate: float | None = None
    tolerance: float = 0.05
    points: float = 1.0
    hint: str = ""
    where: str = NO_FILE_POSITION

    @property
    def title(self) -> str:
        """Name of the check, or its condition as text."""
        if self.name:
            return self.name
        if self.kind == "apart":
            return " and ".join(self.models) + (" do not touch" if len(self.models) > 1 else " touches nothing")
        if self.kind == "rate":
            return f"{self.topic} ticks" + (f" at {self.rate:g} Hz" if self.rate is not None else "")
        return self.expression


@dataclass(frozen=True)
class Tolerance:
    """Allowed difference between readings and golden readings, for runs that need not be equal bit by bit.

    Fields that are None use the default of the message type.

    Attributes:
        pattern: topic, field (`/imu.linear_acceleration`), or shell pattern of either.
        absolute: absolute tolerance in the field's unit.
        relative: tolerance as a fraction of the golden value.
        share: fraction of the values of one message (rays, points, pixels) that may exceed the tolerance.
        image: mean difference of an image's values, 0 to 255.
        ssim: least structural similarity of images, at most 1.
        statistics: compare mean, deviation and distribution of the noise instead of samples.
        ignore: skip the comparison.
        exact: require equal bits on every machine.
        where: `file:line`, or NOWHERE.
    """

    pattern: str
    absolute: float | None = None
    relative: float | None = None
    share: float | None = None
    image: float | None = None
    ssim: float | None = None
    statistics: bool | None = None
    ignore: bool = False
    exact: bool = False
    where: str = NO_FILE_POSITION


class FinalConditions(Texts):
    """Checks; an option gives conditions that must hold at the end."""

    def from_option(self, value: Sequence[str], option: str) -> tuple[Check, ...]:
        return tuple(Check("final", expression=condition, where=option) for condition in value)
