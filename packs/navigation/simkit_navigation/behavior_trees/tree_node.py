"""Behaviour tree and its nodes with their status and their ports.

The rules of `execute`, `halt` and of the status are those of BehaviorTree.CPP 4 (`src/tree_node.cpp`,
`src/control_node.cpp`, `src/decorator_node.cpp`). The state of a tree consists of plain attributes, so that a snapshot
of the plugin contains it.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Final, NamedTuple

from simkit import msgs
from simkit_navigation.behavior_trees.blackboard import Blackboard
from simkit_navigation.behavior_trees.navigator import Navigator, PendingCall
from simkit_navigation.behavior_trees.scripts import Script, ScriptError
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose, pose_of_message

if TYPE_CHECKING:
    from simkit.extend import GoalHandle

IDLE: Final = "IDLE"
RUNNING: Final = "RUNNING"
SUCCESS: Final = "SUCCESS"
FAILURE: Final = "FAILURE"
SKIPPED: Final = "SKIPPED"
COMPLETED: Final = (SUCCESS, FAILURE)
"""Statuses of a node that has ended."""


Ports = Sequence[str]
"""Names of ports."""


class TreeError(Exception):
    """Error of a node that ends the tree, such as a port without a value."""


class StatusChange(NamedTuple):
    """Change of the status of a node."""

    time_ns: int
    name: str
    uid: int
    before: str
    after: str


class TreeNode:
    """Node of a behaviour tree.

    Args:
        tree: tree with the node.
        tag: name of the node's class in the file, such as `Spin`.
        name: name of the node in the file.
        uid: 1, 2, … in the order of the file.
        inputs: texts of the ports.
        board: blackboard.
    """

    ports: ClassVar[Ports] = ()
    """Names of the ports."""
    child_counts: ClassVar[tuple[int, int | None]] = (0, 0)
    """Smallest and largest number of children; None for no limit."""

    def __init__(self, tree: Tree, tag: str, name: str, uid: int, inputs: Mapping[str, str], board: Blackboard) -> None:
        self.tree, self.tag, self.name, self.uid = tree, tag, name, uid
        self.inputs, self.board = dict(inputs), board
        self.status = IDLE
        self.children: list[TreeNode] = []
        self.scripts: dict[str, Script] = {}
        self.prepare()

    # ------------------------------------------------------------------ for the classes of nodes

    def prepare(self) -> None:
        """Set the attributes of a new node, and open the topics that the node needs."""

    def tick(self) -> str:
        """Do the work of the node and return the status."""
        raise NotImplementedError

    def clear(self) -> None:
        """Forget what a halted node was doing."""

    # ------------------------------------------------------------------ execution

    @property
    def is_active(self) -> bool:
        """True from the first tick until the parent resets the node."""
        return self.status != IDLE

    def execute(self) -> str:
        """Tick the node, with the conditions of its attributes such as `_skipIf`."""
        if not self.scripts:
            status = self.tick()
        else:
            status = self._status_before() or self.tick()
            if status in COMPLETED:
                self._run_script("_onSuccess" if status == SUCCESS else "_onFailure")
                self._run_script("_post")
        if status != SKIPPED:
            self.set_status(status)
        return status

    def set_status(self, status: str) -> None:
        """Set the status; a change is an event of the tree's log."""
        if status != self.status:
            self.tree.log_change(self, status)
            self.status = status

    def halt(self) -> None:
        """Stop the node and its children."""
        was_running = self.status == RUNNING
        self.clear()
        self.reset_children()
        self.set_status(IDLE)
        if was_running and self.scripts:
            self._run_script("_onHalted")

    def halt_child(self, index: int) -> None:
        """Stop a child if it is running, and reset its status."""
        child = self.children[index]
        if child.status == RUNNING:
            child.halt()
        child.set_status(IDLE)

    def reset_children(self) -> None:
        """Stop the children that are running, and reset the status of all."""
        for index in range(len(self.children)):
            self.halt_child(index)

    def _status_before(self) -> str:
        """Return the status that a condition gives the node instead of its tick; empty for none."""
        scripts = self.scripts
        if self.status == IDLE:
            for name, status in (("_failureIf", FAILURE), ("_successIf", SUCCESS), ("_skipIf", SKIPPED)):
                if name in scripts and self._value(name):
                    return status
        if "_while" in scripts and not self._value("_while"):
            if self.status == RUNNING:
                self.halt()
            return SKIPPED
        return ""

    def _run_script(self, name: str) -> None:
        if name in self.scripts:
            self._value(name)

    def _value(self, name: str) -> Any:
        try:
            return self.scripts[name].run(self.board)
        except ScriptError as error:
            raise TreeError(f"<{self.tag}> {name}: {error}") from None

    # ------------------------------------------------------------------ ports

    def has_input(self, port: str) -> bool:
        """Check whether a port has a value."""
        key = _key_of(self.inputs.get(port, ""), port)
        return port in self.inputs and (not key or self.board.has(key))

    def input(self, port: str, default: Any = None) -> Any:
        """Return the value of a port: an entry of the blackboard, or the text of the file."""
        text = self.inputs.get(port)
        if text is None:
            return default
        key = _key_of(text, port)
        return self.board.get(key, default) if key else text

    def input_or_entry(self, port: str, default: Any = None) -> Any:
        """Return the value of a port, or the entry of the blackboard with the port's name."""
        return self.input(port, default) if port in self.inputs else self.board.get(port, default)

    def number(self, port: str, default: float) -> float:
        """Return the number of a port."""
        value = self.input(port, default)
        try:
            result = float(value)
        except (TypeError, ValueError):
            result = math.nan
        if math.isnan(result):
            raise TreeError(f"<{self.tag}> {port}: found {value!r:.80}; expected a number")
        return result

    def integer(self, port: str, default: int) -> int:
        """Return the whole number of a port."""
        number = self.number(port, default)
        if not math.isfinite(number):
            raise TreeError(f"<{self.tag}> {port}: found {number}; expected a whole number")
        return int(number)

    def boolean(self, port: str, default: bool) -> bool:
        """Return the boolean of a port."""
        value = self.input(port, default)
        return value.strip().lower() in ("true", "1") if isinstance(value, str) else bool(value)

    def text(self, port: str, default: str = "") -> str:
        """Return the text of a port."""
        value = self.input(port, default)
        return default if value is None else str(value)

    def output(self, port: str, value: object) -> None:
        """Write a value to the entry of the blackboard that a port names."""
        key = _key_of(self.inputs.get(port, ""), port)
        if key:
            self.board.set(key, value)


