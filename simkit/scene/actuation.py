"""What a robot's file tells its controllers: soft limits, calibration, transmissions. The physics does not use it."""

from __future__ import annotations

from dataclasses import dataclass, field

from simkit.diagnostics import NOWHERE, Where
from simkit.params import Params


@dataclass(frozen=True, slots=True)
class Safety:
    """URDF's `<safety_controller>`: how a controller keeps a joint off its limits.

    Attributes:
        lower, upper: soft limits [rad or m].
        k_position: how fast the velocity bound closes near a soft limit [1/s].
        k_velocity: how fast the effort bound closes near a velocity bound [N·m·s/rad or N·s/m].
    """

    lower: float = 0.0
    upper: float = 0.0
    k_position: float = 0.0
    k_velocity: float = 0.0


@dataclass(frozen=True, slots=True)
class Calibration:
    """Positions [rad or m] at which a reference switch rises and falls; None where not given."""

    rising: float | None = None
    falling: float | None = None


@dataclass(frozen=True, slots=True)
class TransmissionEnd:
    """A joint or an actuator of a transmission.

    Attributes:
        name: plain name, as written.
        reduction: actuator position over joint position.
        offset: of the joint [rad or m].
        role: `joint1`, `actuator2`, ...; empty where not given.
        interfaces: hardware interfaces, as written.
    """

    name: str
    reduction: float = 1.0
    offset: float = 0.0
    role: str = ""
    interfaces: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Transmission:
    """URDF's `<transmission>`: how actuators drive joints.

    Attributes:
        kind: simple, differential or four_bar_linkage; the type as written where it is none of them.
        type: as written.
        joints, actuators: in document order.
        params: the whole element, for what is not a field here.
    """

    name: str
    kind: str
    type: str
    joints: tuple[TransmissionEnd, ...] = ()
    actuators: tuple[TransmissionEnd, ...] = ()
    params: Params = field(default_factory=Params)
    where: Where = NOWHERE
