"""Reading of launch files: the plan of what they start, and the arguments that they declare."""

from __future__ import annotations

import os
import re
import sys
import traceback
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final

from simkit.diagnostics import Diagnostics, Where, name_hint
from simkit.errors import InputError, LoadError
from simkit.input_file import TEXT_LIMIT, read_input
from simkit.packs import is_shipped_file
from simkit.run_files import PackagePaths
from simkit_launch.frontends.ros2_files import read_description
from simkit_launch.frontends.roslaunch import read_roslaunch, roslaunch_arguments
from simkit_launch.frontends.roslaunch_elements import is_roslaunch_file
from simkit_launch.frontends.substitution_text import parse_substitutions
from simkit_launch.launch_environment import SEARCH_VARIABLES, USUAL_VALUES, environment_folders
from simkit_launch.launch_modules.launch.actions import IncludeLaunchDescription
from simkit_launch.launch_modules.launch.launch_context import LaunchContext
from simkit_launch.launch_modules.launch.launch_description_source import AnyLaunchDescriptionSource
from simkit_launch.launch_modules.launch.utilities import perform_substitutions
from simkit_launch.launch_packages import LaunchPackages, missing_package_of
from simkit_launch.launch_plan import DeclaredArgument, LaunchPlan
from simkit_launch.launch_program import LaunchProgram, PlanningHost
from simkit_launch.planner import FAILED, LaunchFileError, LaunchLanguage, LaunchPlanner
from simkit_nodes.workspace import Workspace

NO_FILE: Final = "SK-LAUNCH-001"
UNKNOWN_ARGUMENT: Final = "SK-LAUNCH-005"

_NO_CONFIGURATION: Final = re.compile(r"launch configuration '(\w+)' does not exist")
_ENDINGS: Final = (".launch.py", "_launch.py", ".py", ".xml", ".yaml", ".yml", ".launch")


def find_launch_file(package: str, name: str, package_paths: PackagePaths = ()) -> Path:
    """Return the path of a launch file.

    Args:
        package: package that has the file, in any of its folders; empty for a path.
        name: name of the file, or a path.
        package_paths: folders of packages by name, or workspaces.

    Raises:
        InputError: SK-LAUNCH-001 there is no such file; SK-NODE-060 there is no such package.
    """
    if not package:
        path = Path(name)
        if path.is_file():
            return path.resolve()
        problem = f"{name!r} is a folder" if path.is_dir() else f"no launch file {name!r}"
        raise InputError(NO_FILE, problem, help="name a file, or a package and one of its launch files")
    folder = Workspace(Path.cwd(), package_paths).required_package(package)
    files = [file for file in sorted(folder.rglob("*")) if file.name.endswith(_ENDINGS) and file.is_file()]
    found = [file for file in files if name in (file.name, file.relative_to(folder).as_posix())]
    if found:
        return min(found, key=lambda file: (len(file.parts), file)).resolve()
    names = [file.name for file in files if file.parent.name == "launch" or "launch" in file.name]
    raise InputError(NO_FILE, f"package {package!r} has no launch file {name!r}; {name_hint(name, names)}")


def read_launch_file(
    file: Path, arguments: Mapping[str, str], package_paths: PackagePaths = (), *, strict: bool = False
) -> LaunchPlan:
    """Execute a launch file, and return the plan of everything that it starts.

    A file in Python is executed with the rights of the user. Its own changes of the environment and its imports end
    with it.

    Args:
        file: launch file.
        arguments: values of its arguments by name.
        package_paths: folders of packages by name, or workspaces, besides the one around the file.
        strict: treat what is left out as an error.

    Raises:
        LoadError: the launch file has errors; or `strict` is set and something is left out.
    """
    if is_roslaunch_file(file):
        return read_roslaunch(Path(os.path.abspath(file)), arguments, package_paths, strict=strict)  # noqa: PTH100
    return _Reading(file, arguments, package_paths).plan(strict)


def declared_arguments(
    file: Path, arguments: Mapping[str, str] | None = None, package_paths: PackagePaths = ()
) -> list[DeclaredArgument]:
    """Return the arguments that a launch file declares, and those of the files that it includes.

    Args:
        file: launch file.
        arguments: values of its arguments by name.
        package_paths: folders of packages by name, or workspaces, besides the one around the file.

    Raises:
        LoadError: the launch file has errors.
    """
    if is_roslaunch_file(file):
        return roslaunch_arguments(Path(os.path.abspath(file)), arguments or {}, package_paths)  # noqa: PTH100
    return _Reading(file, arguments or {}, package_paths).declared()


