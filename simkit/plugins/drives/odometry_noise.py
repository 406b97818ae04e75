"""Odometry with the errors of real wheels, and the covariance that a drive predicts for these errors.

The random errors follow the model of Siegwart and Nourbakhsh, "Introduction to Autonomous Mobile Robots", section
5.2.4. The error of each wheel's travel has a variance that grows with the distance, k·|Δs|, independent of the update
rate. Equation 5.9 propagates the covariance of the pose. The model of Thrun, Burgard and Fox, "Probabilistic Robotics",
table 5.6, is not used: its variances grow with the square of a step's distance, so they vanish for short steps. The
systematic errors are those that Borenstein and Feng (1996) measure on a robot: wheel radii and a wheel separation that
differ from the values in the drive.
"""

from __future__ import annotations

import copy
import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from simkit.linear_algebra import matmul
from simkit.plugins.drives.motion_errors import FAR, MotionErrorOptions, MotionErrors
from simkit.plugins.drives.odometry import UNKNOWN, DeadReckoning, base_motion
from simkit.plugins.drives.odometry_messages import BodyTwist
from simkit.plugins.options import number
from simkit.pose import Pose, Vector, quat_from_rpy, quat_multiply, wrap_angle

if TYPE_CHECKING:
    from simkit.runtime.engine.random_streams import RandomStream

_PLANAR = np.ix_((0, 1, 5), (0, 1, 5))
_LARGEST_SLIP = 0.9  # greatest share that slip adds to the measured motion


@dataclass(frozen=True, slots=True)
class OdometryNoise:
    """Parameters of the `<odometry_noise>` block of a drive, a simkit extension.

    Attributes:
        wheel_variance: Variance k of a wheel's travel per distance [m²/m].
        left_radius_error, right_radius_error: Relative error of the radius that the drive assumes; positive if too
            large.
        separation_error: Relative error of the wheel separation that the drive assumes.
        resolution: Encoder resolution [rad per count]; 0 for exact angles.
        motion: Relative errors of the measured motion by direction.
        turn_slip: Relative slip per turning rate [s/rad]: the wheels roll farther than the base moves.
        acceleration_slip: Relative slip per acceleration along the heading [s²/m], by the load on the wheels.
    """

    wheel_variance: float = 0.0
    left_radius_error: float = 0.0
    right_radius_error: float = 0.0
    separation_error: float = 0.0
    resolution: float = 0.0
    motion: MotionErrors | None = None
    turn_slip: float = 0.0
    acceleration_slip: float = 0.0

    @property
    def slips(self) -> bool:
        """True if the wheels slip."""
        return self.turn_slip > 0 or self.acceleration_slip > 0


class OdometryNoiseOptions(MotionErrorOptions):
    """Options of the `<odometry_noise>` block."""

    counts_per_revolution: float = number(1.0, minimum=1)
    wheel_variance: float = number(0.0, minimum=0, maximum=1e3)
    left_radius_error: float = number(0.0, minimum=-FAR, maximum=FAR)
    right_radius_error: float = number(0.0, minimum=-FAR, maximum=FAR)
    separation_error: float = number(0.0, minimum=-FAR, maximum=FAR)
    turn_slip: float = number(0.0, "s/rad", minimum=0, maximum=1e3)
    acceleration_slip: float = number(0.0, "s²/m", minimum=0, maximum=1e3)


class WheellessOdometryNoiseOptions(OdometryNoiseOptions):
    """Options of the `<odometry_noise>` block of a drive that has no wheels itself, with the sizes of its wheels."""

    wheel_radius: float = number(0.1, "m", minimum=1e-6)
    wheel_separation: float = number(0.4, "m", minimum=1e-6)


def odometry_noise(options: OdometryNoiseOptions) -> OdometryNoise | None:
    """Return the noise of a drive's `<odometry_noise>` block, or None if the block is missing."""
    if not options.is_given:
        return None
    counts = options.counts_per_revolution if options.params.has("counts_per_revolution") else math.inf
    return OdometryNoise(
        wheel_variance=options.wheel_variance,
        left_radius_error=options.left_radius_error,
        right_radius_error=options.right_radius_error,
        separation_error=options.separation_error,
        resolution=2 * math.pi / counts,
        motion=options.motion_errors,
        turn_slip=options.turn_slip,
        acceleration_slip=options.acceleration_slip,
    )


