"""Reader of `<robot>`: converts a URDF file to one bare model."""

from __future__ import annotations

from pathlib import Path

from simkit.loaders.resources.uri_resolver import Resolver
from simkit.loaders.sdf.entity_names import named_elements, scoped
from simkit.loaders.sdf.frames import Frame, Scope
from simkit.loaders.sdf.joint import joint_link_name, read_joints
from simkit.loaders.sdf.link import read_link as read_sdf_link
from simkit.loaders.sdf.load_context import NamedElement, SdfFile, Workspace, read_pose
from simkit.loaders.sdf.model import read_frames
from simkit.loaders.sdf.plugin import read_plugins
from simkit.loaders.urdf.element_attributes import text_attribute
from simkit.loaders.urdf.gazebo_extensions import GazeboExtensions, read_flag
from simkit.loaders.urdf.joint import read_joint
from simkit.loaders.urdf.kinematic_tree import declare_tree, place_links
from simkit.loaders.urdf.link import is_massless, read_link
from simkit.loaders.urdf.material import Materials
from simkit.loaders.urdf.robot_draft import RobotDraft, RobotFiles
from simkit.loaders.urdf.transmission import read_controls, read_transmissions
from simkit.loaders.urdf.unread_elements import report_unread
from simkit.pose import Pose
from simkit.scene import SceneJoint, SceneLink, SceneModel


def _added_elements(draft: RobotDraft, kind: str) -> list[NamedElement]:
    """Return the elements that `<gazebo>` blocks without a reference add, and register their names."""
    parts = []
    elements, owner = draft.extensions.robot.all(kind), f"robot {draft.name!r}"
    for name, element in named_elements(elements, owner, draft.diagnostics, draft.file.version):
        existing = draft.scope.names.get(name)
        if existing is not None:
            text = f"<gazebo>: {kind} {name!r} has the same name as a {existing.kind} (line {existing.where.line})"
            element.mark_all_read()
            element.warning("SK-URDF-002", f"{text}; this one is left out, as in Gazebo")
            continue
        pose, base = read_pose(element)
        attached = joint_link_name(element, "child") if kind == "joint" else element.attribute("attached_to")
        frame = Frame(name, kind, draft.own(name), draft.scope, pose, base, attached, where=element.where)
        draft.scope.names[name] = frame
        parts.append(NamedElement(name, element, frame, draft.scope, draft.file))
    return parts


WORLD = "world"


def declare_robot(file: SdfFile, workspace: Workspace, resolver: Resolver) -> RobotDraft:
    """Register the names in a robot's file; every mistake in its structure is recorded."""
    element, diagnostics = file.root, workspace.diagnostics
    name = text_attribute(element, "name")
    if not name:
        name = Path(file.chain[-1]).name.partition(".")[0] or "robot"
        message = f"<robot> has no name=, which URDF requires; the name {name!r} is used"
        diagnostics.warning("SK-URDF-027", message, element.where)
    draft = RobotDraft(
        name=name,
        scoped="",
        element=element,
        file=file,
        workspace=workspace,
        assets=RobotFiles(resolver, file.folder, diagnostics),
        scope=Scope(Frame(name, "model", name), diagnostics),
        extensions=GazeboExtensions(element, diagnostics),
    )
    declare_tree(draft)
    return draft


def build_robot(
    draft: RobotDraft,
    outer: str,
    pose: Pose | None = None,
    base: str = "auto",
    static: bool | None = None,
    is_included: bool = False,
) -> SceneModel:
    """Return the model of a robot.

    Args:
        draft: the robot.
        outer: scoped name of the model that contains it; empty at the top.
        pose: pose of its root link in the world; None for the pose in its file, or the origin.
        base: "auto", "fixed" or "floating".
        static: true if it is static; None for the value in its file.
        is_included: true if an SDF file includes the robot; a joint of that file can fix the robot to the world.
    """
    robot = draft.extensions.robot
    draft.scoped = scoped(outer, draft.name)
    own_pose = robot.pose("pose")
    draft.pose = own_pose if pose is None else pose
    draft.scope.world = draft.pose
    place_links(draft)
    materials = Materials(draft)
    windy = bool(read_flag(robot, "enable_wind"))
    more_links, more_joints, frames = (_added_elements(draft, kind) for kind in ("link", "joint", "frame"))
    links = (
        *(read_link(draft, name, materials, windy) for name in draft.links),
        *(read_sdf_link(part, draft.scoped, False, windy, draft.workspace) for part in more_links),
    )
    joints = (*(read_joint(draft, j) for j in draft.joints.values()), *read_joints(more_joints, draft.scoped))
    draft.extensions.report_unknown(draft.links, draft.joints, draft.faulty_joints)
    _check_force_sensors(links, joints)
    declared = bool(read_flag(robot, "static"))
    is_static = declared if static is None else static
    model = SceneModel(
        name=draft.name,
        scoped=draft.scoped,
        pose_world=draft.pose,
        static=is_static,
        declared_static=declared,
        self_collide=bool(read_flag(robot, "self_collide", "selfCollide")),
        canonical_link=draft.own(draft.root) if draft.root else "",
        base=base if is_static else _choose_base(draft, base, is_included, _fixed_base_reason(draft, links, joints)),
        links=links,
        joints=joints,
        frames=read_frames(frames),
        plugins=read_plugins(robot.all("plugin"), draft.scoped),
        where=draft.element.where,
        allow_auto_disable=read_flag(robot, "allow_auto_disable") is not False,
        transmissions=read_transmissions(draft),
        controls=read_controls(draft),
        urdf=draft.element,
        arguments=draft.file.arguments,
    )
    draft.assets.report_packages()
    _report_frames(draft, links)
    report_unread(draft.element, draft.extensions)
    return model


