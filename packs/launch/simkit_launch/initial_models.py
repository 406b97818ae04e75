"""Models that a launch file spawns at its begin: the run loads them with its world.

Such a model can have overrides, and commands and conditions know it before the first step. The program that spawns it
in ROS still runs, and finds its model in the world.
"""

from __future__ import annotations

from argparse import ArgumentError, ArgumentParser
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Final

from simkit_launch.known_programs import known_program
from simkit_launch.launch_plan import LaunchedProcess, LaunchPlan
from simkit_launch.model_spawning import (
    CREATE_FLAGS,
    LOADED_MODEL,
    POSE_FLAGS,
    FlagError,
    add_entity_arguments,
    add_model_arguments,
    add_spawn_arguments,
    parse_flags,
    with_namespace,
)
from simkit_nodes.names import expand_name, join_name

_PROGRAMS: Final = ("create", "spawn_entity", "spawn_model")
"""Programs of known nodes that spawn a model."""
_PUBLISHER: Final = "robot_state_publisher"


class _Parser(ArgumentParser):
    """Parser that raises an exception in place of ending the process."""

    def error(self, message: str) -> Any:
        raise ArgumentError(None, message)


def loaded_model(process: LaunchedProcess, plan: LaunchPlan) -> Mapping[str, Any] | None:
    """Return the entry of `RunSpec.spawn` for a process that spawns a model at the begin of the run.

    Args:
        process: process.
        plan: its plan.

    Returns:
        Entry; None for another process, and for one that waits for something that is not known before the run.
    """
    kind = known_program(process)
    if kind not in _PROGRAMS or process.condition.event != "begin" or process.condition.delay:
        return None
    words = _without_ros(process.arguments)
    try:
        options = _create_options(process, words) if kind == "create" else _classic_options(kind, words)
    except (FlagError, ArgumentError, ValueError):
        return None  # the program reports it
    name, namespace = str(options["name"]), str(options.get("robot_namespace") or "")
    source = _source(options, process, plan)
    if not source or not name or options.get("wait") or options.get("joints") or options.get("reference_frame"):
        return None
    if kind == "spawn_model" and not namespace:
        namespace = process.namespace or "/"
    if namespace:
        source = with_namespace(source, namespace)
    return {"model": source, "place": [float(options[flag]) for flag in POSE_FLAGS], "name": name}


def environment_of(entry: Mapping[str, Any]) -> dict[str, str]:
    """Return the variable of the environment that tells a program which model is in the world already."""
    return {LOADED_MODEL: str(entry["name"])}


def _without_ros(words: Iterable[str]) -> list[str]:
    """Return the words before `--ros-args`."""
    kept: list[str] = []
    for word in words:
        if word == "--ros-args":
            break
        kept.append(word)
    return kept


def _create_options(process: LaunchedProcess, words: list[str]) -> dict[str, Any]:
    values: dict[str, Any] = parse_flags(words, CREATE_FLAGS)
    for parameters in process.parameters:
        if isinstance(parameters, Mapping):
            values.update({name: value for name, value in parameters.items() if name in CREATE_FLAGS and value})
    return values


def _classic_options(kind: str, words: list[str]) -> dict[str, Any]:
    parser = _Parser(allow_abbrev=False, add_help=False)
    (add_entity_arguments if kind == "spawn_entity" else add_model_arguments)(parser)
    add_spawn_arguments(parser)
    given = vars(parser.parse_known_args(words)[0])
    return {**given, "name": given.get("entity") or given.get("model") or ""}


def _source(options: Mapping[str, Any], process: LaunchedProcess, plan: LaunchPlan) -> str:
    """Return file, URI or text of a model; empty if it is not known before the run."""
    if options.get("file"):
        file = str(options["file"])
        return file if "://" in file or Path(file).is_file() else ""
    if options.get("string"):
        return str(options["string"])
    if options.get("database"):
        return f"model://{options['database']}"
    if options.get("param"):
        name = str(options["param"])
        for parameters in reversed(process.parameters):
            if isinstance(parameters, Mapping) and name in parameters:
                return str(parameters[name])
        absolute = name if name.startswith("/") else join_name(process.namespace or "/", name)
        return str(plan.parameters.get(absolute, ""))
    return _published_description(str(options.get("topic") or ""), process, plan)


def _published_description(topic: str, process: LaunchedProcess, plan: LaunchPlan) -> str:
    """Return the description that a robot_state_publisher will publish on a topic from the begin of the run."""
    if not topic:
        return ""
    wanted = _resolved(topic, process)
    for other in plan.processes:
        if known_program(other) != _PUBLISHER or other.condition.event != "begin" or other.condition.delay:
            continue
        if _resolved("robot_description", other) == wanted:
            for parameters in reversed(other.parameters):
                if isinstance(parameters, Mapping) and isinstance(parameters.get("robot_description"), str):
                    return str(parameters["robot_description"])
    return ""


def _resolved(topic: str, process: LaunchedProcess) -> str:
    """Return the absolute name of a topic of a process after its remaps."""
    namespace = process.namespace or "/"
    full = expand_name(topic, process.name or process.executable, namespace)
    for old, new in process.remappings:
        if expand_name(old, process.name or process.executable, namespace) == full:
            return expand_name(new, process.name or process.executable, namespace)
    return full
