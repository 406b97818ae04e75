"""Settings of a world as SDF elements: physics, scene, air, spherical coordinates."""

from __future__ import annotations

import math

from simkit.params import Params
from simkit.scene import Atmosphere, SceneWorld, SphericalCoordinates
from simkit.scene.world import Fog
from simkit.writers.xml_text import changed_element, changed_elements, element, field_elements, text_element


def physics_element(world: SceneWorld) -> Params:
    """Return `<physics>`."""
    children = [
        *field_elements(world.physics, "max_step_size", "real_time_factor"),
        changed_element("simkit:contact_law", world.physics.contact_law, "simkit"),
        *changed_elements(world.physics, "max_contacts"),
    ]
    return element("physics", children, name="default", type=world.physics.engine or "ode")


def scene_element(world: SceneWorld) -> Params:
    """Return `<scene>`."""
    around = world.surroundings
    children = [
        *field_elements(around, "ambient", "background", "shadows", "grid"),
        element("sky") if around.sky else None,
        None if around.fog is None else _fog(around.fog),
        *changed_elements(world, "quality", "renderer"),
    ]
    return element("scene", children)


def _fog(fog: Fog) -> Params:
    return element("fog", [text_element("color", fog.colour), *field_elements(fog, "type", "start", "end", "density")])


def atmosphere_element(air: Atmosphere) -> Params:
    """Return `<atmosphere>`."""
    children = field_elements(air, "temperature", "temperature_gradient", "pressure")
    return element("atmosphere", children, type="adiabatic")


def spherical_coordinates_element(place: SphericalCoordinates | None) -> Params | None:
    """Return `<spherical_coordinates>`; None without coordinates."""
    if place is None:
        return None
    custom = place.surface == "CUSTOM_SURFACE"
    children = [
        text_element("surface_model", place.surface),
        text_element("surface_axis_equatorial", place.equatorial) if custom else None,
        text_element("surface_axis_polar", place.polar) if custom else None,
        text_element("world_frame_orientation", "ENU"),
        text_element("latitude_deg", math.degrees(place.latitude)),
        text_element("longitude_deg", math.degrees(place.longitude)),
        *field_elements(place, "elevation"),
        text_element("heading_deg", math.degrees(place.heading)),
    ]
    return element("spherical_coordinates", children)
