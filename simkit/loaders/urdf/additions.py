"""Links, joints and frames that `<gazebo>` adds to the robot in SDF's words: above all, joints that close loops."""

from __future__ import annotations

from simkit.loaders.sdf.frames import Frame
from simkit.loaders.sdf.joint import end_name
from simkit.loaders.sdf.joint import read_joint as read_sdf_joint
from simkit.loaders.sdf.link import read_link as read_sdf_link
from simkit.loaders.sdf.model import read_frames
from simkit.loaders.sdf.names import named
from simkit.loaders.sdf.parts import Part, read_pose
from simkit.loaders.urdf.draft import Draft
from simkit.params import Params
from simkit.scene import SceneFrame, SceneJoint, SceneLink


class Additions:
    """What the blocks without a reference add; its names are entered in the robot's scope at once."""

    def __init__(self, draft: Draft, block: Params, windy: bool) -> None:
        self._draft, self._block, self._windy = draft, block, windy
        self._links = self._parts("link")
        self._joints = self._parts("joint")
        self._frames = self._parts("frame")

    def links(self) -> tuple[SceneLink, ...]:
        return tuple(
            read_sdf_link(p, self._draft.scoped, False, self._windy, self._draft.workspace) for p in self._links
        )

    def joints(self) -> tuple[SceneJoint, ...]:
        found = (read_sdf_joint(p, self._draft.scoped, self._draft.workspace) for p in self._joints)
        return tuple(j for j in found if j is not None)

    def frames(self) -> tuple[SceneFrame, ...]:
        return read_frames(self._frames)

    def _parts(self, kind: str) -> list[Part]:
        draft, parts = self._draft, []
        owner = f"robot {draft.name!r}"
        for name, element in named(self._block.all(kind), owner, draft.diagnostics, draft.file.version):
            taken = draft.scope.names.get(name)
            if taken is not None:
                message = f"<gazebo>: {kind} {name!r} has the name of a {taken.kind} (line {taken.where.line})"
                draft.diagnostics.error("SK-URDF-002", message, element.where)
                continue
            pose, base = read_pose(element)
            attached = end_name(element, "child") if kind == "joint" else element.attribute("attached_to")
            frame = Frame(name, kind, draft.own(name), draft.scope, pose, base, attached, where=element.where)
            draft.scope.names[name] = frame
            parts.append(Part(name, element, frame, draft.scope, draft.file))
        return parts
