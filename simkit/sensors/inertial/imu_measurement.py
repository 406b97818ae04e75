"""Measurements of an inertial unit: orientation, rate and specific force in the sensor's own frame, with noise."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import mujoco
import numpy as np

from simkit.compiler import Compiled
from simkit.params import Params
from simkit.pose import Vector, quat_conjugate, quat_from_rpy, quat_multiply
from simkit.sensors.base import Sensor
from simkit.sensors.bias_drift import NoiseInterval
from simkit.sensors.inertial.inertial_kinematics import (
    NO_ROTATION,
    QuaternionTuple,
    hamilton_product,
    quaternion_of_rotation_vector,
    sensor_motion,
)
from simkit.sensors.inertial.orientation_reference import OrientationReference, read_reference, reference_orientation
from simkit.sensors.noise import Noise, NoiseModel, ThreeAxes, read_axes, read_noise
from simkit.sensors.sample import Memory

_unpack_numbers = struct.Struct("=31d").unpack  # of what is captured


@dataclass(frozen=True, slots=True)
class ImuOptions:
    """The `<imu>` block.

    Attributes:
        angular_velocity: noise per axis [rad/s].
        linear_acceleration: noise per axis [m/s²].
        orientation: noise per axis [rad]: a small turn of the measured attitude about the sensor's axes.
        reference: what the orientation is measured against; None for the attitude at the start.
        enable_orientation: False leaves the orientation out.
    """

    angular_velocity: ThreeAxes
    linear_acceleration: ThreeAxes
    orientation: ThreeAxes
    reference: OrientationReference | None
    enable_orientation: bool


class ImuReading(NamedTuple):
    """What the unit feels.

    Attributes:
        orientation: attitude (w, x, y, z) against the reference.
        motion: rate [rad/s] and specific force [m/s²] in the sensor frame, six numbers.
    """

    orientation: Sequence[float]
    motion: Sequence[float]

    @property
    def angular_velocity(self) -> Vector:
        """[rad/s], shape (3,)."""
        return np.array(self.motion[:3])

    @property
    def linear_acceleration(self) -> Vector:
        """[m/s²], gravity's reaction included, shape (3,)."""
        return np.array(self.motion[3:])


def _read_axis_noise(quantity: Params) -> ThreeAxes:
    """`<x>`, `<y>`, `<z>` with a `<noise>` each; one `<noise>` beside them is for the axes that have none."""
    return read_axes(quantity, read_noise(quantity))


