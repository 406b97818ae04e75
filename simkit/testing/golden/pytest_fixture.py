"""Golden runs in tests: what pytest's fixture `sensor_regression` gives."""

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
from typing import TYPE_CHECKING, Any, Final, cast

import pytest

from simkit.errors import InputError
from simkit.run_spec import JsonMapping, JsonObject, LoadOptions, RunSpec, Tolerance
from simkit.testing.golden.cause import explain
from simkit.testing.golden.compare.difference import Verdict
from simkit.testing.golden.compare.runs import compare
from simkit.testing.golden.report import text_report, write_html
from simkit.testing.run_record.record import RunRecord
from simkit.testing.scenarios.scenario_file import TOLERANCE_MODES, absolute_topic, read_scenario

if TYPE_CHECKING:
    from simkit.runtime import Simulation

_UNSAFE: Final = re.compile(r"[^A-Za-z0-9_.=-]+")
_PARAMETERS: Final = re.compile(r"([\w.]+)\[([^\[\]]+)\]")
_LONGEST: Final = 80  # letters of a folder's name
_LINES: Final = 24  # of a report that a failure shows
_BUDGET: Final = 20.0  # [s] of wall time for finding the cause
_FILES: Final = (".yaml", ".yml", ".py")
_NUMBERS: Final = ("absolute", "relative", "share", "image", "ssim")  # of a tolerance
_SCENARIO_ARGUMENTS: Final = ("overrides", "spawn", "plugins")  # of `simkit.load`, which a scenario has fields for


