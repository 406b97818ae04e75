"""Stager that copies the files of a run into a folder, and the loader of the world in such a folder."""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final, cast

import numpy as np

from simkit import RunSpec, describe, load
from simkit.errors import InputError, LoadError, SimkitError
from simkit.extend import Diagnostics
from simkit.loaders import Resolver
from simkit.loaders.spawned_models import SpawnEntry, spawned_model
from simkit.msgs import own_interfaces
from simkit.run_files import FileName
from simkit.run_spec import FilePath, SourceOptions
from simkit.runtime.engine.heap_resistance import clear_resistance
from simkit.writers.vendored_folder import vendor
from simkit_verification.testing.bundles.manifest import packed_fields, packed_folder

if TYPE_CHECKING:
    import mujoco

    from simkit import Simulation
    from simkit_verification.testing.bundles.bundle_recorder import BundleRecorder


_SEARCH_VARIABLES: Final = (
    "SIMKIT_RESOURCE_PATH", "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "SDF_PATH", "GAZEBO_MODEL_PATH",
    "ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH", "GZ_FUEL_CACHE_PATH", "IGN_FUEL_CACHE_PATH", own_interfaces.VARIABLE,
)  # fmt: skip


def packed_run_spec(folder: Path, run: RunSpec, code: Sequence[Path] = ()) -> RunSpec:
    """Return the specification of a run whose files are in one folder.

    Args:
        folder: Folder with the files.
        run: Specification in the manifest.
        code: Folders of plugins whose code may run.
    """
    moved = run.with_files(lambda name: str(folder / name.text))
    options = {
        "plugin_paths": tuple(code),
        "interfaces": tuple(interfaces for interfaces in (folder / _INTERFACES,) if interfaces.is_dir()),
    }
    return replace(moved, world=str(folder / run.world)).with_values(options)


def load_packed_world(spec: RunSpec) -> Simulation:
    """Load the world of a bundle at t = 0; search no folder outside the bundle.

    Raises:
        LoadError, PluginError: See `simkit.load`.
    """
    with _without_user_folders():
        return load(spec.world, **spec.load_arguments())


@contextmanager
def _without_user_folders() -> Iterator[None]:
    """Hide the user's search folders, because a file of the same name in them may differ."""
    before = {name: os.environ.pop(name) for name in _SEARCH_VARIABLES if name in os.environ}
    try:
        yield
    finally:
        os.environ.update(before)


def model_hash(model: mujoco.MjModel, originals: Mapping[str, object]) -> str:
    """Return the SHA-256 of all arrays of an `MjModel` and of its options, except gravity and resistance in heaps.

    Args:
        model: Compiled model.
        originals: Compiled values of the arrays that were changed after compilation: name -> array.
    """
    digest = hashlib.sha256()
    for name in sorted(dir(model)):
        if name.startswith("_") or name == "paths" or name.endswith("pathadr"):
            continue
        value = originals.get(name)
        value = getattr(model, name) if value is None else value
        if isinstance(value, np.ndarray):
            if name == "dof_frictionloss":
                value = value.copy()
                clear_resistance(model, value)
            digest.update(name.encode())
            digest.update(np.ascontiguousarray(value).tobytes())
    digest.update(bytes(model.names))
    for name in ("timestep", "integrator", "solver", "iterations", "cone", "disableflags", "enableflags"):
        digest.update(repr(getattr(model.opt, name)).encode())
    return digest.hexdigest()


_CATKIN_PACKAGE: Final = "<package><name>{}</name><buildtool_depend>catkin</buildtool_depend></package>\n"
_INTERFACES: Final = "interfaces"  # folder of definitions of messages, services and actions
UNPACKED: Final = "SK-BUNDLE-006"
_CODE_NOT_ALLOWED: Final = ("SK-PLUGIN-001", "SK-PLUGIN-080")


@dataclass
class StagedWorld:
    """Files of a run that were copied to the stage folder."""

    run: RunSpec
    models: dict[str, str] = field(default_factory=dict)
    code: list[str] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)


