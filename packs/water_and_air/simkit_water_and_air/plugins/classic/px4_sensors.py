"""Sensors of PX4's models for Gazebo Classic, whose readings `libgazebo_mavlink_interface.so` sends to PX4.

Parameters, defaults and noise follow the sources of PX4/PX4-SITL_gazebo-classic. Its IMU and magnetometer have the
noise model of RotorS (Furrer et al., 2016): white noise of a density, and a bias that is a first-order Gauss-Markov
process. The world's `<spherical_coordinates>` are the home position; x is east and y is north for a heading of zero.
"""

from __future__ import annotations

import math
from collections import deque
from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np

from simkit import ModelPlugin, Params, Plugin
from simkit.extend import (
    LARGEST,
    Options,
    OptionsOf,
    SceneSensor,
    Vector,
    boolean,
    find_named_link,
    number,
    without_effect,
)
from simkit.linear_algebra import matmul, norm
from simkit.scene import SphericalCoordinates
from simkit.sensors.environment.geodesy import WorldOnPlanet, east_north_up
from simkit.sensors.environment.magnetic_field import DEFAULT_DATE, MagneticModel

if TYPE_CHECKING:
    from simkit import Link, Model, Simulation
    from simkit.extend import SceneModel, Sensor, SpecBuilder

AnySensor = TypeVar("AnySensor", bound="Px4Sensor")

_GAUSS: Final = 1e4  # per tesla
_HOME: Final = SphericalCoordinates(math.radians(47.397742), math.radians(8.545594), 488.0)  # Zurich, as in the sources
_TEMPERATURE, _LAPSE, _PRESSURE, _DENSITY = 288.0, 0.0065, 101325.0, 1.225  # ISA of the source [K, K/m, Pa, kg/m³]
_GPS_TIME_CONSTANT: Final = 60.0
_AIRSPEED_RATE: Final = 10.0  # [Hz]


def home_of(sim: Simulation) -> SphericalCoordinates:
    """Return the position of the world's origin; PX4's default in Zurich if the world has none."""
    return sim.world.spherical_coordinates or _HOME


class NamespaceOptions(Options):
    """Options that all plugins of PX4 have."""

    namespace: bool = without_effect(element="robotNamespace")


class Px4Sensor(Plugin):
    """Base class of the sensors. A reading belongs to one tick, and is the same however often it is asked for.

    Attributes:
        reading: newest reading; None before the first.
        number: number of readings so far.
        rate: default rate [Hz]; 0 for every step.
    """

    options: Any
    rate: float = 0.0

    def begin(self, link: Link, rate: float) -> None:
        """Set the link and the rate [Hz]; called in `load`."""
        self._link, self._rate = link, rate
        self.reading: Any = None
        self.number, self._tick = 0, self.sim.tick

    def measure(self) -> Any:
        """Return the reading of this tick."""
        raise NotImplementedError

    def update(self) -> Any:
        """Take the sample of this tick if it is due, and return the newest reading."""
        if self._tick != self.sim.tick:
            self._tick = self.sim.tick
            self.each_step()
            if not self._rate or math.floor(self.sim.time * self._rate + 1e-9) > self.number:
                self.reading = self.measure()
                due = math.floor(self.sim.time * self._rate + 1e-9)
                self.number = due if self._rate else self.number + 1
        return self.reading

    def each_step(self) -> None:
        """Update what changes at every step."""

    def after_step(self) -> None:
        """Take a sample, if one is due."""
        self.update()


class GaussMarkovNoise:
    """Noise of three axes: white noise of a density, and a drifting bias.

    Args:
        density: density of the white noise [unit/√Hz].
        walk: intensity of the bias [unit·√Hz].
        time_constant: correlation time of the bias [s].
        turn_on: standard deviation of a constant bias.
    """

    def __init__(self, density: float, walk: float, time_constant: float, turn_on: float, drawn: Vector) -> None:
        self._density, self._walk, self._time_constant = density, walk, time_constant
        self._bias, self._turn_on = np.zeros(3), turn_on * drawn

    def advance(self, step: float, drawn: Vector) -> Vector:
        """Return the error after a time step [s], from six standard normal numbers."""
        left = math.exp(-step / self._time_constant)
        spread = self._walk * math.sqrt(self._time_constant / 2 * (1 - left * left))
        self._bias = left * self._bias + spread * drawn[:3]
        return self._bias + self._density / math.sqrt(step) * drawn[3:] + self._turn_on


