"""Reader for mesh files as triangles in metres, with Gazebo's rules.

COLLADA: the file's unit is applied, but its up axis is ignored, because Gazebo ignores it and models are made for
Gazebo. glTF: the file's axes stay (y up), as in Gazebo. All other formats are in metres and define no axes.
"""

from __future__ import annotations

import io
import math
import re
from functools import lru_cache
from pathlib import Path
from typing import Final

import numpy as np

from simkit import progress
from simkit.diagnostics import Diagnostics, Where, closest
from simkit.input_file import read_input
from simkit.loaders.meshes.collada import read_collada
from simkit.loaders.meshes.collada_skin import bone_parts
from simkit.loaders.meshes.companion_files import Companions
from simkit.loaders.meshes.gltf import read_gltf
from simkit.loaders.meshes.mesh_cache import ConvertedMesh, load_converted, mesh_key, store_converted
from simkit.loaders.meshes.mesh_part import (
    FARTHEST_VERTEX,
    LARGEST_FACES,
    LARGEST_FILE,
    Floats,
    Ints,
    MeshFileError,
    MeshPart,
    check_is_fetched,
    numbers_of,
    report_once,
)
from simkit.loaders.meshes.obj import read_obj
from simkit.number_text import counted
from simkit.scene import Mesh

SUFFIXES: Final = (".dae", ".stl", ".obj", ".gltf", ".glb", ".ply", ".off")


def load_mesh(mesh: Mesh, diagnostics: Diagnostics, where: Where) -> list[MeshPart]:
    """Return the scaled mesh of a geometry; empty, with a diagnostic, if the file cannot be used.

    An unreadable file is a warning, like a missing one, because Gazebo also continues without it. A problem of a file
    is reported once, however often the file is used.
    """
    progress.set_item(mesh.file.name)
    try:
        if mesh.bone:
            return [part.scaled(mesh.scale) for part in bone_parts(mesh.file, mesh.bone)]
        converted = convert_file(mesh.file)
        parts = _submesh(list(converted.parts), mesh.submesh) if mesh.submesh else list(converted.parts)
    except MeshFileError as problem:
        message = f"{mesh.uri}: {problem}; the shape is left out of drawing and contacts"
        report_once(diagnostics, "warning", "SK-MESH-001", message, where)
        return []
    for text in converted.notes:
        report_once(diagnostics, "warning", "SK-MESH-012", f"{mesh.uri}: {text}", where)
    if not all(math.isfinite(s) and s != 0.0 for s in mesh.scale):
        text = f"{mesh.uri}: scale {mesh.scale} has a zero or is not finite"
        report_once(diagnostics, "error", "SK-MESH-002", text, where)
        return []
    if mesh.center and mesh.submesh:
        low = np.min([p.vertices.min(axis=0) for p in parts], axis=0)
        high = np.max([p.vertices.max(axis=0) for p in parts], axis=0)
        parts = [p.moved(-(low + high) / 2) for p in parts]
    if mesh.scale != (1.0, 1.0, 1.0):
        parts = [p.scaled(mesh.scale) for p in parts]
        if any(float(np.abs(p.vertices).max()) > FARTHEST_VERTEX for p in parts):
            text = f"{mesh.uri}: scaled by {mesh.scale} it reaches beyond {FARTHEST_VERTEX:g} m"
            report_once(diagnostics, "error", "SK-MESH-002", text, where)
            return []
    return parts


def load_file(file: Path, submesh: str = "") -> list[MeshPart]:
    """Return all triangles of a file in metres, one part for each material.

    Raises:
        MeshFileError: the file cannot be used.
    """
    parts = list(convert_file(file).parts)
    return _submesh(parts, submesh) if submesh else parts


def convert_file(file: Path) -> ConvertedMesh:
    """Return the content of a mesh file, from the cache if possible.

    Raises:
        MeshFileError: the file cannot be used.
    """
    try:
        stat = file.stat()
    except (OSError, ValueError) as problem:
        raise MeshFileError(f"cannot be read: {getattr(problem, 'strerror', problem)}") from None
    if not file.is_file():
        raise MeshFileError("is not a file")
    if stat.st_size > LARGEST_FILE:
        raise MeshFileError(f"is larger than {LARGEST_FILE >> 20} MiB")
    return _converted(file, (stat.st_mtime_ns, stat.st_size))


@lru_cache(maxsize=64)
def _converted(file: Path, _version: tuple[int, int]) -> ConvertedMesh:
    try:
        content = read_input(file, LARGEST_FILE)
    except OSError as problem:
        raise MeshFileError(f"cannot be read: {problem.strerror}") from None
    key = mesh_key(file, content)
    converted = load_converted(key)
    if converted is None:
        converted = _convert(file, content)
        store_converted(key, converted)
    return converted


def _convert(file: Path, content: bytes) -> ConvertedMesh:
    check_is_fetched(content)
    companions = Companions(file)
    try:
        parts = _read(file.suffix.lower(), content, companions)
    except MeshFileError:
        raise
    except MemoryError:
        raise MeshFileError("needs more memory than is available") from None
    except Exception as problem:  # noqa: BLE001 -- the library of a format may raise anything for a broken file
        text = " ".join(str(problem).split())[:200]
        raise MeshFileError(f"is not a readable {file.suffix[1:] or 'mesh'} file: {text}") from None
    parts = [_check_bounds(part) for part in parts if len(part.faces)]
    if not parts:
        raise MeshFileError("has no triangles")
    return ConvertedMesh(tuple(parts), tuple(companions.notes), companions.read)


