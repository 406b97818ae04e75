"""The outermost `<mujoco>`: a world, or one model."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from simkit.diagnostics import Diagnostics, Where
from simkit.loaders.mjcf.element_ids import ElementIds, ModelPlacement
from simkit.loaders.mjcf.engine import allows_sleep, has_gravity, is_aligned, open_and_compile
from simkit.loaders.mjcf.gathered_file import GatheredFile, gather_files
from simkit.loaders.mjcf.lights import read_lights
from simkit.loaders.mjcf.model import WORLD_LINK, ModelReader
from simkit.loaders.mjcf.schema import check_names
from simkit.loaders.mjcf.size_limits import check_bounds
from simkit.loaders.resources.loader import Loader, LoadRequest
from simkit.loaders.resources.resolver import Resolver
from simkit.loaders.resources.xml_reader import Document
from simkit.params import Params
from simkit.pose import IDENTITY, Pose
from simkit.scene import Physics, Scene, SceneModel, ScenePlugin, SceneWorld, Surroundings

_UNNAMED = ("", "MuJoCo Model")


@dataclass(frozen=True)
class MjcfFile:
    """A file that MuJoCo takes.

    Attributes:
        name: of the model: its `model` attribute, else the name of the file.
    """

    bundle: GatheredFile
    reader: ModelReader
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
        """The whole file as one model, its world at `pose_world`."""
        reader = self.reader
        return reader.read(
            ModelPlacement(
                name,
                scoped,
                reader.roots,
                reader.has_world or not reader.roots,
                pose_world=pose_world,
                prefix=f"{scoped}::",
                static=static,
                base="fixed" if static else base,
                plugins=plugins,
                where=where,
            )
        )


def open_mjcf(
    root: Params, path: Path | None, resolver: Resolver, diagnostics: Diagnostics, as_model: bool = True
) -> MjcfFile | None:
    """Reads a file with all that it includes and names; None, with errors recorded, where it cannot be used.

    Args:
        as_model: it is wanted as a model, even where it could be a world.
    """
    found = Diagnostics()
    bundle = gather_files(root, path, resolver, found)
    check_bounds(bundle.root, found)
    check_names(bundle.root, found)
    opened = None if found.has_errors else open_and_compile(bundle, found)
    diagnostics.extend(found)
    if opened is None:
        return None
    reader = ModelReader(bundle, *opened)
    if is_aligned(reader.spec) and (as_model or not is_world(reader)):
        again = open_and_compile(bundle, Diagnostics(), in_axes_of_file=True)
        reader = reader if again is None else ModelReader(bundle, *again)
    name = root.attribute("model")
    if name in _UNNAMED:
        name = path.stem if path is not None else "model"
    file = MjcfFile(bundle, reader, name.replace("::", "_"))
    _report_engine_elements(file, diagnostics)
    return file


class MjcfLoader(Loader):
    """MuJoCo's own format."""

    roots: ClassVar[tuple[str, ...]] = ("mujoco",)

    def load(self, document: Document, request: LoadRequest) -> Scene:
        resolver = request.resolver.around(document.folder)
        is_part = request.as_model or request.name is not None or request.pose is not None
        file = open_mjcf(document.root, document.path, resolver, request.diagnostics, is_part)
        name = None if document.path is None else str(document.path)
        if file is None:
            return Scene(file=name)
        if is_part or not is_world(file.reader):
            model_name = request.name or file.name
            model = file.model(model_name, model_name, request.pose or IDENTITY, base=request.base)
            _report_base(model, request)
            around = None if is_part else _surroundings_of(file, ())
            return Scene((), model, name, around=around)
        if request.base != "auto":
            request.diagnostics.note(
                "SK-MJCF-012",
                f"base={request.base!r} is for a bare model; {file.name!r} is a world",
                document.root.where,
            )
        return Scene((_surroundings_of(file, tuple(_world_models(file))),), None, name)


