"""Golden runs in tests: the object behind pytest's fixture `sensor_regression`."""

from __future__ import annotations

import hashlib
import os
import re
import shlex
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final, cast

import pytest

from simkit.errors import InputError
from simkit.number_text import counted
from simkit.run_spec import EMPTY_SPACE, JsonMapping, JsonObject, LoadOptions, RunSpec, Tolerance, run_fields
from simkit.testing.golden.cause import explain
from simkit.testing.golden.compare.difference import Verdict
from simkit.testing.golden.compare.runs import compare
from simkit.testing.golden.report import text_report, write_html
from simkit.testing.run_record.record import RunRecord
from simkit.testing.scenarios.code_permission import add_options
from simkit.testing.scenarios.scenario_file import TOLERANCE_MODES, absolute_topic, read_scenario

if TYPE_CHECKING:
    from simkit.runtime import Simulation

_UNSAFE: Final = re.compile(r"[^A-Za-z0-9_.=-]+")
_PARAMETERS: Final = re.compile(r"([\w.]+)\[([^\[\]]+)\]")
_LONGEST: Final = 80  # maximum length of a folder name
_LINES: Final = 24  # maximum length of a report in a test failure
_BUDGET: Final = 20.0  # wall-clock limit of the search for causes [s]
_FILES: Final = (".yaml", ".yml", ".py")
_NUMBERS: Final = ("absolute", "relative", "share", "image", "ssim")  # numeric fields of a tolerance
_SCENARIO_ARGUMENTS: Final = (
    *(name for name, one in run_fields().items() if one.is_loaded and not one.is_load_option and name != "seed"),
    "plugins",
)
"""Arguments of `simkit.load` that are fields of a scenario."""


@dataclass
class GoldenLocation:
    """Folder and options of a test's golden runs.

    Attributes:
        folder: `golden/<stem of the test's file>` in the folder of that file.
        name: Name of the test with its class and parameters.
        beside: Folder of the test's file; worlds are searched in it first.
        test: Node id of the test in pytest.
        reason: Reason for writing new golden runs; None to compare with the present ones.
        other_renderer: Allow pictures of another renderer to be written.
        pages: Folder for an HTML page of each run that differs; None for no pages.
        done: Sentences about golden runs that were written or unchanged, for pytest's summary.
    """

    folder: Path
    name: str
    beside: Path
    test: str
    reason: str | None = None
    other_renderer: bool = False
    pages: Path | None = None
    done: list[str] = field(default_factory=list)

    @property
    def short_test(self) -> str:
        """Node id of the test without folders, which depend on pytest's working directory."""
        file, colons, name = self.test.partition("::")
        return file.rpartition("/")[2] + colons + name


