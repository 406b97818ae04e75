"""A robot that an SDF file includes: its names for the SDF readers, then its model where they placed it."""

from __future__ import annotations

from dataclasses import replace

from simkit.diagnostics import Diagnostics
from simkit.loaders.sdf.plugin import read_plugins
from simkit.loaders.sdf.workspace import ModelDraft, SdfFile, Workspace
from simkit.loaders.urdf.gazebo_extensions import read_flag
from simkit.loaders.urdf.kinematic_tree import place_links
from simkit.loaders.urdf.robot import build_robot, declare_robot
from simkit.params import Params
from simkit.pose import Pose
from simkit.scene import SceneModel


def frames_document(robot: SdfFile, workspace: Workspace) -> Params:
    """An SDF document with the robot's links and joints as frames, so that poses and joints of the world can name them.

    Says nothing about mistakes: reading the robot in earnest says them.
    """
    quiet = Workspace(workspace.resolver, Diagnostics())
    draft = declare_robot(robot, quiet, workspace.resolver)
    place_links(draft)

    def make(tag: str, text: str = "", children: tuple[Params, ...] = (), **attributes: str) -> Params:
        return Params(tag, text, attributes, children, robot.root.where, workspace.diagnostics)

    def pose(value: Pose, base: str = "") -> Params:
        x, y, z, w, a, b, c = (repr(v) for v in value.as_list())
        named = {"relative_to": base} if base else {}
        return make("pose", f"{x} {y} {z} {a} {b} {c} {w}", (), rotation_format="quat_xyzw", **named)

    static = "true" if read_flag(draft.extensions.robot, "static") else "false"
    parts = [make("static", static), pose(draft.extensions.robot.pose("pose"))]
    parts += [make("link", "", (pose(at),), name=name) for name, at in draft.links_world.items()]
    for name, joint in draft.joints.items():
        ends = (make("parent", joint.parent), make("child", joint.child))
        if name not in draft.links:
            parts.append(make("joint", "", ends, name=name, type="fixed"))
    document = make("sdf", "", (make("model", "", tuple(parts), name=draft.name),), version="1.11")
    document.mark_all_read()
    return document


def build_included_robot(draft: ModelDraft, robot: Params, static: bool, workspace: Workspace, base: str) -> SceneModel:
    """The robot as the SDF file has named and placed it.

    Args:
        robot: its `<robot>` element.
        static: whether it, or what it lies in, is static.
    """
    file = replace(draft.source.file, root=robot, urdf=None)
    own = declare_robot(file, workspace, workspace.resolver)
    own.name = draft.source.name
    outer = draft.scoped.rpartition("::")[0]
    model = build_robot(own, outer, draft.scope.world, base, static, is_included=True)
    plugins = read_plugins(draft.plugins, draft.scoped)
    return replace(model, plugins=(*model.plugins, *plugins), where=draft.source.where)
