"""Grade plugins that were handed in for an exercise, and report the grades."""

from __future__ import annotations

import json
import os
import secrets
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from simkit.child_process import ChildProcesses
from simkit.errors import InputError
from simkit.run_spec import JsonObject
from simkit.testing.junit import JunitCase
from simkit.testing.scenarios.exercise import Exercise, ExerciseRun

_SPARE_SECONDS: Final = 20.0  # [s] of wall time beside a run's own, for the start and the end of its process
_MAX_LINES_SHOWN: Final = 20  # last lines of what was printed that are kept


@dataclass(frozen=True)
class CheckGrade:
    """One check of a run.

    Attributes:
        title: of the check.
        passed: whether it held.
        message: what was found, in words.
        points: got.
        worth: points that it is worth.
        hint: what helps where it did not hold.
        time: when it was decided [s].
    """

    title: str
    passed: bool
    message: str
    points: float
    worth: float
    hint: str = ""
    time: float = 0.0


@dataclass(frozen=True)
class RunGrade:
    """One run.

    Attributes:
        name: of the run.
        seed: of its noise.
        time: how far it came, simulated [s].
        marks: its checks.
        error: what ended it before its time; empty where nothing did.
        printed: last lines that it printed.
    """

    name: str
    seed: int
    time: float
    marks: tuple[CheckGrade, ...]
    error: str = ""
    printed: str = ""


@dataclass(frozen=True)
class Grade:
    """What was handed in, and what it got.

    Attributes:
        exercise: what was asked.
        hand_in: the plugin's file; empty where there is none.
        outcomes: of every run.
        label: a short name of its own among those that are graded together.
    """

    exercise: Exercise
    hand_in: str
    outcomes: tuple[RunGrade, ...]
    label: str = ""

    @property
    def points(self) -> float:
        """Points got."""
        return sum(mark.points for outcome in self.outcomes for mark in outcome.marks)

    @property
    def worth(self) -> float:
        """Points that could be had."""
        return sum(mark.worth for outcome in self.outcomes for mark in outcome.marks)

    @property
    def passed(self) -> bool:
        """Whether the points are enough."""
        return self.points >= self.exercise.pass_mark * self.worth - 1e-9


def grade(exercise: Exercise, hand_in: Path | None = None, pictures: Path | None = None) -> Grade:
    """Runs an exercise with what was handed in, each run in a process of its own.

    Args:
        exercise: what is asked.
        hand_in: file of the plugin; None where the exercise brings all there is.
        pictures: folder for a picture of each run's path.

    Raises:
        InputError: the exercise itself is at fault: its world, its commands or what it asks for.
    """
    (graded,) = grade_all(exercise, [hand_in], pictures)
    return graded


def grade_all(
    exercise: Exercise, hand_ins: Sequence[Path | None], pictures: Path | None = None, jobs: int = 1
) -> Iterator[Grade]:
    """Runs an exercise with several plugins, in their order; what each got comes as soon as it is known.

    Args:
        exercise: what is asked.
        hand_ins: files of plugins; None for one that the exercise brings itself.
        pictures: folder for a picture of each run's path.
        jobs: processes at a time.

    Raises:
        InputError: the exercise itself is at fault.
    """
    names = short_labels(hand_ins)
    processes = ChildProcesses()
    with ThreadPoolExecutor(jobs) as pool:

        def outcome(hand_in: Path | None, name: str, number: int) -> RunGrade:
            picture = "" if pictures is None else str((pictures / f"{name or 'exercise'}_{number + 1}.png").absolute())
            return _run_grade(processes, exercise, number, hand_in, picture)

        runs = range(len(exercise.runs))
        asked = [
            (hand_in, name, [pool.submit(outcome, hand_in, name, number) for number in runs])
            for hand_in, name in zip(hand_ins, names, strict=True)
        ]
        try:
            for hand_in, name, outcomes in asked:
                file = "" if hand_in is None else str(hand_in)
                yield Grade(exercise, file, tuple(one.result() for one in outcomes), name)
        finally:  # also where somebody asks for no more: what waits is left, what runs is ended
            pool.shutdown(wait=False, cancel_futures=True)
            processes.end()


def short_labels(hand_ins: Sequence[Path | None]) -> list[str]:
    """A short name for each: of its file, with that of its folder before it where two files have one name."""
    stems = ["" if file is None else file.stem for file in hand_ins]
    longer = [
        stem if file is None or stems.count(stem) == 1 else f"{file.absolute().parent.name}_{stem}"
        for file, stem in zip(hand_ins, stems, strict=True)
    ]
    return [
        name if longer.count(name) == 1 else f"{name}_{longer[:number].count(name) + 1}"
        for number, name in enumerate(longer)
    ]


def _run_grade(
    processes: ChildProcesses, exercise: Exercise, number: int, hand_in: Path | None, picture: str
) -> RunGrade:
    variation = exercise.runs[number]
    checks = _required_checks(variation)
    found, printed = _run_in_process(processes, exercise, number, hand_in, picture)
    error = found.get("error", "")
    results = found.get("results") or [(False, "the run ended before its time", found["time"])] * len(checks)
    marks = [
        CheckGrade(title, passed, message, worth if passed else 0.0, worth, "" if passed else hint, time)
        for (title, worth, hint), (passed, message, time) in zip(checks, results, strict=True)
    ]
    return RunGrade(variation.name, variation.scenario.seed, found["time"], tuple(marks), error, printed)


