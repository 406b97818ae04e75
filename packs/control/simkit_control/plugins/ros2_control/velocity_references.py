"""References of velocity servos: position targets that move at the commanded velocities.

If a joint cannot follow, the distance between reference and joint would grow without limit (windup). The reference
therefore stays within the distance at which the servo gives its full effort, plus a margin. The wheels of one
controller move together: if one wheel is too weak for a moment, for example under a load on its side of the base, the
other wheels wait for it. The base is then late, but it does not leave its path.

A wheel that is commanded to stop holds the position where it comes to rest. The wheel does not return to the position
where it should have stopped, and it does not push on against a wall. Only differences between the lags of one
controller's wheels are corrected, because such differences change the direction of the base.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

_ALLOWED_LAG_TIME: Final = 0.02
"""Travel time [s] by which the lag may exceed the lag at full effort; then the controller's other joints stop."""

_LARGEST_SAG: Final = 0.05
"""Largest displacement of a stopped joint under load [rad or m]."""

_LARGEST_SLACK: Final = 1e9
"""Largest slack, for joints without effort limit [rad or m]."""


def advance_references(
    references: Sequence[float],
    speeds: Sequence[float],
    *,
    positions: Sequence[float],
    velocities: Sequence[float],
    previous_speeds: Sequence[float],
    slacks: Sequence[float],
    catch_up_times: Sequence[float],
    groups: Sequence[int],
) -> tuple[list[float], list[float]]:
    """Return the new references of velocity servos and their speeds.

    The arguments are sequences of numbers, which are faster than arrays because a base has few wheels.

    Args:
        references: current references, the integrals of the commanded speeds [rad or m].
        speeds: new commanded speeds [rad/s or m/s].
        positions: current positions of the joints [rad or m].
        velocities: current velocities of the joints [rad/s or m/s].
        previous_speeds: speeds of the references in the last period [rad/s or m/s].
        slacks: lag at which the servo gives its full effort [rad or m].
        catch_up_times: time constant with which a joint reduces a lag [s].
        groups: number of the controller of each joint; 0 for an unclaimed joint.

    Returns:
        References and their speeds.
    """
    moved, lags, margins, is_free = [], [], [], True
    for k, speed in enumerate(speeds):
        position, slack = positions[k], slacks[k]
        slack = slack if slack < _LARGEST_SLACK else _LARGEST_SLACK
        width = _ALLOWED_LAG_TIME * (speed if speed > 0.0 else -speed)
        width = width if width > slack else slack
        most = slack + width
        lag = references[k] - position
        lag = most if lag > most else -most if lag < -most else lag
        lags.append(lag)
        margins.append((most, width))
        moved.append(position + lag)
        if speed == 0.0 or most - (lag if speed > 0.0 else -lag) < width:
            is_free = False
    if is_free:  # the common case: all joints move and can follow
        return moved, list(speeds)
    is_stopped = not any(speeds) and not any(previous_speeds)
    if 0.0 in speeds:
        across = lags if is_stopped else _lags_across_motion(lags, previous_speeds, groups)
        for k, speed in enumerate(speeds):
            if speed == 0.0:
                if previous_speeds[k] != 0.0:
                    lags[k] = across[k]
                # under load a stopped joint moves no faster than this, so a faster joint has not stopped yet
                elif abs(velocities[k]) > min(slacks[k], _LARGEST_SAG) / catch_up_times[k]:
                    lags[k] = 0.0
    moved = [position + lag for position, lag in zip(positions, lags, strict=True)]
    return moved, list(speeds) if is_stopped else _reduce_to_slowest(speeds, lags, margins, groups)


def _reduce_to_slowest(
    speeds: Sequence[float], lags: Sequence[float], margins: Sequence[tuple[float, float]], groups: Sequence[int]
) -> list[float]:
    """Return the speeds; all joints of a controller are slowed by the factor of the joint that lags most."""
    shares = []  # for each joint, the fraction of the commanded speed that it can follow
    for speed, lag, (most, width) in zip(speeds, lags, margins, strict=True):
        behind = lag if speed > 0.0 else -lag if speed < 0.0 else 0.0
        shares.append(min(max((most - behind) / max(width, 1e-12), 0.0), 1.0))
    if min(shares, default=1.0) >= 1.0:
        return list(speeds)
    pace = {group: min(p for p, g in zip(shares, groups, strict=True) if g == group) for group in set(groups)}
    return [
        speed * (pace[group] if group > 0 else share)
        for speed, share, group in zip(speeds, shares, groups, strict=True)
    ]


def _lags_across_motion(lags: Sequence[float], previous_speeds: Sequence[float], groups: Sequence[int]) -> list[float]:
    """Return the lags minus the common delay of each controller's joints (delay · speed); 0 for a single joint."""
    sums: dict[int, tuple[float, float]] = {}
    for lag, previous, group in zip(lags, previous_speeds, groups, strict=True):
        product, square = sums.get(group, (0.0, 0.0))
        sums[group] = product + lag * previous, square + previous * previous
    along = {group: product / max(square, 1e-300) for group, (product, square) in sums.items()}
    return [
        lag - along[group] * previous if group > 0 else 0.0
        for lag, previous, group in zip(lags, previous_speeds, groups, strict=True)
    ]
