"""Fingerprint of the conditions of a run that its scenario does not contain: versions, processor, renderer, files."""

from __future__ import annotations

import ast
import hashlib
import math
import os
import platform
import struct
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal

import numpy

from simkit.input_file import TEXT_LIMIT, read_input
from simkit.loaders.meshes.mesh_part import MeshFileError
from simkit.packs import is_shipped, is_shipped_file, shipped_folders
from simkit.params import Params
from simkit.testing.run_record.world_values import file_hash, plugin_value_files, values_of_files
from simkit.version import __version__

if TYPE_CHECKING:
    from simkit.runtime import Simulation


RENDERER: Final = "renderer"
RAY_TRACER: Final = "ray tracer"
PROCESSOR_FEATURES: Final = "processor features"
_LEVEL_3: Final = ("AVX2", "FMA3")  # what MuJoCo's and the C library's code for x86-64-v3 needs
_EMBREE_INSTRUCTIONS: Final = {"AVX512_SKX": "avx512", "AVX2": "avx2", "AVX": "avx", "SSE42": "sse4.2"}

Effect = Literal["run", "pictures", "rays", "none"]
"""Bits that an entry may change: of every run, of pictures, of readings of rays; or none, it helps to find a cause."""


def fingerprint(drawn: Simulation | None = None) -> dict[str, str]:
    """Return versions, processor and system of this process.

    Args:
        drawn: Simulation whose renderer is included; None for a run without images.

    Returns:
        Name -> value; `renderer` only on request.
    """
    values = dict(_machine_fingerprint())
    if drawn is not None:
        from simkit.sensors.cameras.renderer_choice import describe_renderer

        values[RENDERER] = describe_renderer(drawn)
    return values


def fingerprint_differences(
    a: Mapping[str, str], b: Mapping[str, str], pictures: bool = False, rays: bool = False
) -> dict[str, tuple[str, str]]:
    """Return the entries of two fingerprints that differ and may change bits: name -> both values.

    Args:
        a: One fingerprint.
        b: The other one.
        pictures: Compare the renderer too.
        rays: Compare the ray tracer too.
    """
    is_compared: dict[Effect, bool] = {"run": True, "pictures": pictures, "rays": rays, "none": False}
    names = [name for name in dict.fromkeys((*a, *b)) if is_compared[_effect(name)]]
    return {name: (a.get(name, ""), b.get(name, "")) for name in names if a.get(name, "") != b.get(name, "")}


def _effect(name: str) -> Effect:
    """Return the effect of an entry; an entry of another version of simkit may change every run."""
    return "pictures" if name == RENDERER else _ENTRIES[name][1] if name in _ENTRIES else "run"


@cache
def _machine_fingerprint() -> Mapping[str, str]:
    """Return the entries without the renderer."""
    return {name: read() for name, (read, _) in _ENTRIES.items()}


def _mujoco_version() -> str:
    import mujoco

    return str(mujoco.__version__)


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return ""


def _features() -> Mapping[str, bool]:
    """Return the processor features that NumPy found: name -> whether the processor has it."""
    try:
        features: Mapping[str, bool] = import_module("numpy._core._multiarray_umath").__cpu_features__
    except (ImportError, AttributeError):  # some NumPy versions do not have this table
        return {}
    return features


def _processor_level() -> str:
    """Return "x86-64-v3" for all processors whose runs have equal bits, "x86-64" for older ones, "" for other kinds."""
    features = _features()
    if platform.machine().lower() not in ("x86_64", "amd64") or not features:
        return ""
    return "x86-64-v3" if all(map(features.get, _LEVEL_3)) else "x86-64"


def _processor_features() -> str:
    """Return the features by which NumPy and BLAS select their code; of each family, only the widest ones."""
    relevant = ("AVX512F", "AVX512_SKX", "AVX512_ICL", "AVX512_SPR", "AVX2", "FMA3", "ASIMD", "SVE", "VSX4", "VX")
    features = _features()
    kernel = os.environ.get("OPENBLAS_CORETYPE", "")
    return " ".join(
        [name for name in relevant if features.get(name)] + ([f"OPENBLAS_CORETYPE={kernel}"] if kernel else [])
    )


def _math_library() -> str:
    """Return a hash of results of the C library's functions, which decide bits of MuJoCo and of Python's `math`."""
    digest = hashlib.sha256()
    functions = (math.sin, math.cos, math.tan, math.atan, math.exp, math.sinh, math.tanh, math.expm1)
    for k in range(1, 400):
        x = k * 0.0437 - 8.7
        values = [function(x) for function in functions]
        values += [
            math.log(k * 0.37),
            math.log1p(k * 1e-3),
            math.log10(k * 0.37),
            math.pow(k * 0.37, x),
            math.atan2(x, k),
        ]
        values += [math.asin(x / 9.0), math.acos(x / 9.0), math.fmod(x, 0.7)]
        digest.update(struct.pack(f"<{len(values)}d", *values))
    return digest.hexdigest()[:12]


def _ray_tracer() -> str:
    """Return the version of Embree's binding and the instructions that Embree chooses on this processor."""
    embree_version = _version("embreex")
    if not embree_version:
        return ""
    features = _features()
    chosen = next((name for feature, name in _EMBREE_INSTRUCTIONS.items() if features.get(feature)), "")
    return f"embree {embree_version} {chosen}".strip()


