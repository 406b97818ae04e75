"""Execution of a launch file at simulated times that are only symbols: everything that it starts goes into a plan.

Processes do not run yet, so each of them is taken to start, and to end with exit code 0. What an event handler then
starts gets the start or the end as its condition. Handlers run in the order of time: first those of starts and timers,
then those of ends.
"""

from __future__ import annotations

import heapq
import os
import re
import sys
import time
from collections.abc import Callable, Container, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from logging import Logger
from pathlib import Path
from types import ModuleType
from typing import IO, TYPE_CHECKING, Any, Final, NamedTuple, Protocol

from simkit.diagnostics import NOWHERE, Where
from simkit.input_file import TEXT_LIMIT, read_input, read_input_text
from simkit.packs import is_shipped_file
from simkit.run_files import PackagePaths
from simkit_launch.action_places import calling_place
from simkit_launch.command_output import command_output
from simkit_launch.launch_environment import USUAL_VALUES, note_usual_value
from simkit_launch.launch_packages import LaunchPackages, missing_package_of
from simkit_launch.launch_plan import MOST_INCLUDES, DeclaredArgument, LaunchedProcess, LaunchPlan, StartCondition
from simkit_launch.temporary_files import folder_of_written_files, run_file_of, write_run_file, write_shared_file
from simkit_nodes.program_imports import run_as_main
from simkit_nodes.python_modules import program_module
from simkit_nodes.tasks import current_task

if TYPE_CHECKING:
    from simkit_launch.launch_program import LaunchProgram

FAILED: Final = "SK-LAUNCH-002"
LEFT_OUT: Final = "SK-LAUNCH-003"
MISSING_ARGUMENT: Final = "SK-LAUNCH-004"
MOVED_FILE: Final = "SK-LAUNCH-006"

_FOUND_COMMANDS: Final = ("gazebo", "gz", "gzclient", "gzserver", "ign", "ros2", "rviz2", "xacro")
_COMMAND: Final = "#!/bin/sh\necho 'simkit runs this command when the launch file starts it' >&2\nexit 1\n"
_XACRO: Final = "#!/bin/sh\nexec '{}' -m simkit_launch.xacro_command \"$@\"\n"
_FOREVER: Final = 1e6  # [s]: ends come after all timers
_MOST_PROCESSES: Final = 2000
_MOST_EVENTS: Final = 20_000
_MOST_LEVELS: Final = 100
_CONTROL: Final = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f]")  # they would change the terminal


class Context(Protocol):
    """State of the execution, as far as the planner uses it: `LaunchContext`."""

    def push_locals(self) -> None:
        """Store the local variables."""

    def pop_locals(self) -> None:
        """Restore the local variables."""

    def event_handlers(self) -> tuple[Any, ...]:
        """Return the event handlers in the order in which they handle an event."""


class LaunchLanguage(NamedTuple):
    """Functions of the modules that launch files import.

    Attributes:
        new_context: function that returns a new context.
        read_description: function that returns the launch description of an XML or YAML file.
        replace_substitutions: function that replaces `$(…)` in a text.
    """

    new_context: Callable[[], Any]
    read_description: Callable[[Path], Any]
    replace_substitutions: Callable[[str, Any], str]


class LaunchFileError(Exception):
    """A launch file has an error.

    Args:
        code: code of the diagnostic.
        text: message.
        where: place.
        hint: advice.
    """

    def __init__(self, code: str, text: str, where: Where, hint: str = "") -> None:
        super().__init__(text)
        self.code, self.text, self.where, self.hint = code, text, where, hint


class Moment(NamedTuple):
    """Time at which actions are executed.

    Attributes:
        condition: condition for what they start.
        time: time in the order of all handlers [s].
    """

    condition: StartCondition = StartCondition()
    time: float = 0.0

    def after(self, delay: float) -> Moment:
        """Return a later moment."""
        condition = replace(self.condition, delay=self.condition.delay + max(delay, 0.0))
        return Moment(condition, self.time + max(delay, 0.0))


def planner_or_none() -> LaunchPlanner | None:
    """Return the planner of the launch file that is executed; None if no launch file is executed."""
    task = current_task()
    planner: LaunchPlanner | None = None if task is None else task.program.data.get("launch planner")
    return planner


