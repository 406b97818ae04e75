"""Loader of URDF, for a separate file and for a robot that an SDF file includes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import ClassVar

from simkit.loaders.resources.loader import LoadRequest
from simkit.loaders.resources.xml_reader import Document
from simkit.loaders.sdf.load_context import IncludableLoader, IncludedModel, ModelDraft, SdfFile, Workspace
from simkit.loaders.sdf.plugin import read_plugins
from simkit.loaders.urdf.gazebo_extensions import read_flag
from simkit.loaders.urdf.kinematic_tree import place_links
from simkit.loaders.urdf.robot import WORLD, build_robot, declare_robot
from simkit.loaders.xacro import needs_expansion
from simkit.params import Params
from simkit.pose import Pose
from simkit.scene import Scene, SceneModel

_SDF_VERSION = (1, 11)  # SDF version of the elements in <gazebo>


class UrdfLoader(IncludableLoader):
    """Loader of the Unified Robot Description Format, with Gazebo's extensions."""

    roots: ClassVar[tuple[str, ...]] = ("robot",)

    def load(self, document: Document, request: LoadRequest) -> Scene:
        resolver = request.resolver.around(document.folder)
        workspace = Workspace.of(request, resolver)
        folder = document.folder or resolver.base
        chain = (str(document.path or ""),)
        file = SdfFile(document.root, _SDF_VERSION, folder, chain, arguments=document.arguments)
        draft = declare_robot(file, workspace, resolver)
        if request.name is not None:
            draft.name = request.name
        model = build_robot(draft, "", request.pose, request.base)
        return Scene((), model, None if document.path is None else str(document.path))

    def open_included(self, document: Document, workspace: Workspace) -> IncludedRobot | None:
        expanded: Document | None = document
        if needs_expansion(document):
            from simkit.loaders.xacro.expansion import expand  # 5 ms, and most robots are not xacro

            expanded = expand(document, workspace.resolver, {}, workspace.diagnostics)
        if expanded is None:
            return None
        path = document.path or Path()
        file = SdfFile(expanded.root, _SDF_VERSION, path.parent, (str(path.resolve()),))
        return IncludedRobot(_frames_document(file, workspace), expanded)


@dataclass
class IncludedRobot(IncludedModel):
    """Robot that an SDF file includes: first its links and joints as frames, later the model at its resolved pose."""

    version: ClassVar[tuple[int, int]] = _SDF_VERSION
    fixed_content: ClassVar[tuple[str, str, str]] = (
        "SK-URDF-029",
        "a robot in URDF",
        "include it without merge and changes, or convert it first: simkit convert ROBOT.urdf -o model.sdf",
    )
    frames: Params
    robot: Document

    def build(self, draft: ModelDraft, static: bool, workspace: Workspace, base: str) -> SceneModel:
        arguments = self.robot.arguments
        file = replace(draft.source.file, root=self.robot.root, included=None, arguments=arguments)
        robot = declare_robot(file, workspace, workspace.resolver)
        robot.name = draft.source.name
        outer = draft.scoped.rpartition("::")[0]
        model = build_robot(robot, outer, draft.scope.world, base, static, is_included=True)
        plugins = read_plugins(draft.plugins, draft.scoped)
        return replace(model, plugins=(*model.plugins, *plugins), where=draft.source.where)


def _frames_document(robot: SdfFile, workspace: Workspace) -> Params:
    """Return an SDF document with the robot's links and joints as frames, for poses and joints of the world.

    Problems are not reported here, because simkit reads the robot again later and reports them then.
    """
    draft = declare_robot(robot, workspace.quiet(), workspace.resolver)
    place_links(draft)

    def make(tag: str, text: str = "", children: tuple[Params, ...] = (), **attributes: str) -> Params:
        return Params(tag, text, attributes, children, robot.root.where, workspace.diagnostics)

    def pose(value: Pose, base: str = "") -> Params:
        x, y, z, w, a, b, c = (repr(v) for v in value.as_list())
        named = {"relative_to": base} if base else {}
        return make("pose", f"{x} {y} {z} {a} {b} {c} {w}", (), rotation_format="quat_xyzw", **named)

    static = "true" if read_flag(draft.extensions.robot, "static") else "false"
    parts = [make("static", static), pose(draft.extensions.robot.pose("pose"))]
    # a link named `world` stands for the world, which the SDF file has already
    links = {name: at for name, at in draft.links_world.items() if name != WORLD}
    parts += [make("link", "", (pose(at),), name=name) for name, at in links.items()]
    for name, joint in draft.joints.items():
        ends = (make("parent", joint.parent), make("child", joint.child))
        if name not in draft.links:
            parts.append(make("joint", "", ends, name=name, type="fixed"))
    document = make("sdf", "", (make("model", "", tuple(parts), name=draft.name),), version="1.11")
    document.mark_all_read()
    return document
