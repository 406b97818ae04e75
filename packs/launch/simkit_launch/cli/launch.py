"""Run a launch file of ROS 2 or ROS 1 without ROS or Gazebo."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer import Option
from typer.core import TyperCommand

from simkit.cli.run import execute, highest_pace
from simkit.cli.run_options import NONE_GIVEN, PARTS, scenario_spec
from simkit.cli.run_part import RunPart, complete_words, with_run_parts
from simkit.cli.terminal import options
from simkit.cli.terminal.json_report import report_errors_and_json
from simkit.cli.terminal.output import print_diagnostics, print_line, print_status
from simkit.extend import GivenOptions, argument, option, with_run_options
from simkit.run_spec import Recording

if TYPE_CHECKING:
    from simkit_launch.launch_plan import DeclaredArgument

LISTED_AFTER = "run"


class LaunchCommand(TyperCommand):
    """Command that completes the options of run parts that work without a value, such as `--web`."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Complete and parse the words of the command line."""
        return super().parse_args(ctx, complete_words(args))


COMMAND = LaunchCommand


@report_errors_and_json
@with_run_parts
@with_run_options(*PARTS, usual={"duration": "until Ctrl-C"})
def launch(
    file: Annotated[str, argument("Launch file, or a package of the workspace.", "FILE|PACKAGE")],
    words: Annotated[
        list[str], argument("Name of a launch file of the package; arguments of the file.", "[FILE] [NAME:=VALUE]...")
    ] = [],
    show_args: Annotated[
        bool, Option("--show-args", "-s", help="List the arguments of the launch file and start nothing.")
    ] = False,
    print_: Annotated[
        bool,
        Option("--print", "-p", help="Print the run as a scenario file, and start nothing; the file is executed."),
    ] = False,
    headless: Annotated[bool, Option("--headless", help="Open no window, whatever the file asks for.")] = False,  # noqa: ARG001 (as always)
    processes: Annotated[
        bool, Option("--processes", help="Run the file's own nodes as processes at real time, not in lock-step.")
    ] = False,
    given: GivenOptions = NONE_GIVEN,
    record: Annotated[Path | None, option("Bag to write: NAME.mcap, else a rosbag2 folder.", "OUT")] = None,
    force: options.Force = False,
    parts: Sequence[RunPart] = (),
    verbose: options.Verbose = False,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors_and_json` reads it)
    quiet: Annotated[bool, Option("--quiet", "-q", help="Print no table of topics at the end.")] = False,
) -> int:
    """Run a launch file of ROS 2 or ROS 1 without ROS or Gazebo."""
    from simkit_launch.launch import launch as launch_run
    from simkit_launch.launch import launch_file_path, with_workspace
    from simkit_launch.launch_file import declared_arguments

    target, arguments = _target(file, words)
    paths = given.values.get("package_paths", ())
    if show_args:
        path = launch_file_path(target, paths)
        with _output_to_stderr():
            declared = declared_arguments(path, arguments, with_workspace(path, paths))
        _print_arguments(declared)
        return 0
    with _output_to_stderr():
        spec = launch_run(target, arguments, package_paths=paths, strict=bool(given.values.get("strict")))
    rest = {name: value for name, value in given.values.items() if name != "package_paths"}
    spec = replace(spec, duration=math.inf)
    spec = scenario_spec(spec, GivenOptions(rest), usual_duration=math.inf)
    if print_:
        from simkit_launch.scenario_text import scenario_text

        print_diagnostics(spec.diagnostics, verbose=verbose)
        print_line(scenario_text(spec))
        return 0
    if processes:
        from simkit_launch.cli.processes.node_processes import split_processes

        spec, part = split_processes(spec)
        parts = (*parts, part)
    spec = replace(
        spec,
        recording=None if record is None else Recording(record, overwrite=force),
        pace=highest_pace(spec.pace, is_watched=any(part.is_watched for part in parts)),
    )
    return execute(spec, parts, verbose=verbose, quiet=quiet)


@contextmanager
def _output_to_stderr() -> Iterator[None]:
    """Send the output of processes that a launch file starts to standard error: the results are on standard output."""
    try:
        stdout = os.dup(1)
        os.dup2(2, 1)
    except OSError:  # one of them is closed
        yield
        return
    try:
        yield
    finally:
        os.dup2(stdout, 1)
        os.close(stdout)


def _target(file: str, words: Sequence[str]) -> tuple[str | tuple[str, str], dict[str, str]]:
    """Return the launch file, or its package and name, and the arguments of the launch file.

    Raises:
        typer.BadParameter: a word is neither.
    """
    names = [word for word in words if ":=" not in word]
    arguments = dict(word.split(":=", 1) for word in words if ":=" in word)
    wrong = [word for word in words if word.startswith(":=")]
    wrong += names if Path(file).is_file() else names[1:]  # a file is no package
    if wrong:
        raise typer.BadParameter(f"{wrong[0]!r} is no argument; expected NAME:=VALUE", param_hint="NAME:=VALUE")
    return ((file, names[0]) if names else file), arguments


def _print_arguments(declared: Sequence[DeclaredArgument]) -> None:
    """Print the arguments of a launch file, as `ros2 launch --show-args`."""
    if not declared:
        print_status("the launch file has no arguments")
        return
    print_line("Arguments (pass arguments as '<name>:=<value>'):")
    for each in declared:
        choices = f" Valid choices are: {list(each.choices)}" if each.choices else ""
        default = "required" if each.default is None else f"default: {each.default!r}"
        print_line(
            f"\n    '{each.name}':\n        {each.description or 'no description given'}{choices}\n        ({default})"
        )
