"""Velocities that DWB tries, and the trajectories that follow from them.

The rules are those of `nav2_dwb_controller/dwb_plugins` (Jazzy): `one_d_velocity_iterator.hpp`,
`xy_theta_iterator.cpp`, `kinematic_parameters.hpp`, `standard_traj_generator.cpp`, `limited_accel_generator.cpp`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit_navigation.plugins.controllers.dwb_options import LIMITED, DwbOptions
from simkit_navigation.plugins.controllers.sample_arithmetic import cosine, sine
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose

_EPSILON: Final = 1e-5  # [m/s or rad/s] between equal velocities
_SLACK: Final = float(np.finfo(np.float32).eps)
_MOST_STEPS: Final = 1000

Speeds3 = tuple[float, float, float]
"""Speeds forward and to the left [m/s], turning rate [rad/s]."""


@dataclass
class Axis:
    """Limits of one component of the velocity.

    Attributes:
        low, high: least and largest velocity [m/s or rad/s].
        accel, decel: acceleration, and negative deceleration [m/s² or rad/s²].
        samples: number of velocities.
    """

    low: float
    high: float
    accel: float
    decel: float
    samples: int

    def project(self, begin: float, target: float, time: float) -> float:
        """Return the velocity after a time [s] on the way to a target."""
        if begin < target:
            return min(target, begin + self.accel * time)
        return max(target, begin + self.decel * time)

    def projected(self, begin: float, targets: Floats, times: Floats) -> Floats:
        """Return the velocities after times [s] on the way to each of the targets, as `project`."""
        slower = np.maximum(targets, begin + self.decel * times)
        result: Floats = np.where(begin < targets, np.minimum(targets, begin + self.accel * times), slower)
        return result

    def velocities(self, present: float, time: float) -> list[float]:
        """Return evenly spaced velocities that are reached within a time [s], and 0 if they change their sign."""
        begin = max(self.low, min(present, self.high))
        high, low = self.project(begin, self.high, time), self.project(begin, self.low, time)
        step = 1.0 if abs(low - high) < _EPSILON else (high - low) / max(1, max(2, self.samples) - 1)
        found, value = [], low
        while value <= high + _EPSILON:
            found.append(value)
            if value < 0.0 < value + step <= high + _EPSILON:
                found.append(0.0)
            value += step
        return found


@dataclass
class Trajectories:
    """Trajectories of all tried velocities; a shorter one repeats its last pose.

    Attributes:
        velocities: commanded velocities, shape (n, 3).
        x, y, yaw: poses of each step, shape (steps + 1, n) [m, rad].
        counts: number of steps of each trajectory.
        time: duration of each trajectory [s].
    """

    velocities: Floats
    x: Floats
    y: Floats
    yaw: Floats
    counts: npt.NDArray[np.int64]
    time: float

    def yaw_at(self, time: float) -> Floats:
        """Return the yaw of each trajectory at a time after its begin [s]."""
        counts = np.maximum(self.counts, 1)
        at = np.minimum(time / (self.time / counts), counts)
        step = np.minimum(np.floor(at).astype(np.int64), counts - 1)
        all_of_them = np.arange(len(counts))
        begin, end = self.yaw[step, all_of_them], self.yaw[step + 1, all_of_them]
        yaw: Floats = begin + (end - begin) * (at - step)
        return yaw


class VelocitySampler:
    """Makes the trajectories of a cycle.

    Args:
        options: options of the controller.
        period: control period [s].
    """

    def __init__(self, options: DwbOptions, period: float) -> None:
        self._options, self._is_limited = options, options.trajectory_generator_name in LIMITED
        self._period = options.sim_period or period
        self.set_speed_limit(1.0)

    def set_speed_limit(self, share: float) -> None:
        """Multiply the largest speeds by a factor."""
        options = self._options
        rate = options.max_vel_theta * share
        self._max_speed = options.max_speed_xy * share
        self._axes = (
            Axis(
                options.min_vel_x, options.max_vel_x * share, options.acc_lim_x, options.decel_lim_x, options.vx_samples
            ),
            Axis(
                options.min_vel_y, options.max_vel_y * share, options.acc_lim_y, options.decel_lim_y, options.vy_samples
            ),
            Axis(-rate, rate, options.acc_lim_theta, options.decel_lim_theta, options.vtheta_samples),
        )

    def velocities(self, present: Speeds3) -> Floats:
        """Return the velocities that are tried, in Nav2's order, shape (n, 3)."""
        options = self._options
        time = self._period if self._is_limited else options.sim_time
        x, y, rate = (axis.velocities(now, time) for axis, now in zip(self._axes, present, strict=True))
        found = np.stack(np.meshgrid(x, y, rate, indexing="ij"), axis=-1).reshape(-1, 3)
        squares = found[:, 0] ** 2 + found[:, 1] ** 2
        is_valid = (squares != 0.0) | (found[:, 2] != 0.0)
        if self._max_speed >= 0.0:
            is_valid &= squares <= self._max_speed**2 + _SLACK
        if options.min_speed_xy >= 0.0 and options.min_speed_theta >= 0.0:
            is_slow = squares + _SLACK < options.min_speed_xy**2
            is_valid &= ~(is_slow & (np.abs(found[:, 2]) + _SLACK < options.min_speed_theta))
        tried: Floats = found[is_valid]
        return tried

    def trajectories(self, pose: PlanarPose, present: Speeds3) -> Trajectories:
        """Return the trajectories of all velocities that are tried."""
        options, velocities = self._options, self.velocities(present)
        counts = self._step_counts(velocities)
        most, periods = int(counts.max(initial=1)), options.sim_time / counts
        steps = np.arange(1, most + 1)[:, None]
        elapsed = np.minimum(steps, counts) * periods
        times = np.where(steps <= counts, periods, 0.0)
        speeds = [
            velocities[:, index] if self._is_limited else axis.projected(present[index], velocities[:, index], elapsed)
            for index, axis in enumerate(self._axes)
        ]
        yaw = _accumulated(pose.yaw, speeds[2] * times)
        cos, sin = cosine(yaw[:-1]), sine(yaw[:-1])
        x, y = speeds[0] * cos, speeds[0] * sin
        if velocities[:, 1].any() or present[1]:
            x, y = x - speeds[1] * sin, y + speeds[1] * cos
        commands = velocities
        if options.limit_vel_cmd_in_traj and not self._is_limited:
            commands = np.column_stack([speed[0] for speed in speeds])
        return Trajectories(
            commands, _accumulated(pose.x, x * times), _accumulated(pose.y, y * times), yaw, counts, options.sim_time
        )

    def _step_counts(self, velocities: Floats) -> npt.NDArray[np.int64]:
        options = self._options
        if options.discretize_by_time:
            return np.full(len(velocities), max(1, math.ceil(options.sim_time / options.time_granularity)), np.int64)
        way = np.sqrt(velocities[:, 0] ** 2 + velocities[:, 1] ** 2) * options.sim_time
        angle = np.abs(velocities[:, 2]) * options.sim_time
        counts = np.ceil(np.maximum(way / options.linear_granularity, angle / options.angular_granularity))
        return np.clip(counts, 1, _MOST_STEPS).astype(np.int64)


def _accumulated(first: float, changes: Floats) -> Floats:
    """Return the values after each change, and the first one before them."""
    values = np.empty((len(changes) + 1, changes.shape[1]))
    values[0] = first
    for step, change in enumerate(changes):
        np.add(values[step], change, out=values[step + 1])
    return values
