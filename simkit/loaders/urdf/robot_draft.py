"""State of reading one robot: its names, frames and files."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

from simkit.diagnostics import Diagnostic, Diagnostics
from simkit.loaders.resources.uri_resolver import Resolver
from simkit.loaders.sdf.entity_names import scoped
from simkit.loaders.sdf.frames import Scope
from simkit.loaders.sdf.load_context import NamedElement, SdfFile, Workspace
from simkit.loaders.urdf.gazebo_extensions import GazeboExtensions
from simkit.number_text import counted
from simkit.params import Params
from simkit.pose import IDENTITY, Pose


@dataclass
class RobotFiles:
    """Finder of the files of one robot.

    Attributes:
        folder: folder of the robot's file.
    """

    resolver: Resolver
    folder: Path | None
    diagnostics: Diagnostics
    _found: dict[str, Path | None] = field(default_factory=dict)
    _packages: dict[str, list[Diagnostic]] = field(default_factory=dict)

    def mesh(self, uri: str, place: Params) -> Path | None:
        """Return a mesh file; a missing one is a warning."""
        if uri in self._found:
            return self._found[uri]
        path, problems = self.resolver.mesh(uri, place.where, self.folder)
        self._found[uri] = path = path if path is None else path.absolute()
        for problem in problems:
            if problem.code == "SK-URI-009":
                package = uri.partition("://")[2].split("/")[0]
                self._packages.setdefault(package, []).append(problem)
            else:
                self.diagnostics.extend([problem])
        return path

    def texture(self, uri: str, place: Params) -> Path | None:
        """Return an image file; a missing one is a warning."""
        key = f"texture {uri}"
        if key not in self._found:
            problems = Diagnostics()
            path = self.resolver.resolve(uri, place.where, problems, self.folder)
            self._found[key] = path if path is None else path.absolute()
            for problem in problems:
                message = f"texture: {problem.message}; the visual is drawn without the texture"
                self.diagnostics.warning("SK-URI-006", message, place.where, problem.hint)
        return self._found[key]

    def report_packages(self) -> None:
        """Report each missing package once, with the lines that refer to it."""
        for problems in self._packages.values():
            first = problems[0]
            if len(problems) > 1:
                lines = ", ".join(str(p.line) for p in problems[:12]) + (", ..." if len(problems) > 12 else "")
                more = f"; {counted(len(problems), 'file')} of it are needed (lines {lines})"
                first = replace(first, message=first.message + more)
            self.diagnostics.extend([first])


@dataclass(frozen=True, slots=True)
class JointDraft:
    """Joint between two existing links; `origin` is its pose in the parent link."""

    name: str
    element: Params
    type: str
    parent: str
    child: str
    origin: Pose


@dataclass
class RobotDraft:
    """State of a robot while its file is read.

    Attributes:
        scoped: name from the world down.
        pose: pose of the robot (its root link) in the world.
        scope: names that the SDF readers of the extensions look up: links, joints, frames.
        links, joints: `<link>` elements and joints by name without scope, in document order.
        faulty_joints: names of the joints whose errors were reported; references to them are not reported again.
        links_world: pose of each link in the world.
    """

    name: str
    scoped: str
    element: Params
    file: SdfFile
    workspace: Workspace
    assets: RobotFiles
    scope: Scope
    extensions: GazeboExtensions
    pose: Pose = IDENTITY
    root: str = ""
    links: dict[str, Params] = field(default_factory=dict)
    joints: dict[str, JointDraft] = field(default_factory=dict)
    faulty_joints: set[str] = field(default_factory=set)
    links_world: dict[str, Pose] = field(default_factory=dict)

    @property
    def diagnostics(self) -> Diagnostics:
        return self.workspace.diagnostics

    def own(self, *names: str) -> str:
        """Return a scoped name inside the robot."""
        return scoped(self.scoped, *names)

    def part(self, link: str, extension: Params, joint: str = "") -> NamedElement:
        """Return the `<gazebo>` block of a link, or of a joint with this child link, as input for the SDF readers."""
        frame = self.scope.names[link]
        frame = replace(frame, kind="joint") if joint else frame
        return NamedElement(joint or link, extension, frame, self.scope, self.file)
