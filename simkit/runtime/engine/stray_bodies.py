"""Warnings about free bodies that leave their world: too fast, or too far away."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import matmul, norm, squared_length
from simkit.runtime.engine.plugin_faults import explanations

if TYPE_CHECKING:
    from simkit.compiler.name_map import LinkBinding
    from simkit.runtime.engine.engine_state import EngineState

RATE: Final = 10.0
"""Rate at which bodies are checked [Hz], that of `sleep`, so that a run needs no further stops."""

FASTEST: Final = 100.0
"""Speed [m/s] above which a body outside of its world is reported."""

FARTHEST: Final = 1000.0
"""Distance from the world [m] above which a body is reported."""

_LEAST_GYRATION: Final = 0.01
"""Least radius of gyration of the largest moment, relative to the radius of a body, that is not named as the cause."""

_GROUND_HINT: Final = "give the world a ground below it: <include><uri>model://ground_plane</uri></include>"
_COLLISION_HINT: Final = "its links have no <collision>, so that no ground can carry it: add one to the lowest links"

Floats = npt.NDArray[np.float64]


class StrayBodies:
    """Check of all free bodies for their speed and distance; each is reported once.

    The check reads positions and velocities and changes nothing.

    Args:
        engine: engine of the simulation.

    Attributes:
        reported: scoped names of the top-level models whose bodies were reported.
    """

    def __init__(self, engine: EngineState) -> None:
        self._engine = engine
        self.reported: set[str] = set()
        self._known: set[str] = set()
        self._model: mujoco.MjModel | None = None
        self._links: list[LinkBinding] = []
        self._coordinates = self._dofs = np.zeros((0, 3), dtype=np.intp)
        self._starts = np.zeros((0, 3))
        self._bounds: WorldBounds | None = None

    def look(self, _tick: int = 0) -> None:
        """Report the bodies that are outside of the world and too fast, or too far away."""
        physics = self._engine.physics
        if physics.sleep.rests:
            return
        if physics.model is not self._model:
            self._take_model(physics.model)
        if not self._links:
            return
        data = physics.data
        ways, speeds = data.qpos.take(self._coordinates) - self._starts, data.qvel.take(self._dofs)
        if squared_length(ways, FARTHEST**2) < FARTHEST**2 and squared_length(speeds, FASTEST**2) < FASTEST**2:
            return  # all together are neither far nor fast
        far = np.einsum("ij,ij->i", ways, ways) > FARTHEST**2  # nothing else can be far from the world
        suspects = far | (np.einsum("ij,ij->i", speeds, speeds) > FASTEST**2)
        if suspects.any():
            for i in np.flatnonzero(suspects).tolist():
                if self._links[i].scoped not in self._known:
                    self._judge(self._links[i], self._starts[i] + ways[i], speeds[i])

    def _take_model(self, model: mujoco.MjModel) -> None:
        links = self._engine.names.links.values()
        self._model, self._bounds = model, None
        self._links = [link for link in links if link.root_joint_qpos >= 0 and link.mocap < 0]
        axes = np.arange(3)
        self._coordinates = np.array([link.root_joint_qpos + axes for link in self._links], np.intp).reshape(-1, 3)
        self._dofs = np.array([link.root_joint_dof + axes for link in self._links], np.intp).reshape(-1, 3)
        self._starts = model.qpos0.take(self._coordinates)

    def _judge(self, link: LinkBinding, place: Floats, velocity: Floats) -> None:
        engine, model = self._engine, self._engine.physics.model
        if not (np.isfinite(place).all() and np.isfinite(velocity).all()):
            return  # a divergence has its own report
        if self._bounds is None:
            self._bounds = WorldBounds(model, self._starts)
        speed, distance = norm(velocity), self._bounds.distance(place)
        is_fast = speed > FASTEST and distance > 0.0
        if not (is_fast or (distance > FARTHEST and not self._bounds.is_over_ground(place))):
            return
        self._known.add(link.scoped)
        self.reported.add(link.model)
        cause, hint = self._cause(link, velocity)
        text = (
            f"{link.scoped} leaves the world: at t = {engine.time:.2f} s it is {distance:.4g} m away from everything, "
            f"with {speed:.4g} m/s; {cause}"
        )
        engine.reports.warning("SK-PHYS-032", text, link.scene.where, hint)

    def _cause(self, link: LinkBinding, velocity: Floats) -> tuple[str, str]:
        """Return the likely cause and a remedy."""
        engine, model = self._engine, self._engine.physics.model
        speed, gravity = norm(velocity), np.array(model.opt.gravity)
        pull = norm(gravity)
        if pull > 0.0 and speed <= pull * engine.time and float(matmul(velocity, gravity)) > 0.99 * speed * pull:
            since = engine.time - speed / pull
            links = [other for other in engine.names.links.values() if other.model == link.model]
            hint = _GROUND_HINT if any(other.geoms for other in links) else _COLLISION_HINT
            return f"it falls freely since about t = {since:.2f} s", hint
        if moments := _too_small_moments(model, link.body):
            text = f"the likely cause are its moments of inertia, {moments}, which are too small for its size"
            return text, "give the link the moments of a body of its size"
        if any(d.code == "SK-PHYS-024" and f"{link.scoped}::" in d.message for d in engine.reports):
            return "the likely cause is that it began inside another body", "move it out of the other body"
        told = [*engine.callbacks.large_commands(), *explanations(list(engine.structure.all_plugins()), link.model)]
        if told:
            return f"the likely cause is a command: {told[0]}", "limit the command, or the velocity of the joints"
        text = "the likely cause is a hit, a force or a joint limit that is too stiff for the step"
        return text, f"try a <max_step_size> below {engine.clock.timestep:g}"


def _too_small_moments(model: mujoco.MjModel, body: int) -> str:
    """Return the principal moments of a body if they are too small for its geoms; else an empty text."""
    geoms = np.flatnonzero(model.geom_bodyid == body)
    radius = float(model.geom_rbound[geoms].max(initial=0.0))
    moments, mass = model.body_inertia[body], float(model.body_mass[body])
    if not math.isfinite(radius) or mass <= 0.0 or float(moments.max()) >= mass * (_LEAST_GYRATION * radius) ** 2:
        return ""
    return "(" + ", ".join(f"{value:.3g}" for value in sorted(moments.tolist())) + ") kg m2"


class WorldBounds:
    """Box around all static collisions and the first positions of free bodies, and the infinite static planes.

    Args:
        model: compiled model.
        starts: first positions of the free bodies [m], shape (n, 3).
    """

    def __init__(self, model: mujoco.MjModel, starts: Floats) -> None:
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        static = ((model.geom_contype | model.geom_conaffinity) != 0) & (model.body_weldid[model.geom_bodyid] == 0)
        is_plane = model.geom_type == int(mujoco.mjtGeom.mjGEOM_PLANE)
        solid, planes = np.flatnonzero(static & ~is_plane), np.flatnonzero(static & is_plane)
        turns = data.geom_xmat[solid].reshape(-1, 3, 3)
        centres = data.geom_xpos[solid] + np.einsum("gij,gj->gi", turns, model.geom_aabb[solid, :3])
        halves = np.einsum("gij,gj->gi", np.abs(turns), model.geom_aabb[solid, 3:])
        points = np.concatenate((centres - halves, centres + halves, starts))
        self._low, self._high = points.min(axis=0), points.max(axis=0)
        self._planes = [(data.geom_xpos[g].copy(), data.geom_xmat[g, 2::3].copy()) for g in planes.tolist()]

    def distance(self, place: Floats) -> float:
        """Return the distance of a place from the box [m]; 0 inside."""
        return norm(np.maximum(0.0, np.maximum(self._low - place, place - self._high)))

    def is_over_ground(self, place: Floats) -> bool:
        """Check whether a place is above a plane by at most `FARTHEST`."""
        return any(0.0 <= float(matmul(place - at, normal)) <= FARTHEST for at, normal in self._planes)
