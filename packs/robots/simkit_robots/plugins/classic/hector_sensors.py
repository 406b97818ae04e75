"""Sensors of hector_gazebo_plugins: `libhector_gazebo_ros_imu.so`, `…_gps.so`, `…_magnetic.so` and `…_sonar.so`."""

from __future__ import annotations

import abc
import math
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import ModelPlugin, Params, SensorPlugin, msgs
from simkit.extend import (
    Options,
    OptionsOf,
    Vector,
    boolean,
    find_named_link,
    integer,
    number,
    offers,
    publish_while_subscribed,
    publishes,
    text,
    vector3,
    without_effect,
)
from simkit.linear_algebra import matmul, norm
from simkit.plugins.publish_on_demand import count_instants
from simkit.pose import quat_multiply
from simkit.scene import SphericalCoordinates
from simkit.sensors.environment.geodesy import WorldOnPlanet
from simkit_robots.plugins.classic.hector_error import HectorError

if TYPE_CHECKING:
    from simkit import Model, Publisher
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.sensors.rays.lidar import Lidar

IMU: Final = "sensor_msgs/msg/Imu"
FIX: Final = "sensor_msgs/msg/NavSatFix"
FIELD: Final = "sensor_msgs/msg/MagneticField"
VECTOR: Final = "geometry_msgs/msg/Vector3Stamped"

_ULTRASOUND: Final = 0  # value of sensor_msgs/Range
_BIG: Final = 1e100
_G: Final = 9.8065  # [m/s²], as in the sources


class HectorOptions(Options):
    """Options of all sensors of hector_gazebo_plugins on a model."""

    body: str = text(element="bodyName")
    frame: str = text(element="frameId")
    update_rate: float = number(0.0, "Hz", element="updateRate", minimum=0)
    always_on: bool = without_effect(element="alwaysOn")
    seed: bool = without_effect(element="randomEngineSeed")


class HectorSensor(ModelPlugin):
    """Base class of the sensors on a link; the link is `<bodyName>`, or the model's canonical link.

    Without subscribers, a sensor takes no time, unless its drift must go on.

    Attributes:
        rate: rate without `<updateRate>` [Hz]; 0 for every step.
    """

    options = OptionsOf(HectorOptions)
    rate: float = 0.0

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        self._body = find_named_link(scene, "bodyName", params) if params.has("bodyName") else scene.canonical_link
        self._frame = options.frame.strip("/") or self._body.rsplit("::", 1)[-1]
        self._instants_rate = options.update_rate if params.has("updateRate") else self.rate

    def load(self, parent: Model, params: Params) -> None:
        self._link = self.sim.link(self._body)
        self._last_ns = self.sim.time_ns

    @abc.abstractmethod
    def measure(self) -> None:
        """Advance the errors, and publish a reading."""

    def measure_on_demand(self, has_memory: bool, *publishers: Publisher) -> None:
        """Call `measure` at each instant, without subscribers only if the errors remember the instants before."""
        self._has_memory = has_memory
        first, *others = publishers
        for other in others:
            self.sim.communication.bus.on_readers_change(other.topic, self.sim.communication.on_demand.look)

        def is_wanted() -> bool:
            return has_memory or any(other.wanted for other in others)

        publish_while_subscribed(self, first, self._instants_rate, "measure", also=is_wanted)

    def error(self, prefix: str, size: int = 3) -> HectorError:
        """Return the error model of a measurement; called in `load`."""
        return HectorError(self.params, prefix, size, self.random(prefix or "error", 2 * size))

    def instant(self) -> tuple[int, float]:
        """Return the number of the present instant, and the time since the last one [s] if the errors depend on it."""
        dt = 0.0
        if self._has_memory:  # otherwise no attribute may change, because subscribers must not change the state
            dt, self._last_ns = (self.sim.time_ns - self._last_ns) * 1e-9, self.sim.time_ns
        return count_instants(self, self._instants_rate), dt


