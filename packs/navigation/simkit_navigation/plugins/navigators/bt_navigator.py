"""Plugin that navigates to goals by behaviour trees, as Nav2's `nav2_bt_navigator`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from simkit import Params, msgs
from simkit.errors import InputError, TransformError
from simkit.extend import (
    NEVER,
    Diagnostics,
    Options,
    OptionsOf,
    SharedByCopies,
    counted,
    did_you_mean,
    integer,
    number,
    offers,
    publishes,
    text,
    texts,
    without_effect,
)
from simkit.plugins.find_entities import find_plugin_file
from simkit.trusted_folders import TrustedFolders
from simkit_navigation.behavior_trees import default_trees
from simkit_navigation.behavior_trees.path_geometry import nearest_index, path_length
from simkit_navigation.behavior_trees.tree_node import RUNNING, SUCCESS, Tree, TreeError
from simkit_navigation.behavior_trees.tree_reader import build_tree, read_tree_file
from simkit_navigation.plugins.lifecycle_state import GET_STATE, answer_active
from simkit_navigation.plugins.navigation.node_parameters import NodeParameters
from simkit_navigation.plugins.navigation.node_values import NodeValues, Values
from simkit_navigation.plugins.navigation.planar_pose import (
    PlanarPose,
    look_up,
    planar_of,
    pose_of_message,
    stamped_pose,
)
from simkit_navigation.plugins.navigators.navigator_parameters import navigator_parameters

if TYPE_CHECKING:
    from simkit import Model, Simulation
    from simkit.extend import GoalHandle
    from simkit_navigation.behavior_trees.navigator import PendingCall

_POSE: Final = "geometry_msgs/msg/PoseStamped"
_LOG: Final = "nav2_msgs/msg/BehaviorTreeLog"
_SECOND: Final = 1_000_000_000
_FEEDBACK_NS: Final = 100_000_000
_LOWEST_SPEED: Final = 0.01  # [m/s] of Nav2's navigate_to_pose.cpp, for the remaining time
TO_POSE: Final = "navigate_to_pose"
THROUGH_POSES: Final = "navigate_through_poses"


class BtNavigatorOptions(Options):
    """Options of `BtNavigator`."""

    global_frame: str = text("map")
    robot_base_frame: str = text("base_footprint")
    odom_topic: str = text("odom")
    bt_loop_duration: float = number(10.0, "ms", minimum=1, maximum=1000)
    default_nav_to_pose_bt_xml: str = text()
    default_nav_through_poses_bt_xml: str = text()
    default_bt_xml_filename: str = text()
    goal_blackboard_id: str = text("goal")
    goals_blackboard_id: str = text("goals")
    path_blackboard_id: str = text("path")
    goal_reached_tol: float = number(0.25, "m", minimum=0)
    goal_updater_topic: str = text("goal_update")
    error_code_names: tuple[str, ...] = texts()
    error_code_name_prefixes: tuple[str, ...] = texts()
    planning_rate: float = number(1.0, "Hz", minimum=0.001)
    number_of_retries: int = integer(6, minimum=0)
    spin_dist: float = number(1.57, "rad")
    wait_duration: float = number(5.0, "s", minimum=0)
    backup_dist: float = number(0.3, "m", minimum=0)
    backup_speed: float = number(0.15, "m/s", minimum=0.001)
    global_costmap: str = text("global_costmap")
    local_costmap: str = text("local_costmap")
    planner_id: str = text()
    controller_id: str = text()
    transform_tolerance: bool = without_effect()
    filter_duration: bool = without_effect()
    default_server_timeout: bool = without_effect()
    default_cancel_timeout: bool = without_effect()
    wait_for_service_timeout: bool = without_effect()
    action_server_result_timeout: bool = without_effect()
    always_reload_bt_xml: bool = without_effect()


class _OpenTopics(SharedByCopies):
    """Topics that trees have opened; a restore does not close them."""

    def __init__(self) -> None:
        self.names: set[str] = set()


@dataclass(eq=False)
class _Task:
    """Navigation to one or several poses.

    Attributes:
        goal: goal of the action.
        kind: name of the action.
        file: file of the tree.
        tree: tree that is executed.
        begin_ns: time of the start [ns].
        next_feedback_ns: time of the next feedback [ns].
    """

    goal: GoalHandle
    kind: str
    file: Path
    tree: Tree
    begin_ns: int
    next_feedback_ns: int = 0


class BtNavigator(NodeParameters):
    """Navigates to poses: actions `navigate_to_pose` and `navigate_through_poses`, topic `goal_pose`.

    A behaviour tree in the XML of Nav2 and BehaviorTree.CPP says what the robot does. Without a file, it is that of
    Jazzy: a new path at `<planning_rate>`; after a failure, the costmap is cleared and the step is tried once more;
    then come recoveries in turn: clear both costmaps, spin, wait, back up; after `<number_of_retries>` recoveries
    without success, the goal is aborted.
    """

    filenames = ("libsimkit_bt_navigator.so",)
    names = ("simkit::BtNavigator", "nav2_bt_navigator::BtNavigator")
    parent_kind = ("world", "model")
    options = OptionsOf(BtNavigatorOptions)
    endpoints = (offers("~/get_state", GET_STATE), publishes("behavior_tree_log", _LOG))
    before_step_rate = NEVER

    @classmethod
    def translate_parameters(cls, values: Values, _: Values, /) -> NodeValues:
        return navigator_parameters(values)

    def load(self, parent: Simulation | Model, params: Params) -> None:
        options = self.options.read_all()
        self.sim.tf.open()  # so that the first look-up knows the transforms before it
        self._task: _Task | None = None
        self._topics = _OpenTopics()
        self._messages: dict[str, tuple[Any, Any]] = {}
        self._trees: dict[Path, Tree] = {}
        self._log_publisher = self.advertise("behavior_tree_log", _LOG)
        to_pose = options.default_nav_to_pose_bt_xml or options.default_bt_xml_filename
        self._defaults = {TO_POSE: to_pose, THROUGH_POSES: options.default_nav_through_poses_bt_xml}
        for kind in self._defaults:
            self._load_tree(kind, "", params.diagnostics)
        self.act(TO_POSE, "nav2_msgs/action/NavigateToPose", partial(self._on_goal, TO_POSE), self._on_cancel)
        through = partial(self._on_goal, THROUGH_POSES)
        self.act(THROUGH_POSES, "nav2_msgs/action/NavigateThroughPoses", through, self._on_cancel)
        self.listen("goal_pose", _POSE, self._on_goal_pose)
        self.open_topic(options.odom_topic, "nav_msgs/msg/Odometry")
        answer_active(self)

    # ------------------------------------------------------------------ trees

    def _tree_file(self, kind: str, wanted: str) -> Path | None:
        """Return the file of a tree; the default one of an action without a name."""
        name = wanted or self._defaults[kind]
        if not name:
            name = default_trees.TO_POSE if kind == TO_POSE else default_trees.THROUGH_POSES
        world = self.where.file
        folders = (Path(world).parent,) if world else ()
        path = default_trees.find_tree_file(name, folders)
        if path is None or (world and not TrustedFolders([default_trees.FOLDER, Path(), *folders]).allows(path)):
            # a world file is not trusted: it may name the files that it may use for models and maps, too
            path = find_plugin_file(self, name, self.sim.engine.structure.builder)
        return path

    def _load_tree(self, kind: str, wanted: str, diagnostics: Diagnostics) -> tuple[Path, Tree] | None:
        """Return a tree, which stays loaded; None after an error, which is reported."""
        file = self._tree_file(kind, wanted)
        if file is None:
            name = wanted or self._defaults[kind]
            names = default_trees.default_tree_names()
            help_ = did_you_mean(Path(name).name, names) or f"the default trees are {', '.join(names)}"
            place = " in the working folder or the folders of the world" if self.where.file else ""
            diagnostics.error("SK-BT-008", f"there is no behaviour tree {name!r}{place}", self.where, help_)
            return None
        if file not in self._trees:
            tree_file = read_tree_file(file, diagnostics)
            if tree_file is None or diagnostics.has_errors:
                return None
            overrides = {} if wanted or self._defaults[kind] else self._overrides()
            tree = build_tree(tree_file, self, diagnostics, overrides)
            if tree is None:
                return None
            self._trees[file] = tree
        return file, self._trees[file]

    def _overrides(self) -> dict[tuple[str, str], str]:
        """Return the options of the default tree as texts of ports."""
        options, services = self.options, {}
        for side, costmap in (("Global", options.global_costmap), ("Local", options.local_costmap)):
            service = f"{costmap}/clear_entirely_{costmap.rpartition('/')[2]}"
            for place in ("Context", "Subtree"):
                services[f"Clear{side}Costmap-{place}", "service_name"] = service
        return {
            **services,
            ("RateController", "hz"): str(options.planning_rate),
            ("NavigateRecovery", "number_of_retries"): str(options.number_of_retries),
            ("Spin", "spin_dist"): str(options.spin_dist),
            ("Wait", "wait_duration"): str(options.wait_duration),
            ("BackUp", "backup_dist"): str(options.backup_dist),
            ("BackUp", "backup_speed"): str(options.backup_speed),
            ("BackUp", "time_allowance"): str(options.backup_dist / options.backup_speed + 5.0),
            ("PlannerSelector", "default_planner"): options.planner_id,
            ("ControllerSelector", "default_controller"): options.controller_id,
        }

    # ------------------------------------------------------------------ what the nodes of a tree need

    @property
    def time_ns(self) -> int:
        """Time of the simulation [ns]."""
        return self.sim.time_ns

    def tree_option(self, name: str, default: object) -> Any:
        """Return an option of the navigator."""
        return getattr(self.options, name, default)

    def look_up(self, target: str, source: str) -> PlanarPose | None:
        """Return the pose of the frame `source` in the frame `target`; None if it is not known."""
        return look_up(self.sim, target, source)

    def open_topic(self, topic: str, type_name: str) -> None:
        """Keep the two newest messages of a topic from now on."""
        if topic not in self._topics.names:
            self._topics.names.add(topic)
            self.subscribe(topic, partial(self._on_message, topic, type_name))

    def _on_message(self, topic: str, type_name: str, message: msgs.Message) -> None:
        if self._once.has_type(message, type_name, topic):
            self._messages[topic] = (self._messages.get(topic, (None, None))[1], message)

    def newest(self, topic: str) -> tuple[Any, Any]:
        """Return the message before the newest one, and the newest one; None for those that are missing."""
        return self._messages.get(topic, (None, None))

    def send_goal(self, action: str, request: Mapping[str, object]) -> GoalHandle:
        """Send a goal; raise TreeError if there is no such action."""
        try:
            return self.sim.send_goal(self.ros.topic(action), request)
        except InputError as error:
            raise TreeError(str(error).partition("\n")[0]) from None

    def call_service(self, service: str, request: Mapping[str, object]) -> PendingCall:
        """Call a service; raise TreeError if there is no such service."""
        try:
            return self.sim.communication.services.request(self.ros.topic(service), request)
        except InputError as error:
            raise TreeError(str(error).partition("\n")[0]) from None

    def warn_once(self, cause: str, text: str) -> None:
        """Report a warning once for each cause."""
        self._once.warn("SK-BT-009", cause, text)

    # ------------------------------------------------------------------ goals

    def _on_goal_pose(self, message: msgs.PoseStamped) -> None:
        self.sim.send_goal(self.ros.topic(TO_POSE), {"pose": message})

    def _on_goal(self, kind: str, goal: GoalHandle) -> None:
        request = goal.request
        try:
            targets = [self._in_map(pose) for pose in (request.poses if kind == THROUGH_POSES else [request.pose])]
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
        problems = Diagnostics()
        loaded = self._load_tree(kind, request.behavior_tree, problems)
        if loaded is None:
            for item in problems:
                self.log.error("%s", item)
            self._reject(goal, next((item.message for item in problems if item.severity == "error"), "no tree"))
            return
        file, tree = loaded
        before = self._task
        if before is not None and before.kind != kind:
            self._reject(goal, f"a goal of {before.kind} is active; cancel it first")
            return
        if before is not None and before.file != file:
            self._reject(goal, f"the active goal has another behaviour tree ({before.file.name}); cancel it first")
            return
        self._task = _Task(goal, kind, file, tree, self.sim.time_ns)
        tree.goal_number += 1
        tree.failure = (0, "")
        tree.board.set("number_recoveries", 0)
        if kind == TO_POSE:
            tree.board.set(self.options.goal_blackboard_id, targets[0])
        else:
            tree.board.set(self.options.goals_blackboard_id, targets)
        if before is None:
            tree.planned_number = None
        else:
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
        task = self._task
        if task is not None and goal is task.goal:
            self._leave(task)
        goal.canceled()

    def _pose(self) -> PlanarPose | None:
        return self.look_up(self.options.global_frame, self.options.robot_base_frame)

    # ------------------------------------------------------------------ execution

    def before_step(self) -> None:
        task = self._task
        if task is None:
            return
        if self._pose() is None:
            self._abort(task, "the pose of the robot is not known any more")
            return
        tree = task.tree
        tree.is_logged = self._log_publisher.wanted
        try:
            status = tree.tick()
        except TreeError as error:
            self._abort(task, str(error))
            return
        if status == SUCCESS and tree.is_path_outdated:
            tree.halt()  # the end of the path to the goal before this one is not the end of this goal
            status = RUNNING
        self._publish_log(tree)
        if status != RUNNING or self.sim.time_ns >= task.next_feedback_ns:
            self._publish_feedback(task)
        if self._task is not task or status == RUNNING:
            return
        if status == SUCCESS:
            self._leave(task)
            task.goal.succeed()
        else:
            self._fail(task)

    def _fail(self, task: _Task) -> None:
        """End a task whose tree has failed."""
        code, reason = task.tree.failure
        count = task.tree.recoveries
        if count:
            tried = "1 recovery" if count == 1 else counted(count, "recovery", "recoveries")
            reason = f"{reason or 'the behaviour tree has failed'}; {tried} did not help"
        self._abort(task, reason or "the behaviour tree has failed", self._error_code(task.tree) or code)

    def _error_code(self, tree: Tree) -> int:
        """Return the smallest error code on the blackboard, as Nav2's `populateErrorCode`."""
        names = [name for given in self.options.error_code_names for name in given.replace(",", " ").split()]
        for given in self.options.error_code_name_prefixes:
            names += [f"{prefix}_error_code" for prefix in given.replace(",", " ").split()]
        names = names or ["follow_path_error_code", "compute_path_error_code"]
        codes = [int(tree.board.get(name, 0) or 0) for name in names]
        return min((code for code in codes if code), default=0)

    def _leave(self, task: _Task) -> None:
        """End the present task."""
        task.tree.halt()
        self._publish_log(task.tree)
        self._task = None
        self._set_before_step_rate(NEVER)

    def _abort(self, task: _Task, reason: str, code: int = 0) -> None:
        """End a task as aborted, with the error code of the server that failed, as in Nav2."""
        if self._task is task:
            self._leave(task)
            self.log.error("Goal failed: %s", reason)
            task.goal.abort({"error_code": code, "error_msg": reason}, reason)

    # ------------------------------------------------------------------ feedback and log

    def _publish_feedback(self, task: _Task) -> None:
        pose = self._pose()
        assert pose is not None
        task.next_feedback_ns = self.sim.time_ns + _FEEDBACK_NS
        remaining, speed = self._remaining(task.tree, pose), self._speed()
        left = remaining / speed if speed > _LOWEST_SPEED else 0.0
        feedback: dict[str, object] = {
            "current_pose": stamped_pose(pose, msgs.header(self.sim.time_ns, self.options.global_frame)),
            "navigation_time": msgs.duration(self.sim.time_ns - task.begin_ns),
            "estimated_time_remaining": msgs.duration(round(left * _SECOND)),
            "number_of_recoveries": task.tree.recoveries,
            "distance_remaining": remaining,
        }
        if task.kind == THROUGH_POSES:
            goals = task.tree.board.get(self.options.goals_blackboard_id, ())
            feedback["number_of_poses_remaining"] = len(goals)
        task.goal.publish_feedback(feedback)

    def _speed(self) -> float:
        """Return the speed of the newest odometry [m/s]."""
        odometry = self.newest(self.options.odom_topic)[1]
        return 0.0 if odometry is None else math.hypot(odometry.twist.twist.linear.x, odometry.twist.twist.linear.y)

    def _remaining(self, tree: Tree, pose: PlanarPose) -> float:
        """Return the length of the path from the point that is nearest to a pose [m]."""
        path = tree.board.get(self.options.path_blackboard_id)
        poses = () if path is None or tree.planned_number is None else path.poses
        if not poses:
            return 0.0
        nearest = nearest_index(poses, pose.x, pose.y)
        at = poses[nearest].pose.position
        return path_length(poses, nearest) + math.hypot(at.x - pose.x, at.y - pose.y)

    def _publish_log(self, tree: Tree) -> None:
        """Publish the changes of the nodes' statuses since the last time."""
        changes, tree.changes = tree.changes, []
        if not changes:
            return
        events = [
            {
                "timestamp": _stamp(change.time_ns),
                "node_name": change.name,
                "uid": change.uid,
                "previous_status": change.before,
                "current_status": change.after,
            }
            for change in changes
        ]
        self._log_publisher.publish(msgs.make(_LOG, timestamp=_stamp(self.sim.time_ns), event_log=events))


def _stamp(time_ns: int) -> msgs.Time:
    """Return a time as a message."""
    return msgs.header(time_ns, "").stamp