def _key_of(text: str, port: str) -> str:
    """Return the name of the entry in `{name}`; `{=}` is the entry with the port's name; empty for another text."""
    stripped = text.strip()
    if len(stripped) < 3 or stripped[0] != "{" or stripped[-1] != "}":
        return ""
    key = stripped[1:-1].strip()
    return port if key == "=" else key


class ControlNode(TreeNode):
    """Node with children."""

    child_counts: ClassVar[tuple[int, int | None]] = (1, None)


class DecoratorNode(TreeNode):
    """Node with one child."""

    child_counts: ClassVar[tuple[int, int | None]] = (1, 1)

    def execute(self) -> str:
        """Tick the node; a child that has ended is reset."""
        status = super().execute()
        child = self.children[0]
        if child.status in COMPLETED:
            child.set_status(IDLE)
        return status


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

    def __deepcopy__(self, memo: dict[int, Any]) -> Tree:
        """Copy the tree for a snapshot; the copy shares the messages of the blackboard, which no node changes.

        A copy with a path of 200 poses takes 17 ms, and 0.6 ms if the path is shared.
        """
        for value in self.board.values.values():
            if hasattr(value, "__msgtype__"):
                memo[id(value)] = value
        copied = Tree.__new__(Tree)
        memo[id(self)] = copied
        vars(copied).update(copy.deepcopy(vars(self), memo))
        return copied

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

    def call_service(self, service: str, request: Mapping[str, object]) -> PendingCall | None:
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
            handle = getattr(node, "handle", None)
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
