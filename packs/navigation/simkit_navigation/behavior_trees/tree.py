"""Behaviour tree that is executed by a navigator, and what its nodes need of the navigator."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from simkit import msgs
from simkit_navigation.behavior_trees.action_nodes import ActionNode
from simkit_navigation.behavior_trees.tree_node import IDLE, Blackboard, TreeError, TreeNode
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose, pose_of_message

if TYPE_CHECKING:
    from simkit.extend import GoalHandle
    from simkit.runtime.communication.service_server import ServiceCall


class Navigator(Protocol):
    """Plugin that executes trees."""

    @property
    def time_ns(self) -> int:
        """Time of the simulation [ns]."""

    def tree_option(self, name: str, default: object) -> Any:
        """Return an option of the navigator."""

    def look_up(self, target: str, source: str) -> PlanarPose | None:
        """Return the pose of the frame `source` in the frame `target`; None if it is not known."""

    def open_topic(self, topic: str, type_name: str) -> None:
        """Keep the two newest messages of a topic from now on."""

    def newest(self, topic: str) -> tuple[Any, Any]:
        """Return the message before the newest one, and the newest one; None for those that are missing."""

    def send_goal(self, action: str, request: Mapping[str, object]) -> GoalHandle:
        """Send a goal; raise TreeError if there is no such action."""

    def call_service(self, service: str, request: Mapping[str, object]) -> ServiceCall:
        """Call a service; raise TreeError if there is no such service."""

    def warn_once(self, cause: str, text: str) -> None:
        """Report a warning once for each cause."""


class StatusChange(NamedTuple):
    """Change of the status of a node."""

    time_ns: int
    name: str
    uid: int
    before: str
    after: str


class Tree:
    """Behaviour tree with its nodes and its blackboard.

    Args:
        navigator: plugin that executes the tree.
        file: file of the tree, for messages.

    Attributes:
        nodes: all nodes in the order of the file.
        board: blackboard of the main tree.
        ticks: number of ticks so far.
        changes: changes of the status of nodes since the last tick, if `is_logged`.
        goal_number: number of goals so far; a goal that replaces another one counts.
        planned_number: number of the goal for which there is a path; None if the tree has planned no path.
        failure: error code and text of the server that failed last.
    """

    root: TreeNode

    def __init__(self, navigator: Navigator, file: str) -> None:
        self.navigator, self.file = navigator, file
        self.nodes: list[TreeNode] = []
        self.board = Blackboard()
        self.ticks = 0
        self.is_logged = False
        self.changes: list[StatusChange] = []
        self.goal_number = 0
        self.planned_number: int | None = None
        self.failure: tuple[int, str] = (0, "")
        self.odometry_topic = ""

    # ------------------------------------------------------------------ execution

    def tick(self) -> str:
        """Tick the tree and return the status of its root."""
        self.ticks += 1
        return self.root.execute()

    def halt(self) -> None:
        """Stop all nodes."""
        self.root.halt()
        for node in self.nodes:
            if node.status != IDLE:
                node.halt()

    @property
    def is_path_outdated(self) -> bool:
        """True if there is no path yet to a goal that replaced another one."""
        return self.planned_number is not None and self.planned_number < self.goal_number

    def log_change(self, node: TreeNode, status: str) -> None:
        """Note the change of a node's status."""
        if self.is_logged:
            self.changes.append(StatusChange(self.time_ns, node.name, node.uid, node.status, status))

    # ------------------------------------------------------------------ for the nodes

    @property
    def time_ns(self) -> int:
        """Time of the simulation [ns]."""
        return self.navigator.time_ns

    def option(self, name: str, default: object) -> Any:
        """Return an option of the navigator."""
        return self.navigator.tree_option(name, default)

    @property
    def goal(self) -> msgs.PoseStamped | None:
        """Goal on the blackboard."""
        goal: msgs.PoseStamped | None = self.board.get(str(self.option("goal_blackboard_id", "goal")))
        return goal

    def look_up(self, target: str, source: str) -> PlanarPose | None:
        """Return the pose of the frame `source` in the frame `target`; None if it is not known."""
        return self.navigator.look_up(target, source)

    def pose_of(self, node: TreeNode, frame: str = "") -> PlanarPose | None:
        """Return the pose of the robot in a frame, or in that of the node's port `global_frame`."""
        target = frame or node.text("global_frame") or str(self.option("global_frame", "map"))
        base = node.text("robot_base_frame") or node.text("robot_frame")
        return self.look_up(target, base or str(self.option("robot_base_frame", "base_link")))

    def in_frame(self, stamped: msgs.PoseStamped, frame: str) -> PlanarPose | None:
        """Return a pose in a frame; None if it is not known."""
        pose = pose_of_message(stamped.pose)
        if stamped.header.frame_id == frame or pose is None:
            return pose
        placed = self.look_up(frame, stamped.header.frame_id)
        return None if placed is None else placed.compose(pose)

    def open_topic(self, topic: str, type_name: str) -> None:
        """Keep the newest messages of a topic from now on."""
        self.navigator.open_topic(topic, type_name)

    def latest(self, topic: str) -> Any:
        """Return the newest message of a topic; None before the first one."""
        return self.navigator.newest(topic)[1]

    def use_odometry(self) -> None:
        """Keep the newest odometry from now on."""
        self.odometry_topic = str(self.option("odom_topic", "odom"))
        self.open_topic(self.odometry_topic, "nav_msgs/msg/Odometry")

    @property
    def odometry(self) -> tuple[Any, Any]:
        """The two newest messages of the odometry; None for those that are missing."""
        return self.navigator.newest(self.odometry_topic)

    @property
    def speed(self) -> float:
        """Speed of the newest odometry [m/s]."""
        message = self.odometry[1]
        return 0.0 if message is None else math.hypot(message.twist.twist.linear.x, message.twist.twist.linear.y)

    def send_goal(self, action: str, request: Mapping[str, object], *, is_needed: bool) -> GoalHandle | None:
        """Send a goal; return None, after a warning, if there is no such action.

        Raises:
            TreeError: the action is needed, and there is none.
        """
        try:
            return self.navigator.send_goal(action, request)
        except TreeError as error:
            if is_needed:
                raise
            self.navigator.warn_once(action, f"{error}; its node in the tree fails")
            return None

    def call_service(self, service: str, request: Mapping[str, object]) -> ServiceCall | None:
        """Call a service; return None, after a warning, if there is no such service."""
        try:
            return self.navigator.call_service(service, request)
        except TreeError as error:
            self.navigator.warn_once(service, f"{error}; its node in the tree fails")
            return None

    def cancel_goals(self, action: str) -> bool:
        """Cancel the goals that nodes have sent to an action."""
        suffix = "/" + action.lstrip("/")
        for node in self.nodes:
            handle = node.handle if isinstance(node, ActionNode) else None
            if handle is not None and not handle.is_done and handle.action.name.endswith(suffix):
                handle.cancel()
        return True

    def count_recovery(self) -> None:
        """Count a recovery."""
        self.board.set("number_recoveries", self.recoveries + 1)

    @property
    def recoveries(self) -> int:
        """Number of recoveries since the goal began."""
        return int(self.board.get("number_recoveries", 0))

    def note_failure(self, code: int, text: str) -> None:
        """Note why a server failed."""
        self.failure = (code, text)
