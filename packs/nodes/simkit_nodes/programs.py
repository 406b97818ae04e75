"""Programs: Python files, executables of ROS packages or functions, each with its own modules and its own log."""

from __future__ import annotations

import ast
import os
import signal
import sys
import traceback
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from functools import cached_property
from operator import attrgetter
from pathlib import Path
from random import Random
from types import FrameType, ModuleType
from typing import TYPE_CHECKING, Any, Final, cast

from simkit.argument_checks import check_kind
from simkit.diagnostics import Severity, Where
from simkit.errors import InputError
from simkit.in_process import InProcess
from simkit.input_file import TEXT_LIMIT, read_failure, read_input
from simkit.run_files import PackagePaths
from simkit_nodes.host import current_host
from simkit_nodes.interfaces import ROS1, ROS2, MessageFlavour
from simkit_nodes.known_nodes import KnownNode, known_node
from simkit_nodes.names import RosArguments, RosArgumentsError, UnknownArgumentsError, parse_ros_arguments
from simkit_nodes.node_options import NodeOptions
from simkit_nodes.packages import Executable, executables_of
from simkit_nodes.parameter_overrides import check_parameters, ros1_parameters
from simkit_nodes.process_state import ProcessState
from simkit_nodes.program_imports import ProgramLoader, install_finder, program_builtins, run_as_main, with_imports
from simkit_nodes.program_streams import ProgramInput, ProgramOutput
from simkit_nodes.python2 import refuse_python2
from simkit_nodes.python_modules import program_module
from simkit_nodes.ros_flavour import flavour_of
from simkit_nodes.set_iteration import iterations_over_sets
from simkit_nodes.syntax_tree import parsed
from simkit_nodes.tasks import ProgramEnd, ProgramStuck, line_of
from simkit_nodes.workspace import Workspace

if TYPE_CHECKING:
    from simkit.diagnostics import Diagnostics
    from simkit_nodes.host import Host
    from simkit_nodes.tasks import Task

_OWN_FOLDER: Final = str(Path(__file__).parent)

_IMPORTING: Final = frozenset(
    str(Path(__file__).parent / name)
    for name in ("programs.py", "live_program.py", "program_imports.py", "interfaces/interface_modules.py")
)
"""Files that import the modules of a program; a traceback of Python does not show its own such files either."""

VARIABLES: Final = {
    ROS1: {"ROS_DISTRO": "noetic", "ROS_VERSION": "1", "ROS_MASTER_URI": "http://localhost:11311"},
    ROS2: {"ROS_DISTRO": "jazzy", "ROS_VERSION": "2", "ROS_PYTHON_VERSION": "3"},
}
"""Variables of the environment after ROS is sourced."""

REPORTS: Final[dict[str, tuple[Severity, str, str]]] = {
    "SK-NODE-050": (
        "note",
        "random bytes of the operating system follow from the run's seed here; elsewhere they differ in each run",
        "",
    ),
    "SK-NODE-051": ("warning", "the node uses a socket, which follows wall time; runs may differ", ""),
    "SK-NODE-052": ("warning", "the node starts a process, which follows wall time; runs may differ", ""),
    "SK-NODE-053": ("warning", "the node waits for the keyboard, and nobody types", "give the input with `keys`"),
    "SK-NODE-054": (
        "warning",
        "this depends on the order of a set, which differs between processes for texts",
        "use `sorted(...)`, or set PYTHONHASHSEED",
    ),
    "SK-NODE-055": ("warning", "threads wait for locks of each other: {}", "acquire the locks in the same order"),
    "SK-NODE-056": (
        "error",
        "the node computes for more than {} s without waiting",
        "let the loop wait, such as with time.sleep(0.01), or raise the limit",
    ),
    "SK-NODE-059": (
        "warning",
        "a thread did not end although it was asked to; it waits here for ever",
        "let KeyboardInterrupt pass: write `except Exception:` instead of `except:`",
    ),
    "SK-NODE-058": ("note", "processes of the node run as its threads", ""),
}
"""Severity, text and help of what a program is told, by code."""

