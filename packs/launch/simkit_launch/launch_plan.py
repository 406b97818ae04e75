"""Plan of a launch file: the processes that it starts, in order, and what each of them waits for.

A launch file is executed once, before the run. Its timers and event handlers become conditions of the plan: a process
starts at a time after the begin of the run, or after the start or the end of another process.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Literal

from simkit.diagnostics import NOWHERE, Diagnostics, Where

MOST_INCLUDES: Final = 2000
"""Largest number of files that a launch file includes, also through other files."""

Parameters = Mapping[str, Any] | Path
"""Values of parameters by name (nested tables are joined with dots), or a file of parameters."""


@dataclass(frozen=True)
class StartCondition:
    """Condition for the start of a process.

    Attributes:
        event: "begin" of the run, or "start" or "exit" of another process.
        process: number of the other process; 0 for the begin of the run.
        delay: simulated time after the event [s].
    """

    event: Literal["begin", "start", "exit"] = "begin"
    process: int = 0
    delay: float = 0.0


@dataclass(frozen=True)
class LaunchedProcess:
    """Process that a launch file starts: a node of a package, a command, or the end of the launch.

    Attributes:
        number: 1, 2, … in the order in which the launch file starts them.
        kind: "node" for an executable of a package; "command" for a command line, whose first word is its program;
            "component" for a node that is loaded into a container; "shutdown" for the end of the run.
        package: package of a node or component; empty for a command.
        executable: executable of a node; plugin name of a component (`pkg::Class`); empty for a command.
        name: name of the node; empty for the name in its program.
        namespace: namespace of the node, absolute, such as `/robot`; empty for none.
        parameters: parameters of the node in the order of their effect: a later one replaces an earlier one.
        remappings: pairs of an old and a new name.
        arguments: words of the command line after the executable, without those for ROS; all words of a command.
        environment: variables of the environment that differ from those of the process of simkit.
        folder: working directory; None for the present one.
        condition: condition for its start.
        respawn_delay: simulated time after which an ended process starts again [s]; None for never.
        ends_run: True if the run ends with the process (`on_exit=Shutdown()`, `required="true"`).
        container: name of the container of a component.
        is_ros1: True for a process of a launch file of ROS 1.
        where: place in the launch file.
        source: text of what is started, for messages, such as `robot_state_publisher/robot_state_publisher`.
    """

    number: int
    kind: Literal["node", "command", "component", "shutdown"]
    package: str = ""
    executable: str = ""
    name: str = ""
    namespace: str = ""
    parameters: tuple[Parameters, ...] = ()
    remappings: tuple[tuple[str, str], ...] = ()
    arguments: tuple[str, ...] = ()
    environment: Mapping[str, str] = field(default_factory=dict)
    folder: Path | None = None
    condition: StartCondition = StartCondition()
    respawn_delay: float | None = None
    ends_run: bool = False
    container: str = ""
    is_ros1: bool = False
    where: Where = NOWHERE

    @property
    def source(self) -> str:
        """Text of what is started, for messages, such as `robot_state_publisher/robot_state_publisher`."""
        if self.kind == "shutdown":
            return "shutdown"
        if self.package == "command":  # a known command, see `command_nodes`
            return " ".join((self.executable, *self.arguments))
        return f"{self.package}/{self.executable}" if self.package else " ".join(self.arguments)


@dataclass(frozen=True)
class DeclaredArgument:
    """Argument of a launch file.

    Attributes:
        name: name.
        default: text of the default value; None for an argument that must be given.
        description: description; empty for none.
        choices: allowed values; empty for any.
        where: place in the launch file.
    """

    name: str
    default: str | None = None
    description: str = ""
    choices: tuple[str, ...] = ()
    where: Where = NOWHERE


@dataclass
class LaunchPlan:
    """Everything that a launch file starts.

    Attributes:
        file: launch file.
        arguments: values of the arguments of the launch file, by name.
        processes: processes in the order of their start.
        parameters: parameters of the parameter server of ROS 1 by absolute name.
        resource_paths: folders for models and worlds, from variables of the environment and from packages.
        log: lines that the launch file prints or logs.
        diagnostics: warnings and notes: what is left out, with its place, and what does not work without it.
    """

    file: Path
    arguments: dict[str, str] = field(default_factory=dict)
    processes: list[LaunchedProcess] = field(default_factory=list)
    parameters: dict[str, Any] = field(default_factory=dict)
    resource_paths: list[str] = field(default_factory=list)
    log: list[str] = field(default_factory=list)
    diagnostics: Diagnostics = field(default_factory=Diagnostics)
