"""Kinematic tree of a model's joint graph, and the joints that close loops."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Final

from simkit.float_sum import float_sum
from simkit.scene import SceneJoint, SceneLink

WORLD: Final = "world"
_CONSTRAINTS: Final = {"gearbox"}


@dataclass(frozen=True, slots=True)
class TreeEdge:
    """Connection of a link to its parent in the tree by `joint`; `parent` is `world` also for a static link.

    `is_reversed` is True if the child link of the file is the parent in the tree.
    """

    parent: str
    joint: SceneJoint
    is_reversed: bool = False


@dataclass(slots=True)
class KinematicTree:
    """Links with parents first; a link without an edge is a root.

    Attributes:
        loops: joints that close a loop.
        constraints: joints that couple others (gearboxes).
        floating: joints that constrain nothing and only measure the relative pose of two links.
        roots: root link of the tree, by link.
        rigid: first link of the rigid group (links connected by fixed joints), by link.
        carriers: heaviest link of the rigid group, by link.
        masses: mass of the whole tree by its root [kg].
        carried: mass of a link and of all links below it [kg], by link.
        deepest: link at the end of the longest chain; `depth` is the number of links of the chain.
    """

    order: list[SceneLink] = field(default_factory=list)
    edges: dict[str, TreeEdge] = field(default_factory=dict)
    loops: list[SceneJoint] = field(default_factory=list)
    constraints: list[SceneJoint] = field(default_factory=list)
    floating: list[SceneJoint] = field(default_factory=list)
    children: dict[str, list[str]] = field(default_factory=dict)
    roots: dict[str, str] = field(default_factory=dict)
    rigid: dict[str, str] = field(default_factory=dict)
    carriers: dict[str, str] = field(default_factory=dict)
    masses: dict[str, float] = field(default_factory=dict)
    carried: dict[str, float] = field(default_factory=dict)
    deepest: str = ""
    depth: int = 0

    def root_of(self, link: str) -> str:
        """Return the root link of the tree of `link`."""
        return self.roots[link]


class _ConnectedLinks:
    """Groups of connected links (union-find with path halving)."""

    def __init__(self) -> None:
        self._above: dict[str, str] = {}

    def find(self, name: str) -> str:
        above = self._above
        while name in above:
            step = above[name]
            if step in above:
                above[name] = above[step]
            name = step
        return name

    def join(self, below: str, above: str) -> None:
        self._above[self.find(below)] = self.find(above)


def plan_tree(links: Iterable[SceneLink], joints: Iterable[SceneJoint], static: Iterable[str] = ()) -> KinematicTree:
    """Choose the tree joint of every link.

    A joint to the world has priority over others. If the child of a joint already has a tree joint, but the parent has
    none, the joint is reversed. Every type can be reversed exactly: its motions in opposite order and direction. All
    other joints close a loop.

    Args:
        links: moving links.
        joints: joints between them, the world and static links.
        static: scoped names of static links, which belong to the world.
    """
    by_name = {link.scoped: link for link in links}
    fixed = {WORLD, *static}
    tree, connected = KinematicTree(), _ConnectedLinks()
    ends = fixed | set(by_name)
    usable = [j for j in joints if j.parent_link in ends and j.child_link in ends]
    for joint in sorted(usable, key=lambda j: not ({j.parent_link, j.child_link} & fixed)):
        parent = WORLD if joint.parent_link in fixed else joint.parent_link
        child = WORLD if joint.child_link in fixed else joint.child_link
        if joint.type in _CONSTRAINTS:
            tree.constraints.append(joint)
        elif joint.type == "floating":
            tree.floating.append(joint)
        elif parent == child:
            continue
        elif connected.find(parent) == connected.find(child):
            tree.loops.append(joint)
        elif child != WORLD and child not in tree.edges:
            tree.edges[child] = TreeEdge(parent, joint)
            connected.join(child, parent)
        elif parent != WORLD and parent not in tree.edges:
            tree.edges[parent] = TreeEdge(child, joint, True)
            connected.join(parent, child)
        else:
            tree.loops.append(joint)
    _sort_joints(tree, by_name)
    _carried_masses(tree)
    return tree


def _sort_joints(tree: KinematicTree, links: dict[str, SceneLink]) -> None:
    roots = []
    for name in links:
        edge = tree.edges.get(name)
        if edge is None or edge.parent == WORLD:
            roots.append(name)
        else:
            tree.children.setdefault(edge.parent, []).append(name)
    stack = roots[::-1]
    level: dict[str, int] = {}
    while stack:
        name = stack.pop()
        edge = tree.edges.get(name)
        tree.roots[name] = name if edge is None or edge.parent == WORLD else tree.roots[edge.parent]
        level[name] = 1 if tree.roots[name] == name else level[tree.edges[name].parent] + 1
        if level[name] > tree.depth:
            tree.deepest, tree.depth = name, level[name]
        tree.order.append(links[name])
        stack += tree.children.get(name, [])[::-1]


def _carried_masses(tree: KinematicTree) -> None:
    """Compute the masses of trees and below each link, and the rigid groups."""
    group: dict[str, str] = {}
    heaviest: dict[str, SceneLink] = {}
    for link in tree.order:
        edge = tree.edges.get(link.scoped)
        is_rigid = edge is not None and edge.parent != WORLD and edge.joint.type == "fixed"
        group[link.scoped] = group[edge.parent] if edge is not None and is_rigid else link.scoped
        most = heaviest.setdefault(group[link.scoped], link)
        if link.inertial.mass > most.inertial.mass:
            heaviest[group[link.scoped]] = link
        root = tree.roots[link.scoped]
        tree.masses[root] = tree.masses.get(root, 0.0) + link.inertial.mass
    tree.rigid = group
    tree.carriers = {name: heaviest[leader].scoped for name, leader in group.items()}
    for link in reversed(tree.order):
        below = float_sum(tree.carried[child] for child in tree.children.get(link.scoped, ()))
        tree.carried[link.scoped] = link.inertial.mass + below


class JointIndex:
    """Joints of a world file by their links.

    A search in all joints of a world for each of its models would be quadratic: a minute for 4000 models.
    """

    def __init__(self, joints: Sequence[SceneJoint]) -> None:
        self._joints = tuple(joints)
        self._numbers: dict[str, list[int]] = {}
        for number, joint in enumerate(joints):
            for link in {joint.parent_link, joint.child_link} - {WORLD}:
                self._numbers.setdefault(link, []).append(number)

    def between(self, links: set[str]) -> list[SceneJoint]:
        """Return the joints that connect two of the links, or one of them and the world, in the order of the file."""
        numbers = sorted({number for link in links for number in self._numbers.get(link, ())})
        ends = links | {WORLD}
        candidates = (self._joints[number] for number in numbers)
        return [joint for joint in candidates if {joint.parent_link, joint.child_link} <= ends]
