"""Settings of a world as SDF elements: physics, scene, spherical coordinates."""

from __future__ import annotations

import math

from simkit.params import Params
from simkit.scene import SceneWorld, SphericalCoordinates
from simkit.scene.world import Fog
from simkit.writers.sdf_elements import changed_element, optional_number_element, text_element
from simkit.writers.xml_text import element


def physics_element(world: SceneWorld) -> Params:
    """`<physics>`."""
    physics = world.physics
    children = [
        text_element("max_step_size", physics.max_step_size),
        text_element("real_time_factor", physics.real_time_factor),
        None if physics.contact_law == "simkit" else text_element("simkit:contact_law", physics.contact_law),
        None if physics.max_contacts == 20 else text_element("max_contacts", str(physics.max_contacts)),
    ]
    return element("physics", "", children, name="default", type="ode")


def scene_element(world: SceneWorld) -> Params:
    """`<scene>`."""
    around = world.surroundings
    return element(
        "scene",
        "",
        [
            text_element("ambient", around.ambient),
            text_element("background", around.background),
            text_element("shadows", around.shadows),
            text_element("grid", around.grid),
            element("sky") if around.sky else None,
            None if around.fog is None else _fog(around.fog),
            changed_element("quality", world.quality, "fast"),
        ],
    )


def _fog(fog: Fog) -> Params:
    return element(
        "fog",
        "",
        [
            text_element("color", fog.colour),
            text_element("type", fog.type),
            text_element("start", fog.start),
            text_element("end", fog.end),
            text_element("density", fog.density),
        ],
    )


def spherical_coordinates_element(place: SphericalCoordinates) -> Params:
    """`<spherical_coordinates>`."""
    custom = place.surface == "CUSTOM_SURFACE"
    return element(
        "spherical_coordinates",
        "",
        [
            text_element("surface_model", place.surface),
            optional_number_element("surface_axis_equatorial", place.equatorial if custom else None),
            optional_number_element("surface_axis_polar", place.polar if custom else None),
            text_element("world_frame_orientation", "ENU"),
            text_element("latitude_deg", math.degrees(place.latitude)),
            text_element("longitude_deg", math.degrees(place.longitude)),
            text_element("elevation", place.elevation),
            text_element("heading_deg", math.degrees(place.heading)),
        ],
    )
