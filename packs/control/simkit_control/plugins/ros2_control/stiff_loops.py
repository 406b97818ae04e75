"""PID loops of effort with gains that would oscillate if a controller computed their whole effort."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.extend import SharedByCopies, Vector, counted

if TYPE_CHECKING:
    from simkit_control.plugins.ros2_control.controller import Controller
    from simkit_control.plugins.ros2_control.joint_pids import JointPids

_LARGEST_DAMPING: Final = 0.5
"""Largest d · period / inertia of a loop that the controller computes."""

_LARGEST_STIFFNESS: Final = 0.25
"""Largest p · period² / inertia of a loop that the controller computes."""


class StiffLoops(SharedByCopies):
    """Loops of one controller whose p and d parts the engine computes at every step, as it does for its servos.

    A controller reads a velocity and acts on it one period later. With d · period / inertia above 1, the effort
    reverses the velocity more than it reduces it, and the joint oscillates between its effort limits. The engine
    computes the same effort from the velocity at the end of its step, so that it is stable. Gains that would oscillate
    at the step of the engine too are reduced.

    Attributes:
        kp: stiffness that the engine computes, by joint [N·m/rad or N/m]; 0 where the controller computes the effort.
        kd: damping that the engine computes, by joint [N·m·s/rad or N·s/m]; 0 where the controller computes the effort.
    """

    def __init__(self, controller: Controller, joints: Sequence[str], pids: JointPids) -> None:
        """Find the stiff loops among `pids`, reduce their gains to stable gains, and report the reduced gains."""
        actuated, self.kp, self.kd = controller.hardware.actuated, np.zeros(len(joints)), np.zeros(len(joints))
        sim, rate = controller.sim, controller.update_rate or controller.plugin.before_step_rate
        step = sim.timestep
        period = max(step, 1.0 / rate) if rate else step
        reduced = []
        for k, name in enumerate(joints):
            stable = actuated.stable_gains(name)
            if stable is None:
                continue
            inertia, p, d = stable[1] * step, float(pids.p[k]), float(pids.d[k])
            if d * period <= _LARGEST_DAMPING * inertia and p * period**2 <= _LARGEST_STIFFNESS * inertia:
                continue
            self.kp[k], self.kd[k] = min(max(p, 0.0), stable[0]), min(max(d, 0.0), stable[1])
            if p > stable[0] or d > stable[1]:
                pids.p[k], pids.d[k] = min(p, stable[0]), min(d, stable[1])
                needed = min(step * (stable[0] / p) ** 0.5 if p > 0.0 else step, inertia / d if d > 0.0 else step)
                reduced.append((name, p, d, float(pids.p[k]), float(pids.d[k]), needed))
        names = {name: (float(self.kp[k]), float(self.kd[k])) for k, name in enumerate(joints)}
        controller.hardware.springs[controller.name] = {name: g for name, g in names.items() if any(g)}
        if reduced:
            name, p, d, used_p, used_d, _ = reduced[0]
            needed = min(entry[-1] for entry in reduced)
            others = f"; so would the gains of {counted(len(reduced) - 1, 'other joint')}" if len(reduced) > 1 else ""
            message = (
                f"controller {controller.name!r}: the gains p = {p:g} and d = {d:g} of joint {name!r} would oscillate "
                f"at a step of {step * 1e3:g} ms{others}; p = {used_p:.3g} and d = {used_d:.3g} are used"
            )
            hint = f"use smaller gains, or a <max_step_size> of at most {needed:.2g}"
            sim.engine.reports.warning("SK-CONTROL-062", message, controller.params.where, hint)

    def __bool__(self) -> bool:
        return bool(self.kp.any() or self.kd.any())

    def effort(self, effort: Vector, position: Vector, velocity: Vector) -> Vector:
        """Return the effort to command, without the part that the engine computes.

        Args:
            effort: whole effort of the loops [N·m or N].
            position: present positions of the joints [rad or m].
            velocity: present velocities of the joints [rad/s or m/s].
        """
        return effort + self.kp * position + self.kd * velocity
