"""Find the wheel joints and steering joints of a drive, and compute the angles of steered wheels."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from simkit.params import Params
from simkit.plugins.find_entities import find_axis_joint
from simkit.scene import SceneJoint, SceneModel

_UNLIMITED_RANGE = 1e6  # [rad]; files write limits such as 1e16 for a wheel that turns without end


def find_wheels(scene: SceneModel, sides: Mapping[str, Sequence[str]], params: Params) -> dict[str, list[SceneJoint]]:
    """Find the wheel joints that a drive names, and report joints that cannot be wheels.

    Args:
        scene: Model of the drive.
        sides: Joint names by role (`left wheel`).
        params: Parameters of the drive.

    Returns:
        The usable joints by role.
    """
    side_by_joint: dict[str, str] = {}
    wheels_by_side: dict[str, list[SceneJoint]] = {side: [] for side in sides}
    for side, name in ((side, name) for side, names in sides.items() for name in names):
        joint = find_axis_joint(scene, name, params)
        if joint is None:
            continue
        if joint.scoped in side_by_joint:
            message = f"joint {name!r} is both {side_by_joint[joint.scoped]} and {side}; each wheel needs its own joint"
            params.error("SK-PLUGIN-050", message)
            continue
        side_by_joint[joint.scoped] = side
        if joint.type == "prismatic":
            message = f"joint {name!r} is prismatic and cannot turn; a wheel needs a revolute or continuous joint"
            params.error("SK-PLUGIN-051", message)
            continue
        _report_position_limits(joint, params)
        wheels_by_side[side].append(joint)
    return wheels_by_side


def find_drive_joint(scene: SceneModel, name: str, role: str, params: Params) -> SceneJoint | None:
    """Find a joint that a drive steers or turns.

    Args:
        scene: Model of the drive.
        name: Name of the joint.
        role: Role of the joint, for the message of an error.
        params: Parameters of the drive.

    Returns:
        The joint, or None after an error.
    """
    joint = find_axis_joint(scene, name, params)
    if joint is not None and joint.type == "prismatic":
        message = f"joint {name!r} is prismatic and cannot turn; a {role} needs a revolute or continuous joint"
        params.error("SK-PLUGIN-051", message)
        return None
    return joint


def steering_angles(slope: float, base: float, width: float) -> tuple[float, float]:
    """Return the steering angles of the left and right wheel [rad] at which all wheels turn around one point.

    Args:
        slope: Tangent of the steering angle of a virtual middle wheel; positive to the left.
        base: Distance between the axles [m].
        width: Distance between the pivots of the steered wheels [m].
    """
    half = width / 2 * slope
    return math.atan2(base * slope, base - half), math.atan2(base * slope, base + half)


def _report_position_limits(joint: SceneJoint, params: Params) -> None:
    axis = joint.axes[0]
    if math.isfinite(axis.lower) and math.isfinite(axis.upper) and axis.upper - axis.lower < _UNLIMITED_RANGE:
        message = f"joint {joint.name!r} is driven as a wheel, but its limits are {axis.lower:g} and {axis.upper:g} rad"
        hint = 'use type="continuous", or remove <lower> and <upper> from <limit>'
        params.diagnostics.warning("SK-PLUGIN-052", message, joint.where, hint)
