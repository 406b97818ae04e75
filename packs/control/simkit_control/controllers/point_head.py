"""Action that turns a head towards a point, like `point_head_action` of PAL's and other robots."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, ClassVar, Final

import numpy as np

from simkit import Pose, msgs
from simkit.errors import InputError
from simkit.extend import Vector
from simkit.linear_algebra import norm
from simkit.msgs.goal_status import GoalStatus
from simkit.plugins.joints.joint_trajectory import SECOND
from simkit.plugins.ros_parameter_block import read_names
from simkit_control.plugins.ros2_control.controller import Controller
from simkit_control.plugins.ros2_control.head_pointing import HeadJoints, frame_link, frame_pose, is_moved_by_joint

if TYPE_CHECKING:
    from simkit.extend import GoalHandle
    from simkit.msgs import PointHead_Goal, PointStamped

POINT_HEAD: Final = "control_msgs/action/PointHead"
_FEEDBACK_NS: Final = SECOND // 20
_FARTHEST: Final = 1e12  # [m]
_LONGEST: Final = 2e9  # [s]; a duration message cannot represent more than 2.1e9 s
_SETTLING_NS: Final = SECOND // 2


class PointHeadAction(Controller):
    """Turns a head to goals of `<controller>/point_head_action`, through the trajectory controller in `controller`.

    The two joints of the neck turn the frame `pointing_frame` so that its `pointing_axis` points at the target. The
    target is a point in any frame; it is converted to the world frame once, when the goal arrives. The motion takes at
    least `min_duration`, and no joint is faster than `max_velocity` or its own limit. The goal succeeds once the angle
    between the axis and the target is at most `success_angle_threshold`. The goal is aborted if the limits of the neck
    do not allow this angle. The controller claims no interfaces. Another trajectory for the head during the motion
    ends the goal.
    """

    types: ClassVar[tuple[str, ...]] = ("simkit/PointHeadAction", "head_action/PointHeadAction")

    def configure(self) -> None:
        params = self.params
        self._trajectory_controller = params.text("controller", "head_controller")
        self._joints = tuple(read_names(params, "joints", code="SK-CONTROL-027"))
        self._tolerance = params.number("success_angle_threshold", 0.02, minimum=0.0)
        self._own_frame = params.text("pointing_frame", "")
        self._own_axis = np.array(
            [
                params.block("pointing_axis").number(axis, default)
                for axis, default in zip("xyz", (1.0, 0.0, 0.0), strict=True)
            ]
        )
        if len(self._joints) != 2:
            message = f"'joints' has {len(self._joints)} names; name two joints, the joint nearer the body first"
            params.error("SK-CONTROL-027", message, "joints: [head_1_joint, head_2_joint]")
        for name in self._joints:
            if name not in self.hardware.joints:
                message = f"there is no joint {name!r} for the head"
                params.error("SK-CONTROL-027", message, "the joints are: " + ", ".join(self.hardware.joints))
        action = params.text("action", f"{self._trajectory_controller}/point_head_action")
        self.act(action, POINT_HEAD, self._on_goal, self._on_cancel)
        self._is_active = False
        self._clear()

    def _clear(self) -> None:
        self._goal: GoalHandle | None = None
        self._motion_goal: GoalHandle | None = None
        self._pointing: tuple[str, Vector] = "", np.zeros(3)
        self._target, self._next_feedback = np.zeros(3), 0
        self._settled_by_ns = 0  # time until which the head may settle after its motion

    def activate(self) -> None:
        self._clear()
        self._is_active = True

    def deactivate(self) -> None:
        self._is_active = False
        if self._goal is not None:
            self._end_goal(lambda goal: goal.abort(reason="the controller was deactivated"))
            self._stop()

    # ------------------------------------------------------------------ goals

    def _on_goal(self, goal: GoalHandle) -> None:
        if not self._is_active:
            goal.reject("Can't accept new action goals. Controller is not running.")
            return
        try:
            request = goal.request
            target = self._read_target(request.target)
            pointing = self._read_pointing(request)
            neck = self._head_joints(pointing)
        except InputError as error:
            goal.reject(str(error))
            return
        if norm(target - neck.frame.position) < 1e-6:
            goal.reject("the target is at the origin of the pointing frame")
            return
        speed = request.max_velocity
        shortest = msgs.stamp_ns(request.min_duration) / SECOND
        if not (np.isfinite(speed) and speed >= 0.0 and shortest >= 0.0):
            goal.reject("max_velocity and min_duration must be at least 0")
            return
        if self._goal is not None:
            self._end_goal(lambda old: old.canceled(reason="Current goal cancelled due to new incoming action."))
        self._goal, self._target, self._pointing, self._next_feedback = goal, target, pointing, 0
        self._send_head(neck, shortest, speed)

    def _read_target(self, target: PointStamped) -> Vector:
        point = np.array([target.point.x, target.point.y, target.point.z])
        if not (np.abs(point) <= _FARTHEST).all():
            raise InputError("the target has a coordinate that is NaN, infinite or too large")
        return self._frame(target.header.frame_id or "world").transform(point)

    def _read_pointing(self, request: PointHead_Goal) -> tuple[str, Vector]:
        """Return the frame that points at the target, and the unit vector of its pointing axis."""
        axis = np.array([request.pointing_axis.x, request.pointing_axis.y, request.pointing_axis.z])
        if not axis.any():
            axis = self._own_axis
        if not (np.abs(axis) <= _FARTHEST).all() or not (length := norm(axis)):
            raise InputError("the pointing axis is zero, or has a component that is NaN, infinite or too large")
        tilt = self.hardware.joints[self._joints[1]].handle
        frame = request.pointing_frame or self._own_frame or tilt.scene.child_link
        is_fixed = frame.lstrip("/") in ("world", "map", *self._odometry_frames())
        if is_fixed or not is_moved_by_joint(self.sim, frame_link(self.sim, self.plugin.scoped, frame)[0], tilt.scoped):
            raise InputError(
                f"the frame {frame!r} is not turned by joint {self._joints[1]!r}: the head cannot point it"
            )
        return frame, axis / length

    def _frame(self, name: str) -> Pose:
        return frame_pose(self.sim, self.plugin.scoped, name, self._odometry_frames())

    def _odometry_frames(self) -> dict[str, Pose]:
        """Return the world poses of odometry frames, such as `odom`, computed from the odometry of the base."""
        manager = getattr(self.plugin, "manager", None)
        poses: dict[str, Pose] = {}
        for loaded in getattr(manager, "controllers", {}).values():
            frames = getattr(loaded.controller, "odometry_frame", None)
            if frames is not None:
                odom, base, pose = frames
                poses[odom] = frame_pose(self.sim, self.plugin.scoped, base) @ pose.inverse()
        return poses

    def _head_joints(self, pointing: tuple[str, Vector]) -> HeadJoints:
        """Return the current axes, angles and limits of the neck's joints, with the pointing frame."""
        data = self.sim.engine.physics.fresh()
        joints = [self.hardware.joints[name] for name in self._joints]
        ids = [int(self.sim.mj_model.dof_jntid[joint.handle.mj_dofs[0]]) for joint in joints]
        return HeadJoints(
            np.array(data.xanchor[ids]),
            np.array(data.xaxis[ids]),
            np.array([float(joint.handle.position) for joint in joints]),
            np.array([joint.lower for joint in joints]),
            np.array([joint.upper for joint in joints]),
            self._frame(pointing[0]),
            pointing[1],
        )

    def _send_head(self, neck: HeadJoints, shortest: float, speed: float) -> None:
        """Send the trajectory that turns the head towards the target."""
        angles, _ = neck.aim(self._target)
        limits = np.array([self.hardware.joints[name].max_velocity for name in self._joints])
        speeds = np.minimum(limits, speed) if speed > 0.0 else limits
        distances = np.abs(angles - neck.angles)
        # the peak speed of a cubic between two states at rest is 1.5 times its mean speed
        duration = max(shortest, float((1.5 * distances / np.where(speeds > 0.0, speeds, np.inf)).max()), 0.05)
        point = {
            "positions": angles,
            "velocities": np.zeros(2),
            "time_from_start": msgs.duration(round(min(duration, _LONGEST) * SECOND)),
        }
        trajectory = {"joint_names": list(self._joints), "points": [point]}
        try:
            name = self.plugin.ros.topic(f"{self._trajectory_controller}/follow_joint_trajectory")
            self._motion_goal = self.sim.send_goal(name, {"trajectory": trajectory})
        except InputError as error:
            reason = str(error)
            self._end_goal(lambda goal: goal.abort(reason=reason))

    def _on_cancel(self, goal: GoalHandle) -> None:
        if goal is self._goal:
            self._end_goal(lambda ended: ended.canceled())
            self._stop()

    def _stop(self) -> None:
        move, self._motion_goal = self._motion_goal, None
        if move is not None and not move.is_done:
            move.cancel()

    def _end_goal(self, how: Callable[[GoalHandle], None]) -> None:
        goal, self._goal = self._goal, None
        if goal is not None:
            how(goal)

    # ------------------------------------------------------------------ each period

    def update(self, now_ns: int, period: float) -> None:
        goal, move = self._goal, self._motion_goal
        if goal is None or move is None:
            return
        if now_ns < self._next_feedback:
            return
        self._next_feedback = now_ns + _FEEDBACK_NS
        neck = self._head_joints(self._pointing)
        error = neck.error(neck.angles, self._target)
        goal.publish_feedback({"pointing_angle_error": error})
        if not move.is_done:
            self._settled_by_ns = now_ns + _SETTLING_NS
            return
        if error <= self._tolerance:
            self._end_goal(lambda ended: ended.succeed())
        elif now_ns < self._settled_by_ns and move.status is GoalStatus.SUCCEEDED:
            return
        elif move.status is GoalStatus.SUCCEEDED:
            reason = f"the limits of the neck keep the pointing axis {error:.3f} rad away from the target"
            self._end_goal(lambda ended: ended.abort(reason=reason))
        else:
            reason = f"the head did not reach the target: {move.reason}"
            self._end_goal(lambda ended: ended.abort(reason=reason))
