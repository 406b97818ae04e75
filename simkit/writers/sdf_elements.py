"""SDF elements inside links and joints: shapes, materials, surfaces, lights, axes, sensors, plugins."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import fields, replace
from pathlib import Path

from simkit.diagnostics import NOWHERE
from simkit.loaders.sdf.inertial import ADDED_MASS_NAMES
from simkit.params import Params
from simkit.pose import Pose
from simkit.scene import (
    Axis,
    Inertial,
    Material,
    Mesh,
    Mimic,
    Optics,
    SceneCollision,
    SceneLight,
    ScenePlugin,
    SceneSensor,
    SceneVisual,
    Surface,
)
from simkit.scene import geometry as shapes
from simkit.writers.xml_text import (
    changed_element,
    changed_elements,
    element,
    field_elements,
    group_element,
    numbers,
    pose,
    text_element,
)

UriOf = Callable[[Path, str], str]
"""Function that returns the URI to write, given a file and its original URI."""


def inertial(value: Inertial, added_mass: Sequence[float] = ()) -> Params | None:
    """Return `<inertial>` with its `<fluid_added_mass>`; None for the format's default."""
    if not added_mass and not value.given and value.mass == 1.0 and value.inertia == (1.0, 1.0, 1.0, 0.0, 0.0, 0.0):
        return None
    ixx, iyy, izz, ixy, ixz, iyz = value.inertia
    moments = {"ixx": ixx, "ixy": ixy, "ixz": ixz, "iyy": iyy, "iyz": iyz, "izz": izz}
    inertia = element("inertia", [text_element(k, v) for k, v in moments.items()])
    children = [pose(Pose(value.com)), text_element("mass", value.mass), inertia]
    if added_mass:
        names = zip(ADDED_MASS_NAMES, added_mass, strict=True)
        children.append(element("fluid_added_mass", [text_element(name, number) for name, number in names]))
    return element("inertial", children)


def geometry(shape: shapes.Geometry, uri_of: UriOf) -> Params:
    """Return `<geometry>`."""
    if isinstance(shape, shapes.Polyline):
        height = text_element("height", shape.height)
        outlines = ([*(text_element("point", point) for point in outline), height] for outline in shape.outlines)
        return element("geometry", [element("polyline", outline) for outline in outlines])
    if isinstance(shape, Mesh):
        return element("geometry", [_mesh(shape, uri_of)])
    if isinstance(shape, shapes.Heightmap):
        uri = text_element("uri", uri_of(shape.file, shape.uri))
        size, position = text_element("size", shape.size), text_element("pos", shape.position)
        return element("geometry", [element("heightmap", [uri, size, position])])
    names = [field.name for field in fields(shape)]  # field names of primitives equal SDF's names
    return element("geometry", [element(type(shape).__name__.lower(), field_elements(shape, *names))])


def _mesh(shape: Mesh, uri_of: UriOf) -> Params:
    part = element("submesh", [text_element("name", shape.submesh), text_element("center", shape.center)])
    pieces = element("convex_decomposition", [text_element("max_convex_hulls", f"{shape.max_hulls}")])
    children = [
        text_element("uri", shape.uri if shape.missing else uri_of(shape.file, shape.uri)),
        *changed_elements(shape, "scale"),
        part if shape.submesh or shape.center else None,
        pieces if shape.max_hulls != 16 else None,
    ]
    return element("mesh", children, **({"optimization": shape.optimization} if shape.optimization else {}))


def collision(value: SceneCollision, uri_of: UriOf) -> Params:
    """Return `<collision>`."""
    shape, light = geometry(value.geometry, uri_of), [*changed_elements(value, "laser_retro"), *_optics(value.optics)]
    return element("collision", [pose(value.pose_link), shape, surface(value.surface), *light], name=value.name)


def _optics(value: Optics) -> list[Params]:
    return changed_elements(value, "reflectivity", "transmittance", "specularity")


def _direction(value: Surface) -> Params | None:
    """Return `<fdir1>`, with the link of its frame as Gazebo's own attribute."""
    if not any(value.fdir1):
        return None
    frame = {"gz:expressed_in": value.fdir1_frame} if value.fdir1_frame else {}
    return element("fdir1", numbers(value.fdir1), **frame)


def surface(value: Surface) -> Params | None:
    """Return `<surface>`; None if all values are the format's defaults."""
    if replace(value, where=NOWHERE) == Surface():
        return None
    ode = [*field_elements(value, "mu", "mu2"), _direction(value), *changed_elements(value, "slip1", "slip2")]
    friction = [
        element("ode", ode),
        _torsional(value),
        group_element("bullet", [changed_element("rolling_friction", value.rolling, None)]),
    ]
    contact = [
        group_element("ode", changed_elements(value, "kp", "kd", "soft_cfm", "soft_erp", "min_depth", "max_vel")),
        _mask("collide_bitmask", value.collide_bitmask),
        _mask("category_bitmask", value.category_bitmask),
        *changed_elements(value, "collide_without_contact"),
    ]
    restitution = text_element("restitution_coefficient", value.restitution)
    bounce = element("bounce", [restitution, text_element("threshold", value.restitution_threshold)])
    has_bounce = (value.restitution, value.restitution_threshold) != (0.0, 1e5)
    blocks = [element("friction", friction), group_element("contact", contact), bounce if has_bounce else None]
    return element("surface", blocks)


