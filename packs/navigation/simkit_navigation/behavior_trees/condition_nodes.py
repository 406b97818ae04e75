"""Conditions: those of BehaviorTree.CPP and of Nav2 (`nav2_behavior_tree/plugins/condition`)."""

from __future__ import annotations

import math
from typing import Any, ClassVar, Final

from simkit_navigation.behavior_trees.path_geometry import index_after, is_same, nearest_index, path_length
from simkit_navigation.behavior_trees.scripts import Script, ScriptError
from simkit_navigation.behavior_trees.tree_node import FAILURE, IDLE, RUNNING, SUCCESS, Ports, TreeError, TreeNode
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose, pose_of_message

_SECOND: Final = 1_000_000_000
_BRAKE_LIMIT: Final = -10.0  # [m/s²] of Nav2's is_stuck_condition.cpp


def _status(is_true: bool) -> str:
    return SUCCESS if is_true else FAILURE


class AlwaysSuccess(TreeNode):
    """Succeeds."""

    def tick(self) -> str:
        return SUCCESS


class AlwaysFailure(TreeNode):
    """Fails."""

    def tick(self) -> str:
        return FAILURE


class ScriptNode(TreeNode):
    """Executes a script."""

    ports: ClassVar[Ports] = ("code",)

    def prepare(self) -> None:
        try:
            self.script = Script(self.inputs.get("code", ""))
        except ScriptError as error:
            raise TreeError(f"<{self.tag}> code: {error}") from None

    def tick(self) -> str:
        try:
            value = self.script.run(self.board)
        except ScriptError as error:
            raise TreeError(f"<{self.tag}> code: {error}") from None
        return SUCCESS if self.tag == "Script" else _status(bool(value))


class SetBlackboard(TreeNode):
    """Writes a value to an entry of the blackboard."""

    ports: ClassVar[Ports] = ("value", "output_key")

    def tick(self) -> str:
        if "output_key" not in self.inputs:
            raise TreeError("<SetBlackboard> needs output_key")
        value, key = self.input("value", ""), self.inputs["output_key"]
        if key.strip().startswith("{"):
            self.output("output_key", value)
        else:
            self.board.set(key, value)
        return SUCCESS


class UnsetBlackboard(TreeNode):
    """Removes an entry of the blackboard."""

    ports: ClassVar[Ports] = ("key",)

    def tick(self) -> str:
        self.board.unset(self.inputs.get("key", "").strip("{} "))
        return SUCCESS


class Sleep(TreeNode):
    """Runs for `msec` milliseconds and succeeds."""

    ports: ClassVar[Ports] = ("msec",)

    def prepare(self) -> None:
        self.end_ns = 0

    def tick(self) -> str:
        if not self.is_active:
            self.end_ns = self.tree.time_ns + round(self.number("msec", 0) * 1e6)
        return SUCCESS if self.tree.time_ns >= self.end_ns else RUNNING


class WasEntryUpdated(TreeNode):
    """Succeeds if an entry of the blackboard has changed since the last tick."""

    ports: ClassVar[Ports] = ("entry",)

    def prepare(self) -> None:
        self.value: Any = None

    def tick(self) -> str:
        before, self.value = self.value, self.input("entry")
        return _status(not is_same(before, self.value))


# ---------------------------------------------------------------------- nodes of Nav2


class GoalUpdated(TreeNode):
    """Succeeds if the goal has changed since the last tick.

    A reactive parent resets its conditions while another child is running. The node keeps its goal then: otherwise a
    new goal does not end a recovery, as Nav2's documentation says (its issue 6082). The first tick of the node, and the
    first one after a pause, fail.
    """

    ports: ClassVar[Ports] = ("goal", "goals")

    def prepare(self) -> None:
        self.goals: tuple[Any, Any] = (None, None)
        self.last_tick = -1

    def tick(self) -> str:
        goals = (self.input_or_entry("goal"), self.input_or_entry("goals"))
        is_continued = self.status != IDLE or self.last_tick == self.tree.ticks - 1
        before, self.goals, self.last_tick = self.goals, goals, self.tree.ticks
        return _status(is_continued and not is_same(before, goals))


