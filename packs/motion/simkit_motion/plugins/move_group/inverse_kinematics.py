"""Inverse kinematics of a group of joints within their limits, from several seeds."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.extend import Vector
from simkit.linear_algebra import matmul
from simkit.plugins.joints.inverse_kinematics import PoseError, find_positions
from simkit_motion.plugins.move_group.group_model import GroupModel

if TYPE_CHECKING:
    from pinocchio import SE3

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
        places: False if only the rotation is given.
    """

    link: str
    pose: SE3
    offset: Vector
    turns: bool = True
    places: bool = True


def solutions(model: GroupModel, goal: PoseGoal, seeds: Iterator[Vector]) -> Iterator[Vector]:
    """Yield joint positions [rad or m] with which a link has a pose, one for each seed that leads to them."""
    for seed in seeds:
        solution = solve(model, goal, seed)
        if solution is not None:
            yield solution


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

    The pose error is in the frame of the tip. The damping falls with its square, so that the last steps are those of
    Newton's method. A joint at a limit that the step would exceed takes no part in the step.
    """
    import pinocchio

    joint, placement = model.tip(goal.link)
    tip = (joint, placement * pinocchio.SE3(np.eye(3), goal.offset))

    def pose_error(q: Vector) -> PoseError:
        pose, jacobian = model.pose_and_jacobian(tip, q)
        if not goal.places:
            error, jacobian = pinocchio.log3(matmul(pose.rotation.T, goal.pose.rotation)), jacobian[3:]
        elif goal.turns:
            error = pinocchio.log6(pose.actInv(goal.pose)).vector
        else:
            error, jacobian = matmul(pose.rotation.T, goal.pose.translation - pose.translation), jacobian[:3]
        return PoseError(error, jacobian, bool(np.abs(error).max() < _PRECISION))

    return find_positions(
        pose_error,
        np.array(seed, dtype=float),
        model.lower,
        model.upper,
        damping=lambda error: _DAMPING * float(matmul(error, error)) + 1e-12,
        longest_step=_LONGEST_STEP,
        steps=_STEPS,
        holds_limits=True,
    )
