"""Warning about models that fell out of the world during a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np

from simkit.diagnostics import Diagnostics

if TYPE_CHECKING:
    from simkit.runtime.handles.model import Model
    from simkit.runtime.simulation import Simulation

_FREE_FALL: Final = 0.01
"""Largest relative difference of an acceleration to gravity in free fall."""

_GROUND_HINT: Final = (
    "give the world a ground: <include><uri>model://ground_plane</uri></include>; a model alone has one without "
    "--world none"
)
_COLLISION_HINT: Final = "its links have no <collision>, so that no ground can carry it: add one to the lowest links"
_MESH_HINT: Final = "its collisions are left out, so that no ground can carry it: see the warnings about their meshes"


def find_fallen_models(sim: Simulation) -> Diagnostics:
    """Return a warning for each top-level model that is farther below everything else than the world's extent.

    Everything else are the static collisions; in a world without any, all collisions at their first poses. The time at
    which a model left the ground follows from its velocity if it falls freely. A divergence and a model that
    `StrayBodies` has reported have other causes, so they get no warning here.
    """
    diagnostics = Diagnostics()
    gravity, engine = float(sim.mj_model.opt.gravity[2]), sim.engine
    if not gravity < 0.0 or engine.physics.has_diverged:
        return diagnostics
    lowest, extent = _lowest_height(sim.mj_model), float(sim.mj_model.stat.extent)
    for name, model in sim.models.items():
        height = float(model.pose.position[2])
        is_told = name in engine.stray_bodies.reported
        if model.static or not model.links or is_told or not height < lowest - extent:
            continue
        link = next(iter(model.links.values()))
        velocity, acceleration = float(link.linear_velocity[2]), float(link.linear_acceleration[2])
        is_free = abs(acceleration - gravity) <= _FREE_FALL * -gravity and velocity < 0.0
        since = f", freely since about t = {max(0.0, sim.time - velocity / gravity):.2f} s" if is_free else ""
        diagnostics.warning(
            "SK-SPAWN-007",
            f"{name} fell out of the world{since}: it is at z = {height:.4g} m at t = {sim.time:.2f} s, and everything "
            f"else is above {lowest:.4g} m",
            model.scene.where,
            _hint(sim, model),
        )
    return diagnostics


def _hint(sim: Simulation, model: Model) -> str:
    """Return the remedy for a model that fell: a ground, collisions, or the files of its collisions."""
    links = model.scene.all_links()
    if not any(link.collisions for link in links):
        return _COLLISION_HINT
    return _GROUND_HINT if any(sim.engine.names.links[link.scoped].geoms for link in links) else _MESH_HINT


def _lowest_height(model: mujoco.MjModel) -> float:
    """Return the height [m] of the lowest static collision in the first state, or of the lowest collision if none is.

    A world without collisions has the height 0.
    """
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    collides = (model.geom_contype | model.geom_conaffinity) != 0
    static = collides & (model.body_weldid[model.geom_bodyid] == 0)
    chosen = np.flatnonzero(static if static.any() else collides)
    if not len(chosen):
        return 0.0
    rows = data.geom_xmat[chosen].reshape(-1, 3, 3)[:, 2]  # the vertical axis in the frame of each geom
    centres, halves = model.geom_aabb[chosen, :3], model.geom_aabb[chosen, 3:]
    is_plane = model.geom_type[chosen] == mujoco.mjtGeom.mjGEOM_PLANE
    depths = np.where(is_plane, 0.0, (np.abs(rows) * halves).sum(axis=1) - (rows * centres).sum(axis=1))
    return float((data.geom_xpos[chosen, 2] - depths).min())