_OF_KNOWN_NODES: Final = frozenset(("SK-NODE-053", "SK-NODE-056", "SK-NODE-059"))
"""Codes that are also told of a program in a pack; the user cannot change what the others are about."""


class NodeProgram(InProcess):
    """Program that runs in lock-step; `Simulation.add_node` returns it.

    Args:
        host: world around the program.
        source: Python file, executable of a ROS package, known node, or function.
        options: what the command line changes.

    Attributes:
        name: name of the program, for messages.
        known: known node whose program this is; None for a program of the user.
        file: file of the program; None for a function.
        hand_overs: number of times that the program got its turn.
        restarts: number of times that the program started again, after an exception or an end.
        added_by: program that has added this one during the run; None for one that a script or the run has added.
        begin_ns: simulated time from which a delay of its start is counted [ns].
        started_ns: simulated time of its present start [ns].
        event_ns: simulated times [ns] of its first start and of its first end, by the names in `EVENTS`.
        options: what the command line changes.
        log: lines that the program has logged.
        error: exception that ended the program, SystemExit for an exit code that is not 0; None without one.
        done: True after the end of all its threads.
        exit_code: exit code of the program, such as the argument of `sys.exit`.
        host: world around the program.
        process: values of the process that the program has for itself.
        builtins: built-in names of its modules.
        module_roots: folders of other packages of the workspace from which the program has imported.
        replaced: modules of Python that wait in simulated time, by name.
        data: data of the modules of ROS by module, such as the context of `rclpy`.
        random: generator for everything that Python draws from the operating system.
        stdin, stdout, stderr: standard input and outputs.
        exit_functions: functions of `atexit`, with their arguments.
        signal_handlers: handlers of signals by number.
        on_report: functions that report what is only known at the end of a run, such as topics that never came.
        on_end: functions that are called when the end of the run ends the program, before KeyboardInterrupt is raised.
        is_exiting: True after `os._exit` and after a loop without an end; the program does not wait for its threads.

    Raises:
        InputError: SK-NODE-030 an argument after `--ros-args` is not valid; SK-NODE-031 a file of parameters is not.
    """

    def __init__(
        self,
        host: Host,
        source: Path | Executable | KnownNode | Callable[[], object],
        options: NodeOptions,
        reports: Diagnostics | None = None,
    ) -> None:
        self._executable = source if isinstance(source, Executable) else None
        self.known = source if isinstance(source, KnownNode) else None
        own_name = source.stem if isinstance(source, Path) else str(getattr(source, "__name__", "node"))
        if isinstance(source, Executable):
            source, own_name = source.file, source.name.removesuffix(".py")
        elif isinstance(source, KnownNode):
            own_name = source.executable.removesuffix(".py")
            source = source.file or (_end_at_once if source.ends else _wait_for_end)
        self.host, self._source, self.options, self._reports = host, source, options, reports
        self.name: str = options.name or own_name
        self.file = source if isinstance(source, Path) else None
        self.hand_overs = self.restarts = self.begin_ns = self.started_ns = 0
        self.event_ns: dict[str, int] = {}
        self.added_by: NodeProgram | None = None
        self.log: list[str] = []
        self.error: BaseException | None = None
        self.done = False
        self.exit_code = 0
        self.prepare()
        if self.known is not None and self.known.nothing:
            return  # what it does not read need not be valid
        if self.flavour is ROS2:
            check_parameters(self.ros_arguments)
            self._check_rules()
        else:
            ros1_parameters(self.ros_arguments)

    def prepare(self) -> None:
        """Make the program as new, before its start."""
        self.log.clear()
        self.error, self.done, self.is_exiting, self.exit_code = None, False, False, 0
        file = str(self._source) if isinstance(self._source, Path) else self.name
        if self.known is not None:
            file = self.known.name  # one program may stand for several executables
        is_own = isinstance(self._source, Path) and self.known is None
        self._root, self._package = _package_of(cast("Path", self._source)) if is_own else (None, None)
        folders = [str(self._source.parent)] if isinstance(self._source, Path) else []
        if self._root is not None:
            folders.insert(0, str(self._root))  # before a module beside the file that has the name of the package
        if self._executable is not None and self._executable.root is not None:
            folders = [str(self._executable.root)]  # as after an installation, without the folder of the module
        seed = self.host.seed_of(self.name)
        self.random = Random(seed)
        self.stdin = ProgramInput(self, self.options.keys)
        self.stdout, self.stderr = ProgramOutput(self.log, "stdout"), ProgramOutput(self.log, "stderr")
        streams = self.stdin, self.stdout, self.stderr
        self._folders = folders
        is_ros1 = self.flavour is ROS1  # programs of ROS 1 do not know `--ros-args`
        argv = [file, *(self.ros_arguments.others if is_ros1 else self.options.args)]
        variables = {**VARIABLES[self.flavour], "AMENT_PREFIX_PATH": str(self.workspace.install_folder)}
        self.process = ProcessState(argv, folders, streams, variables, seed)
        self.process.change(self.options.env, self.options.cwd)
        self.module_roots: list[str] = []
        self.replaced: dict[str, ModuleType] = {}
        self.data: dict[str, Any] = {}
        self.exit_functions: list[tuple[Callable[..., object], tuple[Any, ...], dict[str, Any]]] = []
        self.signal_handlers: dict[int, Any] = {}
        self.on_report: list[Callable[[], object]] = []
        self.on_end: list[Callable[[], object]] = []
        self._interrupts = 0
        self._told: set[tuple[str, str]] = set()
        self.builtins = program_builtins(self)
        install_finder()

    @property
    def label(self) -> str:
        """Name of the program in the conditions of others."""
        return self.options.label or self.name

    @property
    def is_started(self) -> bool:
        """True after the condition for the start of the program has held."""
        return "start" in self.event_ns

    @property
    def awaited(self) -> str:
        """Text of the event for which a program that has not started waits; empty after its start."""
        if self.is_started or not (self.options.after or self.options.delay):
            return ""
        delay = [f"{self.options.delay:g} s"] if self.options.delay else []
        events = [f"the {event} of {label}" for event, label in self.options.after.items()]
        return " and ".join((*events, *delay)) if events else f"{delay[0]} of simulated time"

    @property
    def failure(self) -> str:
        """Name of the program, with the place and the text of the exception that ended it, or its exit code."""
        error = self.error
        if error is None:
            return ""
        if isinstance(error, SystemExit):
            return f"{self.name!r} ended with exit code {self.exit_code}"
        if isinstance(error, InputError) and self.known is not None:  # a mistake of the user that it has found
            return f"{self.name!r} failed: {error}"
        frames = traceback.extract_tb(without_simkit(error))
        inside = [frame for frame in frames if self.has_folder(os.path.dirname(frame.filename))]  # noqa: PTH120
        place = f" at {inside[-1].filename}:{inside[-1].lineno}" if inside else ""
        owner = f" (a program of the pack {self.known.pack})" if self.known is not None else ""
        return f"{self.name!r}{owner} raised {type(error).__name__}{place}: {error}".removesuffix(": ")

    def has_folder(self, folder: str) -> bool:
        """Check whether a folder belongs to the program."""
        roots = (*self.process.search_path, *self.module_roots)
        return any(folder == root or folder.startswith(root + os.sep) for root in roots)

    @cached_property
    def workspace(self) -> Workspace:
        """ROS workspace around the program's file; around the present folder for a function or a known node."""
        is_own = isinstance(self._source, Path) and self.known is None
        folder = cast("Path", self._source).parent if is_own else Path.cwd()
        return shared_workspace(self.host.graph.shared, folder, self.options.package_paths)

    @cached_property
    def flavour(self) -> MessageFlavour:
        """ROS for which the program is written: it decides the modules and the classes of messages that it gets."""
        return ROS1 if flavour_of(self._source, self._folders) == "ros1" else ROS2

    @cached_property
    def ros_arguments(self) -> RosArguments:
        """Arguments after `--ros-args`; a program for ROS 2 reads them itself again.

        Raises:
            InputError: SK-NODE-030 one of them is not valid.
        """
        try:
            return parse_ros_arguments(self.options.args)
        except RosArgumentsError as error:
            unknown = "unknown arguments after --ros-args: " if isinstance(error, UnknownArgumentsError) else ""
            text = f"{self.name}: {unknown}{error}"
            raise InputError("SK-NODE-030", text, help="for example --ros-args -r a:=b -p speed:=0.2") from None

    def _check_rules(self) -> None:
        try:
            self.options.rules()
        except RosArgumentsError as error:
            raise InputError("SK-NODE-030", f"{self.name}: {error}") from None

    def package_folder(self, name: str) -> Path | None:
        """Return the folder of a ROS package; None for an exception in the program."""
        return self.workspace.package(name)

    def source_loader(self, name: str, path: str | os.PathLike[str]) -> ProgramLoader:
        """Return a loader of a Python file as a module of the program."""
        loader = ProgramLoader(name, os.fspath(path))
        loader.program = self
        return loader

    # ------------------------------------------------------------------ start and end

    def run(self) -> None:
        """Run the program as Python does: its main function, then its threads and the functions for its end."""
        threading = program_module(self, "threading")
        try:
            self._run_main()
        except SystemExit as error:
            self._note_exit(error)
        except (ProgramEnd, ProgramStuck):
            raise
        except BaseException as error:  # noqa: BLE001 - a program may raise anything
            self.meet(self.main_task, error)
        if not self.is_exiting:
            threading._shutdown()
            self.call_exit_functions()

    def _run_main(self) -> None:
        if not isinstance(self._source, Path):
            with_imports(self, self._source)()
            return
        if self._executable is not None and self._executable.function:
            self.builtins["__import__"](self._executable.module)
            raise SystemExit(attrgetter(self._executable.function)(sys.modules[self._executable.module])())
        file = str(self._source)
        source = read_input(self._source, TEXT_LIMIT)
        code = compile(source, file, "exec", dont_inherit=True)
        if self._package:
            self.builtins["__import__"](self._package)
        module = run_as_main(self, code, file, self._package)
        if needs_main(source):
            function = vars(module).get(self.workspace.entry_function(self._source))
            if callable(function):
                function()

    def _note_exit(self, error: SystemExit) -> None:
        if isinstance(error.code, str):
            self.write_log([error.code])
        self.note_exit(int(error.code) if isinstance(error.code, int) else int(error.code is not None))

    def note_exit(self, code: int) -> None:
        """Store the exit code of the program; one that is not 0 is an error, unless the end of the run ends it."""
        self.exit_code = code
        if code and not self.main_task.is_ending:
            self.error = self.error or SystemExit(code)

    def call_exit_functions(self) -> None:
        """Call the functions that the program has registered with `atexit`, the last one first."""
        while self.exit_functions:
            function, args, kwargs = self.exit_functions.pop()
            try:
                function(*args, **kwargs)
            except Exception as error:  # noqa: BLE001 - a program may raise anything
                self.meet(self.main_task, error)

    def interrupt(self, task: Task) -> None:
        """End a thread where it waits, as Ctrl-C does for the main thread.

        A handler of SIGINT that the program has set is called instead at first; the thread then continues.

        Raises:
            KeyboardInterrupt: for the main thread.
            ProgramEnd: for other threads.
        """
        if task is not self.main_task or self.is_exiting:
            raise ProgramEnd
        self._interrupts += 1
        if self._interrupts == 1:
            for function in self.on_end:
                function()
        handler = self.signal_handlers.get(signal.SIGINT, signal.default_int_handler)
        if self._interrupts > 1 or handler is signal.default_int_handler or not callable(handler):
            raise KeyboardInterrupt
        handler(int(signal.SIGINT), task.frame)

    def meet(self, task: Task, error: BaseException) -> None:
        """Store an exception that ended a thread of the program, and print its traceback.

        An exception of a thread that the end of the run has ended is only printed: many programs shut down twice there.
        """
        if task.is_ending and isinstance(error, (KeyboardInterrupt, ProgramStuck)):
            return
        if not task.is_ending:
            self.error = self.error or error
        if isinstance(error, InputError):  # a mistake in the command line, not in the program
            lines = [f"error: {error}"]
        else:
            lines = list(traceback_of_program(error).format())
        self.write_log("".join(lines).splitlines())

    def meet_stuck(self, task: Task, limit: float) -> None:
        """Store that a thread has computed for too long [s, wall time]; the program then ends."""
        self.is_exiting = True
        text = f"{line_of(self._own_frame(task.frame))}: computes for more than {limit:g} s without waiting"
        self.error = self.error or RuntimeError(text)
        self.write_log([text])
        self.tell("SK-NODE-056", task.frame, f"{limit:g}")

    # ------------------------------------------------------------------ input, output, reports

    def read_input(self, prompt: object = "") -> str:
        """Read a line of the standard input, as `input` does.

        Raises:
            EOFError: the input has ended.
        """
        sys.stdout.write(str(prompt))
        line = sys.stdin.readline()
        if not line:
            raise EOFError("the input of the program has ended")
        return line.removesuffix("\n")

    def write_log(self, lines: Iterable[str]) -> None:
        """Add lines to the log and print them."""
        for line in lines:
            self.stderr.write(f"{line}\n")

    def tell(self, code: str, frame: FrameType | None = None, *values: str) -> None:
        """Report once for each line that something in the program is not as it is elsewhere.

        Args:
            code: code of the report.
            frame: frame with the line; None for the calling thread.
            values: values in the text.
        """
        if self.known is not None:
            if code in _OF_KNOWN_NODES:
                self._tell_line(code, "", 0, *values)
            return
        frame = self._own_frame(frame or sys._getframe(1))
        place = (frame.f_code.co_filename, frame.f_lineno) if frame is not None else (str(self.file or ""), 0)
        self._tell_line(code, *place, *values)

    def _tell_line(self, code: str, file: str, line: int, *values: str) -> None:
        if (code, f"{file}:{line}") in self._told:
            return
        self._told.add((code, f"{file}:{line}"))
        severity, text, help_ = REPORTS[code]
        if self._reports is not None:
            where = Where(file or None, line or None)
            self._reports.add(severity, code, f"{self.name}: {text.format(*values)}", where, help_)

    def note_source(self, file: str) -> None:
        """Report what can be seen in a file of the program: loops over sets."""
        if self._reports is None or self.known is not None:
            return
        if self.has_folder(os.path.dirname(file)):  # noqa: PTH120 - it may be of any kind
            for line in iterations_over_sets(read_input(file, TEXT_LIMIT)):
                self._tell_line("SK-NODE-054", file, line)

    def note_deadlock(self, tasks: list[Task]) -> None:
        """Report threads that wait for locks of each other."""
        places = [f"{task.name} at {line_of(self._own_frame(task.frame))}" for task in tasks]
        self.tell("SK-NODE-055", tasks[0].frame, ", ".join(places))

    def _own_frame(self, frame: FrameType | None) -> FrameType | None:
        """Return the innermost frame in a file of the program; the given one if there is none."""
        inner = frame
        while inner is not None:
            file = inner.f_code.co_filename
            if file == str(self.file) or self.has_folder(os.path.dirname(file)):  # noqa: PTH120 - it may be of any kind
                return inner
            inner = inner.f_back
        while frame is not None and frame.f_code.co_filename.startswith(_OWN_FOLDER):
            frame = frame.f_back
        return frame

    main_task: Task