class GlobalUpdatedGoal(TreeNode):
    """Succeeds at its first tick, and if the goal has changed since the last one."""

    ports: ClassVar[Ports] = ("goal", "goals")

    def prepare(self) -> None:
        self.goals: tuple[Any, Any] | None = None

    def tick(self) -> str:
        before, self.goals = self.goals, (self.input_or_entry("goal"), self.input_or_entry("goals"))
        return _status(before is None or not is_same(before, self.goals))


class GoalReached(TreeNode):
    """Succeeds if the robot is within `goal_reached_tol` of the goal."""

    ports: ClassVar[Ports] = ("goal", "robot_base_frame", "global_frame")

    def tick(self) -> str:
        goal = self.input("goal") if "goal" in self.inputs else self.tree.goal
        pose = None if goal is None else self.tree.pose_of(self, goal.header.frame_id)
        target = None if goal is None else pose_of_message(goal.pose)
        if pose is None or target is None:
            return FAILURE
        return _status(pose.distance(target) <= float(self.tree.option("goal_reached_tol", 0.25)))


class ArePosesNear(TreeNode):
    """Succeeds if two poses are within `tolerance`."""

    ports: ClassVar[Ports] = ("ref_pose", "target_pose", "global_frame", "tolerance")

    def tick(self) -> str:
        first, second = self.input("ref_pose"), self.input("target_pose")
        if first is None or second is None:
            return FAILURE
        frame = first.header.frame_id
        if frame != second.header.frame_id:
            frame = self.text("global_frame", str(self.tree.option("global_frame", "map")))
        poses = [self.tree.in_frame(message, frame) for message in (first, second)]
        if poses[0] is None or poses[1] is None:
            return FAILURE
        return _status(poses[0].distance(poses[1]) <= self.number("tolerance", 0.5))


class IsGoalNearby(TreeNode):
    """Succeeds if the rest of the path is shorter than `proximity_threshold`."""

    ports: ClassVar[Ports] = (
        "path",
        "proximity_threshold",
        "max_robot_pose_search_dist",
        "global_frame",
        "robot_base_frame",
    )

    def prepare(self) -> None:
        self.path: Any = None
        self.begin = 0

    def tick(self) -> str:
        path, search = self.input("path"), self.number("max_robot_pose_search_dist", -1.0)
        if path is None or not path.poses:
            return FAILURE
        if search < 0 or not is_same(path, self.path):
            self.path, self.begin = path, 0
        pose = self.tree.pose_of(self, path.header.frame_id)
        if pose is None:
            return FAILURE
        end = None if search < 0 else index_after(path.poses, self.begin, search)
        self.begin = nearest_index(path.poses, pose.x, pose.y, self.begin, end)
        return _status(path_length(path.poses, self.begin) < self.number("proximity_threshold", 1.0))


class PathExpiringTimer(TreeNode):
    """Succeeds if the path has not changed for `seconds`."""

    ports: ClassVar[Ports] = ("seconds", "path")

    def prepare(self) -> None:
        self.start_ns: int | None = None
        self.path: Any = None

    def tick(self) -> str:
        now, path = self.tree.time_ns, self.input("path")
        if self.start_ns is None or not is_same(path, self.path):
            is_first = self.start_ns is None
            self.start_ns, self.path = now, path
            if is_first:
                return FAILURE
        if now - self.start_ns < self.number("seconds", 1.0) * _SECOND:
            return FAILURE
        self.start_ns = now
        return SUCCESS


class TimeExpired(TreeNode):
    """Succeeds each time `seconds` have passed."""

    ports: ClassVar[Ports] = ("seconds",)

    def prepare(self) -> None:
        self.start_ns = 0

    def tick(self) -> str:
        now = self.tree.time_ns
        if not self.is_active:
            self.start_ns = now
            return FAILURE
        if now - self.start_ns < self.number("seconds", 1.0) * _SECOND:
            return FAILURE
        self.start_ns = now
        return SUCCESS


