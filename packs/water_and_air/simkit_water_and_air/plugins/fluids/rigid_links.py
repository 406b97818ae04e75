"""Links that fixed joints connect: Gazebo merges them when it reads a URDF file."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from simkit.extend import SceneModel


def rigid_group(scene: SceneModel, link: str) -> list[str]:
    """Return the links that fixed joints connect to a link, and the link itself."""
    group, fixed = [link], [joint for joint in scene.all_joints() if joint.type == "fixed"]
    known = {each.scoped for each in scene.all_links()}
    for name in group:
        for joint in fixed:
            pair = joint.parent_link, joint.child_link
            if name in pair:
                group += [other for other in pair if other in known and other not in group]
    return group