class NoisyOdometry:
    """Dead reckoning from noisy wheel angles, with the covariance that the drive predicts.

    The covariance contains the random errors only: a drive does not know its systematic errors.

    Args:
        noise: Errors of the wheels.
        radius: True radius of the wheels [m].
        separation: True distance between the wheels [m].
        stream: Random stream; every update draws two normal numbers.
        angles: Angles of the left and the right wheel at the start [rad].
        start: Initial pose.

    Attributes:
        reckoning: Pose that the drive estimates.
        covariance: Covariance of x [m], y [m] and yaw [rad], shape (3, 3).
        twist: Twist over the last update, in the body's axes.
        twist_covariance: Covariance of forward speed [m/s] and turning rate [rad/s], shape (2, 2).
    """

    def __init__(
        self,
        noise: OdometryNoise,
        radius: float,
        separation: float,
        stream: RandomStream,
        angles: tuple[float, float] = (0.0, 0.0),
        start: DeadReckoning | None = None,
    ) -> None:
        self.noise = noise
        self._radii = (radius * (1 + noise.left_radius_error), radius * (1 + noise.right_radius_error))
        self._separation = separation * (1 + noise.separation_error)
        self._stream, self._index = stream, 0
        self._counted = tuple(self._count(angle) for angle in angles)
        self._angles, self._speed = angles, 0.0
        self.reckoning = replace(start) if start is not None else DeadReckoning()
        self.covariance: Vector = np.zeros((3, 3))
        self.twist, self.twist_covariance = BodyTwist(), np.zeros((2, 2))

    def independent_copy(self) -> NoisyOdometry:
        """Return a copy that continues alone, with the numbers of the present seed."""
        copied = copy.copy(self)
        copied.reckoning, copied._stream = replace(self.reckoning), self._stream.independent_copy()
        return copied

    def advance(self, left: float, right: float, elapsed: float, sideways: float = 0.0) -> None:
        """Advance the estimate to new wheel angles.

        Args:
            left: Angle of the left wheel [rad].
            right: Angle of the right wheel [rad].
            elapsed: Time since the last update [s].
            sideways: True displacement to the left [m], with the errors by direction and slip only.
        """
        self._index += 1
        counted = tuple(self._count(angle) for angle in (left, right))
        rolled = [(b - a) * r for a, b, r in zip(self._counted, counted, self._radii, strict=True)]
        self._counted = counted
        if self.noise.motion is not None or self.noise.slips:
            rolled, sideways = self._with_motion_errors(rolled, sideways, self._slip(left, right, elapsed))
        variances = np.array([self.noise.wheel_variance * abs(distance) for distance in rolled])
        if self.noise.wheel_variance > 0:
            errors = np.sqrt(variances) * self._stream.normal(self._index)
            rolled = [distance + float(error) for distance, error in zip(rolled, errors, strict=True)]
        self._propagate_covariance(rolled, variances)
        left_distance, right_distance = rolled
        self.reckoning.advance(left_distance, right_distance, self._separation, sideways)
        if elapsed > 0:
            self._update_twist(rolled, variances, elapsed, sideways)

    def _slip(self, left: float, right: float, elapsed: float) -> float:
        """Return the share by which the wheels roll farther than the base moves, from the angles without counts."""
        if not self.noise.slips or elapsed <= 0:
            return 0.0
        rolled = [(b - a) * r for a, b, r in zip(self._angles, (left, right), self._radii, strict=True)]
        ahead, _, turn = base_motion(rolled[0], rolled[1], self._separation)
        speed, before = ahead / elapsed, self._speed
        self._angles, self._speed = (left, right), speed
        slip: float = self.noise.turn_slip * abs(turn) / elapsed
        slip += self.noise.acceleration_slip * abs(speed - before) / elapsed
        return min(slip, _LARGEST_SLIP)

    def _with_motion_errors(self, rolled: list[float], sideways: float, slip: float) -> tuple[list[float], float]:
        """Return the distances that the wheels roll and the displacement to the left, as they are measured [m]."""
        ahead, _, turn = base_motion(rolled[0], rolled[1], self._separation)
        if self.noise.motion is not None:
            ahead, sideways, turn = self.noise.motion.apply(ahead, sideways, turn)
        ahead, sideways, turn = (part * (1.0 + slip) for part in (ahead, sideways, turn))
        half = turn * self._separation / 2
        return [ahead - half, ahead + half], sideways

    def messages_covariance(self) -> tuple[Vector, Vector]:
        """Return the row-major 6×6 covariances of pose and twist in ROS order, shape (36,) each.

        Quantities that wheels do not measure have a huge variance. The lateral speed, which is about zero on wheels,
        has the variance of the forward speed.
        """
        pose, twist = (np.diag([UNKNOWN] * 6) for _ in range(2))
        pose[_PLANAR] = self.covariance
        ahead, turn = self.twist_covariance
        twist[_PLANAR] = [[ahead[0], 0, ahead[1]], [0, ahead[0], 0], [turn[0], 0, turn[1]]]
        return pose.reshape(36), twist.reshape(36)

    def _count(self, angle: float) -> float:
        step = self.noise.resolution
        return math.floor(angle / step + 0.5) * step if step > 0 else angle

    def _propagate_covariance(self, rolled: list[float], variances: Vector) -> None:
        """Propagate the covariance of the pose over one motion, and add the covariance of the motion (equation 5.9)."""
        distance, _, turn = base_motion(rolled[0], rolled[1], self._separation)
        middle = self.reckoning.yaw + turn / 2
        cos, sin, arm = math.cos(middle), math.sin(middle), distance / (2 * self._separation)
        along = np.array([[1, 0, -distance * sin], [0, 1, distance * cos], [0, 0, 1]])
        # columns: derivatives by the travel of the left and of the right wheel
        by_wheel = np.array(
            [
                [cos / 2 + arm * sin, cos / 2 - arm * sin],
                [sin / 2 - arm * cos, sin / 2 + arm * cos],
                [-1 / self._separation, 1 / self._separation],
            ]
        )
        self.covariance = matmul(along, self.covariance, along.T) + matmul(by_wheel * variances, by_wheel.T)

    def _update_twist(self, rolled: list[float], variances: Vector, elapsed: float, sideways: float) -> None:
        width = self._separation
        ahead, _, turn = base_motion(rolled[0], rolled[1], width)
        self.twist = BodyTwist((ahead / elapsed, sideways / elapsed, 0.0), (0.0, 0.0, turn / elapsed))
        by_wheel = np.array([[0.5, 0.5], [-1 / width, 1 / width]]) / elapsed
        self.twist_covariance = matmul(by_wheel * variances, by_wheel.T)


