"""Velocity commands of joints: the efforts that bring them about within one step, whatever holds them back.

gz's engine makes of a velocity command a constraint that is solved together with the contacts. MuJoCo has no such
constraint, so the efforts are found by asking the engine: Newton's method with the inertia of the free joint first,
then with what the last answers say of it (Broyden's rank-one update). A wheel that carries a robot uphill needs that:
its own inertia is a thousandth of what it moves.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import mujoco
import numpy as np

from simkit.plugins.joint_axes import JointAxis
from simkit.pose import Vector

Keys = tuple[tuple[str, int], ...]
"""Scoped name and axis of each of some joints."""

_ENOUGH: Final = 3e-6
"""Of 1 + the commanded velocity [rad/s or m/s]: so near is near enough."""

_FAR: Final = 0.1
"""Of the same: what the efforts of the last step bring about is not worth going on from."""

_HOLD: Final = 10.0
_GRAVITY: Final = 9.81

_ROUNDS: Final = 6


@dataclass(slots=True)
class VelocityServo:
    """Efforts for joints at commanded velocities; what was learnt in the last step makes the next one cheap.

    Attributes:
        efforts: of the last step, by scoped name and axis of the joint.
        learnt: effort over acceleration (n, n) of the joints of one kinematic tree, by their names.
    """

    efforts: dict[tuple[str, int], float] = field(default_factory=dict)
    learnt: dict[Keys, Vector] = field(default_factory=dict)

    def drive(
        self, sim: Any, axes: Sequence[JointAxis], velocities: Sequence[float], layouts: dict[Keys, Layout]
    ) -> None:
        """Sets the efforts of the next step for the wanted velocities [rad/s or m/s], within the joints' limits.

        A target that would go beyond a position limit within the step ends at it. Where the efforts that it takes are
        not found, those that come nearest are taken.

        Args:
            sim: the simulation.
            axes: what is to move.
            velocities: how fast each [rad/s or m/s].
            layouts: kept by the caller as long as the engine's model is the same.
        """
        keys = tuple((axis.joint.scoped, axis.index) for axis in axes)
        if len(set(keys)) < len(keys):  # of two commands to one joint the later counts
            chosen = sorted({key: i for i, key in enumerate(keys)}.values())
            axes, velocities = [axes[i] for i in chosen], [velocities[i] for i in chosen]
            keys = tuple(keys[i] for i in chosen)
        if keys not in layouts:
            layouts[keys] = Layout.of(sim.mj_model, axes)
        layout = layouts[keys]
        bench = _Bench(sim, axes, velocities, layout)
        best = _between(np.array([self.efforts.get(key, 0.0) for key in keys]), bench.lowest, bench.highest)
        missing = bench.missing(best)
        least = bench.badness(missing, best)
        last = best
        if least.any():
            trees = [_Tree(rows, tuple(keys[i] for i in rows)) for rows in layout.groups]
            free = bench.free_inertia(trees)
            bench.bound(trees, free, best)
            least = bench.badness(missing, best)
            best, missing, least, last = self._from_rest(bench, trees, best, missing, least)
            vain = 0
            for _ in range(_ROUNDS):
                if not least.any() or vain > 1:
                    break
                last = self._step(bench, trees, free, best, missing, least)
                answer = bench.missing(last)
                badness = bench.badness(answer, last)
                for tree, own in zip(trees, free, strict=True):
                    self._learn(tree, own, last - best, (missing - answer) / bench.step)
                better = [i for tree in trees if badness[tree.rows].max() < least[tree.rows].max() for i in tree.rows]
                best = best.copy()
                best[better], missing[better], least[better] = last[better], answer[better], badness[better]
                vain = 0 if better else vain + 1
        if not np.array_equal(best, last):
            bench.apply(best)
        self.efforts = dict(zip(keys, best.tolist(), strict=True))

    def _from_rest(
        self, bench: _Bench, trees: list[_Tree], best: Vector, missing: Vector, least: Vector
    ) -> tuple[Vector, Vector, Vector, Vector]:
        """Begins anew, with no efforts and nothing learnt, where those of the last step are far from what it takes.

        Returns:
            The efforts to start from, what they miss, how bad that is, and the efforts that were tried last.
        """
        far = [tree for tree in trees if (least[tree.rows] > bench.far[tree.rows]).any()]
        if not far:
            return best, missing, least, best
        rows = [i for tree in far for i in tree.rows]
        tried = best.copy()
        tried[rows] = 0.0
        answer = bench.missing(tried)
        badness = bench.badness(answer, tried)
        best, missing, least = best.copy(), missing.copy(), least.copy()
        for tree in far:
            self.learnt.pop(tree.keys, None)
            if badness[tree.rows].max() < least[tree.rows].max():
                for values, others in ((best, tried), (missing, answer), (least, badness)):
                    values[tree.rows] = others[tree.rows]
        return best, missing, least, tried

    def _step(
        self, bench: _Bench, trees: list[_Tree], free: list[Vector], best: Vector, missing: Vector, least: Vector
    ) -> Vector:
        """The next efforts to try: of the trees that lack something, what it takes to make up for it."""
        tried = best.copy()
        for tree, own in zip(trees, free, strict=True):
            if least[tree.rows].any():
                inertia = self.learnt.setdefault(tree.keys, own)
                tried[tree.rows] += inertia @ missing[tree.rows] / bench.step
        return _between(tried, bench.lowest, bench.highest)

    def _learn(self, tree: _Tree, free: Vector, pushed: Vector, gained: Vector) -> None:
        """Broyden's update of what it takes, from what `pushed` more effort `gained` in acceleration."""
        s, y = pushed[tree.rows], gained[tree.rows]
        if tree.keys not in self.learnt or not s.any():
            return
        known = self.learnt[tree.keys]
        guess = known @ y
        scale = float(s @ guess)
        # an answer that says little, or the contrary, is that of another contact: begin anew
        if not scale > 1e-6 * float(s @ s):
            self.learnt[tree.keys] = free
            return
        self.learnt[tree.keys] = known + np.outer(s - guess, s @ known) / scale


