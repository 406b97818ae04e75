"""Inertial measurement unit: everything in the sensor's own frame, at the sensor's own place."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from simkit import msgs
from simkit.diagnostics import Diagnostics
from simkit.params import Params
from simkit.pose import Vector, quat_conjugate, quat_from_rpy, quat_multiply
from simkit.sensors.base import Product, Sensor
from simkit.sensors.noise import Noise, NoiseModel, read_noise, variance

if TYPE_CHECKING:
    from simkit.scene import SceneSensor

TYPE = "sensor_msgs/msg/Imu"
_BODY = int(mujoco.mjtObj.mjOBJ_XBODY)
object_velocity, object_acceleration = mujoco.mj_objectVelocity, mujoco.mj_objectAcceleration
# east-north-up to the named axes
_LOCALIZATIONS = {"ENU": (0.0, 0.0, 0.0), "NED": (math.pi, 0.0, math.pi / 2), "NWU": (0.0, 0.0, math.pi / 2)}


@dataclass(frozen=True, slots=True)
class ImuOptions:
    """The `<imu>` block.

    Attributes:
        angular_velocity: noise per axis [rad/s].
        linear_acceleration: noise per axis [m/s²].
        reference: roll, pitch, yaw [rad] of the reference frame in east-north-up axes, or None for the attitude at
            the start.
        enable_orientation: False leaves the orientation out.
    """

    angular_velocity: tuple[NoiseModel, NoiseModel, NoiseModel]
    linear_acceleration: tuple[NoiseModel, NoiseModel, NoiseModel]
    reference: tuple[float, float, float] | None
    enable_orientation: bool


@dataclass(frozen=True, slots=True)
class ImuReading:
    """Attitude (w, x, y, z) against the reference; rate [rad/s] and specific force [m/s²], sensor frame, shape (3,)."""

    orientation: Vector
    angular_velocity: Vector
    linear_acceleration: Vector


def read_options(params: Params) -> ImuOptions:
    block = params.block("imu")
    return ImuOptions(
        angular_velocity=_axes(block, "angular_velocity"),
        linear_acceleration=_axes(block, "linear_acceleration"),
        reference=_reference(block),
        enable_orientation=block.boolean("enable_orientation", True),
    )


def _axes(block: Params, name: str) -> tuple[NoiseModel, NoiseModel, NoiseModel]:
    axes = block.block(name)
    x, y, z = (read_noise(axes.block(axis)) for axis in "xyz")
    return x, y, z


def _reference(block: Params) -> tuple[float, float, float] | None:
    frame = block.child("orientation_reference_frame")
    if frame is None:
        return None
    allowed = ("CUSTOM", "ENU", "NED", "NWU", "GRAV_UP", "GRAV_DOWN")
    localization = frame.choice("localization", allowed, "CUSTOM")
    frame.child("grav_dir_x")
    custom = frame.child("custom_rpy")
    if localization in _LOCALIZATIONS:
        return _LOCALIZATIONS[localization]
    if localization == "CUSTOM" and custom is not None and custom.attribute("parent_frame") == "world":
        return frame.vector3("custom_rpy", (0.0, 0.0, 0.0))
    message = f"orientation reference {localization} is taken as the attitude at the start"
    hint = (
        'a custom one needs <custom_rpy parent_frame="world">'
        if localization == "CUSTOM"
        else "ENU, NED and NWU are known"
    )
    frame.diagnostics.warning("SK-SENSOR-002", message, frame.where, hint)
    return None


class Imu(Sensor):
    """`imu`: specific force, angular rate, attitude.

    Attributes:
        reference: (w, x, y, z) of the frame that the orientation is measured against, in the world.
    """

    kinds = ("imu",)
    example = "<imu/>"
    needs_acceleration = True
    options: ImuOptions
    noise: Noise

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        self.options = read_options(scene.params)

    def prepare(self) -> None:
        options = self.options
        self.noise = self._make_noise((*options.angular_velocity, *options.linear_acceleration), "imu")
        self._rate_covariance = variance(options.angular_velocity)
        self._force_covariance = variance(options.linear_acceleration)
        self._orientation_covariance = np.zeros(9)
        if not options.enable_orientation:
            self._orientation_covariance[0] = -1.0
        self._orientation_covariance.flags.writeable = False
        self._make_types = (
            msgs.type_of(TYPE),
            msgs.type_of("geometry_msgs/msg/Vector3"),
            msgs.type_of("geometry_msgs/msg/Quaternion"),
        )
        if options.reference is None:
            self.measure_against(self.scene.pose_world.quaternion)
        else:
            place = self.sim.world.spherical_coordinates
            heading = quat_from_rpy(0.0, 0.0, place.heading if place else 0.0)
            self.measure_against(quat_multiply(heading, quat_from_rpy(*options.reference)))

    def measure_against(self, reference: Vector | tuple[float, float, float, float]) -> None:
        """Sets the frame, (w, x, y, z) in the world, that the orientation is measured against."""
        self.reference = np.array(reference, dtype=np.float64)
        self._from_reference = quat_conjugate(self.reference)

    def products(self) -> dict[str, Product]:
        return {"imu": Product(TYPE, self._message_of)}

    def default_topics(self) -> dict[str, str]:
        return {"imu": self._default_topic("imu")}

    def measure(self, model: Any, data: Any) -> ImuReading:
        return self.finish(self.capture(model, data))

    def capture(self, model: Any, data: Any) -> tuple[Vector, Vector, Vector]:
        """Attitude of the body, and its velocity and proper acceleration in its own axes."""
        body = self._body
        velocity, acceleration = np.empty(6), np.empty(6)
        object_velocity(model, data, _BODY, body, velocity, 1)
        object_acceleration(model, data, _BODY, body, acceleration, 1)
        return data.xquat[body].copy(), velocity, acceleration

    def finish(self, raw: tuple[Vector, Vector, Vector]) -> ImuReading:
        attitude, velocity, acceleration = raw
        orientation, turn = np.empty(4), np.empty(4)
        mujoco.mju_mulQuat(turn, attitude, self._offset.quaternion)
        mujoco.mju_mulQuat(orientation, self._from_reference, turn)
        rate, force = velocity[:3], acceleration[3:]
        ax, ay, az = self._offset_position.tolist()
        if ax or ay or az:
            # the lever from the body's origin: tangential and centripetal acceleration, in body axes
            wx, wy, wz = rate.tolist()
            dx, dy, dz = acceleration[:3].tolist()
            cx, cy, cz = wy * az - wz * ay, wz * ax - wx * az, wx * ay - wy * ax
            lever = (
                dy * az - dz * ay + wy * cz - wz * cy,
                dz * ax - dx * az + wz * cx - wx * cz,
                dx * ay - dy * ax + wx * cy - wy * cx,
            )
            force = force + np.array(lever)
        return ImuReading(orientation, rate @ self._offset_rotation, force @ self._offset_rotation)

    def perturb(self, reading: ImuReading, index: int) -> ImuReading:
        if self.noise.is_silent:
            return reading
        values = self.noise.apply(np.concatenate((reading.angular_velocity, reading.linear_acceleration)), index)
        return ImuReading(reading.orientation, values[:3], values[3:])

    def memory(self) -> Any:
        return super().memory(), self.reference

    def remember(self, memory: Any) -> None:
        super().remember(memory[0])
        self.measure_against(memory[1])

    def _message_of(self, reading: ImuReading, time_ns: int) -> Any:
        imu, vector, quaternion = self._make_types
        w, x, y, z = reading.orientation.tolist() if self.options.enable_orientation else (1.0, 0.0, 0.0, 0.0)
        return imu(
            msgs.header(time_ns, self.frame_id),
            quaternion(x, y, z, w),
            self._orientation_covariance,
            vector(*reading.angular_velocity.tolist()),
            self._rate_covariance,
            vector(*reading.linear_acceleration.tolist()),
            self._force_covariance,
        )
