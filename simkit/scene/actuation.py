"""Data for controllers in a robot's file: soft limits, calibration, transmissions. The physics does not use them."""

from __future__ import annotations

from dataclasses import dataclass, field

from simkit.diagnostics import NOWHERE, Where
from simkit.params import Params


@dataclass(frozen=True, slots=True)
class Safety:
    """URDF's `<safety_controller>`: limits with which a controller keeps a joint away from its hard limits.

    Attributes:
        lower, upper: soft limits [rad or m].
        k_position: rate at which the velocity bound decreases near a soft limit [1/s].
        k_velocity: rate at which the effort bound decreases near a velocity bound [N·m·s/rad or N·s/m].
    """

    lower: float = 0.0
    upper: float = 0.0
    k_position: float = 0.0
    k_velocity: float = 0.0


@dataclass(frozen=True, slots=True)
class Calibration:
    """Positions [rad or m] at which a reference switch rises and falls; None if the file gives none."""

    rising: float | None = None
    falling: float | None = None


@dataclass(frozen=True, slots=True)
class TransmissionEnd:
    """Joint or actuator of a transmission.

    Attributes:
        name: plain name, as written.
        reduction: ratio of actuator position to joint position.
        offset: offset of the joint position [rad or m].
        role: `joint1`, `actuator2`, ...; empty if not given.
        interfaces: hardware interfaces, as written.
    """

    name: str
    reduction: float = 1.0
    offset: float = 0.0
    role: str = ""
    interfaces: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Transmission:
    """URDF's `<transmission>`: coupling of actuators and joints.

    Attributes:
        kind: simple, differential or four_bar_linkage; any other type as written.
        type: type, as written.
        joints, actuators: joints and actuators in document order.
        params: the whole element, for content that has no field here.
    """

    name: str
    kind: str
    type: str
    joints: tuple[TransmissionEnd, ...] = ()
    actuators: tuple[TransmissionEnd, ...] = ()
    params: Params = field(default_factory=Params)
    where: Where = NOWHERE
