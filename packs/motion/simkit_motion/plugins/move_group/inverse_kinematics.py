"""Inverse kinematics of a group of joints: damped least squares within the limits, from several seeds."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from simkit import linear_algebra
from simkit.linear_algebra import matmul
from simkit.pose import Vector
from simkit_motion.plugins.move_group.group_model import GroupModel

_STEPS: Final = 120  # iterations for one seed
_LONGEST_STEP: Final = 0.4  # [rad or m], of one joint
_DAMPING: Final = 1e-3  # [m or rad], the error at which the damping equals the square of the error's norm
_PRECISION: Final = 1e-6  # [m] and [rad]


@dataclass(frozen=True, eq=False)
class PoseGoal:
    """Pose that a link shall have.

    Attributes:
        link: Scoped name of the link.
        pose: Pose in the world, of Pinocchio's class; its rotation is ignored if `turns` is False.
        offset: Point of the link that the position is for, in the frame of the link [m].
        turns: False if only the position is given.
    """

    link: str
    pose: Any
    offset: Vector
    turns: bool = True


def solutions(model: GroupModel, goal: PoseGoal, seeds: Iterator[Vector]) -> Iterator[Vector]:
    """Yield joint positions [rad or m] with which a link has a pose, one for each seed that leads to them."""
    for seed in seeds:
        found = solve(model, goal, seed)
        if found is not None:
            yield found


def seeds_of(model: GroupModel, first: Vector, random: np.random.Generator, count: int) -> Iterator[Vector]:
    """Yield the given positions and then random positions within the limits."""
    yield np.clip(first, model.lower, model.upper)
    low, high = finite_limits(model)
    for _ in range(count - 1):
        yield random.uniform(low, high)


def finite_limits(model: GroupModel) -> tuple[Vector, Vector]:
    """Return the limits of the joints; a joint without limits may turn by π from its start position."""
    low = np.where(np.isfinite(model.lower), model.lower, model.start - np.pi)
    return low, np.where(np.isfinite(model.upper), model.upper, model.start + np.pi)


def solve(model: GroupModel, goal: PoseGoal, seed: Vector) -> Vector | None:
    """Return joint positions with which a link has a pose; None if the iteration from this seed does not lead to them.

    The step is Jᵀ (J Jᵀ + λ² I)⁻¹ e with the pose error e in the frame of the tip. λ² falls with |e|², so that the last
    steps are those of Newton's method. A joint at a limit that the step would exceed takes no part in the step.
    """
    import pinocchio

    joint, placement = model.tip(goal.link)
    tip = (joint, placement * pinocchio.SE3(np.eye(3), goal.offset))
    q = np.array(seed, dtype=float)
    for _ in range(_STEPS):
        pose, jacobian = model.pose_and_jacobian(tip, q)
        if goal.turns:
            error = pinocchio.log6(pose.actInv(goal.pose)).vector
        else:
            error, jacobian = matmul(pose.rotation.T, goal.pose.translation - pose.translation), jacobian[:3]
        if np.abs(error).max() < _PRECISION:
            return q
        step = _limited_step(jacobian, error, q, model)
        q = np.clip(
            q + step * min(1.0, _LONGEST_STEP / max(float(np.abs(step).max()), 1e-12)), model.lower, model.upper
        )
    return None


def _limited_step(jacobian: Vector, error: Vector, q: Vector, model: GroupModel) -> Vector:
    """Return the step of the joints; joints that would leave their limits are held."""
    damping = _DAMPING * float(matmul(error, error)) * np.eye(len(error)) + 1e-12 * np.eye(len(error))
    held = np.zeros(len(q), dtype=bool)
    while True:
        own = np.where(held, 0.0, jacobian)
        step: Vector = matmul(own.T, linear_algebra.solve(matmul(own, own.T) + damping, error))
        out = ~held & (((q <= model.lower) & (step < 0)) | ((q >= model.upper) & (step > 0)))
        if not out.any():
            return step
        held |= out
