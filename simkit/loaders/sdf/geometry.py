"""Reader of `<geometry>`: primitives, meshes, height maps and outlines."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

from simkit.diagnostics import did_you_mean
from simkit.float_sum import float_sum
from simkit.loaders.sdf.load_context import SdfFile, Workspace
from simkit.number_text import counted
from simkit.params import Params
from simkit.scene import geometry as shapes
from simkit.scene.geometry import Geometry, Mesh, Vec3

_LARGEST_SIZE = 1e15  # [m]; the moments of larger shapes overflow
_OPTIMIZATIONS = ("convex_hull", "convex_decomposition")


def read_geometry(owner: Params, file: SdfFile, workspace: Workspace, what: str) -> Geometry | None:
    """Return the shape of a collision or visual; None, with an error recorded, if there is no usable shape."""
    block = owner.child("geometry")
    if block is None:
        near = did_you_mean("geometry", [c.name for c in owner.children])
        owner.warning("SK-SDF-009", f"{what} has no <geometry> and therefore no shape", near)
        return shapes.Empty()
    children = [c for c in block.children if ":" not in c.name]
    for shape in children:
        if shape.name not in _KNOWN_SHAPES:
            continue
        block.child(shape.name)
        if shape.name == "mesh":
            return _mesh(shape, file, workspace)
        if shape.name == "heightmap":
            return _heightmap(shape, file, workspace)
        if shape.name == "polyline":
            return _polylines(block.all("polyline"))
        return _PRIMITIVES[shape.name](shape)
    for name in _KNOWN_SHAPES if children else ():
        block.has(name)
    if children and children[0].name == "image":
        block.child("image")
        children[0].mark_all_read()
        children[0].warning("SK-SDF-012", f"{what}: the shape <image> is not simulated")
    return shapes.Empty()


def _positive(element: Params, name: str, default: float) -> float:
    value = element.number(name, default)
    if not 0 < value <= _LARGEST_SIZE:
        allowed = "positive" if value <= 0 else f"at most {_LARGEST_SIZE:g}"
        message = f"<{element.name}> has {name} {value:g}; it must be {allowed}"
        element.child_or_self(name).error("SK-SDF-009", message)
        return default
    return value


def _sizes(element: Params, name: str) -> Vec3:
    values = element.vector3(name, (1.0, 1.0, 1.0))
    if not all(0 < v <= _LARGEST_SIZE for v in values):
        text = " ".join(f"{v:g}" for v in values)
        allowed = "positive" if any(v <= 0 for v in values) else f"at most {_LARGEST_SIZE:g}"
        message = f"<{element.name}> has {name} {text}; each number must be {allowed}"
        element.child_or_self(name).error("SK-SDF-009", message)
        return (1.0, 1.0, 1.0)
    return values


def _plane(element: Params) -> Geometry:
    normal = element.vector3("normal", (0.0, 0.0, 1.0))
    length = math.sqrt(float_sum(v * v for v in normal))
    if length < 1e-12:
        element.error("SK-SDF-009", "<plane> has a normal of length zero")
        return shapes.Plane()
    width, depth = element.vector("size", 2, (1.0, 1.0))
    return shapes.Plane((normal[0] / length, normal[1] / length, normal[2] / length), (width, depth))


def _mesh(element: Params, file: SdfFile, workspace: Workspace) -> Geometry | None:
    old = element.text("filename", "")
    uri = element.text("uri", old or None, required=not old)
    scale = _mesh_scale(element, uri)
    if any(v == 0 for v in scale):
        element.error("SK-SDF-009", f"<mesh> {uri} has a scale of zero")
        scale = (1.0, 1.0, 1.0)
    part = element.block("submesh")
    name, center = part.text("name", ""), part.boolean("center", False)
    optimization, most = _optimization(element)
    if not uri:
        return None
    place = element.child("uri") or element.child_or_self("filename")
    path = _find_mesh(uri, place, file, workspace)
    if path is None:
        return Mesh(Path(uri), uri, scale, name, center, missing=True)
    return Mesh(path.absolute(), uri, scale, name, center, optimization=optimization, max_hulls=most)


def _mesh_scale(element: Params, uri: str) -> Vec3:
    """Return the scale of a mesh; one number is used for x, y and z, with a warning."""
    scale = element.child("scale")
    if scale is None or len(scale.value.split()) != 1:
        return element.vector3("scale", (1.0, 1.0, 1.0))
    size = element.number("scale", 1.0)
    message = f"<mesh> {uri}: <scale> has one number, which is used for x, y and z; SDF defines three numbers"
    scale.warning("SK-MESH-017", message, f"write <scale>{size:g} {size:g} {size:g}</scale>")
    return (size, size, size)


def _optimization(element: Params) -> tuple[str, int]:
    """Return the value of `<mesh optimization>` and the maximum number of convex pieces."""
    settings = element.block("convex_decomposition")
    most = settings.integer("max_convex_hulls", 16, minimum=1, maximum=1_000_000)
    settings.child("voxel_resolution")  # setting of another algorithm, which fills the mesh with cubes
    requested = element.attribute("optimization")
    if requested in ("", *_OPTIMIZATIONS):
        return requested, most
    message = f"<mesh optimization={requested!r}> is unknown; expected {', '.join(_OPTIMIZATIONS)}"
    element.warning("SK-MESH-015", message, did_you_mean(requested, _OPTIMIZATIONS))
    return "", most


def _find_mesh(uri: str, place: Params, file: SdfFile, workspace: Workspace) -> Path | None:
    """Return the mesh file that a URI names; problems are reported once, even if several elements use the URI."""
    path, problems = workspace.resolver.mesh(uri, place.where, file.folder)
    if path is not None or uri not in workspace.reported:
        workspace.diagnostics.extend(problems)
    if path is None:
        workspace.reported.add(uri)
    return path


def _heightmap(element: Params, file: SdfFile, workspace: Workspace) -> Geometry | None:
    uri = element.text("uri", required=True)
    size = _sizes(element, "size")
    position = element.vector3("pos", (0.0, 0.0, 0.0))
    if not uri:
        return None
    where = element.child_or_self("uri").where
    path = workspace.resolver.resolve(uri, where, workspace.diagnostics, file.folder)
    return None if path is None else shapes.Heightmap(path.absolute(), uri, size, position)


def _polylines(elements: list[Params]) -> Geometry | None:
    """Return one shape from several outlines. The height of the first outline is used."""
    outlines = [outline for element in elements if (outline := _outline(element)) is not None]
    height = _positive(elements[0], "height", 1.0)
    for element in elements[1:]:
        element.child("height")
    return shapes.Polyline(tuple(outlines), height) if outlines else None


def _outline(element: Params) -> tuple[tuple[float, float], ...] | None:
    points: list[tuple[float, float]] = []
    for point in element.all("point"):
        try:
            x, y = (float(v) for v in point.value.split())
            if not max(abs(x), abs(y)) <= _LARGEST_SIZE:
                raise ValueError(point.value)
        except ValueError:
            point.error("SK-PARAM-002", f"found <point>{point.value}</point>; expected 2 numbers")
            continue
        points.append((x, y))
    if len(points) < 3:
        element.error("SK-SDF-009", f"<polyline> has {counted(len(points), 'point')}; it needs at least 3")
        return None
    return tuple(points)


_PRIMITIVES: dict[str, Callable[[Params], Geometry]] = {
    "box": lambda e: shapes.Box(_sizes(e, "size")),
    "sphere": lambda e: shapes.Sphere(_positive(e, "radius", 1.0)),
    "cylinder": lambda e: shapes.Cylinder(_positive(e, "radius", 1.0), _positive(e, "length", 1.0)),
    "capsule": lambda e: shapes.Capsule(_positive(e, "radius", 0.5), _positive(e, "length", 1.0)),
    "cone": lambda e: shapes.Cone(_positive(e, "radius", 0.5), _positive(e, "length", 1.0)),
    "ellipsoid": lambda e: shapes.Ellipsoid(_sizes(e, "radii")),
    "plane": _plane,
    "empty": lambda _: shapes.Empty(),
}
_KNOWN_SHAPES = (*_PRIMITIVES, "mesh", "heightmap", "polyline")
