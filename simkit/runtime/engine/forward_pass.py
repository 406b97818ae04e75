"""The forward pass of MuJoCo: accelerations and forces of the state at a tick, for the next step and for readers."""

from __future__ import annotations

import mujoco
import numpy as np

from simkit.runtime.contact.contact_law import ContactLaw, ContactShaper
from simkit.runtime.contact.speculative_contacts import FastBodyDetector
from simkit.runtime.engine.physics_state import (
    CONTROL,
    FRESH,
    INTEGRATION_STATE,
    STALE,
    VELOCITY,
    HeldState,
    PhysicsState,
    set_speculative,
)

SKIPPED_STAGE = {CONTROL: int(mujoco.mjtStage.mjSTAGE_VEL), VELOCITY: int(mujoco.mjtStage.mjSTAGE_POS)}
"""The last of MuJoCo's stages that is up to date, by how much of the forward pass is not."""

_AFTER_VELOCITIES = SKIPPED_STAGE[CONTROL]

# looked up once: the loop calls them every few microseconds
mj_forward, mj_forward_skip = mujoco.mj_forward, mujoco.mj_forwardSkip
mj_fwd_position, mj_fwd_velocity = mujoco.mj_fwdPosition, mujoco.mj_fwdVelocity
mj_get_state, mj_rne_post_constraint = mujoco.mj_getState, mujoco.mj_rnePostConstraint


class ForwardPass(PhysicsState):
    """Physics state whose accelerations and forces are computed for whoever asks first."""

    def fresh(self) -> mujoco.MjData:
        """The data with a forward pass of the state at this tick."""
        if self.checks_controls:
            self._check_controls()
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
            self._analyse_if_changed()
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

    def _look_for_fast(self) -> None:
        """Decide at the beginning of a window, from the state alone, whether it needs speculative contacts."""
        self._fast_until = (self.tick // self._window + 1) * self._window
        is_fast = self.fast_bodies.wants(self.data)
        if is_fast != self._is_fast:
            self._is_fast = is_fast
            set_speculative(self.model, is_fast)
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
                mj_forward_skip(model, data, SKIPPED_STAGE[stage], 1)
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

    def _check_controls(self) -> None:
        """Notices controls that were written to the engine's data directly."""
        if not np.array_equal(self._controls, self.data.ctrl):
            self._controls[:] = self.data.ctrl
            self.changed(CONTROL)

    def fresh_accelerations(self) -> mujoco.MjData:
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
        if self.checks_controls:
            self._check_controls()
        if self._held is None or self._held.tick != self.tick:
            values, data = np.empty(self._held_size), self.data
            if self.shows_applied and self._has_passed():
                applied, pushed = data.qfrc_applied.copy(), data.xfrc_applied.copy()
                data.qfrc_applied += self.last_applied
                data.xfrc_applied += self.last_pushed
                mj_get_state(self.model, data, values, INTEGRATION_STATE)
                data.qfrc_applied[:], data.xfrc_applied[:] = applied, pushed
            else:
                mj_get_state(self.model, data, values, INTEGRATION_STATE)
            shaper, uses_law = self.shaper, self._uses_law if self.tick < self._until else None
            if self._acting_shaper is not None:
                uses_law = True
            request = None if shaper is None else shaper.request()
            is_fast = self._is_fast if self.tick < self._fast_until else None
            self._held = HeldState(self.tick, self.model, values, request, uses_law, is_fast, self._probes)
        return self._held

    def data_of(self, held: HeldState) -> mujoco.MjData:
        """An `MjData` with forward pass and accelerations of a held state: a second one, unless it is that of now."""
        if self.checks_controls:  # those of the held state are others then
            self._check_controls()
        if self._held is held and held.tick == self.tick and not (self.sleep.watches or self.shows_applied):
            return self.fresh_accelerations()  # nothing was written since: the step goes on from it
        if self._reader_data is None or (self._reader_state is not None and self._reader_state.model is not held.model):
            self._reader_data = mujoco.MjData(held.model)
            self._reader_state = None
        if self._reader_state is not held:
            self._reader_state = None
            mujoco.mj_setState(held.model, self._reader_data, held.values, INTEGRATION_STATE)
            self._forward_held(held, self._reader_data)
            mujoco.mj_rnePostConstraint(held.model, self._reader_data)
            self._reader_state = held
        return self._reader_data

    def _forward_held(self, held: HeldState, data: mujoco.MjData) -> None:
        """Make the forward pass of a held state as the step did."""
        law, shaper, fast = self.law, self.shaper, self.fast_bodies
        if law.model is not held.model:  # a spawn or a removal has come between
            law, shaper, fast = ContactLaw(held.model), None, FastBodyDetector(held.model)
        is_fast = fast.wants(data) if held.is_fast is None else held.is_fast
        set_speculative(held.model, is_fast)
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
            set_speculative(self.model, self._is_fast)

    def _has_passed(self) -> bool:
        """Whether the last step had forces of its own, and none is set for the next."""
        return not self.one_shot and bool(self.last_applied.any() or self.last_pushed.any())