@dataclass
class GoldenLocation:
    """Where a test's golden runs are, and what becomes of them.

    Attributes:
        folder: `golden/<stem of the test's file>` beside that file.
        name: of the test, its class and parameters included.
        beside: folder of the test's file, where worlds are looked for first.
        test: pytest's name of the test.
        reason: why golden runs are written anew; None to compare.
        other_renderer: whether that may be with pictures of another renderer.
        pages: folder that gets a page for each run that differs; None for none.
        done: what was done, in sentences, for the end of all tests.
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
        """Its name without the folders, which depend on where pytest is run."""
        file, colons, name = self.test.partition("::")
        return file.rpartition("/")[2] + colons + name


class SensorRegression:
    """Compares what runs give with golden runs beside the test; what the fixture `sensor_regression` gives.

    Args:
        place: where those are.
        keep: is given every simulation that is opened, to close it when the test ends.
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
        **options: object,
    ) -> Verdict:
        """Runs, and fails the test where what comes is not golden.

        Args:
            what: a world (a file beside the test, a bare name, XML text), a scenario or its file, or a simulation,
                which goes on from where it stands.
            name: tells several golden runs of one test apart.
            duration: simulated time [s]; 10 where nothing says it.
            topics: patterns of those that are looked at; all but clocks where nothing says it.
            skip: patterns of those that are left out.
            tolerances: by topic or field (`{"/scan": 0.01, "/imu": "statistics", "/odom": {"relative": 0.01}}`), or
                `simkit.run_spec.Tolerance`. They go before a scenario's. Numbers among them count on the same
                machine too, and then nothing but topics is compared.
            seed: of the noise.
            options: further ones of `simkit.load`: `plugins`, `overrides`, `resource_paths`, …

        Returns:
            What was found, for further questions.

        Raises:
            pytest.fail.Exception: the run is not its golden one, or there is none yet.
            InputError: the world or an argument cannot be used.
        """
        from simkit.testing.run_record.run_recorder import run_record

        scenario, sim = self._scenario(what)
        said = {"duration": duration, "seed": seed, "topics": _topic_patterns(topics), "skip": _topic_patterns(skip)}
        given = {key: value for key, value in {**said, **options}.items() if value is not None}
        scenario = _with_tolerances(_with_arguments(scenario, given, sim is not None), tolerances)
        if sim is not None or scenario.plugins:
            scenario = replace(scenario, test=self._place.short_test)
        place = self._place_for(name)
        self._demand_golden(place)
        start = time.perf_counter()
        record = run_record(scenario, sim=sim)
        if sim is None:
            self._keep(record.simulation, scenario.title)
        return self._judged(place, record, time.perf_counter() - start, again=not scenario.test)

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
        """Listens while the test steps a simulation by itself, and judges at the end of the `with` block.

        Args:
            sim: the simulation, wherever it stands.
            name, topics, skip, tolerances: as when called.
            duration: about how long it will run [s]: how densely states are kept.

        Raises:
            pytest.fail.Exception: at the end: the run is not its golden one, or there is none yet.
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
        self._demand_golden(place)
        self._judged(place, record, time.perf_counter() - start, again=False)

    def _place_for(self, name: str | None) -> Path:
        folder = safe_name(self._place.name) + ("" if name is None else f"+{safe_name(name)}")
        if folder in self._used:
            raise InputError(
                f"SK-GOLDEN-020 this test has a golden run {folder!r} already\n"
                '    help: sensor_regression(…, name="second") tells them apart',
                "SK-GOLDEN-020",
            )
        self._used.add(folder)
        return self._place.folder / folder

    def _scenario(self, what: Any) -> tuple[RunSpec, Simulation | None]:
        """What is to be run, and the simulation where it is open already."""
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
                f"SK-GOLDEN-021 sensor_regression: found {type(what).__name__}, allowed is a world, a scenario or a "
                "simulation",
                "SK-GOLDEN-021",
            )
        loaded = what.run_spec
        world = loaded.world if loaded is not None else str(what.world.where.file if what.world.where else "")
        folder = loaded.folder if loaded is not None else self._place.beside
        return RunSpec(world or what.world.name, seed=what.seed, folder=folder), what

    def _demand_golden(self, place: Path) -> None:
        from simkit.testing.golden.store import is_golden

        if self._place.reason is None and not is_golden(place):
            said = f"there is no golden run {_short_path(place)} yet\n    help: pytest {shlex.quote(self._place.test)}"
            pytest.fail(f"{said} --simkit-update-golden", pytrace=False)

    def _judged(self, place: Path, record: RunRecord, elapsed: float, *, again: bool) -> Verdict:
        """Compares a run with its golden one, or makes it the golden one."""
        from simkit.testing.golden.check import make_golden, refuse_failed
        from simkit.testing.golden.store import is_golden, read_golden, write_golden

        writes = self._place.reason is not None
        if writes:
            refuse_failed(record, place)
            for result in record.checks:
                if not result.passed:
                    said = f"{place}: a check does not hold, and the run is not made golden: {result.check.title}"
                    raise InputError(f"SK-GOLDEN-007 {said}: {result.message}", "SK-GOLDEN-007")
        if writes and not is_golden(place):
            write_golden(place, record, reason=self._place.reason or "")
            self._place.done.append(f"written: {_short_path(place)}")
            return Verdict(place.name, record, record, compare(record, record), None, record.checks, elapsed)
        golden = read_golden(place)
        verdict = Verdict(place.name, golden, record, compare(golden, record), None, record.checks, elapsed)
        if writes:
            if verdict.comparison.passed:
                self._place.done.append(f"as it was: {_short_path(place)}")
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
            else:  # what only the test can do again is not tried again
                verdict.explanation = explain(*both, rerun=None)
        lines = text_report(verdict, 100, most=8, mark="")
        if len(lines) > _LINES:
            lines = [*lines[:_LINES], f"  … and {len(lines) - _LINES} lines more"]
        command = f"pytest {shlex.quote(self._place.test)} --simkit-update-golden"
        command += ' --simkit-golden-reason "why it is meant"'
        if self._place.pages is not None:
            page = self._place.pages / f"{self._place.folder.name}-{place.name}.html"
            write_html(page, [verdict], bless=command)
            lines.append(f"  page    {_short_path(page)}")
        lines.append(f"  golden  {_short_path(place)}")
        pytest.fail("\n".join([*lines, f"  bless   {command}"]), pytrace=False)


def safe_name(text: str) -> str:
    """A folder's name for any name of a test; other names give other ones.

    `test_scan[2.0]` is `test_scan-2.0`; names with letters that files had better not have get a hash.
    """
    parameters = _PARAMETERS.fullmatch(text)
    text = f"{parameters[1]}-{parameters[2]}" if parameters else text
    plain = _UNSAFE.sub("-", text).strip(".-") or "run"
    if plain == text and len(plain) <= _LONGEST:
        return plain
    return f"{plain[:_LONGEST]}-{hashlib.sha256(text.encode('utf-8', 'surrogatepass')).hexdigest()[:8]}"


def _with_arguments(scenario: RunSpec, given: JsonObject, is_open: bool) -> RunSpec:
    """A scenario with arguments over its own."""
    own = {key: given.pop(key) for key in ("duration", "seed", "topics", "skip", *_SCENARIO_ARGUMENTS) if key in given}
    if is_open and (given or {"seed", *_SCENARIO_ARGUMENTS} & own.keys()):
        wrong = ", ".join(sorted([*given, *({"seed", *_SCENARIO_ARGUMENTS} & own.keys())]))
        raise InputError(
            f"SK-GOLDEN-021 sensor_regression: {wrong}: of a simulation that is open already this cannot be chosen",
            "SK-GOLDEN-021",
        )
    for key in _SCENARIO_ARGUMENTS:
        if key in own:
            own[key] = (own[key],) if isinstance(own[key], str) else tuple(own[key])
    return replace(scenario, **own, options=cast(LoadOptions, {**scenario.options, **given}))


def _topic_patterns(patterns: str | Sequence[str] | None) -> tuple[str, ...] | None:
    """Patterns of topics, with their leading slashes."""
    if patterns is None:
        return None
    return tuple(map(absolute_topic, (patterns,) if isinstance(patterns, str) else patterns))


def _with_tolerances(scenario: RunSpec, given: Mapping[str, object] | Sequence[Tolerance]) -> RunSpec:
    """A scenario with a test's tolerances before its own: who gives numbers means them on every machine."""
    own = _parse_tolerances(given)
    if any(getattr(t, name) is not None for t in own if not t.statistics for name in _NUMBERS):
        scenario = replace(scenario, bits=False, state=False, model=False)
    return replace(scenario, tolerances=(*own, *scenario.tolerances))


