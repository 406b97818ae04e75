"""Reader of `<light>` in a world or a link."""

from __future__ import annotations

import math

from simkit.diagnostics import did_you_mean
from simkit.loaders.sdf.entity_names import scoped as join
from simkit.loaders.sdf.load_context import NamedElement
from simkit.loaders.sdf.material import read_colour
from simkit.params import LARGEST, Params
from simkit.pose import Pose
from simkit.scene import SceneLight
from simkit.scene.geometry import Vec3, vec3

_TYPES = ("point", "spot", "directional")


def read_lights(part: NamedElement, link: str, link_world: Pose) -> tuple[SceneLight, ...]:
    """Return the lights of a link.

    Args:
        part: the link.
        link: scoped name of the link.
        link_world: pose of the link in the world.
    """
    return tuple(
        read_light(e, name, link_world @ part.pose_of(e, f"light {name!r}"), link) for name, e in part.named("light")
    )


def read_light(element: Params, name: str, pose_world: Pose, link: str = "") -> SceneLight:
    """Return a light with an already resolved pose; `link` is the scoped name of the link that carries it."""
    kind = element.attribute("type")
    if not kind:
        message = f"<light name={name!r}> needs type= ({', '.join(_TYPES)}); it is read as a point light"
        element.warning("SK-SDF-039", message)
        kind = "point"
    if kind not in _TYPES:
        message = f"light {name!r} has unknown type {kind!r}; known are {', '.join(_TYPES)}"
        element.error("SK-SDF-025", message, did_you_mean(kind, _TYPES))
        kind = "point"
    element.child("pose")
    direction = _direction(element, name)
    fade, spot = element.block("attenuation"), element.block("spot")
    element.child("visualize")
    return SceneLight(
        name=name,
        scoped=join(link, name),
        type=kind,
        pose_world=pose_world,
        direction=direction,
        direction_world=vec3(pose_world.rotate(direction)),
        link=link,
        diffuse=read_colour(element, "diffuse", (1.0, 1.0, 1.0, 1.0)),
        specular=read_colour(element, "specular", (0.1, 0.1, 0.1, 1.0)),
        intensity=element.number("intensity", 1.0, minimum=0),
        attenuation=(
            fade.number("range", 10.0, finite=False),
            fade.number("constant", 1.0),
            fade.number("linear", 1.0),
            fade.number("quadratic", 0.0),
        ),
        spot=(spot.number("inner_angle", 0.0), spot.number("outer_angle", 0.0), spot.number("falloff", 0.0)),
        cast_shadows=element.boolean("cast_shadows", False),
        on=element.boolean("light_on", True),
        where=element.where,
        irradiance=element.number("irradiance", minimum=0, maximum=LARGEST) if element.has("irradiance") else None,
    )


def _direction(element: Params, name: str) -> Vec3:
    x, y, z = element.vector3("direction", (0.0, 0.0, -1.0))
    length = math.sqrt(x * x + y * y + z * z)
    if length < 1e-12:
        element.error("SK-SDF-025", f"light {name!r} has a direction of length zero")
        return (0.0, 0.0, -1.0)
    return (x / length, y / length, z / length)
