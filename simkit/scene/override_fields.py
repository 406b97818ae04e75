"""Values of the scene's entities that overrides can set, with their units, by the path of their SDF elements."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Final

from simkit.run_spec import RENDERERS
from simkit.scene.geometry import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Heightmap,
    Mesh,
    Plane,
    Polyline,
    Sphere,
    six,
    vec3,
)
from simkit.scene.model import (
    DEFAULT_REFLECTIVITY,
    Inertial,
    SceneCollision,
    SceneJoint,
    SceneLight,
    SceneLink,
    SceneModel,
    SceneSensor,
    SceneVisual,
)
from simkit.scene.override_values import (
    DIRECTION,
    FLAG,
    RGB,
    RGBA,
    TEXT,
    ValueKind,
    choice,
    integer,
    number,
    vector,
)
from simkit.scene.world import CONTACT_LAWS, QUALITIES, SceneActor, SceneWorld


@dataclass(frozen=True, slots=True)
class Field:
    """Value of an entity.

    Attributes:
        element: path of the value below the entity, with dots.
        kind: kind of the value.
        read: function that returns the value of an entity; None if the entity has no such value.
        write: function that returns a copy of an entity with another value.
    """

    element: str
    kind: ValueKind
    read: Callable[[Any], object]
    write: Callable[[Any, Any], object]


def _read_attribute(entity: Any, path: list[str]) -> object:
    for name in path:
        entity = entity[int(name)] if name.isdigit() else getattr(entity, name)
        if entity is None:
            return None
    return entity


def _write_attribute(entity: Any, path: list[str], value: object) -> Any:
    name, *rest = path
    if name.isdigit():
        number_ = int(name)
        changed = _write_attribute(entity[number_], rest, value) if rest else value
        return (*entity[:number_], changed, *entity[number_ + 1 :])
    return replace(entity, **{name: _write_attribute(getattr(entity, name), rest, value) if rest else value})


def _field(element: str, kind: ValueKind, attribute: str = "") -> Field:
    """Return the field of a dataclass attribute; the attribute's path has dots and the numbers of list items."""
    path = (attribute or element).split(".")
    return Field(
        element, kind, lambda entity: _read_attribute(entity, path), lambda entity, v: _write_attribute(entity, path, v)
    )


_LENGTH, _ANGLE, _SHARE = number("m", above=0.0), number("rad"), number("", minimum=0.0)
_SIZE: Final = vector("m", "x y z", above=0.0)
_ANY_LENGTH: Final = number("m")

PHYSICS: Final = (
    _field("max_step_size", number("s", above=0.0), "physics.max_step_size"),
    _field("real_time_factor", number("", minimum=0.0), "physics.real_time_factor"),
    _field("max_contacts", integer(1), "physics.max_contacts"),
    _field("sleep", FLAG, "physics.sleep"),
    _field("contact_law", choice(CONTACT_LAWS), "physics.contact_law"),
)

WORLD: Final = (
    _field("gravity", vector("m/s²", "x y z")),
    _field("magnetic_field", vector("T", "x y z")),
    _field("wind", vector("m/s", "x y z")),
    _field("atmosphere.temperature", number("K", above=0.0)),
    _field("atmosphere.temperature_gradient", number("K/m")),
    _field("atmosphere.pressure", number("Pa", above=0.0)),
    _field("spherical_coordinates.latitude", _ANGLE),
    _field("spherical_coordinates.longitude", _ANGLE),
    _field("spherical_coordinates.elevation", _ANY_LENGTH),
    _field("spherical_coordinates.heading", _ANGLE),
)