def _parse_tolerances(given: JsonMapping | Sequence[Tolerance]) -> tuple[Tolerance, ...]:
    """Tolerances as a scenario's file says them, or made already."""
    if not isinstance(given, Mapping):
        return tuple(given)
    found = []
    for pattern, value in given.items():
        said: JsonMapping
        if isinstance(value, Tolerance):
            found.append(replace(value, pattern=absolute_topic(pattern)))
            continue
        if isinstance(value, str) and value in TOLERANCE_MODES:
            said = {value: True}
        elif isinstance(value, Mapping) and all(map(_is_valid_tolerance, value, value.values())):
            said = value
        elif _is_valid_tolerance("absolute", value):
            said = {"absolute": float(value)}
        else:
            raise _tolerance_error(pattern, value)
        found.append(Tolerance(absolute_topic(pattern), **said))
    return tuple(found)


def _is_valid_tolerance(name: object, value: object) -> bool:
    """Whether a field of a tolerance may have a value."""
    if name in _NUMBERS:
        return isinstance(value, (int, float)) and not isinstance(value, bool) and value >= 0
    return name in TOLERANCE_MODES and isinstance(value, bool)


def _tolerance_error(pattern: str, value: object) -> InputError:
    names = ", ".join(name for name in Tolerance.__dataclass_fields__ if name not in ("pattern", "where"))
    return InputError(
        f"SK-GOLDEN-021 sensor_regression: tolerances[{pattern!r}]: found {value!r:.80}, allowed is a number of at "
        f"least 0, one of {', '.join(TOLERANCE_MODES)}, or a mapping of {names}",
        "SK-GOLDEN-021",
    )


def _short_path(path: Path) -> str:
    """As seen from the working directory, where that is shorter."""
    relative = os.path.relpath(path)
    return relative if not relative.startswith("..") else str(path)