class DistanceTraveled(TreeNode):
    """Succeeds each time the robot has moved `distance`."""

    ports: ClassVar[Ports] = ("distance", "global_frame", "robot_base_frame")

    def prepare(self) -> None:
        self.start: PlanarPose | None = None

    def tick(self) -> str:
        pose = self.tree.pose_of(self)
        if not self.is_active or self.start is None:
            self.start = pose
            return FAILURE
        if pose is None or pose.distance(self.start) < self.number("distance", 1.0):
            return FAILURE
        self.start = pose
        return SUCCESS


class TransformAvailable(TreeNode):
    """Succeeds from the moment on at which there is a transform between two frames."""

    ports: ClassVar[Ports] = ("child", "parent")

    def prepare(self) -> None:
        self.was_found = False

    def tick(self) -> str:
        child, parent = self.text("child"), self.text("parent")
        if not child or not parent:
            raise TreeError("<TransformAvailable> needs child and parent")
        self.was_found = self.was_found or self.tree.look_up(child, parent) is not None
        return _status(self.was_found)


class InitialPoseReceived(TreeNode):
    """Succeeds if the entry `initial_pose_received` is true."""

    ports: ClassVar[Ports] = ("initial_pose_received",)

    def tick(self) -> str:
        value = self.input_or_entry("initial_pose_received", False)
        return _status(value is True or str(value).lower() in ("true", "1"))


class IsStuck(TreeNode):
    """Succeeds if the odometry shows a deceleration of more than 10 m/s²."""

    def prepare(self) -> None:
        self.tree.use_odometry()

    def tick(self) -> str:
        before, now = self.tree.odometry
        if before is None or now is None:
            return FAILURE
        stamps = [message.header.stamp.sec + message.header.stamp.nanosec * 1e-9 for message in (before, now)]
        period = stamps[1] - stamps[0]
        change = now.twist.twist.linear.x - before.twist.twist.linear.x
        return _status(period > 0 and change / period < _BRAKE_LIMIT)


class CheckStopStatus(TreeNode):
    """Succeeds if the robot has stood still for `duration_stopped` milliseconds."""

    ports: ClassVar[Ports] = ("velocity_threshold", "duration_stopped")

    def prepare(self) -> None:
        self.stopped_ns: int | None = None
        self.tree.use_odometry()

    def tick(self) -> str:
        odometry, limit = self.tree.odometry[1], self.number("velocity_threshold", 0.01)
        twist = None if odometry is None else odometry.twist.twist
        speeds = (0.0,) if twist is None else (twist.linear.x, twist.linear.y, twist.angular.z)
        if not all(abs(speed) < limit for speed in speeds):
            self.stopped_ns = None
            return FAILURE
        if self.stopped_ns is None:
            self.stopped_ns = self.tree.time_ns
        if self.tree.time_ns - self.stopped_ns <= self.number("duration_stopped", 1000) * 1e6:
            return RUNNING
        self.stopped_ns = None
        return SUCCESS


class IsBatteryLow(TreeNode):
    """Succeeds if the percentage, or the voltage, of the battery is at most `min_battery`."""

    ports: ClassVar[Ports] = ("min_battery", "battery_topic", "is_voltage")

    def prepare(self) -> None:
        self.topic = self.inputs.get("battery_topic", "/battery_status")
        self.tree.open_topic(self.topic, "sensor_msgs/msg/BatteryState")

    def tick(self) -> str:
        message = self.tree.latest(self.topic)
        if message is None:
            return FAILURE
        value = message.voltage if self.boolean("is_voltage", False) else message.percentage
        return _status(value <= self.number("min_battery", 0.0))


class IsBatteryCharging(IsBatteryLow):
    """Succeeds if the battery is charging."""

    ports: ClassVar[Ports] = ("battery_topic",)

    def tick(self) -> str:
        message = self.tree.latest(self.topic)
        return _status(message is not None and message.power_supply_status == 1)  # POWER_SUPPLY_STATUS_CHARGING


class AreErrorCodesPresent(TreeNode):
    """Succeeds if `error_code` is one of `error_codes_to_check`."""

    ports: ClassVar[Ports] = (
        "error_code",
        "error_codes_to_check",
        "error_code_id",
        "current_error_code",
        "current_error_codes",
    )
    codes: ClassVar[tuple[int, ...]] = ()
    """Error codes of the node, in place of the port."""

    def tick(self) -> str:
        port = next(
            (name for name in self.ports if name in self.inputs and name != "error_codes_to_check"), "error_code"
        )
        codes: tuple[int, ...] = self.codes or tuple(_integers(self.text("error_codes_to_check")))
        return _status(self.integer(port, 0) in codes)


