"""Velocity limits of joints, enforced by impulses at the joints."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import matmul, solve, squared_length
from simkit.runtime.engine.physics_state import VELOCITY

if TYPE_CHECKING:
    from simkit.runtime.engine.forward_pass import ForwardPass

Vector = npt.NDArray[np.float64]

NO_LIMIT: Final = 1e6
"""Velocity [rad/s or m/s] from which a limit in a file means no limit."""

_LIMIT_SHARE = 0.999  # threshold for the sum of squares of velocities over their limits


LimitedDof = tuple[int, float]
"""Index among MuJoCo's degrees of freedom, and the velocity limit [rad/s or m/s]."""


def velocity_limiter(physics: ForwardPass, limited: Sequence[LimitedDof]) -> Callable[[int], None]:
    """Return one task that enforces velocity limits of degrees of freedom.

    A scalar product shows quickly that no joint is near its limit. Setting a limit makes a new schedule.
    """
    dofs, limits = np.array([dof for dof, _ in limited], dtype=np.intp), np.array([limit for _, limit in limited])
    shares = np.zeros(physics.model.nv)
    shares[dofs] = 1.0 / np.maximum(limits, 1e-9)

    def hold(_tick: int = 0) -> None:
        shares_of_limits = physics.data.qvel * shares
        if squared_length(shares_of_limits, _LIMIT_SHARE) >= _LIMIT_SHARE:  # otherwise no velocity exceeds its limit
            limit_velocities(physics, dofs, limits)

    return hold


def limit_velocities(physics: ForwardPass, dofs: npt.NDArray[np.intp], limits: Vector) -> None:
    """Bring the velocities of joints within their limits, by impulses between parent and child.

    Changing the joint's velocity alone would change the momentum of the robot: a robot that is not fixed would gain
    energy and fly away. Impulses keep the momentum, and the robot never gains energy.

    Args:
        physics: state of the engine.
        dofs: degrees of freedom with limits.
        limits: limit of each degree of freedom [rad/s or m/s].
    """
    model, data = physics.model, physics.data
    is_over = np.abs(data.qvel[dofs]) > limits
    if not is_over.any():
        return
    trees = model.dof_treeid[dofs]
    inside = np.isin(trees, trees[is_over])  # an impulse moves the other joints of its tree
    dofs, limits = dofs[inside], limits[inside]
    if not physics.fresh_velocities():
        physics.fresh()
    pulses, responses = np.zeros((len(dofs), model.nv)), np.zeros((len(dofs), model.nv))
    pulses[np.arange(len(dofs)), dofs] = 1.0
    mujoco.mj_solveM(model, data, responses, pulses)
    chosen, bounds, impulses = _impulses(data.qvel[dofs], limits, responses[:, dofs])
    data.qvel[:] += matmul(impulses, responses[chosen])
    data.qvel[dofs[chosen]] = bounds  # free of rounding errors
    for body in np.unique(model.dof_bodyid[dofs[chosen]]).tolist():
        physics.changed_body(VELOCITY, body)


def _impulses(velocities: Vector, limits: Vector, response: Vector) -> tuple[npt.NDArray[np.intp], Vector, Vector]:
    """Solve for the smallest impulses after which no velocity exceeds its limit.

    Args:
        velocities: velocities [rad/s or m/s].
        limits: their limits.
        response: change of each velocity by a unit impulse at each joint, a symmetric matrix.

    Returns:
        Indices of the joints with an impulse, their velocities afterwards, and the impulses.
    """
    signs = np.where(velocities < 0.0, -1.0, 1.0)
    active = np.abs(velocities) > limits
    chosen = np.flatnonzero(active)
    impulses: Vector = np.zeros(0)
    for _ in range(2 * len(limits) + 1):
        chosen = np.flatnonzero(active)
        wanted = (signs * limits - velocities)[chosen]
        impulses = np.asarray(solve(response[np.ix_(chosen, chosen)], wanted), dtype=np.float64)
        outward = impulses * signs[chosen]
        if outward.max() > 0.0:  # another joint's impulse already slows this joint
            active[chosen[outward.argmax()]] = False
            continue
        after = velocities + matmul(impulses, response[chosen])
        is_over = ~active & (np.abs(after) > limits * (1.0 + 1e-9))
        if not is_over.any():
            break
        signs[is_over] = np.sign(after[is_over])
        active |= is_over
    return chosen, (signs * limits)[chosen], impulses