class EquivalentWheelAngles:
    """Wheel angles with which a base without slip would follow a true motion.

    Args:
        pose: Initial pose.
        radius: Radius of the wheels [m].
        separation: Distance between the wheels [m].
    """

    def __init__(self, pose: Pose, radius: float, separation: float) -> None:
        self._radius, self._separation = radius, separation
        self.angles = (0.0, 0.0)
        self._last = _planar(pose)

    @property
    def start(self) -> DeadReckoning:
        """Planar pose at the last call of `follow`; before the first call, the initial pose."""
        return DeadReckoning(*self._last)

    def follow(self, pose: Pose) -> tuple[float, float, float]:
        """Update the wheel angles for the motion from the last pose to a new pose.

        Returns:
            The angles of the left and the right wheel [rad], and the displacement to the left since the last pose [m].
        """
        x, y, yaw = _planar(pose)
        dx, dy = x - self._last[0], y - self._last[1]
        turn = wrap_angle(yaw - self._last[2])
        middle = self._last[2] + turn / 2
        # ratio of arc to chord, the inverse of the ratio in `DeadReckoning.go`
        arc = turn / 2 / math.sin(turn / 2) if abs(turn) > 1e-4 else 1 + turn * turn / 24
        ahead = (dx * math.cos(middle) + dy * math.sin(middle)) * arc
        across = (dy * math.cos(middle) - dx * math.sin(middle)) * arc
        half = turn * self._separation / 2
        left, right = self.angles
        self.angles = (left + (ahead - half) / self._radius, right + (ahead + half) / self._radius)
        self._last = (x, y, yaw)
        return (*self.angles, across)


class ErringOdometry:
    """Odometry that repeats the motion of another odometry with errors, for a drive of any kind.

    The errors are those of two wheels that make the same motion, left and right.

    Args:
        noise: Errors of the wheels.
        radius: Radius of the wheels [m].
        separation: Distance between the wheels [m].
        stream: Random stream; every update draws two normal numbers.
        pose: Initial pose of the odometry without errors.
        time_ns: Time of this pose [ns].
    """

    def __init__(
        self, noise: OdometryNoise, radius: float, separation: float, stream: RandomStream, pose: Pose, time_ns: int
    ) -> None:
        self._wheels = EquivalentWheelAngles(pose, radius, separation)
        self._noisy = NoisyOdometry(noise, radius, separation, stream, self._wheels.angles, self._wheels.start)
        self._time_ns = time_ns
        self._is_random = noise.wheel_variance > 0

    def follow(self, pose: Pose, time_ns: int) -> None:
        """Advance to the next pose of the odometry without errors, at a time [ns]."""
        left, right, sideways = self._wheels.follow(pose)
        self._noisy.advance(left, right, (time_ns - self._time_ns) * 1e-9, sideways)
        self._time_ns = time_ns

    def pose(self, ideal: Pose) -> Pose:
        """Return the pose with errors, with height and tilt of the pose without them."""
        return replace_planar_pose(ideal, self._noisy.reckoning)

    @property
    def twist(self) -> BodyTwist:
        """Twist over the last update, in the body's axes."""
        return self._noisy.twist

    @property
    def covariances(self) -> tuple[Vector, ...]:
        """Covariances of pose and twist; none without random errors."""
        return self._noisy.messages_covariance() if self._is_random else ()


def replace_planar_pose(pose: Pose, reckoned: DeadReckoning) -> Pose:
    """Return a pose with x, y and yaw from dead reckoning, and with height and tilt of the true pose."""
    turn = quat_from_rpy(0.0, 0.0, reckoned.yaw - _planar(pose)[2])
    return Pose((reckoned.x, reckoned.y, pose.position[2]), quat_multiply(turn, pose.quaternion))


def _planar(pose: Pose) -> tuple[float, float, float]:
    x, y, _ = pose.position
    return float(x), float(y), float(pose.rpy[2])
