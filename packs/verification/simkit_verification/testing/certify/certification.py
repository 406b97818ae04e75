"""Certification: runs a scenario in fresh processes with different environments, and compares the results."""

from __future__ import annotations

import pickle
import re
import signal
import tempfile
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Final

from simkit import RunSpec, progress
from simkit.child_process import ChildProcesses, ProcessResult
from simkit.errors import InputError
from simkit.memory_error import OutOfMemory
from simkit.run_files import FileName, is_there
from simkit.testing.scenarios.code_permission import permit_code
from simkit_verification.testing.certify.certificate import Certificate, Difference, Row, streams_hash
from simkit_verification.testing.certify.child_run import ChildRequest, run_child
from simkit_verification.testing.certify.code_hints import hints_in
from simkit_verification.testing.certify.outcome import (
    STACK_FILE,
    CodePosition,
    Culprit,
    RunOutcome,
    differences,
    find_culprit,
    first_tick,
    read_pickle,
    write_pickle,
)
from simkit_verification.testing.certify.variations import Variation, choose_variations

_LEAST_LIMIT, _TIMES = 60.0, 10.0  # wall-clock limit of a run: ten times as long as the first run, at least 60 s
_WATCHED: Final = 5.0  # factor by which the limit is longer if every plugin call is recorded
_SPARE_SECONDS: Final = 20.0  # additional time in which a process can end itself after its limit [s]
_FRAME: Final = re.compile(r'^  File "(.*)", line (\d+) in (.*)$', re.MULTILINE)


class ProcessRunner:
    """Runner of a scenario in given environments.

    Args:
        scenario: Scenario.
        apart: Use a separate process for each run.
        limit: Wall-clock limit of a run [s]. If None, the first run has no limit, and its duration sets the limit of
            the other runs.

    Raises:
        InputError: SK-CERT-002 the plugins cannot be transferred to another process.
    """

    def __init__(self, scenario: RunSpec, *, apart: bool, limit: float | None) -> None:
        self._plugins_from, self._scenario = _plugin_file(scenario), with_absolute_paths(scenario)
        self._processes = ChildProcesses() if apart else None
        self._limit = limit

    def first(self, variation: Variation) -> RunOutcome:
        """Run the reference run to the scenario's end."""
        outcome = self.run(variation)
        if self._limit is None:
            self._limit = max(_LEAST_LIMIT, _TIMES * outcome.seconds)
        return outcome

    def run(self, variation: Variation, ticks: int | None = None) -> RunOutcome:
        """Run the scenario to a tick; run to its end if `ticks` is None."""
        request = ChildRequest(self._scenario, variation, ticks, plugins_from=self._plugins_from, limit=self._limit)
        return self._run(request)

    def watch(self, variation: Variation, ticks: int, half: int) -> RunOutcome:
        """Run the scenario and record every plugin call."""
        limit = None if self._limit is None else self._limit * _WATCHED
        return self._run(ChildRequest(self._scenario, variation, ticks, True, half, self._plugins_from, limit))

    def end(self) -> None:
        """End all running processes and start no further process."""
        if self._processes is not None:
            self._processes.end()

    def _run(self, request: ChildRequest) -> RunOutcome:
        return run_child(request) if self._processes is None else _run_in_process(request, self._processes)


def _run_in_process(request: ChildRequest, processes: ChildProcesses) -> RunOutcome:
    """Run a request in a fresh process."""
    with tempfile.TemporaryDirectory(prefix="simkit-certify-", ignore_cleanup_errors=True) as made:
        folder = Path(made)
        child_folder = folder / "here"
        child_folder.mkdir()
        asked, result = folder / "request", folder / "result"
        write_pickle(asked, request)
        variation, limit = request.variation, request.limit
        ended = processes.run(
            "simkit_verification.testing.certify",
            [str(asked), str(result)],
            environment=variation.environment(child_folder),
            folder=variation.working_directory(child_folder),
            limit=None if limit is None else limit + _SPARE_SECONDS,
        )
        with suppress(OSError, pickle.UnpicklingError, EOFError):
            return read_pickle(result, RunOutcome)
        return _outcome_of_stopped_process(ended, limit, folder / STACK_FILE)


def _outcome_of_stopped_process(ended: ProcessResult, limit: float | None, stack: Path) -> RunOutcome:
    """Return the outcome of a run that gave no result."""
    text = ""
    with suppress(OSError):
        text = stack.read_text(encoding="utf-8", errors="replace")
    main_thread = text.rpartition("\nThread ")[2]  # the stack trace lists the main thread last
    places = [CodePosition(file, int(line), name) for file, line, name in _FRAME.findall(main_thread)]
    if ended.is_late or text.startswith("Timeout"):
        reason = f"still running after {limit:g} s of wall time, stopped; use --wall-timeout for a longer limit"
        return RunOutcome(stopped=reason, stack=places)
    last = (ended.last_lines(1) or ["no output"])[0]
    code, is_killed = f"with {ended.code}", False
    if ended.code < 0:
        known = -ended.code in set(signal.Signals)
        is_killed = known and signal.Signals(-ended.code).name == "SIGKILL"  # Windows does not have this signal
        code = f"by signal {signal.Signals(-ended.code).name if known else -ended.code}"
    return RunOutcome(stopped=f"the process ended {code}: {last}", stack=places, is_killed=is_killed)


