"""Explain a moment of a run: what slides or has a limit, and all contacts, joints, constraints and wheels."""

from __future__ import annotations

import math
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Option

from simkit.cli.run_options import NONE_GIVEN, scenario_spec
from simkit.cli.terminal import completion, options
from simkit.cli.terminal.json_report import add_diagnostics
from simkit.cli.terminal.output import print_diagnostics, print_json, printable, stdout_console
from simkit.errors import InputError
from simkit.extend import GivenOptions, argument, option, report_errors, with_run_options

if TYPE_CHECKING:
    from simkit import Simulation

LISTED_AFTER = "replay"


@report_errors
@with_run_options(
    *("file", "world", "run"),
    without={
        "duration": "--time ends the run",
        "checks": "the moment is explained whether conditions hold or not",
        "session": "nobody follows the run",
        "topics": "nothing is recorded",
    },
)
def why(
    run: Annotated[str, argument("Bag, bundle, golden run, scenario or world.", "RUN", completion.runs)],
    time: Annotated[
        float | None,
        option(
            "Simulated time to explain; default: the end of the run.", "S", "--time", "-t", min=0, show_default=False
        ),
    ] = None,
    model: Annotated[str | None, option("Explain this model only.", "NAME")] = None,
    joint: Annotated[str | None, option("Explain this joint, its link and its constraints only.", "NAME")] = None,
    given: GivenOptions = NONE_GIVEN,
    allow_code: options.AllowCode = False,
    json_: options.Json = False,
    quiet: Annotated[bool, Option("--quiet", "-q", help="Print only what slides or has a limit.")] = False,
) -> None:
    """Explain a moment of a run: what slides or has a limit, and all contacts, joints, constraints and wheels.

    The command repeats the run up to this time.
    """
    with _opened_at(run, time, given, allow_code=allow_code) as sim:
        try:
            moment = sim.why(model, joint)
        except KeyError as error:
            raise InputError("SK-NAME-006", str(error)) from None
    if json_:
        print_json(moment.as_dict())
    else:
        for line in moment.report(brief=quiet):
            stdout_console().print(printable(line))


@contextmanager
def _opened_at(run: str, time: float | None, given: GivenOptions, *, allow_code: bool) -> Iterator[Simulation]:
    """Repeat a run up to a time [s], and yield its simulation.

    Raises:
        InputError: SK-CLI-064 the run ends before this time, is a bundle and options are given, or is a bag whose run
            cannot be repeated.
    """
    from simkit.testing import (
        check_recorded_files,
        golden_scenario,
        open_scenario,
        recorded_scenario,
        run_scenario,
    )
    from simkit_verification.testing.bundles import replay_until

    if "<" not in run and zipfile.is_zipfile(run):
        if names := given.names():
            raise InputError("SK-CLI-064", f"{run} is a bundle, which repeats one run; omit {', '.join(names)}")
        with replay_until(run, time, allow_code=allow_code) as sim:
            _check_time(sim, run, time)
            yield sim
        return
    folders, code = (given.values.get(name, ()) for name in ("resource_paths", "plugin_paths"))
    golden = golden_scenario(run, folders=folders, allow_code=allow_code, plugin_paths=code) if "<" not in run else None
    recorded = recorded_scenario(run, folders=folders) if "<" not in run else None
    spec = scenario_spec(golden or recorded or run, given, allow_code=allow_code)
    if time is not None:
        is_world = spec.file is None and golden is None and recorded is None
        spec = spec.with_values({"duration": time if is_world else min(time, spec.longest), "timeout": None})
    with open_scenario(spec) as sim:
        if recorded is not None and not given.names(("resource_paths", "plugin_paths")):
            check_recorded_files(run, sim)
        print_diagnostics(sim.diagnostics, verbose=False)
        add_diagnostics(sim.diagnostics)
        run_scenario(spec, sim, judged=False)
        _check_time(sim, run, time)
        yield sim


def _check_time(sim: Simulation, run: str, time: float | None) -> None:
    if time is not None and (math.isinf(time) or sim.tick < sim.engine.clock.ticks(time)):
        raise InputError("SK-CLI-064", f"{Path(run).name}: the run ends at t = {sim.time:g} s, before --time {time:g}")
