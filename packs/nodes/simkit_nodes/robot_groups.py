"""Groups of joints of a robot: its description in URDF, and the semantic description (SRDF) of MoveIt."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Final

from simkit import Params
from simkit.extend import Diagnostics, counted
from simkit.loaders.resources.xml_reader import parse_text

_MOVES: Final = frozenset(("revolute", "continuous", "prismatic"))


class DescriptionError(ValueError):
    """Description that cannot be read; the text says why."""


@dataclass(frozen=True)
class TreeJoint:
    """Joint of a description.

    Attributes:
        name: name.
        kind: type in URDF.
        parent, child: names of its links.
        lower, upper: limits [rad or m]; infinite without a limit.
        is_follower: True if the joint mimics another one.
    """

    name: str
    kind: str
    parent: str
    child: str
    lower: float = -math.inf
    upper: float = math.inf
    is_follower: bool = False

    @property
    def moves(self) -> bool:
        """Check whether a joint has one degree of freedom."""
        return self.kind in _MOVES

    @property
    def is_active(self) -> bool:
        """Check whether a joint moves by itself."""
        return self.moves and not self.is_follower


@dataclass(frozen=True)
class JointTree:
    """Links and joints of a robot, in MoveIt's order: depth first, and by name below a link.

    Attributes:
        name: name of the robot.
        root: name of the root link.
        joints: joints by name.
        links: names of the links.
    """

    name: str
    root: str
    joints: Mapping[str, TreeJoint]
    links: tuple[str, ...]

    def path(self, link: str) -> list[str]:
        """Return the names of the joints from the root to a link.

        Raises:
            DescriptionError: there is no such link.
        """
        if link not in self.links:
            raise DescriptionError(f"the robot {self.name!r} has no link {link!r}")
        above = {joint.child: joint for joint in self.joints.values()}
        names: list[str] = []
        while link in above:
            names.append(above[link].name)
            link = above[link].parent
        return names[::-1]

    def chain(self, base: str, tip: str) -> set[str]:
        """Return the names of the joints between two links."""
        return set(self.path(base)) ^ set(self.path(tip))


@dataclass(frozen=True)
class JointGroup:
    """Group of joints.

    Attributes:
        name: name.
        joints: names of all its joints, also of fixed ones.
        active: names of the joints that move by themselves.
        links: names of the links that its joints carry.
        tip: last link if the joints are one chain; else empty.
        states: named states: positions [rad or m] by joint.
    """

    name: str
    joints: tuple[str, ...]
    active: tuple[str, ...]
    links: tuple[str, ...]
    tip: str
    states: Mapping[str, Mapping[str, float]] = field(default_factory=dict)


@dataclass(frozen=True)
class RobotGroups:
    """Semantic description of a robot.

    Attributes:
        tree: links and joints.
        groups: groups by name.
        planning_frame: frame of plans: the frame of the virtual joint, or the root link.
        disabled_collisions: pairs of links that are not checked for collisions.
        problems: sentences about elements that have no effect.
    """

    tree: JointTree
    groups: Mapping[str, JointGroup]
    planning_frame: str
    disabled_collisions: tuple[tuple[str, str], ...] = ()
    problems: tuple[str, ...] = ()


def read_joint_tree(urdf: str) -> JointTree:
    """Return the links and joints of a description in URDF.

    Raises:
        DescriptionError: it is not valid.
    """
    root = _robot_element(urdf, "robot description")
    unsorted = [_joint(element) for element in root.children if element.name == "joint"]
    links = [element.attributes.get("name", "") for element in root.children if element.name == "link"]
    children = {joint.child for joint in unsorted}
    tops = [link for link in links if link not in children]
    if len(tops) != 1:
        text = f"{counted(len(tops), 'root link')}: {', '.join(tops)}" if tops else "no root link"
        raise DescriptionError(f"the robot description has {text}; expected one")
    below: dict[str, list[TreeJoint]] = {}
    for joint in sorted(unsorted, key=lambda joint: joint.name):
        below.setdefault(joint.parent, []).append(joint)
    joints: dict[str, TreeJoint] = {}
    ordered, waiting = [tops[0]], below.get(tops[0], [])[::-1]
    while waiting:
        joint = waiting.pop()
        joints[joint.name] = joint
        ordered.append(joint.child)
        waiting += below.get(joint.child, [])[::-1]
    return JointTree(root.attributes.get("name", ""), tops[0], joints, tuple(ordered))


def read_robot_groups(urdf: str, srdf: str) -> RobotGroups:
    """Return the groups of a robot.

    Args:
        urdf: description of the robot.
        srdf: semantic description of the robot.

    Raises:
        DescriptionError: one of them is not valid.
    """
    tree = read_joint_tree(urdf)
    root = _robot_element(srdf, "semantic robot description")
    problems: list[str] = []
    elements = {e.attributes.get("name", ""): e for e in _elements(root, "group")}
    members: dict[str, set[str]] = {}
    for name in elements:
        _collect(name, elements, tree, members, problems)
    states: dict[str, dict[str, dict[str, float]]] = {}
    for element in _elements(root, "group_state"):
        values = {joint.attributes.get("name", ""): joint.attributes.get("value", "") for joint in element.children}
        numbers = {name: _number(text) for name, text in values.items() if name in tree.joints}
        group = states.setdefault(element.attributes.get("group", ""), {})
        group[element.attributes.get("name", "")] = {n: v for n, v in numbers.items() if math.isfinite(v)}
    groups = {name: _group(name, found, tree, states.get(name, {})) for name, found in members.items()}
    virtual = [e for e in _elements(root, "virtual_joint") if e.attributes.get("child_link") == tree.root]
    frame = virtual[0].attributes.get("parent_frame", "") if virtual else ""
    pairs = [
        (e.attributes.get("link1", ""), e.attributes.get("link2", "")) for e in _elements(root, "disable_collisions")
    ]
    known = tuple(pair for pair in pairs if pair[0] in tree.links and pair[1] in tree.links)
    return RobotGroups(tree, groups, frame or tree.root, known, tuple(problems))


def _robot_element(text: str, what: str) -> Params:
    problems = Diagnostics()
    root = parse_text(text, problems)
    if root is None:
        reason = next((each.message for each in problems if each.severity == "error"), "it cannot be read")
        raise DescriptionError(f"the {what} is not valid XML: {reason}")
    if root.name != "robot":
        raise DescriptionError(f"the {what} has the root element <{root.name}>; expected <robot>")
    return root


def _number(text: str) -> float:
    """Return the number that a text contains; NaN if the text is not a number."""
    try:
        return float(text)
    except ValueError:
        return math.nan


def _elements(root: Params, name: str) -> Iterator[Params]:
    return (element for element in root.children if element.name == name)


def _joint(element: Params) -> TreeJoint:
    parts = {child.name: child.attributes for child in element.children}
    name, kind = element.attributes.get("name", ""), element.attributes.get("type", "")
    ends = [parts.get(end, {}).get("link", "") for end in ("parent", "child")]
    lower, upper = -math.inf, math.inf
    if kind in ("revolute", "prismatic"):
        lower, upper = (_number(parts.get("limit", {}).get(end, "0")) for end in ("lower", "upper"))
    return TreeJoint(name, kind, ends[0], ends[1], lower, upper, "mimic" in parts)


def _collect(
    name: str, elements: Mapping[str, Params], tree: JointTree, known: dict[str, set[str]], problems: list[str]
) -> set[str]:
    """Return the names of the joints of a group, with those of the groups in it, and store them in `known`."""
    if name in known:
        return known[name]
    known[name] = joints = set()
    above = {joint.child: joint.name for joint in tree.joints.values()}
    for part in elements[name].children:
        given = part.attributes.get("name", "")
        if part.name == "chain":
            base, tip = part.attributes.get("base_link", ""), part.attributes.get("tip_link", "")
            missing = next((link for link in (base, tip) if link not in tree.links), None)
            if missing is None:
                joints |= tree.chain(base, tip)
            else:
                problems.append(f"group {name!r}: the robot has no link {missing!r}")
        elif part.name == "joint" and given in tree.joints:
            joints.add(given)
        elif part.name == "link" and given in above:
            joints.add(above[given])
        elif part.name == "group" and given in elements:
            joints |= _collect(given, elements, tree, known, problems)
        elif part.name == "group" or (part.name == "link" and given not in tree.links):
            problems.append(f"group {name!r}: there is no {part.name} {given!r}")
    return joints


def _group(name: str, found: Iterable[str], tree: JointTree, states: Mapping[str, Mapping[str, float]]) -> JointGroup:
    members = frozenset(found)
    joints = [joint for joint in tree.joints.values() if joint.name in members]
    is_chain = bool(joints)
    for before, after in pairwise(joints):
        between = tree.path(after.parent)
        gap = between[between.index(before.name) + 1 :] if before.name in between else None
        is_chain &= gap is not None and all(tree.joints[joint].kind == "fixed" for joint in gap)
    names = tuple(joint.name for joint in joints)
    active = tuple(joint.name for joint in joints if joint.is_active)
    links = tuple(joint.child for joint in joints)
    return JointGroup(name, names, active, links, links[-1] if is_chain else "", states)
