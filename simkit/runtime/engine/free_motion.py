"""Accurate integration of mechanisms without damping and of bodies that tumble.

MuJoCo's implicit integrators are of first order. With them, a double pendulum changes its energy by 3 % at a step of
1 ms. A falling chain of 50 links gains energy until it diverges, and a top with 400 rad/s on a ball joint falls over.
An arm with servos or damping is not affected. The kinematic trees without damping are integrated by the Runge-Kutta
method of fourth order, in substeps that follow the fastest joint. This needs a second `MjData` if there are other
trees. Trees without constraint forces do not depend on each other, so all other trees keep their bits.

A contact or a joint limit needs the engine's integrator, so a tree with such a force is left to it in that step. Two
cases are exceptions. A mechanism may have a base that rests on its contacts: a very large armature then holds the base,
and only the joints above it are integrated here. A single body may spin while it touches something: the forces of the
step change its velocities, and `RigidRotation` then moves it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

import mujoco
import numpy as np

from simkit.linear_algebra import squared_length
from simkit.runtime.contact.rigid_rotation import RigidRotation
from simkit.runtime.engine.passive_trees import MAX_SUBSTEP_TURN, JointGroup, PassiveTree, find_passive_trees

MAX_SUBSTEPS: Final = 16

MIN_GYROSCOPIC_ERROR: Final = 1e-4
"""Least error of the engine's integrator at which a body in contact is integrated here, relative to its spin [1/s].

The error is the change of the gyroscopic acceleration within a step. A cylinder that rolls straight ahead has none.
"""

MAX_RESTING_SPEED: Final = 1e-3
"""Largest speed [m/s, rad/s] of a base that rests on its contacts."""

MIN_SPEED_ON_BASE: Final = 0.01
"""Least angular velocity [rad/s] of a mechanism on such a base; slower ones rest, such as a cupboard with a hinge."""

MAX_FLYING_MODELS: Final = 8
"""Largest number of models with collisions whose tumbling is integrated here while they fly.