class HectorImuOptions(HectorOptions):
    """Options of `HectorImu`, beside `accel…`, `rate…` and `heading…` with Offset, Drift and so on."""

    topic: str = text("imu", element="topicName")
    service: str = text(element="serviceName")
    gaussian_noise: float = number(0.0, "m/s², rad/s", element="gaussianNoise", minimum=0, maximum=_BIG)
    rpy_offset: tuple[float, float, float] = vector3(unit="rad", element="rpyOffset")


class HectorImu(HectorSensor):
    """Publishes an IMU at a link on `<topicName>` (`imu`), with errors of acceleration, turning rate and heading.

    The errors are `<accelOffset>`, `<accelDrift>`, `<accelDriftFrequency>`, `<accelGaussianNoise>` and the same with
    `rate` and `heading`, in m/s², rad/s and rad. The orientation has the errors of the measured vertical and of the
    heading. The service `<serviceName>` (`<topic>/calibrate`) sets the drift of the turning rate to zero.
    """

    endpoints = (
        publishes("imu", IMU, named_by=("topicName",)),
        offers("imu/calibrate", "std_srvs/srv/Empty", named_by=("serviceName",)),
    )
    options = OptionsOf(HectorImuOptions)
    filenames = ("libhector_gazebo_ros_imu.so",)

    def load(self, parent: Model, params: Params) -> None:
        super().load(parent, params)
        options = self.options
        self._acceleration, self._rate, self._heading = (
            self.error("accel"),
            self.error("rate"),
            self.error("heading", 1),
        )
        if options.gaussian_noise:
            self._acceleration.noise = self._rate.noise = np.full(3, options.gaussian_noise)
        roll, pitch, yaw = options.rpy_offset
        self._acceleration.add_offset((pitch * _G, -roll * _G, 0.0))
        self._heading.add_offset((yaw,))
        self._out = self.advertise(options.topic, IMU)
        errors = (self._acceleration, self._rate, self._heading)
        self.measure_on_demand(any(error.drifts for error in errors), self._out)
        self.offer(options.service or f"{options.topic}/calibrate", "std_srvs/srv/Empty", self._calibrate)

    def _calibrate(self, _: object) -> None:
        self._rate.restart()

    def measure(self) -> None:
        index, dt = self.instant()
        errors = self._acceleration.advance(index, dt), self._rate.advance(index, dt), self._heading.advance(index, dt)
        if self._out.wanted:
            self._out.publish(self._message(*errors))

    def _message(self, acceleration_error: Vector, rate_error: Vector, heading_error: Vector) -> object:
        link, axes = self._link, self._link.pose.matrix
        gravity = matmul(self.sim.mj_model.opt.gravity, axes)
        acceleration = matmul(link.linear_acceleration, axes) - gravity + acceleration_error
        rate = matmul(link.angular_velocity, axes) + rate_error
        turn = float(heading_error[0])
        attitude = quat_multiply((math.cos(turn / 2), 0.0, 0.0, math.sin(turn / 2)), link.pose.quaternion)
        w, x, y, z = quat_multiply(attitude, _tilt(gravity, acceleration_error)).tolist()
        noise = self._acceleration.noise**2
        square = float(matmul(gravity, gravity))
        spread = (noise[0] / square, noise[1] / square) if square > 0 else (-1.0, -1.0)
        return msgs.make(
            IMU,
            header=msgs.header(self.sim.time_ns, self._frame),
            orientation={"x": x, "y": y, "z": z, "w": w},
            orientation_covariance=np.diag([*spread, float(self._heading.noise[0]) ** 2]).reshape(9),
            angular_velocity=_vector(rate),
            angular_velocity_covariance=np.diag(self._rate.noise**2).reshape(9),
            linear_acceleration=_vector(acceleration),
            linear_acceleration_covariance=np.diag(noise).reshape(9),
        )


