"""Steps of the physics: advance MuJoCo's state without repeating forward passes.

After `mj_step` the positions are one step ahead of all values computed from them. The first reader repeats the forward
pass. The next step continues from that forward pass. Integrating from there and then making k-1 steps gives the same
bits as k steps.
"""

from __future__ import annotations

import time

import mujoco
import numpy as np

from simkit.runtime.contact.contact_law import LawUse
from simkit.runtime.contact.speculative_contacts import ApproachCallback
from simkit.runtime.engine.control_callback import call_before_forces
from simkit.runtime.engine.forward_pass import SKIPPED_STAGE, ForwardPass
from simkit.runtime.engine.free_motion import Integrator
from simkit.runtime.engine.physics_state import CONTROL, FRESH, STALE, VELOCITY
from simkit.runtime.engine.pose_history import PoseHistory
from simkit.runtime.engine.simulated_time import Clock

__all__ = ["CONTROL", "FRESH", "STALE", "VELOCITY", "Physics"]

# looked up once, because the loop calls these functions every few microseconds
mj_step, mj_forward, mj_forward_skip = mujoco.mj_step, mujoco.mj_forward, mujoco.mj_forwardSkip
mj_fwd_position, mj_fwd_velocity = mujoco.mj_fwdPosition, mujoco.mj_fwdVelocity
mj_check_pos, mj_check_vel, mj_check_acc = mujoco.mj_checkPos, mujoco.mj_checkVel, mujoco.mj_checkAcc

_WALL_LIMIT = 0.04  # [s] of one call into the engine, so that an interrupt is handled soon
_SHORT_RUN = 16  # steps; fewer steps are not timed, because timing costs as much as a small step


