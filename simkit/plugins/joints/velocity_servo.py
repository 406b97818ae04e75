"""Efforts that bring joints to commanded velocities within one step."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np

from simkit.params import LARGEST
from simkit.plugins.joints.joint_axis import JointAxis
from simkit.plugins.joints.kinematic_trees import Keys, KinematicTrees
from simkit.pose import Vector
from simkit.runtime.engine.physics_step import CONTROL

if TYPE_CHECKING:
    from simkit.plugins.joints.kinematic_trees import Flags
    from simkit.runtime import Simulation

_ENOUGH: Final = 3e-6
"""Of 1 + the commanded velocity [rad/s or m/s]: efforts that miss it by no more stay as they are."""

_CLOSE: Final = 1e-5
"""Of the same: corrected efforts need no more correction in this step; the next one makes up for what is left."""

_FAR: Final = 0.1
"""Of the same: what the efforts of the last step bring about is not worth going on from."""

_ROUNDS: Final = 6
"""Corrections in one step at most, each with a forward pass."""


@dataclass(slots=True)
class VelocityServo:
    """Efforts for joints at commanded velocities; what was learnt in the last step makes the next one cheap.

    Attributes:
        keys: the joints that were driven last.
        efforts: theirs in the last step (n,).
        learnt: effort over acceleration of the joints of each kinematic tree (trees, slots, slots).
        is_learnt: of which trees (trees,).
    """

    keys: Keys = ()
    efforts: Vector = field(default_factory=lambda: np.zeros(0))
    learnt: Vector = field(default_factory=lambda: np.zeros((0, 0, 0)))
    is_learnt: Flags = field(default_factory=lambda: np.zeros(0, bool))

    def drive(
        self,
        sim: Simulation,
        axes: Sequence[JointAxis],
        velocities: Sequence[float],
        layouts: dict[tuple[int, ...], KinematicTrees],
    ) -> None:
        """Sets the efforts of the next step for the wanted velocities [rad/s or m/s], within the joints' limits.

        A target that would go beyond a position limit within the step ends at it. Where the efforts that it takes are
        not found, those that come nearest are taken.

        Args:
            sim: the simulation.
            axes: what is to move; of two commands to one joint the later counts.
            velocities: how fast each [rad/s or m/s].
            layouts: kept by the caller as long as the engine's model and the axes are the same.
        """
        which = tuple(map(id, axes))
        layout = layouts.get(which)
        if layout is None or not layout.fits(sim.mj_model):
            layout = layouts[which] = KinematicTrees.of(sim.mj_model, axes)
        if self.keys != layout.keys:
            self._begin(layout)
        bench = _EffortTrial(sim, layout, velocities)
        best = _between(self.efforts, bench.lowest, bench.highest)
        missing = bench.missing(best)
        least = bench.badness(missing, best)
        self.efforts = self._search(bench, best, missing) if least.any() else best

    def _begin(self, layout: KinematicTrees) -> None:
        """Takes up other joints: of those that it knows the efforts of the last step, else none."""
        efforts = dict(zip(self.keys, self.efforts.tolist(), strict=True))
        self.keys, self.efforts = layout.keys, np.array([efforts.get(key, 0.0) for key in layout.keys])
        trees, slots = layout.is_used.shape
        self.learnt, self.is_learnt = np.zeros((trees, slots, slots)), np.zeros(trees, bool)

    def _search(self, bench: _EffortTrial, best: Vector, missing: Vector) -> Vector:
        """Better efforts than `best`, which miss the velocities by `missing`; they are applied."""
        layout, close = bench.layout, _CLOSE * bench.scale
        free = bench.free_inertia()
        bench.bound(free, best)
        least, last = bench.badness(missing, best), best
        far = layout.any_of_tree(least > _FAR * bench.scale)
        if far.any():  # begins anew, with no efforts and nothing learnt
            last = np.where(far[layout.tree], 0.0, best)
            self.is_learnt &= ~far
            best, missing, least, _ = _better_efforts(layout, (best, missing, least), bench.ask(last))
        self.learnt = np.where(self.is_learnt[:, None, None], self.learnt, free)
        vain = 0
        for round_ in range(_ROUNDS):
            if not (least > close if round_ else least).any() or vain > 1:
                break
            lacks = layout.any_of_tree(least > 0.0)
            self.is_learnt |= lacks
            pushed = np.where(lacks[layout.tree], layout.times(self.learnt, missing / bench.step), 0.0)
            last = _between(best + pushed, bench.lowest, bench.highest)
            asked = bench.ask(last)
            self._learn(layout, free, last - best, (missing - asked[1]) / bench.step)
            best, missing, least, is_better = _better_efforts(layout, (best, missing, least), asked)
            vain = 0 if is_better else vain + 1
        if not np.array_equal(best, last):
            bench.apply(best)
        return best

    def _learn(self, layout: KinematicTrees, free: Vector, pushed: Vector, gained: Vector) -> None:
        """Broyden's update of what it takes, from what `pushed` more effort `gained` in acceleration."""
        s, y, known = layout.spread(pushed), layout.spread(gained), self.learnt
        guess = (known @ y[..., None])[..., 0]
        scale, size = (s * guess).sum(1), (s * s).sum(1)
        # an answer that says little, or the contrary, is that of another contact: begin anew
        is_clear, is_moved = scale > 1e-6 * size, size > 0.0
        row = (s[:, None, :] @ known)[:, 0]
        update = (s - guess)[:, :, None] * row[:, None, :] / np.where(is_clear, scale, 1.0)[:, None, None]
        clear, moved = (is_clear & is_moved)[:, None, None], is_moved[:, None, None]
        self.learnt = np.where(clear, known + update, np.where(moved, free, known))


