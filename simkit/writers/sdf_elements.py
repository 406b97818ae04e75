"""What is in a link or joint, as SDF elements: shapes, looks, surfaces, lights, axes, sensors, plugins."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from simkit.diagnostics import NOWHERE
from simkit.params import Params
from simkit.pose import Pose
from simkit.scene import (
    Axis,
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Geometry,
    Heightmap,
    Inertial,
    Material,
    Mesh,
    Plane,
    Polyline,
    SceneCollision,
    SceneLight,
    ScenePlugin,
    SceneSensor,
    SceneVisual,
    Sphere,
    Surface,
)
from simkit.writers.xml_text import element, number, numbers, pose

Place = Callable[[Path, str], str]
"""Gives the URI to write for a file that was named by some other."""


def text_element(name: str, value: str | float | bool | tuple[float, ...]) -> Params:
    """An element with a value."""
    if isinstance(value, bool):
        return element(name, str(value).lower())
    if isinstance(value, tuple):
        return element(name, numbers(value))
    return element(name, value if isinstance(value, str) else number(value))


def optional_number_element(name: str, value: float | None) -> Params | None:
    """An element for a number that was given."""
    return None if value is None else text_element(name, value)


def changed_element(name: str, value: str | float | bool | tuple[float, ...], usual: object) -> Params | None:
    """An element for a value that is not the format's own."""
    return None if value == usual else text_element(name, value)


def inertial(value: Inertial) -> Params | None:
    """None where the format's default is meant."""
    if not value.given and value.mass == 1.0 and value.inertia == (1.0, 1.0, 1.0, 0.0, 0.0, 0.0):
        return None
    ixx, iyy, izz, ixy, ixz, iyz = value.inertia
    names = {"ixx": ixx, "ixy": ixy, "ixz": ixz, "iyy": iyy, "iyz": iyz, "izz": izz}
    return element(
        "inertial",
        "",
        [
            pose(Pose(value.com)),
            text_element("mass", value.mass),
            element("inertia", "", [text_element(k, v) for k, v in names.items()]),
        ],
    )


def geometry(shape: Geometry, place: Place) -> Params:
    """`<geometry>`."""
    return element("geometry", "", _shapes(shape, place))


def _shapes(shape: Geometry, place: Place) -> list[Params]:
    match shape:
        case Box(size=size):
            return [element("box", "", [text_element("size", size)])]
        case Sphere(radius=r):
            return [element("sphere", "", [text_element("radius", r)])]
        case Cylinder(radius=r, length=h) | Capsule(radius=r, length=h) | Cone(radius=r, length=h):
            return [element(type(shape).__name__.lower(), "", [text_element("radius", r), text_element("length", h)])]
        case Ellipsoid(radii=radii):
            return [element("ellipsoid", "", [text_element("radii", radii)])]
        case Plane(normal=normal, size=size):
            return [element("plane", "", [text_element("normal", normal), text_element("size", size)])]
        case Heightmap():
            uri = text_element("uri", place(shape.file, shape.uri))
            return [
                element("heightmap", "", [uri, text_element("size", shape.size), text_element("pos", shape.position)])
            ]
        case Polyline(outlines=outlines, height=height):
            return [
                element(
                    "polyline",
                    "",
                    [*(text_element("point", point) for point in outline), text_element("height", height)],
                )
                for outline in outlines
            ]
        case Mesh():
            return [_mesh(shape, place)]
    return [element("empty")]


def _mesh(shape: Mesh, place: Place) -> Params:
    part = element("submesh", "", [text_element("name", shape.submesh), text_element("center", shape.center)])
    pieces = element("convex_decomposition", "", [text_element("max_convex_hulls", f"{shape.max_hulls}")])
    mesh = element(
        "mesh",
        "",
        [
            text_element("uri", shape.uri if shape.missing else place(shape.file, shape.uri)),
            changed_element("scale", shape.scale, (1.0, 1.0, 1.0)),
            part if shape.submesh or shape.center else None,
            pieces if shape.max_hulls != 16 else None,
        ],
    )
    if shape.optimization:
        mesh.attributes["optimization"] = shape.optimization
    return mesh


