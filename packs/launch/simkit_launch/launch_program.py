"""Program that executes a launch file before the run: it has its own modules, arguments, environment and output."""

from __future__ import annotations

import ast
import hashlib
import os
import sys
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any, Final, TypeVar, cast

from simkit.input_file import TEXT_LIMIT, read_input
from simkit_nodes.interfaces import ROS2
from simkit_nodes.node_options import NodeOptions
from simkit_nodes.process_state import ProcessState
from simkit_nodes.program_streams import ProgramInput, ProgramOutput
from simkit_nodes.programs import VARIABLES, NodeProgram
from simkit_nodes.syntax_tree import parsed
from simkit_nodes.task_host import TaskHost
from simkit_nodes.tasks import TaskScheduler
from simkit_nodes.workspace import Workspace

if TYPE_CHECKING:
    from simkit_nodes.graph import Graph

_LONGEST_WAIT_NS: Final = 3600 * 10**9
"""Sum of the waits of a launch file after which it is taken to wait for ever."""

_Result = TypeVar("_Result")


class _NoGraph:
    """Topics, services and actions of a launch file, which has none.

    Attributes:
        shared: objects of the programs by name.
    """

    def __init__(self) -> None:
        self.shared: dict[str, object] = {}

    def __getattr__(self, name: str) -> Any:
        raise RuntimeError("a launch file cannot open a node while it is read: no simulation runs yet")


class PlanningHost(TaskHost):
    """World around a launch file: there is no simulation, and a wait ends at once.

    Attributes:
        graph: empty graph of topics, services and actions.
        tasks: scheduler of the threads.
        simulation: None.
    """

    def __init__(self) -> None:
        self._now_ns = 0
        self.tasks = TaskScheduler(self.now_ns)
        self.graph = cast("Graph", _NoGraph())
        self.simulation = None

    def now_ns(self) -> int:
        """Return the time that the launch file has waited [ns]."""
        return self._now_ns

    def wake(self) -> None:
        """Have the conditions of all waits asked again."""
        self.tasks.needs_look = True

    def seed_of(self, node: str) -> int:
        """Return the seed of the random numbers of a launch file."""
        return int.from_bytes(hashlib.sha256(node.encode()).digest()[:8], "little")

    def call_outside(self, function: Callable[[], _Result]) -> _Result:
        """Call a function."""
        return function()

    def run(self, program: LaunchProgram) -> bool:
        """Run a program to the end of its main thread; its waits for a time end at once.

        Returns:
            True; False if the program waits for something that never comes.
        """
        program.main_task = self.tasks.create(program, program.run, program.name)
        try:
            self.tasks.run_ready()
            while program.main_task in self.tasks.tasks_of(program):
                next_ns = self.tasks.next_ns
                if next_ns is None or next_ns > _LONGEST_WAIT_NS:
                    return False
                self._now_ns = max(self._now_ns, next_ns)
                self.tasks.run_ready()
        finally:
            self.tasks.end(program)
            self.tasks.leave_program()
        return True


class LaunchProgram(NodeProgram):
    """Program that executes a launch file.

    Args:
        host: world around the program.
        function: function that executes the launch file.
        argv: command line.
        workspace: ROS packages.
        variables: variables of the environment that the program has, if the process does not have them.
        find_package: function that returns the folder of a ROS package, or one that stands for it.
    """

    def __init__(
        self,
        host: PlanningHost,
        function: Callable[[], object],
        argv: list[str],
        workspace: Workspace,
        variables: Mapping[str, str],
        find_package: Callable[[str], Path],
    ) -> None:
        self._argv, self._variables, self._find_package = argv, variables, find_package
        self.workspace = workspace
        super().__init__(host, function, NodeOptions(name="launch"))

    def prepare(self) -> None:
        """Make the program as new, before its start; all its output goes to the standard error of the process."""
        super().prepare()
        self.stdin = ProgramInput(self, "")
        self.stdout = self.stderr = ProgramOutput(self.log, "stderr")  # the standard output has the results of simkit
        streams = self.stdin, self.stdout, self.stderr
        prefix = {"AMENT_PREFIX_PATH": str(self.workspace.install_folder)}
        variables = {**VARIABLES[ROS2], **prefix, **self._variables}
        self.process = ProcessState(self._argv, [], streams, variables, self.host.seed_of(self.name))

    def package_folder(self, name: str) -> Path | None:
        """Return the folder of a ROS package.

        For a missing one it is a folder that stands for it, or None if the launch file handles the exception.
        """
        if self.workspace.package(name) is not None:
            return self._find_package(name)
        frame: FrameType | None = sys._getframe(1)
        while frame is not None:
            file = frame.f_code.co_filename
            if self.has_folder(os.path.dirname(file)) and handles_missing_package(file, frame.f_lineno):  # noqa: PTH120
                return None
            frame = frame.f_back
        return self._find_package(name)

    def add_folder(self, folder: Path) -> None:
        """Note that the files in a folder belong to the program."""
        if str(folder) not in self.module_roots:
            self.module_roots.append(str(folder))


@cache
def handles_missing_package(file: str, line: int) -> bool:
    """Check whether a line of a Python file is in a `try` block that handles the exception for a missing package.

    Args:
        file: Python file.
        line: number of the line.
    """
    try:
        tree = parsed(read_input(Path(file), TEXT_LIMIT))
    except OSError:
        return False
    blocks = [node for node in ast.walk(tree) if isinstance(node, ast.Try)]
    inside = [node for node in blocks if node.body[0].lineno <= line <= (node.body[-1].end_lineno or 0)]
    handlers = [handler.type for node in inside for handler in node.handlers]
    return any(kind is None or not _HANDLED.isdisjoint(_names(kind)) for kind in handlers)


def _names(expression: ast.expr) -> set[str]:
    names = {node.id for node in ast.walk(expression) if isinstance(node, ast.Name)}
    return names | {node.attr for node in ast.walk(expression) if isinstance(node, ast.Attribute)}


_HANDLED: Final = frozenset(("BaseException", "Exception", "KeyError", "LookupError", "PackageNotFoundError"))