@dataclass(slots=True)
class _Tree:
    """Joints of one kinematic tree: their rows among all, and their names."""

    rows: list[int]
    keys: Keys


@dataclass(frozen=True, slots=True)
class Layout:
    """What stays the same of some joints as long as the engine's model does.

    Attributes:
        dofs: of the joints.
        positions: their places among the engine's coordinates.
        joints: their numbers among the engine's joints.
        all: their degrees of freedom, then those that damping acts on in the same trees.
        trees: of each of these.
        groups: rows of the joints of each tree.
        hold: what a joint without an effort limit may give beyond what moves it when nothing is touched.
    """

    dofs: Any
    positions: Any
    joints: Any
    all: Any
    trees: Any
    groups: list[list[int]]
    hold: Vector

    @classmethod
    def of(cls, model: Any, axes: Sequence[JointAxis]) -> Layout:
        dofs = np.array([axis.dof for axis in axes])
        joints = model.dof_jntid[dofs]
        trees = model.dof_treeid[dofs]
        damped = np.flatnonzero((model.dof_damping > 0.0) & np.isin(model.dof_treeid, trees))
        every = np.concatenate([dofs, np.setdiff1d(damped, dofs)]).astype(int)
        groups = [np.flatnonzero(trees == tree).tolist() for tree in dict.fromkeys(trees.tolist())]
        hold = np.array([_HOLD * _weight(model, dof) for dof in dofs.tolist()])
        places = model.jnt_qposadr[joints]
        return cls(dofs, places, joints, every, model.dof_treeid[every], groups, hold)


def _between(values: Vector, low: Vector, high: Vector) -> Vector:
    found: Vector = np.minimum(np.maximum(values, low), high)
    return found


