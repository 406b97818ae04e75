"""Parameter files that a run is given, for robots whose controllers a launch file of ROS fills in: `--params-file`."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit.diagnostics import Diagnostics, did_you_mean
from simkit.plugins.ros2_control.parameter_files import Entry, ParameterFile, read_parameter_file

if TYPE_CHECKING:
    from simkit.scene import SceneModel

ParameterFileArgument = str | os.PathLike[str] | tuple[str, str | os.PathLike[str]]
"""A file, the text `MODEL=FILE`, or the pair of both."""

_ROS_1_LOOPS: Final = "gazebo_ros_control"


@dataclass(frozen=True, slots=True)
class RunParameterFile:
    """One file as read.

    Attributes:
        model: whose control plugins read it; empty for those of every model.
        file: what it says.
    """

    model: str
    file: ParameterFile

    def is_for(self, model: SceneModel) -> bool:
        """Check whether the plugins of that model read it: it has the name, or is inside the one that has."""
        scoped = f"{model.scoped}::"
        return not self.model or self.model == model.name or scoped.startswith(f"{self.model}::")


def read_run_parameter_files(
    named: ParameterFileArgument | Sequence[ParameterFileArgument],
    find: Callable[[str], Path | None],
    diagnostics: Diagnostics,
) -> tuple[RunParameterFile, ...]:
    """Reads files; each that is missing or broken is an error, and left out.

    Args:
        named: what `params_files` or `--params-file` say.
        find: the file of a `package://` URI or a path; None where there is none.
        diagnostics: gets the problems.
    """
    if isinstance(named, (str, os.PathLike)):
        named = [named]
    read: dict[Path, ParameterFile | None] = {}
    found = []
    for one in named:
        model, text = _model_and_file(one)
        path = _find_file(text, find)
        if path is None:
            message = f"the parameter file {text[:200]} is not found"
            diagnostics.error(
                "SK-CONTROL-015", message, hint=_closest_file_name(text) or "--params-file takes FILE or MODEL=FILE"
            )
            continue
        if path not in read:
            read[path] = read_parameter_file(path, diagnostics)
        file = read[path]
        if file is not None:
            found.append(RunParameterFile(model, file))
    return tuple(found)


def _model_and_file(named: ParameterFileArgument) -> tuple[str, str]:
    """The model, empty for all of them, and the file."""
    if isinstance(named, tuple):
        return str(named[0]), os.fspath(named[1])
    text = os.fspath(named)
    model, equals, file = text.partition("=")
    if not equals or not model.strip() or "/" in model or _exists(Path(text)):
        return "", text
    return model.strip(), file


def _find_file(text: str, find: Callable[[str], Path | None]) -> Path | None:
    if text and _exists(Path(text)):
        return Path(text)
    try:
        found = find(text) if text else None
        return found if found is not None and found.is_file() else None
    except (OSError, ValueError):  # a name that no file can have
        return None


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):
        return False


def _closest_file_name(text: str) -> str:
    """A file of nearly that name in its folder."""
    try:
        folder = Path(text).parent
        return did_you_mean(Path(text).name, [p.name for p in folder.iterdir() if p.suffix in (".yaml", ".yml")])
    except (OSError, ValueError):
        return ""


# ------------------------------------------------------------------ as the manager of a robot looks for it


def adapt_to_manager(
    given: ParameterFile, namespace: str, manager: str, diagnostics: Diagnostics, *, is_ros_1: bool
) -> ParameterFile:
    """A file as it would be on the parameter server: where a launch file had put it, and for either ROS.

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
