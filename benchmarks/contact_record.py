"""The recorded motion of a case of `contact.py`, and what is computed of it for several measures.

Forces are not asked of the engines: friction and normal force are what changed a body's velocity in a step. Energies
take the height half way through the step, which makes the engines' integrator exact in free flight; what a soft contact
stores is not counted, so a landing returns some of it.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from contact_engines import DivergedError, Engine
from contact_scene import Case, Shape

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Record:
    """A case's motion in one engine; the first of t + 1 looks is the state at the start.

    Attributes:
        engine: in its last state.
        times: [s], shape (t + 1,).
        positions, linear: of the n bodies, shape (t + 1, n, 3).
        rotations: body to world, shape (t + 1, n, 3, 3).
        angular: velocity in the world's axes, shape (t + 1, n, 3).
        contact: whether the required pairs pressed on each other in each step, shape (t,).
        cpu: processor time of the steps before each look [s], shape (t,).
    """

    case: Case
    engine: Engine
    times: Floats
    positions: Floats
    rotations: Floats
    linear: Floats
    angular: Floats
    contact: npt.NDArray[np.bool_]
    cpu: Floats

    @property
    def rates(self) -> Floats:
        """Angular velocity in the body's axes, shape (t + 1, n, 3)."""
        turned: Floats = np.einsum("tnji,tnj->tni", self.rotations, self.angular)
        return turned

    @property
    def lowest(self) -> Floats:
        """Height of each body's lowest point, shape (t + 1, n)."""
        extents = [extent(body.shape, self.rotations[:, i, 2]) for i, body in enumerate(self.case.moving)]
        heights: Floats = self.positions[..., 2] - np.stack(extents, axis=1)
        return heights

    @property
    def energy(self) -> Floats:
        """Kinetic and potential energy of all bodies [J], less the potential energy at the start."""
        masses = np.array([body.mass for body in self.case.moving])
        inertias = np.array([body.inertia for body in self.case.moving])
        height = self.positions[..., 2] - self.positions[0, :, 2] - self.linear[..., 2] * self.case.timestep / 2
        moving = masses * (self.linear**2).sum(2) + (inertias * self.rates**2).sum(2)
        energy: Floats = (moving / 2 + masses * self.case.gravity * height).sum(1)
        return energy

    @property
    def speeds(self) -> Floats:
        """Speed of each body's centre [m/s], shape (t + 1, n)."""
        found: Floats = np.linalg.norm(self.linear, axis=2)
        return found

    def between(self, first: float, last: float) -> slice:
        """Looks from one time to another [s]."""
        return slice(int(np.searchsorted(self.times, first)), int(np.searchsorted(self.times, last, "right")))

    def step_us(self, first: float, last: float) -> float:
        """Mean processor time of a step between two times [µs]."""
        looks = (self.times[1:] > first) & (self.times[1:] <= last + 1e-9)
        return 1e6 * float(self.cpu[looks].mean()) / self.case.stride


def extent(shape: Shape, down: Floats) -> Floats:
    """Return how far a shape reaches from its centre along directions that are given in its axes, shape (t, 3)."""
    size, down = shape.size, np.abs(down)
    if shape.kind in {"box", "mesh_box"}:
        flat: Floats = (down * size).sum(axis=1)
        return flat
    if shape.kind == "ellipsoid":
        oval: Floats = np.linalg.norm(down * size, axis=1)
        return oval
    if shape.kind == "sphere":
        return np.full(len(down), size[0])
    if shape.kind == "capsule":
        straight: Floats = size[0] + size[1] * down[:, 2]
        return straight
    reach: Floats = size[0] * np.hypot(down[:, 0], down[:, 1]) + size[1] * down[:, 2]
    return reach


def record(engine: Engine, case: Case) -> Record:
    """Settle, start and observe a case in one engine.

    Raises:
        DivergedError: the state is not finite.
    """
    engine.settle(round(case.settle / case.timestep))
    engine.start()
    return observe(engine, case, max(1, round(case.duration / case.timestep / case.stride)))


def observe(engine: Engine, case: Case, looks: int) -> Record:
    """Observe a case from the engine's present state on.

    Raises:
        DivergedError: the state is not finite.
    """
    required = set(case.required)
    states, contact, cpu = [engine.state()], np.zeros(looks, bool), np.zeros(looks)
    for look in range(looks):
        start = time.process_time()
        engine.advance(case.stride)
        cpu[look] = time.process_time() - start
        contact[look] = required <= engine.pressed()
        states.append(engine.state())
    all_states: Floats = np.stack(states)
    if engine.has_diverged() or not np.isfinite(all_states).all():
        raise DivergedError(case.name)
    times = case.timestep * case.stride * np.arange(looks + 1, dtype=np.float64)
    return Record(
        case,
        engine,
        times,
        all_states[..., :3],
        matrices(all_states[..., 3:7]),
        all_states[..., 7:10],
        all_states[..., 10:13],
        contact,
        cpu,
    )


def matrices(quaternions: Floats) -> Floats:
    """Rotation matrices, shape (..., 3, 3), of quaternions w, x, y, z."""
    w, x, y, z = np.moveaxis(quaternions, -1, 0)
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
