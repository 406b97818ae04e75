"""Sensors of underwater vehicles: pressure, Doppler velocity log, acoustic position and magnetometer of uuv_simulator.

Parameters, topics and formulas are those of `SubseaPressureROSPlugin.cc`, `DVLROSPlugin.cc`, `RPTROSPlugin.cc` and
`MagnetometerROSPlugin.cc`.
"""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params, msgs
from simkit.extend import OptionsOf, Vector, find_link, number, publishes, text, without_effect
from simkit.linear_algebra import matmul
from simkit_water_and_air.message_fields import diagonal, xyz
from simkit_water_and_air.plugins.uuv.uuv_sensor import UuvSensor, UuvSensorOptions

if TYPE_CHECKING:
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.msgs import Message

_PRESSURE: Final = "sensor_msgs/msg/FluidPressure"
_DVL, _BEAM = "uuv_sensor_ros_plugins_msgs/msg/DVL", "uuv_sensor_ros_plugins_msgs/msg/DVLBeam"
_TWIST: Final = "geometry_msgs/msg/TwistWithCovarianceStamped"
_RANGE: Final = "sensor_msgs/msg/Range"
_POSITION: Final = "uuv_sensor_ros_plugins_msgs/msg/PositionWithCovarianceStamped"
_FIELD: Final = "sensor_msgs/msg/MagneticField"
_OUT_OF_RANGE: Final = -1.0  # altitude without a bottom [m]
_TOPIC: Final = "/{robot_namespace}/{sensor_topic}"


class SubseaPressureOptions(UuvSensorOptions):
    """Options of `SubseaPressure`."""

    saturation: bool = without_effect()
    estimate_depth: bool = without_effect(element="estimate_depth_on")
    surface: float = number(101.325, "kPa", element="standard_pressure", minimum=0.0, maximum=1e9)
    slope: float = number(9.80638, "kPa/m", element="kPa_per_meter", minimum=0.0, maximum=1e9)


class SubseaPressure(UuvSensor):
    """Measures the pressure of the water [kPa] at the link; the surface is at z = 0."""

    options = OptionsOf(SubseaPressureOptions)
    endpoints = (*UuvSensor.endpoints, publishes(_TOPIC, _PRESSURE))
    filenames = ("libuuv_gazebo_ros_subsea_pressure_plugin.so",)
    width = 1

    def start(self, base: str) -> None:
        self._output = self.advertise(base, _PRESSURE)

    def measure(self, drawn: Vector, elapsed: float) -> None:
        if not self._output.wanted:
            return
        options = self._settings
        pressure = (
            options.surface + abs(float(self.link.pose.position[2])) * options.slope + float(self.noise(drawn)[0])
        )
        header = msgs.header(self.sim.time_ns, self.link.name)
        self._output.publish(msgs.make(_PRESSURE, header=header, fluid_pressure=pressure, variance=options.sigma**2))


class UuvDvlOptions(UuvSensorOptions):
    """Options of `UuvDvl`."""

    link_0: str = text(element="beam_link_name_0", required=True)
    link_1: str = text(element="beam_link_name_1", required=True)
    link_2: str = text(element="beam_link_name_2", required=True)
    link_3: str = text(element="beam_link_name_3", required=True)
    topic_0: str = text(element="beam_topic_0", required=True)
    topic_1: str = text(element="beam_topic_1", required=True)
    topic_2: str = text(element="beam_topic_2", required=True)
    topic_3: str = text(element="beam_topic_3", required=True)


