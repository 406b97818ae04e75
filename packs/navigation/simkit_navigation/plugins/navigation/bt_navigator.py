"""Plugin that navigates to goals with planner, controller and behaviours, as Nav2's `nav2_bt_navigator`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params, msgs
from simkit.errors import InputError, TransformError
from simkit.extend import NEVER, Options, OptionsOf, integer, number, offers, text
from simkit.msgs.goal_status import GoalStatus
from simkit_navigation.plugins.lifecycle_state import GET_STATE, answer_active
from simkit_navigation.plugins.navigation.node_parameters import NodeParameters
from simkit_navigation.plugins.navigation.planar_pose import (
    Floats,
    PlanarPose,
    look_up,
    planar_of,
    pose_of_message,
    poses_of_path,
    stamped_pose,
)

if TYPE_CHECKING:
    from simkit import Model, Simulation
    from simkit.extend import GoalHandle

_POSE: Final = "geometry_msgs/msg/PoseStamped"
_RECOVERIES: Final = ("clear", "spin", "wait", "backup")
_NO_PATH: Floats = np.zeros((0, 3))
_SECOND: Final = 1_000_000_000
_FEEDBACK_NS: Final = 100_000_000


class BtNavigatorOptions(Options):
    """Options of `BtNavigator`."""

    global_frame: str = text("map")
    robot_base_frame: str = text("base_footprint")
    bt_loop_duration: float = number(10.0, "ms", minimum=1, maximum=1000)
    planning_rate: float = number(1.0, "Hz", minimum=0.001)
    number_of_retries: int = integer(6, minimum=0)
    spin_dist: float = number(1.57, "rad")
    wait_duration: float = number(5.0, "s", minimum=0)
    backup_dist: float = number(0.3, "m", minimum=0)
    backup_speed: float = number(0.05, "m/s", minimum=0.001)
    global_costmap: str = text("global_costmap")
    local_costmap: str = text("local_costmap")
    planner_id: str = text()
    controller_id: str = text()


@dataclass(eq=False)
class _Task:
    """Navigation to one or several poses.

    Attributes:
        goal: goal of the action.
        targets: poses that remain, in the frame of the map, as messages; the last one is the end.
        begin_ns: time of the start [ns].
        plan: goal of the planner, while it plans.
        follow: goal of the controller.
        recovery: goal of a behaviour.
        path: newest path, shape (n, 3).
        path_message: newest path.
        next_plan_ns: time of the next plan [ns].
        next_feedback_ns: time of the next feedback [ns].
        recoveries: number of recoveries so far.
        is_plan_retried: True if the costmap was cleared for a plan that failed.
        is_follow_retried: True if the costmap was cleared for a path that could not be followed.
    """

    goal: GoalHandle
    targets: list[msgs.PoseStamped]
    begin_ns: int
    plan: GoalHandle | None = None
    follow: GoalHandle | None = None
    recovery: GoalHandle | None = None
    path: Floats = field(default_factory=_NO_PATH.copy)
    path_message: msgs.Path | None = None
    next_plan_ns: int = 0
    next_feedback_ns: int = 0
    recoveries: int = 0
    is_plan_retried: bool = False
    is_follow_retried: bool = False


class BtNavigator(NodeParameters):
    """Navigates to poses: actions `navigate_to_pose` and `navigate_through_poses`, topic `goal_pose`.

    The behaviour is that of Nav2's tree `navigate_to_pose_w_replanning_and_recovery`: a new path at `<planning_rate>`;
    after a failure, the costmap is cleared and the step is tried once more; then come recoveries in turn: clear both
    costmaps, spin, wait, back up. After `<number_of_retries>` recoveries without success, the goal is aborted.
    """

    filenames = ("libsimkit_bt_navigator.so",)
    names = ("simkit::BtNavigator", "nav2_bt_navigator::BtNavigator")
    parent_kind = ("world", "model")
    executable = "bt_navigator"
    options = OptionsOf(BtNavigatorOptions)
    endpoints = (offers("~/get_state", GET_STATE),)
    before_step_rate = NEVER

    def load(self, parent: Simulation | Model, params: Params) -> None:
        self.options.read_all()
        self.sim.tf.open()  # so that the first look-up knows the transforms before it
        self._task: _Task | None = None
        self._turn = 0  # recovery that comes next
        self.act("navigate_to_pose", "nav2_msgs/action/NavigateToPose", self._on_goal, self._on_cancel)
        self.act("navigate_through_poses", "nav2_msgs/action/NavigateThroughPoses", self._on_goal, self._on_cancel)
        self.listen("goal_pose", _POSE, self._on_goal_pose)
        answer_active(self)

    # ------------------------------------------------------------------ goals

    def _on_goal_pose(self, message: msgs.PoseStamped) -> None:
        self.sim.send_goal(self.ros.topic("navigate_to_pose"), {"pose": message})

    def _on_goal(self, goal: GoalHandle) -> None:
        wanted = list(goal.request.poses) if hasattr(goal.request, "poses") else [goal.request.pose]
        try:
            targets = [self._in_map(stamped) for stamped in wanted]
        except ValueError as error:
            self._reject(goal, str(error))
            return
        if not targets:
            self._reject(goal, "the goal has no pose")
            return
        if self._pose() is None:
            frames = f"{self.options.global_frame!r} and {self.options.robot_base_frame!r}"
            self._reject(goal, f"the pose of the robot is not known; a localisation must connect the frames {frames}")
            return
        before = self._task
        self._task = _Task(goal, targets, self.sim.time_ns)
        if before is not None:
            self._task.follow = before.follow  # the robot drives on until there is a path to the new goal
            self._cancel(before.plan, before.recovery)
            before.goal.abort(reason="another goal replaced this one")
        self._set_before_step_rate(1000.0 / self.options.bt_loop_duration)

    def _reject(self, goal: GoalHandle, reason: str) -> None:
        self.log.error("Goal rejected: %s", reason)  # the topic goal_pose has no other answer
        goal.reject(reason)

    def _in_map(self, stamped: msgs.PoseStamped) -> msgs.PoseStamped:
        """Return a stamped pose in the frame of the map.

        Raises:
            ValueError: the pose is not known there.
        """
        wanted, pose = self.options.global_frame, pose_of_message(stamped.pose)
        if pose is None:
            raise ValueError("the pose of the goal contains NaN or infinite numbers")
        frame = stamped.header.frame_id or wanted
        if frame != wanted:
            try:
                pose = planar_of(self.sim.tf.lookup(wanted, frame)).compose(pose)
            except TransformError as error:
                raise ValueError(f"the pose of the goal is not known in {wanted!r}: {error}") from None
        return stamped_pose(pose, msgs.header(self.sim.time_ns, wanted))

    def _on_cancel(self, goal: GoalHandle) -> None:
        if self._task is not None and goal is self._task.goal:
            self._leave()
        goal.canceled()

    def _pose(self) -> PlanarPose | None:
        return look_up(self.sim, self.options.global_frame, self.options.robot_base_frame)

    # ------------------------------------------------------------------ the behaviour

    def before_step(self) -> None:
        task = self._task
        if task is None:
            return
        if self.sim.time_ns >= task.next_feedback_ns:
            self._publish_feedback(task)
        if self._task is not task:
            return
        if task.recovery is not None:
            if not task.recovery.is_done:
                return
            task.recovery = None
        if task.plan is not None and task.plan.is_done:
            self._take_plan(task)
        if self._task is task and task.follow is not None and task.follow.is_done and task.recovery is None:
            self._take_end(task)
        is_free = self._task is task and task.plan is None and task.recovery is None
        if is_free and self.sim.time_ns >= task.next_plan_ns:
            self._send_plan(task)

    def _send_plan(self, task: _Task) -> None:
        task.next_plan_ns = self.sim.time_ns + round(_SECOND / self.options.planning_rate)
        request = {"goal": task.targets[0], "planner_id": self.options.planner_id}
        task.plan = self._send(task, "compute_path_to_pose", request)

    def _take_plan(self, task: _Task) -> None:
        """Follow a new path, or react to the lack of one."""
        plan, task.plan = task.plan, None
        assert plan is not None
        path = poses_of_path(plan.result.path) if plan.status is GoalStatus.SUCCEEDED else None
        if path is not None and len(path):
            task.is_plan_retried, task.path, task.path_message = False, path, plan.result.path
            self._send_path(task)
        elif not task.is_plan_retried:
            task.is_plan_retried, task.next_plan_ns = True, self.sim.time_ns
            self._clear(self.options.global_costmap)
        else:
            self._recover(task, plan, "there is no path")

    def _send_path(self, task: _Task) -> None:
        request = {"path": task.path_message, "controller_id": self.options.controller_id}
        task.follow = self._send(task, "follow_path", request)

    def _take_end(self, task: _Task) -> None:
        """React to the end of a path."""
        follow, task.follow = task.follow, None
        assert follow is not None
        if task.path_message is None:
            return  # this was the path of the goal before this one
        if follow.status is GoalStatus.SUCCEEDED:
            task.targets.pop(0)
            task.next_plan_ns = self.sim.time_ns
            if not task.targets:
                self._leave()
                task.goal.succeed()
        elif follow.status is GoalStatus.ABORTED and not task.is_follow_retried:
            task.is_follow_retried = True
            self._clear(self.options.local_costmap)
            self._send_path(task)
        elif follow.status is not GoalStatus.CANCELED:
            self._recover(task, follow, "the path cannot be followed")

    def _recover(self, task: _Task, failed: GoalHandle, problem: str) -> None:
        """Begin the next recovery after a goal of a server has failed, or abort after too many of them."""
        options = self.options
        self._cancel(task.follow)
        task.follow = None
        if task.recoveries >= options.number_of_retries:
            tried = "1 recovery" if task.recoveries == 1 else f"{task.recoveries} recoveries"
            reason = f"{failed.reason or problem}; {tried} did not help"
            self._abort(task, reason, getattr(failed.result, "error_code", 0))
            return
        task.recoveries += 1
        task.is_plan_retried = task.is_follow_retried = False
        task.next_plan_ns = self.sim.time_ns
        for _ in _RECOVERIES:
            name = _RECOVERIES[self._turn]
            self._turn = (self._turn + 1) % len(_RECOVERIES)
            if name == "clear":
                self._clear(options.local_costmap)
                self._clear(options.global_costmap)
                return
            if self.ros.topic(name) in self.sim.communication.actions.names():
                task.recovery = self._send(task, name, self._request(name))
                return

    def _request(self, name: str) -> dict[str, object]:
        """Return the goal of a recovery."""
        options = self.options
        if name == "spin":
            return {"target_yaw": options.spin_dist, "time_allowance": msgs.duration(10 * _SECOND)}
        if name == "wait":
            return {"time": msgs.duration(round(options.wait_duration * _SECOND))}
        allowance = msgs.duration(round((options.backup_dist / options.backup_speed + 5.0) * _SECOND))
        return {"target": {"x": options.backup_dist}, "speed": options.backup_speed, "time_allowance": allowance}

    # ------------------------------------------------------------------ helpers

    def _send(self, task: _Task, action: str, request: Mapping[str, object]) -> GoalHandle | None:
        """Send a goal to a server; abort the task if there is no such server."""
        try:
            return self.sim.send_goal(self.ros.topic(action), request)
        except InputError as error:
            self._abort(task, str(error).partition("\n")[0])
            return None

    def _clear(self, costmap: str) -> None:
        """Clear a costmap."""
        service = self.ros.topic(f"{costmap}/clear_entirely_{costmap.rpartition('/')[2]}")
        if service in self.sim.communication.services.names():
            self.sim.call(service, on_done=_ignore)

    def _cancel(self, *goals: GoalHandle | None) -> None:
        for goal in goals:
            if goal is not None and not goal.is_done:
                goal.cancel()

    def _leave(self) -> None:
        """End the present task."""
        if self._task is not None:
            self._cancel(self._task.plan, self._task.follow, self._task.recovery)
        self._task = None
        self._set_before_step_rate(NEVER)

    def _abort(self, task: _Task, reason: str, code: int = 0) -> None:
        """End a task as aborted, with the error code of the server that failed, as in Nav2."""
        if self._task is task:
            self._leave()
            self.log.error("Goal failed: %s", reason)
            task.goal.abort({"error_code": code, "error_msg": reason}, reason)

    def _publish_feedback(self, task: _Task) -> None:
        pose = self._pose()
        if pose is None:
            self._abort(task, "the pose of the robot is not known any more")
            return
        task.next_feedback_ns = self.sim.time_ns + _FEEDBACK_NS
        elapsed = self.sim.time_ns - task.begin_ns
        remaining = _remaining(task.path, pose)
        speed = task.follow.feedback.speed if task.follow is not None and task.follow.feedback is not None else 0.0
        left = remaining / speed if speed > 1e-2 else 0.0
        feedback: dict[str, object] = {
            "current_pose": stamped_pose(pose, msgs.header(self.sim.time_ns, self.options.global_frame)),
            "navigation_time": msgs.duration(elapsed),
            "estimated_time_remaining": msgs.duration(round(left * _SECOND)),
            "number_of_recoveries": task.recoveries,
            "distance_remaining": remaining,
        }
        if hasattr(task.goal.request, "poses"):
            feedback["number_of_poses_remaining"] = len(task.targets)
        task.goal.publish_feedback(feedback)


def _remaining(path: Floats, pose: PlanarPose) -> float:
    """Return the length of a path from the point that is nearest to a pose [m]."""
    if not len(path):
        return 0.0
    nearest = int(np.hypot(path[:, 0] - pose.x, path[:, 1] - pose.y).argmin())
    steps = np.hypot(*np.diff(path[nearest:, :2], axis=0).T)
    return float(steps.sum()) + math.hypot(path[nearest, 0] - pose.x, path[nearest, 1] - pose.y)


def _ignore(_: object) -> None:
    """Ignore the response of a service."""
