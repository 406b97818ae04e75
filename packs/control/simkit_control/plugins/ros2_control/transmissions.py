"""Transmissions: motion and effort of the actuators that drive the joints, as `<transmission>` describes them.

In Gazebo and in simkit, controllers command joints, not actuators. Position, velocity and effort of an actuator are
state interfaces with the actuator's name, computed when a controller reads them. The laws are those of ros2_control's
transmission_interface. Below, a is the position of an actuator, n_a and n_j are the reductions of actuators and joints,
and x is the position of a joint minus its offset:

* simple: a = n_a n_j x;
* differential: a1 = n_a1 (n_j1 x1 + n_j2 x2), a2 = n_a2 (n_j1 x1 − n_j2 x2);
* four-bar linkage: a1 = n_a1 n_j1 x1, a2 = n_a2 (x1 + n_j2 x2).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params
from simkit.extend import Diagnostics, Vector, did_you_mean
from simkit.linear_algebra import inverse, matmul
from simkit.scene.actuation import Transmission, TransmissionEnd
from simkit_control.plugins.ros2_control.hardware_interfaces import EFFORT, POSITION

if TYPE_CHECKING:
    from simkit.extend import SceneModel

_KINDS: Final = {
    "SimpleTransmission": "simple",
    "DifferentialTransmission": "differential",
    "FourBarLinkageTransmission": "four_bar_linkage",
}
_SMALLEST_REDUCTION: Final = 1e-12  # the largest allowed reduction is 1e12


@dataclass(frozen=True, slots=True)
class TransmissionLaw:
    """Linear relation between the joints and the actuators of a transmission.

    Attributes:
        actuators, joints: plain names.
        motion: matrix from joint positions or velocities to actuator positions or velocities, shape (actuators,
            joints).
        force: matrix from joint efforts to actuator efforts, shape (actuators, joints).
        offset: position offsets of the joints [rad or m].
    """

    actuators: tuple[str, ...]
    joints: tuple[str, ...]
    motion: Vector
    force: Vector
    offset: Vector

    def actuate(self, interface: str, joints: Vector) -> Vector:
        """Convert values of one interface from the joints to the actuators."""
        if interface == EFFORT:
            return np.asarray(matmul(self.force, joints))
        return np.asarray(matmul(self.motion, joints - self.offset if interface == POSITION else joints))


def transmission_laws(
    transmissions: Iterable[Transmission], joints: Sequence[str], diagnostics: Diagnostics
) -> list[TransmissionLaw]:
    """Return the laws of all transmissions whose joints the hardware has; report the others."""
    laws = []
    for transmission in transmissions:
        law = _transmission_law(transmission)
        if law is None and transmission.kind not in _KINDS.values():
            message = f"transmission {transmission.name!r} is of type {transmission.type or transmission.kind!r}"
            message += f", which is not known; use one of {', '.join(_KINDS)}; its actuators are ignored"
            near = did_you_mean(transmission.type.rpartition("/")[2], _KINDS)
            diagnostics.warning("SK-CONTROL-008", message, transmission.where, near)
            continue
        if law is None:
            counts = f"{len(transmission.joints)} joint(s) and {len(transmission.actuators)} actuator(s)"
            message = f"transmission {transmission.name!r} ({transmission.type or 'of no type'}) has {counts}"
            hint = (
                "a simple transmission needs 1 joint and 1 actuator, other types need 2 of each with different names; "
                "no reduction may be near 0"
            )
            diagnostics.warning("SK-CONTROL-008", f"{message}; its actuators are ignored", transmission.where, hint)
            continue
        missing = [joint for joint in law.joints if joint not in joints]
        for joint in missing:
            message = f"transmission {transmission.name!r} names joint {joint!r}, which the hardware does not have"
            diagnostics.warning(
                "SK-CONTROL-008",
                f"{message}; its actuators are ignored",
                transmission.where,
                did_you_mean(joint, joints),
            )
        if not missing:
            laws.append(law)
    return laws


def _transmission_law(transmission: Transmission) -> TransmissionLaw | None:
    joints, actuators = _by_role(transmission.joints), _by_role(transmission.actuators)
    n_j, n_a = [end.reduction for end in joints], [end.reduction for end in actuators]
    two = len(joints) == len(actuators) == 2
    if any(not _SMALLEST_REDUCTION <= abs(n) <= 1.0 / _SMALLEST_REDUCTION for n in (*n_j, *n_a)):
        return None
    if any(len({end.name for end in ends}) != len(ends) for ends in (joints, actuators)):
        return None
    if transmission.kind == "simple" and len(joints) == len(actuators) == 1:
        motion = np.array([[n_a[0] * n_j[0]]])
        force = 1.0 / motion
    elif transmission.kind == "differential" and two:
        motion = np.array([[n_a[0] * n_j[0], n_a[0] * n_j[1]], [n_a[1] * n_j[0], -n_a[1] * n_j[1]]])
        force = inverse(motion.T)
    elif transmission.kind == "four_bar_linkage" and two:
        motion = np.array([[n_a[0] * n_j[0], 0.0], [n_a[1], n_a[1] * n_j[1]]])
        force = np.array([[1.0 / (n_a[0] * n_j[0]), 0.0], [1.0 / n_a[1], 1.0 / (n_a[1] * n_j[1])]])
    else:
        return None
    offset = np.array([end.offset for end in joints])
    return TransmissionLaw(tuple(a.name for a in actuators), tuple(j.name for j in joints), motion, force, offset)


def _by_role(ends: Sequence[TransmissionEnd]) -> list[TransmissionEnd]:
    """Sort the joints or actuators by role (`joint1`, `joint2`) if all of them have a role."""
    return sorted(ends, key=lambda end: end.role) if all(end.role for end in ends) else list(ends)


def transmissions_of(scene: SceneModel, blocks: Iterable[Params]) -> list[Transmission]:
    """Return the transmissions in `<ros2_control>`; if there are none, the robot's `<transmission>` blocks (ROS 1)."""
    written = [_read_transmission(element) for block in blocks for element in block.all("transmission")]
    return written or list(scene.transmissions)


def _read_transmission(element: Params) -> Transmission:
    plugin = element.text("plugin", "")
    kind = _KINDS.get(plugin.rpartition("/")[2], plugin)
    return Transmission(
        name=element.attribute("name"),
        kind=kind,
        type=plugin,
        joints=tuple(_read_end(end) for end in element.all("joint")),
        actuators=tuple(_read_end(end) for end in element.all("actuator")),
        params=element,
        where=element.where,
    )


def _read_end(element: Params) -> TransmissionEnd:
    return TransmissionEnd(
        name=element.attribute("name"),
        reduction=element.number("mechanical_reduction", 1.0),
        offset=element.number("offset", 0.0),
        role=element.attribute("role"),
    )
