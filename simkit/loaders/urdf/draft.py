"""What every part of one robot's reading shares."""

from __future__ import annotations

from dataclasses import dataclass, field

from simkit.diagnostics import Diagnostics
from simkit.loaders.sdf.frames import Frame, Scope
from simkit.loaders.sdf.names import scoped
from simkit.loaders.sdf.workspace import SdfFile, Workspace
from simkit.loaders.urdf.assets import Assets
from simkit.loaders.urdf.extensions import Extensions
from simkit.params import Params
from simkit.pose import IDENTITY, Pose


@dataclass(frozen=True, slots=True)
class JointDraft:
    """A joint whose ends are known: plain link names, and its origin in the parent link's frame."""

    name: str
    element: Params
    type: str
    parent: str
    child: str
    origin: Pose


@dataclass
class Draft:
    """A robot while it is read.

    Attributes:
        scoped: name from the world down.
        pose: of the robot (its root link) in the world.
        scope: names that the SDF readers of the extensions look up: links, joints, frames.
        links, joints: by plain name, in document order.
        links_world: pose of each link in the world.
    """

    name: str
    scoped: str
    element: Params
    file: SdfFile
    workspace: Workspace
    assets: Assets
    scope: Scope
    extensions: Extensions
    pose: Pose = IDENTITY
    root: str = ""
    links: dict[str, Params] = field(default_factory=dict)
    joints: dict[str, JointDraft] = field(default_factory=dict)
    links_world: dict[str, Pose] = field(default_factory=dict)

    @property
    def diagnostics(self) -> Diagnostics:
        return self.workspace.diagnostics

    def own(self, *names: str) -> str:
        """A scoped name inside the robot."""
        return scoped(self.scoped, *names)

    def frame(self, name: str) -> Frame:
        """The frame of a link or joint, for the SDF readers."""
        return self.scope.names[name]