class ImuMeasurement(Sensor):
    """Base of `imu`: specific force, angular rate and attitude, with noise and covariances, without a message.

    Attributes:
        reference: (w, x, y, z) of the frame that the orientation is measured against, in the world.
    """

    gathers = True
    has_dynamic_bias = True
    needs_acceleration = True
    options: ImuOptions
    noise: Noise

    def read_options(self, params: Params) -> ImuOptions:
        block = params.block("imu")
        return ImuOptions(
            angular_velocity=_read_axis_noise(block.block("angular_velocity")),
            linear_acceleration=_read_axis_noise(block.block("linear_acceleration")),
            orientation=_read_axis_noise(block.block("orientation")),
            reference=read_reference(block),
            enable_orientation=block.boolean("enable_orientation", True),
        )

    def describe(self) -> dict[str, object]:
        reference = self.options.reference
        return {
            "imu": {
                "reference": reference.localization if reference else "start",
                "parent_frame": reference.parent_frame if reference else "",
                "orientation": self.options.enable_orientation,
            }
        }

    def prepare(self) -> None:
        options = self.options
        self.noise = self._make_noise((*options.angular_velocity, *options.linear_acceleration), "imu")
        self._attitude_noise = self._make_noise(options.orientation, "orientation")
        self._more_noise: Noise | None = None
        self._covariances_of: NoiseInterval | None = None
        self._covariances: list[Vector] = []
        self.set_orientation_reference(reference_orientation(options.reference, self.scene, self.sim))

    def set_orientation_reference(self, reference: Vector | QuaternionTuple) -> None:
        """Sets the frame, (w, x, y, z) in the world, that the orientation is measured against."""
        self.batch = None  # until the next schedule
        self.reference = np.array(reference, dtype=np.float64)
        w, x, y, z = self.reference.tolist()
        self._from_reference: QuaternionTuple = (w, -x, -y, -z)

    def rotate_orientation(self, rpy: tuple[float, float, float]) -> None:
        """Turns every orientation by roll, pitch, yaw [rad] about the reference's axes."""
        self.set_orientation_reference(quat_multiply(self.reference, quat_conjugate(quat_from_rpy(*rpy))))

    def add_white_noise(self, stddev: float) -> None:
        """Noise on top of the file's, the same number on every rate [rad/s], acceleration [m/s²] and angle [rad]."""
        self.batch = None
        self._more_noise = self._make_noise((NoiseModel(stddev=stddev),) * 9, "more")
        self._covariances_of = None

    @property
    def is_mounted_straight(self) -> bool:
        """Whether its axes are those of the body that it is on."""
        return self._mount == NO_ROTATION

    @property
    def is_against_world(self) -> bool:
        """Whether its orientation is measured against the world's axes."""
        return self._from_reference == NO_ROTATION

    def bind(self, compiled: Compiled) -> None:
        super().bind(compiled)
        # as numbers: so few are sooner multiplied one by one than by NumPy
        self._arm: tuple[float, ...] = tuple(self._offset_position.tolist())
        self._mount: QuaternionTuple = tuple(self._offset.quaternion.tolist())
        self._rotation: tuple[float, ...] = tuple(self._offset_rotation.reshape(9).tolist())
        self._viewed: mujoco.MjData | None = None

    # ------------------------------------------------------------------ measuring

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> ImuReading:
        return self.finish(self.capture(model, data))

    def capture(self, model: mujoco.MjModel, data: mujoco.MjData) -> bytes:
        """How the body lies and moves, see `_look_at`; as bytes, which are the soonest taken."""
        if data is not self._viewed:
            self._bind_views(model, data)
        return b"".join(self._views)

    def _bind_views(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Chooses what is captured: the body's quaternion, rotation matrix and place, and the point that its spatial
        velocity and acceleration (rotation first, in world axes) are of."""
        body, self._viewed = self._body, data
        root = int(model.body_rootid[body])
        self._views = (
            data.xquat[body],
            data.xmat[body],
            data.xpos[body],
            data.subtree_com[root],
            data.cvel[body],
            data.cacc[body],
        )

    def finish(self, raw: bytes) -> ImuReading:
        mount = None if self.is_mounted_straight else self._mount
        reference = None if self.is_against_world else self._from_reference
        return ImuReading(*sensor_motion(_unpack_numbers(raw), self._arm, mount, self._rotation, reference))

    def perturb(self, reading: ImuReading, index: int) -> ImuReading:
        orientation, motion = reading.orientation, reading.motion
        if not self.noise.is_silent:
            motion = self.noise.apply_to_numbers(motion, index)
        if not self._attitude_noise.is_silent:
            turn = self._attitude_noise.apply_to_numbers((0.0, 0.0, 0.0), index)
            orientation = hamilton_product(orientation, quaternion_of_rotation_vector(turn))
        if self._more_noise is not None:
            numbers = self._more_noise.apply_to_numbers((*motion, 0.0, 0.0, 0.0), index)
            motion, orientation = (
                numbers[:6],
                hamilton_product(orientation, quaternion_of_rotation_vector(numbers[6:])),
            )
        return ImuReading(orientation, motion)

    def memory(self) -> object:
        return super().memory(), self.reference

    def remember(self, memory: Memory) -> None:
        super().remember(memory[0])
        self.set_orientation_reference(memory[1])

    def covariances(self) -> list[Vector]:
        """Return the covariances of orientation, rate and force; anew where white noise follows the sample interval."""
        noise = self.noise
        if self._covariances_of is noise.state.interval:
            return self._covariances
        self._covariances_of = noise.state.interval
        of_all = [self._attitude_noise.covariance(), noise.covariance(), noise.covariance(3)]
        if self._more_noise is not None:
            of_all = [of_file + self._more_noise.covariance() for of_file in of_all]
        if not self.options.enable_orientation:
            of_all[0] = np.zeros(9)
            of_all[0][0] = -1.0  # as ROS says that there is none
        for covariance in of_all:
            covariance.flags.writeable = False
        self._covariances = of_all
        return of_all
