"""The engine's state between two steps, and how it advances.

After `mj_step` the positions are one step ahead of everything computed from them, so whoever reads first makes the
forward pass again. To go on from there the engine need not repeat it: integrating the forward that is there, then
stepping k-1 times, gives the bits of k steps.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.engine_options import has_engine_contacts
from simkit.errors import SimulationDiverged
from simkit.runtime.contact.contact_law import ContactLaw, ContactShaper, window_length
from simkit.runtime.contact.speculative_contacts import SPECULATIVE_FLAG, FastBodyDetector
from simkit.runtime.engine.clock import Clock
from simkit.runtime.engine.control_callback import call_before_forces
from simkit.runtime.engine.free_motion import FreeMotionIntegrator
from simkit.runtime.engine.held_state import HeldState
from simkit.runtime.engine.sleep import Sleep

FRESH, CONTROL, VELOCITY, STALE = range(4)
"""How much of the forward pass is out of date: nothing, accelerations, velocities on, all."""

_SKIP = {CONTROL: int(mujoco.mjtStage.mjSTAGE_VEL), VELOCITY: int(mujoco.mjtStage.mjSTAGE_POS)}
_INTEGRATORS = {
    int(mujoco.mjtIntegrator.mjINT_IMPLICITFAST): mujoco.mj_implicit,
    int(mujoco.mjtIntegrator.mjINT_IMPLICIT): mujoco.mj_implicit,
    int(mujoco.mjtIntegrator.mjINT_EULER): mujoco.mj_Euler,
    int(mujoco.mjtIntegrator.mjINT_RK4): lambda model, data: mujoco.mj_RungeKutta(model, data, 4),
}
_BAD = _BAD_POS, _BAD_VEL, _BAD_ACC = [
    int(w)
    for w in (mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC)
]
# looked up once: the loop calls them every few microseconds
mj_step, mj_forward, mj_forward_skip = mujoco.mj_step, mujoco.mj_forward, mujoco.mj_forwardSkip
mj_fwd_position, mj_fwd_velocity = mujoco.mj_fwdPosition, mujoco.mj_fwdVelocity
mj_get_state, mj_rne_post_constraint = mujoco.mj_getState, mujoco.mj_rnePostConstraint
mj_check_pos, mj_check_vel, mj_check_acc = mujoco.mj_checkPos, mujoco.mj_checkVel, mujoco.mj_checkAcc

_INTEGRATION_STATE = int(mujoco.mjtState.mjSTATE_INTEGRATION)
_WALL_LIMIT = 0.04  # [s] of one call into the engine, so that an interrupt is heard

_AFTER_VELOCITIES = _SKIP[CONTROL]
_MIN_PUSH = 0.2  # [m/s²] of the rims of wheels, by a change of controls, from which contacts are looked at
_LEVER = 0.1  # [m] of what a hinge moves
_SHORT_RUN = 16  # steps; so few are not timed, which costs as much as a small step

_engine_warnings: list[str] = []


def _record_engine_warning(text: str) -> None:
    # an exception here would kill the interpreter, so the text is only kept
    if len(_engine_warnings) < 8:
        _engine_warnings.append(text)


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


class Physics:
    """`MjModel` and `MjData`, the tick they stand at, and what of them is up to date.

    Attributes:
        law: forces of contacts that slide, hit or overlap; of the present model.
        shaper: changes contacts before they are solved for, if anything does; of the present model.
        edition: another number after everything that was written, which steps do not count as.
    """

    def __init__(self, model: Any, data: Any, clock: Clock, may_sleep: bool = True) -> None:
        mujoco.set_mju_user_warning(_record_engine_warning)
        self.clock, self._may_sleep = clock, may_sleep
        self.tick = self.edition = 0
        self._take_chunk(256)
        self.rebind(model, data)

    def rebind(self, model: Any, data: Any) -> None:
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
        self.standing = np.zeros((model.nbody, 6))
        self.shows_applied = True
        self._accelerations_tick = -1
        self._held: HeldState | None = None
        self._held_size = mujoco.mj_stateSize(model, _INTEGRATION_STATE)
        self._second: Any = None
        self._second_of: HeldState | None = None
        self._warnings = data.warning.number
        self.hears_controls = False  # whether the user may write to `data.ctrl` without a word
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

    def _analyse_again(self) -> None:
        """Do it once more if a field was written to that it depends on, so that it follows from the present model."""
        self._is_analysed = True
        if _step_fields(self.model) != self._analysed:
            tell = self.fast_bodies.tell
            self._analyse()
            self.fast_bodies.tell = tell

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
        self.changed(STALE if self.sleep.watches and self.sleep.rouse(body) else stage)

    def stand(self, wrenches: Mapping[int, npt.NDArray[np.float64]], *, are_applied: bool = False) -> None:
        """Wrenches (force, torque) on bodies that hold until they are set anew; all others are let go.

        Args:
            are_applied: the data have them already (a restored state).
        """
        before = self.standing
        self.standing = np.zeros_like(before)
        for body, wrench in wrenches.items():
            self.standing[body] = wrench
            if are_applied and not self.data.xfrc_applied[body].any():
                self.data.xfrc_applied[body] = wrench  # a link that came back by its name
        if not are_applied:
            self.data.xfrc_applied += self.standing - before
            for changed in np.flatnonzero((self.standing != before).any(axis=1)):
                self.changed_body(CONTROL, int(changed))

    def changed_surface(self) -> None:
        """Says that a surface runs otherwise than before: whatever may lie on it wakes."""
        if self.sleep.is_drowsy or (self.data.tree_asleep >= 0).any():
            self.sleep.wake_all()
        self.changed(STALE)

    def changed_model(self) -> None:
        """Says that the model itself is about to be written to: everything wakes."""
        self.sleep.wake_all()
        self._second, self._is_analysed = None, False
        self.changed(STALE)

    def changed_lights(self) -> None:
        """Says that lights of the model moved: where bodies may sleep, the engine computes those of the world once."""
        self._second = None
        options = self.model.opt
        flags = options.enableflags
        options.enableflags = flags & ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)
        mujoco.mj_camlight(self.model, self.data)
        options.enableflags = flags

    # ------------------------------------------------------------------ reading

    def fresh(self) -> Any:
        """The data with a forward pass of the state at this tick."""
        if self.hears_controls:
            self._hear_controls()
        if self.stage:
            self._forward()
        return self.data

    def fresh_velocities(self) -> bool:
        """Compute all but accelerations for the state at this tick; the next step goes on from there.

        Returns:
            Whether it was done: not where everything is to wake, nor under an integrator of another kind.
        """
        if self.stage < VELOCITY:
            return True
        if self.sleep.wants_all_awake or self._integrate is None:
            return False
        self._update_velocities()
        return True

    def _update_velocities(self) -> None:
        if not self._is_analysed:
            self._analyse_again()
        model, data, shaper = self.model, self.data, self._acting_shaper
        if self.tick >= self._fast_until:
            self._look_for_fast()
        if self.sleep.wants_all_awake:
            self.sleep.forward()
        else:
            # what is changed of contacts is changed as they are found, not a second time
            if self.stage == STALE or shaper is not None or self.law.changes_contacts:
                mj_fwd_position(model, data)
            mj_fwd_velocity(model, data)
        if shaper is not None:
            shaper.shape(data)
        self.stage = CONTROL

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
        _set_speculative(self.model, self._is_fast)

    def _is_pushed(self) -> bool:
        """Return whether controls differ so much from those of the last look that wheels may begin to slip."""
        change = (self.data.ctrl - self._probed) * self._push
        if change.dot(change) <= _MIN_PUSH * _MIN_PUSH:
            return False
        self._probed[:] = self.data.ctrl
        return True

    def _look_for_fast(self) -> None:
        """Decide at the beginning of a window, from the state alone, whether it needs speculative contacts."""
        self._fast_until = (self.tick // self._window + 1) * self._window
        is_fast = self.fast_bodies.wants(self.data)
        if is_fast != self._is_fast:
            self._is_fast = is_fast
            _set_speculative(self.model, is_fast)
            self.stage = STALE  # contacts are found otherwise

    @property
    def _closing(self) -> list[float] | None:
        """The speeds at which geoms may still close in this window, if it has speculative contacts."""
        return self.fast_bodies.closing if self._is_fast else None

    @property
    def _acting_shaper(self) -> ContactShaper | None:
        """The shaper, if it has anything to change now."""
        shaper = self.shaper
        return shaper if shaper is not None and shaper.acts else None

    def _forward(self) -> None:
        """Complete the forward pass: with the contact law where the steps of this window need it."""
        model, data, stage = self.model, self.data, self.stage
        is_shaped = self._acting_shaper is not None
        if self._integrate is None or not (self.tick >= self._until or self._uses_law or self._probes or is_shaped):
            if stage != STALE:
                mj_forward_skip(model, data, _SKIP[stage], 1)
            elif self.sleep.wants_all_awake:
                self.sleep.forward()
            else:
                mj_forward(model, data)
            self.stage = FRESH
            return
        if stage > CONTROL:
            self._update_velocities()
        if self.tick >= self._until:
            self._until = (self.tick // self._window + 1) * self._window
            self._uses_law = self._is_fast or self.law.is_needed(data)
        if self._probes:
            self._probes = False
            self.stage = STALE  # an interrupt amid it leaves constraints as they are while it solves
            self._uses_law = self.law.solve(data, self._closing, probes=True) or self._uses_law
        elif self._uses_law or is_shaped:
            self.stage = STALE
            self.law.solve(data, self._closing)
        else:
            mj_forward_skip(model, data, _AFTER_VELOCITIES, 1)
        self.stage = FRESH

    def _hear_controls(self) -> None:
        """Notices controls that were written to the engine's data directly."""
        if not np.array_equal(self._controls, self.data.ctrl):
            self._controls[:] = self.data.ctrl
            self.changed(CONTROL)

    def fresh_accelerations(self) -> Any:
        """The same, with body accelerations and the forces between bodies.

        Forces of the last step only are counted in: they made the motion, and what a motor holds is not in free fall.
        """
        if self.shows_applied and self._has_passed():
            return self.data_of(self.hold())
        data = self.fresh()
        if self._accelerations_tick != self.tick:
            mj_rne_post_constraint(self.model, data)
            self._accelerations_tick = self.tick
        return data

    def hold(self) -> HeldState:
        """The state of this tick, with the forces of the step that led to it, shared by all who ask at it."""
        if self.hears_controls:
            self._hear_controls()
        if self._held is None or self._held.tick != self.tick:
            values, data = np.empty(self._held_size), self.data
            if self.shows_applied and self._has_passed():
                applied, pushed = data.qfrc_applied.copy(), data.xfrc_applied.copy()
                data.qfrc_applied += self.last_applied
                data.xfrc_applied += self.last_pushed
                mj_get_state(self.model, data, values, _INTEGRATION_STATE)
                data.qfrc_applied[:], data.xfrc_applied[:] = applied, pushed
            else:
                mj_get_state(self.model, data, values, _INTEGRATION_STATE)
            shaper, uses_law = self.shaper, self._uses_law if self.tick < self._until else None
            if self._acting_shaper is not None:
                uses_law = True
            request = None if shaper is None else shaper.request()
            is_fast = self._is_fast if self.tick < self._fast_until else None
            self._held = HeldState(self.tick, self.model, values, request, uses_law, is_fast, self._probes)
        return self._held

    def data_of(self, held: HeldState) -> Any:
        """An `MjData` with forward pass and accelerations of a held state: a second one, unless it is that of now."""
        if self.hears_controls:  # those of the held state are others then
            self._hear_controls()
        if self._held is held and held.tick == self.tick and not (self.sleep.watches or self.shows_applied):
            return self.fresh_accelerations()  # nothing was written since: the step goes on from it
        if self._second is None or (self._second_of is not None and self._second_of.model is not held.model):
            self._second = mujoco.MjData(held.model)
            self._second_of = None
        if self._second_of is not held:
            self._second_of = None
            mujoco.mj_setState(held.model, self._second, held.values, _INTEGRATION_STATE)
            self._forward_held(held, self._second)
            mujoco.mj_rnePostConstraint(held.model, self._second)
            self._second_of = held
        return self._second

    def _forward_held(self, held: HeldState, data: Any) -> None:
        """Make the forward pass of a held state as the step did."""
        law, shaper, fast = self.law, self.shaper, self.fast_bodies
        if law.model is not held.model:  # a spawn or a removal has come between
            law, shaper, fast = ContactLaw(held.model), None, FastBodyDetector(held.model)
        is_fast = fast.wants(data) if held.is_fast is None else held.is_fast
        _set_speculative(held.model, is_fast)
        try:
            mujoco.mj_forward(held.model, data)
            if self._integrate is not None:
                if shaper is not None:
                    shaper.shape(data, held.request)
                closing = fast.closing if is_fast else None
                if held.probes:
                    law.solve(data, closing, probes=True)
                elif is_fast or (law.is_needed(data) if held.uses_law is None else held.uses_law):
                    law.solve(data, closing)
                elif shaper is not None:
                    mj_forward_skip(held.model, data, _AFTER_VELOCITIES, 1)
        finally:
            _set_speculative(self.model, self._is_fast)

    def _has_passed(self) -> bool:
        """Whether the last step had forces of its own, and none is set for the next."""
        return not self.one_shot and bool(self.last_applied.any() or self.last_pushed.any())

    # ------------------------------------------------------------------ advancing

    def advance(self, count: int) -> None:
        """`count` steps; forces that hold for one step only are gone after the first."""
        sleep = self.sleep
        if not (self.shows_applied or self.one_shot or sleep.counts or sleep.wants_all_awake) and count <= self._short:
            if count > 0:
                self._steps(count)
            return
        if count <= 0:
            return
        if self.shows_applied:
            self.last_applied[:] = self.last_pushed[:] = 0
            self.shows_applied = False
        if sleep.watches and sleep.notice_gravity():
            self.changed(STALE)
        if sleep.rests and sleep.still_rests():
            self._rest(count)
            return
        if self.one_shot:
            self._run(1)
            self._clear_one_shot()
            count -= 1
            if not count:
                # what was applied in the last step is what `Joint.effort` tells of it
                self.shows_applied = True
                return
            self.last_applied[:] = self.last_pushed[:] = 0
        if 0 < count <= self._short:
            self._run(count)
            return
        while count > 0:
            chunk = min(count, self._chunk)
            before = time.perf_counter()
            self._run(chunk)
            self._tune(chunk, time.perf_counter() - before)
            count -= chunk

    def single(self) -> None:
        """One step."""
        is_odd = self._uses_law or self._probes or self.one_shot or self.shows_applied or self.sleep.watches
        is_odd = is_odd or self.shaper is not None or self.free_motion is not None
        if not is_odd and self.stage == STALE and self.tick < self._until:
            mj_step(self.model, self.data)
            self.tick += 1
        else:
            self.advance(1)

    def _rest(self, count: int) -> None:
        """Time goes on, added up as the engine does."""
        data, step = self.data, self.clock.timestep
        if count < _SHORT_RUN:
            now = data.time
            for _ in range(count):
                now += step
            data.time = now
        else:
            times = np.full(count + 1, step)
            times[0] = data.time
            data.time = times.cumsum()[-1]
        self.tick += count

    def _run(self, count: int) -> None:
        sleep = self.sleep
        if sleep.wants_all_awake:
            self.fresh()
        if sleep.is_drowsy:
            sleep.open_eyes()
            self._steps(1)
            sleep.close_eyes()
            count -= 1
        if count:
            self._steps(count)
        sleep.settle()

    def _steps(self, count: int) -> None:
        if self.hears_controls:
            self._hear_controls()
        integrate, has_shaper = self._integrate, self._acting_shaper is not None
        if integrate is None:
            mj_step(self.model, self.data, count)
            self.stage = STALE
            self.tick += count
            return
        if not self._is_analysed:
            self._analyse_again()
        end, is_corrected = self.tick + count, self.free_motion is not None
        while self.tick < end:
            if is_corrected or has_shaper or self._uses_law or self._probes or self.tick >= self._until:
                self._step_by_law(integrate)
            else:
                self._plain_steps(min(end, self._until) - self.tick, integrate)

    def _plain_steps(self, count: int, integrate: Callable[[Any, Any], None]) -> None:
        """Steps by the engine alone, which goes on from what of the forward pass is there."""
        model, data, stage = self.model, self.data, self.stage
        if stage == STALE:
            mj_step(model, data, count)
        else:
            if stage:
                mj_forward_skip(model, data, _SKIP[stage], 1)
            mj_check_acc(model, data)
            integrate(model, data)
            if count > 1:
                mj_step(model, data, count - 1)
        self.stage = STALE
        self.tick += count

    def _step_by_law(self, integrate: Callable[[Any, Any], None]) -> None:
        """One step that stops at the velocities, to look at the contacts and to solve for them by the law."""
        model, data, stage, free_motion = self.model, self.data, self.stage, self.free_motion
        if stage == STALE:
            mj_check_pos(model, data)
            mj_check_vel(model, data)
        is_decided = self._uses_law and self.tick < self._until and self.tick < self._fast_until
        if is_decided and stage == STALE and not (self._probes or self.shaper or self.sleep.wants_all_awake):
            mj_fwd_position(model, data)  # `_forward` without its questions: a tenth of a step with one box
            mj_fwd_velocity(model, data)
            self.law.solve(data, self._closing)
        elif stage:
            self._forward()
        mj_check_acc(model, data)
        self.stage = STALE
        if free_motion is not None:  # after the forward pass, which wakes who sleeps
            free_motion.prepare(data)
        if self._has_stages and (self._uses_law or self._acting_shaper is not None):
            with call_before_forces(data, self._correct_stage):
                integrate(model, data)
        else:
            integrate(model, data)
        if free_motion is not None:
            free_motion.correct(data)
        self.tick += 1

    def _correct_stage(self) -> None:
        """Change the contacts of one of the inner stages of an integrator; the engine then solves for them."""
        shaper = self._acting_shaper
        if shaper is not None:
            shaper.shape(self.data)
        self.law.solve(self.data, self._closing, keeps_references=True)

    def _clear_one_shot(self) -> None:
        self.last_applied[:] = self.data.qfrc_applied
        self.last_pushed[:] = self.data.xfrc_applied - self.standing
        self.data.qfrc_applied[:] = 0
        self.data.xfrc_applied[:] = self.standing
        self.one_shot = False

    def _tune(self, chunk: int, wall: float) -> None:
        if wall > _WALL_LIMIT and chunk > 1:
            self._take_chunk(max(1, chunk // 2))
        elif wall < _WALL_LIMIT / 4 and chunk == self._chunk:
            self._take_chunk(min(1 << 16, chunk * 2))

    def _take_chunk(self, steps: int) -> None:
        self._chunk, self._short = steps, min(steps, _SHORT_RUN)

    def check(self) -> None:
        """Raises SimulationDiverged where the engine met a bad number since the last reset of its counters."""
        if self.sleep.rests:  # found sound before
            return
        data = self.data
        mj_check_pos(self.model, data)
        mj_check_vel(self.model, data)
        counts = self._warnings
        if counts[_BAD_POS] or counts[_BAD_VEL] or counts[_BAD_ACC]:
            self._diverged()

    def _diverged(self) -> None:
        model, data = self.model, self.data
        bad = max(int(self._warnings[w]) for w in _BAD)
        first = max(0, self.tick - bad)
        dof = next((int(i) for a in (data.qvel, data.qacc) for i in np.flatnonzero(~(np.abs(a) < 1e10))), None)
        if dof is None:
            info = next(int(data.warning[w].lastinfo) for w in _BAD if self._warnings[w])
            dof = min(info, model.nv - 1)
        joint = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, int(model.dof_jntid[dof])) or f"dof {dof}"
        text = _engine_warnings[0] if _engine_warnings else ""
        _engine_warnings.clear()
        step = self.clock.timestep
        hint = (
            f"a gain, a force or a stiffness is too large for the step of {step:g} s; "
            "try a smaller max_step_size, a smaller gain or command, or a larger inertia"
        )
        raise SimulationDiverged(joint.split("#")[0], self.clock.time(first), hint, text)

    def clear_warnings(self) -> None:
        """Forgets what the engine warned of (a restored state is sound)."""
        self._warnings[:] = 0
        _engine_warnings.clear()


def _step_fields(model: Any) -> list[bytes]:
    """Return the fields of a model that are written to in a run and decide how steps are made."""
    fields = model.geom_contype, model.geom_conaffinity, model.jnt_range, model.jnt_limited
    return [field.tobytes() for field in (*fields, model.dof_damping, model.dof_frictionloss)]


def _set_speculative(model: Any, is_on: bool) -> None:
    flags = model.opt.enableflags
    model.opt.enableflags = flags | SPECULATIVE_FLAG if is_on else flags & ~SPECULATIVE_FLAG


def _accelerations_by_control(model: Any) -> npt.NDArray[np.float64]:
    """Return how fast a unit of each control accelerates what its joint moves [m/s²], shape (nu,)."""
    found = np.zeros(model.nu)
    for i in range(model.nu):
        if model.actuator_trntype[i] == mujoco.mjtTrn.mjTRN_JOINT:
            joint = int(model.actuator_trnid[i, 0])
            lever = 1.0 if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_SLIDE else _LEVER
            found[i] = lever * model.actuator_gainprm[i, 0] * model.dof_invweight0[model.jnt_dofadr[joint]]
    return found
