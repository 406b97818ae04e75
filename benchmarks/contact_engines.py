"""The engines of `contact.py` behind one interface, each with a case's bodies.

Each engine settles, starts the motion, advances, tells the state of the bodies and which of them press on each other.
"""

from __future__ import annotations

import importlib
import math
from collections.abc import Callable, Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Protocol

import mujoco
import numpy as np
import numpy.typing as npt
from contact_scene import GROUND, Case, Pair, Vector
from contact_sdf import MECHANISM, sdf

import simkit
from simkit.pose import Pose

Floats = npt.NDArray[np.float64]
RESETS = (mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC)
LAW = "MuJoCo's law"
MODULES = {"PyBullet": "contact_pybullet", "Drake": "contact_drake", "DART": "contact_dart"}
PACKAGES = {"simkit": "simkit-robotics", LAW: "mujoco", "PyBullet": "pybullet", "Drake": "drake", "DART": "dartpy"}


class UnsupportedCaseError(Exception):
    """The engine has no such shape or joint."""


class DivergedError(Exception):
    """The engine's state is no longer finite."""


class Engine(Protocol):
    """One case in one engine."""

    def settle(self, count: int) -> None:
        """Do so many steps at rest."""

    def start(self) -> None:
        """Give the bodies their velocities and remember the state."""

    def advance(self, count: int) -> None:
        """Do so many steps, with the case's push."""

    def rewind(self) -> None:
        """Return to the state at `start`."""

    def state(self) -> Floats:
        """Position, quaternion (w, x, y, z), linear and angular velocity (world) of each body, shape (n, 13)."""

    def pressed(self) -> set[Pair]:
        """Pairs of names that pressed on each other in the last step; empty where the engine does not tell."""

    def asleep(self) -> float:
        """Share of the bodies that sleep, NaN where the engine is not asked to let them sleep [%]."""

    def has_diverged(self) -> bool:
        """Check whether the engine has given up and begun anew."""

    def close(self) -> None:
        """Release what the engine holds."""


class Simkit:
    """simkit through its Python API."""

    law = "simkit"

    def __init__(self, case: Case, folder: Path) -> None:
        self.case = case
        law = [f"physics.contact_law={self.law}"]
        self.sim = simkit.load(sdf(case, folder), resource_paths=[str(folder)], overrides=law)
        self.model, self.data = self.sim.mj_model, self.sim.mj_data
        self._derived = mujoco.MjData(self.model)  # poses of the present state, which the engine's own data lack
        bodies = {self.model.body(i).name.rsplit("::", 1)[-1]: i for i in range(1, self.model.nbody)}
        self._bodies = [bodies[body.name] for body in case.moving]
        self._roots = self.model.body_rootid[self._bodies]
        names = {number: name for name, number in bodies.items()} | {0: GROUND}
        self._owners = [names[body] for body in self.model.geom_bodyid.tolist()]
        pushed = case.bodies[0].name if case.push else ""
        self._pushed = self.sim.link(f"{pushed}::{pushed}") if pushed else None

    def settle(self, count: int) -> None:
        self.sim.step(count)

    def start(self) -> None:
        if self.case.vehicle:
            self.sim.publish("/model/vehicle/cmd_vel", {"angular": {"z": self.case.vehicle.yaw_rate}})
        for hinge in self.case.hinges:
            if hinge.rate:
                self.sim.joint(f"{MECHANISM}::{hinge.child}_joint").set_velocity(hinge.rate)
        for body in self.case.bodies:
            if any(body.linear) or any(body.angular):
                self.sim.model(body.name).set_velocity(body.linear, body.angular)
        self._start = self.sim.snapshot()

    def advance(self, count: int) -> None:
        if self._pushed is None or self.case.push is None:
            self.sim.step(count)
            return
        for _ in range(count):
            self._pushed.apply_wrench(self.case.push)
            self.sim.step(1)

    def rewind(self) -> None:
        self.sim.restore(self._start)

    def state(self) -> Floats:
        model, data, bodies = self.model, self._derived, self._bodies
        data.qpos[:], data.qvel[:] = self.data.qpos, self.data.qvel
        for stage in (mujoco.mj_kinematics, mujoco.mj_comPos, mujoco.mj_comVel):
            stage(model, data)
        position, twist = data.xpos[bodies], data.cvel[bodies]
        angular = twist[:, :3]
        linear = twist[:, 3:] + np.cross(angular, position - data.subtree_com[self._roots])
        return np.concatenate((position, data.xquat[bodies], linear, angular), axis=1)

    def pressed(self) -> set[Pair]:
        data, owners = self.data, self._owners
        if not data.ncon:
            return set()
        contact, force = data.contact, data.efc_force
        columns = zip(contact.efc_address.tolist(), contact.geom.tolist(), strict=True)
        return {frozenset((owners[one], owners[other])) for row, (one, other) in columns if row >= 0 and force[row]}

    def asleep(self) -> float:
        return 100.0 * float((self.data.tree_asleep >= 0).mean())

    def has_diverged(self) -> bool:
        return any(self.data.warning[kind].number for kind in RESETS)

    def close(self) -> None:
        self.sim.close()


class MujocoLaw(Simkit):
    """simkit with MuJoCo's own contacts and integration (`--set physics.contact_law=mujoco`)."""

    law = "mujoco"


def engines(wanted: Sequence[str] = ()) -> dict[str, Callable[[Case, Path], Engine]]:
    """The engines that are installed, by the name of their column."""
    found: dict[str, Callable[[Case, Path], Engine]] = {"simkit": Simkit, LAW: MujocoLaw}
    for name, module in MODULES.items():
        if wanted and name not in wanted:
            continue
        try:
            found[name] = getattr(importlib.import_module(module), name)
        except ImportError:
            print(f"{PACKAGES[name]} is not installed (extra `compare`): {name} is left out")
    return {name: maker for name, maker in found.items() if not wanted or name in wanted}


def versions(names: Sequence[str]) -> dict[str, str]:
    """Version of each engine that runs."""
    found = {}
    for name in names:
        try:
            found[name] = simkit.__version__ if name == "simkit" else version(PACKAGES[name])
        except PackageNotFoundError:
            found[name] = "?"
    return found


def quaternion(rpy: Vector) -> tuple[float, float, float, float]:
    """Quaternion w, x, y, z of roll, pitch and yaw."""
    w, x, y, z = Pose.from_rpy(0, 0, 0, *rpy).quaternion.tolist()
    return w, x, y, z


def check_supported(case: Case, kinds: set[str], name: str) -> None:
    """Check that an engine with free bodies on a plane can run a case.

    Raises:
        UnsupportedCaseError: the case has other shapes, grounds or joints.
    """
    shapes = {body.shape.kind for body in (*case.bodies, *case.blocks)}
    has_bounce = case.restitution is not None
    if case.vehicle or case.hinges or case.push or has_bounce or case.ground not in {"plane", "none"} or shapes - kinds:
        raise UnsupportedCaseError(name)


NOT_ASKED = math.nan
