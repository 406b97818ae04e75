"""What a joint of a file may not say."""

from __future__ import annotations

import math
from typing import Final

from simkit.diagnostics import Diagnostics
from simkit.scene import Axis, SceneJoint

_UNIT: Final = 1e-6
_RIGID: Final = 1e8


def is_sound(joint: SceneJoint, axis: Axis, diagnostics: Diagnostics) -> bool:
    """Whether an axis can be simulated; reports what is wrong or has an effect that few expect."""
    numbers = (axis.damping, axis.friction, axis.stiffness, axis.spring_ref)
    limits = (axis.lower, axis.upper, axis.effort, axis.velocity)
    if not all(map(math.isfinite, (*axis.xyz_world, *numbers))) or any(map(math.isnan, limits)):
        diagnostics.error(
            "SK-JOINT-003", f"joint {joint.scoped}: a number of its axis, limits or dynamics is not finite", joint.where
        )
        return False
    if abs(math.hypot(*axis.xyz_world) - 1.0) > _UNIT:
        diagnostics.error(
            "SK-JOINT-002",
            f"joint {joint.scoped}: its axis {axis.xyz_world} has a length of {math.hypot(*axis.xyz_world):g}",
            joint.where,
            "an axis points somewhere: 0 0 1, for example",
        )
        return False
    _hint_at(joint, axis, diagnostics)
    return True


def _hint_at(joint: SceneJoint, axis: Axis, diagnostics: Diagnostics) -> None:
    if axis.lower > axis.upper:
        diagnostics.warning(
            "SK-JOINT-006",
            f"joint {joint.scoped}: its lower limit {axis.lower:g} is above its upper limit {axis.upper:g}; "
            "it is taken as unlimited",
            joint.where,
        )
    elif axis.lower > 0.0 or axis.upper < 0.0:
        diagnostics.warning(
            "SK-JOINT-007",
            f"joint {joint.scoped} begins at 0, outside its limits [{axis.lower:g}, {axis.upper:g}]: "
            "it is pushed inside in the first steps",
            joint.where,
            "limits count from the pose in the file",
        )
    if axis.limit_stiffness is not None and axis.limit_stiffness < _RIGID and math.isfinite(axis.upper - axis.lower):
        diagnostics.note(
            "SK-JOINT-014",
            f"joint {joint.scoped}: the stops at its limits are rigid; stiffness {axis.limit_stiffness:g} is not used",
            joint.where,
        )
    if axis.velocity == 0.0:
        diagnostics.warning(
            "SK-JOINT-008",
            f"joint {joint.scoped} has a velocity limit of 0: it stands still",
            joint.where,
            "leave the limit out for a joint without one",
        )
    if axis.damping < 0.0 or axis.friction < 0.0 or axis.stiffness < 0.0:
        diagnostics.warning(
            "SK-JOINT-009",
            f"joint {joint.scoped}: damping {axis.damping:g}, friction {axis.friction:g}, spring stiffness "
            f"{axis.stiffness:g}: the negative ones are taken as 0",
            joint.where,
        )
