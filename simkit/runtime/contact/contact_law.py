"""Contact law: sliding bodies stay in contact, hitting bodies come to rest, overlapping bodies separate slowly.

MuJoCo solves for contact forces f with R f + J a - aref in the dual of the friction cone. That cone is convex.
Therefore a sliding contact gets a normal acceleration of mu times the tangential acceleration that friction could not
give, 250 times g at 3 m/s. The contact lifts off, falls back, and hops. De Saxce and Feng (1998) subtract exactly that
part from the normal row. With u = aref - J a - R f along the tangents, the normal reference becomes aref_n - s, s = |mu
u|. Normal force and friction are then Coulomb's: mu N against the slip. As u depends on the solution, s is found by
iteration. The first guess is the acceleration of the previous step, which is part of the state. In steady sliding one
solution is enough.

Two more corrections of the normal row apply to rigid contacts (not to contacts that a `<kp>` makes soft):

- A contact that closes fast is stopped within the step, as in Gazebo's engines, and not over two time constants.
- A contact that opens or overlaps separates at no more than `EXIT_SPEED`.

`docs/physics.md` has the formulas, the limits and the measurements.
"""

from __future__ import annotations

import enum
import math
from typing import Any, Final, Protocol

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.engine_options import contact_time_constant, has_engine_contacts
from simkit.linear_algebra import squared_length
from simkit.runtime.contact.array_contact_correction import AnyContactCorrection, find_array_correction
from simkit.runtime.contact.centripetal_friction import CentripetalFriction
from simkit.runtime.contact.contact_conditions import ARRAY_THRESHOLD, ContactConditions, deep_penetration
from simkit.runtime.contact.contact_correction import find_correction
from simkit.runtime.contact.contact_point_motion import ContactPointMotion
from simkit.runtime.contact.height_field_contacts import HeightFieldContacts
from simkit.runtime.contact.line_contacts import LineContacts
from simkit.runtime.contact.wheel_contacts import WheelContacts

TOLERANCE: Final = 0.02
"""Accuracy of the correction, in units of g. Contacts are soft and open only at an error of about 0.1 g."""

MAX_SOLUTIONS: Final = 10
"""Largest number of solutions per step; wheels much lighter than their load need several when they begin to skid."""

MAX_STEP_WITH_EDGES: Final = 0.0025
"""Largest step [s] at which both edge contacts of a wheel keep friction of their own while the wheel does not slip.

In longer steps, the edge contacts of a wheel always share one friction point. Otherwise, at 4 ms, the edges of a
TurtleBot3's wheels push against each other and turn the robot by 0.6 degrees per metre straight ahead.
"""

QUIET_SPEED: Final = 1e-4
"""Root of the sum of the squared velocities along all constraints [m/s, rad/s]; below it, no contact slides."""

FAST_SPEED: Final = 0.5
"""Speed [m/s] of a body above which the contact law is used, because the body may hit something within the window.

A rolling body needs this limit: it is neither in flight nor sliding, so the other checks do not detect it. Below this
speed the engine's own contacts throw a body back with a sixth of its speed, at most three times `EXIT_SPEED`.
"""

_MIN_GRAVITY: Final = 1.0  # [m/s²] scale of the tolerance in a world without gravity
_AFTER_VELOCITIES: Final = int(mujoco.mjtStage.mjSTAGE_VEL)
_PYRAMID: Final = mujoco.mjtCone.mjCONE_PYRAMIDAL

mj_forward_skip, mj_mul_jac_vec = mujoco.mj_forwardSkip, mujoco.mj_mulJacVec
mj_fwd_constraint = mujoco.mj_fwdConstraint

Floats = npt.NDArray[np.float64]


class LawUse(enum.IntEnum):
    """Part of the contact law that the steps of a window need.

    Wheels that turn in an arc slip at both edges, and not at all after `WheelContacts.merge`. The remaining checks
    would find nothing in each step, and cost as much as a step of MuJoCo alone.
    """

    NONE = 0
    WHEELS = 1
    WHOLE = 2


def window_length(timestep: float) -> int:
    """Return the number of steps for which one check of the contacts decides whether they follow the law.

    A check costs 3 to 6 µs: 1 to 4 % of the time of 16 steps, twice that with 8. Longer steps have the shorter window,
    because a contact that begins to slide within the window lifts until its end.
    """
    return 16 if timestep <= 0.001 else 8


class ContactShaper(Protocol):
    """Function object that changes contacts in every forward pass, after the velocities and before the forces."""

    model: mujoco.MjModel

    @property
    def acts(self) -> bool:
        """True if there is something to change; otherwise the engine's contacts stay."""

    def shape(self, data: mujoco.MjData, request: Any = None) -> None:
        """Change the contacts of data of its model by the present requests, or by the stored `request`."""

    def request(self) -> Any:
        """Return the present requests for contacts, for `shape`."""