class Physics(ForwardPass):
    """MuJoCo's model and data, and the functions that advance them.

    Args:
        model: MuJoCo's model.
        data: MuJoCo's data.
        clock: source of the step length.
        may_sleep: True if bodies at rest may sleep.
        on_approach: function that receives the approaches that speculative contacts cannot stop; it changes no state.
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
        self._take_chunk(256)
        super().__init__(model, data, clock, may_sleep, on_approach=on_approach)

    def advance(self, count: int) -> None:
        """Make `count` steps; forces that last for one step only are cleared after the first."""
        if self.poses is not None:
            self._advance_recorded(self.poses, count)
            return
        sleep = self.sleep
        # the usual call of a loop with sensors: few steps, and nothing to do before and after them
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
        if sleep.rests and sleep.still_rests():  # all bodies are at rest: the state stays the same
            self._advance_time(count)
            return
        if self.one_shot:
            self._run(1)
            self._clear_one_shot()
            count -= 1
            if not count:
                # `Joint.effort` reports the forces that were applied in this step
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
        """Make one step."""
        is_special = self._uses_law or self._probes or self.one_shot or self.shows_applied or self.sleep.watches
        is_special = is_special or self.shaper is not None or self._corrects_all or self.poses is not None
        if not is_special and self.stage == STALE and self.tick < self._until:  # saves the cost of `advance`
            mj_step(self.model, self.data)
            self.tick += 1
        else:
            self.advance(1)

    def _advance_recorded(self, poses: PoseHistory, count: int) -> None:
        """Make `count` steps one by one, and record the poses of all bodies before each of them."""
        self.poses = None
        try:
            for _ in range(count):
                tick = self.tick
                # the inner stages of these integrators leave poses between two ticks, and a resting step leaves none
                if self._integrate is None or self._has_stages or self.free_motion is not None or self.sleep.rests:
                    poses.add(tick, self.fresh())
                    self.single()
                else:
                    self.single()
                    poses.add(tick, self.data)
        finally:
            self.poses = poses

    def _advance_time(self, count: int) -> None:
        """Advance the time alone, with the same floating-point sum as the engine."""
        data, step = self.data, self.clock.timestep
        if count < _SHORT_RUN:
            now = data.time
            for _ in range(count):
                now += step
            data.time = now
        else:  # `cumsum` adds one after the other, as the engine; `count * step` has other bits
            times = np.full(count + 1, step)
            times[0] = data.time
            data.time = times.cumsum()[-1]
        self.tick += count

    def _run(self, count: int) -> None:
        sleep = self.sleep
        if sleep.wants_all_awake:
            self.fresh()
        if sleep.is_drowsy:  # the engine puts bodies to sleep in a step only
            sleep.let_fall_asleep()
            self._steps(1)
            sleep.keep_awake()
            count -= 1
        if count:
            self._steps(count)
        sleep.settle()

    def _steps(self, count: int) -> None:
        if self.checks_controls:
            self._check_controls()
        integrate, has_shaper = self._integrate, self._acting_shaper is not None
        if integrate is None:
            mj_step(self.model, self.data, count)
            self.stage = STALE
            self.tick += count
            return
        if not self._is_analysed:
            self._analyse_if_changed()
        end = self.tick + count
        free_motion = self.free_motion if self._is_free and self.stage == STALE else None
        if free_motion is not None and free_motion.advance(self.data, count):
            self.tick = end
        while self.tick < end:
            if has_shaper or self._probes or self.tick >= self._until:
                self._checked_step(integrate)
            elif not (self._uses_law or self._corrects_all):
                self._plain_steps(min(end, self._until) - self.tick, integrate)
            elif self.stage == STALE and self.tick < self._fast_until and not self._has_stages:
                self._decided_steps(min(end, self._until, self._fast_until) - self.tick, integrate)
            else:
                self._checked_step(integrate)

    def _plain_steps(self, count: int, integrate: Integrator) -> None:
        """Make steps by the engine alone, from the part of the forward pass that is up to date."""
        model, data, stage = self.model, self.data, self.stage
        if stage == STALE:
            mj_step(model, data, count)
        else:
            if stage:
                mj_forward_skip(model, data, SKIPPED_STAGE[stage], 1)
            mj_check_acc(model, data)
            integrate(model, data)
            if count > 1:
                mj_step(model, data, count - 1)
        self.stage = STALE
        self.tick += count

    def _decided_steps(self, count: int, integrate: Integrator) -> None:
        """Make steps with corrections, from data without a forward pass, up to the next check of the contacts.

        They have the bits of `_checked_step`. Decisions for each step would take 0.7 of 25 µs with one sliding box.
        """
        model, data, free_motion = self.model, self.data, self.free_motion
        use, solve, closing = self._uses_law, self.law.solve, self._closing
        solve_wheels = self.law.solve_wheels if use is LawUse.WHEELS else None
        for _ in range(count):
            mj_check_pos(model, data)
            mj_check_vel(model, data)
            if solve_wheels is not None:
                mj_fwd_position(model, data)
                mj_fwd_velocity(model, data)
                solve_wheels(data)
            elif use:
                mj_fwd_position(model, data)
                mj_fwd_velocity(model, data)
                solve(data, closing, use)
            else:
                mj_forward(model, data)
            mj_check_acc(model, data)
            if free_motion is None:
                integrate(model, data)
            else:
                free_motion.integrate(model, data, integrate)  # after the forward pass, which wakes bodies
            self.tick += 1

    def _checked_step(self, integrate: Integrator) -> None:
        """Make one step with corrections, from the part of the forward pass that is up to date."""
        model, data, stage, free_motion = self.model, self.data, self.stage, self.free_motion
        if stage == STALE:
            mj_check_pos(model, data)
            mj_check_vel(model, data)
        if stage:
            self._forward()
        mj_check_acc(model, data)
        self.stage = STALE
        if free_motion is not None and (self._uses_law or self._corrects_all):
            free_motion.integrate(model, data, integrate)
        elif self._has_stages and (self._uses_law or self._acting_shaper is not None):
            with call_before_forces(data, self._correct_stage):
                integrate(model, data)
        else:
            integrate(model, data)
        self.tick += 1

    def _correct_stage(self) -> None:
        """Change the contacts in an inner stage of an integrator; the engine then solves for them."""
        shaper = self._acting_shaper
        if shaper is not None:
            self.law.lines.correct(self.data)
            shaper.shape(self.data)
        use = self._uses_law if shaper is None else LawUse.WHOLE
        self.law.solve(self.data, self._closing, use, keeps_references=True)

    def _clear_one_shot(self) -> None:
        self.last_applied[:] = self.data.qfrc_applied
        self.last_pushed[:] = self.data.xfrc_applied - self.persistent_wrenches
        self.data.qfrc_applied[:] = 0
        self.data.xfrc_applied[:] = self.persistent_wrenches
        self.one_shot = False

    def _tune(self, chunk: int, wall: float) -> None:
        """Set the steps of a call so that it takes 0.01 to 0.04 s of wall time."""
        if wall > _WALL_LIMIT and chunk > 1:
            self._take_chunk(max(1, chunk // 2))
        elif wall < _WALL_LIMIT / 4 and chunk == self._chunk:
            self._take_chunk(min(1 << 16, chunk * 2))

    def _take_chunk(self, steps: int) -> None:
        self._chunk, self._short = steps, min(steps, _SHORT_RUN)
