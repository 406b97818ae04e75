"""Parameters that a spawner sets before it loads a controller: its type, its parameter files and its remappings."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit.extend import Diagnostics
from simkit.plugins.ros_parameter_files import Entry, ParameterFile, ParameterFiles, read_parameter_file
from simkit_control.plugins.ros2_control.controller_manager import ControllerManager
from simkit_control.plugins.ros2_control.manager_parameter_files import adapt_to_manager

if TYPE_CHECKING:
    from simkit.msgs import Message, SetParameters_Request

_FILES: Final = "params_file"
_TYPE: Final = "type"
_ARGUMENTS: Final = "node_options_args"
_KNOWN: Final = (_TYPE, _FILES, _ARGUMENTS, "fallback_controllers")
_REMAP: Final = ("-r", "--remap")


def set_parameters(manager: ControllerManager, request: SetParameters_Request) -> dict[str, object]:
    """Set parameters `CONTROLLER.type`, `CONTROLLER.params_file` and `CONTROLLER.node_options_args` of a manager."""
    results = []
    for parameter in request.parameters:
        controller, _, name = parameter.name.rpartition(".")
        problem = f"cannot set {parameter.name!r}; it can be CONTROLLER.{', CONTROLLER.'.join(_KNOWN)}"
        if controller and name in _KNOWN:
            problem = _set(manager, controller, name, _texts(parameter.value))
        results.append({"successful": not problem, "reason": problem})
    return {"results": results}


def _set(manager: ControllerManager, controller: str, name: str, texts: Sequence[str]) -> str:
    """Set a parameter of a controller; return the problem, or an empty text."""
    if name == _TYPE:
        _declare_type(manager, controller, "".join(texts))
    elif name == _ARGUMENTS:
        manager.remappings[controller] = tuple(_remappings(texts))
    elif name == _FILES:
        problems = [_add_parameter_file(manager, Path(text)) for text in texts]
        return "; ".join(problem for problem in problems if problem)
    return ""


def _texts(value: Message) -> Sequence[str]:
    """Return the texts of a parameter: one text, a list of texts, or a text with a list as Python writes it."""
    texts = list(value.string_array_value)
    if texts:
        return texts
    text = str(value.string_value)
    if text.startswith("["):
        try:
            return [str(item) for item in ast.literal_eval(text)]
        except (ValueError, SyntaxError):
            return [text]
    return [text] if text else []


def _remappings(words: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Yield source and target of the remapping rules in arguments such as `--ros-args -r ~/cmd_vel:=/cmd_vel`."""
    for word in words:
        source, assigned, target = word.partition(":=")
        if assigned and not source.startswith("__"):
            yield source.rpartition(":")[2], target


def _add_parameter_file(manager: ControllerManager, path: Path) -> str:
    """Add a parameter file, whose values replace those of the earlier ones; return the problem."""
    if any(file.path == path for file in manager.files.files):
        return ""
    problems = Diagnostics()
    read = read_parameter_file(path, problems)
    manager.reports.extend(problems)
    if read is None:
        return "; ".join(problem.message for problem in problems)
    is_ros_1 = manager.is_ros_1
    file = adapt_to_manager(read, manager.namespace, manager.name, manager.reports, is_ros_1=is_ros_1)
    manager.files = ParameterFiles([*manager.files.files, file])
    return ""


def _declare_type(manager: ControllerManager, controller: str, kind: str) -> None:
    """Declare a controller and its type, as if a parameter file did."""
    where = manager.plugin.where
    declared = Entry(where, below={controller: Entry(where, below={"type": Entry(where, kind, is_text=True)})})
    file = ParameterFile(Path("parameters of services"), [(manager.node or "/", declared)])
    manager.files = ParameterFiles([*manager.files.files, file])