class SensorRegression:
    """Comparison of runs with golden runs in a test; the value of the fixture `sensor_regression`.

    Args:
        place: Folder and options of the golden runs.
        keep: Function that receives every loaded simulation, with a label, and closes the simulation after the test.
    """

    def __init__(self, place: GoldenLocation, keep: Callable[[Simulation, str], None]) -> None:
        self._place, self._keep = place, keep
        self._used: set[str] = set()

    def __call__(
        self,
        what: RunSpec | Simulation | str | os.PathLike[str],
        *,
        name: str | None = None,
        duration: float | None = None,
        topics: str | Sequence[str] | None = None,
        skip: str | Sequence[str] | None = None,
        tolerances: Mapping[str, object] | Sequence[Tolerance] = (),
        seed: int | None = None,
        allow_code: bool = False,
        **options: object,
    ) -> Verdict:
        """Run a world or scenario, and fail the test if the result differs from the golden run.

        Args:
            what: World (a file in the test's folder, a bare name or XML text), scenario, scenario file, or a
                simulation, which continues from its present state.
            name: Name that distinguishes several golden runs of one test.
            duration: Simulated time [s]; default 10.
            topics: Patterns of recorded topics; default all topics except clocks.
            skip: Patterns of topics to leave out.
            tolerances: Tolerances by topic or field (`{"/scan": 0.01, "/imu": "statistics", "/odom": {"relative":
                0.01}}`), or objects of `simkit.run_spec.Tolerance`. They have priority over the tolerances of a
                scenario. Numeric tolerances also apply on the machine that recorded the golden run; then only topics
                are compared.
            seed: Seed of the sensor noise.
            allow_code: Allow the plugin folders that a scenario file names; `plugin_paths` allows single ones.
            options: Further arguments of `simkit.load`: `plugins`, `overrides`, `resource_paths`, …

        Returns:
            Verdict of the comparison.

        Raises:
            pytest.fail.Exception: The run differs from the golden run, or there is no golden run yet.
            InputError: The world or an argument is invalid.
        """
        from simkit.testing.run_record.run_recorder import record_run

        scenario, sim = self._scenario(what)
        named = {"duration": duration, "seed": seed, "topics": _topic_patterns(topics), "skip": _topic_patterns(skip)}
        arguments = {key: value for key, value in {**named, **options}.items() if value is not None}
        scenario = _with_arguments(scenario, arguments, is_open=sim is not None, allow_code=allow_code)
        scenario = _with_tolerances(scenario, tolerances)
        if sim is not None or scenario.plugins:
            scenario = replace(scenario, test=self._place.short_test)
        place = self._place_for(name)
        self._require_golden(place)
        start = time.perf_counter()
        record = record_run(scenario, sim=sim)
        if record.simulation is not None and sim is None:
            self._keep(record.simulation, scenario.title)
        return self._compare_or_write(place, record, time.perf_counter() - start, again=not scenario.test)

    @contextmanager
    def of(
        self,
        sim: Simulation,
        *,
        name: str | None = None,
        topics: str | Sequence[str] | None = None,
        skip: str | Sequence[str] | None = None,
        tolerances: Mapping[str, object] | Sequence[Tolerance] = (),
        duration: float = 10.0,
    ) -> Iterator[None]:
        """Record a simulation that the test steps itself, and compare at the end of the `with` block.

        Args:
            sim: Simulation in any state.
            name: See `__call__`.
            topics: See `__call__`.
            skip: See `__call__`.
            tolerances: See `__call__`.
            duration: Approximate duration of the run [s]; it determines the interval between recorded states.

        Raises:
            pytest.fail.Exception: At the end of the block, the run differs from the golden run, or there is none yet.
        """
        from simkit.testing.run_record.run_recorder import RunRecorder

        place = self._place_for(name)
        scenario = replace(
            self._scenario(sim)[0],
            duration=duration,
            topics=_topic_patterns(topics) or (),
            skip=_topic_patterns(skip) or (),
            test=self._place.short_test,
        )
        scenario = _with_tolerances(scenario, tolerances)
        start, tick = time.perf_counter(), sim.tick
        with RunRecorder(scenario, sim, duration) as capture:
            yield
            scenario = replace(scenario, duration=(sim.tick - tick) * sim.timestep)
            record = replace(capture.record(), scenario=scenario)
        self._require_golden(place)
        self._compare_or_write(place, record, time.perf_counter() - start, again=False)

    def _place_for(self, name: str | None) -> Path:
        folder = safe_name(self._place.name) + ("" if name is None else f"+{safe_name(name)}")
        if folder in self._used:
            raise InputError(
                "SK-GOLDEN-020",
                f"this test already has a golden run {folder!r}",
                help='give each run of the test its own name: sensor_regression(…, name="second")',
            )
        self._used.add(folder)
        return self._place.folder / folder

    def _scenario(self, what: RunSpec | Simulation | str | os.PathLike[str]) -> tuple[RunSpec, Simulation | None]:
        """Return the scenario to run, and the simulation if it is already loaded."""
        if isinstance(what, RunSpec):
            beside = self._place.beside if what.folder == Path() and what.file is None else what.folder
            return replace(what, folder=beside), None
        if isinstance(what, (str, os.PathLike)):
            text = os.fspath(what)
            if "<" in text:
                return RunSpec(text, folder=self._place.beside), None
            beside = self._place.beside / text
            if beside.suffix.lower() in _FILES:
                return read_scenario(beside if beside.is_file() else Path(text)), None
            return RunSpec(text, folder=self._place.beside if beside.exists() else Path.cwd()), None
        if not hasattr(what, "mj_model"):
            raise InputError(
                "SK-GOLDEN-021",
                f"sensor_regression: found {type(what).__name__}, expected a world, a scenario or a simulation",
            )
        loaded = what.run_spec
        world = loaded.world if loaded is not None else str(what.world.where.file if what.world.where else "")
        folder = loaded.folder if loaded is not None else self._place.beside
        around = EMPTY_SPACE if loaded is None else loaded.model_world
        return RunSpec(world or what.world.name, seed=what.seed, model_world=around, folder=folder), what

    def _require_golden(self, place: Path) -> None:
        from simkit.testing.golden.store import is_golden

        if self._place.reason is None and not is_golden(place):
            problem = f"there is no golden run {_short_path(place)} yet"
            help_ = f"    help: pytest {shlex.quote(self._place.test)} --simkit-update-golden"
            pytest.fail(f"{problem}\n{help_}", pytrace=False)

    def _compare_or_write(self, place: Path, record: RunRecord, elapsed: float, *, again: bool) -> Verdict:
        """Compare a run with its golden run; if a reason is set, write the run as the new golden run."""
        from simkit.testing.golden.check import make_golden, refuse_failed
        from simkit.testing.golden.store import is_golden, read_golden, write_golden

        writes = self._place.reason is not None
        if writes:
            refuse_failed(record, place)
            for result in record.checks:
                if not result.passed:
                    problem = f"{place}: a check failed, so the run cannot become golden: {result.check.title}"
                    raise InputError("SK-GOLDEN-007", f"{problem}: {result.message}")
        if writes and not is_golden(place):
            write_golden(place, record, reason=self._place.reason or "")
            self._place.done.append(f"written: {_short_path(place)}")
            return Verdict(place.name, record, record, compare(record, record), None, record.checks, elapsed)
        golden = read_golden(place)
        verdict = Verdict(place.name, golden, record, compare(golden, record), None, record.checks, elapsed)
        if writes:
            if verdict.comparison.passed:
                self._place.done.append(f"unchanged: {_short_path(place)}")
            else:
                make_golden(place, verdict, self._place.reason or "", other_renderer=self._place.other_renderer)
                self._place.done.append(f"changed: {_short_path(place)}: {verdict.comparison.differences[0].words}")
        elif not verdict.passed:
            self._fail(place, verdict, again=again)
        return verdict

    def _fail(self, place: Path, verdict: Verdict, *, again: bool) -> None:
        if not verdict.comparison.passed:
            both = verdict.golden, verdict.run, verdict.comparison
            if again:
                verdict.explanation = explain(*both, budget_s=_BUDGET)
            else:  # only the test itself can repeat this run
                verdict.explanation = explain(*both, rerun=None)
        lines = text_report(verdict, 100, most=8, mark="")
        if len(lines) > _LINES:
            lines = [*lines[:_LINES], f"  … and {counted(len(lines) - _LINES, 'more line')}"]
        command = f"pytest {shlex.quote(self._place.test)} --simkit-update-golden"
        command += ' --simkit-golden-reason "reason for the change"'
        if self._place.pages is not None:
            page = self._place.pages / f"{self._place.folder.name}-{place.name}.html"
            write_html(page, [verdict], bless=command)
            lines.append(f"  page    {_short_path(page)}")
        lines.append(f"  golden  {_short_path(place)}")
        pytest.fail("\n".join([*lines, f"  bless   {command}"]), pytrace=False)


