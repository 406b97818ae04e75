"""Program in a process of its own, beside a running simulation: the modules of Python are the real ones."""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Iterable, Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder
from operator import attrgetter
from pathlib import Path
from types import FrameType, ModuleType, SimpleNamespace
from typing import TYPE_CHECKING, Final, cast

from simkit.input_file import TEXT_LIMIT, read_input
from simkit_nodes.host import PROGRAM_OF_PROCESS
from simkit_nodes.node_options import NodeOptions
from simkit_nodes.program_imports import TableLoader, shipped_interfaces, workspace_interfaces
from simkit_nodes.programs import NodeProgram, needs_main, traceback_of_program
from simkit_nodes.ros_modules import ros_module

if TYPE_CHECKING:
    from simkit_nodes.known_nodes import KnownNode
    from simkit_nodes.live_host import LiveHost
    from simkit_nodes.packages import Executable
    from simkit_nodes.tasks import Task

INTERRUPTED: Final = 130
"""Exit code of a program that Ctrl-C has ended."""
_RAISED: Final = 1  # exit code of a program that raised an exception, as of Python


class LiveProgram(NodeProgram):
    """Program of this process.

    Args:
        host: world around the program.
        source: Python file, executable of a ROS package, or known node.
        options: what the command line changes.
    """

    def __init__(self, host: LiveHost, source: Path | Executable | KnownNode, options: NodeOptions) -> None:
        super().__init__(host, source, options)
        self.name = f"{self.name}_{os.getpid()}"  # a part of the anonymous names of ROS 1, which differ in each process
        self.main_task = cast("Task", SimpleNamespace(frame=None, is_ending=False))

    def execute(self) -> int:
        """Run the program in the main thread; return the exit code of the process."""
        PROGRAM_OF_PROCESS[:] = [self]
        sys.argv = self.process.argv
        sys.path[:0] = self.process.search_path
        sys.meta_path.insert(0, LiveFinder(self))
        try:
            self._run_main()
        except SystemExit as error:
            if isinstance(error.code, str):
                sys.stderr.write(f"{error.code}\n")
                return _RAISED
            return error.code if isinstance(error.code, int) else int(error.code is not None)
        except BaseException as error:  # noqa: BLE001 - a program may raise anything
            return self._print_exception(error)
        finally:
            self._join_threads()
            self.call_exit_functions()
        return 0

    def _execute_file(self, file: Path) -> None:
        """Execute the file as the module `__main__`, and call its function `main` if nothing else does."""
        source = read_input(file, TEXT_LIMIT)
        code = compile(source, str(file), "exec", dont_inherit=True)
        if self._package:
            __import__(self._package)
        module = sys.modules["__main__"] = ModuleType("__main__")
        names = vars(module)
        names.update(__file__=str(file), __package__=self._package, __builtins__=__builtins__)
        exec(code, names)
        if needs_main(source) and callable(names.get("main")):
            names["main"]()

    def _run_main(self) -> None:
        if self._executable is not None and self._executable.function:
            __import__(self._executable.module)
            raise SystemExit(attrgetter(self._executable.function)(sys.modules[self._executable.module])())
        if isinstance(self._source, Path):
            self._execute_file(self._source)
        else:
            self._source()

    def _print_exception(self, error: BaseException) -> int:
        """Print the traceback of the program, unless it was ended because the simulation has ended."""
        is_interrupt = isinstance(error, KeyboardInterrupt)
        host = cast("LiveHost", self.host)
        if host.closed is None or not (is_interrupt or self._is_raised_by_modules(error)):
            if is_interrupt:
                self._cut_traceback(error)
            sys.stderr.write("".join(traceback_of_program(error).format()))
        return INTERRUPTED if is_interrupt else _RAISED

    def _is_raised_by_modules(self, error: BaseException) -> bool:
        """Check whether an exception comes from a module for programs, as after the end of the communication.

        The module may have called another one, such as `socket`, which raised the exception.
        """
        is_raised = False
        trace = error.__traceback__
        while trace is not None:
            frame, trace = trace.tb_frame, trace.tb_next
            if self.has_folder(str(Path(frame.f_code.co_filename).parent)):
                is_raised = False
            else:
                is_raised |= str(frame.f_globals.get("__name__", "")).startswith(("simkit.", "simkit_nodes."))
        return is_raised

    def _cut_traceback(self, error: BaseException) -> None:
        """Remove the frames after the last line of the program: Ctrl-C has interrupted it there."""
        trace, last = error.__traceback__, None
        while trace is not None:
            if self.has_folder(str(Path(trace.tb_frame.f_code.co_filename).parent)):
                last = trace
            trace = trace.tb_next
        if last is not None:
            last.tb_next = None

    def _join_threads(self) -> None:
        """Wait for the threads of the program that are no daemons, as Python does at its end."""
        for thread in threading.enumerate():
            if thread is not threading.current_thread() and not thread.daemon:
                thread.join()

    # ------------------------------------------------------------------ what the modules of ROS use

    def write_log(self, lines: Iterable[str]) -> None:
        """Print lines of the log."""
        sys.stderr.write("".join(f"{line}\n" for line in lines))
        sys.stderr.flush()

    def tell(self, code: str, frame: FrameType | None = None, *values: str) -> None:
        """Do nothing: a program in its own process is not repeatable anyway."""


class LiveFinder(MetaPathFinder):
    """Finder of the modules with the names of ROS, for the program of this process.

    The program's own folders come first, then the modules of ROS and the interfaces that simkit has, then the search
    path, and then the packages of the program's workspace.

    Args:
        program: program.
    """

    def __init__(self, program: LiveProgram) -> None:
        self._program = program

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the specification of a module of ROS or of the workspace; None for any other module."""
        program = self._program
        if path is None and _imports_for_simkit():
            return None
        if _is_module(name, program.process.search_path if path is None else path):
            return None
        module = None if path else ros_module(name, program.flavour) or shipped_interfaces(program, name)
        if module is None and path is None:
            if name in sys.builtin_module_names or _is_module(name, None):
                return None
            folder = program.workspace.module_folder(name)
            if folder is not None:
                sys.path.append(str(folder))
                return PathFinder.find_spec(name, [str(folder)])
        module = module or workspace_interfaces(program, name)
        if module is None:
            return None
        return ModuleSpec(name, TableLoader(module, program), is_package=hasattr(module, "__path__"))


def _is_module(name: str, folders: Sequence[str] | None) -> bool:
    """Check whether folders, or those of the search path, have a module: a folder needs a file `__init__.py`."""
    spec = PathFinder.find_spec(name, folders)
    return spec is not None and spec.loader is not None


def _imports_for_simkit() -> bool:
    """Check whether a module of simkit imports, which never needs the modules for programs."""
    frame: FrameType | None = sys._getframe(2)
    while frame is not None and frame.f_code.co_filename.startswith("<frozen importlib"):
        frame = frame.f_back
    return frame is not None and str(frame.f_globals.get("__name__", "")).partition(".")[0] in (
        "simkit",
        "simkit_nodes",
    )
