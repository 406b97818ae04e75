"""Find the joints that a drive turns as wheels or steers, and the angles of steered wheels."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from simkit.params import Params
from simkit.plugins.find_entities import find_axis_joint
from simkit.scene import SceneJoint, SceneModel

_CONTINUOUS_TYPES = 1e6  # [rad]; files write 1e16 and the like for a wheel that turns for ever


def find_wheels(scene: SceneModel, sides: Mapping[str, Sequence[str]], params: Params) -> dict[str, list[SceneJoint]]:
    """The joints that a drive names, by side; what cannot be a wheel is reported and left out.

    Args:
        scene: the model.
        sides: names of joints by what they are (`left wheel`).
        params: the drive's parameters.
    """
    places: dict[str, str] = {}
    found: dict[str, list[SceneJoint]] = {side: [] for side in sides}
    for side, name in ((side, name) for side, names in sides.items() for name in names):
        joint = find_axis_joint(scene, name, params)
        if joint is None:
            continue
        if joint.scoped in places:
            message = f"joint {name!r} is {places[joint.scoped]} and {side}; each wheel has a joint of its own"
            params.error("SK-PLUGIN-050", message)
            continue
        places[joint.scoped] = side
        if joint.type == "prismatic":
            message = f"joint {name!r} is prismatic, it does not turn; a wheel's is revolute or continuous"
            params.error("SK-PLUGIN-051", message)
            continue
        _report_position_limits(joint, params)
        found[side].append(joint)
    return found


def find_drive_joint(scene: SceneModel, name: str, what: str, params: Params) -> SceneJoint | None:
    """A joint that is to be steered or turned; None after an error."""
    joint = find_axis_joint(scene, name, params)
    if joint is not None and joint.type == "prismatic":
        message = f"joint {name!r} is prismatic, it does not turn; a {what}'s is revolute or continuous"
        params.error("SK-PLUGIN-051", message)
        return None
    return joint


def steering_angles(slope: float, base: float, width: float) -> tuple[float, float]:
    """Angles of the left and right steered wheel, so that all wheels turn round one point [rad].

    Args:
        slope: tangent of the angle of a wheel in the middle; left is positive.
        base: between the axles [m].
        width: between the steered wheels' pivots [m].
    """
    half = width / 2 * slope
    return math.atan2(base * slope, base - half), math.atan2(base * slope, base + half)


def _report_position_limits(joint: SceneJoint, params: Params) -> None:
    axis = joint.axes[0]
    if math.isfinite(axis.lower) and math.isfinite(axis.upper) and axis.upper - axis.lower < _CONTINUOUS_TYPES:
        message = f"joint {joint.name!r} is driven as a wheel, but stops at {axis.lower:g} and {axis.upper:g} rad"
        hint = 'type="continuous", or leave <limit> without <lower> and <upper>'
        params.diagnostics.warning("SK-PLUGIN-052", message, joint.where, hint)