def safe_name(text: str) -> str:
    """Convert a test name to a folder name; different names give different folders.

    `test_scan[2.0]` becomes `test_scan-2.0`. Names with characters that are unsafe in file names get a hash.
    """
    parameters = _PARAMETERS.fullmatch(text)
    text = f"{parameters[1]}-{parameters[2]}" if parameters else text
    plain = _UNSAFE.sub("-", text).strip(".-") or "run"
    if plain == text and len(plain) <= _LONGEST:
        return plain
    return f"{plain[:_LONGEST]}-{hashlib.sha256(text.encode('utf-8', 'surrogatepass')).hexdigest()[:8]}"


def _with_arguments(scenario: RunSpec, arguments: JsonObject, *, is_open: bool, allow_code: bool) -> RunSpec:
    """Return a scenario whose fields are replaced by a test's arguments."""
    scenario_fields = {
        key: arguments.pop(key)
        for key in ("duration", "seed", "topics", "skip", *_SCENARIO_ARGUMENTS)
        if key in arguments
    }
    if is_open and (arguments or {"seed", *_SCENARIO_ARGUMENTS} & scenario_fields.keys()):
        wrong = ", ".join(sorted([*arguments, *({"seed", *_SCENARIO_ARGUMENTS} & scenario_fields.keys())]))
        raise InputError(
            "SK-GOLDEN-021", f"sensor_regression: {wrong}: not possible for a simulation that is already loaded"
        )
    for key, value in scenario_fields.items():
        if isinstance(getattr(scenario, key), tuple):
            scenario_fields[key] = (value,) if isinstance(value, str) else tuple(value)
    return replace(add_options(scenario, cast(LoadOptions, arguments), allow_code), **scenario_fields)


