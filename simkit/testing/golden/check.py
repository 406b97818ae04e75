"""Checks a golden run: the same scenario again, compared, and explained where it differs."""

from __future__ import annotations

import os
import shlex
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Final

from simkit.errors import InputError, SimkitError
from simkit.run_spec import JsonMapping, RunSpec
from simkit.testing.golden.cause import explain, world_changes
from simkit.testing.golden.compare.difference import Verdict
from simkit.testing.golden.compare.runs import compare
from simkit.testing.golden.store import golden_folder, read_golden, read_history, write_golden
from simkit.testing.run_record.fingerprint import RENDERER
from simkit.testing.run_record.record import RunRecord
from simkit.testing.run_record.run_recorder import ENVIRONMENT_VARIABLES, run_record
from simkit.testing.scenarios.scenario_file import read_scenario

CAUSE_BUDGET_SECONDS: Final = 60.0
"""Wall time [s] that looking for causes may take."""
_MAX_NAMED: Final = 5  # changes of a world in which a scenario cannot be run any more
_MAX_DIFFERENCES: Final = 12  # differences that a blessing lists


def check_golden(
    folder: str | os.PathLike[str],
    *,
    scenario: RunSpec | None = None,
    bless: str | None = None,
    other_renderer: bool = False,
    causes: bool = True,
    budget_s: float = CAUSE_BUDGET_SECONDS,
) -> Verdict:
    """Runs a golden run's scenario again and compares.

    Args:
        folder: of the golden run.
        scenario: what is run; None for the scenario's file, or, where there is none, what stands in the golden run.
        bless: why what differs is right: then it becomes golden. What does not differ stays as it is.
        other_renderer: whether pictures of another renderer may be blessed.
        causes: whether differences are explained.
        budget_s: wall time that this may take [s].

    Returns:
        The verdict; of what was blessed it says what differed.

    Raises:
        InputError: SK-GOLDEN-002 to SK-GOLDEN-004 the golden run cannot be read; SK-GOLDEN-006 it cannot be run again
            from here; SK-GOLDEN-007 it is not blessed; or the world cannot be loaded.
        RenderError: there are pictures, and nothing that draws.
    """
    if bless is not None and not bless.strip():
        raise InputError("SK-GOLDEN-007 a blessing needs a reason: --bless 'wheels are 1 mm larger'", "SK-GOLDEN-007")
    place = golden_folder(folder)
    golden = read_golden(place)
    asked = _current_scenario(place, golden, scenario)
    with _recorded_environment(golden.environment), _run_today(golden, asked) as (run, elapsed):
        comparison = compare(golden, run)
        verdict = Verdict(place.resolve().name, golden, run, comparison, None, run.checks, elapsed)
        if not comparison.passed and bless is not None:
            make_golden(place, verdict, bless.strip(), other_renderer=other_renderer)
        elif not comparison.passed and causes:
            verdict.explanation = explain(golden, run, comparison, budget_s=budget_s)
        return verdict


@contextmanager
def _run_today(golden: RunRecord, scenario: RunSpec) -> Iterator[tuple[RunRecord, float]]:
    """A run of today with its wall time [s]; its simulation is closed at the end."""
    started = time.perf_counter()
    try:
        run = run_record(scenario)
    except InputError as error:
        raise _append_world_changes(error, golden, scenario) from None
    try:
        yield run, time.perf_counter() - started
    finally:
        if run.simulation is not None:
            run.simulation.close()
            run.simulation = None


def _append_world_changes(error: InputError, golden: RunRecord, scenario: RunSpec) -> InputError:
    """Why a run was not even begun, with what has changed in its world: a topic that it needs may have gone with it."""

    still = replace(scenario, commands=(), play="", play_topics=(), checks=(), until="", timeout=None, duration=0.0)
    try:
        run = run_record(still)
    except SimkitError:
        return error  # the world itself cannot be used
    if run.simulation is not None:
        run.simulation.close()
    changes = world_changes(golden, run)
    if not changes:
        return error
    told = [f"{change.words} ({change.where})" if change.where else change.words for change in changes[:_MAX_NAMED]]
    if len(changes) > len(told):
        told.append(f"{len(changes) - len(told)} more")
    lines = "\n".join(f"    since it was golden: {one}" for one in told)
    return InputError(f"{error}\n{lines}", error.code)


def _current_scenario(place: Path, golden: RunRecord, given: RunSpec | None) -> RunSpec:
    """What is run: read anew from the scenario's file, for that is what somebody may have changed."""
    stored = golden.scenario
    if given is not None:
        return given
    if stored.file is not None and stored.file.is_file():
        return read_scenario(stored.file)
    if stored.file is not None:
        why = f": its scenario {stored.file.resolve()} is not there\n    help: put it back, or record anew"
    elif stored.test:
        test = shlex.quote(os.path.normpath(place / "../../.." / stored.test))
        why = f" is of a test that makes plugins or steps by itself\n    help: pytest {test}"
    elif stored.plugins:
        why = (
            f" was recorded with plugins made in Python ({', '.join(map(str, stored.plugins))}), which are not here\n"
            "    help: check it where they are made: the fixture sensor_regression, or "
            "simkit.testing.golden.check.check_golden(folder, scenario=...)"
        )
    else:
        return stored
    raise InputError(f"SK-GOLDEN-006 {place}{why}", "SK-GOLDEN-006")


@contextmanager
def _recorded_environment(environment: Mapping[str, str]) -> Iterator[None]:
    """Has the variables that say what the world is be as they were."""
    kept = {name: os.environ.get(name) for name in ENVIRONMENT_VARIABLES if name in environment}
    try:
        os.environ.update({name: environment[name] for name in kept})
        yield
    finally:
        for name, value in kept.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def make_golden(place: Path, verdict: Verdict, reason: str, *, other_renderer: bool = False) -> None:
    """Makes the run of a verdict golden, with what differs in its history.

    Args:
        place: folder of the golden run that it was compared with.
        verdict: the run, and what differs.
        reason: why that is right.
        other_renderer: whether pictures of another renderer may become golden.

    Raises:
        InputError: SK-GOLDEN-007 it failed, or its pictures are another renderer's.
    """
    golden, run = verdict.golden, verdict.run
    refuse_failed(run, place)
    if not other_renderer:
        before, now = golden.fingerprint.get(RENDERER), run.fingerprint.get(RENDERER)
        if before and now and before != now:
            raise InputError(
                f"SK-GOLDEN-007 {place} is not blessed: its pictures were drawn by {before}, here they are by {now}, "
                "and everybody else's would differ\n    help: bless it where the others run (CI), or say "
                "--bless-other-renderer",
                "SK-GOLDEN-007",
            )
    words = [one.words for one in verdict.comparison.differences]
    more = len(words) - _MAX_DIFFERENCES
    changed = [*words[:_MAX_DIFFERENCES], *([f"and {more} more"] if more > 0 else [])]
    history: list[JsonMapping] = read_history(place)
    write_golden(place, run, reason=reason, changed=changed, history=history)


def refuse_failed(run: RunRecord, place: Path) -> None:
    """A run that broke off is no example.

    Raises:
        InputError: SK-GOLDEN-007 it is one.
    """
    if run.error is not None:
        raise InputError(f"SK-GOLDEN-007 {place}: the run failed, and is not made golden: {run.error}", "SK-GOLDEN-007")
