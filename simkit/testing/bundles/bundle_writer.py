"""Puts a run into one file: the world with all that it names, plugins' code, what came in, the last seconds."""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
import tempfile
import traceback
import zipfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from simkit.diagnostics import Diagnostics
from simkit.errors import InputError, SimkitError
from simkit.testing.bundles.archive import MAX_BYTES, name_fault
from simkit.testing.bundles.manifest import BAG, COMMANDS, PAGE, Failure, Manifest, RunEnd, SpawnedModel
from simkit.testing.bundles.message_window import topic_digests, write_bag
from simkit.testing.bundles.packed_world import model_hash
from simkit.testing.run_record.fingerprint import fingerprint
from simkit.writers.atomic_output import check_file, remove_abandoned, unfinished_folder

if TYPE_CHECKING:
    from simkit.testing.bundles.bundle_recorder import BundleRecorder

UNPACKED: Final = "SK-BUNDLE-006"
_UNFINISHED: Final = "simkit-bundle"
_EPOCH: Final = (1980, 1, 1, 0, 0, 0)
_PLAIN: Final = 0o100644 << 16
_UNIX: Final = 3

StagedFiles = Callable[[Path], Manifest]
"""Puts everything into a folder, and says what is in it."""


@dataclass
class _StagedWorld:
    """What was put into the stage."""

    file: str = ""
    spawn: list[SpawnedModel] = field(default_factory=list)
    params: list[tuple[str, str]] = field(default_factory=list)
    models: dict[str, str] = field(default_factory=dict)
    code: list[str] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)


def pack_run(
    keeper: BundleRecorder,
    path: Path,
    failure: Failure | None,
    *,
    name: str = "",
    overwrite: bool,
    with_code: bool = True,
) -> Path:
    """Writes a bundle; see `simkit.testing.bundles.write_bundle`."""
    check_file(path, overwrite=overwrite)
    with _write_hidden_file(
        path.absolute().parent, lambda stage: _stage_files(keeper, stage, failure, name, with_code)
    ) as (file, _):
        os.replace(file, path)  # noqa: PTH105 - atomic on every platform
    return path


def pack_failed_run(keeper: BundleRecorder, folder: Path, failure: Failure, *, with_code: bool = True) -> Path:
    """Writes a bundle of a run that failed; an equal one is equal in name too."""
    return _write_under_own_name(folder, lambda stage: _stage_files(keeper, stage, failure, "", with_code))


def _write_under_own_name(folder: Path, staged: StagedFiles) -> Path:
    """Writes a bundle under a name of its own."""
    with _write_hidden_file(folder.absolute(), staged) as (file, manifest):
        failure = manifest.end.failure or Failure("run", "", "")
        digest = hashlib.sha256(manifest.text().encode()).hexdigest()[:8]
        stem = "".join(c if c.isalnum() or c in "-_." else "_" for c in manifest.name)[:60] or "run"
        path = folder / f"{stem}-{failure.code or failure.kind}-{digest}.zip"
        os.replace(file, path)  # noqa: PTH105 - atomic on every platform
    return path


