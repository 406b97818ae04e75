"""Frames, velocities and transmitted wrench of joints: ball and floating joints, and joints that close loops."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np

from simkit.compiler import JointBinding
from simkit.linear_algebra import matmul
from simkit.matrix_decompositions import lstsq
from simkit.pose import IDENTITY, Pose, Vector, quat_conjugate, quat_multiply, quat_rotate
from simkit.runtime.engine.physics_state import STALE

if TYPE_CHECKING:
    from simkit.runtime.engine.engine_state import EngineState


_XBODY: Final = int(mujoco.mjtObj.mjOBJ_XBODY)
_MAX_ITERATIONS: Final = 30
_LOOP_TOLERANCE: Final = 1e-13

# ------------------------------------------------------------------ ball joints


def ball_quaternion(binding: JointBinding, stored: Vector) -> Vector:
    """Return the orientation of the child-side frame in the parent-side frame from the engine's stored quaternion."""
    frame = binding.pose_moved.quaternion
    turned = quat_multiply(quat_multiply(quat_conjugate(frame), stored), frame)
    return quat_conjugate(turned) if binding.is_reversed else turned


def stored_quaternion(binding: JointBinding, quaternion: Vector) -> Vector:
    """Return the engine's quaternion for a joint orientation; the inverse of `ball_quaternion`."""
    frame = binding.pose_moved.quaternion
    turned = quat_conjugate(quaternion) if binding.is_reversed else quaternion
    return quat_multiply(quat_multiply(frame, turned), quat_conjugate(frame))


def ball_rotation(binding: JointBinding, stored: Vector) -> Vector:
    """Return the rotation from the engine's velocity or torque of a ball joint to the child-side frame, shape (3, 3).

    The matrix is negated for a joint whose direction is reversed in the engine.
    """
    back = quat_conjugate(binding.pose_moved.quaternion)
    if not binding.is_reversed:
        return Pose((0.0, 0.0, 0.0), back).matrix
    return -Pose((0.0, 0.0, 0.0), quat_multiply(back, stored)).matrix


# ------------------------------------------------------------------ readings of any data


def joint_position(binding: JointBinding, data: mujoco.MjData) -> Vector:
    """Return the position [rad or m] of a joint in these data, one number per degree of freedom.

    The position of a ball joint is a rotation vector.
    """
    if binding.type == "ball" and binding.qpos:
        start, turn = binding.qpos[0], np.zeros(3)
        mujoco.mju_quat2Vel(turn, ball_quaternion(binding, data.qpos[start : start + 4]), 1.0)
        return turn
    return np.array(data.qpos[list(binding.qpos)])


def joint_velocity(binding: JointBinding, data: mujoco.MjData) -> Vector:
    """Return the velocity [rad/s or m/s] of a joint in these data, for a ball joint in the child's joint frame."""
    velocity = np.array(data.qvel[list(binding.dofs)])
    if binding.type == "ball" and binding.qpos:
        start = binding.qpos[0]
        velocity = matmul(ball_rotation(binding, np.array(data.qpos[start : start + 4])), velocity)
    return velocity


# ------------------------------------------------------------------ floating joints


def _link_pose(engine: EngineState, scoped: str) -> Pose:
    """Return the world pose of a link's frame."""
    binding, data = engine.names.link(scoped), engine.physics.fresh()
    pose = Pose(data.xpos[binding.body], data.xquat[binding.body])
    return pose if binding.offset == IDENTITY else pose @ binding.offset


def _joint_frames(engine: EngineState, binding: JointBinding) -> tuple[Pose, Pose]:
    """Return the world poses of the parent-side and the child-side frame."""
    parent, child = binding.scene.parent_link, binding.scene.child_link
    return _frame_on_link(engine, parent, binding.pose_parent), _frame_on_link(engine, child, binding.pose_child)


def _frame_on_link(engine: EngineState, link: str, frame: Pose) -> Pose:
    return frame if link not in engine.names.links else _link_pose(engine, link) @ frame


def relative_pose(engine: EngineState, binding: JointBinding) -> Pose:
    """Return the pose of the child-side frame in the parent-side frame."""
    parent, child = _joint_frames(engine, binding)
    return parent.inverse() @ child


