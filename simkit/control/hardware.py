"""The hardware that controllers command: joints with their interfaces, limits and servos."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from simkit.control.interfaces import InterfaceTable


@dataclass(frozen=True, slots=True)
class HardwareJoint:
    """A joint as `<ros2_control>` or `<transmission>` describes it.

    Attributes:
        name: plain name.
        joint: the simulation's handle.
        command_interfaces, state_interfaces: position, velocity, effort.
        lower, upper: position limits [rad or m]; infinite where there are none.
        max_velocity: [rad/s or m/s]; infinite where there is none.
        max_effort: [N·m or N]; infinite where there is none.
    """

    name: str
    joint: Any
    command_interfaces: tuple[str, ...]
    state_interfaces: tuple[str, ...]
    lower: float = -float("inf")
    upper: float = float("inf")
    max_velocity: float = float("inf")
    max_effort: float = float("inf")


@dataclass(slots=True)
class Hardware:
    """Joints and sensors of one robot.

    Attributes:
        joints: by plain name, in the order of the description.
        states: read from the simulation before the controllers are updated.
        commands: written to the simulation after they were.
    """

    joints: dict[str, HardwareJoint] = field(default_factory=dict)
    states: InterfaceTable = field(default_factory=InterfaceTable)
    commands: InterfaceTable = field(default_factory=InterfaceTable)