@contextmanager
def _write_hidden_file(folder: Path, staged: StagedFiles) -> Iterator[tuple[Path, Manifest]]:
    """A whole bundle under a hidden name in a folder, which the caller moves to its place."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        remove_abandoned(folder, _UNFINISHED)
        work = unfinished_folder(folder, _UNFINISHED)
    except OSError as error:
        raise InputError(f"SK-CLI-016 cannot write to {folder}: {error.strerror or error}", "SK-CLI-016") from None
    try:
        stage = work / "stage"
        stage.mkdir()
        manifest = staged(stage)
        file = work / "bundle.zip"
        _write_zip(stage, manifest, file)
        yield file, manifest
    except OSError as error:
        said = f"SK-CLI-016 cannot write to {folder}: {error.strerror or error}"
        raise InputError(said, "SK-CLI-016") from None
    finally:
        shutil.rmtree(work, ignore_errors=True)


def _stage_files(keeper: BundleRecorder, stage: Path, failure: Failure | None, name: str, with_code: bool) -> Manifest:
    sim, origin, journal = keeper.sim, keeper.sim.origin, keeper.journal
    assert origin is not None
    end = keeper.end(failure)
    first = keeper.window.first
    messages = list(_encodable_messages(keeper.window.messages(first), journal.gaps))
    journal.write_to(stage / COMMANDS)
    write_bag(stage / BAG, iter(messages), sim.bus.latched())
    world = _Stager(origin, stage).world(keeper)
    if with_code:
        _plugin_modules(world, stage, origin["plugin_paths"])
    if failure is not None:
        _write_error(stage, failure)
    given = sim.world.name if sim.world.name not in ("", "default") else Path(world.file).stem
    return Manifest(
        name=name or given or "run", world=world.file, **_load_options(origin),
        spawn=tuple(world.spawn), params=tuple(world.params), models=world.models, code=tuple(sorted(world.code)),
        missing=(*world.missing, *journal.gaps), fingerprint=fingerprint(), seconds=keeper.seconds,
        topics=keeper.topics, first=first, end=end, streams=topic_digests(iter(messages)), marks=tuple(keeper.marks.found),
        commands=journal.count, files=_file_table(stage),
    )  # fmt: skip


def pack_load_failure(given: Mapping[str, Any], folder: Path, failure: Failure) -> Path:
    """Writes a bundle of a world that failed while it was loaded.

    Args:
        given: `simkit.load`'s arguments.
        folder: where it goes.
        failure: what it failed with.
    """
    said: dict[str, Any] = {"base": "auto", "overrides": (), "sleep": True, "on_error": None, "spawn": (), "seed": 0}
    said |= {"plugins": (), "plugin_paths": (), "package_paths": {}, "xacro_args": {}, "resource_paths": ()}
    said |= {"is_changed": False, "folder": Path.cwd(), **given}

    def staged(stage: Path) -> Manifest:
        (stage / COMMANDS).touch()
        write_bag(stage / BAG, iter(()), frozenset())
        world = _Stager(said, stage).unloaded(said.get("params_files", ()))
        _plugin_modules(world, stage, said["plugin_paths"])
        _write_error(stage, failure)
        return Manifest(
            name=Path(world.file).stem, world=world.file, **_load_options(said),
            spawn=tuple(world.spawn), params=tuple(world.params), models={}, code=tuple(sorted(world.code)),
            missing=tuple(world.missing), fingerprint=fingerprint(), seconds=0.0, topics=(), first=0,
            end=RunEnd(0, 0, 0, "", failure), streams={}, marks=(), commands=0, files=_file_table(stage),
        )  # fmt: skip

    return _write_under_own_name(folder, staged)


def _load_options(origin: Mapping[str, Any]) -> dict[str, Any]:
    names = ("base", "seed", "sleep", "on_error")
    return {**{name: origin[name] for name in names}, "overrides": tuple(origin["overrides"])}


def _write_error(stage: Path, failure: Failure) -> None:
    """The error with its traceback, where it is being handled."""
    from simkit.testing.bundles.bundle_recorder import strip_folders

    error = sys.exception()
    told = "".join(traceback.format_exception(error)) if error is not None else failure.text + "\n"
    (stage / "error.txt").write_text(strip_folders(told), encoding="utf-8", errors="replace")


def _encodable_messages(messages: Iterator[Any], gaps: list[str]) -> Iterator[Any]:
    """Messages as long as they can be made: what is wrong with the last ones is no reason to have no bundle."""
    try:
        yield from messages
    except Exception as error:  # noqa: BLE001 - a run that failed may have left anything
        gaps.append(f"not all of the last seconds' messages could be made: {error!r:.200}")


def _file_table(stage: Path) -> dict[str, dict[str, Any]]:
    found = {}
    total = 0
    for path in sorted(stage.rglob("*")):
        if not path.is_file():
            continue
        name = path.relative_to(stage).as_posix()
        why = name_fault(name)
        if why:
            raise InputError(f"{UNPACKED} the world cannot be packed: the file {name!r:.100} {why}", UNPACKED)
        digest = hashlib.sha256()
        with path.open("rb") as file:
            while piece := file.read(1 << 20):
                digest.update(piece)
        size = path.stat().st_size
        total += size
        found[name] = {"size": size, "sha256": digest.hexdigest()}
    if total > MAX_BYTES:
        raise InputError(f"{UNPACKED} the run has {total >> 20} MiB, a bundle holds {MAX_BYTES >> 20}", UNPACKED)
    return found


def _write_zip(stage: Path, manifest: Manifest, target: Path) -> None:
    """The same bytes for the same content: no times, no owners, names in order."""
    with target.open("wb") as raw:
        with zipfile.ZipFile(raw, "w") as archive:
            for name in (PAGE, *sorted(manifest.files)):
                info = zipfile.ZipInfo(name, _EPOCH)
                is_packed = name == BAG or Path(name).suffix.lower() in (".png", ".jpg", ".jpeg", ".webp")
                info.compress_type = zipfile.ZIP_STORED if is_packed else zipfile.ZIP_DEFLATED
                info.external_attr, info.create_system = _PLAIN, _UNIX
                if name == PAGE:
                    archive.writestr(info, manifest.text())
                    continue
                with (stage / name).open("rb") as source, archive.open(info, "w") as file:
                    shutil.copyfileobj(source, file, 1 << 20)
        raw.flush()
        os.fsync(raw.fileno())


# ---------------------------------------------------------------------- the world


class _Stager:
    """Copies what a run was made from, so that it opens anywhere.

    Args:
        origin: how it was loaded.
        stage: the folder that becomes the bundle.
    """

    def __init__(self, origin: Any, stage: Path) -> None:
        self._origin, self._stage = origin, stage
        paths = [Path(p) for p in origin["resource_paths"]]
        self._paths = [p if p.is_absolute() else origin["folder"] / p for p in paths]
        self._folders = 0

    def world(self, keeper: BundleRecorder) -> _StagedWorld:
        """Everything that was loaded, and spawned later."""
        origin, found = self._origin, _StagedWorld()
        found.file = self._vendored(origin["source"], "world", base=origin["base"])
        self._spawned(found)
        for given in keeper.sim._loaded.structure.builder.parameter_files:
            found.params.append((given.model, self._copied(Path(given.file.path), f"params/{len(found.params)}")))
        for source in dict.fromkeys(keeper.journal.sources):
            if "<" not in source:
                self._later(found, source)
        if origin["plugins"]:
            kinds = ", ".join(
                sorted({type(one[1] if isinstance(one, tuple) else one).__name__ for one in origin["plugins"]})
            )
            found.missing.append(f"plugins made in Python are not in it: {kinds}")
        if origin["is_changed"]:
            found.missing.append(
                "the world was changed in Python as it was loaded (change_world); it is packed without"
            )
        self._compare(found, keeper)
        return found

    def unloaded(self, params_files: Any) -> _StagedWorld:
        """Everything that was to be loaded."""
        found = _StagedWorld(self._vendored(self._origin["source"], "world", base=self._origin["base"]))
        self._spawned(found)
        for one in params_files:
            model, file = one if isinstance(one, tuple) else _split_params_file(str(one))
            found.params.append((model, self._copied(Path(file), f"params/{len(found.params)}")))
        return found

    def _spawned(self, found: _StagedWorld) -> None:
        from simkit.loaders.spawn_option import parse_spawn

        for number, one in enumerate(self._origin["spawn"]):
            spawn = parse_spawn(one, Diagnostics()) if isinstance(one, str) else one
            if spawn is not None:
                file = self._vendored(spawn.source, f"spawn/{number}")
                found.spawn.append(SpawnedModel(file, spawn.place, spawn.name))

    def _later(self, found: _StagedWorld, source: str) -> None:
        try:
            found.models[source] = self._vendored(source, f"models/{len(found.models)}")
        except SimkitError as error:  # somebody may have asked for a model that there is not
            found.missing.append(f"{source!r:.100}, which was to be spawned, could not be packed: {error!s:.200}")

    def _vendored(self, source: Any, target: str, base: str = "auto") -> str:
        """The place of a file in the stage, with all that it names."""
        from simkit.build import describe
        from simkit.writers.vendor import vendor

        origin = self._origin
        paths = self._paths
        with tempfile.TemporaryDirectory() as folder:
            if isinstance(source, str) and "<" in source:
                file = Path(folder) / "world.sdf"
                file.write_text(source, encoding="utf-8")
                source, paths = file, [*paths, origin["folder"]]
            elif "://" in str(source):
                source = self._found(str(source))
            elif not Path(source).is_absolute() and (origin["folder"] / source).exists():
                source = origin["folder"] / source
            (self._stage / target).parent.mkdir(parents=True, exist_ok=True)
            options = {"package_paths": origin["package_paths"], "xacro_args": origin["xacro_args"], "base": base}
            try:
                main, _ = vendor(str(source), self._stage / target, describe, resource_paths=paths, **options)
            except InputError as error:
                raise InputError(f"{UNPACKED} {_source_text(source)} cannot be packed: {error}", UNPACKED) from None
        return f"{target}/{main.as_posix()}"

    def _found(self, uri: str) -> Path:
        """The file or folder of a URI."""
        from simkit.loaders import Resolver

        path, _ = Resolver(self._paths, package_paths=self._origin["package_paths"]).search(uri, None)
        if path is None:
            raise InputError(f"{UNPACKED} {uri} is not found any more", UNPACKED)
        return path

    def _copied(self, path: Path, target: str) -> str:
        place = self._stage / target / path.name
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path if path.is_absolute() else self._origin["folder"] / path, place)
        return f"{target}/{path.name}"

    def _compare(self, found: _StagedWorld, keeper: BundleRecorder) -> None:
        """Whether what was packed is what was run: files may have been edited since."""
        from simkit.testing.bundles.packed_world import load_packed_world

        try:
            with load_packed_world(self._stage, found.file, found.spawn, found.params, (), self._origin) as sim:
                same = model_hash(sim.mj_model, sim.originals) == loaded_model_hash(keeper)
        except (SimkitError, OSError) as error:
            found.missing.append(f"opening it again failed: {error!s:.300}")
            return
        if not same and not self._origin["plugin_paths"] and not self._origin["is_changed"]:
            found.missing.append("its files have been changed since the run began; they are packed as they are now")


def loaded_model_hash(keeper: BundleRecorder) -> str:
    """Of the model that was loaded, whatever has been changed of it since."""
    sim = keeper.sim
    loaded = sim._loaded.structure.compiled.model
    return model_hash(loaded, sim.originals if loaded is sim.mj_model else {})


def _split_params_file(text: str) -> tuple[str, str]:
    """`[MODEL=]FILE`."""
    model, equals, file = text.partition("=")
    return (model, file) if equals and "/" not in model and not Path(text).exists() else ("", text)


def _source_text(source: Any) -> str:
    return "the text" if "<" in str(source) else str(source)


# ---------------------------------------------------------------------- code


def _plugin_modules(world: _StagedWorld, stage: Path, folders: Any) -> None:
    """The modules that were imported from the user's plugin folders; they are copied, not run."""
    roots = [Path(folder).resolve() for folder in folders]
    for number, root in enumerate(roots):
        files = {
            file
            for file in map(_file_of, tuple(sys.modules.values()))
            if file is not None and file.is_relative_to(root)
        }
        for file in sorted(files | _package_files(files, root)):
            name = f"code/{number}/{file.relative_to(root).as_posix()}"
            target = stage / name
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, target)
            world.code.append(name)


def _file_of(module: Any) -> Path | None:
    said = getattr(module, "__file__", None)
    if not isinstance(said, str) or not said.endswith(".py"):
        return None
    path = Path(said).resolve()
    return path if path.is_file() else None


def _package_files(files: set[Path], root: Path) -> set[Path]:
    """The `__init__.py` above files, up to a folder."""
    above = {folder for file in files for folder in file.parents if folder.is_relative_to(root)}
    return {init for folder in above if (init := folder / "__init__.py").is_file()}
