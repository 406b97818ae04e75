"""A model in MuJoCo's own format that an SDF file includes: its names for the frames here, its content as it is."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.diagnostics import Diagnostics
from simkit.loaders.mjcf.loader import MjcfFile
from simkit.loaders.sdf.plugin import read_plugins
from simkit.params import Params
from simkit.pose import Pose
from simkit.scene import SceneModel

if TYPE_CHECKING:
    from simkit.loaders.sdf.workspace import ModelDraft

_VERSION = "1.7"
"""Of the SDF that stands for the file: names with `::` inside are one name there."""


def frames_document(file: MjcfFile, diagnostics: Diagnostics) -> Params:
    """An `<sdf>` with a model of the file's name, links and sites, which poses and joints of the including file use."""
    scene = file.model(file.name, file.name)
    where = file.bundle.root.where
    seen = {link.name for link in scene.links}
    children = [_named("link", link.name, link.pose_world, {}, diagnostics) for link in scene.links]
    for frame in scene.frames:
        if frame.name not in seen:
            seen.add(frame.name)
            link = frame.attached_to.removeprefix(f"{scene.scoped}::")
            attributes = {"attached_to": link}
            children.append(_named("frame", frame.name, frame.pose_world, attributes, diagnostics))
    model = Params("model", "", {"name": file.name}, children, where, diagnostics)
    root = Params("sdf", "", {"version": _VERSION}, [model], where, diagnostics)
    root.mark_all_read()
    return root


def _named(kind: str, name: str, pose: Pose, attributes: dict[str, str], diagnostics: Diagnostics) -> Params:
    x, y, z = (repr(float(v)) for v in pose.position)
    w, i, j, k = (repr(float(v)) for v in pose.quaternion)
    style = {"rotation_format": "quat_xyzw", "relative_to": "__model__"}
    placed = Params("pose", f"{x} {y} {z} {i} {j} {k} {w}", style, diagnostics=diagnostics)
    return Params(kind, "", {"name": name, **attributes}, [placed], diagnostics=diagnostics)


def build_included_model(file: MjcfFile, draft: ModelDraft, static: bool, base: str) -> SceneModel:
    """The scene of an included file where the including one puts it."""
    source = draft.source
    return file.model(
        source.name,
        draft.scoped,
        draft.scope.world,
        static=static,
        base=base,
        plugins=read_plugins(draft.plugins, draft.scoped),
        where=source.where,
    )