class HectorGpsOptions(HectorOptions):
    """Options of `HectorGps`, beside `Offset`, `Drift` and so on of the position and `velocity…` of the velocity."""

    topic: str = text("fix", element="topicName")
    velocity_topic: str = text("fix_velocity", element="velocityTopicName")
    latitude: float = number(0.0, "degree", element="referenceLatitude", minimum=-90, maximum=90)
    longitude: float = number(0.0, "degree", element="referenceLongitude", minimum=-360, maximum=360)
    heading: float = number(0.0, "degree", element="referenceHeading", minimum=-360, maximum=360)
    altitude: float = number(0.0, "m", element="referenceAltitude", minimum=-1e6, maximum=1e6)
    status: int = integer(0, minimum=-1, maximum=2)
    service: int = integer(1, minimum=0, maximum=15)


class HectorGps(HectorSensor):
    """Publishes the fix of a link on `<topicName>` (`fix`) and its velocity on `<velocityTopicName>` (`fix_velocity`).

    The world's origin is at `<referenceLatitude>`, `<referenceLongitude>` [degrees] and `<referenceAltitude>` [m], with
    the x axis `<referenceHeading>` degrees clockwise from north; without them the world's `<spherical_coordinates>`
    count. The velocity points north, west and up. The errors of position [m] and velocity [m/s] are `<offset>`,
    `<drift>`, `<driftFrequency>`, `<gaussianNoise>`, and the same with `velocity`; the error of the velocity also
    changes the position.
    """

    endpoints = (
        publishes("fix", FIX, named_by=("topicName",)),
        publishes("fix_velocity", VECTOR, named_by=("velocityTopicName",)),
    )
    options = OptionsOf(HectorGpsOptions)
    filenames = ("libhector_gazebo_ros_gps.so",)
    rate = 4.0

    def load(self, parent: Model, params: Params) -> None:
        super().load(parent, params)
        options = self.options
        reference = self.sim.world.spherical_coordinates or SphericalCoordinates()
        has = params.has
        self._place = replace(
            reference,
            latitude=math.radians(options.latitude) if has("referenceLatitude") else reference.latitude,
            longitude=math.radians(options.longitude) if has("referenceLongitude") else reference.longitude,
            heading=math.pi / 2 - math.radians(options.heading) if has("referenceHeading") else reference.heading,
            elevation=options.altitude if has("referenceAltitude") else reference.elevation,
        )
        self._planet = WorldOnPlanet(self._place)
        self._position, self._velocity = self.error(""), self.error("velocity")
        self._walk = np.zeros(3)
        self._fix, self._speed = self.advertise(options.topic, FIX), self.advertise(options.velocity_topic, VECTOR)
        self.measure_on_demand(self._position.drifts or not self._velocity.is_zero, self._fix, self._speed)

    def measure(self) -> None:
        index, dt = self.instant()
        velocity_error = self._velocity.advance(index, dt)
        self._walk = self._walk + velocity_error * dt
        position_error = self._position.advance(index, dt) + self._walk
        options, header = self.options, msgs.header(self.sim.time_ns, self._frame)
        if self._fix.wanted:
            latitude, longitude, height = self._planet.geodetic(self._link.pose.position + position_error)
            self._fix.publish(
                msgs.make(
                    FIX,
                    header=header,
                    status={"status": options.status, "service": options.service},
                    latitude=math.degrees(latitude),
                    longitude=math.degrees(longitude),
                    altitude=height,
                )
            )
        if self._speed.wanted:
            x, y, z = (self._link.linear_velocity + velocity_error).tolist()
            sine, cosine = math.sin(self._place.heading), math.cos(self._place.heading)
            north, west = sine * x + cosine * y, -cosine * x + sine * y
            self._speed.publish(msgs.make(VECTOR, header=header, vector={"x": north, "y": west, "z": z}))


class HectorMagneticOptions(HectorOptions):
    """Options of `HectorMagnetic`, beside `Offset`, `Drift` and so on of the field."""

    topic: str = text("magnetic", element="topicName")
    magnitude: float = number(1.0, minimum=0, maximum=_BIG)
    heading: float = number(0.0, "degree", element="referenceHeading", minimum=-360, maximum=360)
    declination: float = number(0.0, "degree", minimum=-360, maximum=360)
    inclination: float = number(60.0, "degree", minimum=-90, maximum=90)
    as_field: bool = boolean(element="useMagneticFieldMsgs")