def collision(value: SceneCollision, place: Place) -> Params:
    """`<collision>`."""
    return element(
        "collision",
        "",
        [
            pose(value.pose_link),
            geometry(value.geometry, place),
            surface(value.surface),
            changed_element("laser_retro", value.laser_retro, 0.0),
        ],
        name=value.name,
    )


def _direction(value: Surface) -> Params | None:
    """`<fdir1>`, and the link that it is told in, as Gazebo's own attribute."""
    if not any(value.fdir1):
        return None
    frame = {"gz:expressed_in": value.fdir1_frame} if value.fdir1_frame else {}
    return element("fdir1", numbers(value.fdir1), **frame)


def surface(value: Surface) -> Params | None:
    """`<surface>`; None where all is the format's default."""
    if replace(value, where=NOWHERE) == Surface():
        return None
    ode = [
        text_element("mu", value.mu),
        text_element("mu2", value.mu2),
        _direction(value),
        changed_element("slip1", value.slip1, 0.0),
        changed_element("slip2", value.slip2, 0.0),
    ]
    friction = [
        element("ode", "", ode),
        _torsional(value),
        None if value.rolling is None else element("bullet", "", [text_element("rolling_friction", value.rolling)]),
    ]
    names = ("kp", "kd", "soft_cfm", "soft_erp", "min_depth", "max_vel")
    soft = [e for name in names if (e := optional_number_element(name, getattr(value, name))) is not None]
    contact = [
        element("ode", "", soft) if soft else None,
        _mask("collide_bitmask", value.collide_bitmask),
        _mask("category_bitmask", value.category_bitmask),
        changed_element("collide_without_contact", value.collide_without_contact, False),
    ]
    bounce = [
        text_element("restitution_coefficient", value.restitution),
        text_element("threshold", value.restitution_threshold),
    ]
    has_bounce = (value.restitution, value.restitution_threshold) != (0.0, 1e5)
    return element(
        "surface",
        "",
        [
            element("friction", "", friction),
            element("contact", "", contact) if any(contact) else None,
            element("bounce", "", bounce) if has_bounce else None,
        ],
    )


def _torsional(value: Surface) -> Params | None:
    children = [
        optional_number_element("coefficient", value.torsional),
        changed_element("use_patch_radius", value.use_patch_radius, True),
        changed_element("patch_radius", value.patch_radius, 0.0),
        changed_element("surface_radius", value.surface_radius, 0.0),
        element("ode", "", [text_element("slip", value.torsional_slip)]) if value.torsional_slip else None,
    ]
    return element("torsional", "", children) if any(children) else None


def _mask(name: str, bits: int) -> Params | None:
    return None if bits == 0xFFFF else element(name, f"0x{bits:x}")


def visual(value: SceneVisual, place: Place) -> Params:
    """`<visual>`."""
    flags = None if value.visibility_flags == 0xFFFFFFFF else element("visibility_flags", str(value.visibility_flags))
    return element(
        "visual",
        "",
        [
            pose(value.pose_link),
            geometry(value.geometry, place),
            None if value.material is None else material(value.material, place),
            changed_element("transparency", value.transparency, 0.0),
            changed_element("cast_shadows", value.cast_shadows, True),
            flags,
            changed_element("laser_retro", value.laser_retro, 0.0),
            *(_of_visual(plugin(p), place) for p in value.plugins),
        ],
        name=value.name,
    )


def _of_visual(written: Params, place: Place) -> Params:
    """A visual's plugin with the picture of its temperatures named from the new file's place."""
    children = [
        text_element(c.name, place(Path(c.where.file).parent / c.value, c.value))
        if c.name == "heat_signature" and c.where.file and c.value
        else c
        for c in written.children
    ]
    return element(written.name, written.value, children, **written.attributes)


