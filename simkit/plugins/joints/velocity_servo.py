"""Efforts that bring joints to commanded velocities within one step."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np

from simkit.linear_algebra import inverse, matmul, solve
from simkit.params import LARGEST
from simkit.plugins.joints.joint_axis import JointAxis
from simkit.plugins.joints.kinematic_trees import Keys, KinematicTrees
from simkit.pose import Vector
from simkit.runtime.engine.physics_step import CONTROL

if TYPE_CHECKING:
    from simkit.plugins.joints.kinematic_trees import Flags
    from simkit.runtime import Simulation

_ENOUGH: Final = 3e-6
"""Largest velocity error that needs no correction, relative to 1 + the commanded velocity [rad/s or m/s]."""

_CLOSE: Final = 1e-5
"""Largest velocity error after a correction that is left to the next step, relative to the same number."""

_FAR: Final = 0.1
"""Largest velocity error, relative to the same number, for which the search starts from the last efforts.

With larger errors the search starts from zero effort.
"""

_ROUNDS: Final = 6
"""Largest number of corrections in one step; each costs a forward pass."""


@dataclass(slots=True)
class VelocityServo:
    """Solver of joint efforts for commanded velocities. The result of the last step is the start of the next search.

    Attributes:
        keys: Joints of the last step.
        efforts: Efforts of these joints in the last step (n,).
        learnt: Estimated effort per acceleration of the joints of each kinematic tree (trees, slots, slots).
        is_learnt: True for trees that have such an estimate (trees,).
        is_done: True if the last search left a small error that it could not reduce; the next one waits until the
            error has grown. Wheels that push against each other would otherwise be searched in vain at every step.
    """

    keys: Keys = ()
    efforts: Vector = field(default_factory=lambda: np.zeros(0))
    learnt: Vector = field(default_factory=lambda: np.zeros((0, 0, 0)))
    is_learnt: Flags = field(default_factory=lambda: np.zeros(0, bool))
    is_done: bool = False

    def drive(
        self,
        sim: Simulation,
        axes: Sequence[JointAxis],
        velocities: Sequence[float],
        layouts: dict[tuple[int, ...], KinematicTrees],
    ) -> None:
        """Set the efforts of the next step for the commanded velocities, within the joints' limits.

        A target beyond a position limit ends at the limit. If no efforts reach the velocities, the efforts with the
        smallest error are set.

        Args:
            sim: Simulation of the joints.
            axes: Driven axes; if a joint has two commands, the last one counts.
            velocities: Commanded velocity of each axis [rad/s or m/s].
            layouts: Cache owned by the caller, valid for one compiled model.
        """
        axes_key = tuple(map(id, axes))
        layout = layouts.get(axes_key)
        if layout is None or not layout.fits(sim.mj_model):
            layout = layouts[axes_key] = KinematicTrees.of(sim.mj_model, axes)
        if self.keys != layout.keys:
            self._begin(layout)
        trial = _EffortEvaluation(sim, layout, velocities)
        best = _between(self.efforts, trial.lowest, trial.highest)
        missing = trial.missing(best)
        least = trial.relevant_error(missing, best)
        is_far = (least > (_CLOSE * trial.scale if self.is_done else 0.0)).any()
        self.efforts = self._search(trial, best, missing) if is_far else best

    def _begin(self, layout: KinematicTrees) -> None:
        """Switch to the joints of another layout; joints that were already driven keep their efforts."""
        efforts = dict(zip(self.keys, self.efforts.tolist(), strict=True))
        self.keys, self.efforts = layout.keys, np.array([efforts.get(key, 0.0) for key in layout.keys])
        self.is_done = False
        trees, slots = layout.is_used.shape
        self.learnt, self.is_learnt = np.zeros((trees, slots, slots)), np.zeros(trees, bool)

    def _search(self, trial: _EffortEvaluation, best: Vector, missing: Vector) -> Vector:
        """Find and apply efforts with a smaller velocity error than `best`, whose error is `missing`."""
        layout, close = trial.layout, _CLOSE * trial.scale
        free = trial.free_inertia()
        trial.bound(free, best)
        least, last = trial.relevant_error(missing, best), best
        far = layout.any_of_tree(least > _FAR * trial.scale)
        if far.any():  # restart these trees from zero effort, without the learnt estimate
            last = np.where(far[layout.tree], 0.0, best)
            self.is_learnt &= ~far
            best, missing, least, _ = _better_efforts(layout, (best, missing, least), trial.evaluate(last))
        self.learnt = np.where(self.is_learnt[:, None, None], self.learnt, free)
        failures = 0
        for round_ in range(_ROUNDS):
            if not (least > close if round_ else least).any() or failures > 1:
                break
            lacks = layout.any_of_tree(least > 0.0)
            self.is_learnt |= lacks
            pushed = np.where(lacks[layout.tree], layout.times(self.learnt, missing / trial.step), 0.0)
            last = _between(best + pushed, trial.lowest, trial.highest)
            result = trial.evaluate(last)
            self._learn(layout, free, last - best, (missing - result[1]) / trial.step)
            best, missing, least, is_better = _better_efforts(layout, (best, missing, least), result)
            failures = 0 if is_better else failures + 1
        self.is_done = failures > 0 and not (least > close).any()
        if not np.array_equal(best, last):
            trial.apply(best)
        return best

    def _learn(self, layout: KinematicTrees, free: Vector, pushed: Vector, gained: Vector) -> None:
        """Update the learnt matrix by Broyden's method, from a change of the efforts and its effect.

        The change `pushed` [N·m or N] of the efforts caused the change `gained` [rad/s² or m/s²] of the accelerations.
        """
        s, y, known = layout.spread(pushed), layout.spread(gained), self.learnt
        guess = matmul(known, y[..., None])[..., 0]
        scale, size = (s * guess).sum(1), (s * s).sum(1)
        # a very small or opposite effect means that a contact changed: restart from the inertia without contacts
        is_clear, is_moved = scale > 1e-6 * size, size > 0.0
        row = matmul(s[:, None, :], known)[:, 0]
        update = (s - guess)[:, :, None] * row[:, None, :] / np.where(is_clear, scale, 1.0)[:, None, None]
        clear, moved = (is_clear & is_moved)[:, None, None], is_moved[:, None, None]
        self.learnt = np.where(clear, known + update, np.where(moved, free, known))


VelocityCommands = tuple[Vector, Vector, Vector]
"""Efforts, velocity errors, and the relevant part of these errors, each (n,)."""


def _better_efforts(
    layout: KinematicTrees, one: VelocityCommands, other: VelocityCommands
) -> tuple[Vector, Vector, Vector, bool]:
    """Choose the better efforts for each kinematic tree; the last result is True if `other` is better for any tree."""
    is_better = layout.most_of_tree(other[2]) < layout.most_of_tree(one[2])
    rows = is_better[layout.tree]
    efforts, missing, relevant_error = (np.where(rows, b, a) for a, b in zip(one, other, strict=True))
    return efforts, missing, relevant_error, bool(is_better.any())


def _between(values: Vector, low: Vector, high: Vector) -> Vector:
    bounded: Vector = np.minimum(np.maximum(values, low), high)
    return bounded


def _tree_by_tree(function: Callable[..., Vector], *matrices: Vector) -> Vector:
    """Apply a function to the matrices of all trees (trees, …); the result is zero for trees with a singular matrix.

    A matrix is singular within the precision of its numbers if the inertias of a tree differ extremely. The engine then
    reports the divergence.
    """
    try:
        return function(*matrices)
    except np.linalg.LinAlgError:
        results = np.zeros_like(matrices[-1])
        for index, of_tree in enumerate(zip(*matrices, strict=True)):
            with suppress(np.linalg.LinAlgError):
                results[index] = function(*of_tree)
        return results


class _EffortEvaluation:
    """Evaluation of efforts in one step by the engine; all vectors refer to the layout's joints (n,)."""

    def __init__(self, sim: Simulation, layout: KinematicTrees, velocities: Sequence[float]) -> None:
        self._sim, self.layout = sim, layout
        model, data = sim.mj_model, sim.mj_data
        self.step = float(sim.timestep)
        self._velocity = data.qvel[layout.dofs]
        self.highest = np.array([axis.effort_limit for axis in layout.axes])
        self.lowest = -self.highest
        fastest = np.minimum([axis.velocity_limit for axis in layout.axes], LARGEST)
        target = _between(np.array(velocities, float)[layout.order], -fastest, fastest)
        is_limited = model.jnt_limited[layout.joints].astype(bool)
        if is_limited.any():
            position, ends = data.qpos[layout.positions], model.jnt_range[layout.joints]
            up = np.where(is_limited, np.maximum(ends[:, 1] - position, 0.0) / self.step, np.inf)
            down = np.where(is_limited, np.minimum(ends[:, 0] - position, 0.0) / self.step, -np.inf)
            target = _between(target, down, up)
        self._target = target
        self.scale = 1.0 + np.abs(target)
        # damping is integrated implicitly, in the whole tree; not by Runge-Kutta
        self._is_damped = layout.is_damped and model.opt.integrator != mujoco.mjtIntegrator.mjINT_RK4
        self._mobility: Vector | None = None

    def apply(self, efforts: Vector) -> None:
        """Set efforts; NaN and infinite values become so large that the physics reports its divergence."""
        physics = self._sim.engine.physics
        physics.data.qfrc_applied[self.layout.dofs] = np.where(np.abs(efforts) <= LARGEST, efforts, LARGEST)
        physics.push_once()
        if physics.sleep.watches:
            for body in self.layout.bodies:
                physics.changed_body(CONTROL, body)
        else:
            physics.changed(CONTROL)

    def missing(self, efforts: Vector) -> Vector:
        """Return commanded minus resulting velocities of the next step with these efforts [rad/s or m/s]."""
        self.apply(efforts)
        data = self._sim.engine.physics.fresh()
        missing: Vector = self._target - self._velocity - self.step * self._gained(data.qacc)
        return missing

    def evaluate(self, efforts: Vector) -> VelocityCommands:
        """Return the efforts, their velocity errors, and the relevant part of these errors."""
        missing = self.missing(efforts)
        return efforts, missing, self.relevant_error(missing, efforts)

    def _gained(self, acceleration: Vector) -> Vector:
        """Return the joints' accelerations, corrected for damping that is integrated implicitly."""
        layout = self.layout
        gained: Vector = acceleration[layout.dofs]
        if self._is_damped:
            gained = self._damped(acceleration[layout.all][..., None]).ravel()[layout.place]
        return gained

    def _damped(self, accelerations: Vector) -> Vector:
        """Return the accelerations of all slots (trees, all slots, any) under implicit integration of the damping."""
        layout = self.layout
        mobility = self._mobilities()
        damping = self._sim.mj_model.dof_damping[layout.all] * layout.is_any * self.step
        implicit = np.eye(mobility.shape[1]) + mobility * damping[:, None, :]
        return _tree_by_tree(solve, implicit, accelerations)

    def bound(self, free: Vector, efforts: Vector) -> None:
        """Limit the efforts of joints without a limit of their own, so that they cannot push through an obstacle.

        The limit is the effort of a motion without contacts, plus ten times the weight of the whole tree at the reach
        of the moved links.

        Args:
            free: Effort per acceleration of each tree's joints without contacts (trees, slots, slots).
            efforts: Efforts of the last evaluation.
        """
        is_free = np.isinf(self.highest)
        if not is_free.any():
            return
        lacks = (self._target - self._velocity) / self.step - self._gained(self._sim.mj_data.qacc_smooth)
        alone = efforts + self.layout.times(free, lacks)
        hold = self.layout.hold
        self.highest = np.where(is_free, alone + hold, self.highest)
        self.lowest = np.where(is_free, alone - hold, self.lowest)

    def relevant_error(self, missing: Vector, efforts: Vector) -> Vector:
        """Return each joint's error, or 0 if the error is small enough or the effort limit prevents a correction."""
        off = np.abs(missing)
        is_bad = off > _ENOUGH * self.scale
        if is_bad.any():
            is_bad &= (efforts < self.highest) | (missing <= 0.0)
            is_bad &= (efforts > self.lowest) | (missing >= 0.0)
        return np.where(is_bad, off, 0.0)

    def free_inertia(self) -> Vector:
        """Return the effort per acceleration of the joints of each tree, without contacts (trees, slots, slots)."""
        mobility, is_used = self._mobilities(), self.layout.is_used
        if self._is_damped:
            mobility = self._damped(mobility)
        slots = is_used.shape[1]
        both = is_used[:, :, None] & is_used[:, None, :]
        return _tree_by_tree(inverse, np.where(both, mobility[:, :slots, :slots], np.eye(slots)))

    def _mobilities(self) -> Vector:
        """Return the inverse inertia of all relevant degrees of freedom of each tree (trees, all slots, all slots)."""
        if self._mobility is None:
            layout = self.layout
            # trees do not accelerate each other, so one row can test one degree of freedom of every tree
            solved = np.empty_like(layout.units)
            mujoco.mj_solveM(self._sim.mj_model, self._sim.mj_data, solved, layout.units)
            both = layout.is_any[:, :, None] & layout.is_any[:, None, :]
            self._mobility = np.where(both, solved[:, layout.all].transpose(1, 2, 0), 0.0)
        return self._mobility