class HectorMagnetic(HectorSensor):
    """Publishes a magnetic field in the axes of a link on `<topicName>` (`magnetic`).

    The field has the `<magnitude>`, and points `<inclination>` degrees down and `<declination>` degrees east of north.
    The x axis of the world points `<referenceHeading>` degrees clockwise from north; without it the heading of the
    world's `<spherical_coordinates>` counts. The message is a `Vector3Stamped`, or with `<useMagneticFieldMsgs>` a
    `MagneticField`.
    """

    endpoints = (
        publishes("magnetic", VECTOR, named_by=("topicName",)),
        publishes("magnetic", FIELD, named_by=("topicName",)),
    )
    options = OptionsOf(HectorMagneticOptions)
    filenames = ("libhector_gazebo_ros_magnetic.so",)

    def load(self, parent: Model, params: Params) -> None:
        super().load(parent, params)
        options, place = self.options, self.sim.world.spherical_coordinates
        reference = math.pi / 2 - (0.0 if place is None else place.heading)
        heading = math.radians(options.heading) if params.has("referenceHeading") else reference
        turn, down = heading - math.radians(options.declination), math.radians(options.inclination)
        across = math.cos(down)
        field = np.array((across * math.cos(turn), across * math.sin(turn), -math.sin(down)))
        self._field = options.magnitude * field
        self._error = self.error("")
        self._out = self.advertise(options.topic, FIELD if options.as_field else VECTOR)
        self.measure_on_demand(self._error.drifts, self._out)

    def measure(self) -> None:
        index, dt = self.instant()
        error = self._error.advance(index, dt)
        if not self._out.wanted:
            return
        header, field = (
            msgs.header(self.sim.time_ns, self._frame),
            _vector(matmul(self._field, self._link.pose.matrix) + error),
        )
        if self.options.as_field:
            self._out.publish(msgs.make(FIELD, header=header, magnetic_field=field))
        else:
            self._out.publish(msgs.make(VECTOR, header=header, vector=field))


class HectorSonarOptions(Options):
    """Options of `HectorSonar`."""

    topic: str = text("sonar", element="topicName")
    frame: str = text("sonar_link", element="frameId")
    gaussian_noise: float = number(0.0, "m", element="gaussianNoise", minimum=0, maximum=1e6)
    update_rate: float = number(10.0, "Hz", element="updateRate", minimum=0)


class HectorSonar(SensorPlugin):
    """Publishes the nearest ray of its sensor as a `Range` on `<topicName>` (`sonar`), at most at `<updateRate>` Hz.

    `<gaussianNoise>` is the standard deviation [m] of noise on the range.
    """

    endpoints = (publishes("sonar", "sensor_msgs/msg/Range", named_by=("topicName",)),)
    options = OptionsOf(HectorSonarOptions)
    filenames = ("libhector_gazebo_ros_sonar.so",)

    def load(self, parent: Lidar, params: Params) -> None:
        options = self.options.read_all()
        if not hasattr(parent, "range_noise"):
            self.refuse(parent, "ray")
            return
        parent.frame_id, parent.radiation = options.frame.strip("/"), _ULTRASOUND
        if options.gaussian_noise > 0:
            parent.add_range_noise(options.gaussian_noise)
        if 0 < options.update_rate < (parent.update_rate or math.inf):
            parent.set_rate(options.update_rate)
        parent.publish_on({"range": self.ros.topic(options.topic)})


def _vector(values: Vector) -> dict[str, float]:
    x, y, z = values.tolist()
    return {"x": x, "y": y, "z": z}


def _tilt(gravity: Vector, error: Vector) -> Vector:
    """Return the rotation from the direction of gravity to that of a measured gravity, as a quaternion (w, x, y, z)."""
    measured = gravity + error
    scale = float(norm(gravity) * norm(measured))
    if scale == 0.0 or not error.any():
        return np.array((1.0, 0.0, 0.0, 0.0))
    half = np.array((scale + float(matmul(gravity, measured)), *np.cross(gravity, measured)))
    length = norm(half)
    tilt: Vector = half / length if length > 0 else np.array((0.0, 1.0, 0.0, 0.0))
    return tilt
