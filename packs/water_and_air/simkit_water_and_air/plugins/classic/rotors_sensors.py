"""Sensors of RotorS for Gazebo Classic: IMU, odometry, GPS, air pressure and magnetic field.

Parameters, defaults, noise and topics are those of `gazebo_imu_plugin.cpp`, `gazebo_odometry_plugin.cpp`,
`gazebo_gps_plugin.cpp`, `gazebo_pressure_plugin.cpp` and `gazebo_magnetometer_plugin.cpp` of RotorS, with the topics of
`default_topics.h` of mav_msgs.
"""

from __future__ import annotations

import math
from collections import deque
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit import ModelPlugin, Params, Pose, SensorPlugin, msgs
from simkit.extend import (
    Options,
    OptionsOf,
    Vector,
    find_link,
    find_named_link,
    integer,
    number,
    publishes,
    text,
    vector3,
    without_effect,
)
from simkit.linear_algebra import matmul
from simkit.pose import quat_conjugate, quat_multiply, quat_rotate
from simkit_water_and_air.message_fields import xyz
from simkit_water_and_air.plugins.classic.px4_sensors import ImuOptions, Px4Imu

if TYPE_CHECKING:
    from simkit import Link, Model
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.msgs import Message

_IMU, _ODOMETRY, _POSE = "sensor_msgs/msg/Imu", "nav_msgs/msg/Odometry", "geometry_msgs/msg/Pose"
_POSE_COVARIANCE, _POINT = "geometry_msgs/msg/PoseWithCovarianceStamped", "geometry_msgs/msg/PointStamped"
_TRANSFORM, _TRANSFORMS = "geometry_msgs/msg/TransformStamped", "tf2_msgs/msg/TFMessage"
_FIX, _TWIST = "sensor_msgs/msg/NavSatFix", "geometry_msgs/msg/TwistStamped"
_PRESSURE, _FIELD = "sensor_msgs/msg/FluidPressure", "sensor_msgs/msg/MagneticField"
_NS: Final = 1_000_000_000
_EARTH, _SEA_LEVEL, _WARM, _LAPSE = 6356766.0, 101325.0, 288.15, 0.0065  # [m], [Pa], [K], [K/m]
_EXPONENT: Final = 9.80665 * 28.9644 / (8314.32 * -_LAPSE)  # of the standard atmosphere
_COLDEST: Final = 1.0  # [K]; far above the atmosphere the formula has no value


class RotorsImuOptions(ImuOptions):
    """Options of `RotorsImu`."""

    topic: str = text("imu", element="imuTopic")  # type: ignore[assignment]
    bias_walk: float = number(element="gyroscopeBiasRandomWalk", minimum=0, instead="gyro_walk")


class RotorsImu(Px4Imu):
    """Publishes angular rate and specific force at the link `<linkName>` in its axes, with noise, at every step.

    The orientation is the true one, and its covariance says that it is no measurement.
    """

    endpoints = (publishes("/{robotNamespace}/imu", _IMU, named_by=("imuTopic",)),)
    options = OptionsOf(RotorsImuOptions)
    filenames = ("librotors_gazebo_imu_plugin.so",)

    def load(self, parent: Model, params: Params) -> None:
        super().load(parent, params)
        options: Any = self.options
        self._output = self.advertise(options.topic, _IMU)
        self._variances = [
            np.diag([density**2] * 3).reshape(9) for density in (options.gyro_density, options.force_density)
        ]

    def after_step(self) -> None:
        """Publish a reading."""
        gyro, force = self.update()
        if not self._output.wanted:
            return
        w, x, y, z = self._link.pose.quaternion.tolist()
        message = msgs.make(
            _IMU,
            header=msgs.header(self.sim.time_ns, self._link.name),
            orientation={"x": x, "y": y, "z": z, "w": w},
            orientation_covariance=np.full(9, -1.0),
            angular_velocity=xyz(gyro),
            angular_velocity_covariance=self._variances[0],
            linear_acceleration=xyz(force),
            linear_acceleration_covariance=self._variances[1],
        )
        self._output.publish(message)


class RotorsSensorOptions(Options):
    """Options of the other sensors."""

    link: str = text(None, element="linkName", required=True)


