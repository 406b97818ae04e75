"""Plugin that drives to waypoints in turn, as Nav2's `nav2_waypoint_follower`."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

from simkit import Params, msgs
from simkit.errors import InputError
from simkit.extend import NEVER, Options, OptionsOf, boolean, number, offers, text, without_effect
from simkit.msgs.goal_status import GoalStatus
from simkit_navigation.plugins.lifecycle_state import GET_STATE, answer_active
from simkit_navigation.plugins.navigation.node_parameters import NodeParameters
from simkit_navigation.plugins.navigation.node_values import NodeValues, Values

if TYPE_CHECKING:
    from simkit import Model, Simulation
    from simkit.extend import GoalHandle
    from simkit_navigation.behavior_trees.navigator import PendingCall

_WAIT, _INPUT, _PHOTO = "WaitAtWaypoint", "InputAtWaypoint", "PhotoAtWaypoint"
_TASK_FAILED: Final = 601  # TASK_EXECUTOR_FAILED
_UNKNOWN: Final = 600
_SECOND: Final = 1_000_000_000


class WaypointFollowerOptions(Options):
    """Options of `WaypointFollower`."""

    stop_on_failure: bool = boolean(True)
    loop_rate: float = number(20.0, "Hz", minimum=0.1, maximum=1000)
    waypoint_task_executor_plugin: str = text("wait_at_waypoint")
    global_frame_id: str = text("map")
    action_server_result_timeout: bool = without_effect()


@dataclass(eq=False)
class _Walk:
    """Waypoints of a goal.

    Attributes:
        goal: goal of the action.
        poses: waypoints in the frame of the map.
        index: index of the present waypoint.
        loop: number of loops that are done.
        calls: conversions of positions of GPS that are not done.
        missed: missed waypoints.
        drive: goal of the navigator.
        task_end_ns: end of the task at a waypoint [ns]; None while there is none.
    """

    goal: GoalHandle
    poses: list[msgs.PoseStamped]
    index: int
    loop: int = 0
    calls: list[PendingCall] = field(default_factory=list)
    missed: list[dict[str, object]] = field(default_factory=list)
    drive: GoalHandle | None = None
    task_end_ns: int | None = None


class WaypointFollower(NodeParameters):
    """Navigates to poses in turn: actions `follow_waypoints` and `follow_gps_waypoints`.

    At each waypoint, the robot waits, or waits for a message on a topic, as `<waypoint_task_executor_plugin>` says.
    Positions of GPS need the service `fromLL` of `navsat_transform_node`.
    """

    filenames = ("libsimkit_waypoint_follower.so",)
    names = ("simkit::WaypointFollower", "nav2_waypoint_follower::WaypointFollower")
    parent_kind = ("world", "model")
    options = OptionsOf(WaypointFollowerOptions)
    endpoints = (offers("~/get_state", GET_STATE),)
    before_step_rate = NEVER

    @classmethod
    def translate_parameters(cls, values: Values, _: Values, /) -> NodeValues:
        return NodeValues(dict(values), [str(values.get("waypoint_task_executor_plugin", "wait_at_waypoint"))])

    def load(self, parent: Simulation | Model, params: Params) -> None:
        options = self.options.read_all()
        self._walk: _Walk | None = None
        self._has_input = False
        self._read_task(params.block(options.waypoint_task_executor_plugin))
        self.act("follow_waypoints", "nav2_msgs/action/FollowWaypoints", self._on_poses, self._on_cancel)
        gps = "nav2_msgs/action/FollowGPSWaypoints"
        self.act("follow_gps_waypoints", gps, self._on_gps_poses, self._on_cancel)
        answer_active(self)

    def _read_task(self, block: Params) -> None:
        """Read the parameters of the task at each waypoint."""
        kind = block.text("plugin", f"nav2_waypoint_follower::{_WAIT}")
        self._task = kind.replace("/", "::").rpartition("::")[2]
        self._is_enabled = block.boolean("enabled", True)
        self._pause_ns = round(block.number("waypoint_pause_duration", 0.0, minimum=0) * 1e6)
        self._timeout_ns = round(block.number("timeout", 10.0, minimum=0) * _SECOND)
        topic = block.text("input_topic", "input_at_waypoint/input")
        if self._task == _INPUT:
            self.listen(topic, "std_msgs/msg/Empty", self._on_input)
        elif self._task == _PHOTO:
            text = f"no pictures are taken at waypoints ({kind}); the robot drives on"
            self.params.warning("SK-NAV-001", f"plugin {self.name!r}: {text}")
        elif self._task != _WAIT:
            text = f"plugin {self.name!r}: found the task {kind!r}; expected one of {_WAIT}, {_INPUT}, {_PHOTO}"
            self.params.error("SK-PARAM-002", text)

    def _on_input(self, _: msgs.Message) -> None:
        self._has_input = True

    # ------------------------------------------------------------------ goals

    def _on_poses(self, goal: GoalHandle) -> None:
        self._begin(goal, list(goal.request.poses), [])

    def _on_gps_poses(self, goal: GoalHandle) -> None:
        calls: list[PendingCall] = []
        try:
            for pose in goal.request.gps_poses:
                position = pose.position
                point = {name: getattr(position, name) for name in ("latitude", "longitude", "altitude")}
                service = self.ros.topic("/fromLL")
                calls.append(self.sim.communication.services.request(service, {"ll_point": point}))
        except InputError as error:
            problem = str(error).partition("\n")[0]
            self.log.error("Goal rejected: %s", problem)
            goal.reject(f"{problem}; navsat_transform_node has it")
            return
        self._begin(goal, [], calls)

    def _begin(self, goal: GoalHandle, poses: list[msgs.PoseStamped], calls: list[PendingCall]) -> None:
        count = max(len(poses), len(calls))
        self.log.info("Received follow waypoint request with %d waypoints.", count)
        if not count or goal.request.goal_index >= count:
            reason = "the goal has no waypoint" if not count else "goal_index is not the index of a waypoint"
            goal.abort({"error_code": _UNKNOWN, "error_msg": reason}, reason)
            return
        before, self._walk = self._walk, _Walk(goal, poses, goal.request.goal_index, calls=calls)
        if before is not None:
            self._cancel(before)
            before.goal.abort(reason="another goal replaced this one")
        self._set_before_step_rate(self.options.loop_rate)

    def _on_cancel(self, goal: GoalHandle) -> None:
        walk = self._walk
        if walk is not None and goal is walk.goal:
            self._cancel(walk)
            self._leave()
        goal.canceled()

    def _cancel(self, walk: _Walk) -> None:
        if walk.drive is not None and not walk.drive.is_done:
            walk.drive.cancel()

    def _leave(self) -> None:
        self._walk = None
        self._set_before_step_rate(NEVER)

    # ------------------------------------------------------------------ the walk

    def before_step(self) -> None:
        walk = self._walk
        if walk is None or (walk.calls and not self._has_converted(walk)):
            return
        if walk.task_end_ns is not None:
            self._go_on_with_task(walk)
        elif walk.drive is None:
            self._drive(walk)
        elif walk.drive.is_done:
            self._take_end(walk, walk.drive)
        if self._walk is walk:
            walk.goal.publish_feedback({"current_waypoint": walk.index})

    def _has_converted(self, walk: _Walk) -> bool:
        """Check whether the positions of GPS are poses in the map now."""
        if not all(call.is_done for call in walk.calls):
            return False
        header = msgs.header(self.sim.time_ns, self.options.global_frame_id)
        for call, source in zip(walk.calls, walk.goal.request.gps_poses, strict=True):
            if call.error is not None:
                reason = f"a position of GPS is not known in the map: {call.error}"
                self._end(walk, walk.goal.abort, _UNKNOWN, reason)
                return False
            walk.poses.append(msgs.PoseStamped(header, msgs.Pose(call.response.map_point, source.orientation)))
        walk.calls = []
        return True

    def _drive(self, walk: _Walk) -> None:
        """Send the present waypoint to the navigator."""
        pose = walk.poses[walk.index]
        stamped = msgs.PoseStamped(msgs.header(self.sim.time_ns, pose.header.frame_id), pose.pose)
        try:
            walk.drive = self.sim.send_goal(self.ros.topic("navigate_to_pose"), {"pose": stamped})
        except InputError as error:
            self._end(walk, walk.goal.abort, _UNKNOWN, str(error).partition("\n")[0])

    def _take_end(self, walk: _Walk, drive: GoalHandle) -> None:
        """React to the end of a drive."""
        walk.drive = None
        if drive.status is GoalStatus.SUCCEEDED:
            self.log.info("Succeeded processing waypoint %d, processing waypoint task execution", walk.index)
            self._has_input = False
            wait = {_WAIT: self._pause_ns, _INPUT: self._timeout_ns}.get(self._task, 0) if self._is_enabled else 0
            walk.task_end_ns = self.sim.time_ns + wait
            self._go_on_with_task(walk)
        else:
            code = getattr(drive.result, "error_code", 0)
            self._miss(walk, code, drive.reason or "the waypoint was not reached")

    def _go_on_with_task(self, walk: _Walk) -> None:
        """Continue the task at a waypoint."""
        assert walk.task_end_ns is not None
        waits_for_input = self._task == _INPUT and self._is_enabled
        if waits_for_input and self._has_input:
            self._next(walk)
        elif self.sim.time_ns >= walk.task_end_ns:
            if waits_for_input:
                self._miss(walk, _TASK_FAILED, "no input came at the waypoint")
            else:
                self._next(walk)

    def _miss(self, walk: _Walk, code: int, reason: str) -> None:
        """Note that the present waypoint was missed."""
        walk.missed.append({"index": walk.index, "goal": walk.poses[walk.index], "error_code": code})
        if self.options.stop_on_failure:
            end = "in waypoint list and stop on failure is enabled. Terminating action."
            self.log.warning("Failed to process waypoint %d %s", walk.index, end)
            self._end(walk, walk.goal.abort, code, reason)
            return
        self.log.info("Failed to process waypoint %d, moving to next.", walk.index)
        self._next(walk)

    def _next(self, walk: _Walk) -> None:
        """Begin the next waypoint, or the next loop, or end the goal."""
        walk.task_end_ns = None
        walk.index += 1
        if walk.index < len(walk.poses):
            return
        if walk.loop >= walk.goal.request.number_of_loops:
            self.log.info("Completed all %d waypoints requested.", len(walk.poses))
            self._end(walk, walk.goal.succeed)
            return
        walk.loop += 1
        walk.index = 0

    def _end(self, walk: _Walk, end: Any, code: int = 0, reason: str = "") -> None:
        self._leave()
        result: dict[str, object] = {"missed_waypoints": walk.missed}
        if code or reason:
            result.update(error_code=code, error_msg=reason)
        end(result, reason)
