"""Measurements of an inertial unit: orientation, rate and specific force in the sensor's own frame, with noise."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import mujoco
import numpy as np

from simkit.compiler import Compiled
from simkit.params import Params
from simkit.pose import Vector, hamilton_product, quat_conjugate, quat_from_rpy, quat_multiply
from simkit.runtime.array_rules import CannotBatchError, Floats, Ids, SensorRule, Ticks
from simkit.sensors.base import Sensor
from simkit.sensors.bias_drift import NoiseInterval
from simkit.sensors.inertial.inertial_kinematics import (
    NO_ROTATION,
    QuaternionTuple,
    quaternion_of_rotation_vector,
    sensor_motion,
)
from simkit.sensors.inertial.orientation_reference import OrientationReference, read_reference, reference_orientation
from simkit.sensors.noise import Noise, NoiseModel, ThreeAxes, read_axes, read_noise
from simkit.sensors.sample import Memory

if TYPE_CHECKING:
    from simkit import msgs  # noqa: F401 (in the type parameter)
    from simkit.runtime.state_arrays import StateArrays

unpack_numbers = struct.Struct("=31d").unpack  # captured numbers


@dataclass(frozen=True, slots=True)
class ImuOptions:
    """The `<imu>` block.

    Attributes:
        angular_velocity: noise per axis [rad/s].
        linear_acceleration: noise per axis [m/s²].
        orientation: noise per axis [rad], applied as a small rotation of the measured attitude about the sensor's axes.
        reference: reference frame of the orientation; None for the attitude at the start.
        enable_orientation: False omits the orientation.
    """

    angular_velocity: ThreeAxes
    linear_acceleration: ThreeAxes
    orientation: ThreeAxes
    reference: OrientationReference | None
    enable_orientation: bool


class ImuReading(NamedTuple):
    """Measurement of an inertial unit.

    Attributes:
        orientation: attitude (w, x, y, z) relative to the reference.
        motion: angular rate [rad/s] and specific force [m/s²] in the sensor frame, six numbers.
    """

    orientation: Sequence[float]
    motion: Sequence[float]

    @property
    def angular_velocity(self) -> Vector:
        """Angular rate in the sensor frame [rad/s], shape (3,)."""
        return np.array(self.motion[:3])

    @property
    def linear_acceleration(self) -> Vector:
        """Specific force in the sensor frame [m/s²], including the reaction to gravity, shape (3,)."""
        return np.array(self.motion[3:])


def _read_axis_noise(quantity: Params) -> ThreeAxes:
    """Read a `<noise>` in each of `<x>`, `<y>` and `<z>`; a `<noise>` beside them applies to the axes without one."""
    return read_axes(quantity, read_noise(quantity))


class ImuMeasurement(Sensor["msgs.Imu"]):
    """Base of `imu`: specific force, angular rate and attitude with noise and covariances, without messages.

    Attributes:
        reference: reference frame of the orientation, as a rotation (w, x, y, z) in the world.
    """

    gathers = True
    has_dynamic_bias = True
    needs_acceleration = True
    options: ImuOptions
    noise: Noise

    @property
    def reads_at_load(self) -> tuple[str, ...]:
        """Numbers of the world that the reference frame follows from."""
        reference = self.options.reference
        return ("gravity",) if reference is not None and reference.localization.startswith("GRAV") else ()

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
        """Set the reference frame of the orientation, as a rotation (w, x, y, z) in the world."""
        self._make_pending_messages()
        self.batch = None  # the sensor samples alone until the batches are formed again
        self.reference = np.array(reference, dtype=np.float64)
        w, x, y, z = self.reference.tolist()
        self._from_reference: QuaternionTuple = (w, -x, -y, -z)

    def rotate_orientation(self, rpy: tuple[float, float, float]) -> None:
        """Rotate every orientation by roll, pitch, yaw [rad] about the reference's axes."""
        self.set_orientation_reference(quat_multiply(self.reference, quat_conjugate(quat_from_rpy(*rpy))))

    def add_white_noise(self, stddev: float) -> None:
        """Add white noise to each rate [rad/s], acceleration [m/s²] and angle [rad], in place of noise added before."""
        self._replace_more_noise(NoiseModel(stddev=stddev))

    def _replace_more_noise(self, model: NoiseModel | None) -> None:
        """Replace the noise that is added to all channels; None for no such noise."""
        self._make_pending_messages()
        self.batch = None
        if self._more_noise is not None:
            self._noises.remove(self._more_noise)
        self._more_noise = None if model is None else self._make_noise((model,) * 9, "more")
        self._covariances_of, self._revision = None, -1

    @property
    def has_plain_noise(self) -> bool:
        """True if the noise is the same function of a sample's number for all samples, without quantisation."""
        is_plain = not (self.noise.evolves or self.noise.is_quantised)
        return is_plain and self._attitude_noise.is_silent and self._more_noise is None

    @property
    def is_mounted_straight(self) -> bool:
        """True if the sensor's axes are parallel to the axes of its body."""
        return self._mount == NO_ROTATION

    @property
    def is_against_world(self) -> bool:
        """True if the world's axes are the reference frame of the orientation."""
        return self._from_reference == NO_ROTATION

    def bind(self, compiled: Compiled) -> None:
        super().bind(compiled)
        # plain numbers, because for so few NumPy is slower
        self._arm: tuple[float, ...] = tuple(self._offset_position.tolist())
        self._mount: QuaternionTuple = tuple(self._offset.quaternion.tolist())
        self._rotation: tuple[float, ...] = tuple(self._offset_rotation.reshape(9).tolist())
        self._viewed: mujoco.MjData | None = None

    # ------------------------------------------------------------------ measuring

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> ImuReading:
        return self.finish(self.capture(model, data))

    def capture(self, model: mujoco.MjModel, data: mujoco.MjData) -> bytes:
        """Return the body's state (see `_bind_views`) as bytes, because bytes are the fastest to copy."""
        if data is not self._viewed:
            self._bind_views(model, data)
        return b"".join(self._views)

    def _bind_views(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Select the captured numbers: quaternion, rotation matrix, position and motion of the body.

        The motion is the spatial velocity and acceleration (rotation first, in world axes), captured with their
        reference point.
        """
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
        return ImuReading(*sensor_motion(unpack_numbers(raw), self._arm, mount, self._rotation, reference))

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
        if len(memory[0]) != len(self._noises):  # the state is from before `add_white_noise`, or from after it
            self._replace_more_noise(NoiseModel() if self._more_noise is None else None)
        super().remember(memory[0])
        if memory[1] is self.reference:
            self._make_pending_messages()
            self.batch = None
            return
        self.set_orientation_reference(memory[1])
        self.reference = memory[1]  # the array is replaced by a change and never written to

    def covariances(self) -> list[Vector]:
        """Return the covariances of orientation, rate and force; recompute them if the sample interval changes."""
        noise = self.noise
        if self._covariances_of is noise.state.interval:
            return self._covariances
        self._covariances_of = noise.state.interval
        covariances = [self._attitude_noise.covariance(), noise.covariance(), noise.covariance(3)]
        if self._more_noise is not None:
            covariances = [c + self._more_noise.covariance() for c in covariances]
        if not self.options.enable_orientation:
            covariances[0] = np.zeros(9)
            covariances[0][0] = -1.0  # the ROS convention for an unavailable quantity
        for covariance in covariances:
            covariance.flags.writeable = False
        self._covariances = covariances
        return covariances


class ImuRule(SensorRule):
    """Readings of an inertial unit on a free base in n simulations: orientation w, x, y, z and `motion`.

    Raises:
        CannotBatchError: the acceleration of the unit's link is not that of a free joint.
    """

    inputs = ("xquat", "xmat", "xpos", "cvel", "qvel", "qacc")

    def __init__(self, imu: ImuMeasurement) -> None:
        model = imu.sim.mj_model
        self._root = int(model.body_weldid[imu._body])
        joint = int(model.body_jntadr[self._root])
        is_free = self._root > 0 and joint >= 0 and int(model.jnt_type[joint]) == mujoco.mjtJoint.mjJNT_FREE
        if not is_free or imu._more_noise is not None:
            raise CannotBatchError(f"sensor {imu.scoped!r}: its link is not rigidly connected to a free base")
        self._imu, self._dof = imu, int(model.jnt_dofadr[joint])

    def bind(self, states: StateArrays, *, is_truth: bool) -> None:
        self._fields = [states.field(name) for name in self.inputs]
        self._noise, self._turns = self._imu.noise.rows(states.count), self._imu._attitude_noise.rows(states.count)
        self._is_truth = is_truth
        self._references, self._gravity = np.zeros((states.count, 4)), np.zeros((states.count, 3))

    def take(self, row: int) -> None:
        self._noise.take(row)
        self._turns.take(row)
        self._references[row], self._gravity[row] = self._imu._from_reference, self._imu.sim.mj_model.opt.gravity

    def read(self, ids: Ids, index: Ticks) -> Floats:
        xquat, xmat, xpos, cvel, qvel, qacc = self._fields
        imu, body, dof = self._imu, self._imu._body, self._dof
        # the reference point is the base's origin, whose motion is that of the free joint
        spin, speed = cvel[:, self._root, :3], qvel[:, dof : dof + 3]
        turn = xmat[:, self._root].reshape(-1, 3, 3)
        growth = np.einsum("nij,nj->ni", turn, qacc[:, dof + 3 : dof + 6])
        force = qacc[:, dof : dof + 3] - self._gravity - np.cross(spin, speed)
        state = (xquat[:, body], xmat[:, body], xpos[:, body], xpos[:, self._root], spin, speed, growth, force)
        mount = None if imu.is_mounted_straight else imu._mount
        numbers = np.hstack([part.reshape(len(spin), -1) for part in state]).T
        attitude, motion = sensor_motion(numbers, imu._arm, mount, imu._rotation, self._references.T)
        measured = np.stack(motion, axis=1)
        if not self._is_truth:
            self._noise.apply(measured, ids, index)
            if not imu._attitude_noise.is_silent:
                turns = np.zeros((len(spin), 3))
                self._turns.apply(turns, ids, index)
                small = np.array([quaternion_of_rotation_vector(vector) for vector in turns.tolist()])
                attitude = hamilton_product(attitude, small.T)
        return np.column_stack((*attitude, measured))