class RotorsOdometryOptions(RotorsSensorOptions):
    """Options of `RotorsOdometry`; noise is normal with a standard deviation, or uniform within a bound."""

    pose: str = text("pose", element="poseTopic")
    pose_with_covariance: str = text("pose_with_covariance", element="poseWithCovarianceTopic")
    position: str = text("position", element="positionTopic")
    transform: str = text("transform", element="transformTopic")
    odometry: str = text("odometry", element="odometryTopic")
    parent_frame: str = text("world", element="parentFrameId")
    child_frame: str = text("odometry_sensor", element="childFrameId")
    divisor: int = integer(1, element="measurementDivisor", minimum=1)
    delay: int = integer(0, element="measurementDelay", minimum=0, maximum=100_000)
    unknown_delay: float = number(0.0, "s", element="unknownDelay", minimum=0.0, maximum=1e6)
    normal_position: tuple[float, float, float] = vector3(unit="m", element="noiseNormalPosition")
    normal_turn: tuple[float, float, float] = vector3(unit="rad", element="noiseNormalQuaternion")
    normal_linear: tuple[float, float, float] = vector3(unit="m/s", element="noiseNormalLinearVelocity")
    normal_angular: tuple[float, float, float] = vector3(unit="rad/s", element="noiseNormalAngularVelocity")
    uniform_position: tuple[float, float, float] = vector3(unit="m", element="noiseUniformPosition")
    uniform_turn: tuple[float, float, float] = vector3(unit="rad", element="noiseUniformQuaternion")
    uniform_linear: tuple[float, float, float] = vector3(unit="m/s", element="noiseUniformLinearVelocity")
    uniform_angular: tuple[float, float, float] = vector3(unit="rad/s", element="noiseUniformAngularVelocity")
    seed: bool = without_effect(element="randomEngineSeed")
    image: str = text(element="covarianceImage")
    image_scale: bool = without_effect(element="covarianceImageScale")


