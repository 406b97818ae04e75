"""Explain a moment of a run: contacts, joints, constraints and wheels, with their forces and limits."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from simkit.cli.run_options import NONE_GIVEN, scenario_spec
from simkit.cli.terminal import completion, options
from simkit.cli.terminal.json_report import add_diagnostics
from simkit.cli.terminal.output import print_diagnostics, print_json, printable, stdout_console
from simkit.cli.terminal.verbosity import is_quiet
from simkit.errors import InputError
from simkit.extend import GivenOptions, argument, option, report_errors, with_run_options

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit.run_spec import RunSpec

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
    run: Annotated[str, argument("Bundle, golden run, scenario or world.", "RUN", completion.runs)],
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
) -> None:
    """Explain a moment of a run: what slides or has a limit, and all contacts, joints, constraints and wheels.

    The command repeats the run up to this time. With --quiet, it prints only what slides or has a limit.
    """
    from simkit_verification.testing.moment.sentences import NOTHING_FOUND

    with _opened_at(run, time, given, allow_code=allow_code) as sim:
        try:
            moment = sim.why(model, joint)
        except KeyError as error:
            raise InputError("SK-NAME-006", str(error)) from None
    if json_:
        print_json(moment.as_dict())
    else:
        for line in moment.findings or [NOTHING_FOUND] if is_quiet() else str(moment).splitlines():
            stdout_console().print(printable(line))


@contextmanager
def _opened_at(run: str, time: float | None, given: GivenOptions, *, allow_code: bool) -> Iterator[Simulation]:
    """Repeat a run up to a time [s], and yield its simulation.

    Raises:
        InputError: SK-CLI-064 the run ends before this time, is a bundle and options are given, or is a bag.
    """
    from simkit.testing import open_scenario, run_scenario
    from simkit.testing.golden.store import is_golden
    from simkit_verification.testing.bundles import replay_until

    if "<" not in run and zipfile.is_zipfile(run):
        if names := given.names():
            raise InputError("SK-CLI-064", f"{run} is a bundle, which repeats one run; omit {', '.join(names)}")
        with replay_until(run, time, allow_code=allow_code) as sim:
            _check_time(sim, run, time)
            yield sim
        return
    spec = _spec(run, given, allow_code=allow_code)
    if time is not None:
        is_world = spec.file is None and not is_golden(run)
        spec = spec.with_values({"duration": time if is_world else min(time, spec.longest), "timeout": None})
    with open_scenario(spec) as sim:
        print_diagnostics(sim.diagnostics, verbose=False)
        add_diagnostics(sim.diagnostics)
        run_scenario(spec, sim, judged=False)
        _check_time(sim, run, time)
        yield sim


def _spec(run: str, given: GivenOptions, *, allow_code: bool) -> RunSpec:
    from simkit.cli.plot_sources import is_bag
    from simkit.testing.golden.check import golden_scenario
    from simkit.testing.golden.store import golden_folder, is_golden, read_golden

    if "<" not in run and is_bag(Path(run)):
        help_ = f"name the world, and play the bag: simkit why WORLD --play {run}"
        raise InputError("SK-CLI-064", f"{run} is a bag, which has messages but not their world", help=help_)
    if "<" in run or not is_golden(run):
        return scenario_spec(run, given, allow_code=allow_code)
    place, loading = golden_folder(run), given.load_options()
    paths = loading.get("resource_paths", ()), allow_code, loading.get("plugin_paths", ())
    stored = golden_scenario(place, read_golden(place), *paths)
    return scenario_spec(stored, given, allow_code=allow_code)


def _check_time(sim: Simulation, run: str, time: float | None) -> None:
    if time is not None and sim.tick < sim.engine.clock.ticks(time):
        raise InputError("SK-CLI-064", f"{Path(run).name}: the run ends at t = {sim.time:g} s, before --time {time:g}")
