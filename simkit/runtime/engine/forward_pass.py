"""Forward pass of MuJoCo: accelerations and forces of the state at a tick, for the next step and for readers."""

from __future__ import annotations

import copy

import mujoco
import numpy as np

from simkit.runtime.contact.contact_law import ContactLaw, ContactShaper, LawUse
from simkit.runtime.contact.speculative_contacts import FastBodyDetector
from simkit.runtime.engine.physics_state import (
    CONTROL,
    FRESH,
    INTEGRATION_STATE,
    OPEN_WINDOWS,
    STALE,
    VELOCITY,
    HeldState,
    PhysicsState,
    set_speculative,
)

SKIPPED_STAGE = {CONTROL: int(mujoco.mjtStage.mjSTAGE_VEL), VELOCITY: int(mujoco.mjtStage.mjSTAGE_POS)}
"""Last MuJoCo stage that is up to date, by the first part of the forward pass that is out of date."""

_AFTER_VELOCITIES = SKIPPED_STAGE[CONTROL]

# looked up once, because the loop calls these functions every few microseconds
mj_forward, mj_forward_skip = mujoco.mj_forward, mujoco.mj_forwardSkip
mj_fwd_position, mj_fwd_velocity = mujoco.mj_fwdPosition, mujoco.mj_fwdVelocity
mj_get_state, mj_rne_post_constraint = mujoco.mj_getState, mujoco.mj_rnePostConstraint


