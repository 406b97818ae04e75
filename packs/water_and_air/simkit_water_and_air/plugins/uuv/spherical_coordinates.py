"""Services of uuv_simulator and dave between positions in the world and on the Earth.

Services and types are those of `SphericalCoordinatesROSInterfacePlugin.cc` and dave's
`spherical_coordinates_interface.cpp`.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params, WorldPlugin
from simkit.extend import offers
from simkit.linear_algebra import matmul
from simkit.scene import SphericalCoordinates
from simkit.sensors.environment.geodesy import WorldOnPlanet

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit.msgs import Message

_NAMES: Final = {
    "get_origin_spherical_coordinates": "GetOriginSphericalCoord",
    "set_origin_spherical_coordinates": "SetOriginSphericalCoord",
    "transform_to_spherical_coordinates": "TransformToSphericalCoord",
    "transform_from_spherical_coordinates": "TransformFromSphericalCoord",
}


class SphericalCoordinatesServices(WorldPlugin):
    """Converts positions in the world [m] to latitude and longitude [degrees] and back, and moves the world's origin.

    The services are `/gazebo/get_origin_spherical_coordinates`, `set_…`, `/gazebo/transform_to_spherical_coordinates`
    and `transform_from_…`. A world without `<spherical_coordinates>` is at latitude 0 and longitude 0, as in Gazebo.
    """

    package = "uuv_world_ros_plugins_msgs"
    endpoints = tuple(
        offers(f"/gazebo/{name}", f"uuv_world_ros_plugins_msgs/srv/{kind}") for name, kind in _NAMES.items()
    )
    filenames = ("libuuv_sc_ros_interface_plugin.so",)

    def load(self, parent: Simulation, params: Params) -> None:
        for name, kind in _NAMES.items():
            self.offer(f"/gazebo/{name}", f"{self.package}/srv/{kind}", getattr(self, f"_{name}"))

    @property
    def _place(self) -> SphericalCoordinates:
        return self.sim.control.origin.place or SphericalCoordinates()

    def _get_origin_spherical_coordinates(self, _: Message) -> dict[str, object]:
        place = self._place
        return _degrees(place.latitude, place.longitude, place.elevation)

    def _set_origin_spherical_coordinates(self, request: Message) -> dict[str, object]:
        values = float(request.latitude_deg), float(request.longitude_deg), float(request.altitude)
        is_valid = abs(values[0]) <= 90.0 and all(map(math.isfinite, values))
        if is_valid:
            latitude, longitude = math.radians(values[0]), math.radians(values[1])
            self.sim.control.origin.move(
                replace(self._place, latitude=latitude, longitude=longitude, elevation=values[2])
            )
        return {"success": is_valid}

    def _transform_to_spherical_coordinates(self, request: Message) -> dict[str, object]:
        point = np.array((request.input.x, request.input.y, request.input.z))
        return _degrees(*WorldOnPlanet(self._place).geodetic(point))

    def _transform_from_spherical_coordinates(self, request: Message) -> dict[str, object]:
        planet = WorldOnPlanet(self._place)
        latitude, longitude = math.radians(request.latitude_deg), math.radians(request.longitude_deg)
        on_planet = planet.ellipsoid.cartesian(latitude, longitude, float(request.altitude))
        x, y, z = matmul(planet.axes.T, on_planet - planet.origin).tolist()
        return {"output": {"x": x, "y": y, "z": z}}


class DaveSphericalCoordinatesServices(SphericalCoordinatesServices):
    """Has the services of `libuuv_sc_ros_interface_plugin.so`, with the types of dave."""

    package = "dave_gazebo_ros_plugins"
    endpoints = tuple(offers(f"/gazebo/{name}", f"dave_gazebo_ros_plugins/srv/{kind}") for name, kind in _NAMES.items())
    filenames = ("libdave_sc_coordinates_interface.so",)


def _degrees(latitude: float, longitude: float, height: float) -> dict[str, object]:
    return {"latitude_deg": math.degrees(latitude), "longitude_deg": math.degrees(longitude), "altitude": height}
