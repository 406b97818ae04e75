"""Runs of one scenario, each in a process of its own with other surroundings."""

from __future__ import annotations

import pickle
import re
import signal
import tempfile
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any, Final, cast

from simkit.child_process import ChildProcesses, ProcessResult
from simkit.errors import InputError
from simkit.run_spec import JsonObject, LoadOptions, RunSpec
from simkit.testing.certify.child_run import ChildRequest
from simkit.testing.certify.child_run import run_child as run_here
from simkit.testing.certify.outcome import STACK_FILE, CodePosition, RunOutcome, read_pickle, write_pickle
from simkit.testing.certify.variations import Variation

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
        found = self._run(ChildRequest(self._scenario, variation, plugins_from=self._plugins_from, limit=self._limit))
        if self._limit is None:
            self._limit = max(_LEAST_LIMIT, _TIMES * found.seconds)
        return found

    def run(self, variation: Variation, ticks: int) -> RunOutcome:
        """One run, to a tick."""
        return self._run(ChildRequest(self._scenario, variation, ticks, False, None, self._plugins_from, self._limit))

    def watch(self, variation: Variation, ticks: int, half: int) -> RunOutcome:
        """One run whose plugins are watched at every call."""
        limit = None if self._limit is None else self._limit * _WATCHED
        return self._run(ChildRequest(self._scenario, variation, ticks, True, half, self._plugins_from, limit))

    def end(self) -> None:
        """Ends what runs, and begins nothing more."""
        if self._processes is not None:
            self._processes.end()

    def _run(self, request: ChildRequest) -> RunOutcome:
        return run_here(request) if self._processes is None else _run_in_process(request, self._processes)


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
    code = f"with {ended.code}" if ended.code >= 0 else f"by signal {_signal_name(-ended.code)}"
    return RunOutcome(stopped=f"its process was ended {code}: {last}", stack=places)


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return str(number)


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
    source = scenario.source
    if "<" not in source and Path(source).exists():
        source = str(Path(source).absolute())
    options: JsonObject = dict(scenario.options)
    if "<" in source:
        options["resource_paths"] = [*options.get("resource_paths", ()), Path.cwd()]
    for name in _FOLDERS:
        if name in options:
            options[name] = [str(Path(place).expanduser().absolute()) for place in options[name]]
    if options.get("package_paths"):
        pairs = dict(options["package_paths"]).items()
        options["package_paths"] = {name: str(Path(place).expanduser().absolute()) for name, place in pairs}
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
