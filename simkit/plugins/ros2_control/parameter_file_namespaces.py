"""Parameter files of a run, moved to the names under which a controller manager looks for its parameters."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final

from simkit.diagnostics import Diagnostics
from simkit.plugins.ros_parameter_files import Entry, ParameterFile

_ROS_1_LOOPS: Final = "gazebo_ros_control"


def adapt_to_manager(
    given: ParameterFile, namespace: str, manager: str, diagnostics: Diagnostics, *, is_ros_1: bool
) -> ParameterFile:
    """Return a file as it would be on the parameter server: where a launch file had put it, and for either ROS.

    The launch file of ROS 1 loads a file into the robot's namespace; so a file that has no such name is taken to be
    below it. A file of one ROS declares controllers for a plugin of the other too: in ROS 2 they stand, with their
    type, below the manager's node; in ROS 1 in the robot's namespace.

    Args:
        given: the file.
        namespace: of the robot, with its slash; empty for none.
        manager: name of the manager's node.
        diagnostics: gets what has no effect.
        is_ros_1: whether the plugin is ROS 1's.
    """
    parts = [part for part in namespace.split("/") if part]
    if given.root is not None:
        root = given.root if _nested_entry(given.root, parts) is not None else _wrap_in_namespace(given.root, parts)
        if is_ros_1:
            return replace(given, root=root)
        own = _nested_entry(root, parts) or root
        _report_ros_1_gains(own, given, diagnostics)
        declared = list(_declared_controllers(own, only_type=True))
        nodes = [(f"{namespace}/{manager}", Entry(root.where, below=dict(declared)))] if declared else []
        return replace(given, root=root, nodes=nodes)
    if not is_ros_1:
        return given
    inside = any(pattern.strip("/").split("/")[: len(parts)] == parts for pattern, _ in given.nodes)
    nodes = given.nodes
    if not inside:
        nodes = [(p if p.startswith("/**") else f"{namespace}/{p.strip('/')}", entry) for p, entry in nodes]
    own_nodes = [
        (namespace or "/", _controllers_with_type(entry)) for p, entry in nodes if p.rpartition("/")[2] == manager
    ]
    return replace(given, nodes=[*nodes, *own_nodes])


def _controllers_with_type(entry: Entry) -> Entry:
    return Entry(entry.where, below=dict(_declared_controllers(entry, only_type=False)))


def _declared_controllers(entry: Entry, *, only_type: bool) -> Iterator[tuple[str, Entry]]:
    """The blocks with a type; only that is left in them where the rest is the controller's own."""
    for name, one in (entry.below or {}).items():
        kind = (one.below or {}).get("type")
        if kind is not None and kind.text:
            yield name, Entry(one.where, below={"type": kind}) if only_type else one


def _nested_entry(entry: Entry, parts: Sequence[str]) -> Entry | None:
    """The block at a path; None where there is none."""
    found: Entry | None = entry
    for part in parts:
        found = (found.below or {}).get(part) if found is not None else None
    return found


def _wrap_in_namespace(entry: Entry, parts: Sequence[str]) -> Entry:
    for part in reversed(parts):
        entry = Entry(entry.where, below={part: entry})
    return entry


def _report_ros_1_gains(own: Entry, given: ParameterFile, diagnostics: Diagnostics) -> None:
    below = own.below or {}
    if _ROS_1_LOOPS in below:
        message = f"{given.path.name}: {_ROS_1_LOOPS} has loops for the plugin of ROS 1; this robot's is of ROS 2"
        hint = "its own node has pid_gains: {position: {JOINT: {kp: ..., kd: ...}}}"
        diagnostics.warning("SK-CONTROL-011", message, below[_ROS_1_LOOPS].where, hint)