class UuvDvl(UuvSensor):
    """Measures the velocity of the link [m/s] and the altitude above the bottom [m].

    The altitude is the mean of the ranges that four sonars publish on `<beam_topic_0>` to `<beam_topic_3>`; it is -1
    if all are at their limits. The reading is on `<sensor_topic>`, and as a twist on `<sensor_topic>_twist`.
    """

    options = OptionsOf(UuvDvlOptions)
    endpoints = (*UuvSensor.endpoints, publishes(_TOPIC, _DVL), publishes(f"{_TOPIC}_twist", _TWIST))
    filenames = ("libuuv_gazebo_ros_dvl_plugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        super().prepare(scene, params, builder)
        links = {link.scoped: link for link in scene.all_links()}
        own = links.get(self._link_name)
        self._beam_poses: list[tuple[str, Vector, Vector]] = []
        for index in range(4):
            element = params.block(f"beam_link_name_{index}")
            link = find_link(scene, getattr(self._settings, f"link_{index}"), element)
            if link is not None and own is not None:
                pose = own.pose_world.inverse() @ link.pose_world
                self._beam_poses.append((link.name, pose.position, pose.quaternion))

    def start(self, base: str) -> None:
        namespace = self._settings.namespace.strip("/")
        self._ranges: list[tuple[float, float, float] | None] = [None] * 4
        for index in range(4):
            topic = getattr(self._settings, f"topic_{index}").strip("/")
            self.listen(f"/{namespace}/{topic}", _RANGE, partial(self._on_range, index))
        self._output, self._twist = self.advertise(base, _DVL), self.advertise(f"{base}_twist", _TWIST)

    def _on_range(self, index: int, message: Message) -> None:
        self._ranges[index] = float(message.range), float(message.min_range), float(message.max_range)

    def _altitude(self) -> float:
        given = [r for r in self._ranges if r is not None]
        if len(given) < 4 or all(r <= low for r, low, _ in given) or all(r >= high for r, _, high in given):
            return _OUT_OF_RANGE
        first, second, third, fourth = (r for r, _, _ in given)
        return 0.25 * (first + second + third + fourth)

    def measure(self, drawn: Vector, elapsed: float) -> None:
        axes = self.link.pose.matrix
        velocity = self.in_axes_of_link(matmul(self.link.linear_velocity, axes) + self.noise(drawn))
        variance, header = self._settings.sigma**2, msgs.header(self.sim.time_ns, self.frame_id)
        if self._output.wanted:
            self._output.publish(
                msgs.make(
                    _DVL,
                    header=header,
                    velocity=xyz(velocity),
                    velocity_covariance=diagonal(9, variance, variance, variance),
                    altitude=self._altitude(),
                    beams=self._beams(),
                )
            )
        if self._twist.wanted:
            covariance = diagonal(36, variance, variance, variance, -1.0, -1.0, -1.0)
            twist = {"twist": {"linear": xyz(velocity)}, "covariance": covariance}
            self._twist.publish(msgs.make(_TWIST, header=header, twist=twist))

    def _beams(self) -> list[object]:
        beams: list[object] = []
        for reading, (name, position, turn) in zip(self._ranges, self._beam_poses, strict=False):
            w, x, y, z = turn.tolist()
            pose = {"position": xyz(position), "orientation": {"x": x, "y": y, "z": z, "w": w}}
            stamped = {"header": msgs.header(self.sim.time_ns, name), "pose": pose}
            beams.append(msgs.make(_BEAM, range=0.0 if reading is None else reading[0], pose=stamped))
        return beams


class AcousticPosition(UuvSensor):
    """Measures the position of the link [m] in the frame `<static_reference_frame>` or `<reference_link_name>`."""

    endpoints = (*UuvSensor.endpoints, publishes(_TOPIC, _POSITION))
    filenames = ("libuuv_gazebo_ros_rpt_plugin.so",)

    def start(self, base: str) -> None:
        self._output = self.advertise(base, _POSITION)

    def measure(self, drawn: Vector, elapsed: float) -> None:
        if not self._output.wanted:
            return
        place = self.reference_pose.inverse().transform(self.link.pose.position) + self.noise(drawn)
        variance = self._settings.sigma**2
        position = {"pos": xyz(place), "covariance": diagonal(9, variance, variance, variance)}
        header = msgs.header(self.sim.time_ns, self.reference_frame_id)
        self._output.publish(msgs.make(_POSITION, header=header, pos=position))


class UuvMagnetometerOptions(UuvSensorOptions):
    """Options of `UuvMagnetometer`; the unit is that of `<intensity>`."""

    intensity: float = number(1.0, minimum=0.0, maximum=1e9)
    heading: float = number(math.pi, "rad", element="reference_heading")
    declination: float = number(0.0, "rad")
    inclination: float = number(math.pi / 3, "rad")
    noise_xy: float = number(1.0, minimum=0.0, maximum=1e9)
    noise_z: float = number(1.4, minimum=0.0, maximum=1e9)
    turn_on_bias: float = number(2.0, minimum=0.0, maximum=1e9)


class UuvMagnetometer(UuvSensor):
    """Measures a constant magnetic field, given by `<intensity>`, `<inclination>` and `<reference_heading>`."""

    options = OptionsOf(UuvMagnetometerOptions)
    endpoints = (*UuvSensor.endpoints, publishes(_TOPIC, _FIELD))
    filenames = ("libuuv_gazebo_ros_magnetometer_plugin.so",)

    def start(self, base: str) -> None:
        options = self._settings
        angle, level = options.heading - options.declination, math.cos(options.inclination)
        field = level * math.cos(angle), level * math.sin(angle), -math.sin(options.inclination)
        self._field = options.intensity * np.array(field)
        drawn = np.asarray(self.random("turn on", 3).normal(0))
        self._bias = options.amplitude * options.turn_on_bias * drawn
        self._spread = np.array((options.noise_xy, options.noise_xy, options.noise_z))
        self._output = self.advertise(base, _FIELD)

    def measure(self, drawn: Vector, elapsed: float) -> None:
        if not self._output.wanted:
            return
        noise = self._settings.amplitude * self._spread * drawn
        field = self.in_axes_of_link(matmul(self._field, self.link.pose.matrix) + self._bias + noise)
        covariance = diagonal(9, *(self._spread * self._spread).tolist())
        header = msgs.header(self.sim.time_ns, self.frame_id)
        message = msgs.make(_FIELD, header=header, magnetic_field=xyz(field), magnetic_field_covariance=covariance)
        self._output.publish(message)
