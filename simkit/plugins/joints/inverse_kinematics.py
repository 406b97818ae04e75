"""Inverse kinematics of joints in series: damped least squares within the limits of the joints."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from simkit.linear_algebra import matmul, solve
from simkit.pose import Vector


@dataclass(frozen=True, eq=False)
class PoseError:
    """Difference between the wanted and the present pose of a tip.

    Attributes:
        error: components of the difference [m and rad], shape (m,).
        jacobian: change of the pose per change of each joint, in the frame of `error`, shape (m, n).
        is_reached: True if the pose is close enough to the wanted one.
    """

    error: Vector
    jacobian: Vector
    is_reached: bool


def find_positions(
    pose_error: Callable[[Vector], PoseError],
    start: Vector,
    lower: Vector,
    upper: Vector,
    *,
    damping: Callable[[Vector], float],
    longest_step: float,
    steps: int,
    holds_limits: bool = False,
) -> Vector | None:
    """Return joint positions with which a pose is reached; None if the steps Jᵀ (J Jᵀ + λ² I)⁻¹ e do not lead to them.

    Args:
        pose_error: function of the joint positions, shape (n,).
        start: positions from which the steps begin [rad or m], shape (n,).
        lower: lower limits of the joints [rad or m], shape (n,).
        upper: upper limits of the joints [rad or m], shape (n,).
        damping: function that returns λ² for an error, shape (m,).
        longest_step: largest change of one joint in a step [rad or m].
        steps: largest number of steps.
        holds_limits: True if a joint at a limit that the step would exceed takes no part in the step.
    """
    positions = start
    for _ in range(steps):
        now = pose_error(positions)
        if now.is_reached:
            return positions
        square = damping(now.error) * np.eye(len(now.error))
        if holds_limits:
            step = _step_within_limits(now, square, positions, lower, upper)
        else:
            step = _step(now.jacobian, now.error, square)
        share = min(1.0, longest_step / max(float(np.abs(step).max()), 1e-12))
        positions = np.clip(positions + step * share, lower, upper)
    return None


def _step(jacobian: Vector, error: Vector, damping: Vector) -> Vector:
    step: Vector = matmul(jacobian.T, solve(matmul(jacobian, jacobian.T) + damping, error))
    return step


def _step_within_limits(now: PoseError, damping: Vector, positions: Vector, lower: Vector, upper: Vector) -> Vector:
    """Return the step of the joints; joints that would leave their limits are held."""
    is_held = np.zeros(len(positions), dtype=bool)
    while True:
        step = _step(np.where(is_held, 0.0, now.jacobian), now.error, damping)
        leaves = ~is_held & (((positions <= lower) & (step < 0)) | ((positions >= upper) & (step > 0)))
        if not leaves.any():
            return step
        is_held |= leaves
