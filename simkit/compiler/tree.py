"""The joint graph of a model as a tree, and the joints that close loops."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Final

from simkit.scene import SceneJoint, SceneLink

WORLD: Final = "world"
_REVERSIBLE: Final = {"fixed", "revolute", "continuous", "prismatic"}
_CONSTRAINTS: Final = {"gearbox"}


@dataclass(frozen=True, slots=True)
class Edge:
    """How a link hangs in the tree: by `joint` under `parent` (`world` for the world or a static link).

    `is_reversed`: the file's child is the tree's parent.
    """

    parent: str
    joint: SceneJoint
    is_reversed: bool = False


@dataclass(slots=True)
class Tree:
    """Links in an order where parents come first; a link without an edge is a root."""

    order: list[SceneLink] = field(default_factory=list)
    edges: dict[str, Edge] = field(default_factory=dict)
    loops: list[SceneJoint] = field(default_factory=list)
    constraints: list[SceneJoint] = field(default_factory=list)
    children: dict[str, list[str]] = field(default_factory=dict)

    def root_of(self, link: str) -> str:
        """The link at the foot of the tree that carries `link`."""
        while link in self.edges and self.edges[link].parent != WORLD:
            link = self.edges[link].parent
        return link


def plan_tree(links: Iterable[SceneLink], joints: Iterable[SceneJoint], static: Iterable[str] = ()) -> Tree:
    """Chooses for every link the joint it hangs on.

    A joint to the world wins over others. A joint whose child already hangs elsewhere is turned round where that is
    exact (one degree of freedom, and its parent still free); what is left closes a loop.

    Args:
        links: the moving links.
        joints: joints between them, the world and static links.
        static: scoped names of links that belong to the world.
    """
    by_name = {link.scoped: link for link in links}
    fixed = {WORLD, *static}
    tree = Tree()
    usable = [j for j in joints if _is_end(j.parent_link, by_name, fixed) and _is_end(j.child_link, by_name, fixed)]
    for joint in sorted(usable, key=lambda j: not ({j.parent_link, j.child_link} & fixed)):
        parent = WORLD if joint.parent_link in fixed else joint.parent_link
        child = WORLD if joint.child_link in fixed else joint.child_link
        if joint.type in _CONSTRAINTS:
            tree.constraints.append(joint)
        elif child != WORLD and child not in tree.edges and not _is_above(tree, child, parent):
            tree.edges[child] = Edge(parent, joint)
        elif _can_turn(tree, joint, parent, child):
            tree.edges[parent] = Edge(child, joint, True)
        elif parent != child:
            tree.loops.append(joint)
    _sort(tree, by_name)
    return tree


def _is_end(name: str, links: Mapping[str, SceneLink], fixed: set[str]) -> bool:
    return name in links or name in fixed


def _can_turn(tree: Tree, joint: SceneJoint, parent: str, child: str) -> bool:
    free = parent != WORLD and parent not in tree.edges
    return free and joint.type in _REVERSIBLE and not _is_above(tree, parent, child)


def _is_above(tree: Tree, link: str, other: str) -> bool:
    """Whether `other` hangs below `link` or is it, so that hanging `link` under `other` would close a ring."""
    while True:
        if other == link:
            return True
        edge = tree.edges.get(other)
        if edge is None:
            return False
        other = edge.parent


def _sort(tree: Tree, links: Mapping[str, SceneLink]) -> None:
    roots = []
    for name in links:
        edge = tree.edges.get(name)
        if edge is None or edge.parent == WORLD:
            roots.append(name)
        else:
            tree.children.setdefault(edge.parent, []).append(name)
    stack = roots[::-1]
    while stack:
        name = stack.pop()
        tree.order.append(links[name])
        stack += tree.children.get(name, [])[::-1]
