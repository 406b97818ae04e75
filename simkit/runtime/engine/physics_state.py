"""State of the physics between two steps: MuJoCo's model and data, the outdated parts of the data, and divergence."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.actuator_gains import unstable_gains
from simkit.compiler.engine_options import has_engine_contacts
from simkit.errors import SimulationDiverged
from simkit.linear_algebra import squared_length
from simkit.runtime.contact.contact_law import ContactLaw, ContactShaper, LawUse, window_length
from simkit.runtime.contact.open_space import OpenSpace
from simkit.runtime.contact.speculative_contacts import SPECULATIVE_FLAG, ApproachCallback, FastBodyDetector
from simkit.runtime.engine.free_motion import FreeMotionIntegrator
from simkit.runtime.engine.passive_trees import joint_friction
from simkit.runtime.engine.pose_history import PoseHistory, PoseRows
from simkit.runtime.engine.simulated_time import Clock
from simkit.runtime.engine.sleep import RestState, Sleep

BAD_POSITION: Final = int(mujoco.mjtWarning.mjWARN_BADQPOS)
BAD_VELOCITY: Final = int(mujoco.mjtWarning.mjWARN_BADQVEL)
BAD_ACCELERATION: Final = int(mujoco.mjtWarning.mjWARN_BADQACC)
_ENGINE_TEXT: Final = re.compile(r"in Q(?:VEL|ACC) at DOF (\d+)\..* Time = ([\d.]+)\.$")
_BAD: Final = (BAD_POSITION, BAD_VELOCITY, BAD_ACCELERATION)


class EngineWarnings:
    """Texts of MuJoCo's warnings; MuJoCo has one warning callback per process."""

    def __init__(self) -> None:
        self._texts: list[str] = []

    def record(self, text: str) -> None:
        """Store the text of a warning. An exception in this method would end the interpreter."""
        if len(self._texts) < 8:
            self._texts.append(text)

    def take_first(self) -> str:
        """Return the first text and clear all texts."""
        text = self._texts[0] if self._texts else ""
        self.clear()
        return text

    def clear(self) -> None:
        """Forget all texts, such as those of a simulation that has ended."""
        self._texts.clear()


ENGINE_WARNINGS: Final = EngineWarnings()


def divergence(model: mujoco.MjModel, data: mujoco.MjData, clock: Clock, tick: int) -> SimulationDiverged:
    """Return the error for a state in which MuJoCo counted NaN or infinite numbers.

    Args:
        model: MuJoCo's model.
        data: MuJoCo's data.
        clock: conversion of ticks to time.
        tick: tick of the state.
    """
    counts = data.warning.number
    first = max(0, tick - max(int(counts[w]) for w in _BAD))
    text = ENGINE_WARNINGS.take_first()
    dof = _first_dof(text, clock.time(first), model.nv)
    if dof is None:  # the values of a later step: by then, NaN may have spread to other joints
        dof = next((int(i) for a in (data.qvel, data.qacc) for i in np.flatnonzero(~(np.abs(a) < 1e10))), None)
    if dof is None:
        info = next(int(data.warning[w].lastinfo) for w in _BAD if counts[w])
        dof = min(info, model.nv - 1)
    joint = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, int(model.dof_jntid[dof])) or f"dof {dof}"
    gains = [gain for gain in unstable_gains(model) if model.dof_treeid[gain.dof] == model.dof_treeid[dof]]
    gains.sort(key=lambda gain: gain.dof != dof)
    hint = (
        f"{gains[0].message}; {gains[0].hint}"
        if gains
        else (
            f"a gain, a force or a stiffness is too large for the step of {clock.timestep:g} s; "
            "try a smaller max_step_size, a smaller gain or command, or a larger inertia"
        )
    )
    return SimulationDiverged(joint.split("#")[0], clock.time(first), hint, text)


def _first_dof(text: str, time: float, count: int) -> int | None:
    """Return the degree of freedom that MuJoCo's warning names first; None for a warning of another time."""
    match = _ENGINE_TEXT.search(text)
    if match is None or match[2] != f"{time:.4f}" or int(match[1]) >= count:
        return None
    return int(match[1])


FRESH, CONTROL, VELOCITY, STALE = range(4)
"""Part of the forward pass that is out of date: nothing, accelerations, velocities and later, everything."""

INTEGRATION_STATE = int(mujoco.mjtState.mjSTATE_INTEGRATION)

