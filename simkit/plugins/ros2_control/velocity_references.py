"""References of velocity servos: they move as commanded, but no further than the motors can follow.

A reference that its joint cannot follow would wind up, so it keeps within what the whole effort makes up for. Wheels of
one controller go on together: where one is too weak for the moment (the load lies on its side), the others wait for it,
so that a base is late rather than astray. What is told to stand stands where it comes to rest: it neither goes back to
where it was told to, nor on against a wall; only what its wheels differ by from the motion that was told is made good.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

_ALLOWED_LAG_TIME: Final = 0.02
"""[s] of its way that a joint may lag behind beyond what its effort makes up for; the others stand by then."""

_LARGEST_SAG: Final = 0.05
"""[rad or m] that a load may move a joint by that stands."""

_LARGEST_SLACK: Final = 1e9
"""[rad or m]; of joints whose effort has no limit."""


def advance_references(
    led: Sequence[float],
    speeds: Sequence[float],
    *,
    places: Sequence[float],
    turning: Sequence[float],
    before: Sequence[float],
    slacks: Sequence[float],
    catch_up: Sequence[float],
    groups: Sequence[int],
) -> tuple[list[float], list[float]]:
    """References of velocity servos and how fast they go on; in plain numbers, as a base has a handful of wheels.

    Args:
        led: where the commands have led them [rad or m].
        speeds: commanded from now on [rad/s or m/s].
        places, turning: of the joints now [rad, rad/s or m, m/s].
        before: how fast the references moved up to now [rad/s or m/s].
        slacks: behind its reference by this, a joint gets its whole effort [rad or m].
        catch_up: in which a reference would be caught up with [s].
        groups: number of its controller for each joint; 0 is nobody's.

    Returns:
        References and their speeds.
    """
    ways, lags, rooms, is_free = [], [], [], True
    for k, speed in enumerate(speeds):
        place, slack = places[k], slacks[k]
        slack = slack if slack < _LARGEST_SLACK else _LARGEST_SLACK
        width = _ALLOWED_LAG_TIME * (speed if speed > 0.0 else -speed)
        width = width if width > slack else slack
        most = slack + width
        lag = led[k] - place
        lag = most if lag > most else -most if lag < -most else lag
        lags.append(lag)
        rooms.append((most, width))
        ways.append(place + lag)
        if speed == 0.0 or most - (lag if speed > 0.0 else -lag) < width:
            is_free = False
    if is_free:  # the common case: all move, and can follow
        return ways, list(speeds)
    is_standing = not any(speeds) and not any(before)
    if 0.0 in speeds:
        across = lags if is_standing else _lags_across_motion(lags, before, groups)
        for k, speed in enumerate(speeds):
            if speed == 0.0:
                if before[k] != 0.0:
                    lags[k] = across[k]
                # a load lets it sag no faster than this, so what moves faster has not come to rest
                elif abs(turning[k]) > min(slacks[k], _LARGEST_SAG) / catch_up[k]:
                    lags[k] = 0.0
    ways = [place + lag for place, lag in zip(places, lags, strict=True)]
    return ways, list(speeds) if is_standing else _reduce_to_slowest(speeds, lags, rooms, groups)


def _reduce_to_slowest(
    speeds: Sequence[float], lags: Sequence[float], rooms: Sequence[tuple[float, float]], groups: Sequence[int]
) -> list[float]:
    """The speeds, less what the slowest of each controller's joints cannot follow."""
    parts = []  # of the speed that each may still go on with
    for speed, lag, (most, width) in zip(speeds, lags, rooms, strict=True):
        behind = lag if speed > 0.0 else -lag if speed < 0.0 else 0.0
        parts.append(min(max((most - behind) / max(width, 1e-12), 0.0), 1.0))
    if min(parts, default=1.0) >= 1.0:
        return list(speeds)
    pace = {group: min(p for p, g in zip(parts, groups, strict=True) if g == group) for group in set(groups)}
    return [
        speed * (pace[group] if group > 0 else part) for speed, part, group in zip(speeds, parts, groups, strict=True)
    ]


def _lags_across_motion(lags: Sequence[float], before: Sequence[float], groups: Sequence[int]) -> list[float]:
    """The part of lags that is across the motion of their controller's joints, which is nothing for a joint alone."""
    sums: dict[int, tuple[float, float]] = {}
    for lag, was, group in zip(lags, before, groups, strict=True):
        way, square = sums.get(group, (0.0, 0.0))
        sums[group] = way + lag * was, square + was * was
    along = {group: way / max(square, 1e-300) for group, (way, square) in sums.items()}
    return [
        lag - along[group] * was if group > 0 else 0.0 for lag, was, group in zip(lags, before, groups, strict=True)
    ]