def _package_of(file: Path) -> tuple[Path | None, str | None]:
    """Return the folder of the outermost package around a file, and the dotted name of the innermost one."""
    folder = file.parent
    names: list[str] = []
    while (folder / "__init__.py").is_file():
        names.insert(0, folder.name)
        folder = folder.parent
    return (folder, ".".join(names)) if names else (None, None)


def needs_main(source: bytes) -> bool:
    """Check whether a file only defines functions, one of which the entry point of its package calls.

    Args:
        source: text of the file.
    """
    for node in _nodes_outside_functions(parsed(source)):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load) and node.id == "main":
            return False
        if isinstance(node, ast.Constant) and node.value == "__main__":
            return False
    return True


def _nodes_outside_functions(tree: ast.AST) -> Iterator[ast.AST]:
    for node in ast.iter_child_nodes(tree):
        yield node
        if not isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)):
            yield from _nodes_outside_functions(node)


def traceback_of_program(error: BaseException) -> traceback.TracebackException:
    """Return the traceback of an exception from the program's first line on, without simkit's imports."""
    report = traceback.TracebackException(type(error), error, without_simkit(error))
    part: traceback.TracebackException | None = report
    while part is not None:
        frames = [frame for frame in part.stack if frame.filename not in _IMPORTING]
        part.stack = traceback.StackSummary.from_list(frames) if frames else None  # type: ignore[assignment]
        part = part.__cause__ or part.__context__
    return report


