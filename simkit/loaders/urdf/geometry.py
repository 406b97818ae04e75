"""`<geometry>`: box, cylinder, sphere, capsule, mesh."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from simkit.diagnostics import did_you_mean
from simkit.loaders.urdf.draft import Draft
from simkit.loaders.urdf.reading import bad, missing, number, numbers, text, vector3
from simkit.params import Params
from simkit.scene import Box, Capsule, Cylinder, Geometry, Mesh, Sphere

THINNEST = 1e-4
_Reader = Callable[[Params, Draft, str], Geometry | None]


def read_geometry(owner: Params, draft: Draft, what: str) -> Geometry | None:
    """The shape of a collision or visual; None, with an error recorded, where there is no usable one."""
    block = owner.child("geometry")
    if block is None:
        near = did_you_mean("geometry", [c.name for c in owner.children])
        draft.diagnostics.error("SK-URDF-009", f"{what} needs <geometry>", owner.where, near)
        return None
    shapes = [c for c in block.children if ":" not in c.name]
    for shape in shapes:
        reader = _READERS.get(shape.name)
        if reader is not None:
            block.child(shape.name)
            return reader(shape, draft, what)
        if shape.name == "mesh":
            block.child("mesh")
            return _mesh(shape, draft, what)
    known = ", ".join(f"<{name}>" for name in _SHAPES)
    if not shapes:
        draft.diagnostics.error("SK-URDF-009", f"{what} has an empty <geometry>, known are {known}", block.where)
        return None
    hint = did_you_mean(shapes[0].name, _SHAPES)
    message = f"{what} has a <{shapes[0].name}>, known are {known}"
    draft.diagnostics.error("SK-URDF-009", message, shapes[0].where, hint)
    block.mark_all_read()
    return None


def _positive(element: Params, attribute: str, what: str) -> float:
    return _sizes(element, attribute, what, (number(element, attribute, owner=what),))[0]


def _sizes(element: Params, attribute: str, what: str, sizes: tuple[float, ...]) -> tuple[float, ...]:
    """Sizes [m] as they can be simulated: nothing negative, and what is flat gets a tenth of a millimetre."""
    if attribute not in element.attributes or all(v > 0 for v in sizes):
        return tuple(v or 1.0 for v in sizes)
    shown = f"{what}: <{element.name}> has {attribute} {' '.join(f'{v:g}' for v in sizes)}"
    if any(v < 0 for v in sizes):
        element.diagnostics.error("SK-URDF-009", f"{shown}, it must be positive", element.where)
        return tuple(abs(v) or THINNEST for v in sizes)
    message = f"{shown}; what has no size is made {THINNEST * 1000:g} mm"
    element.diagnostics.warning("SK-URDF-028", message, element.where)
    return tuple(v or THINNEST for v in sizes)


def _box(element: Params, _draft: Draft, what: str) -> Geometry:
    size = numbers(element, "size", 3)
    if size is None:
        if "size" not in element.attributes:
            missing(element, "size", "3 numbers", what)
        return Box((1.0, 1.0, 1.0))
    x, y, z = _sizes(element, "size", what, size)
    return Box((x, y, z))


def _cylinder(element: Params, _draft: Draft, what: str) -> Geometry:
    return Cylinder(_positive(element, "radius", what), _positive(element, "length", what))


def _capsule(element: Params, _draft: Draft, what: str) -> Geometry:
    return Capsule(_positive(element, "radius", what), _positive(element, "length", what))


def _sphere(element: Params, _draft: Draft, what: str) -> Geometry:
    return Sphere(_positive(element, "radius", what))


def _mesh(element: Params, draft: Draft, what: str) -> Geometry | None:
    uri = text(element, "filename")
    scale = vector3(element, "scale", (1.0, 1.0, 1.0))
    if any(v == 0 for v in scale):
        bad(element, "scale", "3 numbers that are not 0")
        scale = (1.0, 1.0, 1.0)
    if not uri:
        missing(element, "filename", "the URI of a mesh", what)
        return None
    path = draft.assets.mesh(uri, element)
    if path is None:
        return Mesh(Path(uri), uri, scale, missing=True)
    return Mesh(path, uri, scale)


_READERS: dict[str, _Reader] = {
    "box": _box,
    "cylinder": _cylinder,
    "sphere": _sphere,
    "capsule": _capsule,
}
_SHAPES = (*_READERS, "mesh")
