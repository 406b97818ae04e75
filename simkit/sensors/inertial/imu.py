"""Inertial measurement unit: `imu` sensors and their messages, one by one or many at once, to the same bits."""

from __future__ import annotations

from collections.abc import Hashable, Sequence

import mujoco
import numpy as np

from simkit import msgs
from simkit.pose import Vector
from simkit.sensors.base import Product
from simkit.sensors.bias_drift import NoiseInterval, NoiseState
from simkit.sensors.inertial.imu_measurement import ImuMeasurement, ImuReading
from simkit.sensors.inertial.inertial_kinematics import NO_ROTATION, sensor_motion
from simkit.sensors.sample import Sample
from simkit.sensors.sampler import Sampler
from simkit.sensors.sensor_batch import SensorBatch, form_batches

_TYPES = "sensor_msgs/msg/Imu", "geometry_msgs/msg/Vector3", "geometry_msgs/msg/Quaternion"
_BATCH_TYPES = *_TYPES, "std_msgs/msg/Header", "builtin_interfaces/msg/Time"
_NUMBERS = 31  # captured of each
_NOISE_BLOCK = 64  # samples whose noise is looked up at a time
_NS = 1_000_000_000


def _batch_key(imu: ImuMeasurement) -> Hashable | None:
    """What has to be the same for the same arithmetic; None where there is more to do than a batch does."""
    noise = imu.noise
    if noise.wanders or noise._is_quantised or not imu._attitude_noise.is_silent or imu._more_noise is not None:
        return None
    return imu.is_mounted_straight, imu.is_against_world, noise.is_silent, noise._white is None


class ImuBatch(SensorBatch[ImuMeasurement]):
    """IMUs that differ in place and noise alone."""

    def __init__(self, members: Sequence[ImuMeasurement]) -> None:
        super().__init__(members)
        model, first = self.model, members[0]
        self._bodies = np.array([imu._body for imu in members], dtype=np.intp)
        self._roots = model.body_rootid[self._bodies].astype(np.intp)
        self._arms = np.array([imu._arm for imu in members]).T.copy()
        self._mounts = None if first.is_mounted_straight else np.array([imu._mount for imu in members]).T.copy()
        self._turns = np.array([imu._rotation for imu in members]).T.copy()
        references = [imu._from_reference for imu in members]
        self._references = None if first.is_against_world else np.array(references).T.copy()
        self._is_silent, self._is_white = first.noise.is_silent, first.noise._white is not None
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

    def captured(self, place: int) -> bytes:
        # a copy: whoever keeps one sample does not keep those of all
        captured: bytes = self._raw[place].tobytes()
        return captured

    def publish_sample(self, member: Sampler, tick: int) -> bool:
        if not self.is_ready(member, tick):
            return False
        index = member._index + 1
        if self._index != index:
            self._finish(index)
        place = member.batch_index
        sample = Sample(index, self._time_ns)
        sample.raw = self._raw[place].tobytes()  # for `truth`
        sample.messages["imu"] = message = self._message(place)
        member._index, member._time_ns, member._newest = index, self._time_ns, sample
        for _, publisher, _ in member._wanted:
            publisher.publish(message)
        return True

    def _message(self, place: int) -> msgs.Imu:
        make, vector, quaternion, header, time = msgs.types_of(*_BATCH_TYPES)
        frame, (of_orientation, of_rate, of_force), has_attitude = self._message_constants[place]
        w, x, y, z, rx, ry, rz, fx, fy, fz = self._rows[place]
        if not has_attitude:
            w, x, y, z = 1.0, 0.0, 0.0, 0.0
        message: msgs.Imu = make(
            header(time(*self._clock), frame),
            quaternion(x, y, z, w),
            of_orientation,
            vector(rx, ry, rz),
            of_rate,
            vector(fx, fy, fz),
            of_force,
        )
        return message

    # ------------------------------------------------------------------ the arithmetic

    def _finish(self, index: int) -> None:
        """The numbers of everybody's message, noise included, shape (members, 10)."""
        rows = np.ascontiguousarray(self._raw.T)
        attitude, motion = sensor_motion(rows, self._arms, self._mounts, self._turns, self._references)
        numbers = np.empty((len(self.members), 10))
        for i, column in enumerate((*attitude, *motion)):
            numbers[:, i] = column
        if not self._is_silent:
            numbers[:, 4:] = self._with_noise(numbers[:, 4:], index)
        self._rows, self._index = numbers.tolist(), index
        if self._constants_of is not self.members[0].noise.state.interval:
            self._update_message_constants()

    def _update_message_constants(self) -> None:
        """What of everybody's message changes with the rate alone."""
        self._constants_of, self._message_constants = self.members[0].noise.state.interval, []
        for imu in self.members:
            self._message_constants.append((imu.frame_id, tuple(imu.covariances()), imu.options.enable_orientation))

    def _with_noise(self, motion: Vector, index: int) -> Vector:
        states = [imu.noise.state for imu in self.members]
        if states != self._states:
            self._states = states
            self._constants = np.array([state.constant for state in states])
            self._deviations = np.array([state.interval.stddev for state in states])
        out: Vector = motion + self._constants
        if self._is_white:
            out += self._deviations * self._white(index)
        return out

    def _white(self, index: int) -> Vector:
        """Standard normal numbers of everybody's sample, shape (members, 6)."""
        row = index - self._first_index
        if not 0 <= row < len(self._normals) or self._seed != self.sim.engine.streams.seed:
            streams = [imu.noise._white for imu in self.members if imu.noise._white is not None]
            parts = [stream.normals(index, _NOISE_BLOCK) for stream in streams]
            self._normals, self._first_index, row = np.stack(parts, axis=1), index, 0
            self._seed = self.sim.engine.streams.seed
        values: Vector = self._normals[row]
        return values


class Imu(ImuMeasurement):
    """`imu`: specific force, angular rate, attitude."""

    kinds = ("imu",)
    example = "<imu/>"

    @classmethod
    def make_batches(cls, sensors: Sequence[ImuMeasurement]) -> None:
        if cls is Imu:
            form_batches(sensors, ImuBatch, _batch_key)

    def products(self) -> dict[str, Product]:
        return {"imu": Product(_TYPES[0], self._message_of)}

    def default_topics(self) -> dict[str, str]:
        return {"imu": self._default_topic("imu")}

    def _message_of(self, reading: ImuReading, time_ns: int) -> msgs.Imu:
        imu, vector, quaternion = msgs.types_of(*_TYPES)
        of_orientation, of_rate, of_force = self.covariances()
        w, x, y, z = reading.orientation if self.options.enable_orientation else NO_ROTATION
        rx, ry, rz, fx, fy, fz = reading.motion
        message: msgs.Imu = imu(
            msgs.header(time_ns, self.frame_id),
            quaternion(x, y, z, w),
            of_orientation,
            vector(rx, ry, rz),
            of_rate,
            vector(fx, fy, fz),
            of_force,
        )
        return message