VelocityCommands = tuple[Vector, Vector, Vector]
"""Efforts, what they miss, and how bad that is."""


def _better_efforts(
    layout: KinematicTrees, one: VelocityCommands, other: VelocityCommands
) -> tuple[Vector, Vector, Vector, bool]:
    """Of each kinematic tree the better efforts of two, and whether the other's are it anywhere."""
    is_better = layout.most_of_tree(other[2]) < layout.most_of_tree(one[2])
    rows = is_better[layout.tree]
    efforts, missing, badness = (np.where(rows, b, a) for a, b in zip(one, other, strict=True))
    return efforts, missing, badness, bool(is_better.any())


def _between(values: Vector, low: Vector, high: Vector) -> Vector:
    found: Vector = np.minimum(np.maximum(values, low), high)
    return found


class _EffortTrial:
    """What the engine says of efforts in one step; all vectors are of the layout's joints (n,)."""

    def __init__(self, sim: Simulation, layout: KinematicTrees, velocities: Sequence[float]) -> None:
        self._sim, self.layout = sim, layout
        model, data = sim.mj_model, sim.mj_data
        self.step = float(sim.timestep)
        self._velocity = data.qvel[layout.dofs]
        self.highest = np.array([axis.effort_limit for axis in layout.axes])
        self.lowest = -self.highest
        fastest = np.minimum([axis.velocity_limit for axis in layout.axes], LARGEST)
        wanted = _between(np.array(velocities, float)[layout.order], -fastest, fastest)
        is_limited = model.jnt_limited[layout.joints].astype(bool)
        if is_limited.any():
            position, ends = data.qpos[layout.positions], model.jnt_range[layout.joints]
            up = np.where(is_limited, np.maximum(ends[:, 1] - position, 0.0) / self.step, np.inf)
            down = np.where(is_limited, np.minimum(ends[:, 0] - position, 0.0) / self.step, -np.inf)
            wanted = _between(wanted, down, up)
        self._wanted = wanted
        self.scale = 1.0 + np.abs(wanted)
        # damping is integrated implicitly, in the whole tree; not by Runge-Kutta
        self._is_damped = layout.is_damped and model.opt.integrator != mujoco.mjtIntegrator.mjINT_RK4
        self._mobility: Vector | None = None

    def apply(self, efforts: Vector) -> None:
        """Sets efforts; what is no longer a number becomes so large that the physics diverges, and says so."""
        physics = self._sim.engine.physics
        physics.data.qfrc_applied[self.layout.dofs] = np.where(np.abs(efforts) <= LARGEST, efforts, LARGEST)
        physics.one_shot = True
        if physics.sleep.watches:
            for body in self.layout.bodies:
                physics.changed_body(CONTROL, body)
        else:
            physics.changed(CONTROL)

    def missing(self, efforts: Vector) -> Vector:
        """What the velocities of the next step lack to the wanted ones with these efforts [rad/s or m/s]."""
        self.apply(efforts)
        data = self._sim.engine.physics.fresh()
        missing: Vector = self._wanted - self._velocity - self.step * self._gained(data.qacc)
        return missing

    def ask(self, efforts: Vector) -> VelocityCommands:
        """Efforts, what they miss, and how bad that is."""
        missing = self.missing(efforts)
        return efforts, missing, self.badness(missing, efforts)

    def _gained(self, acceleration: Vector) -> Vector:
        """What the joints gain in velocity per second, where damping is integrated implicitly."""
        layout = self.layout
        gained: Vector = acceleration[layout.dofs]
        if self._is_damped:
            gained = self._damped(acceleration[layout.all][..., None]).ravel()[layout.place]
        return gained

    def _damped(self, accelerations: Vector) -> Vector:
        """Accelerations of all that counts (trees, all slots, any), as an implicit integration of damping has them."""
        layout = self.layout
        mobility = self._mobilities()
        damping = self._sim.mj_model.dof_damping[layout.all] * layout.is_any * self.step
        implicit = np.eye(mobility.shape[1]) + mobility * damping[:, None, :]
        found: Vector = np.linalg.solve(implicit, accelerations)
        return found

    def bound(self, free: Vector, efforts: Vector) -> None:
        """Bounds the efforts of joints without a limit of their own, so that they cannot push through what holds them.

        They may give what it takes if nothing is touched, and ten times the weight of all that hangs together more,
        at the length of what the joint moves.

        Args:
            free: effort over acceleration of each tree's joints, contacts aside (trees, slots, slots).
            efforts: those that the engine was asked about last.
        """
        is_free = np.isinf(self.highest)
        if not is_free.any():
            return
        lacks = (self._wanted - self._velocity) / self.step - self._gained(self._sim.mj_data.qacc_smooth)
        alone = efforts + self.layout.times(free, lacks)
        hold = self.layout.hold
        self.highest = np.where(is_free, alone + hold, self.highest)
        self.lowest = np.where(is_free, alone - hold, self.lowest)

    def badness(self, missing: Vector, efforts: Vector) -> Vector:
        """How far each joint is off, 0 where it is near enough or its effort limit allows no more."""
        off = np.abs(missing)
        is_bad = off > _ENOUGH * self.scale
        if is_bad.any():
            is_bad &= (efforts < self.highest) | (missing <= 0.0)
            is_bad &= (efforts > self.lowest) | (missing >= 0.0)
        return np.where(is_bad, off, 0.0)

    def free_inertia(self) -> Vector:
        """Effort over acceleration of the joints of each tree, contacts aside (trees, slots, slots)."""
        mobility, is_used = self._mobilities(), self.layout.is_used
        if self._is_damped:
            mobility = self._damped(mobility)
        slots = is_used.shape[1]
        both = is_used[:, :, None] & is_used[:, None, :]
        found: Vector = np.linalg.inv(np.where(both, mobility[:, :slots, :slots], np.eye(slots)))
        return found

    def _mobilities(self) -> Vector:
        """The inverse inertia at all degrees of freedom of each tree that count (trees, all slots, all slots)."""
        if self._mobility is None:
            layout = self.layout
            # trees do not move each other: one row can ask about one degree of freedom of each
            solved = np.empty_like(layout.units)
            mujoco.mj_solveM(self._sim.mj_model, self._sim.mj_data, solved, layout.units)
            both = layout.is_any[:, :, None] & layout.is_any[:, None, :]
            self._mobility = np.where(both, solved[:, layout.all].transpose(1, 2, 0), 0.0)
        return self._mobility