@cache
def code_hash() -> str:
    """Return the first 12 characters of a hash of simkit's own Python files: of the core and of the packs."""
    digest = hashlib.sha256()
    for root in shipped_folders():
        for path in sorted(root.rglob("*.py")):
            digest.update(path.relative_to(root).as_posix().encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()[:12]


_ENTRIES: Final[Mapping[str, tuple[Callable[[], str], Effect]]] = {
    "simkit": (lambda: __version__, "run"),
    "simkit code": (code_hash, "none"),
    "mujoco": (_mujoco_version, "run"),
    "numpy": (lambda: numpy.__version__, "run"),
    "opencv": (lambda: _version("opencv-python-headless"), "run"),
    "trimesh": (lambda: _version("trimesh"), "run"),
    "python": (platform.python_version, "none"),
    "processor": (platform.machine, "run"),
    "processor level": (_processor_level, "run"),
    # NumPy and BLAS choose their code by these instructions; simkit uses no function that depends on them
    PROCESSOR_FEATURES: (_processor_features, "none"),
    "system": (platform.system, "run"),
    "math library": (_math_library, "run"),
    "libc": (lambda: " ".join(platform.libc_ver()).strip(), "none"),
    # where a ray meets the edge of two triangles, either may be the nearest
    RAY_TRACER: (_ray_tracer, "rays"),
}
"""Entries of a fingerprint, beside the renderer: function that reads the value, and effect of the entry."""


_MAX_MODULES: Final = 100
_FILE_NAMING_SUFFIXES: Final = frozenset((".obj", ".dae", ".gltf", ".glb"))  # mesh formats that refer to further files


def source_hashes(sim: Simulation) -> dict[str, str]:
    """Return the SHA-256 of meshes, pictures and the code of external plugins and nodes, by file name.

    A file name includes parent folders if two files have the same name.
    """
    of_plugins = plugin_value_files(sim)
    are_leaves = values_of_files(of_plugins)[2]
    paths = dict.fromkeys(
        [*_files_of_scene(sim.world), *_code_files(sim), *(p for p in of_plugins if p not in are_leaves)]
    )
    hashes = {}
    for path, name in _short_names(list(paths)).items():
        digest = file_hash(path)[0]
        if digest:
            hashes[name] = digest
    return dict(sorted(hashes.items()))


def _files_of_scene(value: object) -> Iterator[Path]:
    """Iterate over the files that a scene refers to."""
    if isinstance(value, Path):
        yield value
        yield from _files_of_mesh(value)
    elif is_dataclass(value) and not isinstance(value, type):
        for field in fields(value):
            if field.name not in ("where", "mjcf", "moved_by", "urdf"):
                yield from _files_of_scene(getattr(value, field.name))
    elif isinstance(value, (tuple, list)):
        for item in value:
            yield from _files_of_scene(item)
    elif isinstance(value, Params):
        if value.value.startswith("/") and len(value.value) < 4096 and Path(value.value).is_file():
            yield Path(value.value)
        for child in value.children:
            yield from _files_of_scene(child)


def _files_of_mesh(mesh: Path) -> Iterator[Path]:
    """Iterate over the materials, pictures and buffers that a mesh refers to."""
    if mesh.suffix.lower() not in _FILE_NAMING_SUFFIXES:
        return
    from simkit.loaders.meshes.mesh_reader import convert_file

    try:
        yield from (Path(path) for path, known in convert_file(mesh).companions.items() if known is not None)
    except (MeshFileError, OSError):
        return  # loading has already reported the error


def _code_files(sim: Simulation) -> Iterator[Path]:
    """Iterate over the code files of nodes, and of plugins and sensors that are not part of simkit."""
    for part in (*sim.engine.structure.all_plugins(), *sim.engine.structure.all_sensors()):
        for kind in type(part).__mro__:
            file = getattr(sys.modules.get(kind.__module__), "__file__", None)
            if file and not is_shipped(kind) and not _is_standard_library(kind.__module__):
                yield from imported_files(Path(file).resolve())
    for program in sim.nodes:
        if program.file is not None and not is_shipped_file(str(program.file)):
            yield from imported_files(program.file)


def imported_files(path: Path) -> list[Path]:
    """Return a code file and the files in its folder that it imports, directly or indirectly."""
    files = [path]
    for file in files:  # the loop appends the imported files to this list
        if len(files) > _MAX_MODULES:
            break
        try:
            tree = ast.parse(read_input(file, TEXT_LIMIT))
        except (OSError, SyntaxError, ValueError, RecursionError, MemoryError):
            continue
        for node in ast.walk(tree):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import | ast.ImportFrom) else []
            names += [node.module] if isinstance(node, ast.ImportFrom) and node.module else []
            for name in names:
                beside = file.parent.joinpath(*name.split("."))
                for candidate in (beside.with_suffix(".py"), beside / "__init__.py"):
                    if candidate not in files and candidate.is_file():
                        files.append(candidate)
    return files


def _is_standard_library(module: str) -> bool:
    return module.partition(".")[0] in sys.stdlib_module_names


def _short_names(paths: list[Path]) -> dict[Path, str]:
    """Return a unique name for each path: the file name, with parent folders where names are equal."""
    names = {path: path.name for path in paths}
    for parts in range(2, 8):
        taken: dict[str, int] = {}
        for name in names.values():
            taken[name] = taken.get(name, 0) + 1
        if max(taken.values(), default=1) == 1:
            break
        names = {p: n if taken[n] == 1 else "/".join(p.parts[-parts:]) for p, n in names.items()}
    return names
