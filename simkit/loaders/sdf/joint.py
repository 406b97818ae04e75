"""`<joint>` of a model or a world: its links, frame and axes."""

from __future__ import annotations

import math

from simkit.diagnostics import Where, did_you_mean
from simkit.loaders.sdf.entity_names import named_elements, scoped
from simkit.loaders.sdf.frames import MODEL, WORLD, Frame, world_pose
from simkit.loaders.sdf.load_context import NamedElement, Workspace, local_pose
from simkit.loaders.sdf.plugin import read_plugins
from simkit.loaders.sdf.sensor import read_sensor
from simkit.params import Params
from simkit.pose import IDENTITY, Pose
from simkit.scene import Axis, Mimic, SceneJoint, SceneSensor

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
    """The text of `<parent>` or `<child>`; before 1.2 it was an attribute."""
    found = joint.child(name)
    return "" if found is None else found.value or found.attribute("link").strip()


def read_joint(part: NamedElement, model: str, workspace: Workspace) -> SceneJoint | None:
    """A joint whose frame is known; None, with errors recorded, when it joins nothing.

    Args:
        model: scoped name of its model; empty in a world.
    """
    element, diagnostics = part.element, workspace.diagnostics
    own = scoped(model, part.name)
    kind = element.attribute("type").strip()
    parent, child = _joint_link(part, "parent", workspace), _joint_link(part, "child", workspace)
    if kind not in AXES:
        hint = did_you_mean(kind, AXES)
        diagnostics.error(
            "SK-SDF-008", f"joint {part.name!r} has type {kind!r}, known are {', '.join(AXES)}", element.where, hint
        )
        element.mark_all_read()
        return None
    if parent is None or child is None:
        if child is not None:
            _axes(part, kind, IDENTITY, workspace)  # for what is wrong with them
        element.mark_all_read()
        return None
    if parent is child:
        message = f"joint {part.name!r} joins link {child.scoped!r} with itself"
        diagnostics.error("SK-SDF-007", message, element.where)
        element.mark_all_read()
        return None
    pose = world_pose(part.frame)
    element.child("pose")
    return SceneJoint(
        name=part.name,
        scoped=own,
        type=kind,
        parent_link=WORLD if parent.kind == WORLD else parent.scoped,
        child_link=child.scoped,
        pose_world=pose,
        axes=_axes(part, kind, pose, workspace),
        thread_pitch=_thread_pitch(element) if kind == "screw" else 0.0,
        gearbox_ratio=element.number("gearbox_ratio", 1.0) if kind == "gearbox" else 1.0,
        gearbox_reference=_gearbox_reference(part, workspace) if kind == "gearbox" else "",
        sensors=_sensors(part, own, child, workspace),
        plugins=read_plugins(element.all("plugin"), own),
        where=element.where,
    )


def _sensors(part: NamedElement, own: str, child: Frame, workspace: Workspace) -> tuple[SceneSensor, ...]:
    """The joint's sensors, their poses in the child link's frame."""
    diagnostics, base = workspace.diagnostics, world_pose(child)
    in_child = base.inverse() @ world_pose(part.frame)
    sensors = []
    for name, e in named_elements(part.element.all("sensor"), f"joint {part.name!r}", diagnostics, part.file.version):
        pose = in_child @ local_pose(e, part.scope, part.frame, f"sensor {name!r}")
        sensors.append(read_sensor(e, name, own, True, pose, base, diagnostics))
    return tuple(sensors)


def _joint_link(part: NamedElement, which: str, workspace: Workspace) -> Frame | None:
    """The link at one end; the parent may be the world."""
    element, diagnostics = part.element, workspace.diagnostics
    name = joint_link_name(element, which)
    place = element.child(which) or element
    what = f"joint {part.name!r}: the {which}"
    if not name:
        near = "" if element.has(which) else did_you_mean(which, [c.name for c in element.children])
        diagnostics.error("SK-SDF-026", f"joint {part.name!r} needs <{which}>", place.where, near)
        return None
    if name == WORLD:
        if which == "child":
            diagnostics.error("SK-SDF-004", f"{what} cannot be the world", place.where, "exchange parent and child")
            return None
        return Frame(WORLD, WORLD, WORLD)
    frames = part.scope.chain(name)
    if frames is None:
        part.scope.report_unknown(name, what, place.where)
        return None
    if frames and frames[-1] is part.frame:
        diagnostics.error("SK-SDF-007", f"{what} is the joint itself", place.where)
        return None
    return part.scope.body(name, place.where, what)