def _read(suffix: str, content: bytes, companions: Companions) -> list[MeshPart]:
    if suffix in _READERS:
        return _READERS[suffix](content, companions)
    if suffix in (".ply", ".off"):
        return _with_trimesh(suffix, content)
    near = closest(suffix, SUFFIXES)
    hint = f"; did you mean {near}?" if near else ""
    raise MeshFileError(f"is a {suffix or 'nameless'} file (supported: {', '.join(SUFFIXES)}){hint}")


def _with_trimesh(suffix: str, content: bytes) -> list[MeshPart]:
    import trimesh

    header = content[:65536].split(b"end_header")[0] if suffix == ".ply" else content[:200]
    declared = sum(int(n) for line in header.splitlines() for n in line.split()[-1:] if n.isdigit() and len(n) < 20)
    if declared > 4 * LARGEST_FACES or declared > 4 * len(content):
        raise MeshFileError("declares more elements than it has")
    mesh = trimesh.load_mesh(io.BytesIO(content), file_type=suffix[1:], process=False)
    visual = mesh.visual
    colour = None
    if getattr(visual, "defined", False) and visual.kind in ("vertex", "face"):
        r, g, b, a = (float(v) / 255.0 for v in visual.main_color)
        colour = (r, g, b, a if a > 0.01 else 1.0)
    return [MeshPart("", np.asarray(mesh.vertices, float), np.asarray(mesh.faces, np.int32), colour=colour)]


def _check_bounds(part: MeshPart) -> MeshPart:
    used = part.vertices[part.faces.reshape(-1)] if len(part.vertices) > 3 * len(part.faces) else part.vertices
    if part.faces.min() < 0 or part.faces.max() >= len(part.vertices):
        raise MeshFileError("has a face with a missing vertex")
    if not np.isfinite(used).all():
        raise MeshFileError("has NaN or infinite coordinates")
    if np.abs(used).max() > FARTHEST_VERTEX:
        raise MeshFileError(f"has coordinates beyond {FARTHEST_VERTEX:g} m")
    if part.uv is not None and not (np.abs(part.uv) < 1e6).all():
        return MeshPart(part.name, part.vertices, part.faces, None, part.colour, None, part.specular, part.emission)
    return part


def _submesh(parts: list[MeshPart], name: str) -> list[MeshPart]:
    """Return the parts of one sub-mesh: by the name of its node or group, else by an alias."""
    chosen = [p for p in parts if p.name == name] or [p for p in parts if name in p.aliases]
    if not chosen:
        known = list(dict.fromkeys(n for p in parts for n in (p.name, *p.aliases) if n))
        near = closest(name, known)
        listed = f"did you mean {near!r}?" if near else ", ".join(known[:20]) or "none has a name"
        raise MeshFileError(f"has no sub-mesh {name!r} ({listed})")
    return chosen


_HEADER: Final = 84
_RECORD: Final = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_VERTEX: Final = re.compile(rb"vertex[ \t]+([^\r\n]*)", re.IGNORECASE)


def read_stl(content: bytes, companions: Companions) -> list[MeshPart]:
    """Read the triangles of a binary or ASCII STL file, which has no names, units or colours.

    A binary file is recognised by its length, because some exporters write `solid` at the beginning of binary files
    too. trimesh's reader is not used, because it does not limit hostile files. It reads a truncated file as an empty
    scene without an error, and its error messages contain names of arrays instead of the problem.

    Raises:
        MeshFileError: the file cannot be used.
    """
    declared = int.from_bytes(content[80:_HEADER], "little") if len(content) >= _HEADER else -1
    present = (len(content) - _HEADER) // _RECORD.itemsize
    is_text = content[:512].lstrip()[:5].lower() == b"solid"
    if declared >= 0 and len(content) == _HEADER + declared * _RECORD.itemsize:
        corners = _binary(content, declared)
    elif is_text and (b"facet" in content[:4096].lower() or b"endsolid" in content[-512:].lower()):
        corners = _ascii(content)
    elif 0 < declared <= present:
        companions.note(
            f"has {counted(len(content) - _HEADER - declared * _RECORD.itemsize, 'byte')} after its last triangle"
        )
        corners = _binary(content, declared)
    elif declared > 0:
        raise MeshFileError(
            f"is truncated: its header declares {counted(declared, 'triangle')}, it has {max(0, present)}"
        )
    else:
        raise MeshFileError("has no triangles")
    return [MeshPart("", *merge_corners(corners))]


def _binary(content: bytes, count: int) -> Floats:
    if count > LARGEST_FACES:
        raise MeshFileError(f"has more than {LARGEST_FACES} faces")
    records = np.frombuffer(content, _RECORD, count, _HEADER)
    return np.asarray(records["corners"], float).reshape(-1, 3)


def _ascii(content: bytes) -> Floats:
    if content.lower().count(b"vertex") > 3 * LARGEST_FACES:
        raise MeshFileError(f"has more than {LARGEST_FACES} faces")
    numbers = numbers_of(b" ".join(_VERTEX.findall(content)), "vertex")
    if not len(numbers) or len(numbers) % 9:
        raise MeshFileError(f"has {len(numbers) / 3:g} corners, which is not a whole number of triangles")
    return numbers.reshape(-1, 3)


def merge_corners(corners: Floats) -> tuple[Floats, Ints]:
    """Return vertices and faces of separate triangles, shape (3·m, 3); equal corners are merged."""
    packed = np.ascontiguousarray(corners + 0.0).view(np.dtype((np.void, 24))).reshape(-1)
    _, first, inverse = np.unique(packed, return_index=True, return_inverse=True)
    order = np.argsort(first, kind="stable")
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return corners[first[order]], rank[np.asarray(inverse).reshape(-1)].reshape(-1, 3).astype(np.int32)


_READERS: Final = {
    ".stl": read_stl, ".obj": read_obj, ".dae": read_collada, ".gltf": read_gltf, ".glb": read_gltf
}  # fmt: skip