class RotorsOdometry(ModelPlugin):
    """Publishes pose and twist of the link `<linkName>` in `<parentFrameId>`, with noise and delay.

    The position is that of the centre of mass; the twist is in the axes of the link. Every `<measurementDivisor>`-th
    step has a reading, which is published `<measurementDelay>` steps later. `<unknownDelay>` is added to its stamp.
    """

    endpoints = (
        publishes("/{robotNamespace}/odometry", _ODOMETRY, named_by=("odometryTopic",)),
        publishes("/{robotNamespace}/pose", _POSE, named_by=("poseTopic",)),
        publishes("/{robotNamespace}/pose_with_covariance", _POSE_COVARIANCE, named_by=("poseWithCovarianceTopic",)),
        publishes("/{robotNamespace}/position", _POINT, named_by=("positionTopic",)),
        publishes("/{robotNamespace}/transform", _TRANSFORM, named_by=("transformTopic",)),
        publishes("/tf", _TRANSFORMS),
    )
    options = OptionsOf(RotorsOdometryOptions)
    filenames = ("librotors_gazebo_odometry_plugin.so",)
    reads_at_load = ("inertial",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        self._name, self._parent = find_named_link(scene, "linkName", params), ""
        self._centre = next(
            (np.array(k.inertial.com) for k in scene.all_links() if k.scoped == self._name), np.zeros(3)
        )
        if options.parent_frame != "world":
            link = find_link(scene, options.parent_frame, params.block("parentFrameId"))
            self._parent = "" if link is None else link.scoped
        if options.image:
            message = "<covarianceImage> has no effect: the odometry is published everywhere"
            params.block("covarianceImage").warning("SK-PLUGIN-111", message)

    def load(self, parent: Model, params: Params) -> None:
        options = self.options
        self._link = self.sim.link(self._name)
        self._base = self.sim.link(self._parent) if self._parent else None
        self._queue: deque[tuple[int, int, Pose, Vector]] = deque()
        normal = options.normal_position, options.normal_turn, options.normal_linear, options.normal_angular
        uniform = options.uniform_position, options.uniform_turn, options.uniform_linear, options.uniform_angular
        self._normal, self._uniform = np.array(normal).reshape(12), np.array(uniform).reshape(12)
        self._streams = self.random("normal", 12), self.random("uniform", 12)
        self._outputs = {
            _ODOMETRY: self.advertise(options.odometry, _ODOMETRY),
            _POSE: self.advertise(options.pose, _POSE),
            _POSE_COVARIANCE: self.advertise(options.pose_with_covariance, _POSE_COVARIANCE),
            _POINT: self.advertise(options.position, _POINT),
            _TRANSFORM: self.advertise(options.transform, _TRANSFORM),
            _TRANSFORMS: self.advertise("/tf", _TRANSFORMS),
        }

    def after_step(self) -> None:
        """Take a reading, and publish the one that is due."""
        options, tick = self.options, self.sim.tick
        is_wanted = any(output.wanted for output in self._outputs.values())
        if tick % options.divisor == 0 and (is_wanted or options.delay):
            self._queue.append((tick + options.delay, self.sim.time_ns, *self._read()))
        while self._queue and self._queue[0][0] <= tick:
            _, time_ns, pose, twist = self._queue.popleft()
            if is_wanted:
                self._publish(time_ns + round(options.unknown_delay * _NS), *self._with_noise(pose, twist))

    def _read(self) -> tuple[Pose, Vector]:
        """Return the pose, and linear and angular velocity in the axes of the link."""
        link, base = self._link, self._base
        pose, velocity = link.pose, link.spatial_velocity()
        linear, angular = velocity[3:], velocity[:3]
        centre = Pose(pose.transform(self._centre), pose.quaternion)
        if base is not None:
            frame, turning = base.pose, base.angular_velocity
            linear = linear - base.linear_velocity - np.cross(turning, centre.position - frame.position)
            angular = angular - turning
            centre = frame.inverse() @ centre
        back = quat_conjugate(pose.quaternion)
        return centre, np.concatenate((quat_rotate(back, linear), quat_rotate(back, angular)))

    def _with_noise(self, pose: Pose, twist: Vector) -> tuple[Pose, Vector]:
        if not (self._normal.any() or self._uniform.any()):
            return pose, twist
        normal, uniform = (
            np.asarray(draw(self.sim.tick)) for draw in (self._streams[0].normal, self._streams[1].uniform)
        )
        error = self._normal * normal + self._uniform * uniform
        x, y, z = (error[3:6] / 2).tolist()
        turned = quat_multiply(pose.quaternion, np.array((1.0, x, y, z)))  # `Pose` makes its length 1
        return Pose(pose.position + error[:3], turned), twist + error[6:]

    def _publish(self, time_ns: int, pose: Pose, twist: Vector) -> None:
        options = self.options
        header = msgs.header(time_ns, options.parent_frame)
        w, x, y, z = pose.quaternion.tolist()
        point, turn = xyz(pose.position), {"x": x, "y": y, "z": z, "w": w}
        place = {"position": point, "orientation": turn}
        covered = {"pose": place, "covariance": np.diag(self._normal[:6] ** 2).reshape(36)}
        motion = {"linear": xyz(twist[:3]), "angular": xyz(twist[3:])}
        moved = {"twist": motion, "covariance": np.diag(self._normal[6:] ** 2).reshape(36)}
        child = options.child_frame
        transform = {"header": header, "child_frame_id": child, "transform": {"translation": point, "rotation": turn}}
        makers = {
            _ODOMETRY: partial(msgs.make, _ODOMETRY, header=header, child_frame_id=child, pose=covered, twist=moved),
            _POSE: partial(msgs.make, _POSE, **place),
            _POSE_COVARIANCE: partial(msgs.make, _POSE_COVARIANCE, header=header, pose=covered),
            _POINT: partial(msgs.make, _POINT, header=header, point=point),
            _TRANSFORM: partial(msgs.make, _TRANSFORM, **transform),
            _TRANSFORMS: partial(msgs.make, _TRANSFORMS, transforms=[transform]),
        }
        for kind, output in self._outputs.items():
            if output.wanted:
                output.publish(makers[kind]())


class RotorsPressureOptions(RotorsSensorOptions):
    """Options of `RotorsPressure`."""

    topic: str = text("air_pressure", element="pressureTopic")
    altitude: float = number(500.0, "m", element="referenceAltitude", minimum=-1e4, maximum=1e6)
    variance: float = number(0.0, "Pa²", element="pressureVariance", minimum=0.0, maximum=1e12)


class RotorsPressure(ModelPlugin):
    """Publishes the pressure of the standard atmosphere at the height of the model, at every step."""

    endpoints = (publishes("/{robotNamespace}/air_pressure", _PRESSURE, named_by=("pressureTopic",)),)
    options = OptionsOf(RotorsPressureOptions)
    filenames = ("librotors_gazebo_pressure_plugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self.options.read_all()
        self._name = find_named_link(scene, "linkName", params)

    def load(self, parent: Model, params: Params) -> None:
        self._model, self._frame = parent, self.sim.link(self._name).name
        self._stream = self.random("pressure", 1)
        self._output = self.advertise(self.options.topic, _PRESSURE)

    def after_step(self) -> None:
        """Publish a reading."""
        if not self._output.wanted:
            return
        options = self.options
        height = options.altitude + float(self._model.pose.position[2])
        temperature = max(_WARM - _LAPSE * _EARTH * height / (_EARTH + height), _COLDEST)
        pressure = _SEA_LEVEL * math.exp(_EXPONENT * math.log(_WARM / temperature))
        pressure += math.sqrt(options.variance) * float(np.asarray(self._stream.normal(self.sim.tick))[0])
        header = msgs.header(self.sim.time_ns, self._frame)
        self._output.publish(msgs.make(_PRESSURE, header=header, fluid_pressure=pressure, variance=options.variance))


class RotorsMagnetometerOptions(RotorsSensorOptions):
    """Options of `RotorsMagnetometer`."""

    topic: str = text("magnetic_field", element="magnetometerTopic")
    north: float = number(0.000021493, "T", element="refMagNorth", minimum=-1.0, maximum=1.0)
    east: float = number(0.000000815, "T", element="refMagEast", minimum=-1.0, maximum=1.0)
    down: float = number(0.000042795, "T", element="refMagDown", minimum=-1.0, maximum=1.0)
    noise: tuple[float, float, float] = vector3(unit="T", element="noiseNormal")
    bias: tuple[float, float, float] = vector3(unit="T", element="noiseUniformInitialBias")


class RotorsMagnetometer(ModelPlugin):
    """Publishes the magnetic field in the axes of the link `<linkName>`, at every step.

    `<refMagNorth>`, `<refMagEast>` and `<refMagDown>` are the components along the world's x, y and z axes.
    """

    endpoints = (publishes("/{robotNamespace}/magnetic_field", _FIELD, named_by=("magnetometerTopic",)),)
    options = OptionsOf(RotorsMagnetometerOptions)
    filenames = ("librotors_gazebo_magnetometer_plugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self.options.read_all()
        self._name = find_named_link(scene, "linkName", params)

    def load(self, parent: Model, params: Params) -> None:
        options = self.options
        self._link = self.sim.link(self._name)
        bias = np.array(options.bias) * np.asarray(self.random("bias", 3).uniform(0))
        self._field = np.array((options.north, options.east, options.down)) + bias
        self._noise, self._stream = np.array(options.noise), self.random("noise", 3)
        self._output = self.advertise(options.topic, _FIELD)

    def after_step(self) -> None:
        """Publish a reading."""
        if not self._output.wanted:
            return
        field = self._field + self._noise * np.asarray(self._stream.normal(self.sim.tick))
        message = msgs.make(
            _FIELD,
            header=msgs.header(self.sim.time_ns, self._link.name),
            magnetic_field=xyz(matmul(field, self._link.pose.matrix)),
            magnetic_field_covariance=np.diag(self._noise**2).reshape(9),
        )
        self._output.publish(message)


class RotorsGpsOptions(RotorsSensorOptions):
    """Options of `RotorsGps`."""

    topic: str = text("gps", element="gpsTopic")
    speed_topic: str = text("ground_speed", element="groundSpeedTopic")
    horizontal: float = number(0.1, "m/s", element="horVelStdDev", minimum=0.0, maximum=1e6)
    vertical: float = number(0.1, "m/s", element="verVelStdDev", minimum=0.0, maximum=1e6)
    horizontal_position: bool = without_effect(element="horPosStdDev")
    vertical_position: bool = without_effect(element="verPosStdDev")


class RotorsGps(SensorPlugin):
    """Publishes the fix of a gps sensor on `<gpsTopic>`, and the velocity in the world on `<groundSpeedTopic>`.

    The noise of the fix is that of the sensor.
    """

    endpoints = (
        publishes("/{robotNamespace}/gps", _FIX, named_by=("gpsTopic",)),
        publishes("/{robotNamespace}/ground_speed", _TWIST, named_by=("groundSpeedTopic",)),
    )
    options = OptionsOf(RotorsGpsOptions)
    filenames = ("librotors_gazebo_gps_plugin.so",)

    def load(self, parent: Any, params: Params) -> None:
        options = self.options.read_all()
        if parent.kind not in ("gps", "navsat"):
            self.refuse(parent, "gps")
            return
        self._link: Link = self.sim.link(parent.scene.parent)
        parent.frame_id = self._link.name
        parent.publish_on({"fix": self.ros.topic(options.topic)})
        self.after_step_rate = parent.update_rate or None
        self._spread = np.array((options.horizontal, options.horizontal, options.vertical))
        self._stream = self.random("speed", 3)
        self._output = self.advertise(options.speed_topic, _TWIST)

    def after_step(self) -> None:
        """Publish the velocity."""
        if self._output.wanted:
            drawn = np.asarray(self._stream.normal(self.sim.tick))
            velocity: Vector = self._link.linear_velocity + self._spread * drawn
            message: Message = msgs.make(
                _TWIST, header=msgs.header(self.sim.time_ns, self._link.name), twist={"linear": xyz(velocity)}
            )
            self._output.publish(message)
