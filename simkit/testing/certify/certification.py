"""Run a scenario in fresh processes with other surroundings, and put what they gave side by side."""

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
from typing import Any, Final, cast

from simkit.child_process import ChildProcesses, ProcessResult
from simkit.errors import InputError
from simkit.run_spec import JsonObject, LoadOptions, RunSpec
from simkit.testing.certify.certificate import Certificate, Difference, Row, streams_hash
from simkit.testing.certify.child_run import ChildRequest, run_child
from simkit.testing.certify.code_hints import hints_in
from simkit.testing.certify.outcome import STACK_FILE, CodePosition, RunOutcome, read_pickle, write_pickle
from simkit.testing.certify.outcome_comparison import Culprit, differences, find_culprit, first_tick
from simkit.testing.certify.variations import Variation, choose_variations

_FOLDERS: Final = ("resource_paths", "plugin_paths")
_LEAST_LIMIT, _TIMES = 60.0, 10.0  # a run has so many seconds, or so many times as long as the first took
_WATCHED: Final = 5.0  # times as long, where every call is noted
_SPARE_SECONDS: Final = 20.0  # [s] that a process has to end by itself after its limit
_FRAME: Final = re.compile(r'^  File "(.*)", line (\d+) in (.*)$', re.MULTILINE)


class ProcessRunner:
    """Runs a scenario in surroundings.

    Args:
        scenario: what is run.
        apart: whether each run has a process of its own.
        limit: wall time of a run [s]; where not given the first has none, and sets that of the others.

    Raises:
        InputError: SK-CERT-002 plugins that no other process can have.
    """

    def __init__(self, scenario: RunSpec, *, apart: bool, limit: float | None) -> None:
        self._plugins_from, self._scenario = _plugin_file(scenario), _with_absolute_paths(scenario)
        self._processes = ChildProcesses() if apart else None
        self._limit = limit

    def first(self, variation: Variation) -> RunOutcome:
        """The run that the others are compared with, to the scenario's end."""
        found = self.run(variation)
        if self._limit is None:
            self._limit = max(_LEAST_LIMIT, _TIMES * found.seconds)
        return found

    def run(self, variation: Variation, ticks: int | None = None) -> RunOutcome:
        """One run, to a tick; to the scenario's end where that is None."""
        request = ChildRequest(self._scenario, variation, ticks, plugins_from=self._plugins_from, limit=self._limit)
        return self._run(request)

    def watch(self, variation: Variation, ticks: int, half: int) -> RunOutcome:
        """One run whose plugins are watched at every call."""
        limit = None if self._limit is None else self._limit * _WATCHED
        return self._run(ChildRequest(self._scenario, variation, ticks, True, half, self._plugins_from, limit))

    def end(self) -> None:
        """Ends what runs, and begins nothing more."""
        if self._processes is not None:
            self._processes.end()

    def _run(self, request: ChildRequest) -> RunOutcome:
        return run_child(request) if self._processes is None else _run_in_process(request, self._processes)


def _run_in_process(request: ChildRequest, processes: ChildProcesses) -> RunOutcome:
    """Runs a request in a fresh process."""
    with tempfile.TemporaryDirectory(prefix="simkit-certify-", ignore_cleanup_errors=True) as made:
        folder = Path(made)
        own = folder / "here"
        own.mkdir()
        asked, result = folder / "request", folder / "result"
        write_pickle(asked, request)
        variation, limit = request.variation, request.limit
        ended = processes.run(
            "simkit.testing.certify",
            [str(asked), str(result)],
            environment=variation.environment(own),
            folder=variation.working_directory(own),
            limit=None if limit is None else limit + _SPARE_SECONDS,
        )
        with suppress(OSError, pickle.UnpicklingError, EOFError):
            found: RunOutcome = read_pickle(result)
            return found
        return _outcome_of_stopped_process(ended, limit, folder / STACK_FILE)


def _outcome_of_stopped_process(ended: ProcessResult, limit: float | None, stack: Path) -> RunOutcome:
    """What is known of a run that gave no result."""
    text = ""
    with suppress(OSError):
        text = stack.read_text(encoding="utf-8", errors="replace")
    main_thread = text.rpartition("\nThread ")[2]  # of several, the newest come first
    places = [CodePosition(file, int(line), name) for file, line, name in _FRAME.findall(main_thread)]
    if ended.is_late or text.startswith("Timeout"):
        said = f"it was still running after {limit:g} s of wall time and was ended; --wall-timeout gives it longer"
        return RunOutcome(stopped=said, stack=places)
    last = (ended.last_lines(1) or ["nothing was said"])[0]
    code = f"with {ended.code}"
    if ended.code < 0:
        known = -ended.code in set(signal.Signals)
        code = f"by signal {signal.Signals(-ended.code).name if known else -ended.code}"
    return RunOutcome(stopped=f"its process was ended {code}: {last}", stack=places)