SCENE: Final = (
    _field("quality", choice(QUALITIES)),
    _field("renderer", choice(RENDERERS)),
    _field("shadows", FLAG, "surroundings.shadows"),
    _field("sky", FLAG, "surroundings.sky"),
    _field("grid", FLAG, "surroundings.grid"),
    _field("ambient", RGB, "surroundings.ambient"),
    _field("background", RGB, "surroundings.background"),
    _field("fog.color", RGBA, "surroundings.fog.colour"),
    _field("fog.start", _ANY_LENGTH, "surroundings.fog.start"),
    _field("fog.end", _ANY_LENGTH, "surroundings.fog.end"),
    _field("fog.density", number("1/m", minimum=0.0), "surroundings.fog.density"),
)

_MODEL: Final = (_field("static", FLAG), _field("self_collide", FLAG), _field("allow_auto_disable", FLAG))

ACTOR: Final = (
    _field("loop", FLAG),
    _field("delay_start", number("s", minimum=0.0)),
    _field("auto_start", FLAG),
    _field("skin_scale", number("", above=0.0)),
)


def _set_mass(link: SceneLink, mass: float) -> SceneLink:
    """Return a link with another mass; its inertia changes in proportion."""
    return replace(link, inertial=with_mass(link.inertial, mass))


def with_mass(old: Inertial, mass: float) -> Inertial:
    """Return another mass [kg] with an inertia that changes in proportion."""
    scale = mass / old.mass if old.mass > 0.0 else 1.0
    return Inertial(mass, old.com, six(scale * moment for moment in old.inertia))


MASS: Final = "inertial.mass"
INERTIA: Final = "inertial.inertia"

_LINK: Final = (
    Field(MASS, number("kg", above=0.0), lambda link: link.inertial.mass, _set_mass),
    _field("inertial.com", vector("m", "x y z")),
    _field(INERTIA, vector("kg·m²", "ixx iyy izz ixy ixz iyz")),
    _field("gravity", FLAG),
    _field("kinematic", FLAG),
    _field("self_collide", FLAG),
    _field("enable_wind", FLAG),
    _field("velocity_decay.linear", _SHARE, "velocity_decay.0"),
    _field("velocity_decay.angular", _SHARE, "velocity_decay.1"),
)

MU: Final = "surface.friction.ode.mu"
MU2: Final = "surface.friction.ode.mu2"


def _set_mu(collision: SceneCollision, mu: float) -> SceneCollision:
    """Return a collision with another friction along and across its direction."""
    return replace(collision, surface=replace(collision.surface, mu=mu, mu2=mu))


def _given(name: str) -> Callable[[SceneCollision], float]:
    """Return a function that reads a property of a surface; 0 if the file gives no value."""
    return lambda collision: getattr(collision.surface, name) or 0.0


def _reflectivity(shape: SceneCollision | SceneVisual) -> float:
    """Return the reflectivity of a surface, or the value of a surface without one."""
    value = shape.optics.reflectivity
    return DEFAULT_REFLECTIVITY if value is None else value


def _optional(element: str, unit: str, name: str) -> Field:
    write = _field(element, TEXT, f"surface.{name}").write
    return Field(element, number(unit, minimum=0.0), _given(name), write)


