"""Set the place on Earth of a world or of an entity for services."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from simkit.plugins.world.service_entities import RequestRefused, require_finite
from simkit.pose import Pose, quat_from_rpy
from simkit.scene import SphericalCoordinates
from simkit.sensors.environment.geodesy import WorldOnPlanet

if TYPE_CHECKING:
    from simkit.msgs import SetSphericalCoordinates_Request
    from simkit.runtime import Light, Model, Simulation

_MOON: Final = 1737400.0, 1737400.0  # semi-axes [m], as `<surface_model>MOON_SCS</surface_model>` has them
_EARTH: Final = 6378137.0, 6356752.314245  # of WGS 84


def set_world_location(sim: Simulation, request: SetSphericalCoordinates_Request) -> None:
    """Lays the world's origin somewhere else; sensors of position and field go by it from now on. Raises Refused."""
    latitude, longitude, elevation, heading = _numbers(request)
    surface = int(request.surface_model)
    if surface not in (0, 1):
        raise RequestRefused(f"found surface_model {surface}, allowed is 0 (EARTH_WGS84) or 1 (MOON_SCS)")
    name, (equatorial, polar) = ("EARTH_WGS84", _EARTH) if surface == 0 else ("MOON_SCS", _MOON)
    before = sim.control.origin.place or SphericalCoordinates(where=sim.world.where)
    sim.control.origin.move(
        replace(
            before,
            latitude=latitude,
            longitude=longitude,
            elevation=elevation,
            heading=heading,
            surface=name,
            equatorial=equatorial,
            polar=polar,
        )
    )


def set_entity_location(sim: Simulation, handle: Model | Light, request: SetSphericalCoordinates_Request) -> None:
    """Puts a model or a light at a place on the planet, upright, turned by the heading about z. Raises Refused."""

    if sim.control.origin.place is None:
        raise RequestRefused("the world has no spherical coordinates, by which an entity could be placed")
    latitude, longitude, elevation, heading = _numbers(request)
    planet = WorldOnPlanet(sim.control.origin.place)
    position = planet.axes.T @ (planet.ellipsoid.cartesian(latitude, longitude, elevation) - planet.origin)
    handle.set_pose(Pose(position, quat_from_rpy(0.0, 0.0, heading)))


def _numbers(request: SetSphericalCoordinates_Request) -> tuple[float, float, float, float]:
    """Latitude, longitude [rad], elevation [m], heading [rad]."""
    latitude = require_finite(request.latitude_deg, "latitude_deg")
    longitude = require_finite(request.longitude_deg, "longitude_deg")
    if not -90.0 <= latitude <= 90.0:
        raise RequestRefused(f"found latitude_deg {latitude:g}, allowed is a number from -90 to 90")
    elevation, heading = (
        require_finite(request.elevation, "elevation"),
        require_finite(request.heading_deg, "heading_deg"),
    )
    return math.radians(latitude), math.radians(longitude), elevation, math.radians(heading)