def is_world(reader: ModelReader) -> bool:
    """Whether a file is a world: it has something solid of its own beside a body, or not exactly one body."""
    return reader.has_world or len(reader.roots) != 1


def _surroundings_of(file: MjcfFile, models: tuple[SceneModel, ...]) -> SceneWorld:
    """The world that a file's options make."""
    option, spec = file.reader.model.opt, file.reader.spec
    gx, gy, gz = (float(v) for v in option.gravity)
    if not has_gravity(file.reader.model):
        gx = gy = gz = 0.0
    mx, my, mz = (float(v) for v in option.magnetic)
    r, g, b = (float(c) for c in spec.visual.headlight.ambient)
    root = file.bundle.root
    place = next((e.where for e in root.children if e.name == "option"), root.where)
    return SceneWorld(
        name=file.name,
        gravity=(gx, gy, gz),
        magnetic_field=(mx, my, mz),
        physics=Physics(float(option.timestep), 1.0, place, sleep=allows_sleep(file.reader.model)),
        models=models,
        lights=read_lights(file.reader, 0, "", IDENTITY, ElementIds()),
        surroundings=Surroundings(ambient=(r, g, b, 1.0)),
        where=root.where,
        mjcf=file.reader.document,
    )


def _world_models(file: MjcfFile) -> list[SceneModel]:
    """What stands in the world body as one static model, and each top-level body as a model.

    Bodies of one included file are one model with that file's name; so are bodies whose names begin alike up to `::`.
    """
    reader, origins = file.reader, file.bundle.origins
    groups: dict[tuple[str, str], list[int]] = {}
    for body in reader.roots:
        own = reader.name("BODY", body)
        first, colons, _ = own.partition("::")
        name = first if colons else origins.get(own, own).replace("::", "_")
        groups.setdefault((name, f"{first}::" if colons else ""), []).append(body)
    models: list[SceneModel] = []
    taken: set[str] = set()
    if reader.has_world:
        name = _free_name(WORLD_LINK, {n for n, _ in groups})
        taken.add(name)
        models.append(reader.read(ModelPlacement(name, name, (), True, static=True)))
    for (name, strip), bodies in groups.items():
        name = _free_name(name, taken)
        taken.add(name)
        frame = reader.pose(bodies[0])
        models.append(reader.read(ModelPlacement(name, name, bodies, False, frame, frame, strip=strip)))
    return models


def _free_name(name: str, taken: set[str]) -> str:
    found, k = name, 1
    while found in taken:
        k += 1
        found = f"{name}_{k}"
    return found


def _report_base(model: SceneModel, request: LoadRequest) -> None:
    """Says what a base that the caller chose changes."""
    if request.base == "fixed" and any(j.type == "fixed" and j.parent_link == "world" for j in model.joints):
        request.diagnostics.note(
            "SK-MJCF-012", f"model {model.name!r} stands fixed in the world, as asked for (base='fixed')", model.where
        )
    held = [j.name for j in model.joints if j.parent_link == "world"]
    if request.base == "floating" and held:
        request.diagnostics.warning(
            "SK-MJCF-012",
            f"model {model.name!r} cannot float: it hangs on the world by {', '.join(held[:5])}",
            model.where,
        )


def _report_engine_elements(file: MjcfFile, diagnostics: Diagnostics) -> None:
    """Says which of the file's elements are the engine's alone."""
    model, where = file.reader.model, file.bundle.root.where
    counts = {
        "sensors": model.nsensor,
        "cameras": model.ncam,
        "tendons": model.ntendon,
        "flexes": model.nflex,
        "skins": model.nskin,
        "keyframes": model.nkey,
    }
    left = [f"{count} {what}" for what, count in counts.items() if count]
    if left:
        diagnostics.note(
            "SK-MJCF-010",
            f"{file.name}: {', '.join(left)} of the file work in MuJoCo alone; they are in mj_model and mj_data, "
            "and publish nothing",
            where,
        )