_COEFFICIENT: Final = number("", minimum=0.0)
_OPTICS: Final = (
    Field("reflectivity", _COEFFICIENT, _reflectivity, _field("reflectivity", TEXT, "optics.reflectivity").write),
    _field("transmittance", _SHARE, "optics.transmittance"),
    _field("specularity", _SHARE, "optics.specularity"),
)
_SURFACE: Final = (
    Field(MU, _COEFFICIENT, lambda collision: collision.surface.mu, _set_mu),
    _field(MU2, _COEFFICIENT, "surface.mu2"),
    _field("surface.friction.ode.fdir1", vector("", "x y z"), "surface.fdir1"),
    _field("surface.friction.ode.slip1", number("m/s/N", minimum=0.0), "surface.slip1"),
    _field("surface.friction.ode.slip2", number("m/s/N", minimum=0.0), "surface.slip2"),
    _optional("surface.friction.torsional.coefficient", "", "torsional"),
    _field("surface.friction.torsional.patch_radius", number("m", minimum=0.0), "surface.patch_radius"),
    _field("surface.friction.torsional.surface_radius", number("m", minimum=0.0), "surface.surface_radius"),
    _optional("surface.friction.bullet.rolling_friction", "", "rolling"),
    _field("surface.bounce.restitution_coefficient", _COEFFICIENT, "surface.restitution"),
    _field("surface.bounce.threshold", number("m/s", minimum=0.0), "surface.restitution_threshold"),
    _optional("surface.contact.ode.kp", "N/m", "kp"),
    _optional("surface.contact.ode.kd", "N·s/m", "kd"),
    _optional("surface.contact.ode.min_depth", "m", "min_depth"),
    _optional("surface.contact.ode.max_vel", "m/s", "max_vel"),
    _field("surface.contact.collide_bitmask", integer(0), "surface.collide_bitmask"),
    _field("surface.contact.category_bitmask", integer(0), "surface.category_bitmask"),
    _field("laser_retro", number("")),
    *_OPTICS,
)

_VISUAL: Final = (
    _field("transparency", number("", minimum=0.0)),
    _field("cast_shadows", FLAG),
    _field("laser_retro", number("")),
    *_OPTICS,
    _field("visibility_flags", integer(0)),
    _field("material.ambient", RGBA),
    _field("material.diffuse", RGBA),
    _field("material.specular", RGBA),
    _field("material.emissive", RGBA),
)

_GEOMETRY: Final[dict[type, tuple[Field, ...]]] = {
    Box: (_field("geometry.box.size", _SIZE, "geometry.size"),),
    Sphere: (_field("geometry.sphere.radius", _LENGTH, "geometry.radius"),),
    Cylinder: (
        _field("geometry.cylinder.radius", _LENGTH, "geometry.radius"),
        _field("geometry.cylinder.length", _LENGTH, "geometry.length"),
    ),
    Capsule: (
        _field("geometry.capsule.radius", _LENGTH, "geometry.radius"),
        _field("geometry.capsule.length", _LENGTH, "geometry.length"),
    ),
    Cone: (
        _field("geometry.cone.radius", _LENGTH, "geometry.radius"),
        _field("geometry.cone.length", _LENGTH, "geometry.length"),
    ),
    Ellipsoid: (_field("geometry.ellipsoid.radii", _SIZE, "geometry.radii"),),
    Plane: (
        _field("geometry.plane.normal", DIRECTION, "geometry.normal"),
        _field("geometry.plane.size", vector("m", "x y", above=0.0), "geometry.size"),
    ),
    Mesh: (_field("geometry.mesh.scale", vector("", "x y z"), "geometry.scale"),),
    Heightmap: (
        _field("geometry.heightmap.size", _SIZE, "geometry.size"),
        _field("geometry.heightmap.pos", vector("m", "x y z"), "geometry.position"),
    ),
    Polyline: (_field("geometry.polyline.height", _LENGTH, "geometry.height"),),
}

_PART_UNITS: Final = {False: ("rad", "N·m"), True: ("m", "N")}  # of an axis, by whether it is a sliding one