def _plugin_file(scenario: RunSpec) -> Path | None:
    """The Python file that a fresh process can take the scenario's plugins from."""
    if not scenario.plugins:
        return None
    if scenario.file is not None and scenario.file.suffix.lower() == ".py":
        return scenario.file.absolute()
    message = "a fresh process cannot have plugins that were made in this one"
    hint = "write the scenario as a Python file with `scenario = RunSpec(..., plugins=(MyPlugin(),))`"
    raise InputError(f"SK-CERT-002 {message}; {hint}", "SK-CERT-002")


def _with_absolute_paths(scenario: RunSpec) -> RunSpec:
    """The scenario with paths that mean the same in every working directory."""

    def absolute(place: Any) -> str:
        return str(Path(place).expanduser().absolute())

    source = scenario.source
    if "<" not in source and Path(source).exists():
        source = str(Path(source).absolute())
    options: JsonObject = dict(scenario.options)
    if "<" in source:
        options["resource_paths"] = [*options.get("resource_paths", ()), Path.cwd()]
    for name in {*_FOLDERS} & options.keys():
        options[name] = [absolute(place) for place in options[name]]
    if options.get("package_paths"):
        options["package_paths"] = {name: absolute(place) for name, place in dict(options["package_paths"]).items()}
    if options.get("params_files"):
        given = options["params_files"]
        options["params_files"] = [_absolute_file(g) for g in ([given] if isinstance(given, (str, Path)) else given)]
    spawn = tuple(_absolute_file(text, ":") for text in scenario.spawn)
    folder, file = scenario.folder.absolute(), scenario.file and scenario.file.absolute()
    return replace(
        scenario, world=source, options=cast(LoadOptions, options), spawn=spawn, folder=folder, file=file, plugins=()
    )


def _absolute_file(text: Any, mark: str = "=") -> Any:
    """A file's name, with what may stand before or behind it, as an absolute path; what is no file stays."""
    if not isinstance(text, (str, Path)):
        return text
    if Path(text).exists():
        return str(Path(text).absolute())
    before, sign, behind = str(text).partition(mark)
    if sign and mark == "=" and Path(behind).exists():
        return f"{before}={Path(behind).absolute()}"
    if sign and mark == ":" and Path(before).exists():
        return f"{Path(before).absolute()}:{behind}"
    return text


_WATCH_ATTEMPTS: Final = 2  # looks at a difference that does not show when it is looked at
_TICK_MARGIN: Final = 2  # ticks after the first that differs

ProgressCallback = Callable[[Row], None]


def certify(
    scenario: RunSpec,
    *,
    runs: int = 6,
    variations: Sequence[Variation] | None = None,
    jobs: int = 1,
    apart: bool = True,
    wall_timeout: float | None = None,
    told: ProgressCallback | None = None,
) -> Certificate:
    """Runs a scenario several times, each in a fresh process with other surroundings, and compares what came of it.

    Args:
        scenario: what is run.
        runs: how many runs; the first ones of `VARIATIONS`, then those again with other hash seeds.
        variations: the surroundings instead, the first being what the others are compared with.
        jobs: how many processes at a time.
        apart: whether each has a process of its own. In this one, where a debugger can look, only who listens and what
            is done on the way can be other, and nothing has a limit.
        wall_timeout: of each run, in wall time [s]. Where not given the first has none, and the others have ten times
            as long as it took, at least a minute.
        told: called with each run once it is there.

    Raises:
        InputError: SK-CERT-001 fewer than two runs; SK-CERT-002 plugins that no other process can have; SK-CERT-004
            the first process ended, or did not end in time.
        LoadError: the world does not open.
        PluginError: a plugin of it does not.
    """
    chosen = choose_variations(runs) if variations is None else list(variations)
    if len(chosen) < 2:
        message = f"SK-CERT-001 found {len(chosen)} runs, allowed are at least 2: the first is compared with others"
        raise InputError(message, "SK-CERT-001")
    runner = ProcessRunner(scenario, apart=apart, limit=wall_timeout)
    first = runner.first(chosen[0])
    if first.failure is not None:
        raise first.failure
    if first.stopped:
        place = f" It stood at {first.stack[0]}." if first.stack else ""
        message = f"SK-CERT-004 the run {chosen[0].name!r} gave nothing: {first.stopped}.{place}"
        raise InputError(message, "SK-CERT-004")
    # how far the others are to go: where the first was stopped by an error, one step further than it came
    ticks = first.ticks + (1 if first.end else 0)
    told = told or (lambda _: None)
    rows = [Row(chosen[0], first, streams_hash(first), True)]
    told(rows[0])
    with ThreadPoolExecutor(max(1, jobs if apart else 1)) as pool:
        try:
            outcomes = pool.map(lambda variation: runner.run(variation, ticks), chosen[1:])
            for variation, outcome in zip(chosen[1:], outcomes, strict=True):
                rows.append(Row(variation, outcome, streams_hash(outcome), not differences(first, outcome)))
                told(rows[-1])
        except BaseException:  # Ctrl-C too: the pool waits for its threads, and they for their processes
            runner.end()
            raise
    known: dict[int, Difference] = {}
    found = [_explain_difference(row, rows[0], runner, ticks, known) for row in rows[1:] if not row.same]
    duration, notes = first.ticks * first.timestep, _attribute_notes(rows)
    return Certificate(scenario.title, scenario.world, duration, scenario.seed, rows, found, notes, first.fingerprint)