class _Bench:
    """What the engine says of efforts in one step."""

    def __init__(self, sim: Any, axes: Sequence[JointAxis], velocities: Sequence[float], layout: Layout) -> None:
        self._sim, self._axes, self._layout = sim, axes, layout
        model, data = sim.mj_model, sim.mj_data
        self.step = float(sim.timestep)
        self._velocity = data.qvel[layout.dofs]
        self.highest = np.array([axis.effort_limit for axis in axes])
        self.lowest = -self.highest
        fastest = np.array([axis.velocity_limit for axis in axes])
        wanted = _between(np.asarray(velocities, float), -fastest, fastest)
        is_limited = model.jnt_limited[layout.joints].astype(bool)
        if is_limited.any():
            position, ends = data.qpos[layout.positions], model.jnt_range[layout.joints]
            up = np.where(is_limited, np.maximum(ends[:, 1] - position, 0.0) / self.step, np.inf)
            down = np.where(is_limited, np.minimum(ends[:, 0] - position, 0.0) / self.step, -np.inf)
            wanted = _between(wanted, down, up)
        self._wanted = wanted
        scale = 1.0 + np.abs(wanted)
        self._enough, self.far = _ENOUGH * scale, _FAR * scale
        # damping is integrated implicitly, in the whole tree
        self._all, self._trees = layout.all, layout.trees
        self._damping = model.dof_damping[layout.all] * self.step
        self._is_damped = bool(self._damping.any())
        self._mobility: Vector | None = None
        self._implicit: Vector | None = None

    def apply(self, efforts: Vector) -> None:
        for axis, effort in zip(self._axes, efforts.tolist(), strict=True):
            axis.push(effort)

    def missing(self, efforts: Vector) -> Vector:
        """What the velocities of the next step lack to the wanted ones with these efforts [rad/s or m/s]."""
        self.apply(efforts)
        data = self._sim.physics.fresh()
        missing: Vector = self._wanted - self._velocity - self.step * self._gained(data.qacc)
        return missing

    def _gained(self, acceleration: Vector) -> Vector:
        """What the joints gain in velocity per second, where damping is integrated implicitly."""
        gained = acceleration[self._all]
        if self._is_damped:
            if self._implicit is None:
                self._implicit = np.eye(len(self._all)) + self._mobility_matrix() * self._damping
            gained = np.linalg.solve(self._implicit, gained)
        return np.asarray(gained[: len(self._axes)], float)

    def bound(self, trees: Sequence[_Tree], free: Sequence[Vector], efforts: Vector) -> None:
        """Bounds the efforts of joints without a limit of their own, so that they cannot push through what holds them.

        They may give what it takes if nothing is touched, and `_HOLD` times the weight of all that hangs together more,
        at the length of what the joint moves.

        Args:
            trees: the joints.
            free: effort over acceleration of each, contacts aside.
            efforts: those that the engine was asked about last.
        """
        is_free = np.isinf(self.highest)
        if not is_free.any():
            return
        lacks = (self._wanted - self._velocity) / self.step - self._gained(self._sim.mj_data.qacc_smooth)
        alone = efforts.copy()
        for tree, inertia in zip(trees, free, strict=True):
            alone[tree.rows] += inertia @ lacks[tree.rows]
        hold = self._layout.hold
        self.highest = np.where(is_free, alone + hold, self.highest)
        self.lowest = np.where(is_free, alone - hold, self.lowest)

    def badness(self, missing: Vector, efforts: Vector) -> Vector:
        """How far each joint is off, 0 where it is near enough or its effort limit allows no more."""
        is_spent = ((efforts >= self.highest) & (missing > 0.0)) | ((efforts <= self.lowest) & (missing < 0.0))
        return np.where(is_spent | (np.abs(missing) <= self._enough), 0.0, np.abs(missing))

    def free_inertia(self, trees: Sequence[_Tree]) -> list[Vector]:
        """Effort over acceleration of the joints of each tree, contacts aside (n, n)."""
        mobility = self._mobility_matrix()
        if self._is_damped:
            mobility = np.linalg.solve(np.eye(len(self._all)) + mobility * self._damping, mobility)
        return [np.asarray(np.linalg.inv(mobility[np.ix_(tree.rows, tree.rows)]), float) for tree in trees]

    def _mobility_matrix(self) -> Vector:
        """The inverse inertia at all degrees of freedom that count (k, k)."""
        if self._mobility is None:
            model, data = self._sim.mj_model, self._sim.mj_data
            # trees do not move each other: one column can ask about one degree of freedom of each
            rank = np.zeros(len(self._all), int)
            seen: dict[int, int] = {}
            for i, tree in enumerate(self._trees.tolist()):
                rank[i] = seen.get(tree, 0)
                seen[tree] = rank[i] + 1
            units = np.zeros((int(rank.max()) + 1, model.nv))
            units[rank, self._all] = 1.0
            solved = np.zeros_like(units)
            mujoco.mj_solveM(model, data, solved, units)
            is_same = self._trees[:, None] == self._trees[None, :]
            self._mobility = np.where(is_same, solved[rank][:, self._all], 0.0).T
        return self._mobility


def _weight(model: Any, dof: int) -> float:
    """Of all that hangs together with a joint: [N] for a slider; for a hinge [N·m] at the length of what it moves."""
    joint, body = int(model.dof_jntid[dof]), int(model.dof_bodyid[dof])
    weight = float(model.body_subtreemass[model.body_rootid[body]]) * _GRAVITY
    if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_SLIDE:
        return weight
    return weight * (_reach(model, body) + float(np.linalg.norm(model.jnt_pos[joint])))


def _reach(model: Any, body: int) -> float:
    """How far from the frame of a body anything of it, or of what hangs on it, can be [m]."""
    geoms = range(model.body_geomadr[body], model.body_geomadr[body] + model.body_geomnum[body])
    own = [float(np.linalg.norm(model.geom_pos[g]) + model.geom_rbound[g]) for g in geoms]
    below = [
        float(np.linalg.norm(model.body_pos[b])) + _reach(model, int(b))
        for b in np.flatnonzero(model.body_parentid == body)
    ]
    return max([float(np.linalg.norm(model.body_ipos[body])), *own, *below])