def material(value: Material, place: Place) -> Params:
    """`<material>`, with every colour written out so that no script is needed for them."""
    metal = [
        None if value.texture is None else text_element("albedo_map", place(value.texture, value.texture.name)),
        optional_number_element("roughness", value.roughness),
    ]
    return element(
        "material",
        "",
        [
            element("script", "", [text_element("name", value.script)]) if value.script else None,
            text_element("ambient", value.ambient),
            text_element("diffuse", value.diffuse),
            text_element("specular", value.specular),
            text_element("emissive", value.emissive),
            text_element("double_sided", value.double_sided) if value.double_sided else None,
            optional_number_element("shininess", value.shininess),
            element("pbr", "", [element("metal", "", metal)]) if any(metal) else None,
        ],
    )


def light(value: SceneLight, at: Pose) -> Params:
    """`<light>`; `at` is its pose in the frame of what holds it."""
    names = ("range", "constant", "linear", "quadratic")
    fade = [text_element(n, v) for n, v in zip(names, value.attenuation, strict=True)]
    spot = [text_element(n, v) for n, v in zip(("inner_angle", "outer_angle", "falloff"), value.spot, strict=True)]
    return element(
        "light",
        "",
        [
            pose(at),
            text_element("diffuse", value.diffuse),
            text_element("specular", value.specular),
            changed_element("intensity", value.intensity, 1.0),
            text_element("cast_shadows", value.cast_shadows),
            changed_element("light_on", value.on, True),
            None if value.irradiance is None else text_element("irradiance", value.irradiance),
            element("attenuation", "", fade),
            element("spot", "", spot) if any(value.spot) else None,
            text_element("direction", value.direction),
        ],
        name=value.name,
        type=value.type,
    )


def axis(value: Axis, name: str, kind: str, leader: str) -> Params:
    """`<axis>` or `<axis2>`; `leader` is the joint that it mimics, seen from its model."""
    bounds = {} if kind == "continuous" else {"lower": value.lower, "upper": value.upper}
    limits = {**bounds, "effort": value.effort, "velocity": value.velocity}
    limit = [text_element(k, v) for k, v in limits.items() if math.isfinite(v)]
    limit += [
        e
        for e in (
            optional_number_element("stiffness", value.limit_stiffness),
            optional_number_element("dissipation", value.limit_dissipation),
        )
        if e is not None
    ]
    dynamics = [
        changed_element("damping", value.damping, 0.0),
        changed_element("friction", value.friction, 0.0),
        changed_element("spring_stiffness", value.stiffness, 0.0),
        changed_element("spring_reference", value.spring_ref, 0.0),
    ]
    mimic = None
    if value.mimic is not None:
        m = value.mimic
        parts = [
            text_element("multiplier", m.multiplier),
            text_element("offset", m.offset),
            text_element("reference", m.reference),
        ]
        mimic = element("mimic", "", parts, joint=leader, **({"axis": "axis2"} if m.axis else {}))
    return element(
        name,
        "",
        [
            text_element("xyz", value.xyz_joint),
            element("limit", "", limit) if limit else None,
            element("dynamics", "", dynamics) if any(dynamics) else None,
            mimic,
        ],
    )


def sensor(value: SceneSensor, at: Pose) -> Params:
    """`<sensor>` as it was written, with its own pose; `at` is in the frame of its link or joint."""
    kept = [c for c in value.params.children if c.name not in ("pose", "plugin")]
    children = [pose(at), *kept, *(plugin(p) for p in value.plugins)]
    attributes = {**value.params.attributes, "name": value.name}
    return element("sensor", value.params.value, children, **attributes)


def plugin(value: ScenePlugin) -> Params:
    """`<plugin>` as it was written."""
    attributes = {**value.params.attributes, "name": value.name, "filename": value.filename}
    return element("plugin", value.params.value, value.params.children, **attributes)
