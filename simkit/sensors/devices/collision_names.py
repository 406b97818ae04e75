"""Find the collision that a contact sensor names.

In SDF that is a collision of the sensor's own link. A robot in URDF is turned into SDF by Gazebo first: links behind
fixed joints become part of the link that carries them, and every collision gets a new name. Files are written with
those names, so they are understood here too, although every link stays a link (sdformat, src/parser_urdf.cc).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

from simkit.scene import SceneCollision, SceneJoint, SceneLink, SceneModel

_LUMPED_INFIX: Final = "_fixed_joint_lump__"
_NUMBER_SUFFIX = re.compile(r"_\d+$")


def find_collision(name: str, link: SceneLink, model: SceneModel) -> SceneCollision | None:
    """The collision that a sensor on `link` means by `name`, or None.

    Args:
        model: the top-level model of the link.
    """
    for collision in link.collisions:
        if collision.name == name or ("::" in name and f"::{collision.scoped}".endswith(f"::{name}")):
            return collision
    rigid = _RigidLinks(model)
    carriers = list(rigid.carriers(link))
    for carrier in carriers:
        found = rigid.converted(carrier).get(name)
        if found is not None:
            return found
    # the numbers count what Gazebo found on the lumped link, which a file may have wrong or from an older version
    stem = _NUMBER_SUFFIX.sub("", name.rsplit(_LUMPED_INFIX, 1)[-1])
    near = [c for base, c in rigid.lumped(carriers[-1]) if stem == f"{base}_collision"]
    return near[0] if len(near) == 1 else None


class _RigidLinks:
    """The links of a model by the fixed joints between them."""

    def __init__(self, model: SceneModel) -> None:
        self._links = {link.scoped: link for link in model.all_links()}
        self._above: dict[str, SceneJoint] = {}
        self._below: dict[str, list[SceneJoint]] = {}
        for joint in model.all_joints():
            if joint.type == "fixed" and joint.child_link in self._links:
                self._above.setdefault(joint.child_link, joint)
                self._below.setdefault(joint.parent_link, []).append(joint)

    def carriers(self, link: SceneLink) -> Iterator[SceneLink]:
        """The link, the one that carries it over a fixed joint, and so on."""
        seen: set[str] = set()
        at: SceneLink | None = link
        while at is not None and at.scoped not in seen:
            seen.add(at.scoped)
            yield at
            above = self._above.get(at.scoped)
            at = self._links.get(above.parent_link) if above is not None and at.name != "world" else None
            if at is not None and at.name == "world":
                return

    def lumped(self, link: SceneLink, seen: frozenset[str] = frozenset()) -> Iterator[tuple[str, SceneCollision]]:
        """Its collisions and those of all that it carries rigidly, in Gazebo's order, each with the base of its name.

        The children come in the order of their joints' names.
        """
        seen |= {link.scoped}
        for collision in link.collisions:
            is_unnamed = re.fullmatch(rf"{re.escape(link.name)}_collision(_\d+)?", collision.name)
            yield (link.name if is_unnamed else collision.name), collision
        for joint in sorted(self._below.get(link.scoped, ()), key=lambda j: j.name):
            if joint.child_link not in seen:
                yield from self.lumped(self._links[joint.child_link], seen)

    def converted(self, root: SceneLink) -> dict[str, SceneCollision]:
        """The collisions by the names that they have in Gazebo if `root` is what carries them all."""
        found: dict[str, SceneCollision] = {}
        for number, (base, collision) in enumerate(self.lumped(root)):
            name = f"{base}_collision" + (f"_{number}" if number else "")
            found.setdefault(name if name.startswith(root.name) else f"{root.name}{_LUMPED_INFIX}{name}", collision)
        return found
