"""Models that pages spawn, move and remove, through the services and calls that scripts use."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from simkit.compiler.standing_models import TOLERANCE, standing_lift
from simkit.pose import Pose

if TYPE_CHECKING:
    from simkit.runtime import Simulation


def spawnable(sim: Simulation) -> dict[str, str]:
    """Return the source of each model that can be spawned by name."""
    return {} if sim.control.list_models is None else sim.control.list_models()


def spawn_standing(sim: Simulation, source: str, name: str | None, x: float, y: float, yaw: float) -> str:
    """Spawn a model that stands on what is below it, and return its name; roll and pitch are those of its file.

    Raises:
        LoadError: the source has errors, or the name is already used.
    """
    own = sim.contents.pose_in_file(source)
    roll, pitch, _ = (float(angle) for angle in own.rpy)
    pose = Pose.from_rpy(x, y, float(own.position[2]), roll, pitch, yaw)
    model = sim.spawn(source, name, pose)
    lift = None if model.static else _lift(sim, model.scoped)
    if lift is not None and abs(lift) > TOLERANCE:
        set_pose(sim, model.scoped, [x, y, float(pose.position[2]) + lift], pose.quaternion.tolist())
    return model.name


def set_pose(sim: Simulation, name: str, position: Sequence[float], quaternion: Sequence[float]) -> bool:
    """Move a model by the world's service; return False if the service refuses."""
    pose = {
        "position": dict(zip("xyz", position, strict=True)),
        "orientation": dict(zip("wxyz", quaternion, strict=True)),
    }
    answer = sim.call(f"/world/{sim.world.name}/set_pose", {"entity": {"name": name}, "pose": pose})
    return bool(answer.success)


def _lift(sim: Simulation, name: str) -> float | None:
    """Return the distance from the pose of a model to the pose on what is below it [m]; None if nothing is there."""
    own = np.zeros(sim.mj_model.ngeom, dtype=bool)
    for link in sim.engine.names.links.values():
        if link.model == name:
            own[[*link.geoms, *link.ray_geoms]] = True
    return standing_lift(sim.mj_model, sim.mj_data, own)
