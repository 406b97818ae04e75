"""`<geometry>`: primitives, meshes, height maps and outlines."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

from simkit.diagnostics import did_you_mean
from simkit.loaders.sdf.load_context import SdfFile, Workspace
from simkit.params import Params
from simkit.scene import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Empty,
    Geometry,
    Heightmap,
    Mesh,
    Plane,
    Polyline,
    Sphere,
)
from simkit.scene.geometry import Vec3

_LARGEST_SIZE = 1e15  # [m]; moments of larger shapes leave the numbers
_Reader = Callable[[Params, SdfFile, Workspace], Geometry | None]


def read_geometry(owner: Params, file: SdfFile, workspace: Workspace, what: str) -> Geometry | None:
    """The shape of a collision or visual; None, with an error recorded, where there is no usable one."""
    block = owner.child("geometry")
    if block is None:
        near = did_you_mean("geometry", [c.name for c in owner.children])
        workspace.diagnostics.warning("SK-SDF-009", f"{what} has no <geometry>, and so no shape", owner.where, near)
        return Empty()
    shapes = [c for c in block.children if ":" not in c.name]
    if not shapes:
        return Empty()
    for shape in shapes:
        reader = _READERS.get(shape.name)
        if reader is not None:
            block.child(shape.name)
            if shape.name == "polyline":
                return _polylines(block.all("polyline"))
            return reader(shape, file, workspace)
    for name in _READERS:
        block.has(name)
    if shapes[0].name == "image":
        block.child("image")
        shapes[0].mark_all_read()
        workspace.diagnostics.warning("SK-SDF-012", f"{what}: <image> as a shape is not simulated", shapes[0].where)
    return Empty()


def _positive(element: Params, name: str, default: float) -> float:
    value = element.number(name, default)
    if not 0 < value <= _LARGEST_SIZE:
        found = element.child(name) or element
        allowed = "positive" if value <= 0 else f"at most {_LARGEST_SIZE:g}"
        found.error("SK-SDF-009", f"<{element.name}> has {name} {value:g}, it must be {allowed}")
        return default
    return value


def _sizes(element: Params, name: str, default: Vec3, minimum: float = 0.0) -> Vec3:
    values = element.vector3(name, default)
    if not all(minimum < v <= _LARGEST_SIZE for v in values):
        found = element.child(name) or element
        text = " ".join(f"{v:g}" for v in values)
        allowed = "positive" if any(v <= minimum for v in values) else f"at most {_LARGEST_SIZE:g}"
        found.error("SK-SDF-009", f"<{element.name}> has {name} {text}, each must be {allowed}")
        return default
    return values


def _box(element: Params, _file: SdfFile, _workspace: Workspace) -> Geometry:
    return Box(_sizes(element, "size", (1.0, 1.0, 1.0)))


def _sphere(element: Params, _file: SdfFile, _workspace: Workspace) -> Geometry:
    return Sphere(_positive(element, "radius", 1.0))


def _cylinder(element: Params, _file: SdfFile, _workspace: Workspace) -> Geometry:
    return Cylinder(_positive(element, "radius", 1.0), _positive(element, "length", 1.0))


def _capsule(element: Params, _file: SdfFile, _workspace: Workspace) -> Geometry:
    return Capsule(_positive(element, "radius", 0.5), _positive(element, "length", 1.0))


def _cone(element: Params, _file: SdfFile, _workspace: Workspace) -> Geometry:
    return Cone(_positive(element, "radius", 0.5), _positive(element, "length", 1.0))


def _ellipsoid(element: Params, _file: SdfFile, _workspace: Workspace) -> Geometry:
    return Ellipsoid(_sizes(element, "radii", (1.0, 1.0, 1.0)))


def _plane(element: Params, _file: SdfFile, _workspace: Workspace) -> Geometry:
    normal = element.vector3("normal", (0.0, 0.0, 1.0))
    length = math.sqrt(sum(v * v for v in normal))
    if length < 1e-12:
        element.error("SK-SDF-009", "<plane> has a normal of length zero")
        return Plane()
    width, depth = element.vector("size", 2, (1.0, 1.0))
    return Plane((normal[0] / length, normal[1] / length, normal[2] / length), (width, depth))


def _mesh(element: Params, file: SdfFile, workspace: Workspace) -> Geometry | None:
    old = element.text("filename", "")
    uri = element.text("uri", old or None, required=not old)
    scale = element.vector3("scale", (1.0, 1.0, 1.0))
    if any(v == 0 for v in scale):
        element.error("SK-SDF-009", f"<mesh> {uri} has a scale of zero")
        scale = (1.0, 1.0, 1.0)
    part = element.block("submesh")
    name, center = part.text("name", ""), part.boolean("center", False)
    optimization, most = _optimization(element)
    if not uri:
        return None
    place = element.child("uri") or element.child("filename") or element
    path = find_mesh(uri, place, file, workspace)
    if path is None:
        return Mesh(Path(uri), uri, scale, name, center, missing=True)
    return Mesh(path.absolute(), uri, scale, name, center, optimization=optimization, max_hulls=most)


def _optimization(element: Params) -> tuple[str, int]:
    """What `<mesh optimization>` asks for, and into how many pieces."""
    settings = element.block("convex_decomposition")
    most = settings.integer("max_convex_hulls", 16, minimum=1, maximum=1_000_000)
    settings.child("voxel_resolution")  # of another algorithm, which fills the mesh with cubes
    asked = element.attribute("optimization")
    if asked in ("", "convex_hull", "convex_decomposition"):
        return asked, most
    allowed = ("convex_hull", "convex_decomposition")
    element.diagnostics.warning(
        "SK-MESH-015",
        f"<mesh optimization={asked!r}> is not known, allowed are {', '.join(allowed)}",
        element.where,
        did_you_mean(asked, allowed),
    )
    return "", most


def find_mesh(uri: str, place: Params, file: SdfFile, workspace: Workspace) -> Path | None:
    """The mesh file that a URI names; what is to be said of it is said once, however often it is used."""
    path, said = workspace.resolver.mesh(uri, place.where, file.folder)
    if path is not None or uri not in workspace.reported:
        workspace.diagnostics.extend(said)
    if path is None:
        workspace.reported.add(uri)
    return path


def _heightmap(element: Params, file: SdfFile, workspace: Workspace) -> Geometry | None:
    uri = element.text("uri", required=True)
    size = _sizes(element, "size", (1.0, 1.0, 1.0))
    position = element.vector3("pos", (0.0, 0.0, 0.0))
    if not uri:
        return None
    place = element.child("uri") or element
    path = workspace.resolver.resolve(uri, place.where, workspace.diagnostics, file.folder)
    return None if path is None else Heightmap(path.absolute(), uri, size, position)


def _polylines(elements: list[Params]) -> Geometry | None:
    """Several outlines are one shape; the height is that of the first."""
    outlines = [outline for element in elements if (outline := _outline(element)) is not None]
    height = _positive(elements[0], "height", 1.0)
    for element in elements[1:]:
        element.child("height")
    return Polyline(tuple(outlines), height) if outlines else None


def _outline(element: Params) -> tuple[tuple[float, float], ...] | None:
    points: list[tuple[float, float]] = []
    for point in element.all("point"):
        try:
            x, y = (float(v) for v in point.value.split())
            if not max(abs(x), abs(y)) <= _LARGEST_SIZE:
                raise ValueError(point.value)
        except ValueError:
            point.error("SK-PARAM-002", f"found <point>{point.value}</point>, allowed is 2 numbers")
            continue
        points.append((x, y))
    if len(points) < 3:
        element.error("SK-SDF-009", f"<polyline> has {len(points)} points, it needs at least 3")
        return None
    return tuple(points)


_READERS: dict[str, _Reader] = {
    "box": _box,
    "sphere": _sphere,
    "cylinder": _cylinder,
    "capsule": _capsule,
    "cone": _cone,
    "ellipsoid": _ellipsoid,
    "plane": _plane,
    "mesh": _mesh,
    "heightmap": _heightmap,
    "polyline": lambda element, _file, _workspace: _polylines([element]),
    "empty": lambda _element, _file, _workspace: Empty(),
}
