"""State of the physics between two steps: MuJoCo's model and data, and how much is up to date; report of divergence."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.engine_options import has_engine_contacts
from simkit.errors import SimulationDiverged
from simkit.runtime.contact.contact_law import ContactLaw, ContactShaper, window_length
from simkit.runtime.contact.speculative_contacts import SPECULATIVE_FLAG, FastBodyDetector
from simkit.runtime.engine.free_motion import FreeMotionIntegrator
from simkit.runtime.engine.simulated_time import Clock
from simkit.runtime.engine.sleep import Sleep

BAD_POSITION: Final = int(mujoco.mjtWarning.mjWARN_BADQPOS)
BAD_VELOCITY: Final = int(mujoco.mjtWarning.mjWARN_BADQVEL)
BAD_ACCELERATION: Final = int(mujoco.mjtWarning.mjWARN_BADQACC)
_BAD: Final = (BAD_POSITION, BAD_VELOCITY, BAD_ACCELERATION)


class EngineWarnings:
    """Texts of MuJoCo's warnings, which has one place for them in a process."""

    def __init__(self) -> None:
        self._texts: list[str] = []

    def record(self, text: str) -> None:
        """Keeps a text; an exception here would end the interpreter."""
        if len(self._texts) < 8:
            self._texts.append(text)

    def take_first(self) -> str:
        """Returns the first text and forgets all."""
        text = self._texts[0] if self._texts else ""
        self._texts.clear()
        return text


ENGINE_WARNINGS: Final = EngineWarnings()


def divergence(model: mujoco.MjModel, data: mujoco.MjData, clock: Clock, tick: int) -> SimulationDiverged:
    """Return the error for a state of which MuJoCo counts NaN or infinite numbers.

    Args:
        model, data: of MuJoCo.
        clock: gives the time of a tick.
        tick: of the state.
    """
    counts = data.warning.number
    first = max(0, tick - max(int(counts[w]) for w in _BAD))
    dof = next((int(i) for a in (data.qvel, data.qacc) for i in np.flatnonzero(~(np.abs(a) < 1e10))), None)
    if dof is None:
        info = next(int(data.warning[w].lastinfo) for w in _BAD if counts[w])
        dof = min(info, model.nv - 1)
    joint = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, int(model.dof_jntid[dof])) or f"dof {dof}"
    hint = (
        f"a gain, a force or a stiffness is too large for the step of {clock.timestep:g} s; "
        "try a smaller max_step_size, a smaller gain or command, or a larger inertia"
    )
    return SimulationDiverged(joint.split("#")[0], clock.time(first), hint, ENGINE_WARNINGS.take_first())


FRESH, CONTROL, VELOCITY, STALE = range(4)
"""How much of the forward pass is out of date: nothing, accelerations, velocities on, all."""

INTEGRATION_STATE = int(mujoco.mjtState.mjSTATE_INTEGRATION)

mj_check_pos, mj_check_vel = mujoco.mj_checkPos, mujoco.mj_checkVel  # looked up once
_INTEGRATORS = {
    int(mujoco.mjtIntegrator.mjINT_IMPLICITFAST): mujoco.mj_implicit,
    int(mujoco.mjtIntegrator.mjINT_IMPLICIT): mujoco.mj_implicit,
    int(mujoco.mjtIntegrator.mjINT_EULER): mujoco.mj_Euler,
    int(mujoco.mjtIntegrator.mjINT_RK4): lambda model, data: mujoco.mj_RungeKutta(model, data, 4),
}
_MIN_PUSH = 0.2  # [m/s²] of the rims of wheels, by a change of controls, from which contacts are looked at
_LEVER = 0.1  # [m] of what a hinge moves


class StepWindow(NamedTuple):
    """How the steps up to the next look at the contacts are made.

    Attributes:
        uses_law: whether they follow the contact law.
        until: tick of the next look at the contacts.
        is_fast: whether they have speculative contacts.
        fast_until: tick of the next look at the speeds.
        probes: whether controls or forces have changed so that contacts may begin to slide.
        probed: the controls at the last look at what they push, shape (nu,); empty for those of now.
    """

    uses_law: bool = False
    until: int = -1
    is_fast: bool = False
    fast_until: int = -1
    probes: bool = False
    probed: tuple[float, ...] = ()


