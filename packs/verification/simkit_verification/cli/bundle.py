"""Run a world or scenario and pack it into a repeatable bundle."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from typer import Option

from simkit.cli.run_options import NONE_GIVEN, scenario_spec
from simkit.cli.terminal import options
from simkit.cli.terminal.json_report import add_diagnostics
from simkit.cli.terminal.output import print_diagnostics, print_message, stdout_console
from simkit.errors import InputError, SimkitError
from simkit.extend import GivenOptions, add_to_report, counted, option, report_errors, with_run_options
from simkit.writers.atomic_output import check_file


@report_errors
@with_run_options(
    *("file", "world", "run"),
    usual={"duration": "the scenario's, else 10"},
    without={
        "topics": "--topic chooses the image topics that the bundle keeps",
        "session": "nobody follows the run of a bundle",
    },
)
def bundle(
    world: options.Scenario,
    output: Annotated[Path, option("Bundle to write.", "FILE.zip", "--output", "-o")],
    given: GivenOptions = NONE_GIVEN,
    last: Annotated[float, option("Seconds of messages to keep before the end.", "S", min=0)] = 10.0,
    topic: Annotated[list[str], option("Keep image topics that match this pattern, too; repeatable.", "PATTERN")] = [],
    no_code: Annotated[bool, Option("--no-code", help="Leave out the code of plugins.")] = False,
    force: options.Force = False,
    allow_code: options.AllowCode = False,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors` reads it)
) -> None:
    """Run a world or scenario and pack it into a repeatable bundle.

    The file holds the world with all files that it uses, the code of plugins, the seed, the versions, every command
    with its tick, the messages of the last seconds, and the hashes of the end state. `simkit replay` repeats the run.
    """
    from simkit.testing import open_scenario, run_scenario
    from simkit.testing.scenarios.scenario_run import resolve_commands
    from simkit_verification.testing.bundles import BundleRecorder, write_bundle
    from simkit_verification.testing.bundles.manifest import failure_from_checks, failure_from_error

    check_file(output, overwrite=force)
    scenario = scenario_spec(world, given, allow_code=allow_code)
    with open_scenario(scenario) as sim:
        print_diagnostics(sim.diagnostics, verbose=False)
        add_diagnostics(sim.diagnostics)
        recorder = BundleRecorder(sim, last, topic, scenario)
        scenario = resolve_commands(scenario, sim.communication.bus)
        failure = None
        try:
            ended = run_scenario(scenario, sim)
            failure = failure_from_checks(ended.results, was_given_up=ended.reason == "wall_timeout")
            if failure is not None:
                print_message(f"the run failed; the bundle contains the failure: {failure.text}")
        except InputError:
            raise
        except SimkitError as error:
            failure = failure_from_error(error)
            print_message(f"the run failed; the bundle contains the failure: {error}")
        name = scenario.name or ("" if scenario.file is None else scenario.file.stem)
        write_bundle(recorder, output, failure, name=name, overwrite=force, with_code=not no_code)
        state, size = recorder.end().state, output.stat().st_size
        add_to_report(bundle=str(output), bytes=size, state=state, time=sim.time, commands=recorder.journal.count)
        add_to_report(failure=None if failure is None else failure.text)
        stdout_console().print(f"state {state}")
        stdout_console().print(
            f"{output}: {sim.time:g} s, {counted(recorder.journal.count, 'command')}, {size / 1000:.0f} kB"
        )