def _fixed_base_reason(draft: RobotDraft, links: tuple[SceneLink, ...], joints: tuple[SceneJoint, ...]) -> str:
    """Return the reason why the base cannot float; empty if it can.

    Gazebo removes links without mass. PyBullet also fixes the base of a robot without mass.
    """
    heavy = {link.scoped for link in links if link.inertial.mass > 0}
    if not heavy:
        return "no link has mass"
    ground = {draft.own(draft.root)} if draft.root else set()
    under: dict[str, list[SceneJoint]] = {}
    for joint in joints:
        under.setdefault(joint.parent_link, []).append(joint)
    stack, kinds = list(ground), set[str]()
    while stack:
        for joint in under.get(stack.pop(), ()):
            if joint.type != "fixed":
                kinds.add(joint.type)
            elif joint.child_link not in ground:
                ground.add(joint.child_link)
                stack.append(joint.child_link)
    if kinds and kinds <= {"planar", "floating"} and not ground & heavy:
        return f"its root link {draft.root!r} has no mass and represents the ground under a moving base"
    return ""


def _choose_base(draft: RobotDraft, base: str, is_included: bool, fixed_reason: str) -> str:
    """Apply Gazebo's rule: a robot whose root link is named `world` is fixed; every other robot floats.

    A robot that cannot float, because of `fixed_reason`, is fixed.
    """
    element, owner = draft.element, f"robot {draft.name!r}"
    if draft.root == WORLD:
        if base == "floating":
            message = f"{owner}: its root link is 'world', so its base stays fixed"
            element.warning("SK-URDF-018", message, "remove the link 'world' from the file")
        elif base == "auto" and not is_included:
            element.note("SK-URDF-017", f"{owner}: base is fixed, because its root link is named 'world'")
        return "fixed"
    if base == "auto" and fixed_reason and draft.root:
        hint = "to let it move, add an <inertial> to its links"
        element.warning("SK-URDF-032", f"{owner}: {fixed_reason}, so its base is fixed", hint)
        return "fixed"
    if base == "auto" and not is_included:
        message = f"{owner}: base is floating, because no link is named 'world'"
        element.note("SK-URDF-017", message, "to fix it in the world: --base fixed, in Python base='fixed'")
    return base


def _report_frames(draft: RobotDraft, links: tuple[SceneLink, ...]) -> None:
    names = [link.name for link in links if not link.inertial.given and link.name != WORLD]
    if names:
        listed = ", ".join(names[:8]) + (f" and {len(names) - 8} more" if len(names) > 8 else "")
        message = f"robot {draft.name!r}: links without <inertial> are frames without mass: {listed}"
        draft.links.get(names[0], draft.element).note("SK-URDF-024", message)


def _check_force_sensors(links: tuple[SceneLink, ...], joints: tuple[SceneJoint, ...]) -> None:
    """Report force_torque sensors that would always read zero: no mass and no collision is below their joint."""
    by_name = {link.scoped: link for link in links}
    below: dict[str, list[str]] = {}
    for joint in joints:
        below.setdefault(joint.parent_link, []).append(joint.child_link)
    for joint in joints:
        sensors = [s for s in joint.sensors if s.kind == "force_torque"]
        if not sensors:
            continue
        carried, stack = set[str](), [joint.child_link]
        while stack:
            name = stack.pop()
            if name not in carried:
                carried.add(name)
                stack += below.get(name, [])
        loaded = [by_name[n] for n in carried if n in by_name]
        if loaded and all(is_massless(link) and not link.collisions for link in loaded):
            message = (
                f"sensor {sensors[0].name!r} measures the force on joint {joint.name!r}, which carries only frames "
                f"without mass ({', '.join(sorted(link.name for link in loaded)[:6])}); it would always read zero"
            )
            hint = "add an <inertial> to the link, or move the sensor to a joint that carries mass"
            sensors[0].params.error("SK-URDF-023", message, hint)
