"""Loader of MJCF: a world, one model, or a model that an SDF file includes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

from simkit.diagnostics import Diagnostics, Where
from simkit.loaders.mjcf.compiled_file import WORLD_LINK, CompiledFile, ModelPlacement
from simkit.loaders.mjcf.includes import gather_files
from simkit.loaders.mjcf.lights import read_lights
from simkit.loaders.mjcf.model import ModelReader
from simkit.loaders.mjcf.schema import check_names
from simkit.loaders.mjcf.size_limits import check_bounds
from simkit.loaders.resources.loader import LoadRequest, MjcfParser
from simkit.loaders.resources.uri_resolver import Resolver
from simkit.loaders.resources.xml_reader import Document
from simkit.loaders.sdf.load_context import IncludableLoader, IncludedModel, ModelDraft, Workspace
from simkit.loaders.sdf.plugin import read_plugins
from simkit.number_text import counted
from simkit.params import Params
from simkit.pose import IDENTITY, Pose
from simkit.scene import Physics, Scene, SceneModel, ScenePlugin, SceneWorld, Surroundings
from simkit.scene.geometry import vec3
from simkit.scene.mjcf_source import MjcfElements

_UNNAMED = ("", "MuJoCo Model")


@dataclass(frozen=True)
class MjcfFile:
    """MJCF file that MuJoCo accepted.

    Attributes:
        content: the compiled file.
        name: name of the model: its `model` attribute, else the name of the file.
    """

    content: CompiledFile
    name: str

    def model(
        self,
        name: str,
        scoped: str,
        pose_world: Pose = IDENTITY,
        *,
        static: bool = False,
        base: str = "auto",
        plugins: tuple[ScenePlugin, ...] = (),
        where: Where | None = None,
    ) -> SceneModel:
        """Return the whole file as one model; `pose_world` is the pose of the file's world."""
        content = self.content
        placed = ModelPlacement(
            name,
            scoped,
            content.roots,
            content.has_world or not content.roots,
            pose_world=pose_world,
            prefix=f"{scoped}::",
            static=static,
            base="fixed" if static else base,
            plugins=plugins,
            where=where,
        )
        return ModelReader(content, placed).read()


class MjcfLoader(IncludableLoader):
    """Loader of MuJoCo's own format."""

    roots: ClassVar[tuple[str, ...]] = ("mujoco",)

    def load(self, document: Document, request: LoadRequest) -> Scene:
        resolver = request.resolver.around(document.folder)
        is_part = request.as_model or request.name is not None or request.pose is not None
        parser = _parser(request.mjcf_parser)
        file = _open_mjcf(document, resolver, request.diagnostics, parser, is_part)
        name = None if document.path is None else str(document.path)
        if file is None:
            return Scene(file=name)
        if is_part or not _is_world(file.content):
            model_name = request.name or file.name
            model = file.model(model_name, model_name, request.pose or IDENTITY, base=request.base)
            _report_base(model, request)
            around = None if is_part else _surroundings_of(file, ())
            return Scene((), model, name, around=around)
        if request.base != "auto":
            message = f"base={request.base!r} is ignored: {file.name!r} is a world, not a bare model"
            document.root.note("SK-MJCF-012", message)
        return Scene((_surroundings_of(file, tuple(_world_models(file))),), None, name)

    def open_included(self, document: Document, workspace: Workspace) -> IncludedMjcf | None:
        parser = _parser(workspace.mjcf_parser)
        file = _open_mjcf(document, workspace.resolver, workspace.diagnostics, parser)
        return None if file is None else IncludedMjcf(_frames_document(file, workspace.diagnostics), file)


@dataclass
class IncludedMjcf(IncludedModel):
    """MJCF model that an SDF file includes. The SDF file can use the model's frames, but not change its content."""

    version: ClassVar[tuple[int, int]] = (1, 7)  # in SDF 1.7, a name that contains `::` is one name
    fixed_content: ClassVar[tuple[str, str, str]] = ("SK-MJCF-015", "a model in MuJoCo's own format", "")
    frames: Params
    file: MjcfFile

    def build(self, draft: ModelDraft, static: bool, workspace: Workspace, base: str) -> SceneModel:
        return self.file.model(
            draft.source.name,
            draft.scoped,
            draft.scope.world,
            static=static,
            base=base,
            plugins=read_plugins(draft.plugins, draft.scoped),
            where=draft.source.where,
        )


def _parser(mjcf_parser: Callable[[], MjcfParser] | None) -> MjcfParser:
    if mjcf_parser is None:
        raise TypeError("a file in MuJoCo's own format needs `mjcf_parser`")
    return mjcf_parser()


def _open_mjcf(
    document: Document, resolver: Resolver, diagnostics: Diagnostics, parser: MjcfParser, as_model: bool = True
) -> MjcfFile | None:
    """Read a file with all its included and asset files; return None, with errors recorded, if it is unusable.

    With `as_model`, the file becomes one model, even if it could also be a world.
    """
    problems = Diagnostics()
    root, path = document.root, document.path
    gathered = gather_files(root, path, resolver, problems)
    check_bounds(gathered.root)
    check_names(gathered.root, parser.schema_text())
    compiled = None if problems.has_errors else parser.compile(gathered, problems)
    diagnostics.extend(problems)
    if compiled is None:
        return None
    content = CompiledFile(gathered, compiled)
    if compiled.is_aligned and (as_model or not _is_world(content)):
        again = parser.compile(gathered, Diagnostics(), in_axes_of_file=True)
        content = content if again is None else CompiledFile(gathered, again)
    name = root.attribute("model")
    if name in _UNNAMED:
        name = path.stem if path is not None else "model"
    file = MjcfFile(content, name.replace("::", "_"))
    _report_engine_elements(file, diagnostics)
    return file


