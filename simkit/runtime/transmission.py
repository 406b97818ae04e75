"""The wrench that passes through a joint."""

from __future__ import annotations

from typing import Any

import numpy as np

from simkit.compiler import JointBinding
from simkit.pose import Vector


def transmitted_wrench(model: Any, data: Any, binding: JointBinding, point: Vector) -> tuple[Vector, Vector]:
    """What the parent link does to the child link through a joint, world axes.

    That is all that passes: what the joint holds, and along its own motions what motors, springs, dampers, friction and
    stops give (gz-physics' `GetTransmittedWrench` is the same sum). It is found from the motion: what the bodies beyond
    the joint need besides the forces that act on them from outside (Newton–Euler).

    Args:
        data: with a forward pass and `mj_rnePostConstraint`; nobody near the joint sleeps in it.
        point: that the torque is about [m], world frame.

    Returns:
        Force [N] and torque [N·m]; zeros where the joint moves nothing (both links static, or the joint binds nothing).
    """
    body = binding.moved_body
    if body <= 0:
        return np.zeros(3), np.zeros(3)
    # the body below the joint in the engine's tree carries the force; it may be the file's parent
    wrench = -data.cfrc_int[body] if binding.is_reversed else data.cfrc_int[body]
    # the engine's torques are about the centre of mass of the whole tree
    return wrench[3:].copy(), torque_at(wrench, data.subtree_com[model.body_rootid[body]], point)


def torque_at(wrench: Vector, centre: Vector, point: Vector) -> Vector:
    """The torque about a point [m] of a wrench (torque, force) that is about another, `centre` [m]."""
    fx, fy, fz = wrench[3:].tolist()
    x, y, z = (centre - point).tolist()
    torque: Vector = wrench[:3] + np.array((y * fz - z * fy, z * fx - x * fz, x * fy - y * fx))
    return torque