def _integers(text: str) -> list[int]:
    try:
        return [int(part) for part in text.replace(",", ";").split(";") if part.strip()]
    except ValueError:
        raise TreeError(f"error_codes_to_check: found {text!r:.80}; expected numbers such as 100;101") from None


class WouldAPlannerRecoveryHelp(AreErrorCodesPresent):
    """Succeeds for UNKNOWN, TIMEOUT and NO_VALID_PATH of a planner."""

    codes = (200, 207, 208, 300, 307, 308)


class WouldAControllerRecoveryHelp(AreErrorCodesPresent):
    """Succeeds for UNKNOWN, PATIENCE_EXCEEDED, FAILED_TO_MAKE_PROGRESS and NO_VALID_CONTROL of a controller."""

    codes = (100, 104, 105, 106)


class WouldASmootherRecoveryHelp(AreErrorCodesPresent):
    """Succeeds for UNKNOWN, TIMEOUT, SMOOTHED_PATH_IN_COLLISION and FAILED_TO_SMOOTH_PATH of a smoother."""

    codes = (500, 502, 503, 504)


class WouldARouteRecoveryHelp(AreErrorCodesPresent):
    """Succeeds for UNKNOWN, NO_VALID_ROUTE and TIMEOUT of a route server."""

    codes = (400, 404, 405)


class IsWithinPathTrackingBounds(TreeNode):
    """Succeeds if the tracking errors of the controller's feedback are within bounds, or if there are none."""

    ports: ClassVar[Ports] = ("max_error_left", "max_error_right", "max_error_heading", "tracking_feedback")

    def tick(self) -> str:
        feedback = self.input("tracking_feedback")
        if feedback is None:
            return SUCCESS
        error, heading = feedback.position_tracking_error, feedback.heading_tracking_error
        side = "max_error_left" if error >= 0 else "max_error_right"
        is_near = abs(error) <= abs(self.number(side, 0.5))
        return _status(
            is_near and abs(heading) <= abs(self.number("max_error_heading", 3.14)) and math.isfinite(heading)
        )


CONDITION_NODES: Final = {
    "AlwaysSuccess": AlwaysSuccess,
    "AlwaysFailure": AlwaysFailure,
    "Script": ScriptNode,
    "ScriptCondition": ScriptNode,
    "SetBlackboard": SetBlackboard,
    "UnsetBlackboard": UnsetBlackboard,
    "Sleep": Sleep,
    "WasEntryUpdated": WasEntryUpdated,
    "GoalUpdated": GoalUpdated,
    "GlobalUpdatedGoal": GlobalUpdatedGoal,
    "GoalReached": GoalReached,
    "ArePosesNear": ArePosesNear,
    "IsGoalNearby": IsGoalNearby,
    "PathExpiringTimer": PathExpiringTimer,
    "TimeExpired": TimeExpired,
    "DistanceTraveled": DistanceTraveled,
    "TransformAvailable": TransformAvailable,
    "InitialPoseReceived": InitialPoseReceived,
    "initialPoseReceived": InitialPoseReceived,
    "IsStuck": IsStuck,
    "CheckStopStatus": CheckStopStatus,
    "IsBatteryLow": IsBatteryLow,
    "IsBatteryCharging": IsBatteryCharging,
    "AreErrorCodesPresent": AreErrorCodesPresent,
    "WouldAPlannerRecoveryHelp": WouldAPlannerRecoveryHelp,
    "WouldAControllerRecoveryHelp": WouldAControllerRecoveryHelp,
    "WouldASmootherRecoveryHelp": WouldASmootherRecoveryHelp,
    "WouldARouteRecoveryHelp": WouldARouteRecoveryHelp,
    "IsWithinPathTrackingBounds": IsWithinPathTrackingBounds,
}
"""Classes by their name in a file."""