def _frames_document(file: MjcfFile, diagnostics: Diagnostics) -> Params:
    """Return an `<sdf>` with the file's links and sites as frames, for poses and joints of the including file."""
    scene = file.model(file.name, file.name)
    where = file.content.source.root.where
    seen = {link.name for link in scene.links}
    children = [_frame_element("link", link.name, link.pose_world, diagnostics) for link in scene.links]
    for frame in scene.frames:
        if frame.name not in seen:
            seen.add(frame.name)
            link = frame.attached_to.removeprefix(f"{scene.scoped}::")
            children.append(_frame_element("frame", frame.name, frame.pose_world, diagnostics, attached_to=link))
    model = Params("model", "", {"name": file.name}, children, where, diagnostics)
    root = Params("sdf", "", {"version": "1.7"}, [model], where, diagnostics)
    root.mark_all_read()
    return root


def _frame_element(kind: str, name: str, pose: Pose, diagnostics: Diagnostics, **attributes: str) -> Params:
    x, y, z, w, i, j, k = (repr(v) for v in pose.as_list())
    style = {"rotation_format": "quat_xyzw", "relative_to": "__model__"}
    placed = Params("pose", f"{x} {y} {z} {i} {j} {k} {w}", style, diagnostics=diagnostics)
    return Params(kind, "", {"name": name, **attributes}, [placed], diagnostics=diagnostics)


def _is_world(content: CompiledFile) -> bool:
    """Check whether a file is a world: its world body has geoms, or it has not exactly one top-level body."""
    return content.has_world or len(content.roots) != 1


def _surroundings_of(file: MjcfFile, models: tuple[SceneModel, ...]) -> SceneWorld:
    """Return the world that a file's options describe."""
    content, compiled = file.content, file.content.compiled
    option, spec = content.model.opt, content.spec
    r, g, b = (float(c) for c in spec.visual.headlight.ambient)
    root = content.source.root
    place = next((e.where for e in root.children if e.name == "option"), root.where)
    return SceneWorld(
        name=file.name,
        gravity=vec3(option.gravity) if compiled.has_gravity else (0.0, 0.0, 0.0),
        magnetic_field=vec3(option.magnetic),
        physics=Physics(float(option.timestep), 1.0, place, sleep=compiled.allows_sleep),
        models=models,
        lights=read_lights(content, 0, "", IDENTITY, MjcfElements()),
        surroundings=Surroundings(ambient=(r, g, b, 1.0)),
        where=root.where,
        mjcf=compiled.document,
    )


def _world_models(file: MjcfFile) -> list[SceneModel]:
    """Return the content of the world body as one static model, and each top-level body as a model.

    Bodies of one included file form one model with that file's name. Bodies with the same prefix before `::` in their
    names also form one model.
    """
    content, origins = file.content, file.content.source.origins
    groups: dict[tuple[str, str], list[int]] = {}
    for body in content.roots:
        body_name = content.name("BODY", body)
        first, colons, _ = body_name.partition("::")
        name = first if colons else origins.get(body_name, body_name).replace("::", "_")
        groups.setdefault((name, f"{first}::" if colons else ""), []).append(body)
    models: list[SceneModel] = []
    used_names: set[str] = set()
    if content.has_world:
        name = _free_name(WORLD_LINK, {n for n, _ in groups})
        used_names.add(name)
        models.append(ModelReader(content, ModelPlacement(name, name, (), True, static=True)).read())
    for (name, strip), bodies in groups.items():
        name = _free_name(name, used_names)
        used_names.add(name)
        frame = content.pose(bodies[0])
        placed = ModelPlacement(name, name, bodies, False, frame, frame, strip=strip)
        models.append(ModelReader(content, placed).read())
    return models


def _free_name(name: str, used_names: set[str]) -> str:
    free_name, k = name, 1
    while free_name in used_names:
        k += 1
        free_name = f"{name}_{k}"
    return free_name


def _report_base(model: SceneModel, request: LoadRequest) -> None:
    """Report the effect of `base`, which the caller has selected."""
    if request.base == "fixed" and any(j.type == "fixed" and j.parent_link == "world" for j in model.joints):
        message = f"model {model.name!r} is fixed to the world, because of base='fixed'"
        request.diagnostics.note("SK-MJCF-012", message, model.where)
    world_joints = [j.name for j in model.joints if j.parent_link == "world"]
    if request.base == "floating" and world_joints:
        message = f"model {model.name!r} cannot float: it is joined to the world by {', '.join(world_joints[:5])}"
        request.diagnostics.warning("SK-MJCF-012", message, model.where)


def _report_engine_elements(file: MjcfFile, diagnostics: Diagnostics) -> None:
    """Report the elements of the file that only MuJoCo itself uses."""
    model, where = file.content.model, file.content.source.root.where
    counts = (model.nsensor, model.ncam, model.ntendon, model.nflex, model.nskin, model.nkey)
    kinds = ("sensor", "camera", "tendon", "flex", "skin", "keyframe")
    plurals = {"flex": "flexes"}
    left = [counted(count, kind, plurals.get(kind, "")) for kind, count in zip(kinds, counts, strict=True) if count]
    if left:
        message = f"{file.name}: {', '.join(left)} publish nothing; read them from mj_model and mj_data"
        diagnostics.note("SK-MJCF-010", message, where)