class ForwardPass(PhysicsState):
    """Physics state whose accelerations and forces are computed at the first read."""

    def fresh(self) -> mujoco.MjData:
        """Return the data with a complete forward pass of the state at this tick."""
        if self.checks_controls:
            self._check_controls()
        if self.stage:
            self._forward()
        return self.data

    def awake_data(self) -> mujoco.MjData:
        """Return data with a complete forward pass in which sleeping bodies have contacts, too; the state stays."""
        data = self.fresh()
        if not (data.tree_asleep >= 0).any():
            return data
        holding, awake = self.hold(), copy.copy(data)
        awake.tree_asleep[:] = -1
        options = self.model.opt
        flags = options.enableflags
        options.enableflags = flags & ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)
        try:
            self._forward_held(holding, awake)  # with the contact law of the step, as for the bodies that are awake
        finally:
            options.enableflags = flags
        return awake

    def fresh_velocities(self) -> bool:
        """Compute everything except accelerations for the state at this tick; the next step continues from there.

        Returns:
            True if the velocities are up to date. False if the next forward pass must wake all bodies, or if MuJoCo's
            integrator cannot continue from computed velocities.
        """
        if self.stage < VELOCITY:
            return True
        if self.sleep.wants_all_awake or self._integrate is None:
            return False
        self._update_velocities()
        return True

    def _update_velocities(self) -> None:
        if not self._is_analysed:
            self._analyse_if_changed()
        model, data, shaper = self.model, self.data, self._acting_shaper
        if self.tick >= self._fast_until:
            self._look_for_fast()
        if self.sleep.wants_all_awake:
            self.sleep.forward()
        else:
            # contacts are changed right after their detection, not a second time later
            if self.stage == STALE or shaper is not None or self.law.changes_contacts:
                mj_fwd_position(model, data)
            mj_fwd_velocity(model, data)
        if shaper is not None:
            self.law.lines.correct(data)
            shaper.shape(data)
        self.stage = CONTROL

    def _look_for_fast(self) -> None:
        """Decide at the beginning of a window, from the state alone, whether the window needs speculative contacts."""
        is_open = self._space.is_open(self.data)
        self._fast_until = self._end_of_window(is_open)
        is_fast = not is_open and self.fast_bodies.wants(self.data)
        if is_fast != self._is_fast:
            self._is_fast = is_fast
            set_speculative(self.model, is_fast)
            self.stage = STALE  # contact detection changes

    def _end_of_window(self, is_open: bool) -> int:
        """Return the tick of the next check; bodies that are far from everything need fewer checks."""
        window = OPEN_WINDOWS * self._window if is_open else self._window
        return (self.tick // window + 1) * window

    def _tumbles(self) -> bool:
        """Check whether a flying body needs the integrator of free motion, which acts in steps by the contact law."""
        motion = self.free_motion
        return motion is not None and motion.can_fly and motion.is_needed(self.data)

    @property
    def _closing(self) -> list[float] | None:
        """Limits of the approach speeds of geoms in this window; None without speculative contacts."""
        return self.fast_bodies.closing if self._is_fast else None

    @property
    def _acting_shaper(self) -> ContactShaper | None:
        """Contact shaper; None if it has nothing to change now."""
        shaper = self.shaper
        return shaper if shaper is not None and shaper.acts else None

    def _forward(self) -> None:
        """Complete the forward pass, with the contact law if the steps of this window need it."""
        model, data, stage = self.model, self.data, self.stage
        is_shaped = self._acting_shaper is not None
        if self._integrate is None or not (self.tick >= self._until or self._uses_law or self._probes or is_shaped):
            if stage != STALE:
                mj_forward_skip(model, data, SKIPPED_STAGE[stage], 1)
            elif self.sleep.wants_all_awake:
                self.sleep.forward()
            else:
                mj_forward(model, data)
            self.stage = FRESH
            return
        if stage > CONTROL:
            self._update_velocities()
        has_new_forces = self._probes or self.tick >= self._until
        if self.tick >= self._until:
            self._is_open = not (data.ncon or self._tumbles()) and self._space.is_open(data)
            self._until = self._end_of_window(self._is_open)
            if self._is_open:
                self._uses_law = LawUse.NONE
            else:
                self.stage = STALE  # the check may change contacts, and an interrupt may end it
                self._uses_law = LawUse.WHOLE if self._is_fast else self.law.needed_use(data)
        if self._probes:
            self._probes = False
            self.stage = STALE  # an interrupt during the solve leaves unfinished constraints
            if self.law.solve(data, self._closing, probes=True):
                self._uses_law = LawUse.WHOLE
        elif is_shaped or (self._uses_law and not (has_new_forces and self._uses_law is LawUse.WHEELS)):
            self.stage = STALE
            self.law.solve(data, self._closing, LawUse.WHOLE if is_shaped else self._uses_law)
        else:  # the check has already changed the contacts of wheels
            mj_forward_skip(model, data, _AFTER_VELOCITIES, 1)
        if self._is_open and has_new_forces and self._space.is_pushed(data):
            self._until = self._fast_until = -1
        self.stage = FRESH

    def _check_controls(self) -> None:
        """Detect controls that were written directly to the engine's data."""
        if not np.array_equal(self._controls, self.data.ctrl):
            self._controls[:] = self.data.ctrl
            self.changed(CONTROL)

    def fresh_accelerations(self) -> mujoco.MjData:
        """Return the data with a forward pass, body accelerations and the forces between bodies.

        The forces of the last step are included, even if they are applied for one step only. These forces caused the
        present motion. Without them, a link that a motor holds would appear to be in free fall.
        """
        if self.shows_applied and self._has_expired_forces():
            return self.data_of(self.hold())
        data = self.fresh()
        if self._accelerations_tick != self.tick:
            mj_rne_post_constraint(self.model, data)
            self._accelerations_tick = self.tick
        return data

    def hold(self) -> HeldState:
        """Store the state of this tick with the forces of the step that led to it.

        All readers of a tick share one stored state.
        """
        if self.checks_controls:
            self._check_controls()
        if self._held is None or self._held.tick != self.tick:
            values, data = np.empty(self._held_size), self.data
            if self.shows_applied and self._has_expired_forces():
                applied, pushed = data.qfrc_applied.copy(), data.xfrc_applied.copy()
                data.qfrc_applied += self.last_applied
                data.xfrc_applied += self.last_pushed
                mj_get_state(self.model, data, values, INTEGRATION_STATE)
                data.qfrc_applied[:], data.xfrc_applied[:] = applied, pushed
            else:
                mj_get_state(self.model, data, values, INTEGRATION_STATE)
            shaper, uses_law = self.shaper, self._uses_law if self.tick < self._until else None
            if self._acting_shaper is not None:
                uses_law = LawUse.WHOLE
            request = None if shaper is None else shaper.request()
            is_fast = self._is_fast if self.tick < self._fast_until else None
            self._held = HeldState(self.tick, self.model, values, request, uses_law, is_fast, self._probes)
        return self._held

    def data_of(self, state: HeldState) -> mujoco.MjData:
        """Return an `MjData` with forward pass and accelerations of a stored state.

        The result is a second `MjData`, unless the stored state is the present one.
        """
        if self.checks_controls:  # a direct write makes the stored state differ from the present one
            self._check_controls()
        if self._held is state and state.tick == self.tick and not (self.sleep.watches or self.shows_applied):
            return self.fresh_accelerations()  # unchanged since: the next step continues from this forward pass
        if self._reader_data is None or (
            self._reader_state is not None and self._reader_state.model is not state.model
        ):
            self._reader_data = mujoco.MjData(state.model)
            self._reader_state = None
        if self._reader_state is not state:
            self._reader_state = None
            mujoco.mj_setState(state.model, self._reader_data, state.values, INTEGRATION_STATE)
            self._forward_held(state, self._reader_data)
            mujoco.mj_rnePostConstraint(state.model, self._reader_data)
            self._reader_state = state
        return self._reader_data

    def _forward_held(self, state: HeldState, data: mujoco.MjData) -> None:
        """Make the forward pass of a stored state in the same way as the step did."""
        law, shaper, fast = self.law, self.shaper, self.fast_bodies
        if law.model is not state.model:  # a spawn or a removal has replaced the model
            law, shaper, fast = ContactLaw(state.model), None, FastBodyDetector(state.model)
        is_fast = fast.wants(data) if state.is_fast is None else state.is_fast
        set_speculative(state.model, is_fast)
        try:
            mujoco.mj_forward(state.model, data)
            if self._integrate is not None:
                if shaper is not None:
                    law.lines.correct(data)
                    shaper.shape(data, state.request)
                closing, use = fast.closing if is_fast else None, state.uses_law
                if is_fast and not use:
                    use = LawUse.WHOLE
                if state.probes:
                    law.solve(data, closing, probes=True)
                elif use := law.needed_use(data) if use is None else use:
                    law.solve(data, closing, use)
                elif shaper is not None:
                    mj_forward_skip(state.model, data, _AFTER_VELOCITIES, 1)
        finally:
            set_speculative(self.model, self._is_fast)

    def _has_expired_forces(self) -> bool:
        """Check whether the last step had one-shot forces and the next step has none."""
        return not self.one_shot and bool(self.last_applied.any() or self.last_pushed.any())
