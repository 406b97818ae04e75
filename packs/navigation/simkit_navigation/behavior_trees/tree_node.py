"""Nodes of a behaviour tree, their status, their ports and the blackboard.

The rules of `execute`, `halt` and of the status are those of BehaviorTree.CPP 4 (`src/tree_node.cpp`,
`src/control_node.cpp`, `src/decorator_node.cpp`). The state of a tree consists of plain attributes, so that a snapshot
of the plugin contains it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, Final

from simkit_navigation.behavior_trees.scripts import Script, ScriptError

if TYPE_CHECKING:
    from simkit_navigation.behavior_trees.tree import Tree

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


@dataclass(eq=False)
class Blackboard:
    """Values by name, which the nodes of a tree share.

    Attributes:
        values: values by name.
        parent: blackboard of the tree that contains this one as a subtree.
        remapped: names of this blackboard whose values are in the parent, with their name there.
        remaps_all: True if the parent has each name that this blackboard does not have.
    """

    values: dict[str, Any] = field(default_factory=dict)
    parent: Blackboard | None = None
    remapped: dict[str, str] = field(default_factory=dict)
    remaps_all: bool = False

    def _owner(self, name: str) -> tuple[Blackboard, str]:
        """Return the blackboard with the value of a name, and its name there."""
        board: Blackboard = self
        while (outer := board.parent) is not None:
            if name.startswith("@"):
                board = outer
            elif name in board.remapped:
                board, name = outer, board.remapped[name]
            elif board.remaps_all and name not in board.values and not name.startswith("_"):
                board = outer
            else:
                break
        return board, name.removeprefix("@")

    def has(self, name: str) -> bool:
        """Check whether there is a value."""
        board, key = self._owner(name)
        return key in board.values

    def get(self, name: str, default: Any = None) -> Any:
        """Return a value."""
        board, key = self._owner(name)
        return board.values.get(key, default)

    def set(self, name: str, value: object) -> None:
        """Store a value."""
        board, key = self._owner(name)
        board.values[key] = value

    def unset(self, name: str) -> None:
        """Remove a value."""
        board, key = self._owner(name)
        board.values.pop(key, None)


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
            found = float(value)
        except (TypeError, ValueError):
            found = math.nan
        if math.isnan(found):
            raise TreeError(f"<{self.tag}> {port}: found {value!r:.80}; expected a number")
        return found

    def integer(self, port: str, default: int) -> int:
        """Return the whole number of a port."""
        found = self.number(port, default)
        if not math.isfinite(found):
            raise TreeError(f"<{self.tag}> {port}: found {found}; expected a whole number")
        return int(found)

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
