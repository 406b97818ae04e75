"""Satellite receiver and chemical sensor of underwater vehicles: plugins of uuv_simulator.

Parameters, topics and formulas are those of `GPSROSPlugin.cc` and `CPCROSPlugin.cc`.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit import Params, SensorPlugin, msgs
from simkit.extend import Options, OptionsOf, Vector, choice, number, publishes, text, without_effect
from simkit.sensors.environment.geodesy import WorldOnPlanet
from simkit_water_and_air.message_fields import xyz
from simkit_water_and_air.plugins.classic.px4_sensors import home_of
from simkit_water_and_air.plugins.fluids.water_current import absolute_topic
from simkit_water_and_air.plugins.uuv.uuv_sensor import UuvSensor, UuvSensorOptions

if TYPE_CHECKING:
    from simkit.msgs import Message

_FIX: Final = "sensor_msgs/msg/NavSatFix"
_CONCENTRATION: Final = "uuv_sensor_ros_plugins_msgs/msg/ChemicalParticleConcentration"
_SALINITY: Final = "uuv_sensor_ros_plugins_msgs/msg/Salinity"
_CLOUD: Final = "sensor_msgs/msg/PointCloud"
_TOPIC: Final = "/{robot_namespace}/{sensor_topic}"
_FORGOTTEN: Final = 5.0  # after a plume without a message [s]
_WATER: Final = {"ppt": 35.0, "ppm": 35000.0, "psu": 35.0}
"""Salinity of the water by unit."""


class UuvGpsOptions(Options):
    """Options of `UuvGps`."""

    namespace: str = text(element="robot_namespace", required=True)
    topic: str = text(element="sensor_topic", required=True)
    horizontal: bool = without_effect(element="horizontal_pos_std_dev")
    vertical: bool = without_effect(element="vertical_pos_std_dev")
    rate: bool = without_effect(element="update_rate")
    is_on: bool = without_effect()
    gazebo_messages: bool = without_effect(element="enable_gazebo_messages")


class UuvGps(SensorPlugin):
    """Publishes the position that its sensor `gps` measures, in the frame `<robot_namespace>/gps_link`.

    The covariance is that of the noise of the sensor.
    """

    endpoints = (publishes(_TOPIC, _FIX),)
    options = OptionsOf(UuvGpsOptions)
    filenames = ("libuuv_gazebo_ros_gps_plugin.so",)

    def load(self, parent: Any, params: Params) -> None:
        options = self.options.read_all()
        if parent.kind not in ("gps", "navsat"):
            self.refuse(parent, "gps")
            return
        space = options.namespace.strip("/")
        parent.frame_id = f"{space}/gps_link"
        parent.use_classic_noise()
        parent.publish_on({"fix": absolute_topic(f"{space}/{options.topic.strip('/')}")})


class UuvChemicalOptions(UuvSensorOptions):
    """Options of `UuvChemicalSensor`."""

    plume: str = text(element="plume_topic", required=True)
    gamma: float = number(0.001, minimum=1e-12, maximum=1e9)
    gain: float = number(1.0, minimum=0.0, maximum=1e12)
    radius: float = number(3.0, "m", minimum=1e-6, maximum=1e6)
    salinity_topic: str = text("salinity", element="salinity_output_topic")
    unit: str = choice(tuple(_WATER), "ppt", element="salinity_unit")
    water: float = number(35.0, element="water_salinity_value", minimum=0.0, maximum=1e9)
    plume_salinity: float = number(0.0, element="plume_salinity_value", minimum=0.0, maximum=1e9)


class UuvChemicalSensor(UuvSensor):
    """Measures the concentration of particles of a plume, and the salinity, from the cloud on `<plume_topic>`.

    The cloud is a `PointCloud` with the time of each particle's release [s] in its first channel. The kernel of a
    particle grows with its age by `<gamma>` from `<radius>`. Five seconds after the last cloud, the concentration is 0.
    """

    endpoints = (*UuvSensor.endpoints, publishes(_TOPIC, _CONCENTRATION), publishes("/salinity", _SALINITY))
    options = OptionsOf(UuvChemicalOptions)
    filenames = ("libuuv_gazebo_ros_cpc_plugin.so",)
    width = 1

    def start(self, base: str) -> None:
        options = self._settings
        if not options.params.has("water_salinity_value"):
            self._water = _WATER[options.unit]
        else:
            self._water = options.water
        if options.plume_salinity >= self._water:
            message = f"found {options.plume_salinity:g}; expected less than the {self._water:g} of the water"
            options.params.block("plume_salinity_value").error("SK-PARAM-002", message)
        space = options.namespace.strip("/")
        self._concentration, self._is_measuring, self._heard = 0.0, False, 0.0
        self._place = np.zeros(3)
        self._planet = WorldOnPlanet(home_of(self.sim))
        self._coordinates = (0.0, 0.0, 0.0)
        self._output = self.advertise(base, _CONCENTRATION)
        self._salinity = self.advertise(_topic_in(space, options.salinity_topic), _SALINITY)
        self.listen(_topic_in(space, options.plume), _CLOUD, self._on_plume)

    def _on_plume(self, message: Message) -> None:
        if not message.channels or len(message.channels[0].values) != len(message.points):
            return
        options, position = self._settings, self.link.pose.position
        time = message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec
        x, y, z = position.tolist()
        first = options.radius ** (2.0 / 3.0)
        total = 0.0
        for point, released in zip(message.points, message.channels[0].values, strict=True):
            width = max(first + options.gamma * (time - float(released)), 1e-9) ** 1.5
            share = math.sqrt((point.x - x) ** 2 + (point.y - y) ** 2 + (point.z - z) ** 2) / width
            if share < 1:
                kernel = 4.0 - 6.0 * share * share + 3.0 * share**3
            else:
                kernel = (2.0 - share) ** 3 if share < 2 else 0.0
            total += kernel / (4 * math.pi * width**3)
        if not math.isfinite(total):
            return
        self._concentration, self._is_measuring, self._heard = options.gain * total, True, self.sim.time
        self._place = self.reference_pose.inverse().transform(position)
        self._coordinates = self._planet.geodetic(position)

    def measure(self, drawn: Vector, elapsed: float) -> None:
        if self.sim.time - self._heard > _FORGOTTEN:
            self._concentration, self._is_measuring = 0.0, False
        # as in the source, the noise of a reading stays until the next cloud
        self._concentration += self._settings.amplitude * self._settings.sigma * float(drawn[0])
        header = msgs.header(self.sim.time_ns, self.reference_frame_id)
        latitude, longitude, altitude = self._coordinates
        self._output.publish(
            msgs.make(
                _CONCENTRATION,
                header=header,
                position=xyz(self._place),
                latitude=math.degrees(latitude),
                longitude=math.degrees(longitude),
                depth=-altitude,
                concentration=self._concentration,
                is_measuring=self._is_measuring,
            )
        )
        share = min(1.0, self._concentration)
        salinity = self._water * (1 - share) + share * self._settings.plume_salinity
        variance = self._settings.sigma**2
        self._salinity.publish(
            msgs.make(_SALINITY, header=header, salinity=salinity, variance=variance, unit=self._settings.unit)
        )


def _topic_in(space: str, name: str) -> str:
    """Return a topic in the namespace of the robot, unless it is absolute."""
    return name if name.startswith("/") else absolute_topic(f"{space}/{name}")
