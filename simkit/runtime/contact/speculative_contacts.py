"""Detection of bodies that move so far in one step that they could pass through an obstacle.

MuJoCo's speculative contacts sweep geoms along their velocities and stop them before they touch. They multiply the time
of a step by 1.1 to 2.7 even without fast bodies. Therefore they are enabled for windows of some steps
(`window_length`), by a rule that depends on positions and velocities alone. In such a window all steps follow the
contact law, which stops a fast contact within one step. A body that strikes with an edge begins to spin, and its other
corners would sink through a soft contact.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.engine_options import contact_time_constant, has_engine_contacts
from simkit.diagnostics import NOWHERE
from simkit.linear_algebra import matmul, squared_length
from simkit.runtime.contact import travel_bounds
from simkit.runtime.contact.contact_law import window_length
from simkit.runtime.contact.travel_bounds import Floats, Ints

if TYPE_CHECKING:
    from simkit.compiler.name_map import NameMap
    from simkit.diagnostics import Diagnostics


SPECULATIVE_FLAG: Final = int(mujoco.mjtEnableBit.mjENBL_SPECULATIVE)
"""Bit in `model.opt.enableflags` for a window with speculative contacts."""

_GROWTH: Final = 2.0
"""Factor by which speeds may grow within a time window of `window_length` steps."""

_MAX_TILTED_TRAVEL: Final = 3.0
"""Largest common travel of two bodies in a step, in half thicknesses of both, that is reliably stopped.

