"""IMUs of Gazebo Classic: ROS 1's `libgazebo_ros_imu.so` on a model, `libgazebo_ros_imu_sensor.so` on a sensor."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from simkit import msgs
from simkit.linear_algebra import matmul
from simkit.params import LARGEST, Params
from simkit.plugins.base import ModelPlugin, SensorPlugin
from simkit.plugins.endpoints import offers, publishes
from simkit.plugins.find_entities import SensorFrameOptions, find_named_link
from simkit.plugins.options import Options, OptionsOf, boolean, number, text, vector3, without_effect
from simkit.pose import Pose, Vector, quat_from_rpy, quat_multiply

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneModel
    from simkit.sensors.inertial.imu_measurement import ImuMeasurement

TYPE = "sensor_msgs/msg/Imu"
_DEFAULT = "/default_imu"  # default name of both the topic and the service


class GazeboRosImuOptions(Options):
    """Options of `GazeboRosImu`."""

    body_name: str = text(element="bodyName", required=True)
    topic_name: str = text(_DEFAULT, element="topicName")
    service_name: str = text(_DEFAULT, element="serviceName")
    frame_name: str = text(element="frameName")
    gaussian_noise: float = number(0.0, element="gaussianNoise", minimum=0, maximum=LARGEST)
    rpy_offset: tuple[float, float, float] = vector3(unit="rad", element="rpyOffset")
    update_rate: float = number(0.0, "Hz", element="updateRate", minimum=0)
    always_on: bool = without_effect(element="alwaysOn")
    xyz_offset: tuple[float, float, float] = vector3(unit="m", element="xyzOffset")


class GazeboRosImu(ModelPlugin):
    """Publishes the reading of an IMU at the origin of the link `<bodyName>` on `<topicName>` (`/default_imu`).

    Rates and accelerations are in the link's axes; the orientation is the link's orientation in the world, turned by
    `<rpyOffset>` about the world's axes. `<frameName>` (the link's name) sets only the `frame_id`. The acceleration
    includes the reaction to gravity, as `sensor_msgs/Imu` requires. Gazebo's plugin omits this reaction and turns both
    vectors in the wrong direction; simkit does the same only in a world with `<gazebo_quirks>`. `<gaussianNoise>` is
    the standard deviation of the noise on each of the six numbers [rad/s, m/s²]; its square is on the diagonals of the
    covariances. `<updateRate>` is in Hz; 0 means every step. The calibration service `<serviceName>` (`/default_imu`)
    does nothing.
    """

    endpoints = (
        publishes("/default_imu", TYPE, named_by=("topicName",)),
        offers("/default_imu", "std_srvs/srv/Empty", named_by=("serviceName",)),
    )
    options = OptionsOf(GazeboRosImuOptions)
    filenames = ("libgazebo_ros_imu.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._body = find_named_link(scene, "bodyName", params)
        options = self.options.read_all()
        self._frame = options.frame_name.strip("/") or self._body.rsplit("::", 1)[-1]
        self._deviation = options.gaussian_noise
        self._turn = quat_from_rpy(*options.rpy_offset)
        self.after_step_rate = options.update_rate
        if any(options.xyz_offset):
            message = f"plugin {self.name!r}: <xyzOffset> changes no reading, as in Gazebo"
            params.diagnostics.note("SK-SENSOR-072", message, params.block("xyzOffset").where)
        self._is_gazebos = builder.world.gazebo_quirks
        if not self._is_gazebos:
            message = f"plugin {self.name!r}: the acceleration includes gravity's reaction; Gazebo's plugin omits it"
            hint = "for Gazebo's reading, add <simkit:gazebo_quirks>true</simkit:gazebo_quirks> to the world"
            params.diagnostics.note("SK-PLUGIN-060", message, self.where, hint)

    def load(self, parent: Model, params: Params) -> None:
        self._link = self.sim.link(self._body)
        topic, service = self.options.topic_name, self.options.service_name
        self._out = self.advertise(topic, TYPE) if topic else None
        if service and self.ros.topic(service) not in self.sim.communication.services.names():
            self.offer(service, "std_srvs/srv/Empty", lambda _request: None)
        self._stream = self.random("gaussianNoise", 6) if self._deviation > 0 else None
        self._index = 0
        covariance = np.diag([self._deviation**2] * 3).reshape(9)
        covariance.flags.writeable = False
        self._covariance = covariance

    def after_step(self) -> None:
        self._index += 1  # counted even without subscribers, because the noise depends on this number
        if self._out is None or not self._out.wanted:
            return
        link, pose = self._link, self._link.pose
        rate, acceleration = link.angular_velocity, link.linear_acceleration
        attitude = quat_multiply(self._turn, pose.quaternion)
        axes = pose.matrix
        if self._is_gazebos:
            axes = Pose(pose.position, attitude).matrix.T
        else:
            acceleration = acceleration - self.sim.mj_model.opt.gravity
        motion = np.concatenate((matmul(rate, axes), matmul(acceleration, axes)))
        self._out.publish_later(partial(self._message, self.sim.time_ns, attitude, motion, self._index))

    def _message(self, time_ns: int, attitude: Vector, motion: Vector, index: int) -> object:
        if self._stream is not None:
            motion = motion + self._deviation * self._stream.normal(index)
        vector, quaternion = (msgs.type_of(f"geometry_msgs/msg/{name}") for name in ("Vector3", "Quaternion"))
        w, x, y, z = attitude.tolist()
        rate, acceleration = vector(*motion[:3].tolist()), vector(*motion[3:].tolist())
        spread = self._covariance
        header = msgs.header(time_ns, self._frame)
        return msgs.type_of(TYPE)(header, quaternion(x, y, z, w), spread, rate, spread, acceleration, spread)


_WORLD = (1.0, 0.0, 0.0, 0.0)


class GazeboRosImuSensorOptions(SensorFrameOptions):
    """Options of `GazeboRosImuSensor`."""

    topic_name: str = text(element="topicName")
    initial_orientation_as_reference_ros_1: bool = boolean(element="initialOrientationAsReference")
    initial_orientation_as_reference: bool = boolean(instead="initial_orientation_as_reference_ros_1")
    body_name: str = text(element="bodyName")
    gaussian_noise: float = number(0.0, element="gaussianNoise", minimum=0, maximum=LARGEST)
    rpy_offset: tuple[float, float, float] = vector3(unit="rad", element="rpyOffset")
    xyz_offset: tuple[float, float, float] = vector3(unit="m", element="xyzOffset")
    update_rate_hz: float = number(0.0, "Hz", element="updateRateHZ", minimum=0)


class GazeboRosImuSensor(SensorPlugin):
    """Publishes its IMU on `~/out` (after `<remapping>`), in the link's frame or `<frame_name>`.

    The orientation is relative to the world (REP 145). If `<initial_orientation_as_reference>` is true, it is relative
    to the orientation at the start. In ROS 1, `<gaussianNoise>` adds noise to all published numbers, `<rpyOffset>`
    turns the orientation, and `<updateRateHZ>` may lower the sensor's rate.
    """

    endpoints = (publishes("~/out", "sensor_msgs/msg/Imu", named_by=("topicName",)),)
    options = OptionsOf(GazeboRosImuSensorOptions)
    filenames = ("libgazebo_ros_imu_sensor.so",)
    only_publishes = True

    def load(self, parent: ImuMeasurement, params: Params) -> None:
        topic = self.ros.topic(self.options.topic_name or "~/out")
        from_start = self.options.initial_orientation_as_reference
        body = self.options.body_name
        if not hasattr(parent, "set_orientation_reference"):
            self.refuse(parent, "imu")
            return
        is_named = any(params.has(name) for name in ("frame_name", "frameName"))
        frame = self.options.frame_of(parent)
        parent.frame_id = body if body and not is_named else frame
        parent.set_orientation_reference(parent.scene.pose_world.quaternion if from_start else _WORLD)
        parent.publish_on({"imu": topic})
        self._read_ros_1(parent, params)

    def _read_ros_1(self, imu: ImuMeasurement, params: Params) -> None:
        stddev = self.options.gaussian_noise
        if stddev:
            imu.add_white_noise(stddev)
        turn = self.options.rpy_offset
        if any(turn):
            imu.rotate_orientation(turn)
        if any(self.options.xyz_offset):
            where = params.block("xyzOffset").where
            message = f"plugin {self.name!r}: <xyzOffset> changes no reading, as in Gazebo"
            params.diagnostics.note("SK-SENSOR-072", message, where, "move the sensor with its <pose> instead")
        rate = self.options.update_rate_hz
        if rate and not 0 < imu.update_rate <= rate:
            imu.set_rate(rate)
