"""Recorded motion of one free model, such as a tossed cube: its poses over time, cut into short windows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from simkit.elementary_functions import arctan2
from simkit.errors import InputError
from simkit.extend import counted
from simkit.linear_algebra import dot, norm
from simkit.pose import Pose, quat_rotate
from simkit.recording import open_bag_to_read
from simkit_identification.fitting.codes import INVALID_MOTION
from simkit_identification.fitting.readings import Channel, Readings

if TYPE_CHECKING:
    from simkit import Simulation

Floats = npt.NDArray[np.float64]
_COLUMNS: Final = ("position.x", "position.y", "position.z", *(f"orientation.{axis}" for axis in "xyzw"))
_FEWEST: Final = 3  # samples of a motion
_NS: Final = 1e-9


@dataclass(frozen=True)
class Motion:
    """Recorded motion of one model that no command moves.

    Attributes:
        model: name of the model.
        times: times of the samples [s], shape (n,), ascending.
        positions: positions of the model's frame in the world [m], shape (n, 3).
        quaternions: orientations in the world, w x y z, shape (n, 4).
        linear: velocities of the frame's origin in the world [m/s], shape (n, 3); None to take them from the poses.
        angular: angular velocities in the axes of the world [rad/s], shape (n, 3); None to take them from the poses.
        name: name of the recording in messages.
    """

    model: str
    times: Floats
    positions: Floats
    quaternions: Floats
    linear: Floats | None = None
    angular: Floats | None = None
    name: str = "motion"

    def __post_init__(self) -> None:
        count = len(self.times)
        arrays = {"positions": 3, "quaternions": 4, "linear": 3, "angular": 3}
        for field, width in arrays.items():
            values = getattr(self, field)
            if values is None:
                continue
            values = np.asarray(values, dtype=np.float64)
            if values.shape != (count, width) or not np.all(np.isfinite(values)):
                text = f"{self.name}: {field} has the shape {values.shape} or NaN; expected finite ({count}, {width})"
                raise InputError(INVALID_MOTION, text)
            object.__setattr__(self, field, values)
        times = np.asarray(self.times, dtype=np.float64)
        if count < _FEWEST or not np.all(np.diff(times) > 0):
            text = f"{self.name}: found {counted(count, 'sample')}; expected at least {_FEWEST} with ascending times"
            raise InputError(INVALID_MOTION, text)
        object.__setattr__(self, "times", times - times[0])
        norms = np.sqrt(_products(self.quaternions, self.quaternions))
        if not np.all(norms > 0):
            raise InputError(INVALID_MOTION, f"{self.name}: a quaternion is zero")
        object.__setattr__(self, "quaternions", self.quaternions / norms[:, None])

    @property
    def duration(self) -> float:
        """Time from the first to the last sample [s]."""
        return float(self.times[-1])

    def recorded(self) -> Readings:
        """Return the poses as readings of a channel."""
        values = np.concatenate((self.positions, self.quaternions[:, [1, 2, 3, 0]]), axis=1)
        return Readings(Channel(f"pose of {self.model}", (), _COLUMNS), self.times, values)

    def windows(self, length: float | None) -> list[tuple[int, int]]:
        """Return the first and the last sample of each window, which begins with the recorded state.

        Args:
            length: length of a window [s]; None for one window.
        """
        last = len(self.times) - 1
        if length is None or length >= self.duration:
            return [(0, last)]
        count = max(1, round(self.duration / length))
        edges = np.searchsorted(self.times, np.linspace(0, self.duration, count + 1) - 1e-9).tolist()
        edges[-1] = last
        return [(a, b) for a, b in pairwise(edges) if b > a]

    def velocities(self) -> tuple[Floats, Floats]:
        """Return linear and angular velocities in the axes of the world; those of the poses if none were recorded."""
        linear = np.gradient(self.positions, self.times, axis=0) if self.linear is None else self.linear
        return linear, _angular_velocities(self.times, self.quaternions) if self.angular is None else self.angular


def _angular_velocities(times: Floats, quaternions: Floats) -> Floats:
    """Return the angular velocity at each sample from its neighbours, in the axes of the world, shape (n, 3)."""
    after = np.minimum(np.arange(len(times)) + 1, len(times) - 1)
    before = np.maximum(np.arange(len(times)) - 1, 0)
    w2, v2 = quaternions[after, 0], quaternions[after, 1:]
    w1, v1 = quaternions[before, 0], quaternions[before, 1:]
    scalar = w2 * w1 + _products(v2, v1)
    vector = -w2[:, None] * v1 + w1[:, None] * v2 - np.cross(v2, v1)
    vector *= np.where(scalar < 0, -1.0, 1.0)[:, None]
    size = np.sqrt(_products(vector, vector))
    angle = 2.0 * np.asarray(arctan2(size, np.abs(scalar)))
    span = times[after] - times[before]
    factor = np.divide(angle, size * span, out=np.full_like(angle, 2.0) / span, where=size > 1e-12)
    return np.asarray(vector * factor[:, None], dtype=np.float64)


def _products(first: Floats, second: Floats) -> Floats:
    """Return the scalar product of each pair of rows, added in the order of the columns."""
    total = first[:, 0] * second[:, 0]
    for column in range(1, first.shape[1]):
        total = total + first[:, column] * second[:, column]
    return total


class MotionRun:
    """Runs of a world that begin with the recorded states of a motion.

    Args:
        sim: world at its start; its state is restored before each window.
        motion: recorded motion.

    Raises:
        InputError: SK-FIT-011 the world has no such model, or the model cannot move freely.
    """

    def __init__(self, sim: Simulation, motion: Motion) -> None:
        try:
            self._model = sim.model(motion.model)
        except KeyError as error:
            raise InputError(INVALID_MOTION, f"the world has no model {motion.model!r}: {error}") from None
        if self._model.static:
            raise InputError(INVALID_MOTION, f"the model {motion.model!r} is static, so it has no motion to fit")
        self._sim, self._motion = sim, motion
        self._start = sim.snapshot()
        self._linear, self._angular = motion.velocities()

    def values(self, windows: Sequence[tuple[int, int]]) -> Floats:
        """Return the poses at the recorded times, shape (n, 7); those at the beginning of a window are recorded.

        Raises:
            SimulationDiverged: the state became NaN or infinite.
        """
        motion = self._motion
        poses = motion.recorded().values.copy()
        for first, last in windows:
            self._sim.restore(self._start)
            self._model.set_pose(Pose(motion.positions[first], motion.quaternions[first]))
            self._model.set_velocity(self._linear[first], self._angular[first])
            self._run(first, last, poses)
        return poses

    def _run(self, first: int, last: int, poses: Floats) -> None:
        """Write the poses after the first sample of a window; between two steps they are interpolated."""
        sim, times = self._sim, self._motion.times
        begun, step = sim.tick, sim.timestep
        before = self._pose()
        for at in range(first + 1, last + 1):
            steps = (times[at] - times[first]) / step
            whole = int(np.floor(steps + 1e-6))
            ahead = whole - (sim.tick - begun)
            if ahead > 0:
                sim.step(ahead)
                before = self._pose()
            share = steps - whole
            if share > 1e-6:
                sim.step(1)
                after = self._pose()
                if dot(before[3:], after[3:]) < 0:
                    after[3:] = -after[3:]
                pose = before + share * (after - before)
                before = after
            else:
                pose = before.copy()
            pose[3:] /= norm(pose[3:])
            if dot(pose[3:], poses[at, 3:]) < 0:
                pose[3:] = -pose[3:]
            poses[at] = pose

    def _pose(self) -> Floats:
        pose = self._model.pose
        return np.concatenate((pose.position, pose.quaternion[[1, 2, 3, 0]]))


def motion_of_bag(path: Path, model: str, topic: str) -> Motion:
    """Return the motion of a model from the poses of a topic.

    Args:
        path: bag.
        model: name of the model.
        topic: topic of type Odometry, whose twist gives the velocities, or PoseStamped, Pose or TransformStamped.

    Raises:
        InputError: SK-CLI-030 no such topic; SK-FIT-011 its messages have no pose.
    """
    rows: list[tuple[float, Any, Any]] = []
    with open_bag_to_read(path) as bag:
        for message in bag.messages([topic]):
            decoded = bag.decode(message)
            rows.append(((message.time_ns - bag.time_origin) * _NS, *_pose_and_twist(decoded, message.type_name)))
    positions = np.array([[p.x, p.y, p.z] for _, (p, _), _ in rows], dtype=np.float64).reshape(-1, 3)
    turns = np.array([[q.w, q.x, q.y, q.z] for _, (_, q), _ in rows], dtype=np.float64).reshape(-1, 4)
    linear = angular = None
    if rows and rows[0][2] is not None:
        twists = [twist for _, _, twist in rows]
        linear = _in_world(turns, [twist.linear for twist in twists])
        angular = _in_world(turns, [twist.angular for twist in twists])
    times = np.array([time for time, _, _ in rows])
    return Motion(model, times, positions, turns, linear, angular, name=str(path))


def _in_world(turns: Floats, vectors: Sequence[Any]) -> Floats:
    """Return vectors in the axes of the world; an Odometry message has them in the axes of the moving frame."""
    return np.array([quat_rotate(q, (v.x, v.y, v.z)) for q, v in zip(turns, vectors, strict=True)])


def _pose_and_twist(message: Any, type_name: str) -> tuple[tuple[Any, Any], Any]:
    """Return position, orientation and twist of a message; None for the twist if it has none."""
    if type_name == "nav_msgs/msg/Odometry":
        return (message.pose.pose.position, message.pose.pose.orientation), message.twist.twist
    if type_name == "geometry_msgs/msg/PoseStamped":
        return (message.pose.position, message.pose.orientation), None
    if type_name == "geometry_msgs/msg/Pose":
        return (message.position, message.orientation), None
    if type_name == "geometry_msgs/msg/TransformStamped":
        return (message.transform.translation, message.transform.rotation), None
    text = f"found messages of type {type_name}; expected Odometry, PoseStamped, Pose or TransformStamped"
    raise InputError(INVALID_MOTION, text)
