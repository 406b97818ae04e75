"""Nodes that send goals to servers and cancel them (`nav2_behavior_tree/plugins/action`, `bt_action_node.hpp`)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Final

from simkit import msgs
from simkit.msgs.goal_status import GoalStatus
from simkit_navigation.behavior_trees.path_geometry import is_same
from simkit_navigation.behavior_trees.tree_node import FAILURE, RUNNING, SUCCESS, Ports, TreeNode

if TYPE_CHECKING:
    from simkit.extend import GoalHandle

_SERVER: Final = ("server_name", "server_timeout")
_ERRORS: Final = ("error_code_id", "error_msg")
_NO_PATH: Final = msgs.Path(msgs.Header(msgs.Time(0, 0), ""), [])


class ActionNode(TreeNode):
    """Node that sends a goal to an action, and runs until the goal has ended.

    Attributes:
        handle: goal of the server; None while there is none.
    """

    action: ClassVar[str] = ""
    """Name of the action, unless the port `server_name` has another one."""
    is_needed: ClassVar[bool] = False
    """True if the tree ends without the server; otherwise the node fails."""

    def prepare(self) -> None:
        self.handle: GoalHandle | None = None

    def request(self) -> dict[str, object]:
        """Return the goal."""
        raise NotImplementedError

    def on_start(self) -> None:
        """Do what comes before a goal."""

    def updated_request(self) -> dict[str, object] | None:
        """Return a goal that replaces the present one; None to continue."""
        return None

    def take_result(self, result: Any) -> None:
        """Write the values of a result to the ports."""

    def take_nothing(self) -> None:
        """Write the values of a goal without success to the ports."""

    def _send(self, request: dict[str, object]) -> bool:
        name = self.text("server_name") or self.action
        self.handle = self.tree.send_goal(name, request, is_needed=self.is_needed)
        return self.handle is not None

    def tick(self) -> str:
        if not self.is_active:
            self.set_status(RUNNING)
            self.on_start()
            if not self._send(self.request()):
                self.take_nothing()
                return FAILURE
            return RUNNING
        handle = self.handle
        if handle is None:
            return FAILURE
        is_running = not handle.is_done
        if is_running or handle.status is GoalStatus.SUCCEEDED:
            update = self.updated_request()  # also at the end: the goal may belong to an older path
            if update is not None:
                return RUNNING if self._send(update) else FAILURE
        return RUNNING if is_running else self._end(handle)

    def _end(self, handle: GoalHandle) -> str:
        """Return the status of a goal that has ended."""
        self.handle = None
        if handle.status is GoalStatus.SUCCEEDED:
            self.take_result(handle.result)
            self._set_error(0, "")
            return SUCCESS
        if handle.status is GoalStatus.CANCELED:
            self.take_nothing()
            self._set_error(0, "")
            return SUCCESS  # as in Nav2
        self.take_nothing()
        code = int(getattr(handle.result, "error_code", 0))
        text = getattr(handle.result, "error_msg", "") or handle.reason
        self._set_error(code, text)
        self.tree.note_failure(code, handle.reason or text or f"the goal of {handle.action.name!r} was not reached")
        return FAILURE

    def _set_error(self, code: int, text: str) -> None:
        self.output("error_code_id", code)
        self.output("error_msg", text)

    def clear(self) -> None:
        handle, self.handle = self.handle, None
        if handle is not None:
            self.take_nothing()
            if not handle.is_done:
                handle.cancel()


# ---------------------------------------------------------------------- planners


class ComputePathToPose(ActionNode):
    """Asks the planner for a path to `goal`."""

    ports: ClassVar[Ports] = (
        "goal",
        "start",
        "use_start",
        "planner_id",
        "path",
        "viapoints",
        "planning_time",
        *_SERVER,
        *_ERRORS,
    )
    action, is_needed = "compute_path_to_pose", True

    def prepare(self) -> None:
        super().prepare()
        self.goal_number = 0

    def request(self) -> dict[str, object]:
        self.goal_number = self.tree.goal_number
        fields: dict[str, object] = {"planner_id": self.text("planner_id")}
        if self.input("goal") is not None:
            fields["goal"] = self.input("goal")
        start = self.input("start")
        if start is not None and self.boolean("use_start", True):
            fields.update(start=start, use_start=True)
        return fields

    def take_result(self, result: Any) -> None:
        self.output("path", result.path)
        self.tree.planned_number = self.goal_number

    def take_nothing(self) -> None:
        self.output("path", _NO_PATH)


class ComputePathThroughPoses(ComputePathToPose):
    """Asks the planner for a path through `goals`."""

    ports: ClassVar[Ports] = ("goals", *ComputePathToPose.ports, "last_reached_index")
    action = "compute_path_through_poses"

    def request(self) -> dict[str, object]:
        fields = super().request()
        fields.pop("goal", None)
        return {**fields, "goals": list(self.input("goals") or ())}


class SmoothPath(ActionNode):
    """Asks the smoother for a smooth path."""

    ports: ClassVar[Ports] = (
        *("unsmoothed_path", "max_smoothing_duration", "check_for_collisions", "smoother_id", "smoothed_path"),
        *("smoothing_duration", "was_completed", *_SERVER, *_ERRORS),
    )
    action, is_needed = "smooth_path", True

    def request(self) -> dict[str, object]:
        return {
            "path": self.input("unsmoothed_path", _NO_PATH),
            "smoother_id": self.text("smoother_id"),
            "max_smoothing_duration": _duration(self.number("max_smoothing_duration", 3.0)),
            "check_for_collisions": self.boolean("check_for_collisions", False),
        }

    def take_result(self, result: Any) -> None:
        self.output("smoothed_path", result.path)
        duration = result.smoothing_duration
        self.output("smoothing_duration", duration.sec + duration.nanosec * 1e-9)
        self.output("was_completed", result.was_completed)


# ---------------------------------------------------------------------- controller


class FollowPath(ActionNode):
    """Sends `path` to the controller, and each new path while it drives."""

    ports: ClassVar[Ports] = (
        *("path", "controller_id", "goal_checker_id", "progress_checker_id", "path_handler_id", "tracking_feedback"),
        *("distance_to_goal", *_SERVER, *_ERRORS),
    )
    action, is_needed = "follow_path", True

    def prepare(self) -> None:
        super().prepare()
        self.sent: dict[str, object] = {}

    def request(self) -> dict[str, object]:
        names = ("controller_id", "goal_checker_id", "progress_checker_id")
        self.sent = {"path": self.input("path", _NO_PATH), **{name: self.text(name) for name in names}}
        return self.sent

    def updated_request(self) -> dict[str, object] | None:
        before = self.sent
        feedback = None if self.handle is None else self.handle.feedback
        if feedback is not None:
            self.output("distance_to_goal", feedback.distance_to_goal)
        request = self.request()
        if not getattr(request["path"], "poses", ()):
            request = self.sent = {**request, "path": before["path"]}
        is_new = any(not is_same(before[name], value) for name, value in request.items())
        return request if is_new else None


# ---------------------------------------------------------------------- behaviours


class _Behavior(ActionNode):
    """Node that counts as a recovery."""

    is_recovery: ClassVar[bool] = True

    def on_start(self) -> None:
        if self.boolean("is_recovery", self.is_recovery):
            self.tree.count_recovery()

    def _allowance(self, default: float = 10.0) -> msgs.Duration:
        return _duration(self.number("time_allowance", default))


class Spin(_Behavior):
    """Turns the robot."""

    ports: ClassVar[Ports] = (
        "spin_dist",
        "time_allowance",
        "is_recovery",
        "disable_collision_checks",
        *_SERVER,
        *_ERRORS,
    )
    action = "spin"

    def request(self) -> dict[str, object]:
        return {"target_yaw": self.number("spin_dist", 1.57), "time_allowance": self._allowance()}


class BackUp(_Behavior):
    """Drives backwards."""

    ports: ClassVar[Ports] = (
        "backup_dist",
        "backup_speed",
        "time_allowance",
        "disable_collision_checks",
        *_SERVER,
        *_ERRORS,
    )
    action = "backup"

    def request(self) -> dict[str, object]:
        return {
            "target": {"x": self.number("backup_dist", 0.15)},
            "speed": self.number("backup_speed", 0.025),
            "time_allowance": self._allowance(),
        }


class DriveOnHeading(_Behavior):
    """Drives straight on."""

    ports: ClassVar[Ports] = (
        "dist_to_travel",
        "speed",
        "time_allowance",
        "disable_collision_checks",
        *_SERVER,
        *_ERRORS,
    )
    action, is_recovery = "drive_on_heading", False

    def request(self) -> dict[str, object]:
        return {
            "target": {"x": self.number("dist_to_travel", 0.15)},
            "speed": self.number("speed", 0.025),
            "time_allowance": self._allowance(),
        }


class AssistedTeleop(_Behavior):
    """Lets a person drive, without collisions."""

    ports: ClassVar[Ports] = ("time_allowance", "is_recovery", *_SERVER, *_ERRORS)
    action, is_recovery = "assisted_teleop", False

    def request(self) -> dict[str, object]:
        return {"time_allowance": self._allowance()}


class Wait(_Behavior):
    """Waits."""

    ports: ClassVar[Ports] = ("wait_duration", "duration", *_SERVER, *_ERRORS)
    action = "wait"

    def request(self) -> dict[str, object]:
        return {"time": _duration(self.number("wait_duration" if "wait_duration" in self.inputs else "duration", 1.0))}


# ---------------------------------------------------------------------- navigators


class NavigateToPose(ActionNode):
    """Sends `goal` to a navigator, which must be another one than that of the tree."""

    ports: ClassVar[Ports] = ("goal", "behavior_tree", *_SERVER, *_ERRORS)
    action = "navigate_to_pose"

    def request(self) -> dict[str, object]:
        goal = self.input("goal")
        fields = {} if goal is None else {"pose": goal}
        return {**fields, "behavior_tree": self.text("behavior_tree")}


class NavigateThroughPoses(ActionNode):
    """Sends `goals` to a navigator, which must be another one than that of the tree."""

    ports: ClassVar[Ports] = ("goals", "behavior_tree", *_SERVER, *_ERRORS)
    action = "navigate_through_poses"

    def request(self) -> dict[str, object]:
        return {"poses": list(self.input("goals") or ()), "behavior_tree": self.text("behavior_tree")}


# ---------------------------------------------------------------------- cancel


class CancelNode(TreeNode):
    """Cancels the goals of a server, and succeeds."""

    ports: ClassVar[Ports] = _SERVER
    action: ClassVar[str] = ""

    def tick(self) -> str:
        return SUCCESS if self.tree.cancel_goals(self.text("server_name") or self.action) else FAILURE


class CancelControl(CancelNode):
    """Cancels the goals of the controller."""

    ports: ClassVar[Ports] = (*_SERVER, "service_name")
    action = "follow_path"


class CancelSpin(CancelNode):
    """Cancels a turn."""

    action = "spin"


class CancelBackUp(CancelNode):
    """Cancels a drive backwards."""

    action = "backup"


class CancelDriveOnHeading(CancelNode):
    """Cancels a drive straight on."""

    action = "drive_on_heading"


class CancelAssistedTeleop(CancelNode):
    """Cancels the drive of a person."""

    action = "assisted_teleop"


class CancelWait(CancelNode):
    """Cancels a wait."""

    action = "wait"


def _duration(seconds: float) -> msgs.Duration:
    return msgs.duration(round(min(max(seconds, 0.0), 1e9) * 1e9))


ACTION_NODES: Final = {
    node.__name__: node
    for node in (
        *(ComputePathToPose, ComputePathThroughPoses, SmoothPath, FollowPath, Spin, BackUp, DriveOnHeading),
        *(AssistedTeleop, Wait, NavigateToPose, NavigateThroughPoses, CancelControl, CancelSpin, CancelBackUp),
        *(CancelDriveOnHeading, CancelAssistedTeleop, CancelWait),
    )
}
"""Classes by their name in a file."""
