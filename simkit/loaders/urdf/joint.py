"""Reader of `<joint>`: axes, limits, dynamics, mimic, and the joint's `<gazebo>` extensions."""

from __future__ import annotations

import math

from simkit.diagnostics import did_you_mean
from simkit.float_sum import float_sum
from simkit.loaders.sdf.plugin import read_plugins
from simkit.loaders.sdf.sensor import read_sensors
from simkit.loaders.urdf import gazebo_extensions
from simkit.loaders.urdf.element_attributes import (
    number_attribute,
    parse_number,
    report_missing,
    text_attribute,
    vector3_attribute,
)
from simkit.loaders.urdf.robot_draft import JointDraft, RobotDraft
from simkit.params import Params
from simkit.pose import Pose
from simkit.scene import Axis, Calibration, Mimic, Safety, SceneJoint
from simkit.scene.geometry import Vec3, vec3
from simkit.scene.model import MOST_LEADERS

_NO_LIMIT = 1e15
_NO_MIMIC = ("fixed", "floating", "planar", "ball")
_NO_AXES = ("fixed", "floating", "ball")
_FIXED_DEFAULTS = ("preserveFixedJoint", "disableFixedJointLumping")  # no effect: simkit never merges links


def read_joint(draft: RobotDraft, joint: JointDraft) -> SceneJoint:
    """Return a joint; the poses of its links must be known."""
    element, name = joint.element, joint.name
    extension = draft.extensions.of(name)
    pose = draft.links_world[joint.child]
    for setting in _FIXED_DEFAULTS:
        extension.all(setting)
    joint_name = draft.own(name)
    return SceneJoint(
        name=name,
        scoped=joint_name,
        type=joint.type,
        parent_link=draft.own(joint.parent),
        child_link=draft.own(joint.child),
        pose_world=pose,
        axes=_axes(draft, joint, pose, extension),
        sensors=read_sensors(draft.part(joint.child, extension, name), joint_name, pose),
        plugins=read_plugins(extension.all("plugin"), joint_name),
        where=element.where,
        safety=_safety(element),
        calibration=_calibration(element),
    )


# ---------------------------------------------------------------------- axes


def _axes(draft: RobotDraft, joint: JointDraft, pose: Pose, extension: Params) -> tuple[Axis, ...]:
    """Return one axis; for a planar joint x and y of its plane and the normal; none for the types without axes."""
    element = joint.element
    mimic = _mimic(draft, joint)
    if joint.type in _NO_AXES:
        for unused in ("axis", "limit", "dynamics"):
            unused_element = element.child(unused)
            if unused_element is not None:
                unused_element.mark_all_read()
                for attribute in unused_element.attributes:
                    unused_element.attribute(attribute)
        return ()
    direction = _direction(joint)
    lower, upper, effort, velocity = _limits(joint)
    dynamics = element.block("dynamics")
    damping = number_attribute(dynamics, "damping", 0.0)
    friction = number_attribute(dynamics, "friction", 0.0)
    stiffness = gazebo_extensions.read_number(extension, "springStiffness") or 0.0
    spring_ref = gazebo_extensions.read_number(extension, "springReference") or 0.0
    directions = (*_plane_axes(direction), direction) if joint.type == "planar" else (direction,)
    return tuple(
        Axis(
            xyz_world=vec3(pose.rotate(d)),
            xyz_joint=d,
            lower=lower,
            upper=upper,
            effort=effort,
            velocity=velocity,
            damping=damping,
            friction=friction,
            stiffness=stiffness,
            spring_ref=spring_ref,
            mimic=mimic if index == 0 else None,
        )
        for index, d in enumerate(directions)
    )


def _direction(joint: JointDraft) -> Vec3:
    """Return the unit axis in the joint frame; without `<axis>` it is x, as URDF defines."""
    element = joint.element.child("axis")
    if element is None:
        return (1.0, 0.0, 0.0)
    if "xyz" not in element.attributes:
        report_missing(element, "xyz", "3 numbers", f"joint {joint.name!r}")
    x, y, z = vector3_attribute(element, "xyz", (1.0, 0.0, 0.0))
    length = math.sqrt(x * x + y * y + z * z)
    if not 1e-12 < length < math.inf:
        element.error("SK-URDF-014", f"joint {joint.name!r} has an axis of length {length:g}")
        return (1.0, 0.0, 0.0)
    return (x / length, y / length, z / length)


def _plane_axes(normal: Vec3) -> tuple[Vec3, Vec3]:
    """Return two unit vectors that form a right-handed frame with the normal: x and y for a normal along z."""
    main = max(range(3), key=lambda i: abs(normal[i]))
    seed = [0.0, 0.0, 0.0]
    seed[(main + 1) % 3] = 1.0
    along = float_sum(s * n for s, n in zip(seed, normal, strict=True))
    x = [s - along * n for s, n in zip(seed, normal, strict=True)]
    length = math.sqrt(float_sum(v * v for v in x))
    a, b, c = (v / length for v in x)
    p, q, r = normal
    return (a, b, c), (q * c - r * b, r * a - p * c, p * b - q * a)


# ---------------------------------------------------------------------- limits


