"""Command `simkit run`: run a world without a window, as fast as possible."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

from typer import Option
from typer.core import TyperCommand

from simkit.cli.gazebo_options import remove_gazebo_options
from simkit.cli.run_options import NONE_GIVEN, PARTS, GivenOptions, with_run_options
from simkit.cli.run_part import RunPart, complete_words, with_run_parts
from simkit.cli.terminal import options
from simkit.cli.terminal.blocked_plugins import BlockedPlugins
from simkit.cli.terminal.json_report import UsageError, add_diagnostics, end_with_error, report_errors_and_json
from simkit.cli.terminal.options import option
from simkit.cli.terminal.output import print_diagnostics, print_message, print_status
from simkit.diagnostics import Diagnostic
from simkit.errors import LoadError
from simkit.garbage_collection import permanent_imports
from simkit.run_spec import Recording, RunSpec


class RunCommand(TyperCommand):
    """Command that answers options of Gazebo, and completes the options of run parts that work without a value."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Complete and parse the words of the command line."""
        args = complete_words(args)
        if not ctx.resilient_parsing:
            args = self._without_gazebo_options(args)
        try:
            return super().parse_args(ctx, args)
        except UsageError as error:
            if getattr(getattr(error, "param", None), "name", None) != "world":
                raise
            from simkit.loaders.resources.bundled_models import bundled_worlds

            raise UsageError(
                f"no world is given; give a file or a world of simkit: {', '.join(bundled_worlds())}", ctx
            ) from None

    def _without_gazebo_options(self, args: list[str]) -> list[str]:
        """Remove options of Gazebo that need no action, with a note; for other options of Gazebo, end the command."""
        options_with_value = {
            name for each in self.params if not getattr(each, "is_flag", True) for name in each.opts if name[0] == "-"
        }
        try:
            remaining, notes = remove_gazebo_options(args, options_with_value)
        except LoadError as error:
            end_with_error(error, json_="--json" in args)
        for note in notes:
            print_status(f"note: {note}")
        return remaining


COMMAND = RunCommand


@report_errors_and_json
@with_run_parts
@with_run_options(*PARTS, usual={"duration": "until Ctrl-C"})
def run(
    world: options.World,
    given: GivenOptions = NONE_GIVEN,
    record: Annotated[Path | None, option("Bag to write: NAME.mcap, else a rosbag2 folder.", "OUT")] = None,
    force: options.Force = False,
    parts: Sequence[RunPart] = (),
    verbose: options.Verbose = False,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors_and_json` reads it)
    quiet: Annotated[bool, Option("--quiet", "-q", help="Print no table of topics at the end.")] = False,
) -> int:
    """Run a world without a window, as fast as possible."""
    spec = given.run_spec(world, duration=math.inf)
    spec = replace(
        spec,
        duration=spec.duration if math.isfinite(spec.duration) else math.inf,
        recording=None if record is None else Recording(record, overwrite=force),
        pace=highest_pace(spec.pace, is_watched=any(part.is_watched for part in parts)),
    )
    return execute(spec, parts, verbose=verbose, quiet=quiet)


def highest_pace(rtf: float | None, *, is_watched: bool) -> float | None:
    """Return the highest real-time factor; None for no limit.

    The default is 1 for runs with a viewer or teleop, else no limit.
    """
    if rtf is None:
        return 1.0 if is_watched else None
    return rtf if math.isfinite(rtf) else None


def _print_model_world(diagnostics: Iterable[Diagnostic]) -> None:
    """Print the note about the ground of a bare model, which a user may not expect."""
    for note in diagnostics:
        if note.code == "SK-SPAWN-005":
            print_status(f"note: {note.message} ({note.hint})")


def execute(spec: RunSpec, parts: Sequence[RunPart], *, verbose: bool, quiet: bool) -> int:
    """Run a specification and return the exit code.

    Args:
        spec: run specification.
        parts: parts of the run, of `run_parts`.
        verbose: True to print every note.
        quiet: True to print no table of topics.

    Raises:
        SimkitError: the run failed; the recording up to the failure is complete.
    """
    with permanent_imports():
        from simkit.build import load
        from simkit.cli.run_session import Session
        from simkit.cli.run_verdict import RunVerdict
        from simkit.run_nodes import nodes_read_files
        from simkit.testing.scenarios.scenario_run import add_nodes

    for part in parts:
        spec = part.extended(spec)
    if spec.recording is not None:
        from simkit.recording.bags import writer  # 3 ms: the formats of bags

        writer.check_target(spec.recording.path, overwrite=spec.recording.overwrite)
    with RunVerdict(spec) as verdict, ExitStack() as stack:
        for part in parts:
            stack.enter_context(part.around_run(spec, verdict))
        blocked = stack.enter_context(BlockedPlugins(print_message))
        has_nodes = bool(spec.nodes) or any(part.adds_nodes for part in parts)
        with nodes_read_files(has_nodes):
            loaded = load(spec.world, **spec.load_arguments())
        with loaded as sim:
            try:
                try:
                    nodes = [node for part in parts for node in part.added_nodes(spec, sim)]
                    spec = replace(spec, nodes=(*spec.nodes, *nodes))
                    add_nodes(spec, sim)
                finally:
                    print_diagnostics([*spec.diagnostics, *sim.diagnostics], verbose=verbose)
                    if not verbose:
                        _print_model_world(sim.diagnostics)
                verdict.code = Session(spec, parts, sim, blocked, verdict, quiet=quiet).execute()
            finally:
                add_diagnostics([*spec.diagnostics, *sim.diagnostics])
    return verdict.code
