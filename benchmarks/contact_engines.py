"""The three engines of `contact.py` behind one interface, each with a case's bodies.

Each engine settles, starts the motion, advances, tells the state of the bodies and which of them press on each other.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, Protocol

import mujoco
import numpy as np
import numpy.typing as npt
from contact_cases import GROUND, Case, Pair
from contact_models import mjcf, sdf

import simkit

Floats = npt.NDArray[np.float64]
RESETS = (mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC)


class UnsupportedCaseError(Exception):
    """The engine has no such shape."""


class DivergedError(Exception):
    """The engine's state is no longer finite."""


class Engine(Protocol):
    """One case in one engine.

    Attributes:
        local_rates: whether angular velocities are given in the body's axes instead of the world's.
    """

    local_rates: bool

    def settle(self, count: int) -> None:
        """Do so many steps at rest."""

    def start(self) -> None:
        """Give the bodies their velocities and remember the state."""

    def advance(self, count: int) -> None:
        """Do so many steps, with the case's push."""

    def rewind(self) -> None:
        """Return to the state at `start`."""

    def state(self) -> Floats:
        """Position, quaternion (w, x, y, z), linear and angular velocity of each body, shape (n, 13)."""

    def pressed(self) -> set[Pair]:
        """Pairs of names that pressed on each other in the last step."""

    def has_diverged(self) -> bool:
        """Check whether the engine has given up and begun anew."""

    def close(self) -> None:
        """Release what the engine holds."""


class _MujocoState:
    """The state of the bodies and the contacts, read from a MuJoCo model."""

    local_rates = True

    def __init__(self, case: Case, model: Any, data: Any, name_of: Callable[[str], str]) -> None:
        self.case, self.model, self.data = case, model, data
        bodies = {name_of(model.body(i).name): i for i in range(1, model.nbody)}
        free = [int(model.body_jntadr[bodies[body.name]]) for body in case.moving]
        self._positions = model.jnt_qposadr[free][:, None] + np.arange(7)
        self._rates = model.jnt_dofadr[free][:, None] + np.arange(6)
        names = {number: name for name, number in bodies.items()} | {0: GROUND}
        self._owners = [names[body] for body in model.geom_bodyid.tolist()]
        self._is_pyramid = model.opt.cone == mujoco.mjtCone.mjCONE_PYRAMIDAL

    def state(self) -> Floats:
        return np.concatenate((self.data.qpos[self._positions], self.data.qvel[self._rates]), axis=1)

    def pressed(self) -> set[Pair]:
        found: set[Pair] = set()
        data, owners = self.data, self._owners
        if not data.ncon:
            return found
        contact, force = data.contact, data.efc_force
        columns = (contact.efc_address.tolist(), contact.dim.tolist(), contact.geom.tolist())
        for row, size, (one, other) in zip(*columns, strict=True):
            if row >= 0:
                rows = max(1, 2 * (size - 1)) if self._is_pyramid else 1  # an elliptic cone's first row is the normal
                if force[row : row + rows].any():
                    found.add(frozenset((owners[one], owners[other])))
        return found

    def has_diverged(self) -> bool:
        return any(self.data.warning[kind].number for kind in RESETS)

    def close(self) -> None:
        """Nothing is held."""


class Simkit(_MujocoState):
    """simkit through its Python API."""

    def __init__(self, case: Case, folder: Path) -> None:
        self.sim = simkit.load(sdf(case, folder), resource_paths=[str(folder)])
        super().__init__(case, self.sim.mj_model, self.sim.mj_data, lambda name: name.rsplit("::", 1)[-1])
        if case.vehicle:
            self.link = None
        else:
            self.link = self.sim.link(f"{case.bodies[0].name}::{case.bodies[0].name}")

    def settle(self, count: int) -> None:
        self.sim.step(count)

    def start(self) -> None:
        if self.case.vehicle:
            self.sim.publish("/model/vehicle/cmd_vel", {"angular": {"z": self.case.vehicle.yaw_rate}})
        for body in self.case.bodies:
            if any(body.linear) or any(body.angular):
                self.sim.model(body.name).set_velocity(body.linear, body.angular)
        self._start = self.sim.snapshot()

    def advance(self, count: int) -> None:
        if not self.case.push or self.link is None:
            self.sim.step(count)
            return
        for _ in range(count):
            self.link.apply_wrench(self.case.push)
            self.sim.step(1)

    def rewind(self) -> None:
        self.sim.restore(self._start)

    def close(self) -> None:
        self.sim.close()


class PlainMujoco(_MujocoState):
    """MuJoCo with default options on an equivalent MJCF."""

    def __init__(self, case: Case, folder: Path) -> None:
        model = mujoco.MjModel.from_xml_string(mjcf(case))
        super().__init__(case, model, mujoco.MjData(model), lambda name: name)

    def settle(self, count: int) -> None:
        mujoco.mj_step(self.model, self.data, count)

    def start(self) -> None:
        for body, places, rows in zip(self.case.moving, self._positions, self._rates, strict=True):
            matrix = np.empty(9)
            mujoco.mju_quat2Mat(matrix, self.data.qpos[places[3:]])
            self.data.qvel[rows] = (*body.linear, *(matrix.reshape(3, 3).T @ body.angular))
        if self.case.vehicle:
            vehicle = self.case.vehicle
            rate = vehicle.yaw_rate * vehicle.track / 2 / vehicle.radius
            self.data.ctrl[:] = [rate * (-1 if number % 2 == 0 else 1) for number in range(4)]
        if self.case.push:
            self.data.xfrc_applied[self.model.body(self.case.bodies[0].name).id, :3] = self.case.push
        self._start = np.empty(mujoco.mj_stateSize(self.model, mujoco.mjtState.mjSTATE_INTEGRATION))
        mujoco.mj_getState(self.model, self.data, self._start, mujoco.mjtState.mjSTATE_INTEGRATION)

    def advance(self, count: int) -> None:
        mujoco.mj_step(self.model, self.data, count)

    def rewind(self) -> None:
        mujoco.mj_setState(self.model, self.data, self._start, mujoco.mjtState.mjSTATE_INTEGRATION)


def engines() -> dict[str, Callable[[Case, Path], Engine]]:
    """The engines that are installed, by the name of their column."""
    found: dict[str, Callable[[Case, Path], Engine]] = {"simkit": Simkit, "MuJoCo": PlainMujoco}
    try:
        from contact_pybullet import PyBullet
    except ImportError:
        print("pybullet is not installed (extra `compare`): its column is left out")
    else:
        found["PyBullet"] = PyBullet
    return found