Beyond it up to 13 of 100 tilted boxes and capsules pass through.
"""

_SAFE_SHARE: Final = 0.25
"""Distance that two bodies may still approach within the stopping time, as a fraction of half the thickness of both."""

_MAX_DENSE_SIZE: Final = 20_000
_MAX_PAIRS: Final = 4_000_000
_PLANE, _HFIELD = int(mujoco.mjtGeom.mjGEOM_PLANE), int(mujoco.mjtGeom.mjGEOM_HFIELD)
_RK4 = int(mujoco.mjtIntegrator.mjINT_RK4)


_multiply = np.multiply


class FastApproach(NamedTuple):
    """Pair of geoms: `geom` may pass through `other` within the next time window of `window_length` steps.

    Attributes:
        geom: fast geom.
        other: geom that it approaches.
        speed: approach speed of the fastest points [m/s].
        thickness: thickness of the thinner geom [m].
        step: length of a step [s] with which `geom` does not pass through `other`.
        is_height_field: True if `other` is a height field.
    """

    geom: int
    other: int
    speed: float
    thickness: float
    step: float
    is_height_field: bool


ApproachCallback = Callable[[list[FastApproach]], None]


class FastBodyDetector:
    """Detector of bodies that are too fast for the step, in one compiled model.

    Args:
        model: `MjModel`; masks, sizes and the step are read once.
        on_approach: function that receives the approaches that speculative contacts cannot stop; it changes no state.

    Attributes:
        closing: remaining approach speed [m/s] of each geom after it is stopped; the last item is for no geom. A body
            that is stopped before a wall thus still reaches it.
        can_be_fast: False if no body can ever need speculative contacts.
    """

    def __init__(self, model: mujoco.MjModel, on_approach: ApproachCallback | None = None) -> None:
        self.model, self._on_approach = model, on_approach
        step = float(model.opt.timestep)
        self._window = window_length(step)
        # time for which a body still moves into a soft contact; twice as long for a bouncing one
        bounces = bool((model.geom_solref[travel_bounds.can_collide(model), 0] < 0.0).any())
        self._time = max(_GROWTH * step, contact_time_constant(step) / (1.0 if bounces else 2.0))
        self._half = travel_bounds.half_thickness(model)
        self.closing: list[float] = (_SAFE_SHARE / self._time * self._half).tolist()
        tree = model.body_treeid[model.geom_bodyid]
        solid = travel_bounds.can_collide(model)
        moving = np.flatnonzero(solid & (tree >= 0))
        allowed = travel_bounds.allowed_travel(model, self._half, moving)
        self._moving, self._allowed = moving[np.isfinite(allowed)], allowed[np.isfinite(allowed)]
        self._others = np.flatnonzero(solid & (model.geom_type != _PLANE))
        self._bodies = model.geom_bodyid[self._moving]
        self._roots = model.body_rootid[self._bodies]
        self._is_ball, is_round = travel_bounds.rotational_symmetries(model)
        self._spin_radius = np.where(self._is_ball, 0.0, model.geom_rbound)[self._moving]
        self._turns_freely = is_round[self._moving, None].astype(float)
        self._scratch: Any = None
        self._data: mujoco.MjData | None = None
        self._velocities_now = np.zeros(0)
        self._compute_weights()

    def _compute_weights(self) -> None:
        """Compute the weights of velocities with which `wants` quickly detects that no body is fast."""
        model, nv = self.model, self.model.nv
        rows, dofs, lever = travel_bounds.velocity_levers(model, self._moving)
        share = lever * self._time / self._allowed[rows]
        weights = np.zeros(nv)
        np.maximum.at(weights, dofs, share)
        self._share = np.zeros((0, 0))
        if len(self._moving) * nv <= _MAX_DENSE_SIZE:
            self._share = np.zeros((len(self._moving), nv))
            np.add.at(self._share, (rows, dofs), share)
        self._weights = weights
        # |Σ w v| ≤ 1 holds within a tree if its n terms have Σ (w v)² ≤ 1/n
        trees = model.dof_treeid
        counts = np.bincount(trees, minlength=max(model.ntree, 1)) if nv else np.ones(1)
        self._rooted = weights * np.sqrt(counts[trees]) if nv else weights
        self._terms = np.empty(nv)
        self._starts = model.tree_dofadr.astype(np.intp)
        self.can_be_fast = bool(len(self._moving)) and bool(weights.any()) and not has_engine_contacts(model)

    # ------------------------------------------------------------------ check of a window

    def wants(self, data: mujoco.MjData) -> bool:
        """Check whether the next window needs speculative contacts, from `qpos`, `qvel` and mocap poses alone."""
        if not self.can_be_fast:
            return False
        if data is not self._data:  # the same object at every check; its arrays keep their addresses
            self._data, self._velocities_now = data, data.qvel
        terms = _multiply(self._velocities_now, self._rooted, self._terms)
        if squared_length(terms, 1.0) <= 1.0 or self._is_slow(self._velocities_now):
            return False
        return self._has_fast_pair(data)

    def _is_slow(self, velocities: Floats) -> bool:
        """Check that no geom can be fast, by the sum over its chain of joints."""
        speeds = np.abs(velocities)
        if self._share.size:
            return bool(matmul(self._share, speeds).max() <= 1.0)
        return bool(np.add.reduceat(speeds * self._weights, self._starts).max() <= 1.0)

    def _has_fast_pair(self, data: mujoco.MjData) -> bool:
        """Check whether a fast geom may pass through another within a time window of `window_length` steps."""
        model, moving = self.model, self._moving
        scratch = self._positions(data)
        linear, turning = self._velocities(scratch)
        speeds = np.sqrt(np.einsum("ij,ij->i", linear, linear)) + turning
        is_fast = ~(speeds * self._time <= self._allowed)
        if not is_fast.any():
            return False
        fast = moving[is_fast]
        if len(fast) * len(self._others) > _MAX_PAIRS:
            return True
        all_speeds, all_linear = np.zeros(model.ngeom), np.zeros((model.ngeom, 3))
        all_speeds[moving], all_linear[moving] = speeds, linear
        this, other = self._find_reachable_pairs(scratch.geom_xpos, fast, all_speeds)
        if not len(this):
            return False
        half, both = self._half, all_speeds[this] + all_speeds[other]
        keep = (both * self._time > half[this] + half[other]) & (model.geom_bodyid[this] != model.geom_bodyid[other])
        this, other, both = this[keep], other[keep], both[keep]
        bodies = model.geom_bodyid
        body_pairs = travel_bounds.BodyPairs(model)
        cleared = {
            pair: body_pairs.is_filtered(*pair)
            for pair in set(zip(bodies[this].tolist(), bodies[other].tolist(), strict=True))
        }
        keep = np.array([not cleared[int(bodies[a]), int(bodies[b])] for a, b in zip(this, other, strict=True)], bool)
        if not keep.any():
            return False
        if self._on_approach is not None:
            self._report_unstoppable(scratch, this[keep], other[keep], both[keep], all_linear)
        return True

    def _positions(self, data: mujoco.MjData) -> mujoco.MjData:
        """Compute positions and velocities of bodies in separate data.

        The values in `data` belong to its last forward pass and may be older.
        """
        model = self.model
        scratch: mujoco.MjData | None = self._scratch
        if scratch is None:
            scratch = self._scratch = mujoco.MjData(model)
        scratch.qpos[:], scratch.qvel[:] = data.qpos, data.qvel
        if model.nmocap:
            scratch.mocap_pos[:], scratch.mocap_quat[:] = data.mocap_pos, data.mocap_quat
        options = model.opt
        flags = options.enableflags
        options.enableflags = flags & ~int(
            mujoco.mjtEnableBit.mjENBL_SLEEP
        )  # with the flag, MuJoCo skips static bodies
        try:
            mujoco.mj_kinematics(model, scratch)
            mujoco.mj_comPos(model, scratch)
            mujoco.mj_comVel(model, scratch)
        finally:
            options.enableflags = flags
        return scratch

    def _velocities(self, scratch: mujoco.MjData) -> tuple[Floats, Floats]:
        """Return velocities of the moving geoms' centres, and speeds of their farthest points about them [m/s]."""
        motion = scratch.cvel.take(self._bodies, 0)
        spin, arm = motion[:, :3], scratch.geom_xpos.take(self._moving, 0) - scratch.subtree_com.take(self._roots, 0)
        linear = motion[:, 3:].copy()
        for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):  # np.cross takes several times as long
            linear[:, i] += spin[:, j] * arm[:, k] - spin[:, k] * arm[:, j]
        axes = scratch.geom_xmat.take(self._moving, 0)[:, 2::3] * self._turns_freely
        spin = spin - np.einsum("ij,ij->i", spin, axes)[:, None] * axes
        turning: Floats = np.sqrt(np.einsum("ij,ij->i", spin, spin)) * self._spin_radius
        return linear, turning

    def _find_reachable_pairs(self, places: Floats, fast: Ints, speeds: Floats) -> tuple[Ints, Ints]:
        """Find pairs of a fast geom and a geom that it may reach, even after bounces.

        The pairs are those for the next time window of `window_length` steps.
        """
        model, others = self.model, self._others
        radius = model.geom_rbound
        reach = (speeds[fast, None] + speeds[None, others]) * (self._window * _GROWTH * model.opt.timestep)
        reach += radius[fast, None]
        difference = places[fast, None] - places[None, others]
        distance = np.sqrt(np.einsum("ijk,ijk->ij", difference, difference))
        rows, columns = np.nonzero(
            (distance <= reach + radius[None, others]) & travel_bounds.can_touch(model, fast[:, None], others[None])
        )
        this, other = fast[rows], others[columns]
        local = self._to_box_frames(places[this], other)
        with np.errstate(over="ignore"):  # a geom that far away is not within reach
            gap = np.linalg.norm(np.maximum(np.abs(local) - model.geom_aabb[other, 3:], 0.0), axis=1)
        keep = (gap <= reach[rows, columns]) & (this != other)
        return this[keep], other[keep]

    def _to_box_frames(self, points: Floats, geoms: Ints) -> Floats:
        """Transform world points to the frames of the bounding boxes of geoms."""
        scratch = self._scratch
        turned = scratch.geom_xmat[geoms].reshape(-1, 3, 3)
        local: Floats = np.einsum("nji,nj->ni", turned, points - scratch.geom_xpos[geoms])
        local -= self.model.geom_aabb[geoms, :3]
        return local

    # ------------------------------------------------------------------ unstoppable approaches

    def _report_unstoppable(
        self, scratch: mujoco.MjData, this: Ints, other: Ints, both: Floats, linear: Floats
    ) -> None:
        """Report approaching pairs that speculative contacts do not reliably stop."""
        model, step, half = self.model, float(self.model.opt.timestep), self._half
        together = half[this] + half[other]
        is_field = model.geom_type[other] == _HFIELD
        most = 1.0 if model.opt.integrator == _RK4 else _MAX_TILTED_TRAVEL
        is_tilted = ~self._is_ball[this] & (both * step > most * together)
        chosen = np.flatnonzero((is_field | is_tilted) & self._is_on_course(scratch, this, other, linear))
        approaches = []
        for i in chosen.tolist():
            speed, field = float(both[i]), bool(is_field[i])
            thick = 2.0 * float(min(half[this[i]], half[other[i]]))
            enough = float(together[i]) / speed * (1.0 / _GROWTH if field else most)
            approaches.append(FastApproach(int(this[i]), int(other[i]), speed, thick, enough, field))
        if approaches and self._on_approach is not None:
            self._on_approach(approaches)

    def _is_on_course(self, scratch: mujoco.MjData, this: Ints, other: Ints, linear: Floats) -> npt.NDArray[np.bool_]:
        """Check for each pair whether the bounding sphere of geom `this` meets the bounding box of geom `other`.

        The check assumes straight motion within a time window of `window_length` steps.
        """
        model = self.model
        start = self._to_box_frames(scratch.geom_xpos[this], other)
        turned = scratch.geom_xmat[other].reshape(-1, 3, 3)
        way = np.einsum("nji,nj->ni", turned, linear[this] - linear[other]) * (self._window * model.opt.timestep)
        box = model.geom_aabb[other, 3:] + model.geom_rbound[this][:, None]
        way = np.where(np.abs(way) < 1e-12, 1e-12, way)
        ends = np.stack([(-box - start) / way, (box - start) / way])
        enters, leaves = ends.min(axis=0).max(axis=1), ends.max(axis=0).min(axis=1)
        hits: npt.NDArray[np.bool_] = (enters <= leaves) & (leaves >= 0.0) & (enters <= 1.0)
        return hits


