"""Belts and tracks: surfaces that move while the body that they belong to does not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

Point = tuple[float, float, float]

ZERO_VECTOR: Point = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class BeltMotion:
    """How a belt runs now.

    Attributes:
        speed: [m/s]; a positive one carries what lies on top along x, where x, the axle and up are right-handed.
        centre: of the circle, in the world, that its contacts are carried along [m]; None where it runs straight.
    """

    speed: float
    centre: Point | None = None


@dataclass(frozen=True, slots=True)
class Belt:
    """A surface that can run, in one compiled model.

    Attributes:
        geoms: ids of its geoms.
        body: that they move with.
        axle: unit vector in the body's frame that the belt runs round.
        now: asked in every forward pass, so that it is part of its plugin's state; None while it stands still.
        friction: coefficients along and across its way; None where they are those of the file.
    """

    geoms: tuple[int, ...]
    body: int
    axle: Point
    now: Callable[[], BeltMotion | None]
    friction: tuple[float, float] | None = None
