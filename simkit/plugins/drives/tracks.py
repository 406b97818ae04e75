"""Belts and tracks: links whose surface moves, and the odometry of tracked vehicles."""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from simkit.compiler.contact_friction import has_directional_friction
from simkit.linear_algebra import matmul
from simkit.plugins.drives.odometry import DeadReckoning, base_motion
from simkit.plugins.drives.odometry_messages import BodyTwist
from simkit.pose import Pose
from simkit.runtime.contact.moving_surface import Belt, BeltMotion

if TYPE_CHECKING:
    from simkit.params import Params
    from simkit.runtime import Simulation
    from simkit.scene import SceneLink


def belt_of(
    sim: Simulation,
    link: str,
    track: Pose,
    now: Callable[[], BeltMotion | None],
    friction: tuple[float, float] | None = None,
) -> Belt:
    """Return the belt of a link in the current compiled model.

    Args:
        sim: Simulation of the link.
        link: Scoped name of the link.
        track: Pose of the track's frame in the link; the belt moves along the x axis and turns about the y axis.
        now: Callback that returns the current motion of the belt.
        friction: Coefficients along and across the belt; None to use the values of the file.
    """
    named = sim.engine.names.link(link)
    x, y, z = matmul((named.offset @ track).matrix, np.array((0.0, 1.0, 0.0)))
    return Belt(named.geoms, named.body, (float(x), float(y), float(z)), now, friction)


def needs_direction(link: SceneLink) -> bool:
    """Check whether a link's friction depends on direction; then also a stopped belt must define the directions."""
    return any(has_directional_friction(collision.surface) for collision in link.collisions)


def report_missing_collisions(link: SceneLink, params: Params) -> None:
    """Warn if a track link has no collisions, because a belt acts only through contacts."""
    if not link.collisions:
        message = f"link {link.name!r} of a track has no <collision>: the track moves nothing"
        params.diagnostics.warning("SK-PLUGIN-101", message, params.where, "add a <collision> to the link")


class TrackOdometry:
    """Odometry of a tracked vehicle from its commanded track speeds, without slip; the initial pose is zero.

    Args:
        separation: Distance between the tracks [m].
        now: Current time [ns].
    """

    def __init__(self, separation: float, now: int) -> None:
        self._separation, self._since = separation, now
        self._speeds = (0.0, 0.0)
        self._reckoning = DeadReckoning()

    def drive(self, left: float, right: float, now: int) -> None:
        """Set the speeds of both tracks [m/s] from time `now` [ns] on."""
        self._reckoning, self._since = self._reckoned(now), now
        self._speeds = left, right

    def at(self, now: int) -> tuple[Pose, BodyTwist]:
        """Return the vehicle's pose, and its twist in its own axes, at time `now` [ns]."""
        left, right = self._speeds
        ahead, _, turning = base_motion(left, right, self._separation)
        return self._reckoned(now).pose, BodyTwist((ahead, 0.0, 0.0), (0.0, 0.0, turning))

    def _reckoned(self, now: int) -> DeadReckoning:
        reckoning, elapsed = copy.copy(self._reckoning), (now - self._since) * 1e-9
        left, right = self._speeds
        reckoning.advance(left * elapsed, right * elapsed, self._separation)
        return reckoning