# ---------------------------------------------------------------------- what differs


def _explain_difference(
    row: Row, first: Row, runner: ProcessRunner, ticks: int, known: dict[int, Difference]
) -> Difference:
    """The first difference of a run, and who began it.

    Args:
        row, first: the run, and what it is compared with.
        runner: for running both again.
        ticks: how far they go.
        known: differences that are explained, by their first tick; this one is put there.
    """
    found = differences(first.outcome, row.outcome)
    tick, step = first_tick(found), first.outcome.timestep
    more = tuple(f.words for f in found[1:6])
    plain = Difference(row.variation, found[0].words, tick, None if tick is None else tick * step, more=more)
    if row.outcome.stopped:
        return _code_at_timeout(plain, row.outcome, first.outcome)
    if row.outcome.failure is not None:
        return plain
    if tick is not None and tick in known:  # no need to run it twice more
        return replace(known[tick], variation=row.variation, words=found[0].words, more=more)
    end, who = ticks if tick is None else min(ticks, tick + _TICK_MARGIN), None
    for _ in range(_WATCH_ATTEMPTS):
        who = find_culprit(*(runner.watch(r.variation, end, ticks // 2) for r in (first, row)))
        if who is not None:
            break
    made = _culprit_of_error(plain, who, first.outcome, found[0].owner)
    if tick is not None and made.owner:
        known[tick] = made
    return made


def _culprit_of_error(plain: Difference, who: Culprit | None, first: RunOutcome, owner: str) -> Difference:
    if who is None and not owner:
        how = "no plugin or sensor was seen to begin it; it did not show when it was looked at again"
        return replace(plain, how=how)
    name = who.owner if who is not None else owner
    file, start, end = first.sources.get(name, ("", 0, 0))
    hints = tuple(hints_in(file, start, end)) if file else ()
    if who is None:
        return replace(plain, owner=name, hints=hints)
    tick = who.tick if plain.tick is None or (who.matters and who.tick < plain.tick) else plain.tick
    return replace(plain, owner=name, how=who.how, hints=hints, tick=tick, time=tick * first.timestep)


def _code_at_timeout(plain: Difference, stopped: RunOutcome, first: RunOutcome) -> Difference:
    """With whose code it was that a run stood in when its time was over."""
    for place in stopped.stack:
        for name, (file, start, end) in first.sources.items():
            if place.file == file and start <= place.line < end:
                hints = tuple(hints_in(file, start, end))
                return replace(plain, owner=name, how=f"it stood in {place.function} at {place}", hints=hints)
    return replace(plain, how=f"it stood at {stopped.stack[0]}") if stopped.stack else plain


def _attribute_notes(rows: Sequence[Row]) -> list[str]:
    """Plugins that remember something else at the end though nothing that comes out shows it."""
    first = rows[0].outcome
    notes: dict[str, None] = {}
    for row in rows[1:]:
        if not row.same:
            continue
        for owner, attributes in first.remembered.items():
            others = row.outcome.remembered.get(owner, {})
            names = [n for n in attributes if n in others and others[n] != attributes[n]]
            if names:
                said = f"remembers something else from run to run ({', '.join(names[:4])}); nothing shows it"
                notes[f"{owner} {said}"] = None
    return list(notes)
