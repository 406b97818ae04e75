"""Belts and tracks: links whose surface runs, and the odometry of a vehicle from its commanded tracks."""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from simkit.compiler.contact_friction import has_directional_friction
from simkit.plugins.drives.odometry import BodyTwist, DeadReckoning
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
    """The belt of a link in the engine's present model.

    Args:
        sim: the simulation.
        link: its scoped name.
        track: frame of the track in the link: the belt runs along x, round y.
        now: how it runs.
        friction: along and across its way; None where it is as the file has it.
    """
    found = sim.engine.names.link(link)
    x, y, z = (found.offset @ track).matrix @ np.array((0.0, 1.0, 0.0))
    return Belt(found.geoms, found.body, (float(x), float(y), float(z)), now, friction)


def needs_direction(link: SceneLink) -> bool:
    """Whether friction differs along and across on a link: then a belt gives it its direction though it stands."""
    return any(has_directional_friction(collision.surface) for collision in link.collisions)


def report_missing_collisions(link: SceneLink, params: Params) -> None:
    """Warns of a link without collisions: no contact, no belt."""
    if not link.collisions:
        message = f"link {link.name!r} of a track has no <collision>: nothing is carried"
        params.diagnostics.warning("SK-PLUGIN-101", message, params.where, "give it a collision")


class TrackOdometry:
    """Where a vehicle would be if its tracks were wheels that do not slip; begins at zero.

    Args:
        separation: between the tracks [m].
        now: time [ns].
    """

    def __init__(self, separation: float, now: int) -> None:
        self._separation, self._since = separation, now
        self._speeds = (0.0, 0.0)
        self._reckoning = DeadReckoning()

    def drive(self, left: float, right: float, now: int) -> None:
        """From `now` [ns] on the tracks run at these speeds [m/s]."""
        self._reckoning, self._since = self._reckoned(now), now
        self._speeds = left, right

    def at(self, now: int) -> tuple[Pose, BodyTwist]:
        """Pose and twist in the body's axes at `now` [ns]."""
        left, right = self._speeds
        turning = (right - left) / self._separation
        return self._reckoned(now).pose, BodyTwist(((left + right) / 2, 0.0, 0.0), (0.0, 0.0, turning))

    def _reckoned(self, now: int) -> DeadReckoning:
        reckoning, elapsed = copy.copy(self._reckoning), (now - self._since) * 1e-9
        left, right = self._speeds
        reckoning.advance(left * elapsed, right * elapsed, self._separation)
        return reckoning
