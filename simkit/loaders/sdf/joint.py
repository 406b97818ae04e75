"""Reader of `<joint>` in a model or a world: its links, frame and axes."""

from __future__ import annotations

import math
from collections.abc import Iterable

from simkit.diagnostics import did_you_mean
from simkit.loaders.sdf.entity_names import scoped
from simkit.loaders.sdf.frames import MODEL, WORLD, Frame, world_pose
from simkit.loaders.sdf.load_context import NamedElement
from simkit.loaders.sdf.plugin import read_plugins
from simkit.loaders.sdf.sensor import read_sensors
from simkit.params import Params
from simkit.pose import IDENTITY, Pose
from simkit.scene import Axis, Mimic, SceneJoint
from simkit.scene.geometry import Vec3, vec3

AXES = {
    "revolute": 1,
    "continuous": 1,
    "prismatic": 1,
    "screw": 1,
    "gearbox": 2,
    "universal": 2,
    "revolute2": 2,
    "fixed": 0,
    "ball": 0,
}
_NO_LIMIT = 1e15


def joint_link_name(joint: Params, name: str) -> str:
    """Return the link name in `<parent>` or `<child>`; SDF before 1.2 has this name in the attribute `link`."""
    link = joint.child(name)
    return "" if link is None else link.value or link.attribute("link").strip()


def read_joints(parts: Iterable[NamedElement], model: str) -> tuple[SceneJoint, ...]:
    """Return the joints; a joint without two valid links is an error and is left out.

    Args:
        parts: named joint elements.
        model: scoped name of their model; empty in a world.
    """
    return tuple(joint for part in parts if (joint := _joint(part, model)) is not None)


def _joint(part: NamedElement, model: str) -> SceneJoint | None:
    element = part.element
    joint_name = scoped(model, part.name)
    kind = element.attribute("type").strip()
    parent, child = _joint_link(part, "parent"), _joint_link(part, "child")
    if kind not in AXES:
        message = f"joint {part.name!r} has unknown type {kind!r}; known are {', '.join(AXES)}"
        hint = "remove the joint: a link without a joint is free" if kind == "floating" else did_you_mean(kind, AXES)
        element.error("SK-SDF-008", message, hint)
    elif parent is None and child is not None:
        _axes(part, kind, IDENTITY)  # only to report problems of the axes
    elif parent is not None and parent is child:
        element.error("SK-SDF-007", f"joint {part.name!r} joins link {child.scoped!r} with itself")
    if kind not in AXES or parent is None or child is None or parent is child:
        element.mark_all_read()
        return None
    pose = world_pose(part.frame)
    element.child("pose")
    return SceneJoint(
        name=part.name,
        scoped=joint_name,
        type=kind,
        parent_link=WORLD if parent.kind == WORLD else parent.scoped,
        child_link=child.scoped,
        pose_world=pose,
        axes=_axes(part, kind, pose),
        thread_pitch=_thread_pitch(element) if kind == "screw" else 0.0,
        gearbox_ratio=element.number("gearbox_ratio", 1.0) if kind == "gearbox" else 1.0,
        gearbox_reference=_gearbox_reference(part) if kind == "gearbox" else "",
        sensors=read_sensors(part, joint_name, world_pose(child), world_pose(child).inverse() @ pose),
        plugins=read_plugins(element.all("plugin"), joint_name),
        where=element.where,
    )


def _joint_link(part: NamedElement, which: str) -> Frame | None:
    """Return the parent or child link of a joint; the parent can be the world."""
    element = part.element
    name = joint_link_name(element, which)
    place = element.child_or_self(which)
    what = f"joint {part.name!r}: the {which}"
    if not name:
        near = "" if element.has(which) else did_you_mean(which, [c.name for c in element.children])
        place.error("SK-SDF-026", f"joint {part.name!r} needs <{which}>", near)
        return None
    if name == WORLD:
        if which == "child":
            place.error("SK-SDF-004", f"{what} cannot be the world", "swap <parent> and <child>")
            return None
        return Frame(WORLD, WORLD, WORLD)
    frames = part.scope.chain(name)
    if frames is None:
        part.scope.report_unknown(name, what, place.where)
        return None
    if frames and frames[-1] is part.frame:
        place.error("SK-SDF-007", f"{what} is the joint itself")
        return None
    return part.scope.body(name, place.where, what)


def _axes(part: NamedElement, kind: str, pose_world: Pose) -> tuple[Axis, ...]:
    axes = []
    for index, name in enumerate(("axis", "axis2")):
        has_axis = part.element.has(name)
        if index >= AXES[kind] or (kind == "gearbox" and index == 1 and not has_axis):
            continue  # the report on unused elements lists axes that this joint type does not have
        if not has_axis:
            part.element.warning("SK-SDF-026", f"{kind} joint {part.name!r} has no <{name}>; 0 0 1 is used")
        axes.append(_axis(part, part.element.block(name), kind, pose_world))
    return tuple(axes)