def current_planner() -> LaunchPlanner:
    """Return the planner of the launch file that is executed.

    Raises:
        RuntimeError: no launch file is executed.
    """
    planner = planner_or_none()
    if planner is None:
        raise RuntimeError("launch descriptions can only be executed by simkit launch")
    return planner


class LaunchPlanner:
    """Execution of one launch file with everything that it includes.

    Args:
        plan: plan that receives the processes.
        packages: packages of the workspace.
        package_paths: folders of packages by name, or workspaces.
        language: functions of the modules that launch files import.

    Attributes:
        plan: plan.
        language: functions of the modules that launch files import.
        program: program that executes the launch file.
        used_names: names of launch configurations that something has read.
        loggers: loggers by name.
        lifecycle_nodes: actions that start nodes with states.
        declared: declared arguments by name.
        usual_variables: variables of the environment that are not set, with their usual values.
    """

    def __init__(
        self, plan: LaunchPlan, packages: LaunchPackages, package_paths: PackagePaths, language: LaunchLanguage
    ) -> None:
        self.plan, self._packages, self._package_paths = plan, packages, package_paths
        self.language = language
        self.program: LaunchProgram
        self.used_names: set[str] = set()
        self.loggers: dict[str, Logger] = {}
        self.lifecycle_nodes: list[Any] = []
        self.declared: dict[str, DeclaredArgument] = {}
        self.usual_variables = {name: value for name, value in USUAL_VALUES.items() if name not in os.environ}
        self._moment = Moment()
        self._queue: list[tuple[float, int, Moment, Callable[[], Any], Context]] = []
        self._count = self._events = 0
        self._environment: dict[str, str] = {}
        self._service_context: Any = None
        self._places: list[Where] = []
        self._depth = self._included = 0
        self._begun = 0.0
        self._outputs: dict[object, str] = {}
        self._moved: dict[Path, Path | None] = {}

    # ------------------------------------------------------------------ execution

    def begin(self) -> None:
        """Note the environment before the launch file changes it."""
        self.program.data["launch planner"] = self
        self._begun = time.time()
        self.program.builtins["open"] = self._open
        os.environ["PATH"] = os.pathsep.join((os.environ.get("PATH", os.defpath), str(self._found_commands())))
        self._environment = dict(os.environ)

    def _found_commands(self) -> Path:
        """Return a folder with the commands that launch files search; none of them is run."""
        folder = self.folder / "bin"
        for name in _FOUND_COMMANDS:
            write_shared_file(folder / name, _XACRO.format(sys.executable) if name == "xacro" else _COMMAND, 0o700)
        return folder

    def _open(self, file: Any, mode: str = "r", *args: Any, **options: Any) -> IO[Any]:
        """Open a file, as `open` does; one that a build installs elsewhere is found in its source tree."""
        if isinstance(file, (str, os.PathLike)) and not set(mode) & set("wax+"):
            path = self.source_of(Path(os.fspath(file)))
            file = file if path == Path(os.fspath(file)) else path
        return open(file, mode, *args, **options)

    def service_context(self, argv: list[str]) -> Any:
        """Return the context of a `LaunchService`; all services of a launch file share it."""
        if self._service_context is None:
            self._service_context = self.language.new_context()
            self._service_context.launch_configurations.update(self.plan.arguments)
        self._service_context.argv[:] = argv
        return self._service_context

    def execute(self, entity: Any, context: Context) -> None:
        """Execute an item, then what happens after it."""
        self._visit(entity, context)
        while self._queue:
            _, _, moment, function, context = heapq.heappop(self._queue)
            self._moment = moment
            context.push_locals()
            try:
                for each in function() or ():
                    self._visit(each, context)
            finally:
                context.pop_locals()
        self._moment = Moment()

    def _visit(self, entity: Any, context: Context) -> None:
        where = getattr(entity, "where", None)
        if not hasattr(entity, "visit"):
            text = f"found {entity!r:.60} among the actions of a launch description; expected an action"
            raise LaunchFileError(FAILED, text, self.place, "remove it")
        if isinstance(where, Where):
            self._places.append(where)
        for each in entity.visit(context) or ():
            self._visit(each, context)
        if isinstance(where, Where):
            self._places.pop()

    def _schedule(self, moment: Moment, function: Callable[[], Any], context: Context) -> None:
        self._events += 1
        if self._events > _MOST_EVENTS:
            text = f"the event handlers of the launch file start more than {_MOST_EVENTS} events"
            raise LaunchFileError(FAILED, text, self.place, "let the handlers end")
        heapq.heappush(self._queue, (moment.time, self._events, moment, function, context))

    @property
    def place(self) -> Where:
        """Place of the action that is executed; of the include for a file of simkit."""
        for where in reversed(self._places):
            if where.file is not None and not is_shipped_file(where.file):
                return where
        return self._places[-1] if self._places else NOWHERE

    # ------------------------------------------------------------------ events

    @property
    def moment(self) -> Moment:
        """Moment of the action that is executed."""
        return self._moment

    def handle(self, event: Any, context: Context, moment: Moment) -> None:
        """Call the handlers of an event, at a moment."""

        def run() -> None:
            for handler in context.event_handlers():
                if handler.matches(event):
                    context.push_locals()
                    try:
                        for each in _items(handler.handle(event, context)):
                            self._visit(each, context)
                    finally:
                        context.pop_locals()

        self._schedule(moment, run, context)

    def call(self, function: Callable[[], Iterable[Any] | None], context: Context, moment: Moment) -> None:
        """Call a function at a moment, and execute what it returns."""
        self._schedule(moment, function, context)

    def shut_down(self, where: Where) -> None:
        """Let the run end at the present moment."""
        condition = self._moment.condition
        if condition.event == "exit" and not condition.delay:
            at = condition.process - 1
            self.plan.processes[at] = replace(self.plan.processes[at], ends_run=True)
        else:
            self.add({"kind": "shutdown"}, where)

    # ------------------------------------------------------------------ processes

    @property
    def next_number(self) -> int:
        """Number of the next process."""
        return len(self.plan.processes) + 1

    def add(
        self, fields: Mapping[str, Any], where: Where, environment: Mapping[str, str] | None = None
    ) -> LaunchedProcess:
        """Add a process that starts at the present moment.

        Args:
            fields: fields of the process.
            where: place in the launch file.
            environment: all variables of the environment; None for those of simkit.
        """
        if len(self.plan.processes) >= _MOST_PROCESSES:
            text = f"the launch file starts more than {_MOST_PROCESSES} processes"
            raise LaunchFileError(FAILED, text, where, "an event handler may start itself for ever")
        words = fields.get("arguments", ())
        arguments = tuple(
            str(run_file_of(self.source_of(Path(w)), self._begun)) if w.startswith("/") else w for w in words
        )
        before = self._environment
        changed = {name: value for name, value in (environment or {}).items() if before.get(name) != value}
        process = LaunchedProcess(
            number=self.next_number,
            condition=self._moment.condition,
            environment=dict(sorted(changed.items())),
            where=self.shown_place(where),
            **{**fields, "arguments": arguments},
        )
        self.plan.processes.append(process)
        return process

    def started(self, process: LaunchedProcess) -> Moment:
        """Return the moment of the start of a process that is added now."""
        return Moment(StartCondition("start", process.number), self._moment.time)

    def ended(self, process: LaunchedProcess) -> Moment:
        """Return the moment of the end of a process that is added now."""
        return Moment(StartCondition("exit", process.number), self._moment.time + _FOREVER)

    @contextmanager
    def at(self, moment: Moment) -> Iterator[None]:
        """Execute what is inside at another moment."""
        before, self._moment = self._moment, moment
        try:
            yield
        finally:
            self._moment = before

    # ------------------------------------------------------------------ arguments

    def declare(self, argument: DeclaredArgument) -> None:
        """Note a declared argument."""
        self.declared.setdefault(argument.name, argument)

    def check_arguments(self, declared: Iterable[DeclaredArgument], given: Container[str]) -> None:
        """Check that all arguments without a default value are given.

        Raises:
            LaunchFileError: SK-LAUNCH-004 some are not given.
        """
        missing = [each for each in declared if each.default is None and each.name not in given]
        if not missing:
            return
        names = [f"{each.name} ({each.description})" if each.description else each.name for each in missing]
        text = f"the launch file needs the argument{'s' if len(names) > 1 else ''} {', '.join(names)}"
        values = " ".join(f"{each.name}:=…" for each in missing)
        raise LaunchFileError(MISSING_ARGUMENT, text, self.shown_place(missing[0].where), f"give {values}")

    # ------------------------------------------------------------------ files and packages

    @property
    def folder(self) -> Path:
        """Folder of the files that are written for the run."""
        return folder_of_written_files()

    def write_file(self, name: str, suffix: str, text: str) -> Path:
        """Write a file for the run; the same text has the same path, so that runs can be compared."""
        return write_run_file(name, suffix, text)

    def share_folder(self, package: str) -> Path:
        """Return the folder with the files of a package; a placeholder, with a warning, if it is not there."""
        return self._packages.folder(package, self.calling_place())

    def source_of(self, path: Path) -> Path:
        """Return the file of the source tree that a build would install at a path.

        For a path of another computer it is the file of the workspace with the same end, with a warning.
        """
        file = self._packages.source_of(path)
        if file.exists() or missing_package_of(file):
            return file
        if file not in self._moved:
            self._moved[file] = self._packages.moved_file(file)
            if self._moved[file] is not None:
                text = f"there is no file {file}; {self._moved[file]} is used"
                hint = "let the launch file find it with get_package_share_directory"
                self.plan.diagnostics.warning(MOVED_FILE, text, self.calling_place(), hint)
        return self._moved[file] or file

    def calling_place(self) -> Where:
        """Return the innermost line of the launch file that is executed; else that of the action."""
        return self.shown_place(calling_place())

    def shown_place(self, where: Where) -> Where:
        """Return a place in a file of the user: that of the include for a file of simkit."""
        return self.place if where.file is None or is_shipped_file(where.file) else where

    def command_output(self, words: list[str]) -> str:
        """Return the output of a command; empty, with a warning, if it is left out.

        A launch file often expands one description for several nodes, so outputs are stored.
        """
        if words[:3] == ["ros2", "param", "get"] and (value := self._parameter_value(words[3:])) is not None:
            return value
        key = (tuple(words), tuple(sorted(os.environ.items())))
        if key not in self._outputs:
            words = [str(self.source_of(Path(word))) if word.startswith("/") else word for word in words]
            place, diagnostics = self.calling_place(), self.plan.diagnostics
            self._outputs[key] = command_output(words, place, diagnostics, self._package_paths) or ""
        return self._outputs[key]

    def _parameter_value(self, words: list[str]) -> str | None:
        """Return the value that the launch file gives to a parameter of a node it starts; None for another parameter.

        Args:
            words: words after `ros2 param get`: options, the node and the parameter.
        """
        names = [word for word in words if not word.startswith("-")]
        for process in reversed(self.plan.processes):
            full_name = f"{process.namespace.rstrip('/')}/{process.name or process.executable}"
            if process.kind != "node" or len(names) != 2 or full_name != f"/{names[0].lstrip('/')}":
                continue
            tables = (table for table in reversed(process.parameters) if not isinstance(table, Path))
            value = next((table[names[1]] for table in tables if names[1] in table), None)
            if value is not None:
                return str(value)
        return None

    def parameter_file(self, path: Path, where: Where) -> Path | None:
        """Return the absolute path of a file of parameters; None, with a warning, if it does not exist."""
        file = self.source_of(Path(os.path.abspath(path)))  # noqa: PTH100 - without symbolic links
        if file.is_file():
            return run_file_of(file, self._begun)
        package = missing_package_of(path)
        reason = f"the package {package!r} is not there" if package else "there is no such file"
        self.warn_left_out(f"the parameters of {path} are left out: {reason}", where)
        return None

    def warn_left_out(self, text: str, where: Where, hint: str = "") -> None:
        """Report that something is left out."""
        self.plan.diagnostics.warning(LEFT_OUT, text, self.shown_place(where), hint)

    def has_launch_file(self, path: Path, where: Where) -> bool:
        """Check whether the file of an include exists, and report if it does not."""
        if self.source_of(path).is_file():
            return True
        package = missing_package_of(path)
        name = "/".join((package, path.name)) if package else str(path)
        reason = f"the package {package!r} is not there" if package else "there is no such file"
        self.warn_left_out(f"the launch file {name} is not included: {reason}", where)
        return False

    def inside(self, description: Any, where: Where, leave: Callable[[], None]) -> Iterator[Any]:
        """Return an included description, and count how deep includes are while it is executed.

        Args:
            description: launch description.
            where: place of the include.
            leave: function that is called after its execution.
        """
        if self._depth >= _MOST_LEVELS:
            text = "launch files include each other without an end"
            raise LaunchFileError(FAILED, text, self.shown_place(where), "remove the include, or give it a condition")
        self._included += 1
        if self._included > MOST_INCLUDES:
            text = f"the launch file includes more than {MOST_INCLUDES} files"
            raise LaunchFileError(FAILED, text, self.shown_place(where), "remove repeated includes")
        self._depth += 1
        yield description
        self._depth -= 1
        leave()

    def replace_substitutions(self, text: str, context: Any) -> str:
        """Return a text in which substitutions such as `$(var NAME)` are replaced."""
        return self.language.replace_substitutions(text, context)

    @property
    def program_asyncio(self) -> ModuleType:
        """Module `asyncio` of the program, whose waits end at once."""
        return program_module(self.program, "asyncio")

    def log(self, line: str) -> None:
        """Print a line, and add it to the log of the launch."""
        shown = _CONTROL.sub(lambda match: match[0].encode("unicode_escape").decode(), line)
        self.program.stderr.write(f"{shown}\n")

    # ------------------------------------------------------------------ launch files

    def description_of(self, path: str) -> Any:
        """Return the launch description of a file in Python, XML or YAML."""
        file = self.source_of(Path(os.path.abspath(path)))  # noqa: PTH100 - without symbolic links
        if file.suffix == ".py":
            function = getattr(self.load_module(str(file)), "generate_launch_description", None)
            if function is None:
                text = "the file has no function generate_launch_description()"
                raise LaunchFileError(FAILED, text, Where(str(file)), "name a launch file")
            description = function()
            if not hasattr(description, "entities"):
                text = f"generate_launch_description() returned {description!r:.60}; expected a LaunchDescription"
                raise LaunchFileError(FAILED, text, Where(str(file)), "return LaunchDescription([...])")
            return description
        return self.language.read_description(file)

    def load_module(self, path: str) -> ModuleType:
        """Return a file in Python as a module of the program, without writing compiled files beside it."""
        file = Path(os.path.abspath(path))  # noqa: PTH100 - without symbolic links
        self.program.add_folder(file.parent)
        source = read_input(file, TEXT_LIMIT)
        for number, line in enumerate(source.splitlines(), 1):
            for name in tuple(self.usual_variables):
                if name.encode() in line:
                    self.note_variable(name, Where(str(file), number))
        code = compile(source, str(file), "exec", dont_inherit=True)
        module = ModuleType("python_launch_file")
        vars(module).update(__file__=str(file), __builtins__=self.program.builtins)
        exec(code, vars(module))
        return module

    def note_variable(self, name: str, where: Where) -> None:
        """Note once that a variable of the environment has its usual value."""
        if name in self.usual_variables:
            value = self.usual_variables.pop(name)
            note_usual_value(name, value, self.shown_place(where), self.plan.diagnostics)

    def run_script(self, path: Path) -> None:
        """Execute a file in Python as the module `__main__`.

        Raises:
            LaunchFileError: SK-LAUNCH-002 the file uses no `LaunchService` either.
        """
        self.program.add_folder(path.parent)
        code = compile(read_input_text(path), str(path), "exec", dont_inherit=True)
        try:
            run_as_main(self.program, code, str(path), None)
        except SystemExit as error:
            if error.code:
                raise
        if self._service_context is None:
            text = "the file has neither a function generate_launch_description() nor a LaunchService"
            raise LaunchFileError(FAILED, text, Where(str(path)), "name a launch file")


def _items(entities: Any) -> Iterator[Any]:
    """Return the items of nested sequences."""
    if entities is None:
        return
    if hasattr(entities, "visit"):
        yield entities
        return
    for each in entities:
        yield from _items(each)