mj_check_pos, mj_check_vel = mujoco.mj_checkPos, mujoco.mj_checkVel  # looked up once for speed
_INTEGRATORS = {
    int(mujoco.mjtIntegrator.mjINT_IMPLICITFAST): mujoco.mj_implicit,
    int(mujoco.mjtIntegrator.mjINT_IMPLICIT): mujoco.mj_implicit,
    int(mujoco.mjtIntegrator.mjINT_EULER): mujoco.mj_Euler,
    int(mujoco.mjtIntegrator.mjINT_RK4): lambda model, data: mujoco.mj_RungeKutta(model, data, 4),
}
_NEVER = 1 << 62  # tick
OPEN_WINDOWS = 4
"""Number of windows without a check of the contacts while all bodies are far from everything."""
_MIN_PUSH = 0.2  # [m/s²] least acceleration of wheel rims, by a change of controls, that starts a check of the contacts
_NEXT_TO_LIMIT = 1e-6  # relative distance from the limit in which the order of a sum may decide
_LEVER = 0.1  # [m] assumed radius of a body on a hinge


class StepWindow(NamedTuple):
    """Step method up to the next check of the contacts.

    Attributes:
        uses_law: part of the contact law that the steps follow.
        until: tick of the next check of the contacts.
        is_fast: True if the steps have speculative contacts.
        fast_until: tick of the next check of the speeds.
        probes: True if controls or forces have changed so much that contacts may begin to slide, or at
            all while the space is open.
        probed: controls at the last check of their effect, shape (nu,); empty for the present controls.
        is_open: True if all bodies are so far from everything that the steps need no check of their contacts.
    """

    uses_law: LawUse = LawUse.NONE
    until: int = -1
    is_fast: bool = False
    fast_until: int = -1
    probes: bool = False
    probed: tuple[float, ...] = ()
    is_open: bool = False


@dataclass(frozen=True, slots=True)
class PhysicsMemory:
    """State of the physics beside MuJoCo's data.

    Attributes:
        tick: tick of the state.
        one_shot: True if forces in the data last for one step only.
        last_applied: forces on joints that lasted for the last step only [N, N·m], shape (nv,).
        last_pushed: forces and torques on bodies that lasted for the last step only [N, N·m], shape (nbody, 6).
        window: step method up to the next check of the contacts.
        sleep: bodies that sleep.
        poses: recorded poses of all bodies; None if no sensor needs them.
    """

    tick: int
    one_shot: bool
    last_applied: npt.NDArray[np.float64]
    last_pushed: npt.NDArray[np.float64]
    window: StepWindow
    sleep: RestState
    poses: PoseRows | None = None


@dataclass(slots=True, eq=False)
class HeldState:
    """Stored physics state of one tick, so that a sensor can be read later.

    Attributes:
        tick: tick of the state.
        model: MuJoCo's model of the state.
        values: state vector of MuJoCo (`mjSTATE_INTEGRATION`).
        request: contact changes that plugins requested at that tick, for `ContactShaper.shape`.
        uses_law: part of the contact law that the step follows; None if a check of the state must still decide this.
        is_fast: True if the step has speculative contacts; None if a check of the state must still decide this.
        probes: True if controls or forces changed before the step so much that contacts may begin to slide.
    """

    tick: int
    model: mujoco.MjModel
    values: npt.NDArray[np.float64]
    request: object
    uses_law: LawUse | None
    is_fast: bool | None
    probes: bool

    def __deepcopy__(self, memo: dict[int, object]) -> HeldState:
        return self


