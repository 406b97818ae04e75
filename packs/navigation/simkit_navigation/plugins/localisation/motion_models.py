"""Motion models of a particle filter: odometry moves each particle with an error of its own."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

import numpy as np

from simkit.pose import wrap_angle
from simkit_navigation.plugins.localisation.likelihood_field import Poses

Motion = tuple[float, float, float]
"""Motion of the robot in its frame before the motion: x, y [m] and yaw [rad]."""
Alphas = tuple[float, float, float, float, float]
MotionModel = Callable[[Poses, Motion, Alphas, np.random.Generator], Poses]

_STANDS: Final = 0.01  # [m]; the direction of a shorter motion is noise


def _unsigned(angle: float) -> float:
    """Return the size of a turn [rad]; a robot that drives backwards has not turned by π."""
    angle = abs(wrap_angle(angle))
    return min(angle, math.pi - angle)


def differential(poses: Poses, motion: Motion, alphas: Alphas, generator: np.random.Generator) -> Poses:
    """Return the moved poses of a robot that turns, drives, and turns again.

    This is `sample_motion_model_odometry` of Thrun, Burgard and Fox: *Probabilistic Robotics*, table 5.6.

    Args:
        poses: poses before the motion.
        motion: motion by odometry.
        alphas: variances: of turns by turns [rad²/rad²], of turns by travel [rad²/m²], of travel by travel [m²/m²], of
            travel by turns [m²/rad²]; the fifth one is not used.
        generator: random numbers.
    """
    x, y, yaw = motion
    travel = math.hypot(x, y)
    first = math.atan2(y, x) if travel >= _STANDS else 0.0
    second = wrap_angle(yaw - first)
    a, b = _unsigned(first) ** 2, _unsigned(second) ** 2
    a1, a2, a3, a4, _ = alphas
    noise = generator.standard_normal((3, len(poses)))
    first_turn = first + math.sqrt(a1 * a + a2 * travel**2) * noise[0]
    driven = travel + math.sqrt(a3 * travel**2 + a4 * (a + b)) * noise[1]
    second_turn = second + math.sqrt(a1 * b + a2 * travel**2) * noise[2]
    heading = poses[:, 2] + first_turn
    moved_x, moved_y = poses[:, 0] + driven * np.cos(heading), poses[:, 1] + driven * np.sin(heading)
    return np.column_stack((moved_x, moved_y, wrapped_angles(heading + second_turn)))


def omnidirectional(poses: Poses, motion: Motion, alphas: Alphas, generator: np.random.Generator) -> Poses:
    """Return the moved poses of a robot that drives in any direction; see `differential` for the arguments.

    The fifth variance is that of the travel to the side by travel [m²/m²].
    """
    x, y, yaw = motion
    travel, turned = math.hypot(x, y), yaw**2
    a1, a2, a3, a4, a5 = alphas
    noise = generator.standard_normal((3, len(poses)))
    driven = travel + math.sqrt(a3 * travel**2 + a4 * turned) * noise[0]
    aside = math.sqrt(a5 * travel**2 + a4 * turned) * noise[1]
    turn = yaw + math.sqrt(a1 * turned + a2 * travel**2) * noise[2]
    heading = poses[:, 2] + (math.atan2(y, x) if travel >= _STANDS else 0.0)
    cos, sin = np.cos(heading), np.sin(heading)
    moved_x, moved_y = poses[:, 0] + driven * cos + aside * sin, poses[:, 1] + driven * sin - aside * cos
    return np.column_stack((moved_x, moved_y, wrapped_angles(poses[:, 2] + turn)))


def wrapped_angles(angles: Poses) -> Poses:
    """Return angles [rad] from -π to π."""
    wrapped: Poses = (angles + np.pi) % (2 * np.pi) - np.pi
    return wrapped


MOTION_MODELS: Final[dict[str, MotionModel]] = {
    "nav2_amcl::DifferentialMotionModel": differential,
    "nav2_amcl::OmniMotionModel": omnidirectional,
}