class FastBodyWarnings:
    """Warnings about collisions that may pass through each other, one for each pair.

    Args:
        reports: collection for the warnings.
        timestep: length of a step [s].
        names: function that returns the name map of the present compiled model.
    """

    def __init__(self, reports: Diagnostics, timestep: float, names: Callable[[], NameMap]) -> None:
        self._reports, self._timestep, self._names = reports, timestep, names
        self._reported: set[frozenset[str]] = set()

    def __call__(self, approaches: list[FastApproach]) -> None:
        """Warn of new pairs."""
        names, timestep = self._names(), self._timestep
        for approach in approaches:
            link, mover, _ = names.geom_owner(approach.geom)
            _, other, _ = names.geom_owner(approach.other)
            mover, other = mover or "a geom", other or "a geom"
            pair = frozenset((mover, other))
            if pair in self._reported:
                continue
            self._reported.add(pair)
            obstacle = f"the height map {other}" if approach.is_height_field else other
            travel = approach.speed * timestep
            message = (
                f"{mover} may pass through {obstacle}: it approaches at {approach.speed:.3g} m/s, {travel:.3g} m in a "
                f"step of {timestep:g} s, and the thinner of the two is {approach.thickness:.3g} m thick"
            )
            where = names.link(link).scene.where if link in names.links else NOWHERE
            hint = f"<max_step_size>{_round_down(approach.step):g}</max_step_size>"
            self._reports.warning("SK-PHYS-031", message, where, hint)


def _round_down(value: float) -> float:
    """Return the largest number with one digit that is not above a positive number."""
    unit = 10.0 ** math.floor(math.log10(value))
    return math.floor(value / unit * (1.0 + 1e-12)) * unit
