"""Nodes of a run: programs that run in lock-step with the world, as texts or mappings of a run specification.

A text has the words of a command line, `follower.py --ros-args -r scan:=/base_scan`. A mapping has the arguments of
`Simulation.add_node` by name, and `program`.
"""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import Any, Final

from simkit.errors import InputError
from simkit.run_files import ChangeFile, FileName, is_there

Node = str | Mapping[str, Any]
"""Program with its arguments."""
NODE_KEYS: Final = (
    *("program", "name", "namespace", "remap", "params", "args", "latency", "keys"),
    *("label", "after", "delay", "respawn", "ends_run", "env", "cwd"),
)
"""Keys of a node that is a mapping."""
ROS_ARGUMENTS: Final = "--ros-args"
_NAME: Final = "__node:="
_PARAMETER_FILE: Final = "--params-file"
_WITH_VALUE: Final = frozenset(
    {"-r", "--remap", "-p", "--param", _PARAMETER_FILE, "-e", "--enclave", "--log-level", "--log-config-file"}
    | {"--log-file-name"}
)
_LOG_FLAG: Final = re.compile(r"--(enable|disable)-(rosout|stdout|external-lib)-logs")
_TIME: Final = re.compile(r"(\d+\.?\d*|\.\d+)\s*(s|ms|us|min|)")
_UNITS: Final = {"": 1.0, "s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0}
_INVALID: Final = "SK-CLI-018"
NODES_READ_FILES: ContextVar[bool] = ContextVar("nodes_read_files", default=False)
"""True while a world is loaded whose run has nodes, which are added later and may read the parameter files."""


def seconds_of(text: str) -> float | None:
    """Return a time [s] of a text such as `30`, `30s`, `500ms` or `2min`; None for another text."""
    match = _TIME.fullmatch(text.strip())
    return None if match is None else float(match[1]) * _UNITS[match[2]]


def latency_of(value: object) -> float | tuple[float, float]:
    """Return a latency [s], or the limits of a latency that is drawn for each message.

    Args:
        value: number [s], pair of numbers, or text such as `5ms` or `5ms..20ms`.

    Raises:
        InputError: SK-CLI-018 the value is no latency.
    """
    limits: list[float | None] = [None]
    if isinstance(value, str):
        limits = [seconds_of(text) for text in value.split("..")]
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        limits = [float(value)]
    elif isinstance(value, Sequence) and all(isinstance(item, (int, float)) for item in value):
        limits = [float(item) for item in value]
    times = [limit for limit in limits if limit is not None and limit >= 0.0]
    if len(times) == len(limits) == 1:
        return times[0]
    if len(times) == len(limits) == 2 and times[0] <= times[1]:
        return times[0], times[1]
    raise InputError(_INVALID, f"found the latency {value!r:.60}; expected a time such as 5ms, or a range: 5ms..20ms")


def node_arguments(node: Node) -> dict[str, Any]:
    """Return the arguments of `Simulation.add_node` for a node, and `program`.

    Raises:
        InputError: SK-CLI-018 the node is empty, or has another form.
    """
    if isinstance(node, str):
        program, *words = split_node(node)
        name = next((word.removeprefix(_NAME) for word in words if word.startswith(_NAME)), None)
        return {"program": program, **({"name": name} if name else {}), **({"args": tuple(words)} if words else {})}
    unknown = [key for key in node if key not in NODE_KEYS]
    if unknown or not node.get("program"):
        problem = f"has no key {unknown[0]!r}" if unknown else "needs 'program'"
        raise InputError(_INVALID, f"a node {problem}", help=f"allowed keys: {', '.join(NODE_KEYS)}")
    arguments = {key: value for key, value in node.items() if value is not None}
    arguments["program"] = os.fspath(arguments["program"])
    if "args" in arguments:
        arguments["args"] = tuple(map(str, arguments["args"]))
    if "cwd" in arguments:
        arguments["cwd"] = os.fspath(arguments["cwd"])
    if "latency" in arguments:
        arguments["latency"] = latency_of(arguments["latency"])
    return arguments


def split_node(text: str) -> list[str]:
    """Return the words of a node: its program, then the arguments of the program.

    Raises:
        InputError: SK-CLI-018 the text is empty, or a quotation mark is missing.
    """
    try:
        words = [text] if text and is_there(Path(text)) else shlex.split(text)
    except ValueError as error:
        raise InputError(_INVALID, f"node {text!r:.100}: {error}".lower()) from None
    if not words:  # its usual cause is an unset variable of a shell script
        raise InputError(_INVALID, "a node is empty; expected FILE.py or PACKAGE/EXECUTABLE")
    return words


def label_of(node: Node) -> str:
    """Return the name by which messages and `--node-latency` call a node: its name, else that of its program."""
    arguments = node_arguments(node)
    program = str(arguments["program"])
    return str(arguments.get("name") or Path(program).name.removesuffix(".py"))


def moved_node(node: Node, keys: tuple[str | int, ...], change: ChangeFile) -> Node:
    """Return a node in which each name of a file is changed: its program, folder, and files of parameters.

    Args:
        node: node.
        keys: position of the node, such as `("nodes", 0)`.
        change: function that returns the new name of a file.
    """
    arguments = node_arguments(node)
    program = str(change(FileName(arguments["program"], "program", keys)))
    words = list(arguments.get("args", ()))
    for index in _parameter_files(words):
        words[index] = str(change(FileName(words[index], "file", keys)))
    if isinstance(node, str):
        return shlex.join([program, *words])
    moved = {**node, "program": program, **({"args": words} if words else {})}
    if moved.get("cwd") is not None:
        moved["cwd"] = str(change(FileName(os.fspath(moved["cwd"]), "folder", keys)))
    return moved


def _parameter_files(words: Sequence[str]) -> Iterator[int]:
    """Yield the positions of the names of parameter files among the arguments of a program."""
    is_ros = False
    for index, word in enumerate(words):
        is_ros = word == ROS_ARGUMENTS or (is_ros and word != "--")
        if is_ros and index and words[index - 1] == _PARAMETER_FILE:
            yield index


def join_node_words(words: Sequence[str]) -> list[str]:
    """Return the words of a command line in which each option `--node` has one value with all arguments of ROS.

    The arguments of a node begin with `--ros-args`, directly after the program, as in `ros2 run`. They end with the
    first word that is no argument of ROS, so that further options of simkit may follow, or with `--`.
    """
    joined: list[str] = []
    words = list(words)
    index = 0
    while index < len(words):
        word = words[index]
        index += 1
        name, equals, program = word.partition("=")
        if name != "--node" or not (equals or index < len(words)):
            joined.append(word)
            continue
        if not equals:
            program = words[index]
            index += 1
        end = _end_of_ros_arguments(words, index)
        if end > index:
            program = shlex.join([*split_node(program), *words[index:end]])
            index = end + 1 if words[end : end + 1] == ["--"] else end
        joined += ["--node", program]
    return joined


def _end_of_ros_arguments(words: Sequence[str], index: int) -> int:
    """Return the position after the arguments of ROS that begin at a position; the position itself without any."""
    if words[index : index + 1] != [ROS_ARGUMENTS]:
        return index
    index += 1
    while index < len(words):
        if words[index] in _WITH_VALUE:
            index = min(index + 2, len(words))
        elif _LOG_FLAG.fullmatch(words[index]) or words[index] == ROS_ARGUMENTS:
            index += 1
        else:
            break
    return index


@contextmanager
def nodes_read_files(has_nodes: bool) -> Iterator[None]:
    """Within the context, a parameter file of ROS 2 for all models may be one for the nodes of the run.

    Args:
        has_nodes: True if the run has nodes, which are added after the world is loaded.
    """
    token = NODES_READ_FILES.set(has_nodes)
    try:
        yield
    finally:
        NODES_READ_FILES.reset(token)
