"""Mesh files as triangles in metres, as Gazebo reads them.

COLLADA: the file's unit counts, its up axis does not (Gazebo ignores it, and models are made for that).
"""

from __future__ import annotations

import math
from functools import lru_cache
from pathlib import Path
from typing import Any, Final

import numpy as np

from simkit.compiler.mesh_cache import load_cached, mesh_key, store
from simkit.compiler.mesh_part import MeshPart
from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.scene import Mesh

LARGEST_FILE: Final = 512 << 20
LARGEST_FACES: Final = 4_000_000
FARTHEST_VERTEX: Final = 1e9  # [m]; volumes of farther ones leave the single precision that the engine keeps them in
LARGEST_TEXTURE: Final = 2048


class MeshFileError(Exception):
    """A mesh file that cannot be used; the text says why."""


def load_mesh(mesh: Mesh, diagnostics: Diagnostics, where: Where) -> list[MeshPart]:
    """The mesh of a geometry, scaled; empty (and an error recorded) when the file cannot be used."""
    try:
        parts = load_file(mesh.file, mesh.submesh)
    except MeshFileError as problem:
        diagnostics.error("SK-MESH-001", f"{mesh.uri}: {problem}", where)
        return []
    if mesh.center and parts:
        low = np.min([p.vertices.min(axis=0) for p in parts], axis=0)
        high = np.max([p.vertices.max(axis=0) for p in parts], axis=0)
        parts = [p.moved(-(low + high) / 2) for p in parts]
    if not all(math.isfinite(s) and s != 0.0 for s in mesh.scale):
        diagnostics.error("SK-MESH-002", f"{mesh.uri}: scale {mesh.scale} has a zero or is not finite", where)
        return []
    if mesh.scale != (1.0, 1.0, 1.0):
        parts = [p.scaled(mesh.scale) for p in parts]
    return parts


def load_file(file: Path, submesh: str = "") -> list[MeshPart]:
    """All triangles of a file by material, in metres. Raises MeshFileError."""
    try:
        stat = file.stat()
    except OSError as problem:
        raise MeshFileError(f"cannot be read: {problem.strerror}") from None
    if stat.st_size > LARGEST_FILE:
        raise MeshFileError(f"is larger than {LARGEST_FILE >> 20} MiB")
    return list(_load(file, submesh, (stat.st_mtime_ns, stat.st_size)))


@lru_cache(maxsize=64)
def _load(file: Path, submesh: str, _version: tuple[int, int]) -> tuple[MeshPart, ...]:
    key = mesh_key(file, submesh)
    parts = load_cached(key)
    if parts is None:
        parts = _convert(file, submesh)
        store(key, parts)
    return tuple(parts)


def _convert(file: Path, submesh: str) -> list[MeshPart]:
    import trimesh

    options: dict[str, Any] = {"split_object": True} if submesh and file.suffix.lower() == ".obj" else {}
    try:
        scene = trimesh.load_scene(str(file), **options)
        dumped = [(scene.graph[node][1], scene.graph[node][0]) for node in scene.graph.nodes_geometry]
    except Exception as problem:  # noqa: BLE001 -- a reader of a broken file raises whatever its format's library does
        raise MeshFileError(f"is not a readable {file.suffix[1:] or 'mesh'} file: {problem}") from None
    wanted = _wanted(file, submesh, {name for name, _ in dumped}) if submesh else None
    unit = _unit_of(file)
    parts, faces = [], 0
    for name, matrix in dumped:
        geometry = scene.geometry[name]
        if (
            not isinstance(geometry, trimesh.Trimesh)
            or not len(geometry.faces)
            or (wanted is not None and name not in wanted)
        ):
            continue
        faces += len(geometry.faces)
        if faces > LARGEST_FACES:
            raise MeshFileError(f"has more than {LARGEST_FACES} faces")
        parts.append(_part(name, geometry, np.asarray(matrix, float), unit))
    if not parts:
        raise MeshFileError("holds no triangles")
    return parts