def _axis_fields(axis: str, index: int, slides: bool, has_mimic: bool) -> tuple[Field, ...]:
    """Return the fields of one axis of a joint, `axis` or `axis2`."""
    place, effort = _PART_UNITS[slides]
    limit, some = number(place, infinite=True), f"axes.{index}"
    fields_: tuple[Field, ...] = (
        _field(f"{axis}.limit.lower", limit, f"{some}.lower"),
        _field(f"{axis}.limit.upper", limit, f"{some}.upper"),
        _field(f"{axis}.limit.effort", number(effort, infinite=True), f"{some}.effort"),
        _field(f"{axis}.limit.velocity", number(f"{place}/s", infinite=True), f"{some}.velocity"),
        _field(f"{axis}.dynamics.damping", number(f"{effort}·s/{place}"), f"{some}.damping"),
        _field(f"{axis}.dynamics.friction", number(effort), f"{some}.friction"),
        _field(f"{axis}.dynamics.spring_stiffness", number(f"{effort}/{place}"), f"{some}.stiffness"),
        _field(f"{axis}.dynamics.spring_reference", number(place), f"{some}.spring_ref"),
        Field(
            f"{axis}.xyz",
            DIRECTION,
            lambda joint: joint.axes[index].xyz_joint,
            lambda joint, value: _turn_axis(joint, index, value),
        ),
    )
    if has_mimic:
        fields_ += (
            _field(f"{axis}.mimic.multiplier", number(), f"{some}.mimic.multiplier"),
            _field(f"{axis}.mimic.offset", number(place), f"{some}.mimic.offset"),
        )
    return fields_


def _turn_axis(joint: SceneJoint, index: int, value: tuple[float, ...]) -> SceneJoint:
    """Return a joint with another axis, given in the joint frame."""
    xyz = vec3(value)
    world = vec3(joint.pose_world.rotate(xyz))
    axes = (replace(a, xyz_joint=xyz, xyz_world=world) if i == index else a for i, a in enumerate(joint.axes))
    return replace(joint, axes=tuple(axes))


def _joint_fields(joint: SceneJoint) -> tuple[Field, ...]:
    fields: list[Field] = []
    for index, axis in enumerate(joint.axes[:2]):
        slides = joint.type == "prismatic" or (joint.type == "planar")
        fields += _axis_fields("axis2" if index else "axis", index, slides, axis.mimic is not None)
    if joint.type == "screw":
        fields.append(_field("thread_pitch", number("m")))
    if joint.type == "gearbox":
        fields.append(_field("gearbox_ratio", number()))
    return tuple(fields)


def _set_direction(light: SceneLight, value: tuple[float, ...]) -> SceneLight:
    direction = vec3(value)
    return replace(light, direction=direction, direction_world=vec3(light.pose_world.rotate(direction)))


_LIGHT: Final = (
    _field("intensity", number("", minimum=0.0)),
    _field("cast_shadows", FLAG),
    _field("on", FLAG),
    _field("diffuse", RGBA),
    _field("specular", RGBA),
    _field("irradiance", number("W/m²", minimum=0.0)),
    Field("direction", DIRECTION, lambda light: light.direction, _set_direction),
    _field("attenuation.range", number("m", minimum=0.0, infinite=True), "attenuation.0"),
    _field("attenuation.constant", number(""), "attenuation.1"),
    _field("attenuation.linear", number("1/m"), "attenuation.2"),
    _field("attenuation.quadratic", number("1/m²"), "attenuation.3"),
)
_SPOT: Final = (
    _field("spot.inner_angle", _ANGLE, "spot.0"),
    _field("spot.outer_angle", _ANGLE, "spot.1"),
    _field("spot.falloff", number(""), "spot.2"),
)

_SENSOR: Final = (_field("update_rate", number("Hz", minimum=0.0), "rate"), _field("topic", TEXT))


def fields_of(entity: object) -> tuple[Field, ...]:
    """Return the values of an entity that overrides can set, without its pose and its free parameters."""
    match entity:
        case SceneModel():
            return _MODEL
        case SceneLink():
            return _LINK
        case SceneCollision():
            return (*_GEOMETRY.get(type(entity.geometry), ()), *_SURFACE)
        case SceneVisual():
            return (*_GEOMETRY.get(type(entity.geometry), ()), *_VISUAL)
        case SceneJoint():
            return _joint_fields(entity)
        case SceneLight():
            return (*_LIGHT, *_SPOT) if entity.type == "spot" else _LIGHT
        case SceneSensor():
            return _SENSOR
        case SceneActor():
            return ACTOR
        case SceneWorld():
            return ()
    return ()