class WorldStager:
    """Stager that copies the files of a run, so that the run can be loaded on another machine.

    Args:
        spec: Specification of the run.
        stage: Folder that becomes the bundle.
    """

    def __init__(self, spec: RunSpec, stage: Path) -> None:
        self._spec, self._stage = spec, stage
        self._paths = [spec.folder / path for path in spec.options.get("resource_paths", ())]

    def world(self, keeper: BundleRecorder) -> StagedWorld:
        """Copy the loaded world and all models that were spawned during the run."""
        files = keeper.sim.loaded.snapshot.structure.builder.parameter_files
        used = {"params_files": tuple((parameters.model, Path(parameters.file.path)) for parameters in files)}
        spec, staged = self._spec, self._main_files(self._spec.with_values(used))
        for source in dict.fromkeys(source for source in keeper.journal.sources if "<" not in source):
            try:
                staged.models[source] = self._copy_with_references(source, f"models/{len(staged.models)}")
            except SimkitError as error:  # the run may have requested a model that does not exist
                staged.missing.append(f"the spawned model {source!r:.100} could not be packed: {error!s:.200}")
        if spec.plugins:
            plugins = (entry[1] if isinstance(entry, tuple) else entry for entry in spec.plugins)
            kinds = ", ".join(sorted({type(plugin).__name__ for plugin in plugins}))
            staged.missing.append(f"plugins created in Python are not in the bundle: {kinds}")
        if spec.change_world is not None:
            problem = "changes to the world by a Python function (change_world) are not in the bundle"
            staged.missing.append(problem)
        self._compare(staged, keeper)
        return staged

    def unloaded(self) -> StagedWorld:
        """Copy the files of a run that failed while it was loaded."""
        return self._main_files(self._spec)

    def _main_files(self, spec: RunSpec) -> StagedWorld:
        """Copy the world, the models that are spawned during loading, and the user's types that the process used."""
        for name, text in own_interfaces.used_texts().items():
            target = self._stage / _INTERFACES / f"{name}.{name.split('/')[1]}"
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text, encoding="utf-8")
        for package in own_interfaces.used_ros1_packages():  # else the replay refuses names such as that of `int64 A`
            manifest = self._stage / _INTERFACES / package / "package.xml"
            manifest.write_text(_CATKIN_PACKAGE.format(package), encoding="utf-8")
        world = self._copy_with_references(spec.world, "world", base=spec.options.get("base", "auto"))
        parsed = (spawned_model(cast("SpawnEntry", request), Diagnostics()) for request in spec.spawn)
        spec = replace(spec, spawn=tuple(request for request in parsed if request is not None))
        values = {}
        for name, described in packed_fields().items():
            value = spec.value_of(described)
            if value not in (None, ()):
                values[name] = described.kind.move(value, name, self._copy)
        return StagedWorld(RunSpec(world).with_values(values))

    def _copy(self, name: FileName) -> str:
        """Copy a file that a field names; return its path in the stage folder."""
        target = "/".join(map(str, (packed_folder(str(name.keys[0])), *name.keys[1:])))
        if name.role == "world":
            return self._copy_with_references(str(name.path_in(self._spec.folder) or name.text), target)
        return self._copy_with_references(name.text, target) if name.role == "model" else self._copied(name, target)

    def _copy_with_references(self, source: FilePath, target: str, base: str = "auto") -> str:
        """Copy a file and all files to which the file refers; return its path in the stage folder."""
        spec, paths = self._spec, self._paths
        with tempfile.TemporaryDirectory() as folder:
            if isinstance(source, str) and "<" in source:
                file = Path(folder) / "world.sdf"
                file.write_text(source, encoding="utf-8")
                source, paths = file, [*paths, spec.folder]
            elif "://" in str(source):
                source = self._resolve_uri(str(source))
            elif not Path(source).is_absolute() and (spec.folder / source).exists():
                source = spec.folder / source
            (self._stage / target).parent.mkdir(parents=True, exist_ok=True)
            options: SourceOptions = {
                "resource_paths": paths,
                "package_paths": spec.options.get("package_paths", {}),
                "xacro_args": spec.options.get("xacro_args", {}),
                "base": base,
            }
            try:
                main, _ = vendor(str(source), self._stage / target, describe, **options)
            except InputError as error:
                what = "the text" if "<" in str(source) else source
                raise InputError(UNPACKED, f"{what} cannot be packed: {error}") from None
        return f"{target}/{main.as_posix()}"

    def _resolve_uri(self, uri: str) -> Path:
        """Resolve a URI to a file or folder."""
        path, _ = Resolver(self._paths, package_paths=self._spec.options.get("package_paths", {})).search(uri, None)
        if path is None:
            raise InputError(UNPACKED, f"{uri} no longer exists")
        return path

    def _copied(self, name: FileName, target: str) -> str:
        path = name.used_path(self._spec.folder) or Path(name.text)
        place = self._stage / target / path.name
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, place)
        return f"{target}/{path.name}"

    def _compare(self, staged: StagedWorld, keeper: BundleRecorder) -> None:
        """Compare the packed world with the world of the run, because files may have been edited during the run."""
        spec = self._spec
        try:
            with load_packed_world(packed_run_spec(self._stage, staged.run)) as sim:
                same = model_hash(sim.mj_model, sim.engine.originals) == loaded_model_hash(keeper)
        except (SimkitError, OSError) as error:
            errors = [d for d in error.diagnostics if d.severity == "error"] if isinstance(error, LoadError) else []
            if errors and all(d.code in _CODE_NOT_ALLOWED for d in errors):
                return  # the comparison does not run the plugins of the user
            staged.missing.append(f"the packed world could not be loaded: {error!s:.300}")
            return
        if not same and not spec.options.get("plugin_paths") and spec.change_world is None:
            staged.missing.append("files were edited after the run began; the bundle holds the edited files")


def loaded_model_hash(keeper: BundleRecorder) -> str:
    """Return the hash of the loaded model, without the changes that were made after loading."""
    sim = keeper.sim
    loaded = sim.loaded.snapshot.structure.compiled.model
    return model_hash(loaded, sim.engine.originals if loaded is sim.mj_model else {})


# ---------------------------------------------------------------------- code


def copy_plugin_modules(world: StagedWorld, stage: Path, folders: Iterable[FilePath]) -> None:
    """Copy the modules that were imported from the user's plugin folders; the modules are not run."""
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


def _file_of(module: object) -> Path | None:
    file = getattr(module, "__file__", None)
    if not isinstance(file, str) or not file.endswith(".py"):
        return None
    path = Path(file).resolve()
    return path if path.is_file() else None


def _package_files(files: set[Path], root: Path) -> set[Path]:
    """Return the `__init__.py` files in the parent folders of some files, up to a root folder."""
    above = {folder for file in files for folder in file.parents if folder.is_relative_to(root)}
    return {init for folder in above if (init := folder / "__init__.py").is_file()}
