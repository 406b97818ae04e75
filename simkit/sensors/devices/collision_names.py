"""Search for the collision that a contact sensor refers to by name.

In SDF the name belongs to a collision of the sensor's own link. Gazebo converts a URDF robot into SDF first: links
behind fixed joints are merged into their parent link, and every collision gets a new name. Many files use those names,
so this module recognises them too, although simkit keeps every link (sdformat, src/parser_urdf.cc).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

from simkit.scene import SceneCollision, SceneJoint, SceneLink, SceneModel

_LUMPED_INFIX: Final = "_fixed_joint_lump__"
_NUMBER_SUFFIX = re.compile(r"_\d+$")


def find_collision(name: str, link: SceneLink, model: SceneModel) -> SceneCollision | None:
    """Return the collision that a sensor on `link` refers to as `name`, or None.

    Args:
        name: name of a collision: its own, its scoped name, or its name after Gazebo's conversion.
        link: link of the sensor.
        model: top-level model of the link.
    """
    for collision in link.collisions:
        if collision.name == name or ("::" in name and f"::{collision.scoped}".endswith(f"::{name}")):
            return collision
    rigid = _RigidLinks(model)
    carriers = list(rigid.carriers(link))
    for carrier in carriers:
        converted = rigid.converted(carrier).get(name)
        if converted is not None:
            return converted
    # the number in a merged name depends on all merged collisions and may be outdated, so only base names are compared
    stem = _NUMBER_SUFFIX.sub("", name.rsplit(_LUMPED_INFIX, 1)[-1])
    near = [c for base, c in rigid.lumped(carriers[-1]) if stem == f"{base}_collision"]
    return near[0] if len(near) == 1 else None


class _RigidLinks:
    """Links of a model, connected by the fixed joints between them."""

    def __init__(self, model: SceneModel) -> None:
        self._links = {link.scoped: link for link in model.all_links()}
        self._above: dict[str, SceneJoint] = {}
        self._below: dict[str, list[SceneJoint]] = {}
        for joint in model.all_joints():
            if joint.type == "fixed" and joint.child_link in self._links:
                self._above.setdefault(joint.child_link, joint)
                self._below.setdefault(joint.parent_link, []).append(joint)

    def carriers(self, link: SceneLink) -> Iterator[SceneLink]:
        """Yield the link, and then each parent link that fixed joints connect to it, up to the root."""
        seen: set[str] = set()
        current: SceneLink | None = link
        while current is not None and current.scoped not in seen:
            seen.add(current.scoped)
            yield current
            above = self._above.get(current.scoped)
            current = self._links.get(above.parent_link) if above is not None and current.name != "world" else None
            if current is not None and current.name == "world":
                return

    def lumped(self, link: SceneLink, seen: frozenset[str] = frozenset()) -> Iterator[tuple[str, SceneCollision]]:
        """Yield the collisions of a link and of all links fixed to the link, in Gazebo's order, with their base names.

        Child links are in the order of their joints' names.
        """
        seen |= {link.scoped}
        for collision in link.collisions:
            is_unnamed = re.fullmatch(rf"{re.escape(link.name)}_collision(_\d+)?", collision.name)
            yield (link.name if is_unnamed else collision.name), collision
        for joint in sorted(self._below.get(link.scoped, ()), key=lambda j: j.name):
            if joint.child_link not in seen:
                yield from self.lumped(self._links[joint.child_link], seen)

    def converted(self, root: SceneLink) -> dict[str, SceneCollision]:
        """Return the collisions of all links that Gazebo merges into `root`, with Gazebo's names as keys."""
        collisions: dict[str, SceneCollision] = {}
        for number, (base, collision) in enumerate(self.lumped(root)):
            name = f"{base}_collision" + (f"_{number}" if number else "")
            collisions.setdefault(
                name if name.startswith(root.name) else f"{root.name}{_LUMPED_INFIX}{name}", collision
            )
        return collisions