class PhysicsState:
    """`MjModel` and `MjData`, their tick, and the parts of the data that are up to date.

    Args:
        model: MuJoCo's model.
        data: MuJoCo's data.
        clock: source of the step length.
        may_sleep: True if bodies at rest may sleep.
        on_approach: function that receives the approaches that speculative contacts cannot stop; it changes no state.

    Attributes:
        law: forces of contacts that slide, hit or overlap; for the present model.
        shaper: function object that changes contacts before the solve; None without changes; for the present model.
        edition: counter that changes with every write to the state, but not with steps.
        poses: record of the poses of all bodies; None if no sensor needs it.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        clock: Clock,
        may_sleep: bool = True,
        *,
        on_approach: ApproachCallback | None = None,
    ) -> None:
        mujoco.set_mju_user_warning(ENGINE_WARNINGS.record)
        ENGINE_WARNINGS.clear()
        self.clock, self._may_sleep, self._on_approach = clock, may_sleep, on_approach
        self.tick = self.edition = 0
        self.poses: PoseHistory | None = None
        self.rebind(model, data)

    def rebind(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Replace the engine objects (after a spawn, a removal or a restore)."""
        self.model, self.data = model, data
        if self.poses is not None:
            self.poses.clear()
        self._uses_law: LawUse
        self._until: int
        self._is_fast: bool
        self._fast_until: int
        self._probes: bool
        self._probed: npt.NDArray[np.float64]
        self._is_open: bool
        self.sleep = Sleep(model, data, self._may_sleep)
        self.shaper: ContactShaper | None = None
        self._analyse()
        self._window = window_length(float(model.opt.timestep))
        self.renew_pushes()
        self.window = StepWindow()
        self.stage = STALE
        self.edition += 1
        self.one_shot = False
        self.last_applied = np.zeros(model.nv)
        self.last_pushed = np.zeros((model.nbody, 6))
        self.persistent_wrenches = np.zeros((model.nbody, 6))
        self._has_wrenches = False
        self.shows_applied = True
        self._accelerations_tick = -1
        self._held: HeldState | None = None
        self._held_size = mujoco.mj_stateSize(model, INTEGRATION_STATE)
        self._reader_data: mujoco.MjData | None = None
        self._reader_state: HeldState | None = None
        self._warnings = data.warning.number
        self.checks_controls = False  # True if user code may write to `data.ctrl` directly
        self._controls = data.ctrl.copy()
        self._integrate = _INTEGRATORS.get(int(model.opt.integrator))
        self._has_stages = model.opt.integrator == mujoco.mjtIntegrator.mjINT_RK4

    def _analyse(self) -> None:
        """Derive the objects that decide the step method from the model."""
        model = self.model
        self.law, self.fast_bodies = ContactLaw(model), FastBodyDetector(model, self._on_approach)
        self._space = self._open_space()
        # an MJCF file that sets no integrator has Euler's method, with which a spinning top diverges
        is_simple = int(model.opt.integrator) in _INTEGRATORS and model.opt.integrator != mujoco.mjtIntegrator.mjINT_RK4
        self.free_motion = FreeMotionIntegrator.of(model) if is_simple and not has_engine_contacts(model) else None
        self._corrects_all = self.free_motion is not None and self.free_motion.acts_always
        self._analysed, self._is_analysed = _step_fields(model), True
        # without contacts that the law may change, no step has to check anything
        self._is_plain = not (self.law.is_on or self.fast_bodies.can_be_fast)
        self._is_free = self._is_plain and self.free_motion is not None and self.free_motion.is_alone()

    def _open_space(self) -> OpenSpace:
        timestep = float(self.model.opt.timestep)
        return OpenSpace(self.model, OPEN_WINDOWS * window_length(timestep) * timestep)

    def renew_pushes(self) -> None:
        """Compute again which accelerations the controls cause, because masses or gains have changed."""
        self._push = _accelerations_by_control(self.model).tolist()

    def _analyse_if_changed(self) -> None:
        """Repeat the analysis if one of its model fields was written to.

        The step method thus depends on the present model only.
        """
        self._is_analysed = True
        if _step_fields(self.model) != self._analysed:
            self._analyse()
        elif not self._space.is_current():
            self._space = self._open_space()
        self._until = self._fast_until = _NEVER if self._is_plain else -1

    def check_controls(self) -> None:
        """Look for direct writes to `data.ctrl` of the present model at every step, because user code may make them."""
        self.checks_controls = True

    # ------------------------------------------------------------------ writing

    def changed(self, stage: int) -> None:
        """Record a write to controls or forces (CONTROL), velocities (VELOCITY) or positions (STALE)."""
        self.stage = max(self.stage, stage)
        self.edition += 1
        self._held = None
        self._accelerations_tick = -1
        self.sleep.rests = False
        if self._is_plain:
            return
        if stage > CONTROL:
            self._until = self._fast_until = -1  # the step method was chosen for the previous velocities
        elif not self._probes:
            self._probes = self.one_shot or self._is_pushed() or self._is_open

    def changed_body(self, stage: int, body: int) -> None:
        """Record a write to one body and wake the body if it sleeps."""
        self.changed(STALE if self.sleep.watches and self.sleep.wake(body) else stage)

    def set_persistent_wrenches(
        self, wrenches: Mapping[int, npt.NDArray[np.float64]], *, are_applied: bool = False
    ) -> None:
        """Set the wrenches (force, torque) on bodies that persist until they are replaced; clear all others.

        Args:
            wrenches: wrenches by body id, shape (6,) [N, N·m].
            are_applied: True if the data already contain the wrenches (a restored state).
        """
        if not (wrenches or self._has_wrenches):
            return
        self._has_wrenches = bool(wrenches)
        before = self.persistent_wrenches
        self.persistent_wrenches = np.zeros_like(before)
        for body, wrench in wrenches.items():
            self.persistent_wrenches[body] = wrench
            if are_applied and not self.data.xfrc_applied[body].any():
                self.data.xfrc_applied[body] = wrench  # a link was spawned again under the same name
        if not are_applied:
            self.data.xfrc_applied += self.persistent_wrenches - before
            for changed in np.flatnonzero((self.persistent_wrenches != before).any(axis=1)):
                self.changed_body(CONTROL, int(changed))

    def applied_forces(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Return the applied forces on joints, shape (nv,), and on bodies, shape (nbody, 6), of the last step [N, N·m].

        Forces that lasted for one step only are included, although the state no longer contains them.
        """
        applied, pushed = self.data.qfrc_applied, self.data.xfrc_applied
        if self.shows_applied:
            return self.last_applied + applied, self.last_pushed + pushed
        return applied, pushed

    def push_once(self, is_pushed: bool = True) -> None:
        """Record that forces in the data last for the next step only, or that there are no such forces."""
        self.one_shot = is_pushed

    def record_poses(self, user: object, ticks: int) -> None:
        """Record the poses of all bodies, and keep those of at least a number of ticks for a user."""
        if self.poses is None:
            self.poses = PoseHistory()
        self.poses.require(user, ticks)

    def end_record_of_poses(self, user: object) -> None:
        """End the record of a user; the poses of the next steps are not recorded if there is no other user."""
        if self.poses is not None and not self.poses.release(user):
            self.poses = None

    def changed_surface(self) -> None:
        """Record a changed motion of a surface; wake all bodies that may lie on it."""
        if self.sleep.is_drowsy or (self.data.tree_asleep >= 0).any():
            self.sleep.wake_all()
        self.changed(STALE)

    def changed_model(self) -> None:
        """Record that the model is about to be written to; wake all bodies."""
        self.sleep.wake_all()
        self._reader_data, self._is_analysed = None, False
        self.changed(STALE)
        self._until = self._fast_until = -1  # the analysis comes before the next step

    def changed_lights(self) -> None:
        """Update moved lights in the data.

        MuJoCo computes the lights of the world only once while bodies may sleep.
        """
        self._reader_data = None
        options = self.model.opt
        flags = options.enableflags
        options.enableflags = flags & ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)
        mujoco.mj_camlight(self.model, self.data)
        options.enableflags = flags

    def use_shaper(self, shaper: ContactShaper | None) -> None:
        """Change contacts by a function object before the solve; None for no changes."""
        self.shaper = shaper

    def changed_contacts(self) -> None:
        """Record that contacts must be detected again."""
        self.changed(STALE)

    def check(self) -> None:
        """Raise SimulationDiverged if the engine met NaN or infinite numbers since the last reset of its counters."""
        if self.sleep.rests:  # the resting state was checked before
            return
        data = self.data
        mj_check_pos(self.model, data)
        mj_check_vel(self.model, data)
        counts = self._warnings
        if counts[BAD_POSITION] or counts[BAD_VELOCITY] or counts[BAD_ACCELERATION]:
            raise divergence(self.model, data, self.clock, self.tick)

    @property
    def has_diverged(self) -> bool:
        """True if the engine met NaN or infinite numbers since the last reset of its counters."""
        return bool(self._warnings[[BAD_POSITION, BAD_VELOCITY, BAD_ACCELERATION]].any())

    def clear_warnings(self) -> None:
        """Clear the engine's warnings, because a restored state has none."""
        self._warnings[:] = 0
        ENGINE_WARNINGS.take_first()

    # ------------------------------------------------------------------ state

    def state_vector(self) -> npt.NDArray[np.float64]:
        """Return MuJoCo's state vector, `mjSTATE_INTEGRATION`."""
        values = np.empty(self._held_size)
        mujoco.mj_getState(self.model, self.data, values, INTEGRATION_STATE)
        return values

    def get_state(self) -> PhysicsMemory:
        """Return the state beside MuJoCo's data, for a snapshot."""
        applied, pushed = self.last_applied.copy(), self.last_pushed.copy()
        poses = None if self.poses is None else self.poses.get_state()
        return PhysicsMemory(self.tick, self.one_shot, applied, pushed, self.window, self.sleep.get_state(), poses)

    def set_state(self, state: PhysicsMemory, *, is_model_changed: bool) -> None:
        """Restore a state from `get_state`, after the data.

        Args:
            state: state to restore.
            is_model_changed: True if fields of the model were written to.
        """
        self.tick = state.tick
        self.changed(STALE)
        if is_model_changed:
            self.changed_model()
        self.clear_warnings()
        self.one_shot = state.one_shot
        self.last_applied, self.last_pushed = state.last_applied.copy(), state.last_pushed.copy()
        self.shows_applied = True
        self.window = state.window
        self.sleep.set_state(state.sleep)
        if self.poses is not None:
            if state.poses is None:
                self.poses.clear()
            else:
                self.poses.set_state(state.poses)

    # ------------------------------------------------------------------ how the next steps are made

    @property
    def window(self) -> StepWindow:
        """Step method up to the next check of the contacts; part of the state."""
        return StepWindow(
            *(self._uses_law, self._until, self._is_fast, self._fast_until, self._probes),
            *(tuple(self._probed.tolist()), self._is_open),
        )

    @window.setter
    def window(self, value: StepWindow) -> None:
        self._uses_law, self._until, self._is_fast, self._fast_until, self._probes, probed, self._is_open = value
        if self._is_plain:
            self._uses_law, self._is_fast, self._probes, self._is_open = LawUse.NONE, False, False, False
            self._until = self._fast_until = _NEVER
        elif self._until >= _NEVER:
            self._until = self._fast_until = -1  # the state is from before collisions were enabled
        self._probed = np.array(probed) if len(probed) == self.model.nu else self.data.ctrl.copy()
        set_speculative(self.model, self._is_fast)

    def _is_pushed(self) -> bool:
        """Check whether controls changed so much since the last check that wheels may begin to slip."""
        limit, square = _MIN_PUSH * _MIN_PUSH, 0.0
        # Python's numbers overflow without a warning, and for 20 controls or fewer they take less time than NumPy's
        for now, before, push in zip(self.data.ctrl.tolist(), self._probed.tolist(), self._push, strict=True):
            change = (now - before) * push
            square += change * change
        if abs(square - limit) <= _NEXT_TO_LIMIT * limit:
            square = squared_length((self.data.ctrl - self._probed) * np.array(self._push), limit)
        if square <= limit:  # False for NaN
            return False
        self._probed[:] = self.data.ctrl
        return True


def _step_fields(model: mujoco.MjModel) -> list[bytes]:
    """Return the fields of a model that a run may write to and that decide the step method."""
    geoms = model.geom_contype, model.geom_conaffinity, model.geom_solref
    joints = model.jnt_range, model.jnt_limited, model.jnt_stiffness
    dofs = model.dof_damping, joint_friction(model), model.dof_armature, model.dof_invweight0
    bodies = model.body_inertia, model.body_ipos, model.body_iquat
    return [field.tobytes() for field in (*geoms, *joints, *dofs, *bodies)]


def set_speculative(model: mujoco.MjModel, is_on: bool) -> None:
    """Enable or disable MuJoCo's speculative contacts."""
    flags = model.opt.enableflags
    model.opt.enableflags = flags | SPECULATIVE_FLAG if is_on else flags & ~SPECULATIVE_FLAG


def _accelerations_by_control(model: mujoco.MjModel) -> npt.NDArray[np.float64]:
    """Return the acceleration [m/s²] of the driven body that one unit of each control causes, shape (nu,)."""
    accelerations = np.zeros(model.nu)
    for i in range(model.nu):
        if model.actuator_trntype[i] == mujoco.mjtTrn.mjTRN_JOINT:
            joint = int(model.actuator_trnid[i, 0])
            lever = 1.0 if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_SLIDE else _LEVER
            accelerations[i] = lever * model.actuator_gainprm[i, 0] * model.dof_invweight0[model.jnt_dofadr[joint]]
    return accelerations