@dataclass(slots=True, eq=False)
class HeldState:
    """The physics state of one tick, which is kept so that a sensor can be read later.

    Attributes:
        tick: the tick.
        model: of the engine, that the state is of.
        values: of the engine (`mjSTATE_INTEGRATION`).
        request: what plugins asked of contacts at that tick, for `ContactShaper.shape`.
        uses_law, is_fast: whether its step follows the contact law, and has speculative contacts; None where that is
            still to be found from the state.
        probes: whether controls or forces have changed before that step so that contacts may begin to slide.
    """

    tick: int
    model: mujoco.MjModel
    values: npt.NDArray[np.float64]
    request: object
    uses_law: bool | None
    is_fast: bool | None
    probes: bool

    def __deepcopy__(self, memo: dict[int, object]) -> HeldState:
        return self


class PhysicsState:
    """`MjModel` and `MjData`, the tick that they belong to, and what of them is up to date.

    Args:
        model, data: of MuJoCo.
        clock: gives the length of a step.
        may_sleep: whether bodies at rest may be left out.

    Attributes:
        law: forces of contacts that slide, hit or overlap; of the present model.
        shaper: changes contacts before they are solved for, if anything does; of the present model.
        edition: another number after everything that was written, which steps do not count as.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, clock: Clock, may_sleep: bool = True) -> None:
        mujoco.set_mju_user_warning(ENGINE_WARNINGS.record)
        self.clock, self._may_sleep = clock, may_sleep
        self.tick = self.edition = 0
        self.rebind(model, data)

    def rebind(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Other engine objects (after a spawn, a removal, a restore)."""
        self.model, self.data = model, data
        self._uses_law: bool
        self._until: int
        self._is_fast: bool
        self._fast_until: int
        self._probes: bool
        self._probed: npt.NDArray[np.float64]
        self.sleep = Sleep(model, data, self._may_sleep)
        self.shaper: ContactShaper | None = None
        self._analyse()
        self._window = window_length(float(model.opt.timestep))
        self._push = _accelerations_by_control(model)
        self.window = StepWindow()
        self.stage = STALE
        self.edition += 1
        self.one_shot = False
        self.last_applied = np.zeros(model.nv)
        self.last_pushed = np.zeros((model.nbody, 6))
        self.persistent_wrenches = np.zeros((model.nbody, 6))
        self.shows_applied = True
        self._accelerations_tick = -1
        self._held: HeldState | None = None
        self._held_size = mujoco.mj_stateSize(model, INTEGRATION_STATE)
        self._reader_data: mujoco.MjData | None = None
        self._reader_state: HeldState | None = None
        self._warnings = data.warning.number
        self.checks_controls = False  # whether the user may write to `data.ctrl` without a word
        self._controls = data.ctrl.copy()
        self._integrate = _INTEGRATORS.get(int(model.opt.integrator))
        self._has_stages = model.opt.integrator == mujoco.mjtIntegrator.mjINT_RK4

    def _analyse(self) -> None:
        """Find out of the model what decides how steps are made."""
        model = self.model
        self.law, self.fast_bodies = ContactLaw(model), FastBodyDetector(model)
        is_implicit = model.opt.integrator == mujoco.mjtIntegrator.mjINT_IMPLICITFAST
        self.free_motion = FreeMotionIntegrator.of(model) if is_implicit and not has_engine_contacts(model) else None
        self._analysed, self._is_analysed = _step_fields(model), True

    def _analyse_if_changed(self) -> None:
        """Do it once more if a field was written to that it depends on, so that it follows from the present model."""
        self._is_analysed = True
        if _step_fields(self.model) != self._analysed:
            on_approach = self.fast_bodies.on_approach
            self._analyse()
            self.fast_bodies.on_approach = on_approach

    # ------------------------------------------------------------------ writing

    def changed(self, stage: int) -> None:
        """Says that controls or forces (CONTROL), velocities (VELOCITY) or positions (STALE) were written."""
        self.stage = max(self.stage, stage)
        self.edition += 1
        self._held = None
        self._accelerations_tick = -1
        self.sleep.rests = False
        if stage > CONTROL:
            self._until = self._fast_until = -1  # velocities are others than those that decided how steps are made
        elif not self._probes:
            self._probes = self.one_shot or self._is_pushed()

    def changed_body(self, stage: int, body: int) -> None:
        """The same of one body, which wakes where it sleeps."""
        self.changed(STALE if self.sleep.watches and self.sleep.wake(body) else stage)

    def set_persistent_wrenches(
        self, wrenches: Mapping[int, npt.NDArray[np.float64]], *, are_applied: bool = False
    ) -> None:
        """Wrenches (force, torque) on bodies that hold until they are set anew; all others are let go.

        Args:
            are_applied: the data have them already (a restored state).
        """
        before = self.persistent_wrenches
        self.persistent_wrenches = np.zeros_like(before)
        for body, wrench in wrenches.items():
            self.persistent_wrenches[body] = wrench
            if are_applied and not self.data.xfrc_applied[body].any():
                self.data.xfrc_applied[body] = wrench  # a link that came back by its name
        if not are_applied:
            self.data.xfrc_applied += self.persistent_wrenches - before
            for changed in np.flatnonzero((self.persistent_wrenches != before).any(axis=1)):
                self.changed_body(CONTROL, int(changed))

    def applied_forces(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Forces on joints, shape (nv,), and on bodies, shape (nbody, 6), of the last step [N, N m].

        Those that hold for one step are gone from the state by then, and remembered.
        """
        applied, pushed = self.data.qfrc_applied, self.data.xfrc_applied
        if self.shows_applied:
            return self.last_applied + applied, self.last_pushed + pushed
        return applied, pushed

    def changed_surface(self) -> None:
        """Says that a surface runs otherwise than before: whatever may lie on it wakes."""
        if self.sleep.is_drowsy or (self.data.tree_asleep >= 0).any():
            self.sleep.wake_all()
        self.changed(STALE)

    def changed_model(self) -> None:
        """Says that the model itself is about to be written to: everything wakes."""
        self.sleep.wake_all()
        self._reader_data, self._is_analysed = None, False
        self.changed(STALE)

    def changed_lights(self) -> None:
        """Says that lights of the model moved: where bodies may sleep, the engine computes those of the world once."""
        self._reader_data = None
        options = self.model.opt
        flags = options.enableflags
        options.enableflags = flags & ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)
        mujoco.mj_camlight(self.model, self.data)
        options.enableflags = flags

    def changed_contacts(self) -> None:
        """Says that contacts are to be found anew."""
        self.changed(STALE)

    def check(self) -> None:
        """Raises SimulationDiverged where the engine met a bad number since the last reset of its counters."""
        if self.sleep.rests:  # found sound before
            return
        data = self.data
        mj_check_pos(self.model, data)
        mj_check_vel(self.model, data)
        counts = self._warnings
        if counts[BAD_POSITION] or counts[BAD_VELOCITY] or counts[BAD_ACCELERATION]:
            raise divergence(self.model, data, self.clock, self.tick)

    def clear_warnings(self) -> None:
        """Forgets what the engine warned of (a restored state is sound)."""
        self._warnings[:] = 0
        ENGINE_WARNINGS.take_first()

    # ------------------------------------------------------------------ how the next steps are made

    @property
    def window(self) -> StepWindow:
        """How the steps up to the next look are made; part of the state."""
        return StepWindow(
            self._uses_law, self._until, self._is_fast, self._fast_until, self._probes, tuple(self._probed.tolist())
        )

    @window.setter
    def window(self, value: StepWindow) -> None:
        self._uses_law, self._until, self._is_fast, self._fast_until, self._probes, probed = value
        self._probed = np.array(probed) if len(probed) == self.model.nu else self.data.ctrl.copy()
        set_speculative(self.model, self._is_fast)

    def _is_pushed(self) -> bool:
        """Return whether controls differ so much from those of the last look that wheels may begin to slip."""
        change = (self.data.ctrl - self._probed) * self._push
        if change.dot(change) <= _MIN_PUSH * _MIN_PUSH:
            return False
        self._probed[:] = self.data.ctrl
        return True


def _step_fields(model: mujoco.MjModel) -> list[bytes]:
    """Return the fields of a model that are written to in a run and decide how steps are made."""
    fields = model.geom_contype, model.geom_conaffinity, model.jnt_range, model.jnt_limited
    return [field.tobytes() for field in (*fields, model.dof_damping, model.dof_frictionloss)]


def set_speculative(model: mujoco.MjModel, is_on: bool) -> None:
    flags = model.opt.enableflags
    model.opt.enableflags = flags | SPECULATIVE_FLAG if is_on else flags & ~SPECULATIVE_FLAG


def _accelerations_by_control(model: mujoco.MjModel) -> npt.NDArray[np.float64]:
    """Return how fast a unit of each control accelerates what its joint moves [m/s²], shape (nu,)."""
    found = np.zeros(model.nu)
    for i in range(model.nu):
        if model.actuator_trntype[i] == mujoco.mjtTrn.mjTRN_JOINT:
            joint = int(model.actuator_trnid[i, 0])
            lever = 1.0 if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_SLIDE else _LEVER
            found[i] = lever * model.actuator_gainprm[i, 0] * model.dof_invweight0[model.jnt_dofadr[joint]]
    return found
