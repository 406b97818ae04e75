"""Reader of `<geometry>`: box, cylinder, sphere, capsule, mesh, and PyBullet's plane."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from simkit.diagnostics import did_you_mean
from simkit.loaders.urdf.element_attributes import (
    FARTHEST,
    leading_numbers,
    number_attribute,
    numbers_attribute,
    parse_number,
    report_bad_value,
    report_missing,
    report_substitute,
    text_attribute,
    vector3_attribute,
)
from simkit.loaders.urdf.robot_draft import RobotDraft
from simkit.params import Params
from simkit.scene import Box, Capsule, Cylinder, Geometry, Mesh, Plane, Sphere
from simkit.scene.geometry import Vec3

THINNEST = 1e-4  # [m], replaces a size of 0


def read_geometry(owner: Params, draft: RobotDraft, what: str) -> Geometry | None:
    """Return the shape of a collision or visual; None, with an error recorded, if there is no usable shape."""
    block = owner.child("geometry")
    if block is None:
        near = did_you_mean("geometry", [c.name for c in owner.children])
        owner.error("SK-URDF-009", f"{what} needs <geometry>", near)
        return None
    shapes = [c for c in block.children if ":" not in c.name]
    for shape in shapes:
        if shape.name in _PRIMITIVES:
            block.child(shape.name)
            return _PRIMITIVES[shape.name](shape, what)
        if shape.name == "mesh":
            block.child("mesh")
            return _mesh(shape, draft, what)
    known = ", ".join(f"<{name}>" for name in _SHAPES)
    if not shapes:
        block.error("SK-URDF-009", f"{what} has an empty <geometry>; known shapes are {known}")
        return None
    hint = did_you_mean(shapes[0].name, _SHAPES)
    message = f"{what} has the unknown shape <{shapes[0].name}>; known are {known}"
    if hint:
        shapes[0].error("SK-URDF-009", message, hint)
    else:
        report_substitute(shapes[0], message, "it is left out")
    block.mark_all_read()
    return None


def _positive(element: Params, attribute: str, what: str) -> float:
    value = number_attribute(element, attribute, owner=what)
    if value == 0.0 and parse_number(element.attributes.get(attribute, "")) != 0.0:
        return 1.0  # no number, which is reported
    return _sizes(element, attribute, what, (value,))[0]


def _sizes(element: Params, attribute: str, what: str, sizes: tuple[float, ...]) -> tuple[float, ...]:
    """Return sizes [m] that can be simulated: a negative size is an error, and 0 becomes 0.1 mm."""
    if attribute not in element.attributes or all(0 < v <= FARTHEST for v in sizes):
        return tuple(v or 1.0 for v in sizes)
    shown = f"{what}: <{element.name}> has {attribute} {' '.join(f'{v:g}' for v in sizes)}"
    if any(v < 0 for v in sizes):
        element.error("SK-URDF-009", f"{shown}; it must be positive")
        return tuple(abs(v) or THINNEST for v in sizes)
    if any(v > FARTHEST for v in sizes):
        element.error("SK-URDF-009", f"{shown}; it must be at most {FARTHEST:g}")
        return tuple(1.0 for _ in sizes)
    message = f"{shown}; {THINNEST * 1000:g} mm is used instead of 0"
    element.diagnostics.warning("SK-URDF-028", message, element.where)
    return tuple(v or THINNEST for v in sizes)


def _box(element: Params, what: str) -> Geometry:
    size = numbers_attribute(element, "size", 3)
    if size is None:
        if "size" not in element.attributes:
            report_missing(element, "size", "3 numbers", what)
        return Box((1.0, 1.0, 1.0))
    x, y, z = _sizes(element, "size", what, size)
    return Box((x, y, z))


def _mesh(element: Params, draft: RobotDraft, what: str) -> Geometry | None:
    uri = text_attribute(element, "filename")
    scale = _scale(element)
    if any(v == 0 for v in scale):
        report_bad_value(element, "scale", "3 numbers that are not 0")
        scale = (1.0, 1.0, 1.0)
    if not uri:
        report_missing(element, "filename", "the URI of a mesh", what)
        return None
    path = draft.assets.mesh(uri, element)
    return Mesh(path or Path(uri), uri, scale, missing=path is None)


def _scale(element: Params) -> Vec3:
    """Return three scale factors; one number alone is used for all three."""
    written = text_attribute(element, "scale").split()
    if len(written) == 1 and parse_number(written[0]) is not None:
        report_substitute(element, f'<mesh scale="{written[0]}"> has one number', "it is used for x, y and z")
        element.attributes["scale"] = " ".join(written * 3)
    scale = leading_numbers(element, "scale", 3)
    return (1.0, 1.0, 1.0) if scale is None else (scale[0], scale[1], scale[2])


def _plane(element: Params, what: str) -> Geometry:
    """Return PyBullet's plane: infinite, through the origin of its frame."""
    report_substitute(element, f"{what}: <plane> is PyBullet's element", "it is read as an infinite plane")
    return Plane(vector3_attribute(element, "normal", (0.0, 0.0, 1.0)))


_PRIMITIVES: dict[str, Callable[[Params, str], Geometry]] = {
    "box": _box,
    "cylinder": lambda e, what: Cylinder(_positive(e, "radius", what), _positive(e, "length", what)),
    "sphere": lambda e, what: Sphere(_positive(e, "radius", what)),
    "capsule": lambda e, what: Capsule(_positive(e, "radius", what), _positive(e, "length", what)),
    "plane": _plane,
}
_SHAPES = ("box", "cylinder", "sphere", "capsule", "mesh")
