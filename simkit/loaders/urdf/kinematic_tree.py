"""Links and joints of a robot: their names, the check that they form one tree, and the pose of each link."""

from __future__ import annotations

from simkit.diagnostics import did_you_mean
from simkit.loaders.sdf.frames import Frame
from simkit.loaders.urdf.element_attributes import read_origin, report_missing, skip_element, text_attribute
from simkit.loaders.urdf.robot_draft import JointDraft, RobotDraft
from simkit.number_text import counted
from simkit.params import Params
from simkit.pose import IDENTITY

TYPES = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")


def declare_tree(draft: RobotDraft) -> None:
    """Register every link and joint, check that they form one tree, and fill `links`, `joints` and `root`."""
    draft.links = _elements_by_name(draft, "link")
    if not draft.links:
        near = ", ".join(f"<{name}>" for name in dict.fromkeys(c.name for c in draft.element.children))
        hint = f"it has only {near}" if near else "add a <link>"
        draft.diagnostics.error("SK-URDF-008", f"robot {draft.name!r} has no link", draft.element.where, hint)
    for name, element in _elements_by_name(draft, "joint").items():
        joint = _joint(draft, name, element)
        if joint is not None:
            draft.joints[name] = joint
        else:
            draft.faulty_joints.add(name)
            skip_element(element)
    _check_tree(draft)


def place_links(draft: RobotDraft) -> None:
    """Compute the pose of each link with all joints at zero, and register links and joints in the draft's scope."""
    below: dict[str, list[JointDraft]] = {}
    for joint in draft.joints.values():
        below.setdefault(joint.parent, []).append(joint)
    in_model = {draft.root: IDENTITY} if draft.root else {}
    stack = list(in_model)
    while stack:
        parent = stack.pop()
        for joint in below.get(parent, ()):
            if joint.child not in in_model:
                in_model[joint.child] = in_model[parent] @ joint.origin
                stack.append(joint.child)
    scope = draft.scope
    for name, element in draft.links.items():
        pose = in_model.get(name, IDENTITY)
        draft.links_world[name] = draft.pose @ pose
        scope.names[name] = Frame(name, "link", draft.own(name), scope, pose, where=element.where, resolved=pose)
    for name, joint in draft.joints.items():
        pose = in_model.get(joint.child, IDENTITY)
        frame = Frame(name, "joint", draft.own(name), scope, pose, attached_to=joint.child, resolved=pose)
        frame.where = joint.element.where
        scope.names.setdefault(name, frame)
    scope.canonical = draft.root


def _elements_by_name(draft: RobotDraft, kind: str) -> dict[str, Params]:
    """Return elements by name; a missing, invalid or repeated name is an error."""
    elements: dict[str, Params] = {}
    for element in draft.element.all(kind):
        name = text_attribute(element, "name")
        if not name:
            report_missing(element, "name", "a text")
            element.mark_all_read()
        elif name in elements:
            message = f"two {kind}s are named {name!r} (the other at line {elements[name].where.line})"
            draft.diagnostics.error("SK-URDF-002", message, element.where, "rename one of them")
            skip_element(element)
        else:
            if "::" in name:
                message = f"{kind} {name!r}: a name cannot contain '::', which separates names"
                draft.diagnostics.error("SK-URDF-002", message, element.where)
            elements[name] = element
    return elements


def _joint(draft: RobotDraft, name: str, element: Params) -> JointDraft | None:
    """Return a joint with its type and two links; None, with errors recorded, if one of these is invalid."""
    kind = text_attribute(element, "type")
    if kind == "spherical":
        message = f"joint {name!r} has type 'spherical', which only PyBullet knows; it is a ball joint without limits"
        draft.diagnostics.warning("SK-URDF-004", message, element.where)
        kind = "ball"
    elif kind not in TYPES:
        hint = did_you_mean(kind, TYPES)
        problem = f"has unknown type {kind!r}" if kind else "needs type="
        message = f"joint {name!r} {problem}; known are {', '.join(TYPES)}"
        draft.diagnostics.error("SK-URDF-004", message, element.where, hint)
    parent, child = _joint_link(draft, name, element, "parent"), _joint_link(draft, name, element, "child")
    pose = read_origin(element)
    if parent and parent == child:
        message = f"joint {name!r} joins link {parent!r} with itself"
        draft.diagnostics.error("SK-URDF-007", message, element.where)
        return None
    if kind not in (*TYPES, "ball") or not parent or not child:
        return None
    return JointDraft(name, element, kind, parent, child, pose)


def _joint_link(draft: RobotDraft, name: str, joint: Params, which: str) -> str:
    """Return the parent or child link of a joint; empty, with an error recorded, if there is none."""
    element = joint.child(which)
    if element is None:
        near = did_you_mean(which, [c.name for c in joint.children])
        draft.diagnostics.error("SK-URDF-001", f"joint {name!r} needs <{which} link=...>", joint.where, near)
        return ""
    link = text_attribute(element, "link")
    if not link:
        report_missing(element, "link", "the name of a link", f"joint {name!r}")
        return ""
    if link in draft.links:
        return link
    hint = did_you_mean(link, draft.links)
    if link == "world" and not hint:
        hint = "to fix the robot to the world, add <link name='world'/>"
    message = f"joint {name!r}: the {which} link {link!r} does not exist"
    draft.diagnostics.error("SK-URDF-003", message, element.where, hint)
    return ""


def _check_tree(draft: RobotDraft) -> None:
    """Check that there is one root and one path to each link, and select the root."""
    above: dict[str, JointDraft] = {}
    for joint in list(draft.joints.values()):
        existing = above.get(joint.child)
        if existing is None:
            above[joint.child] = joint
            continue
        first = f"{existing.name!r} (line {existing.element.where.line})"
        message = f"link {joint.child!r} is the child of two joints, {first} and {joint.name!r}; a URDF is a tree"
        hint = "close a loop with an SDF <joint> inside <gazebo>"
        draft.diagnostics.error("SK-URDF-005", message, joint.element.where, hint)
    children_of_bad_joints = {
        text_attribute(e, "link") for j in draft.element.all("joint") for e in (j.child("child"),) if e is not None
    } - set(above)
    roots = [name for name in draft.links if name not in above]
    draft.root = next(iter(roots), next(iter(draft.links), ""))
    unjoined = [name for name in roots if name not in children_of_bad_joints]
    if len(unjoined) > 1 + len(draft.faulty_joints):  # each faulty joint may be the missing connection
        listed = ", ".join(f"{name!r} (line {draft.links[name].where.line})" for name in unjoined[:8])
        more = f" and {len(unjoined) - 8} more" if len(unjoined) > 8 else ""
        message = (
            f"robot {draft.name!r} has {counted(len(unjoined), 'root link')}, but can have only one: {listed}{more}"
        )
        draft.diagnostics.error("SK-URDF-006", message, draft.links[unjoined[1]].where, "join them with a <joint>")
    _report_rings(draft, above)


def _report_rings(draft: RobotDraft, above: dict[str, JointDraft]) -> None:
    """Report each ring of joints once."""
    done: set[str] = set()
    for start in draft.links:
        path: list[str] = []
        name = start
        while name in above and name not in done:
            done.add(name)
            path.append(name)
            name = above[name].parent
        if name in path:
            ring = path[path.index(name) :]
            message = f"joints form a ring: {' <- '.join([*ring[:8], ring[0]])}"
            draft.diagnostics.error("SK-URDF-007", message, above[ring[0]].element.where)
