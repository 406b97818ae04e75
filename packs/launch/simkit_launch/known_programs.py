"""Programs of simkit that run in place of the nodes that a launch file starts."""

from __future__ import annotations

from simkit_launch.launch_plan import LaunchedProcess
from simkit_nodes.known_nodes import known_node


def known_program(process: LaunchedProcess) -> str:
    """Return the name of the program of a known node, such as `create`; empty for another process."""
    node = known_node(f"{process.package}/{process.executable}") if process.package else None
    return node.file.stem if node is not None and node.file is not None else ""
