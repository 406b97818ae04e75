"""Inertial measurement unit: `imu` sensors and their messages; a batch gives the same bits as single sensors."""

from __future__ import annotations

from collections.abc import Hashable, Sequence

import mujoco
import numpy as np

from simkit import msgs
from simkit.msgs.cdr_template import CdrTemplate
from simkit.pose import Vector
from simkit.sensors.base import Product
from simkit.sensors.bias_drift import NoiseInterval, NoiseState
from simkit.sensors.inertial.imu_measurement import ImuMeasurement, ImuReading, ImuRule, unpack_numbers
from simkit.sensors.inertial.inertial_kinematics import NO_ROTATION, sensor_motion
from simkit.sensors.noise import with_noise
from simkit.sensors.sample import Sample
from simkit.sensors.sampler import Sampler
from simkit.sensors.sensor_batch import SensorBatch, form_batches

_TYPES = "sensor_msgs/msg/Imu", "geometry_msgs/msg/Vector3", "geometry_msgs/msg/Quaternion"
_BATCH_TYPES = *_TYPES, "std_msgs/msg/Header", "builtin_interfaces/msg/Time"
_NUMBERS = 31  # numbers captured per sensor
_NOISE_BLOCK = 64  # samples whose noise is drawn at a time
_NS = 1_000_000_000
_VARIABLE_FIELDS = (
    *("header.stamp.sec", "header.stamp.nanosec"),
    *(f"orientation.{axis}" for axis in "wxyz"),
    *(f"{vector}.{axis}" for vector in ("angular_velocity", "linear_acceleration") for axis in "xyz"),
)


def _batch_key(imu: ImuMeasurement) -> Hashable | None:
    """Return the properties that all IMUs of a batch share; None if a batch cannot compute this IMU's reading."""
    if not imu.has_plain_noise:
        return None
    return imu.is_mounted_straight, imu.is_against_world, imu.noise.is_silent, imu.noise.white is None


class ImuBatch(SensorBatch[ImuMeasurement]):
    """Batch of IMUs that differ only in position and noise."""

    def __init__(self, members: Sequence[ImuMeasurement]) -> None:
        super().__init__(members)
        model, first = self.model, members[0]
        self._bodies = np.array([imu.body for imu in members], dtype=np.intp)
        self._roots = model.body_rootid[self._bodies].astype(np.intp)
        self._arms = np.array([imu._arm for imu in members]).T.copy()
        self._mounts = None if first.is_mounted_straight else np.array([imu._mount for imu in members]).T.copy()
        self._turns = np.array([imu._rotation for imu in members]).T.copy()
        references = [imu._from_reference for imu in members]
        self._references = None if first.is_against_world else np.array(references).T.copy()
        self._is_silent, self._is_white = first.noise.is_silent, first.noise.white is not None
        self._normals, self._first_index, self._seed = np.empty((0, 0, 0)), 0, self.sim.engine.streams.seed
        self._index = -1
        self._constants_of: NoiseInterval | None = None
        self._states: list[NoiseState] = []
        self._message_constants: list[tuple[str, tuple[Vector, ...], bool]] = []

    def capture_all(self, data: mujoco.MjData) -> None:
        bodies, raw = self._bodies, np.empty((len(self.members), _NUMBERS))
        raw[:, :4] = data.xquat[bodies]
        raw[:, 4:13] = data.xmat[bodies]
        raw[:, 13:16] = data.xpos[bodies]
        raw[:, 16:19] = data.subtree_com[self._roots]
        raw[:, 19:25] = data.cvel[bodies]
        raw[:, 25:] = data.cacc[bodies]
        self._raw, self._index = raw, -1
        self._time_ns = self.sim.time_ns
        self._clock = divmod(self._time_ns, _NS)

    def captured(self, member_index: int) -> bytes:
        # a copy, because a view would keep the array of all members alive
        captured: bytes = self._raw[member_index].tobytes()
        return captured

    def publish_sample(self, member: Sampler, tick: int) -> bool:
        if not self.is_ready(member, tick):
            return False
        index = member._index + 1
        if self._index != index:
            self._finish(index)
        member_index = member.batch_index
        sample = Sample(index, self._time_ns)
        sample.raw = self._raw[member_index].tobytes()  # read by `truth`
        sample.messages["imu"] = message = self._message(member_index)
        member.publish_made(sample, message)
        return True

    def _message(self, member_index: int) -> msgs.Imu:
        make, vector, quaternion, header, time = msgs.types_of(*_BATCH_TYPES)
        frame, (orientation_cov, rate_cov, force_cov), has_attitude = self._message_constants[member_index]
        w, x, y, z, rx, ry, rz, fx, fy, fz = self._rows[member_index]
        if not has_attitude:
            w, x, y, z = 1.0, 0.0, 0.0, 0.0
        motion = vector(rx, ry, rz), rate_cov, vector(fx, fy, fz), force_cov
        message: msgs.Imu = make(header(time(*self._clock), frame), quaternion(x, y, z, w), orientation_cov, *motion)
        return message

    # ------------------------------------------------------------------ arithmetic

    def _finish(self, index: int) -> None:
        """Compute the numbers of all members' messages, noise included, shape (members, 10)."""
        rows = np.ascontiguousarray(self._raw.T)
        attitude, motion = sensor_motion(rows, self._arms, self._mounts, self._turns, self._references)
        numbers = np.empty((len(self.members), 10))
        for i, column in enumerate((*attitude, *motion)):
            numbers[:, i] = column
        if not self._is_silent:
            numbers[:, 4:] = self._with_noise(numbers[:, 4:], index)
        self._rows, self._index = numbers.tolist(), index
        frames = [constants[0] for constants in self._message_constants]
        if self._constants_of is not self.members[0].noise.state.interval or frames != self._frames():
            self._update_message_constants()

    def _frames(self) -> list[str]:
        return [imu.frame_id for imu in self.members]

    def _update_message_constants(self) -> None:
        """Update the parts of all members' messages that change only with the rate."""
        self._constants_of, self._message_constants = self.members[0].noise.state.interval, []
        for imu in self.members:
            self._message_constants.append((imu.frame_id, tuple(imu.covariances()), imu.options.enable_orientation))

    def _with_noise(self, motion: Vector, index: int) -> Vector:
        states = [imu.noise.state for imu in self.members]
        if states != self._states:
            self._states = states
            self._constants = np.array([state.constant for state in states])
            self._deviations = np.array([state.interval.stddev for state in states])
        return with_noise(motion, self._constants, self._deviations, self._white(index) if self._is_white else None)

    def _white(self, index: int) -> Vector:
        """Return the standard normal numbers of all members' samples, shape (members, 6)."""
        row = index - self._first_index
        if not 0 <= row < len(self._normals) or self._seed != self.sim.engine.streams.seed:
            streams = [imu.noise.white for imu in self.members if imu.noise.white is not None]
            parts = [stream.normals(index, _NOISE_BLOCK) for stream in streams]
            self._normals, self._first_index, row = np.stack(parts, axis=1), index, 0
            self._seed = self.sim.engine.streams.seed
        values: Vector = self._normals[row]
        return values