def _axes(part: NamedElement, kind: str, pose_world: Pose, workspace: Workspace) -> tuple[Axis, ...]:
    axes = []
    for index, name in enumerate(("axis", "axis2")):
        if index >= AXES[kind]:
            part.element.has(name)  # it has no meaning for this kind, which the report on unused elements says
            continue
        element = part.element.child(name)
        if element is None:
            if kind != "gearbox" or index == 0:
                workspace.diagnostics.warning(
                    "SK-SDF-026", f"{kind} joint {part.name!r} has no <{name}>; 0 0 1 is used", part.element.where
                )
                element = Params(name, where=part.element.where, diagnostics=workspace.diagnostics)
            else:
                continue
        axes.append(_axis(part, element, kind, pose_world, workspace))
    return tuple(axes)


def _axis(part: NamedElement, element: Params, kind: str, pose_world: Pose, workspace: Workspace) -> Axis:
    direction = _direction(part, element, workspace)
    limit, dynamics = element.block("limit"), element.block("dynamics")
    lower = _position_limit(limit, "lower", -math.inf)
    upper = _position_limit(limit, "upper", math.inf)
    if kind == "continuous":
        lower, upper = -math.inf, math.inf
    if lower > upper:
        workspace.diagnostics.warning(
            "SK-SDF-027",
            f"joint {part.name!r} has a lower limit {lower:g} above its upper limit {upper:g}; it is read as unlimited",
            (limit.child("lower") or limit).where,
        )
        lower, upper = -math.inf, math.inf
    turned = pose_world.rotate(direction)
    return Axis(
        xyz_world=(float(turned[0]), float(turned[1]), float(turned[2])),
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
    """A number that is not negative, where the file gives one."""
    return block.number(name, 0.0, minimum=0.0) if block.has(name) else None


def _direction(part: NamedElement, element: Params, workspace: Workspace) -> tuple[float, float, float]:
    """The unit axis in the joint frame; it is given there, in `expressed_in`, or (before 1.5) in the model frame."""
    x, y, z = element.vector3("xyz", (0.0, 0.0, 1.0))
    xyz = element.child("xyz")
    length = math.hypot(x, y, z)
    where = (xyz or element).where
    if length < 1e-12:
        workspace.diagnostics.error("SK-SDF-017", f"joint {part.name!r} has an axis of length zero", where)
        return (0.0, 0.0, 1.0)
    frame = xyz.attribute("expressed_in") if xyz is not None else ""
    in_model = (
        element.boolean("use_parent_model_frame", part.file.version < (1, 5)) if part.file.version < (1, 7) else False
    )
    if not frame and in_model:
        frame = MODEL
    unit = (x / length, y / length, z / length)
    if not frame:
        return unit
    source = (
        IDENTITY if frame == MODEL and part.scope.root.scope is None else part.scope.pose_of(frame, part.frame, where)
    )
    turned = part.scope.resolve(part.frame).inverse().rotate(source.rotate(unit))
    return (float(turned[0]), float(turned[1]), float(turned[2]))


def _position_limit(limit: Params, name: str, none: float) -> float:
    """A position limit; from 1e15 on it means none."""
    value = limit.number(name, none, finite=False)
    return math.copysign(math.inf, value) if abs(value) >= _NO_LIMIT else value


def _unsigned_limit(limit: Params, name: str) -> float:
    """An effort or velocity limit; negative means none."""
    value = limit.number(name, -1.0, finite=False)
    return math.inf if value < 0 or value >= _NO_LIMIT else value


def _mimic(part: NamedElement, element: Params) -> Mimic | None:
    block = element.child("mimic")
    if block is None:
        return None
    leader = block.attribute("joint")
    frames = part.scope.chain(leader)
    if not leader or not frames or frames[-1].kind != "joint":
        part.scope.report_unknown(leader, f"joint {part.name!r} mimics a joint that", block.where)
        return None
    return Mimic(
        joint=frames[-1].scoped,
        axis=1 if block.attribute("axis", "axis") == "axis2" else 0,
        multiplier=block.number("multiplier", 1.0),
        offset=block.number("offset", 0.0),
        reference=block.number("reference", 0.0),
    )


def _thread_pitch(element: Params) -> float:
    """Metres per turn: `screw_thread_pitch`, or the older `thread_pitch` [rad/m], which is left-handed."""
    old = element.number("thread_pitch", 1.0)
    if element.has("screw_thread_pitch"):
        return element.number("screw_thread_pitch", 1.0)
    if old == 0:
        place = element.child("thread_pitch") or element
        place.error("SK-PARAM-002", "found <thread_pitch>0</thread_pitch>, allowed is a number other than 0")
        return 1.0
    return -2 * math.pi / old if element.has("thread_pitch") else 1.0


def _gearbox_reference(part: NamedElement, workspace: Workspace) -> str:
    name = part.element.text("gearbox_reference_body", "")
    if not name:
        workspace.diagnostics.error(
            "SK-SDF-026", f"gearbox {part.name!r} needs <gearbox_reference_body>", part.element.where
        )
        return ""
    where: Where = (part.element.child("gearbox_reference_body") or part.element).where
    body = part.scope.body(name, where, f"gearbox {part.name!r}")
    return body.scoped if body is not None else ""
