"""Steering of a slotcar along the waypoints of a path, as in rmf_robot_sim_common."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from simkit.pose import wrap_angle

Point = tuple[float, float]

_NEAR: Final = 1e-3  # distance at which the direction to a point has no meaning [m]


@dataclass(frozen=True, slots=True)
class Displacement:
    """Motion that is left to do.

    Attributes:
        ahead: distance along the heading [m]; negative for driving backwards.
        turn: angle [rad].
        cruise: speed of the way [m/s].
        final: speed at the end of the way [m/s].
        limit: largest speed [m/s]; infinite for the robot's own.
    """

    ahead: float = 0.0
    turn: float = 0.0
    cruise: float = 0.0
    final: float = 0.0
    limit: float = math.inf


def turn_towards(heading: float, direction: Point) -> float:
    """Return the angle [rad] from a heading [rad] to a direction; zero for a direction of no length.

    The source uses the arc sine of the cross product, which turns robots away from points straight behind them.
    """
    if math.hypot(*direction) < _NEAR:
        return 0.0
    return wrap_angle(math.atan2(direction[1], direction[0]) - heading)


def lookahead_point(start: Point, end: Point, place: Point, distance: float) -> Point:
    """Return the point of a straight way that a steered robot drives to.

    This is the point at `distance` [m] from the place of the robot that is nearer to the end, or without such a point
    the nearest one.
    """
    along = (end[0] - start[0], end[1] - start[1])
    length = math.hypot(*along)
    if length < _NEAR:
        return end
    x, y = along[0] / length, along[1] / length
    offset = (place[0] - start[0], place[1] - start[1])
    nearest, aside = offset[0] * x + offset[1] * y, offset[1] * x - offset[0] * y
    if abs(aside) < distance:
        reach = math.sqrt(distance * distance - aside * aside)
        way = min(nearest - reach, nearest + reach, key=lambda s: abs(length - s))
    else:
        way = min(max(nearest, 0.0), length)
    return start[0] + way * x, start[1] + way * y
