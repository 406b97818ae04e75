"""Inertial sensor and true pose of underwater vehicles: plugins of uuv_simulator.

Parameters, defaults, topics and formulas are those of `IMUROSPlugin.cc` and `PoseGTROSPlugin.cc`. The noise is that of
RotorS (Furrer et al., 2016), multiplied by `<noise_amplitude>`, which is 0 by default.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from simkit import Pose, msgs
from simkit.extend import OptionsOf, Vector, boolean, number, publishes, vector3
from simkit.linear_algebra import matmul
from simkit.pose import quat_conjugate, quat_from_rpy, quat_multiply
from simkit_water_and_air.message_fields import diagonal, xyz
from simkit_water_and_air.plugins.classic.px4_sensors import GaussMarkovNoise
from simkit_water_and_air.plugins.uuv.uuv_sensor import UuvSensor, UuvSensorOptions

_IMU: Final = "sensor_msgs/msg/Imu"
_ODOMETRY: Final = "nav_msgs/msg/Odometry"
_TOPIC: Final = "/{robot_namespace}/{sensor_topic}"


class UuvImuOptions(UuvSensorOptions):
    """Options of `UuvImu`."""

    gyro_density: float = number(2 * 35 / 3600 * math.pi / 180, element="gyroscope_noise_density", minimum=0)
    gyro_walk: float = number(2 * 4.0 / 3600 * math.pi / 180, element="gyroscope_bias_random_walk", minimum=0)
    gyro_time: float = number(1e3, "s", element="gyroscope_bias_correlation_time", minimum=1e-6)
    gyro_turn_on: float = number(0.5 * math.pi / 180, "rad/s", element="gyroscope_turn_on_bias_sigma", minimum=0)
    force_density: float = number(2 * 2.0e-3, element="accelerometer_noise_density", minimum=0)
    force_walk: float = number(2 * 3.0e-3, element="accelerometer_random_walk", minimum=0)
    force_time: float = number(300.0, "s", element="accelerometer_bias_correlation_time", minimum=1e-6)
    force_turn_on: float = number(20e-3 * 9.8, "m/s²", element="accelerometer_turn_on_bias_sigma", minimum=0)
    orientation_noise: float = number(0.5, "rad", minimum=0, maximum=10.0)


class UuvImu(UuvSensor):
    """Measures angular rate and specific force in the axes of the link, and its orientation in the reference frame.

    As in the source, the orientation always has noise of `<orientation_noise>` squared, also without
    `<noise_amplitude>`; 0 switches it off.
    """

    options = OptionsOf(UuvImuOptions)
    endpoints = (*UuvSensor.endpoints, publishes(_TOPIC, _IMU))
    filenames = ("libuuv_gazebo_ros_imu_plugin.so",)
    width = 15

    def start(self, base: str) -> None:
        options = self._settings
        drawn = np.asarray(self.random("turn on", 6).normal(0))
        gyro = options.gyro_density, options.gyro_walk, options.gyro_time, options.gyro_turn_on
        force = options.force_density, options.force_walk, options.force_time, options.force_turn_on
        self._gyro, self._force = GaussMarkovNoise(*gyro, drawn[:3]), GaussMarkovNoise(*force, drawn[3:])
        self._output = self.advertise(base, _IMU)

    def measure(self, drawn: Vector, elapsed: float) -> None:
        options, link, pose = self._settings, self.link, self.link.pose
        axes = pose.matrix
        rate = self.in_axes_of_link(matmul(link.angular_velocity, axes))
        force = self.in_axes_of_link(matmul(link.linear_acceleration - self.sim.mj_model.opt.gravity, axes))
        rate = rate + options.amplitude * self._gyro.advance(elapsed, drawn[:6])
        force = force + options.amplitude * self._force.advance(elapsed, drawn[6:12])
        if not self._output.wanted:
            return
        turn = quat_multiply(pose.quaternion, quat_conjugate(self.reference_pose.quaternion))
        half = 0.5 * options.orientation_noise * options.orientation_noise * drawn[12:]
        w, x, y, z = Pose((0.0, 0.0, 0.0), quat_multiply(turn, np.concatenate(((1.0,), half)))).quaternion.tolist()
        length = math.sqrt(w * w + x * x + y * y + z * z)
        spreads = (options.orientation_noise, options.gyro_density, options.force_density)
        around, rates, forces = (diagonal(9, *[spread**2] * 3) for spread in spreads)
        self._output.publish(
            msgs.make(
                _IMU,
                header=msgs.header(self.sim.time_ns, link.name),
                orientation={"w": w / length, "x": x / length, "y": y / length, "z": z / length},
                orientation_covariance=around,
                angular_velocity=xyz(rate),
                angular_velocity_covariance=rates,
                linear_acceleration=xyz(force),
                linear_acceleration_covariance=forces,
            )
        )


class UuvPoseOptions(UuvSensorOptions):
    """Options of `UuvPose`."""

    shift: tuple[float, float, float] = vector3(unit="m", element="position_offset")
    turn: tuple[float, float, float] = vector3(unit="rad", element="orientation_offset")
    has_ned: bool = boolean(element="publish_ned_odom")


class UuvPose(UuvSensor):
    """Publishes the true pose and twist of the link in the world as odometry, with noise on the twist.

    `<publish_ned_odom>` publishes them in the frame `<static_reference_frame>` on `<sensor_topic>_ned`, too.
    """

    options = OptionsOf(UuvPoseOptions)
    endpoints = (*UuvSensor.endpoints, publishes(_TOPIC, _ODOMETRY), publishes(f"{_TOPIC}_ned", _ODOMETRY))
    filenames = ("libuuv_gazebo_ros_pose_gt_plugin.so",)
    width = 6

    def start(self, base: str) -> None:
        options = self._settings
        self._offset = Pose(options.shift, quat_from_rpy(*options.turn))
        self._output = self.advertise(base, _ODOMETRY)
        self._ned = self.advertise(f"{base}_ned", _ODOMETRY) if options.has_ned else None

    def measure(self, drawn: Vector, elapsed: float) -> None:
        link, pose, noise = self.link, self.link.pose, self.noise(drawn)
        linear, angular = link.linear_velocity, link.angular_velocity
        if self._reference is not None:
            linear, angular = linear - self._reference.linear_velocity, angular - self._reference.angular_velocity
        linear, angular = linear + noise[:3], angular + noise[3:]
        if self._output.wanted:
            self._output.publish(self._message("world", link.name, pose, linear, angular))
        if self._ned is not None and self._ned.wanted:
            frame = self.reference_pose
            place = frame.inverse().transform(pose.position)
            turn = quat_multiply(frame.quaternion, quat_multiply(pose.quaternion, quat_from_rpy(math.pi, 0.0, 0.0)))
            axes, name = frame.matrix, f"{link.name}_ned"
            motion = matmul(axes, linear), matmul(axes, angular)
            self._ned.publish(self._message(self.reference_frame_id, name, Pose(place, turn), *motion))

    def _message(self, frame: str, child: str, pose: Pose, linear: Vector, angular: Vector) -> object:
        shifted = Pose(pose.position + self._offset.position, quat_multiply(self._offset.quaternion, pose.quaternion))
        w, x, y, z = shifted.quaternion.tolist()
        covariance = diagonal(36, *[self._settings.sigma**2] * 6)
        turn = {"w": w, "x": x, "y": y, "z": z}
        return msgs.make(
            _ODOMETRY,
            header=msgs.header(self.sim.time_ns, frame),
            child_frame_id=child,
            pose={"pose": {"position": xyz(shifted.position), "orientation": turn}, "covariance": covariance},
            twist={"twist": {"linear": xyz(linear), "angular": xyz(angular)}, "covariance": covariance},
        )
