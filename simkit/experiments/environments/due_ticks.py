"""Ticks at which the parts of a batch are due; a grid of None means every step."""

from __future__ import annotations

from typing import Final

from simkit.plugins.drives.odometry import WheelOdometry
from simkit.runtime.engine.simulated_time import TickGrid

Grid = TickGrid | None

NEVER: Final = 1 << 62

_STRIDE: Final = WheelOdometry.stride
_WINDOW: Final = WheelOdometry.mean_steps


def next_due(grid: Grid, tick: int) -> int:
    """Return the first due tick after a tick."""
    return tick + 1 if grid is None else grid.next(tick)


def is_due(grid: Grid, tick: int) -> bool:
    """Check whether a tick is due; a grid is not due at the start."""
    return grid is None or (tick > 0 and grid.next(tick - 1) == tick)


def last_due(grid: Grid, tick: int) -> int:
    """Return the last due tick up to a tick; 0 if there is none."""
    return tick if grid is None else grid.tick(grid.index(tick))


def next_odometry_tick(grid: Grid, tick: int) -> int:
    """Return the first tick after a tick at which the odometry from wheels needs their angles.

    These ticks are those of the messages, those at the start of the mean twist of a message, and those between two
    arcs of the pose.

    Args:
        grid: ticks of the messages.
        tick: present tick.
    """
    if grid is None:
        return tick + 1
    since = (tick - last_due(grid, tick)) % _STRIDE
    return min(grid.next(tick), grid.next(tick + _WINDOW) - _WINDOW, tick + _STRIDE - since)
