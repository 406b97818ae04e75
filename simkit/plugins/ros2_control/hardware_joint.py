"""A joint of the control hardware: its interfaces, its limits, and the gains of its own PID loops."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from simkit.params import Params

if TYPE_CHECKING:
    from simkit.runtime import Joint


@dataclass(frozen=True, slots=True)
class HardwareJoint:
    """A joint as `<ros2_control>` or `<transmission>` describes it.

    Attributes:
        name: plain name.
        joint: the simulation's handle; None before the load.
        command_interfaces: position, velocity, effort.
        lower, upper: position limits [rad or m]; infinite where there are none.
        max_velocity: [rad/s or m/s]; infinite where there is none.
        max_effort: [N·m or N]; infinite where there is none.
        scoped: scoped name.
        is_continuous: whether its angle has no ends, so that it is wrapped.
        initial: first position; NaN for that of the file.
        leader: what it mimics; empty for nothing.
        multiplier, offset: position = multiplier · leader's + offset.
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
    def handle(self) -> Joint:
        """The simulation's joint.

        Raises:
            RuntimeError: the hardware is not loaded into a simulation yet.
        """
        if self.joint is None:
            raise RuntimeError(f"joint {self.name!r} is not in a simulation yet")
        return self.joint


@dataclass(frozen=True, slots=True)
class PidGains:
    """Gains of a joint's own loop: effort per error, per error and second, per error's rate.

    Attributes:
        i_max, i_min: bounds of the integral's part of the effort.
        u_max, u_min: bounds of the whole effort.
    """

    p: float = 0.0
    i: float = 0.0
    d: float = 0.0
    i_max: float = 0.0
    i_min: float = 0.0
    u_max: float = math.inf
    u_min: float = -math.inf


def read_pid_gains(params: Params) -> PidGains:
    """Gains of a joint: `kp`, `ki`, `kd` and `max_integral_error`, or `p`, `i`, `d` and `i_clamp` as in ROS 1."""
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