def without_simkit(error: BaseException) -> Any:
    """Return the traceback of an exception from the program's first line on."""
    trace = error.__traceback__
    while trace is not None and trace.tb_frame.f_code.co_filename.startswith(_OWN_FOLDER) and trace.tb_next is not None:
        trace = trace.tb_next
    return trace


def shared_workspace(shared: dict[str, object], folder: Path, package_paths: PackagePaths) -> Workspace:
    """Return the ROS workspace around a folder; many programs come from one workspace, which is searched once.

    Args:
        shared: data that all programs of a simulation share, by name.
        folder: folder.
        package_paths: folders of ROS packages by name, or workspaces.
    """
    name = f"workspace around {folder}"
    if name not in shared:
        shared[name] = Workspace(folder, package_paths)
    return cast("Workspace", shared[name])


def program_source(
    program: str | os.PathLike[str], package_paths: PackagePaths, shared: dict[str, object] | None = None
) -> Path | Executable | KnownNode:
    """Return the Python file of a program, the executable of a ROS package, or the known node in its place.

    Args:
        program: file, or `PACKAGE/EXECUTABLE` of a workspace around the present folder or in `package_paths`, or of a
            known node.
        package_paths: folders of ROS packages by name, or workspaces.
        shared: data that all programs of a simulation share, by name.

    Raises:
        InputError: SK-NODE-001 there is no such file, or it cannot be read; SK-NODE-060 there is no such package;
            SK-NODE-061 the package has no such executable; SK-NODE-041 it is written for Python 2.
    """
    check_kind(program, (str, os.PathLike), "program", "a path, PACKAGE/EXECUTABLE or a function")
    path = Path(program)
    if path.is_file():
        try:
            refuse_python2(path)
        except OSError as error:
            raise InputError("SK-NODE-001", f"{path}: cannot be read: {read_failure(error)}") from None
        return path.resolve()
    text = os.fspath(program)
    package, slash, name = text.partition("/")
    if slash and package and name and "/" not in name:
        workspace = shared_workspace({} if shared is None else shared, Path.cwd(), package_paths)
        folder = workspace.package(package)
        known = known_node(text)
        if known is not None and (folder is None or name not in executables_of(folder)):
            return known
        if path.suffix != ".py" or folder is not None:
            return workspace.executable(package, name)
    problem = f"{text!r} is a folder" if text and path.is_dir() else f"no program {text!r}"
    raise InputError("SK-NODE-001", problem, help="name a Python file, or PACKAGE/EXECUTABLE of a ROS workspace")


def _wait_for_end() -> None:
    """Wait until the end of the run or Ctrl-C, in place of a program that has no effect."""
    with suppress(KeyboardInterrupt):
        current_host().wait()


def _end_at_once() -> None:
    """Do nothing, in place of a program that has no effect and ends."""