def _torsional(value: Surface) -> Params | None:
    children = [
        changed_element("coefficient", value.torsional, None),
        *changed_elements(value, "use_patch_radius", "patch_radius", "surface_radius"),
        group_element("ode", [changed_element("slip", value.torsional_slip, 0.0)]),
    ]
    return group_element("torsional", children)


def _mask(name: str, bits: int) -> Params | None:
    return None if bits == 0xFFFF else element(name, f"0x{bits:x}")


def visual(value: SceneVisual, uri_of: UriOf) -> Params:
    """Return `<visual>`."""
    flags = None if value.visibility_flags == 0xFFFFFFFF else element("visibility_flags", str(value.visibility_flags))
    children = [
        pose(value.pose_link),
        geometry(value.geometry, uri_of),
        None if value.material is None else material(value.material, uri_of),
        *changed_elements(value, "transparency", "cast_shadows"),
        flags,
        *changed_elements(value, "laser_retro"),
        *_optics(value.optics),
        *(_visual_plugin(plugin(p), p.where.file, uri_of) for p in value.plugins),
    ]
    return element("visual", children, name=value.name)


def _visual_plugin(written: Params, file: str | None, uri_of: UriOf) -> Params:
    """Adapt the URI of the temperature image in a visual's plugin, which is from a file, to the new file."""
    for i, child in enumerate(written.children):
        if child.name == "heat_signature" and file and child.value:
            uri = uri_of(Path(file).parent / child.value, child.value)
            written.children[i] = text_element(child.name, uri)
    return written


def material(value: Material, uri_of: UriOf) -> Params:
    """Return `<material>` with all colours, so that no script is needed for them."""
    texture = None if value.texture is None else text_element("albedo_map", uri_of(value.texture, value.texture.name))
    metal = group_element("metal", [texture, *changed_elements(value, "roughness")])
    children = [
        element("script", [text_element("name", value.script)]) if value.script else None,
        *field_elements(value, "ambient", "diffuse", "specular", "emissive"),
        *changed_elements(value, "double_sided", "shininess"),
        group_element("pbr", [metal]),
    ]
    return element("material", children)


def light(value: SceneLight, at: Pose) -> Params:
    """Return `<light>`; `at` is its pose in the frame of its parent element."""
    names = ("range", "constant", "linear", "quadratic")
    fade = [text_element(n, v) for n, v in zip(names, value.attenuation, strict=True)]
    spot = [text_element(n, v) for n, v in zip(("inner_angle", "outer_angle", "falloff"), value.spot, strict=True)]
    children = [
        pose(at),
        *field_elements(value, "diffuse", "specular"),
        *changed_elements(value, "intensity"),
        *field_elements(value, "cast_shadows"),
        changed_element("light_on", value.on, True),
        *changed_elements(value, "irradiance"),
        element("attenuation", fade),
        element("spot", spot) if any(value.spot) else None,
        *field_elements(value, "direction"),
    ]
    return element("light", children, name=value.name, type=value.type)


def axis(value: Axis, name: str, kind: str, leader: str) -> Params:
    """Return `<axis>` or `<axis2>`; `leader` is the joint that it mimics, by its name in the model."""
    bounds = ("effort", "velocity") if kind == "continuous" else ("lower", "upper", "effort", "velocity")
    limit = [
        *field_elements(value, *(bound for bound in bounds if math.isfinite(getattr(value, bound)))),
        changed_element("stiffness", value.limit_stiffness, None),
        changed_element("dissipation", value.limit_dissipation, None),
    ]
    dynamics = [
        *changed_elements(value, "damping", "friction"),
        changed_element("spring_stiffness", value.stiffness, 0.0),
        changed_element("spring_reference", value.spring_ref, 0.0),
    ]
    children = [
        text_element("xyz", value.xyz_joint),
        group_element("limit", limit),
        group_element("dynamics", dynamics),
        None if value.mimic is None else _mimic(value.mimic, leader),
    ]
    return element(name, children)


def _mimic(value: Mimic, leader: str) -> Params:
    axis = {"axis": "axis2"} if value.axis else {}
    return element("mimic", field_elements(value, "multiplier", "offset", "reference"), joint=leader, **axis)


def sensor(value: SceneSensor, at: Pose) -> Params:
    """Return `<sensor>` as it was written; `at` is its pose in the frame of its link or joint."""
    children_of_file = [c for c in value.params.children if c.name not in ("pose", "plugin")]
    children = [c for c in (pose(at), *children_of_file, *(plugin(p) for p in value.plugins)) if c is not None]
    return Params("sensor", value.params.value, {**value.params.attributes, "name": value.name}, children)


def plugin(value: ScenePlugin) -> Params:
    """Return `<plugin>` or `<particle_emitter>` as it was written."""
    if value.params.name == "particle_emitter":
        return value.params
    attributes = {**value.params.attributes, "name": value.name, "filename": value.filename}
    return Params("plugin", value.params.value, attributes, value.params.children)
