"""Command lines of a launch file that start nodes, such as `ros2 run` or `ros2 control`."""

from __future__ import annotations

from dataclasses import replace
from pathlib import PurePath
from typing import Final

from simkit_launch.command_line import run_executable
from simkit_launch.launch_plan import LaunchedProcess
from simkit_nodes.known_nodes import known_node

COMMAND: Final = "command"
"""Package of the known nodes that are commands: `command/ros2` is the program `ros2`."""


def resolved_process(process: LaunchedProcess) -> LaunchedProcess:
    """Return the process of a command line as a node, if simkit knows the command; other processes as they are.

    `ros2 run PACKAGE EXECUTABLE` is a node of the package. A known command such as `ros2 control …` is a node
    `command/ros2` with the further words as its arguments. A nodelet of ROS 1 is a node with the name of its class.
    """
    if process.package == "nodelet" and process.executable == "nodelet":
        return _resolved_nodelet(process)
    if process.kind != "command":
        return process
    words = process.arguments
    executable = run_executable(words)
    if executable is not None:
        package, name, rest = executable
        return replace(process, kind="node", package=package, executable=name, arguments=rest)
    name = PurePath(words[0]).name if words else ""
    if name and known_node(f"{COMMAND}/{name}") is not None:
        return replace(process, kind="node", package=COMMAND, executable=name, arguments=tuple(words[1:]))
    return process


def _resolved_nodelet(process: LaunchedProcess) -> LaunchedProcess:
    """Return the node that a process loads into a manager of nodelets; the manager itself as it is."""
    words = [word for word in process.arguments if word]
    package, slash, name = (
        words[1].partition("/") if len(words) > 1 and words[0] in ("load", "standalone") else ("",) * 3
    )
    if not slash:
        return process
    return replace(process, package=package, executable=name, arguments=())