class ContactLaw:
    """Contact forces of one compiled model.

    Args:
        model: MuJoCo's model.

    Attributes:
        is_on: True if something can collide, and the world does not use the engine's own contacts.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self.model = model
        self._window = float(model.opt.timestep) * window_length(float(model.opt.timestep))
        self._gravity = model.opt.gravity  # a view, because gravity may change during a run
        self._product = np.empty(0)
        constant = contact_time_constant(float(model.opt.timestep))
        softest = constant * (1.0 + 1e-9)
        step = float(model.opt.timestep)
        deep = deep_penetration(constant, step)
        self._around = ContactConditions(step, [], 0.0, None, softest=softest, least_damping=2.0 / softest, deep=deep)
        self._least_reference = (deep / (constant * constant)) ** 2
        self._fields, self.lines = HeightFieldContacts(model), LineContacts(model)
        self._has_fields, self._is_pyramid = bool(self._fields), model.opt.cone == _PYRAMID
        self._wheels, self._carried = WheelContacts(model), CentripetalFriction(model)
        self._points = ContactPointMotion.of(model)
        self._always_merges = bool(self._wheels) and model.opt.timestep > MAX_STEP_WITH_EDGES
        trees = np.append(model.body_treeid[model.geom_bodyid], -1)  # the last item is for contacts without a geom
        collides = (model.geom_contype | model.geom_conaffinity) != 0
        self._tree_of = np.where(trees >= 0, trees, model.ntree)
        moving = trees[:-1][collides & (trees[:-1] >= 0)]
        self._colliding = np.array(sorted(set(moving.tolist())), trees.dtype)  # `np.unique` imports `numpy.ma`, 8 ms
        free = np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE)
        free = free[np.isin(model.body_treeid[model.jnt_bodyid[free]], self._colliding)]
        self._free = (model.jnt_dofadr[free][:, None] + np.arange(3)).reshape(-1).astype(np.intp)
        self.is_on = collides.sum() > 1 and not has_engine_contacts(model)

    @property
    def changes_contacts(self) -> bool:
        """True if `solve` may change the constraints, so that other velocities need new constraints."""
        return bool(self._wheels) or bool(self.lines)

    def needed_use(self, data: mujoco.MjData) -> LawUse:
        """Return the part of the law for contacts that slide, hit or overlap, or for a flying or fast model.

        The result is `LawUse.NONE` in a world that uses the engine's own contacts.

        Args:
            data: MuJoCo's data with positions and velocities up to date; the contacts of wheels may change.
        """
        if not self.is_on:
            return LawUse.NONE
        lines = self.lines
        if (
            lines
            and data.ncon
            and lines.may_touch(data)
            and (lines.correct(data) or lines.reaches_edge(data, self._window))
        ):
            return LawUse.WHOLE
        if self._has_flying(data) or self._has_fast(data) or self._carried.find(data):
            return LawUse.WHOLE
        if self._points is not None and self._points.find(data):
            return LawUse.WHOLE
        if not (data.ncon and (self._always_merges or self._needs_correction(data))):
            return LawUse.NONE
        return LawUse.WHEELS if self._wheels.merge(data) and not self._needs_correction(data) else LawUse.WHOLE

    def solve(
        self,
        data: mujoco.MjData,
        closing: list[float] | None,
        use: LawUse = LawUse.WHOLE,
        *,
        keeps_references: bool = False,
        probes: bool = False,
    ) -> bool:
        """Solve for accelerations and forces.

        Args:
            data: MuJoCo's data with positions and velocities up to date.
            closing: remaining approach speed [m/s] of each geom after it is stopped; None in a window without
                speculative contacts.
            use: part of the law to apply.
            keeps_references: keep the corrected references of constraints, so that the engine can solve again;
                otherwise they are restored.
            probes: check whether a new control or force makes contacts slide that do not slide yet.

        Returns:
            True if a contact was corrected.
        """
        if use is LawUse.WHEELS:
            self.solve_wheels(data)
            return False
        if not (data.ncon and self.is_on):
            mj_forward_skip(self.model, data, _AFTER_VELOCITIES, 1)
            return False
        has_lines = self.lines.correct(data)
        correction, carried, is_solved = None, self._carried.find(data), False
        has_to_look = not self._is_quiet(data)
        if has_to_look or self._always_merges:
            self._wheels.merge(data)
        motion = None
        if self._points is not None and not has_lines:  # it computes the contacts of the next step without lines
            motion = self._points.correct(data, carried)
        if probes:
            correction, is_solved = self._find(data, closing, self._residual(data)), True
        elif has_to_look:
            correction, is_solved = self._found(data, closing)
        before: list[tuple[int, float]] = []
        if carried or motion is not None:
            engine = data.efc_aref.copy()
            if correction is not None:
                correction.stop_slip()
            before = self._carried.correct(data, carried, engine) if carried else []
            if motion is not None:
                before += motion.shift_tangents()
            if correction is not None:
                correction.read_references()
        if correction is not None:
            self._repeat(data, correction)
        elif before or not is_solved:
            mj_forward_skip(self.model, data, _AFTER_VELOCITIES, 1)
        if not keeps_references:
            for row, reference in before:
                data.efc_aref[row] = reference
            if correction is not None:
                correction.restore()
        if motion is not None:
            motion.restore(keeps_references=keeps_references)
        return correction is not None

    def solve_wheels(self, data: mujoco.MjData) -> None:
        """Solve for accelerations and forces with `LawUse.WHEELS`, as `solve` does."""
        self._wheels.merge(data)
        mj_forward_skip(self.model, data, _AFTER_VELOCITIES, 1)

    def _needs_correction(self, data: mujoco.MjData) -> bool:
        """Check whether a contact needs a correction."""
        return not self._is_quiet(data) and self._found(data, None)[0] is not None

    def _found(self, data: mujoco.MjData, closing: list[float] | None) -> tuple[AnyContactCorrection | None, bool]:
        """Return the contacts to correct, and True if the engine's solution was computed for the decision.

        The velocities alone do not tell whether a contact slides: under a wheel that creeps, friction may give what the
        velocities require. The acceleration of the previous step tells most cases apart, the engine's solution the
        rest.
        """
        correction = self._find(data, closing)
        if (
            correction is None
            or not correction.may_creep
            or not correction.creeps(self._multiplied(data, data.qacc_warmstart))
        ):
            return correction, False
        mj_forward_skip(self.model, data, _AFTER_VELOCITIES, 1)
        return (None if correction.creeps(self._multiplied(data, data.qacc), data.efc_force) else correction), True

    def _residual(self, data: mujoco.MjData) -> Floats:
        """Return aref - J a - R f of the engine's solution, shape (nefc,)."""
        mj_forward_skip(self.model, data, _AFTER_VELOCITIES, 1)
        residual: Floats = data.efc_aref - self._multiplied(data, data.qacc) - data.efc_R * data.efc_force
        return residual

    def _has_flying(self, data: mujoco.MjData) -> bool:
        """Check whether an awake tree with collisions touches nothing, so that it may land within the window."""
        trees = self._colliding
        # a body exactly on a surface has a contact without rows, and no force yet
        if len(trees) < 2 or data.nefc == data.ne + data.nf + data.nl:
            return len(trees) > 0 and data.nefc == data.ne + data.nf + data.nl
        contact = data.contact
        touching = contact.geom[contact.efc_address >= 0]
        touches = np.zeros(self.model.ntree + 1, bool)
        touches[self._tree_of[touching]] = True
        return bool((~touches[trees] & (data.tree_asleep[trees] < 0)).any())

    def _has_fast(self, data: mujoco.MjData) -> bool:
        """Check whether a freely moving body is so fast that a hit within the window matters."""
        velocities = data.qvel.take(self._free)
        if squared_length(velocities, FAST_SPEED * FAST_SPEED) <= FAST_SPEED * FAST_SPEED:  # no body can be fast
            return False
        return bool((np.abs(velocities) > FAST_SPEED).any())

    def _is_quiet(self, data: mujoco.MjData) -> bool:
        """Check whether all constraints are nearly at rest and no reference separates bodies fast."""
        if squared_length(data.efc_vel, QUIET_SPEED * QUIET_SPEED) > QUIET_SPEED * QUIET_SPEED:
            return False
        return bool(squared_length(data.efc_aref, self._least_reference) < self._least_reference)

    def _find(
        self, data: mujoco.MjData, closing: list[float] | None, residual: Floats | None = None
    ) -> AnyContactCorrection | None:
        """Return the contacts whose normal references need a correction."""
        gravity: list[float] = self._gravity.tolist()
        around = self._around
        if gravity != around.gravity:
            around.gravity = gravity
            around.tolerance = TOLERANCE * max(_MIN_GRAVITY, math.hypot(*gravity))
        around.closing = closing
        if self._has_fields:
            around.inner = self._fields.inner(data)
        if data.ncon > ARRAY_THRESHOLD or self._is_pyramid:
            return find_array_correction(self.model, data, around, residual)
        return find_correction(data, around, residual)

    def _repeat(self, data: mujoco.MjData, correction: AnyContactCorrection) -> None:
        """Solve, correct the normal references by the solution, and repeat until they converge."""
        model, start, before = self.model, data.qacc_warmstart, None
        correction.guess(self._multiplied(data, start))
        mj_forward_skip(model, data, _AFTER_VELOCITIES, 1)
        for _ in range(MAX_SOLUTIONS - 1):
            if correction.correct(self._multiplied(data, data.qacc), data.efc_force):
                break
            if before is None:
                before = start.copy()
            start[:] = data.qacc  # only references have changed: most islands are solved already
            mj_fwd_constraint(model, data)
        else:
            correction.settle()
            mj_fwd_constraint(model, data)
        if before is not None:
            start[:] = before  # part of the state: a forward pass must not change it

    def _multiplied(self, data: mujoco.MjData, acceleration: Floats) -> Floats:
        """Return J a, shape (nefc,); the next call reuses the array."""
        if self._product.size != data.nefc:
            self._product = np.empty(data.nefc)
        mj_mul_jac_vec(self.model, data, self._product, acceleration)
        return self._product