def set_relative_pose(engine: EngineState, binding: JointBinding, pose: Pose) -> None:
    """Move the free link of a floating joint so that the child-side frame has this pose in the parent-side frame."""
    parent, child = _joint_frames(engine, binding)
    if binding.is_reversed:
        target = child @ pose.inverse() @ binding.pose_parent.inverse()
    else:
        target = parent @ pose @ binding.pose_child.inverse()
    start, qpos = engine.names.link(binding.free).root_joint_qpos, engine.mj_data.qpos
    qpos[start : start + 3], qpos[start + 3 : start + 7] = target.position, target.quaternion


def _point_velocity(engine: EngineState, link: str, point: Vector) -> tuple[Vector, Vector]:
    """Return the velocity of a point on a link and the link's angular velocity; world frame."""
    if link not in engine.names.links:
        return np.zeros(3), np.zeros(3)
    body, out, data = engine.names.link(link).body, np.zeros(6), engine.physics.fresh()
    if not body:
        return np.zeros(3), np.zeros(3)
    mujoco.mj_objectVelocity(engine.mj_model, data, _XBODY, body, out, 0)
    return out[3:] + np.cross(out[:3], point - data.xpos[body]), out[:3]


def relative_velocity(engine: EngineState, binding: JointBinding) -> Vector:
    """Return the velocity of the child-side origin in the parent-side frame [m/s] and the angular velocity [rad/s].

    The angular velocity is in the child-side frame.
    """
    parent, child = _joint_frames(engine, binding)
    v_parent, w_parent = _point_velocity(engine, binding.scene.parent_link, child.position)
    v_child, w_child = _point_velocity(engine, binding.scene.child_link, child.position)
    linear = quat_rotate(quat_conjugate(parent.quaternion), v_child - v_parent)
    angular = quat_rotate(quat_conjugate(child.quaternion), w_child - w_parent)
    return np.concatenate([linear, angular])


def set_relative_velocity(engine: EngineState, binding: JointBinding, velocity: Vector) -> None:
    """Set the velocity of a floating joint's free link so that `relative_velocity` has this value."""
    parent, child = _joint_frames(engine, binding)
    linear, angular = quat_rotate(parent.quaternion, velocity[:3]), quat_rotate(child.quaternion, velocity[3:])
    sign = -1.0 if binding.is_reversed else 1.0
    other = binding.scene.child_link if binding.is_reversed else binding.scene.parent_link
    v_other, w_other = _point_velocity(engine, other, child.position)
    free = engine.names.link(binding.free)
    data, dof = engine.mj_data, free.root_joint_dof
    pose = _link_pose(engine, binding.free)
    turning = w_other + sign * angular
    data.qvel[dof : dof + 3] = v_other + sign * linear + np.cross(turning, pose.position - child.position)
    data.qvel[dof + 3 : dof + 6] = quat_rotate(quat_conjugate(pose.quaternion), turning)


# ------------------------------------------------------------------ loops


def update_loop_joints(engine: EngineState) -> None:
    """Move the twin body of every loop joint to its link after joints were set, and give it the link's velocity.

    The twin can only move along the joint's own degrees of freedom. If the new state breaks a loop, the twin gets as
    near as possible (least squares, Gauss–Newton from its present state).
    """
    loops = [b for b in engine.names.joints.values() if b.is_loop and b.dofs]
    if not loops:
        return
    model, data = engine.mj_model, engine.mj_data
    change = np.zeros(model.nv)
    for _ in range(_MAX_ITERATIONS):
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        change[:] = 0.0
        for binding in loops:
            dofs, columns, spread = _loop_jacobian(engine, binding)
            change[dofs] += matmul(spread, lstsq(columns, _loop_error(engine, binding)))
        mujoco.mj_integratePos(model, data.qpos, change, 1.0)
        if float(np.abs(change).max()) < _LOOP_TOLERANCE:
            break
    for binding in loops:
        dofs, columns, spread = _loop_jacobian(engine, binding)
        data.qvel[dofs] = 0.0
        link = engine.names.link(binding.carried).body
        velocity = body_velocity(engine, link) - body_velocity(engine, binding.moved_body)
        data.qvel[dofs] = matmul(spread, lstsq(columns, velocity))
        engine.physics.changed_body(STALE, binding.moved_body)


