"""Link of a robot by the name of its frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from simkit import Link, Simulation


def links_of_frame(sim: Simulation, frame: str) -> list[Link]:
    """Return the links whose frame has a name.

    Args:
        sim: simulation.
        frame: name of a link, or `MODEL/LINK` for the link of one model.
    """
    robot, _, name = frame.rpartition("/")
    candidates = [model for model in sim.models.values() if robot in ("", model.name)]
    return [model.links[name] for model in candidates if name in model.links]