def _plugin_file(scenario: RunSpec) -> Path | None:
    """Return the Python file from which a fresh process can load the scenario's plugins."""
    if not scenario.plugins:
        return None
    if scenario.file is not None and scenario.file.suffix.lower() == ".py":
        return scenario.file.absolute()
    message = "plugins created in Python cannot be transferred to a fresh process"
    hint = "write the scenario as a Python file with `scenario = RunSpec(..., plugins=(MyPlugin(),))`"
    raise InputError("SK-CERT-002", message, help=hint)


def with_absolute_paths(scenario: RunSpec) -> RunSpec:
    """Return the scenario with absolute paths, which are valid in every working directory."""

    def absolute(name: FileName) -> str:
        path = name.used_path(scenario.folder)
        if path is None or (name.role == "file" and not is_there(path)):  # a parameter file can be a URI
            return name.text
        return str(path.absolute())

    source = scenario.source
    moved = scenario.with_files(absolute)
    if "<" in source:
        options = moved.options
        moved = moved.with_values({"resource_paths": [*options.get("resource_paths", ()), str(Path.cwd())]})
    elif Path(source).exists():
        source = str(Path(source).absolute())
    folder, file = scenario.folder.absolute(), scenario.file and scenario.file.absolute()
    return replace(moved, world=source, folder=folder, file=file, plugins=())


_WATCH_ATTEMPTS: Final = 2  # attempts to reproduce a difference while recording plugin calls
_TICK_MARGIN: Final = 2  # ticks to run after the first tick that differs

ProgressCallback = Callable[[Row], None]


def certify(
    scenario: RunSpec,
    *,
    runs: int = 6,
    variations: Sequence[Variation] | None = None,
    jobs: int = 1,
    apart: bool = True,
    wall_timeout: float | None = None,
    on_row: ProgressCallback | None = None,
    allow_code: bool = False,
) -> Certificate:
    """Run a scenario several times, each in a fresh process with another environment, and compare the results.

    Args:
        scenario: Scenario.
        runs: Number of runs. They use the environments in `VARIATIONS`, then the same ones with other hash seeds.
        variations: Environments to use instead of `runs`; the first one belongs to the reference run.
        jobs: Number of parallel processes.
        apart: Use a separate process for each run. If False, all runs use this process, so that a debugger works. Then
            only the subscribers and the detours of `Variation` differ, and there is no time limit.
        wall_timeout: Wall-clock limit of each run [s]. If None, the first run has no limit, and the others have ten
            times its duration, at least one minute.
        on_row: Function that is called with the result of each run when the run is complete.
        allow_code: Allow the plugin folders that the scenario's file names.

    Returns:
        Certificate of all runs.

    Raises:
        InputError: SK-CERT-001 fewer than two runs; SK-CERT-002 plugins that cannot be transferred to another process;
            SK-CERT-004 the first process ended early or timed out.
        OutOfMemory: A process ended for lack of memory.
        LoadError: The world has errors, or SK-SCEN-008 the scenario needs code that is not allowed.
        PluginError: A plugin raised an exception during loading.
    """
    # a snapshot does not contain the programs of nodes
    chosen = choose_variations(runs, with_restore=not scenario.nodes) if variations is None else list(variations)
    if len(chosen) < 2:
        message = f"cannot certify with {len(chosen)} runs"
        raise InputError("SK-CERT-001", message, help="use --runs 2 or more")
    scenario = permit_code(scenario, allow_code)
    runner = ProcessRunner(scenario, apart=apart, limit=wall_timeout)
    first = _run_reference(runner, chosen[0])
    # if an error stopped the first run, the other runs need one more step to reach the same error
    ticks = first.ticks + (1 if first.end else 0)
    rows = [Row(chosen[0], first, streams_hash(first), True)]
    on_row = on_row or (lambda _: None)
    on_row(rows[0])
    with (
        ThreadPoolExecutor(max(1, jobs if apart else 1)) as pool,
        progress.task("repeating the run", len(chosen) - 1) as task,
    ):
        try:
            outcomes = pool.map(lambda variation: runner.run(variation, ticks), chosen[1:])
            for variation, outcome in zip(chosen[1:], outcomes, strict=True):
                _check_memory(variation, outcome)
                rows.append(Row(variation, outcome, streams_hash(outcome), not differences(first, outcome)))
                on_row(rows[-1])
                task.advance()
        except BaseException:  # for Ctrl-C too; otherwise, the pool would wait for all processes
            runner.end()
            raise
    known: dict[int, Difference] = {}
    explained = []
    different = [row for row in rows[1:] if not row.same]
    with progress.task("searching for the plugin that differs", len(different)) as task:
        for row in different:
            explained.append(_explain_difference(row, rows[0], runner, ticks, known))
            task.advance()
    duration, notes = first.ticks * first.timestep, _attribute_notes(rows)
    return Certificate(
        scenario.title, scenario.world, duration, scenario.seed, rows, explained, notes, first.fingerprint
    )