def _required_checks(variation: ExerciseRun) -> list[tuple[str, float, str]]:
    """Title, points and hint of everything that must hold, in the order of the results."""
    scenario = variation.scenario
    until = [(f"until {scenario.until}", 1.0, "")] if scenario.until else []
    return until + [(check.title, check.points, check.hint) for check in scenario.checks]


def _run_in_process(
    processes: ChildProcesses, exercise: Exercise, number: int, hand_in: Path | None, picture: str
) -> tuple[JsonObject, str]:
    """What a run gave, and what it printed."""
    variation = exercise.runs[number]
    limit = (variation.scenario.wall_timeout or 0.0) + _SPARE_SECONDS
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        target = Path(folder) / "result.json"
        token = secrets.token_hex()
        job = {
            "exercise": str(exercise.file.absolute()),
            "hand_in": "" if hand_in is None else str(hand_in.absolute()),
            "number": number,
            "target": str(target),
            "picture": picture,
            "token": token,
        }
        asked = Path(folder) / "job.json"
        asked.write_text(json.dumps(job), encoding="utf-8")
        environment = {**os.environ, "PYTHONIOENCODING": "utf-8"}
        done = processes.run(
            "simkit.testing.scenarios.grading_process", [str(asked)], environment=environment, limit=limit
        )
        printed = "\n".join(done.last_lines(_MAX_LINES_SHOWN))
        if done.is_late:
            message = f"it was still running after {limit:g} s of wall time and was ended: a loop without an end?"
            return {"error": message, "time": 0.0}, printed
        found = _read_process_result(target, token, len(_required_checks(variation)))
    if found is None:
        how = f"with {done.code}" if done.code >= 0 else f"by signal {-done.code}"
        return {"error": f"its process ended {how} in the middle of the run", "time": 0.0}, printed
    if "fault" in found:
        raise InputError(f"{exercise.file}: {variation.name}: {found['fault']}", found["code"])
    return found, printed


def _read_process_result(target: Path, token: str, count: int) -> JsonObject | None:
    """What a run left behind; None where that is not what simkit writes: what was handed in can write there too."""
    try:
        found = json.loads(target.read_text(encoding="utf-8")) if target.is_file() else None
    except (OSError, ValueError):
        return None
    if not isinstance(found, dict) or found.pop("token", None) != token:
        return None
    return found if "error" in found or "fault" in found or len(found.get("results", ())) == count else None


def grade_text(graded: Grade) -> Iterator[str]:
    """Lines for a terminal: each run, each check with what was found, hints where one did not hold, the points."""
    exercise = graded.exercise
    yield exercise.title + (f" - {Path(graded.hand_in).name}" if graded.hand_in else "")
    for outcome in graded.outcomes:
        yield f"  {outcome.name}: {outcome.time:g} s simulated, seed {outcome.seed}"
        width = max((len(mark.title) for mark in outcome.marks), default=0)
        for number, line in enumerate(outcome.error.splitlines()):
            yield f"      {line}" if number else f"    stopped: {line}"
        for mark in outcome.marks:
            sign = "pass" if mark.passed else "FAIL"
            yield f"    {sign}  {mark.title:<{width}}  {mark.points:g} of {mark.worth:g}   {mark.message}".rstrip()
            if mark.hint:
                yield f"          hint: {mark.hint}"
        if outcome.printed and not all(mark.passed for mark in outcome.marks):
            yield "    it printed:"
            yield from (f"      {line}" for line in outcome.printed.splitlines())
    share = graded.points / graded.worth if graded.worth else 1.0
    verdict = "passed" if graded.passed else "not passed"
    yield f"  {graded.points:g} of {graded.worth:g} points ({share:.0%}), {exercise.pass_mark:.0%} needed: {verdict}"


def grade_json(graded: Grade) -> JsonObject:
    """The same as plain data."""
    return {
        "exercise": graded.exercise.title,
        "hand_in": graded.hand_in,
        "points": graded.points,
        "of": graded.worth,
        "passed": graded.passed,
        "runs": [_run_json(outcome) for outcome in graded.outcomes],
    }


def _run_json(outcome: RunGrade) -> JsonObject:
    return {
        "name": outcome.name,
        "seed": outcome.seed,
        "time": outcome.time,
        "error": outcome.error,
        "printed": outcome.printed,
        "checks": [vars(mark) for mark in outcome.marks],
    }


def junit_cases(graded: Grade) -> list[JunitCase]:
    """One case of JUnit for each check of each run."""

    suite = graded.label or Path(graded.hand_in).stem or graded.exercise.file.stem
    return [
        JunitCase(
            name=mark.title,
            classname=f"{suite}.{outcome.name}",
            seconds=outcome.time,
            failure=None if mark.passed else (mark.message, "\n".join(filter(None, (outcome.error, mark.hint)))),
            output=outcome.printed,
        )
        for outcome in graded.outcomes
        for mark in outcome.marks
    ]