def _part(name: str, geometry: Any, matrix: Any, unit: float) -> MeshPart:
    vertices = (np.asarray(geometry.vertices, float) @ matrix[:3, :3].T + matrix[:3, 3]) * unit
    if not np.isfinite(vertices).all():
        raise MeshFileError("has coordinates that are not finite")
    if len(vertices) and np.abs(vertices).max() > FARTHEST_VERTEX:
        raise MeshFileError(f"has coordinates beyond {FARTHEST_VERTEX:g} m")
    faces = np.asarray(geometry.faces, np.int32)
    if np.linalg.det(matrix[:3, :3]) < 0.0:
        faces = np.ascontiguousarray(faces[:, ::-1])
    uv, colour, texture = _look(geometry.visual)
    if uv is None or len(uv) != len(vertices):
        uv = texture = None
    return MeshPart(name, vertices, faces, uv, colour, texture)


def _look(visual: Any) -> tuple[Any, tuple[float, float, float, float] | None, Any]:
    """Texture coordinates, colour and image of a mesh's material."""
    if not getattr(visual, "defined", False):
        return None, None, None
    if visual.kind != "texture":
        return None, _colour(visual.main_color), None
    material = visual.material
    image = getattr(material, "baseColorTexture", None)
    if image is None:
        image = getattr(material, "image", None)
    factor = getattr(material, "baseColorFactor", None)
    if factor is None:
        factor = getattr(material, "diffuse", None)
    colour = _colour(factor) if factor is not None else None
    uv = None if visual.uv is None else np.asarray(visual.uv, float)[:, :2]
    if image is None or uv is None or not np.isfinite(uv).all():
        return None, colour, None
    return uv, colour, pixels_of(image)


def pixels_of(image: Any) -> Any:
    """A Pillow image as uint8 rows from the top, shape (h, w, 3), not larger than MuJoCo draws comfortably."""
    image = image.convert("RGB")
    image.thumbnail((LARGEST_TEXTURE, LARGEST_TEXTURE))
    return np.asarray(image, np.uint8)


def _colour(value: Any) -> tuple[float, float, float, float]:
    given = np.asarray(value)
    numbers = given.astype(float) / (255.0 if np.issubdtype(given.dtype, np.integer) else 1.0)
    r, g, b, *rest = (float(min(1.0, max(0.0, c))) for c in numbers)
    # Exporters that write opacity the other way round would make the whole part invisible.
    return r, g, b, rest[0] if rest and rest[0] > 0.01 else 1.0


def _unit_of(file: Path) -> float:
    """Metres per unit of a COLLADA file; 1 for all other formats, which Gazebo reads as metres."""
    if file.suffix.lower() != ".dae":
        return 1.0
    for element in _collada(file).iter("{*}unit"):
        try:
            metres = float(element.get("meter", "1"))
        except ValueError:
            return 1.0
        return metres if math.isfinite(metres) and metres > 0.0 else 1.0
    return 1.0


def _collada(file: Path) -> Any:
    from lxml import etree

    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False, huge_tree=True, recover=True)
    return etree.parse(str(file), parser).getroot()


def _wanted(file: Path, submesh: str, names: set[str]) -> set[str]:
    """Names of trimesh's geometries that make up a sub-mesh: Gazebo knows a COLLADA one by its node's name."""
    of_name: dict[str, set[str]] = {n: {n} for n in names}
    if file.suffix.lower() == ".dae":
        root = _collada(file)
        aliases: dict[str, set[str]] = {}
        for geometry in root.iter("{*}geometry"):
            for alias in (geometry.get("id"), geometry.get("name")):
                if alias:
                    aliases.setdefault(alias, set()).add(geometry.get("id", ""))
        for node in root.iter("{*}node"):
            urls = {i.get("url", "").lstrip("#") for i in node.iterfind("{*}instance_geometry")}
            for alias in (node.get("name"), node.get("id")):
                if alias and urls:
                    aliases.setdefault(alias, set()).update(urls)
        for alias, ids in aliases.items():
            # trimesh numbers the further materials of one geometry: id, id_1, id_2
            of_name.setdefault(alias, set()).update(n for n in names if n in ids or n.rpartition("_")[0] in ids)
    chosen = of_name.get(submesh)
    if not chosen:
        raise MeshFileError(
            f"has no sub-mesh {submesh!r} ({did_you_mean(submesh, of_name) or ', '.join(sorted(of_name))})"
        )
    return chosen