class Imu(ImuMeasurement):
    """IMU, `imu`: specific force, angular rate and attitude."""

    kinds = ("imu",)
    artefact_families = ("imu",)
    example = "<imu/>"
    sees_scene = False
    _template_of: tuple[list[Vector], str] = ([], "")

    @classmethod
    def make_batches(cls, sensors: Sequence[ImuMeasurement]) -> None:
        if cls is Imu:
            form_batches(sensors, ImuBatch, _batch_key)

    def array_rule(self) -> ImuRule:
        return ImuRule(self)

    def packs(self, product: str) -> bool:
        return True

    def pack_samples(self, first: int, times: Sequence[int], captures: Sequence[bytes]) -> list[bytes]:
        if _batch_key(self) is None:
            return []
        rows = np.frombuffer(b"".join(captures)).reshape(-1, _NUMBERS).T
        mount = None if self.is_mounted_straight else self._mount
        reference = None if self.is_against_world else self._from_reference
        attitude, motion = sensor_motion(np.ascontiguousarray(rows), self._arm, mount, self._rotation, reference)
        noisy = np.column_stack(motion)
        if not self.noise.is_silent:
            noisy = self.noise.apply_to_samples(noisy, first)
        if not self.options.enable_orientation:
            attitude = NO_ROTATION
        columns = [np.array(times) // _NS, np.array(times) % _NS, *attitude, *noisy.T]
        return self._template().fill(len(times), dict(zip(_VARIABLE_FIELDS, columns, strict=True)))

    @property
    def makes_directly(self) -> bool:
        return self.has_plain_noise

    def make_directly(self, raw: bytes, index: int, time_ns: int) -> msgs.Imu:
        mount = None if self.is_mounted_straight else self._mount
        reference = None if self.is_against_world else self._from_reference
        attitude, motion = sensor_motion(unpack_numbers(raw), self._arm, mount, self._rotation, reference)
        noisy = motion if self.noise.is_silent else self.noise.apply_to_numbers(motion, index)
        w, x, y, z = attitude if self.options.enable_orientation else NO_ROTATION
        rx, ry, rz, fx, fy, fz = noisy
        make, vector, quaternion, header, time = msgs.types_of(*_BATCH_TYPES)
        orientation_cov, rate_cov, force_cov = self.covariances()
        message: msgs.Imu = make(
            header(time(time_ns // _NS, time_ns % _NS), self.frame_id),
            quaternion(x, y, z, w),
            orientation_cov,
            vector(rx, ry, rz),
            rate_cov,
            vector(fx, fy, fz),
            force_cov,
        )
        return message

    def _template(self) -> CdrTemplate:
        """Return the serialised message whose numbers are replaced; it changes with the covariances."""
        covariances, frame = self.covariances(), self.frame_id
        if self._template_of[0] is not covariances or self._template_of[1] != frame:
            message = self._message_of(ImuReading(NO_ROTATION, (0.0,) * 6), 0)
            self._stored_template, self._template_of = CdrTemplate(message, _VARIABLE_FIELDS), (covariances, frame)
        return self._stored_template

    def products(self) -> dict[str, Product]:
        return {"imu": Product(_TYPES[0], self._message_of)}

    def _message_of(self, reading: ImuReading, time_ns: int) -> msgs.Imu:
        imu, vector, quaternion = msgs.types_of(*_TYPES)
        orientation_cov, rate_cov, force_cov = self.covariances()
        w, x, y, z = reading.orientation if self.options.enable_orientation else NO_ROTATION
        rx, ry, rz, fx, fy, fz = reading.motion
        motion = vector(rx, ry, rz), rate_cov, vector(fx, fy, fz), force_cov
        message: msgs.Imu = imu(msgs.header(time_ns, self.frame_id), quaternion(x, y, z, w), orientation_cov, *motion)
        return message
