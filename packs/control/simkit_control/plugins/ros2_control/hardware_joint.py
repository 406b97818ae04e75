"""Joint of the control hardware: interfaces, limits, and gains of PID loops that replace a servo."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from simkit import Params
from simkit_control.plugins.ros2_control.hardware_interfaces import KD, KP

if TYPE_CHECKING:
    from simkit import Joint


@dataclass(frozen=True, slots=True)
class HardwareJoint:
    """Joint as `<ros2_control>` or `<transmission>` describes it.

    Attributes:
        name: plain name.
        joint: joint handle of the simulation; None before the load.
        command_interfaces: command interfaces among position, velocity, effort, kp and kd.
        lower, upper: position limits [rad or m]; infinite without limits.
        max_velocity: velocity limit [rad/s or m/s]; infinite without one.
        max_effort: effort limit [N·m or N]; infinite without one.
        scoped: scoped name.
        is_continuous: true for a rotation without limits, whose angle errors are wrapped.
        initial: initial position [rad or m]; NaN to keep the model's initial position.
        leader: joint that it mimics; empty for none.
        multiplier, offset: mimic relation: position = multiplier · position of the leader + offset.
    """

    name: str
    joint: Joint | None
    command_interfaces: tuple[str, ...]
    lower: float = -float("inf")
    upper: float = float("inf")
    max_velocity: float = float("inf")
    max_effort: float = float("inf")
    scoped: str = ""
    is_continuous: bool = False
    initial: float = math.nan
    leader: str = ""
    multiplier: float = 1.0
    offset: float = 0.0

    @property
    def has_gain_commands(self) -> bool:
        """True if stiffness and damping are commands: effort = e + kp (x_commanded − x) + kd (v_commanded − v)."""
        return not {KP, KD}.isdisjoint(self.command_interfaces)

    @property
    def handle(self) -> Joint:
        """Joint handle of the simulation.

        Raises:
            RuntimeError: the hardware is not loaded into a simulation yet.
        """
        if self.joint is None:
            raise RuntimeError(f"joint {self.name!r} is not loaded into a simulation yet")
        return self.joint


@dataclass(frozen=True, slots=True)
class PidGains:
    """Gains of a PID loop that replaces a joint's servo; the output is an effort [N·m or N].

    Attributes:
        p: effort per error.
        i: effort per error and second.
        d: effort per error rate.
        i_max, i_min: bounds of the integral part of the effort.
        u_max, u_min: bounds of the complete effort.
    """

    p: float = 0.0
    i: float = 0.0
    d: float = 0.0
    i_max: float = 0.0
    i_min: float = 0.0
    u_max: float = math.inf
    u_min: float = -math.inf


def read_pid_gains(params: Params) -> PidGains:
    """Read the gains of a joint: `kp`, `ki`, `kd` and `max_integral_error`, or `p`, `i`, `d` and `i_clamp`."""
    i = params.number("ki", params.number("i", 0.0))
    clamp = abs(params.number("i_clamp", 0.0))
    if params.has("max_integral_error"):
        clamp = abs(i * params.number("max_integral_error", 0.0, minimum=0.0))
    params.child("antiwindup")
    return PidGains(
        p=params.number("kp", params.number("p", 0.0)),
        i=i,
        d=params.number("kd", params.number("d", 0.0)),
        i_max=params.number("i_clamp_max", clamp),
        i_min=params.number("i_clamp_min", -clamp),
    )