class _Reading:
    """Execution of one launch file.

    Args:
        file: launch file.
        arguments: values of its arguments by name.
        package_paths: folders of packages by name, or workspaces.
    """

    def __init__(self, file: Path, arguments: Mapping[str, str], package_paths: PackagePaths) -> None:
        self._file = Path(os.path.abspath(file))  # noqa: PTH100 - without symbolic links
        self._plan = LaunchPlan(self._file, dict(arguments))
        self._diagnostics: Diagnostics = self._plan.diagnostics
        self._packages = LaunchPackages(self._file.parent, package_paths, self._diagnostics)
        language = LaunchLanguage(LaunchContext, read_description, _replace_substitutions)
        self._planner = LaunchPlanner(self._plan, self._packages, package_paths, language)
        self._declared: list[DeclaredArgument] = []

    def plan(self, strict: bool) -> LaunchPlan:
        """Execute the launch file, and return its plan."""
        self._run(self._execute)
        self._diagnostics.raise_if_errors(strict)
        return self._plan

    def declared(self) -> list[DeclaredArgument]:
        """Read the launch file, and return the declared arguments."""
        self._run(self._declare)
        self._diagnostics.raise_if_errors()
        return self._declared

    def _run(self, function: Callable[[], object]) -> None:
        argv = ["/opt/ros/jazzy/bin/ros2", "launch", str(self._file)]
        argv += [f"{name}:={value}" for name, value in self._plan.arguments.items()]
        usual = {**dict.fromkeys(SEARCH_VARIABLES, ""), **USUAL_VALUES}
        variables = {**usual, **self._packages.variables}
        host, planner = PlanningHost(), self._planner
        workspace = self._packages.workspace
        program = LaunchProgram(host, lambda: self._guard(function), argv, workspace, variables, planner.share_folder)
        self._planner.program = program
        recursion_limit = sys.getrecursionlimit()
        try:
            has_ended = host.run(program)
        finally:
            sys.setrecursionlimit(recursion_limit)
        program.stdout.end_line()
        program.stderr.end_line()
        self._plan.log.extend(program.log)
        if not has_ended or program.error is not None:
            reason = program.failure if has_ended else "the launch file waits for something that never comes"
            self._diagnostics.error(FAILED, reason, Where(str(self._file)))

    def _guard(self, function: Callable[[], object]) -> None:
        """Call a function; its exceptions become diagnostics with the line of the launch file."""
        self._planner.begin()
        try:
            function()
        except LaunchFileError as error:
            self._diagnostics.error(error.code, error.text, error.where, error.hint)
        except LoadError as error:
            self._diagnostics.extend(error.diagnostics)
        except (Exception, SystemExit) as error:  # noqa: BLE001 - a launch file may raise anything
            self._diagnostics.error(FAILED, _failure_text(error), self._place_of(error), _failure_hint(error))
        finally:
            variables = (*os.environ.items(), *self._packages.variables.items())
            self._plan.resource_paths = list(dict.fromkeys(environment_folders(variables)))

    def _place_of(self, error: BaseException) -> Where:
        """Return the innermost line of a launch file or of a module of its workspace; else that of the action."""
        if isinstance(error, SyntaxError) and error.filename:
            return Where(error.filename, error.lineno)
        for frame in reversed(traceback.extract_tb(error.__traceback__)):
            if self._planner.program.has_folder(os.path.dirname(frame.filename)) and not is_shipped_file(  # noqa: PTH120
                frame.filename
            ):
                return Where(frame.filename, frame.lineno)
        where = self._planner.place
        return where if where.file is not None else Where(str(self._file))

    def _execute(self) -> None:
        planner = self._planner
        if self._file.suffix == ".py" and not _defines(self._file, "generate_launch_description"):
            planner.run_script(self._file)
            return
        context = planner.service_context([])
        source = AnyLaunchDescriptionSource(str(self._file))
        include = IncludeLaunchDescription(source, launch_arguments=list(self._plan.arguments.items()))
        include.where = Where(str(self._file))
        planner.execute(include, context)
        self._report_unknown_arguments()

    def _report_unknown_arguments(self) -> None:
        """Report arguments that the launch file neither declares nor reads."""
        known = self._planner.declared
        for name in self._plan.arguments:
            if name not in known and name not in self._planner.used_names:
                text = f"the launch file has no argument {name!r}, so that its value changes nothing"
                where = Where(str(self._file))
                self._diagnostics.warning(UNKNOWN_ARGUMENT, text, where, name_hint(name, sorted(known)))

    def _declare(self) -> None:
        description = self._planner.description_of(str(self._file))
        self._declared = [each.argument for each in description.get_launch_arguments()]


def _failure_text(error: BaseException) -> str:
    if isinstance(error, SystemExit):
        return f"the launch file ended itself with sys.exit({'' if error.code is None else repr(error.code)})"
    if isinstance(error, SyntaxError):
        return f"{type(error).__name__}: {error.msg}"
    text = str(error)
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def _failure_hint(error: BaseException) -> str:
    if isinstance(error, ModuleNotFoundError) and error.name:
        return f"put the package of the module {error.name.partition('.')[0]!r} into the workspace, or install it"
    package = missing_package_of(error.filename) if isinstance(error, OSError) and error.filename else ""
    if package:
        return f"put the package {package!r} into the workspace, or name its workspace with --package-path"
    missing = _NO_CONFIGURATION.search(str(error))
    if missing is not None:
        return f"give {missing[1]}:=…"
    return ""


def _defines(file: Path, name: str) -> bool:
    return name.encode() in read_input(file, TEXT_LIMIT)


def _replace_substitutions(text: str, context: Any) -> str:
    """Return a text in which substitutions such as `$(var NAME)` are replaced."""
    return perform_substitutions(context, parse_substitutions(text))