def _loop_jacobian(engine: EngineState, binding: JointBinding) -> tuple[list[int], Vector, Vector]:
    """Return a twin's degrees of freedom, its Jacobian (6, k) for the joint's k free coordinates, and a matrix (n, k).

    The matrix converts velocities of the free coordinates to velocities of the n degrees of freedom.
    """
    model, data, body = engine.mj_model, engine.mj_data, binding.moved_body
    hidden = [f for f in binding.followers if model.dof_bodyid[f.dof] == body]
    dofs = [*binding.dofs, *(f.dof for f in hidden)]
    spread = np.zeros((len(dofs), len(binding.dofs)))
    spread[: len(binding.dofs)] = np.eye(len(binding.dofs))
    for row, follower in enumerate(hidden, len(binding.dofs)):
        spread[row, follower.axis] = follower.ratio
    jacobian = np.zeros((6, model.nv))
    mujoco.mj_jacBody(model, data, jacobian[:3], jacobian[3:], body)
    return dofs, matmul(jacobian[:, dofs], spread), spread


def _loop_error(engine: EngineState, binding: JointBinding) -> Vector:
    """Return the shift [m] and the rotation vector [rad] that move the twin to its link, world frame."""
    data, link, twin = engine.mj_data, engine.names.link(binding.carried).body, binding.moved_body
    turn = np.zeros(3)
    apart = quat_multiply(data.xquat[link], quat_conjugate(data.xquat[twin]))
    mujoco.mju_quat2Vel(turn, apart, 1.0)
    return np.concatenate([data.xpos[link] - data.xpos[twin], turn])


def body_velocity(engine: EngineState, body: int) -> Vector:
    """Return the velocity of a body's origin [m/s] and its angular velocity [rad/s], world frame, shape (6,)."""
    model, data = engine.mj_model, engine.mj_data
    jacobian = np.zeros((6, model.nv))
    mujoco.mj_jacBody(model, data, jacobian[:3], jacobian[3:], body)
    velocity: Vector = matmul(jacobian, data.qvel)
    return velocity


def transmitted_wrench(
    model: mujoco.MjModel, data: mujoco.MjData, binding: JointBinding, point: Vector
) -> tuple[Vector, Vector]:
    """Return the wrench of the parent link on the child link through a joint, world axes.

    The wrench includes the constraint forces of the joint, and the efforts of motors, springs, dampers, friction and
    stops along its axes (the same sum as gz-physics' `GetTransmittedWrench`). It is computed from the motion by
    Newton–Euler: the wrench that the bodies beyond the joint need besides external forces.

    Args:
        model: MuJoCo's model.
        data: MuJoCo's data with a forward pass and `mj_rnePostConstraint`; no body near the joint may sleep.
        binding: joint in the compiled model.
        point: reference point of the torque [m], world frame.

    Returns:
        Force [N] and torque [N·m]; zeros if the joint moves no body of the engine, for example if both links are
        static.
    """
    body = binding.moved_body
    if body <= 0:
        return np.zeros(3), np.zeros(3)
    # the body below the joint in the engine's tree carries the force; it may be the file's parent
    wrench = -data.cfrc_int[body] if binding.is_reversed else data.cfrc_int[body]
    # the engine's torques are about the centre of mass of the whole tree
    return wrench[3:].copy(), torque_about(wrench, data.subtree_com[model.body_rootid[body]], point)


def torque_about(wrench: Vector, centre: Vector, point: Vector) -> Vector:
    """Return the torque about a point [m] of a wrench (torque, force) about `centre` [m]."""
    fx, fy, fz = wrench[3:].tolist()
    x, y, z = (centre - point).tolist()
    torque: Vector = wrench[:3] + np.array((y * fz - z * fy, z * fx - x * fz, x * fy - y * fx))
    return torque