def _topic_patterns(patterns: str | Sequence[str] | None) -> tuple[str, ...] | None:
    """Return patterns of topics with leading slashes."""
    if patterns is None:
        return None
    return tuple(map(absolute_topic, (patterns,) if isinstance(patterns, str) else patterns))


def _with_tolerances(scenario: RunSpec, tolerances: Mapping[str, object] | Sequence[Tolerance]) -> RunSpec:
    """Return a scenario in which a test's tolerances have priority; numeric tolerances apply on every machine."""
    parsed = _parse_tolerances(tolerances)
    if any(getattr(t, name) is not None for t in parsed if not t.statistics for name in _NUMBERS):
        scenario = replace(scenario, bits=False, state=False, model=False)
    return replace(scenario, tolerances=(*parsed, *scenario.tolerances))


def _parse_tolerances(tolerances: JsonMapping | Sequence[Tolerance]) -> tuple[Tolerance, ...]:
    """Parse tolerances in the form of a scenario file; accept `Tolerance` objects too."""
    if not isinstance(tolerances, Mapping):
        return tuple(tolerances)
    parsed = []
    for pattern, value in tolerances.items():
        fields: JsonMapping
        if isinstance(value, Tolerance):
            parsed.append(replace(value, pattern=absolute_topic(pattern)))
            continue
        if isinstance(value, str) and value in TOLERANCE_MODES:
            fields = {value: True}
        elif isinstance(value, Mapping) and all(map(_is_valid_tolerance, value, value.values())):
            fields = value
        elif _is_valid_tolerance("absolute", value):
            fields = {"absolute": float(value)}
        else:
            raise _tolerance_error(pattern, value)
        parsed.append(Tolerance(absolute_topic(pattern), **fields))
    return tuple(parsed)


def _is_valid_tolerance(name: object, value: object) -> bool:
    """Check whether a field of a tolerance accepts a value."""
    if name in _NUMBERS:
        return isinstance(value, (int, float)) and not isinstance(value, bool) and value >= 0
    return name in TOLERANCE_MODES and isinstance(value, bool)


def _tolerance_error(pattern: str, value: object) -> InputError:
    names = ", ".join(name for name in Tolerance.__dataclass_fields__ if name not in ("pattern", "where"))
    return InputError(
        "SK-GOLDEN-021",
        f"sensor_regression: tolerances[{pattern!r}]: found {value!r:.80}, expected a number >= 0, "
        f"one of {', '.join(TOLERANCE_MODES)}, or a mapping of {names}",
    )


def _short_path(path: Path) -> str:
    """Return the path relative to the working directory, if the path is below it."""
    relative = os.path.relpath(path)
    return relative if not relative.startswith("..") else str(path)