def _axis(part: NamedElement, element: Params, kind: str, pose_world: Pose) -> Axis:
    direction = _direction(part, element)
    limit, dynamics = element.block("limit"), element.block("dynamics")
    lower = _position_limit(limit, "lower", -math.inf)
    upper = _position_limit(limit, "upper", math.inf)
    if kind == "continuous":
        lower, upper = -math.inf, math.inf
    if lower > upper:
        message = f"joint {part.name!r} has a lower limit {lower:g} above its upper limit {upper:g}"
        limit.child_or_self("lower").warning("SK-SDF-027", f"{message}; the joint is unlimited")
        lower, upper = -math.inf, math.inf
    return Axis(
        xyz_world=vec3(pose_world.rotate(direction)),
        xyz_joint=direction,
        lower=lower,
        upper=upper,
        effort=_unsigned_limit(limit, "effort"),
        velocity=_unsigned_limit(limit, "velocity"),
        damping=dynamics.number("damping", 0.0, maximum=_NO_LIMIT),
        friction=dynamics.number("friction", 0.0, maximum=_NO_LIMIT),
        stiffness=dynamics.number("spring_stiffness", 0.0, maximum=_NO_LIMIT),
        spring_ref=dynamics.number("spring_reference", 0.0, minimum=-_NO_LIMIT, maximum=_NO_LIMIT),
        mimic=_mimic(part, element),
        limit_stiffness=_optional_non_negative(limit, "stiffness"),
        limit_dissipation=_optional_non_negative(limit, "dissipation"),
    )


def _optional_non_negative(block: Params, name: str) -> float | None:
    """Return a number that is not negative, or None if the file gives none."""
    return block.number(name, 0.0, minimum=0.0) if block.has(name) else None


def _direction(part: NamedElement, element: Params) -> Vec3:
    """Return the unit axis in the joint frame.

    The file can give the axis in another frame: the frame `expressed_in`, or before SDF 1.5 the model frame.
    """
    x, y, z = element.vector3("xyz", (0.0, 0.0, 1.0))
    xyz = element.child_or_self("xyz")
    length = math.hypot(x, y, z)
    if length < 1e-12:
        xyz.error("SK-SDF-017", f"joint {part.name!r} has an axis of length zero")
        return (0.0, 0.0, 1.0)
    frame = xyz.attribute("expressed_in") if xyz is not element else ""
    version = part.file.version
    in_model = version < (1, 7) and element.boolean("use_parent_model_frame", version < (1, 5))
    if not frame and in_model:
        frame = MODEL
    unit = (x / length, y / length, z / length)
    if not frame:
        return unit
    is_own_model = frame == MODEL and part.scope.root.scope is None
    source = IDENTITY if is_own_model else part.scope.pose_of(frame, part.frame, xyz.where)
    return vec3(part.scope.resolve(part.frame).inverse().rotate(source.rotate(unit)))


def _position_limit(limit: Params, name: str, default: float) -> float:
    """Return a position limit; an absolute value of at least 1e15 means no limit."""
    value = limit.number(name, default, finite=False)
    return math.copysign(math.inf, value) if abs(value) >= _NO_LIMIT else value


def _unsigned_limit(limit: Params, name: str) -> float:
    """Return an effort or velocity limit; a negative value means no limit."""
    value = limit.number(name, -1.0, finite=False)
    return math.inf if value < 0 or value >= _NO_LIMIT else value


def _mimic(part: NamedElement, element: Params) -> Mimic | None:
    block = element.child("mimic")
    if block is None:
        return None
    leader = block.attribute("joint")
    frames = part.scope.chain(leader)
    if not leader or not frames or frames[-1].kind != "joint":
        part.scope.report_unknown(leader, f"joint {part.name!r}: the mimicked joint", block.where)
        return None
    return Mimic(
        joint=frames[-1].scoped,
        axis=1 if block.attribute("axis", "axis") == "axis2" else 0,
        multiplier=block.number("multiplier", 1.0),
        offset=block.number("offset", 0.0),
        reference=block.number("reference", 0.0),
    )


def _thread_pitch(element: Params) -> float:
    """Return metres per turn from `screw_thread_pitch`, or from the older left-handed `thread_pitch` [rad/m]."""
    old = element.number("thread_pitch", 1.0)
    if element.has("screw_thread_pitch"):
        return element.number("screw_thread_pitch", 1.0)
    if old == 0:
        message = "found <thread_pitch>0</thread_pitch>; expected a number other than 0"
        element.child_or_self("thread_pitch").error("SK-PARAM-002", message)
        return 1.0
    return -2 * math.pi / old if element.has("thread_pitch") else 1.0


def _gearbox_reference(part: NamedElement) -> str:
    name = part.element.text("gearbox_reference_body", "")
    if not name:
        part.element.error("SK-SDF-026", f"gearbox {part.name!r} needs <gearbox_reference_body>")
        return ""
    where = part.element.child_or_self("gearbox_reference_body").where
    body = part.scope.body(name, where, f"gearbox {part.name!r}")
    return body.scoped if body is not None else ""