With more, some fly nearly always in a heap, for a short time: 30 capsules that fall would take a tenth longer. Bodies
that spin in contact are still integrated here, while at most this number of trees moves.
"""

_STATE: Final = int(mujoco.mjtState.mjSTATE_INTEGRATION)
_NO_CONSTRAINTS: Final = int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
_SLEEP: Final = int(mujoco.mjtEnableBit.mjENBL_SLEEP)
_RUNGE_KUTTA: Final = int(mujoco.mjtIntegrator.mjINT_RK4)
_ORDER: Final = 4
_HOLDING_ARMATURE: Final = 1e12  # [kg, kg m²] of the six degrees of freedom of a base that rests

Integrator = Callable[[mujoco.MjModel, mujoco.MjData], None]
"""Function of MuJoCo that integrates over a step."""


class FreeMotionIntegrator:
    """Integrator for the trees of a compiled model that the engine's own integrator does not suit.

    Attributes:
        acts_always: True if every step needs `integrate`; otherwise only steps by the contact law need it, which all
            tumbling bodies have while they fly.
        can_fly: True if a tree is integrated here while it flies.
    """

    def __init__(self, model: mujoco.MjModel, trees: list[PassiveTree], is_crowded: bool = False) -> None:
        self.model, self.trees, self._is_crowded = model, trees, is_crowded
        self._option, self._step = model.opt, float(model.opt.timestep)
        self.acts_always = not all(tree.may_touch for tree in trees)
        self.can_fly = self.acts_always or not is_crowded
        self._data: mujoco.MjData | None = None
        self._state = np.empty(mujoco.mj_stateSize(model, _STATE))
        self._turning = np.concatenate([tree.turning for tree in trees])
        self._first_turning = np.cumsum([0, *(len(tree.turning) for tree in trees[:-1])])
        self._dofs = np.concatenate([np.arange(tree.whole.dofs.start, tree.whole.dofs.stop) for tree in trees])
        self._first_dofs = np.cumsum([0, *(tree.whole.dofs.stop - tree.whole.dofs.start for tree in trees[:-1])])
        self._unloaded, self._indices = [False] * len(trees), list(range(len(trees)))
        self._min_speed = min(tree.min_speed for tree in trees)
        self._can_sleep = bool(model.opt.enableflags & _SLEEP)
        self._count, self._bases, self._touching = 1, list[slice](), list[RigidRotation]()

    @classmethod
    def of(cls, model: mujoco.MjModel) -> FreeMotionIntegrator | None:
        """Return the integrator of a model; None if no tree needs it."""
        trees = [tree for tree in find_passive_trees(model) if tree.substeps <= MAX_SUBSTEPS]
        if len([tree for tree in trees if tree.may_touch]) > MAX_FLYING_MODELS:
            trees = [tree for tree in trees if not tree.may_touch or tree.rotation is not None]
            return cls(model, trees, is_crowded=True) if trees else None
        return cls(model, trees) if trees else None

    def is_needed(self, data: mujoco.MjData) -> bool:
        """Check whether a tree is so fast that it needs this integrator."""
        if self._min_speed < 0.0:
            return True
        return not self._is_slow(data) and bool(np.abs(data.qvel.take(self._turning)).max() > self._min_speed)

    def _is_slow(self, data: mujoco.MjData) -> bool:
        """Check that no joint can be fast, as all of them together are not; the usual case."""
        square = self._min_speed * self._min_speed
        return self._min_speed >= 0.0 and squared_length(data.qvel.take(self._turning), square) <= square

    def is_alone(self) -> bool:
        """Check whether every step integrates all trees of the model here in one substep, as nothing else can act."""
        model, trees = self.model, self.trees
        has_constraints = model.neq or model.ntendon or model.jnt_limited.any()
        are_simple = all(tree.is_short_chain and tree.substeps <= 1 for tree in trees)
        return len(trees) == model.ntree and are_simple and not has_constraints

    def advance(self, data: mujoco.MjData, count: int) -> bool:
        """Make steps in a model for which `is_alone` is True, with the bits of `integrate` and in less time.

        Returns:
            True if the steps were made; False if forces are applied, which `integrate` considers.
        """
        if _are_forces_applied(data):
            return False
        self._count, self._bases = 1, []
        self._runge_kutta(data, count)
        return True

    def integrate(self, model: mujoco.MjModel, data: mujoco.MjData, integrate: Integrator) -> None:
        """Integrate over a step, from data with a complete forward pass.

        Args:
            model: the model.
            data: its data.
            integrate: integrator of the engine, for all other trees.
        """
        moving = self._find_moving(data)
        spinning = [
            (rotation, *motion) for rotation in self._touching if (motion := self._kick_and_drift(data, rotation))
        ]
        if not moving:
            integrate(model, data)
        elif len(moving) == model.ntree and not self._bases:
            end = data.time + self._step
            self._runge_kutta(data, 1, is_fresh=True)
            data.time = end
        else:
            if self._data is None:
                self._data = mujoco.MjData(model)
            scratch = self._data
            mujoco.mj_getState(model, data, self._state, _STATE)
            mujoco.mj_setState(model, scratch, self._state, _STATE)
            self._runge_kutta(scratch, 1)
            integrate(model, data)
            for dofs, at in moving:
                velocities, positions = scratch.qvel[dofs], scratch.qpos[at]
                if all(map(math.isfinite, velocities.tolist() + positions.tolist())):
                    data.qvel[dofs], data.qpos[at] = velocities, positions
        for rotation, position, velocity in spinning:
            data.qpos[rotation.coordinates], data.qvel[rotation.dofs] = position, velocity

    def _kick_and_drift(self, data: mujoco.MjData, rotation: RigidRotation) -> tuple[list[float], list[float]] | None:
        """Return coordinates and velocities of a body in contact after the step; None if the engine integrates it."""
        step, position = self._step, data.qpos[rotation.coordinates].tolist()
        velocity, acceleration = data.qvel[rotation.dofs].tolist(), data.qacc[rotation.dofs].tolist()
        spin, gyroscopic = velocity[3:], rotation.gyroscopic_acceleration(position[3:], velocity[3:])
        error = step * math.hypot(*rotation.gyroscopic_rate(spin, acceleration[3:]))
        if not (error > MIN_GYROSCOPIC_ERROR * math.hypot(*spin) and rotation.is_resolved(spin, step)):
            return None
        kicked = [v + step * (a - g) for v, a, g in zip(velocity, acceleration, gyroscopic, strict=True)]
        if not all(map(math.isfinite, kicked)):
            return None
        return rotation.moved(position, kicked, step)

    def _find_moving(self, data: mujoco.MjData) -> list[JointGroup]:
        """Return the joints to integrate in this step; set the substeps, the bases to hold and the touching bodies."""
        self._touching = []
        if self._is_slow(data):
            return []
        step = self._step
        speeds = np.maximum.reduceat(np.abs(data.qvel.take(self._turning)), self._first_turning)
        has_heap, indices = False, self._indices
        if self._is_crowded:
            has_heap = bool(np.count_nonzero(speeds) > MAX_FLYING_MODELS)
            if has_heap and not self.acts_always:
                return []
            indices = np.flatnonzero(speeds > self._min_speed).tolist()
        forces, loaded = data.qfrc_constraint, self._unloaded
        if data.nefc and np.count_nonzero(forces.take(self._dofs)):
            loaded = np.logical_or.reduceat(forces.take(self._dofs) != 0.0, self._first_dofs).tolist()
        asleep = data.tree_asleep.tolist() if self._can_sleep else None
        is_pushed = _are_forces_applied(data)
        moving, count, self._bases = [], 1, []
        for index in indices:
            tree, speed, is_loaded = self.trees[index], speeds.item(index), loaded[index]
            if not tree.min_speed < speed < math.inf or (asleep is not None and asleep[tree.number] >= 0):
                continue
            if is_loaded and tree.rotation is not None:
                if not has_heap:
                    self._touching.append(tree.rotation)
                continue
            if tree.may_touch and self._is_crowded:
                continue
            if is_pushed and not tree.needs_accuracy and self._is_pushed(data, tree):
                continue
            if not is_loaded:
                moving.append(tree.whole)
            elif tree.base is not None and speed > MIN_SPEED_ON_BASE and not forces[tree.mechanism.dofs].any():
                if np.abs(data.qvel[tree.base]).max() > MAX_RESTING_SPEED:
                    continue
                moving.append(tree.mechanism)
                self._bases.append(tree.base)
            else:
                continue
            turn = 0.0 if tree.is_short_chain else speed * step
            count = max(count, tree.substeps, math.ceil(turn / MAX_SUBSTEP_TURN))
        self._count = min(MAX_SUBSTEPS, count)
        return moving

    @staticmethod
    def _is_pushed(data: mujoco.MjData, tree: PassiveTree) -> bool:
        """Check whether a force is applied to a tree.

        Such forces are constant during a step. Springs and drives that plugins compute in this way, such as buoyancy,
        keep their energy with the engine's integrator only.
        """
        return bool(data.qfrc_applied[tree.whole.dofs].any() or data.xfrc_applied[tree.bodies].any())

    def _runge_kutta(self, data: mujoco.MjData, steps: int, *, is_fresh: bool = False) -> None:
        """Advance data by steps without constraints, in substeps.

        Args:
            data: data of the model.
            steps: number of steps.
            is_fresh: True for data with a forward pass.
        """
        model, option, count = self.model, self._option, self._count
        step, integrator = self._step, option.integrator
        disabled, enabled = option.disableflags, option.enableflags
        armatures = [model.dof_armature[base].copy() for base in self._bases]
        option.timestep, option.integrator = step / count, _RUNGE_KUTTA
        option.disableflags, option.enableflags = disabled | _NO_CONSTRAINTS, enabled & ~_SLEEP
        try:
            for base in self._bases:
                model.dof_armature[base] = _HOLDING_ARMATURE
            if is_fresh:
                mujoco.mj_RungeKutta(model, data, _ORDER)
            if count * steps > is_fresh:
                mujoco.mj_step(model, data, count * steps - is_fresh)
        finally:
            for base, armature in zip(self._bases, armatures, strict=True):
                model.dof_armature[base] = armature
            option.timestep, option.integrator = step, integrator
            option.disableflags, option.enableflags = disabled, enabled


def _are_forces_applied(data: mujoco.MjData) -> bool:
    """Check whether forces are applied to joints or bodies; counting takes a quarter of the time of `any`."""
    return bool(np.count_nonzero(data.qfrc_applied) or np.count_nonzero(data.xfrc_applied))