def _limits(joint: JointDraft) -> tuple[float, float, float, float]:
    """Return lower, upper, effort and velocity limits; a missing limit is infinite."""
    element, name = joint.element, joint.name
    limit = element.child("limit")
    bounded = joint.type in ("revolute", "prismatic")
    if limit is None:
        if bounded:
            hint = 'use type="continuous"' if joint.type == "revolute" else "add <limit lower= upper= ...>"
            message = f"{joint.type} joint {name!r} has no <limit>, which URDF requires; the joint is unlimited"
            element.warning("SK-URDF-020", message, hint)
        return (-math.inf, math.inf, math.inf, math.inf)
    effort, velocity = _unsigned_limit(joint, limit, "effort"), _unsigned_limit(joint, limit, "velocity")
    lower, upper = _position_limit(limit, "lower"), _position_limit(limit, "upper")
    if not bounded:
        return (-math.inf, math.inf, effort, velocity)
    if "lower" not in limit.attributes and "upper" not in limit.attributes:
        message = f"{joint.type} joint {name!r}: <limit> has no lower= and no upper=; both are 0, so it cannot move"
        limit.warning("SK-URDF-020", message)
    if lower > upper:
        message = f"joint {name!r} has a lower limit {lower:g} above its upper limit {upper:g}; the joint is unlimited"
        limit.warning("SK-URDF-019", message)
        return (-math.inf, math.inf, effort, velocity)
    return (lower, upper, effort, velocity)


def _position_limit(limit: Params, attribute: str) -> float:
    value = number_attribute(limit, attribute, 0.0, finite=False)
    return math.copysign(math.inf, value) if abs(value) >= _NO_LIMIT else value


def _unsigned_limit(joint: JointDraft, limit: Params, attribute: str) -> float:
    """Return an effort or velocity limit; a missing or negative limit, or a velocity of 0, means unlimited."""
    if attribute not in limit.attributes:
        limit.attribute(attribute)
        if joint.type in ("revolute", "prismatic"):
            message = f"joint {joint.name!r}: <limit> has no {attribute}=, which URDF requires; it is unlimited"
            limit.warning("SK-URDF-020", message)
        return math.inf
    value = number_attribute(limit, attribute, -1.0, finite=False)
    if value == 0 and attribute == "velocity":
        message = f"joint {joint.name!r} has a velocity limit of 0 and could never move; its velocity is unlimited"
        limit.warning("SK-URDF-019", message)
        return math.inf
    return math.inf if value < 0 or value >= _NO_LIMIT else value


# ---------------------------------------------------------------------- mimic, safety, calibration


def _mimic(draft: RobotDraft, joint: JointDraft) -> Mimic | None:
    """Return the coupling position = multiplier · leader + offset; None if there is no valid `<mimic>`."""
    element = joint.element.child("mimic")
    if element is None:
        return None
    leader = text_attribute(element, "joint")
    multiplier, offset = number_attribute(element, "multiplier", 1.0), number_attribute(element, "offset", 0.0)
    if not leader:
        report_missing(element, "joint", "the name of a joint", f"joint {joint.name!r}")
        return None
    if leader in draft.faulty_joints:
        return None
    if joint.type in _NO_MIMIC:
        element.warning("SK-URDF-015", f"{joint.type} joint {joint.name!r}: <mimic> has no effect")
        return None
    if leader not in draft.joints:
        moving = [n for n, j in draft.joints.items() if j.type not in _NO_MIMIC]
        message = f"joint {joint.name!r} mimics {leader!r}, which does not exist; it moves freely"
        element.warning("SK-URDF-015", message, did_you_mean(leader, moving))
        return None
    if draft.joints[leader].type in _NO_MIMIC:
        message = f"joint {joint.name!r} mimics {leader!r}, a {draft.joints[leader].type} joint; it moves freely"
        element.warning("SK-URDF-015", message)
        return None
    if leader == joint.name or _is_in_mimic_ring(draft, joint.name):
        element.error("SK-URDF-015", f"joint {joint.name!r} mimics itself")
        return None
    return Mimic(draft.own(leader), 0, multiplier, offset)


def _is_in_mimic_ring(draft: RobotDraft, start: str) -> bool:
    name, steps = start, 0
    while steps <= min(len(draft.joints), MOST_LEADERS):  # longer chains are refused later
        joint = draft.joints.get(name)
        element = None if joint is None else joint.element.child("mimic")
        if element is None:
            return False
        name, steps = text_attribute(element, "joint"), steps + 1
        if name == start:
            return True
    return False


def _safety(element: Params) -> Safety | None:
    block = element.child("safety_controller")
    if block is None:
        return None
    return Safety(
        number_attribute(block, "soft_lower_limit", 0.0, finite=False),
        number_attribute(block, "soft_upper_limit", 0.0, finite=False),
        number_attribute(block, "k_position", 0.0),
        number_attribute(block, "k_velocity", owner="safety_controller"),
    )


def _calibration(element: Params) -> Calibration | None:
    block = element.child("calibration")
    if block is None:
        return None
    rising = number_attribute(block, "rising", 0.0) if text_attribute(block, "rising") else None
    falling = number_attribute(block, "falling", 0.0) if text_attribute(block, "falling") else None
    if text_attribute(block, "reference_position") and rising is None:  # the spelling of URDF before 1.0
        rising = parse_number(text_attribute(block, "reference_position"))
    return Calibration(rising, falling)
