"""Sensors: classes that sample the simulation and publish readings; one file per kind, in a subfolder of its field.

Inputs are a `<sensor>` of the scene and the running simulation. Outputs are messages on topics, at the sensor's rate
and with noise and latency. A sensor never changes the physics. A sensor without a reader costs nothing. This folder
holds the code that all kinds share, and the names of the classes, for `sim.sensor("lds", type=Lidar)`. The kinds are
discovered at first use, in the subfolders and in the entry points `simkit.sensors`.
"""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

from simkit.lazy_names import lazy_attributes
from simkit.registry import Kinds

if TYPE_CHECKING:
    from simkit.sensors.base import Sensor
    from simkit.sensors.cameras.camera import Camera
    from simkit.sensors.cameras.depth_camera import DepthCamera
    from simkit.sensors.cameras.logical_camera import LogicalCamera
    from simkit.sensors.cameras.multicamera import MultiCamera
    from simkit.sensors.cameras.rgbd_camera import RgbdCamera
    from simkit.sensors.devices.contact import Contact
    from simkit.sensors.devices.encoder import Encoder
    from simkit.sensors.devices.force_torque import ForceTorque
    from simkit.sensors.environment.air_pressure import AirPressure
    from simkit.sensors.environment.air_speed import AirSpeed
    from simkit.sensors.environment.altimeter import Altimeter
    from simkit.sensors.environment.magnetometer import Magnetometer
    from simkit.sensors.environment.navsat import NavSat
    from simkit.sensors.environment.solar_sensor import SolarSensor
    from simkit.sensors.inertial.imu import Imu
    from simkit.sensors.rays.lidar import Lidar
    from simkit.sensors.rays.sonar import Sonar

__all__ = [
    "AirPressure",
    "AirSpeed",
    "Altimeter",
    "Camera",
    "Contact",
    "DepthCamera",
    "Encoder",
    "ForceTorque",
    "Imu",
    "Lidar",
    "LogicalCamera",
    "Magnetometer",
    "MultiCamera",
    "NavSat",
    "RgbdCamera",
    "Sensor",
    "SolarSensor",
    "Sonar",
    "sensor_kinds",
]

_MODULES = {
    "simkit.sensors.base": ("Sensor",),
    "simkit.sensors.cameras.camera": ("Camera",),
    "simkit.sensors.cameras.depth_camera": ("DepthCamera",),
    "simkit.sensors.cameras.logical_camera": ("LogicalCamera",),
    "simkit.sensors.cameras.multicamera": ("MultiCamera",),
    "simkit.sensors.cameras.rgbd_camera": ("RgbdCamera",),
    "simkit.sensors.devices.contact": ("Contact",),
    "simkit.sensors.devices.encoder": ("Encoder",),
    "simkit.sensors.devices.force_torque": ("ForceTorque",),
    "simkit.sensors.environment.air_pressure": ("AirPressure",),
    "simkit.sensors.environment.air_speed": ("AirSpeed",),
    "simkit.sensors.environment.altimeter": ("Altimeter",),
    "simkit.sensors.environment.magnetometer": ("Magnetometer",),
    "simkit.sensors.environment.navsat": ("NavSat",),
    "simkit.sensors.environment.solar_sensor": ("SolarSensor",),
    "simkit.sensors.inertial.imu": ("Imu",),
    "simkit.sensors.rays.lidar": ("Lidar",),
    "simkit.sensors.rays.sonar": ("Sonar",),
}

if not TYPE_CHECKING:  # hidden from type checkers, so that they report unknown names
    __getattr__, __dir__ = lazy_attributes(__name__, _MODULES)

GROUP = "simkit.sensors"


@functools.cache
def sensor_kinds() -> Kinds[Sensor]:
    """Return every known sensor class by its `<sensor type>`, as a read-only mapping.

    Raises:
        RuntimeError: two classes of simkit claim the same kind.
    """
    from simkit.sensors.base import Sensor

    return Kinds("simkit.sensors", GROUP, Sensor, lambda cls: cls.kinds, ("kinds",))  # type: ignore[type-abstract]
