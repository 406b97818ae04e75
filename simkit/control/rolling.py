"""How the references of velocity servos go on: as commanded, but no further than the motors can follow.

A reference that its joint cannot follow would wind up, so it keeps within what the whole effort makes up for. Wheels of
one controller go on together: where one is too weak for the moment (the load lies on its side), the others wait for it,
so that a base is late rather than astray. What is told to stand stands where it comes to rest: it neither goes back to
where it was told to, nor on against a wall; only what its wheels differ by from the motion that was told is made good.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.pose import Vector

_WAIT: Final = 0.02
"""[s] of its way that a joint may lag behind beyond what its effort makes up for; the others stand by then."""

_SAG: Final = 0.05
"""[rad or m] that a load may move a joint by that stands."""

_FARTHEST: Final = 1e9
"""[rad or m]; of joints whose effort has no limit."""


def lead(
    led: Vector,
    speed: Vector,
    *,
    place: Vector,
    turning: Vector,
    before: Vector,
    slack: Vector,
    catch_up: Vector,
    groups: npt.NDArray[np.intp],
) -> tuple[Vector, Vector]:
    """References of velocity servos and how fast they go on.

    Args:
        led: where the commands have led them [rad or m].
        speed: commanded from now on [rad/s or m/s].
        place, turning: of the joints now [rad, rad/s or m, m/s].
        before: how fast the references moved up to now [rad/s or m/s].
        slack: behind its reference by this, a joint gets its whole effort [rad or m].
        catch_up: in which a reference would be caught up with [s].
        groups: number of its controller for each joint; 0 is nobody's.

    Returns:
        References and their speeds, each shape (joints,).
    """
    slack = np.minimum(slack, _FARTHEST)
    width = np.maximum(slack, _WAIT * np.abs(speed))
    most = slack + width
    lag = np.minimum(np.maximum(led - place, -most), most)
    # a load lets it sag no faster than this, so what moves faster has not come to rest
    sagging = np.minimum(slack, _SAG) / catch_up
    rests = speed == 0.0
    if rests.all() and not before.any():
        return place + np.where(np.abs(turning) > sagging, 0.0, lag), speed
    if rests.any():
        stops = rests & (before != 0.0)
        if stops.any():
            lag = np.where(stops, _across(lag, before, groups), lag)
        lag = np.where(rests & ~stops & (np.abs(turning) > sagging), 0.0, lag)
    left = (most - lag * np.sign(speed)) / np.maximum(width, 1e-12)  # parts of the speed that it may still go on with
    if (left < 1.0).any():
        pace = np.ones(int(groups.max()) + 1)
        np.minimum.at(pace, groups, np.maximum(left, 0.0))
        speed = speed * np.where(groups > 0, pace[groups], np.minimum(np.maximum(left, 0.0), 1.0))
    return place + lag, speed


def _across(lag: Vector, before: Vector, groups: npt.NDArray[np.intp]) -> Vector:
    """The part of lags that is across the motion of their controller's joints, which is nothing for a joint alone."""
    along = np.bincount(groups, lag * before) / np.maximum(np.bincount(groups, before * before), 1e-300)
    found: Vector = np.where(groups > 0, lag - along[groups] * before, 0.0)
    return found