def _run_reference(runner: ProcessRunner, variation: Variation) -> RunOutcome:
    """Run the reference run and return its outcome; raise an error if the run gave no result."""
    with progress.task("running the reference run in its own process"):
        first = runner.first(variation)
    _check_memory(variation, first)
    if first.failure is not None:
        raise first.failure
    if first.stopped:
        position = f"; its last code position was {first.stack[0]}" if first.stack else ""
        message = f"the run {variation.name!r} gave no result: {first.stopped}{position}"
        raise InputError("SK-CERT-004", message)
    return first


def _check_memory(variation: Variation, outcome: RunOutcome) -> None:
    """Raise OutOfMemory if a run ended for lack of memory: such an end says nothing about the run's bits."""
    if outcome.failure is not None and outcome.failure.code == OutOfMemory.code:
        raise OutOfMemory(f"the run {variation.name!r} did not fit into it")
    if outcome.is_killed:
        raise OutOfMemory(f"the system killed the process of the run {variation.name!r}")


# ---------------------------------------------------------------------- causes


def _explain_difference(
    row: Row, first: Row, runner: ProcessRunner, ticks: int, known: dict[int, Difference]
) -> Difference:
    """Return the first difference between a run and the reference run, with its cause.

    Args:
        row: Result of the run that differs.
        first: Result of the reference run.
        runner: Runner that repeats both runs.
        ticks: Number of steps of each run.
        known: First tick -> difference that is already explained; this function adds the new difference.
    """
    unequal = differences(first.outcome, row.outcome)
    tick, step = first_tick(unequal), first.outcome.timestep
    more = tuple(f.words for f in unequal[1:6])
    plain = Difference(row.variation, unequal[0].words, tick, None if tick is None else tick * step, more=more)
    if row.outcome.stopped:
        return _code_at_timeout(plain, row.outcome, first.outcome)
    if row.outcome.failure is not None:
        return plain
    if tick is not None and tick in known:  # assume the same cause at the same tick, which saves two runs
        return replace(known[tick], variation=row.variation, words=unequal[0].words, more=more)
    end, culprit = ticks if tick is None else min(ticks, tick + _TICK_MARGIN), None
    for _ in range(_WATCH_ATTEMPTS):
        culprit = find_culprit(*(runner.watch(r.variation, end, ticks // 2) for r in (first, row)))
        if culprit is not None:
            break
    made = _culprit_of_error(plain, culprit, first.outcome, unequal[0].owner)
    if tick is not None and made.owner:
        known[tick] = made
    return made


def _culprit_of_error(plain: Difference, culprit: Culprit | None, first: RunOutcome, owner: str) -> Difference:
    if culprit is None and not owner:
        how = "the cause is unknown: the difference did not occur again while plugin calls were recorded"
        return replace(plain, how=how)
    name = culprit.owner if culprit is not None else owner
    file, start, end = first.sources.get(name, ("", 0, 0))
    hints = tuple(hints_in(file, start, end)) if file else ()
    if culprit is None:
        return replace(plain, owner=name, hints=hints)
    tick = culprit.tick if plain.tick is None or (culprit.matters and culprit.tick < plain.tick) else plain.tick
    return replace(plain, owner=name, how=culprit.how, hints=hints, tick=tick, time=tick * first.timestep)


def _code_at_timeout(plain: Difference, stopped: RunOutcome, first: RunOutcome) -> Difference:
    """Return the difference with the plugin whose code was running when the run timed out."""
    for place in stopped.stack:
        for name, (file, start, end) in first.sources.items():
            if place.file == file and start <= place.line < end:
                hints = tuple(hints_in(file, start, end))
                return replace(plain, owner=name, how=f"it was running {place.function} at {place}", hints=hints)
    return replace(plain, how=f"its last code position was {stopped.stack[0]}") if stopped.stack else plain


def _attribute_notes(rows: Sequence[Row]) -> list[str]:
    """Return notes about plugins whose attributes differ at the end of two runs although all outputs are equal."""
    first = rows[0].outcome
    notes: dict[str, None] = {}
    for row in rows[1:]:
        if not row.same:
            continue
        for owner, attributes in first.remembered.items():
            others = row.outcome.remembered.get(owner, {})
            names = [n for n in attributes if n in others and others[n] != attributes[n]]
            if names:
                note = f"has different attributes from run to run ({', '.join(names[:4])}); no output differs"
                notes[f"{owner} {note}"] = None
    return list(notes)
