"""Belts and tracks: links whose surface runs (see `simkit.runtime.surface`)."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from simkit.compiler.friction import has_direction
from simkit.pose import Pose
from simkit.runtime.surface import Belt, Run

if TYPE_CHECKING:
    from simkit.params import Params
    from simkit.runtime import Simulation
    from simkit.scene import SceneLink


def belt_of(
    sim: Simulation,
    link: str,
    track: Pose,
    now: Callable[[], Run | None],
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
    found = sim.names.link(link)
    x, y, z = (found.offset @ track).matrix @ np.array((0.0, 1.0, 0.0))
    return Belt(found.geoms, found.body, (float(x), float(y), float(z)), now, friction)


def needs_direction(link: SceneLink) -> bool:
    """Whether friction differs along and across on a link: then a belt gives it its direction though it stands."""
    return any(has_direction(collision.surface) for collision in link.collisions)


def report_nothing_to_run(link: SceneLink, params: Params) -> None:
    """Warns of a link without collisions: no contact, no belt."""
    if not link.collisions:
        message = f"link {link.name!r} of a track has no <collision>: nothing is carried"
        params.diagnostics.warning("SK-PLUGIN-101", message, params.where, "give it a collision")