class ImuOptions(NamespaceOptions):
    """Options of `Px4Imu`."""

    topic: bool = without_effect(element="imuTopic")
    gyro_density: float = number(2 * 35 / 3600 * math.pi / 180, element="gyroscopeNoiseDensity", minimum=0)
    gyro_walk: float = number(2 * 4.0 / 3600 * math.pi / 180, element="gyroscopeRandomWalk", minimum=0)
    gyro_time: float = number(1e3, "s", element="gyroscopeBiasCorrelationTime", minimum=1e-6)
    gyro_turn_on: float = number(0.5 * math.pi / 180, "rad/s", element="gyroscopeTurnOnBiasSigma", minimum=0)
    force_density: float = number(2 * 2.0e-3, element="accelerometerNoiseDensity", minimum=0)
    force_walk: float = number(2 * 3.0e-3, element="accelerometerRandomWalk", minimum=0)
    force_time: float = number(300.0, "s", element="accelerometerBiasCorrelationTime", minimum=1e-6)
    force_turn_on: float = number(20e-3 * 9.8, "m/s²", element="accelerometerTurnOnBiasSigma", minimum=0)


class Px4Imu(Px4Sensor, ModelPlugin):
    """Measures angular rate and specific force at the link `<linkName>`, in its axes, at every step.

    The noise is that of RotorS: `<gyroscopeNoiseDensity>`, `<gyroscopeRandomWalk>`, `<gyroscopeBiasCorrelationTime>`,
    `<gyroscopeTurnOnBiasSigma>`, and the same for `accelerometer…`.
    """

    options = OptionsOf(ImuOptions)
    filenames = ("libgazebo_imu_plugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self.options.read_all()
        self._name = find_named_link(scene, "linkName", params)

    def load(self, parent: Model, params: Params) -> None:
        self.begin(self.sim.link(self._name), 0.0)
        options, first = self.options, self.random("turn on", 6)
        drawn = np.asarray(first.normal(0))
        gyro = options.gyro_density, options.gyro_walk, options.gyro_time, options.gyro_turn_on
        force = options.force_density, options.force_walk, options.force_time, options.force_turn_on
        self._gyro, self._force = GaussMarkovNoise(*gyro, drawn[:3]), GaussMarkovNoise(*force, drawn[3:])
        self._stream = self.random("noise", 12)

    def measure(self) -> tuple[Vector, Vector]:
        link, step = self._link, self.period
        axes, drawn = link.pose.matrix, np.asarray(self._stream.normal(self.sim.tick))
        force = matmul(link.linear_acceleration - self.sim.mj_model.opt.gravity, axes)
        gyro = matmul(link.angular_velocity, axes)
        return gyro + self._gyro.advance(step, drawn[:6]), force + self._force.advance(step, drawn[6:])


class MagnetometerOptions(NamespaceOptions):
    """Options of `Px4Magnetometer`."""

    topic: bool = without_effect(element="magTopic")
    rate: float = number(100.0, "Hz", element="pubRate", minimum=0, maximum=LARGEST)
    density: float = number(0.4e-3, "gauss/√Hz", element="noiseDensity", minimum=0)
    walk: float = number(6.4e-6, element="randomWalk", minimum=0)
    time_constant: float = number(600.0, "s", element="biasCorrelationTime", minimum=1e-6)


class Px4Magnetometer(Px4Sensor, ModelPlugin):
    """Measures the Earth's magnetic field [gauss] in the model's axes; the World Magnetic Model gives the field."""

    options = OptionsOf(MagnetometerOptions)
    filenames = ("libgazebo_magnetometer_plugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self.options.read_all()
        self._name = scene.canonical_link

    def load(self, parent: Model, params: Params) -> None:
        options = self.options
        self.begin(self.sim.link(self._name), options.rate)
        planet = WorldOnPlanet(home_of(self.sim))
        field = MagneticModel(DEFAULT_DATE).at(*planet.origin.tolist())
        self._field = matmul(planet.axes.T, field) * _GAUSS
        self._noise = GaussMarkovNoise(options.density, options.walk, options.time_constant, 0.0, np.zeros(3))
        self._stream = self.random("noise", 6)

    def measure(self) -> Vector:
        step = 1.0 / self._rate if self._rate else self.period
        field: Vector = matmul(self._field, self._link.pose.matrix)
        return field + self._noise.advance(step, np.asarray(self._stream.normal(self.sim.tick)))


class BarometerOptions(NamespaceOptions):
    """Options of `Px4Barometer`."""

    topic: bool = without_effect(element="baroTopic")
    rate: float = number(50.0, "Hz", element="pubRate", minimum=0, maximum=LARGEST)
    drift: float = number(0.0, "Pa/s", element="baroDriftPaPerSec")


class Px4Barometer(Px4Sensor, ModelPlugin):
    """Measures the pressure of the air with 1 Pa of noise: pressure [hPa], altitude [m] and temperature [°C]."""

    options = OptionsOf(BarometerOptions)
    filenames = ("libgazebo_barometer_plugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self.options.read_all()
        self._name = scene.canonical_link

    def load(self, parent: Model, params: Params) -> None:
        self.begin(self.sim.link(self._name), self.options.rate)
        self._home = home_of(self.sim).elevation
        self._stream = self.random("noise", 1)

    def measure(self) -> tuple[float, float, float]:
        altitude = self._home + float(self._link.pose.position[2])
        temperature = max(_TEMPERATURE - _LAPSE * altitude, 1.0)
        ratio = _TEMPERATURE / temperature
        error = float(np.asarray(self._stream.normal(self.sim.tick))[0]) + self.options.drift * self.sim.time
        pressure = _PRESSURE / ratio**5.256 + error
        density = _DENSITY / ratio**4.256
        gravity = max(norm(self.sim.mj_model.opt.gravity), 1e-3)
        return pressure / 100, altitude - error / (gravity * density), temperature - 273.0


class AirspeedOptions(NamespaceOptions):
    """Options of `Px4Airspeed`."""

    topic: bool = without_effect()
    link: bool = without_effect(element="linkName")
    spread: float = number(0.01, "hPa", element="DiffPressureStdev", minimum=0.0, maximum=LARGEST)


class Px4Airspeed(Px4Sensor):
    """Measures the dynamic pressure [hPa] of the air along the x axis of its link, ten times a second.

    It is negative if the air comes from behind. The air moves with the world's wind.
    """

    parent_kind = ("model", "sensor")
    options = OptionsOf(AirspeedOptions)
    filenames = ("libgazebo_airspeed_plugin.so",)

    def prepare(self, scene: SceneModel | SceneSensor, params: Params, builder: SpecBuilder) -> None:
        self.options.read_all()
        self._name = scene.parent if isinstance(scene, SceneSensor) else scene.canonical_link

    def load(self, parent: Model | Sensor, params: Params) -> None:
        self.begin(self.sim.link(self._name), _AIRSPEED_RATE)
        self._home, self._stream = home_of(self.sim).elevation, self.random("noise", 1)

    def measure(self) -> float:
        link = self._link
        altitude = self._home + float(link.pose.position[2])
        density = _DENSITY / (_TEMPERATURE / max(_TEMPERATURE - _LAPSE * altitude, 1.0)) ** 4.256
        wind = np.array(self.sim.engine.wind.at(max(self.sim.tick - 1, 0)))
        speed = float(matmul(link.linear_velocity - wind, link.pose.matrix)[0])
        error = self.options.spread * float(np.asarray(self._stream.normal(self.sim.tick))[0])
        return float(0.005 * density * speed * abs(speed) + error)


class GpsOptions(NamespaceOptions):
    """Options of `Px4Gps`."""

    topic: bool = without_effect(element="topic")
    noise: bool = boolean(element="gpsNoise")
    xy_walk: float = number(2.0, element="gpsXYRandomWalk", minimum=0)
    z_walk: float = number(4.0, element="gpsZRandomWalk", minimum=0)
    xy_density: float = number(2e-4, "m/√Hz", element="gpsXYNoiseDensity", minimum=0)
    z_density: float = number(4e-4, "m/√Hz", element="gpsZNoiseDensity", minimum=0)
    vxy_density: float = number(0.2, "m/s/√Hz", element="gpsVXYNoiseDensity", minimum=0)
    vz_density: float = number(0.4, "m/s/√Hz", element="gpsVZNoiseDensity", minimum=0)
    update_rate: float = number(5.0, "Hz", minimum=0)
    delay: float = number(0.12, "s", minimum=0.0, maximum=10.0)


class Px4Gps(Px4Sensor):
    """Measures latitude and longitude [rad], altitude [m] and velocity (east, north, up) [m/s], 0.12 s late.

    It stands in a `<sensor type="gps">` or, in older files, in a model. `<gpsNoise>` switches the noise on.
    """

    parent_kind = ("model", "sensor")
    options = OptionsOf(GpsOptions)
    filenames = ("libgazebo_gps_plugin.so",)

    def prepare(self, scene: SceneModel | SceneSensor, params: Params, builder: SpecBuilder) -> None:
        self.options.read_all()
        self._name = scene.parent if isinstance(scene, SceneSensor) else scene.canonical_link

    def load(self, parent: Model | Sensor, params: Params) -> None:
        options = self.options
        sensor_rate = 0.0 if params.has("update_rate") else float(getattr(parent, "update_rate", 0.0))
        self.begin(self.sim.link(self._name), sensor_rate or options.update_rate)
        self._planet = WorldOnPlanet(home_of(self.sim))
        home = home_of(self.sim)
        self._to_enu = matmul(east_north_up(home.latitude, home.longitude).T, self._planet.axes)
        xy, z = (options.xy_walk, options.xy_density, options.vxy_density), (options.z_walk,)
        self._scales = np.array([xy[0], xy[0], *z, xy[1], xy[1], options.z_density, xy[2], xy[2], options.vz_density])
        self._bias, self._white = np.zeros(3), np.zeros(9)
        self._stream = self.random("noise", 9) if options.noise else None
        self._late: deque[tuple[int, Vector, Vector]] = deque()

    def each_step(self) -> None:
        if self._stream is not None:
            step = self.period
            self._white = self._scales * math.sqrt(step) * np.asarray(self._stream.normal(self.sim.tick))
            self._bias = self._bias + self._white[:3] * step - self._bias * (step / _GPS_TIME_CONSTANT)
        link, delay = self._link, round(self.options.delay / self.period)
        position = link.pose.position + self._bias + self._white[3:6]
        self._late.append((self.sim.tick, position, matmul(self._to_enu, link.linear_velocity) + self._white[6:]))
        while len(self._late) > 1 and self._late[1][0] <= self.sim.tick - delay:
            self._late.popleft()

    def measure(self) -> tuple[int, float, float, float, Vector]:
        tick, position, velocity = self._late[0]
        return tick, *self._planet.geodetic(position), velocity


class Px4GroundTruth(ModelPlugin):
    """Has no effect: the plugin `libgazebo_mavlink_interface.so` reads the true state itself."""

    options = OptionsOf(NamespaceOptions)
    filenames = ("libgazebo_groundtruth_plugin.so",)

    def load(self, parent: Model, params: Params) -> None:
        self.options.read_all()


def find_sensor_plugin(sim: Simulation, kind: type[AnySensor], model: str) -> AnySensor | None:
    """Return the first sensor of a kind on a model or its nested models; None if there is none."""
    for plugin in sim.engine.structure.all_plugins():
        if isinstance(plugin, kind) and f"{plugin.scoped}::".startswith(f"{model}::"):
            return plugin
    return None
