"""Grading of plugins that were submitted for an exercise, and reports of the grades."""

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

from simkit import Check
from simkit.child_process import ChildProcesses
from simkit.errors import InputError
from simkit.float_sum import float_sum
from simkit.input_file import read_input
from simkit.progress import report_each
from simkit.run_spec import FilePath, JsonObject
from simkit.testing.junit import JunitCase
from simkit_verification.testing.grading.callback_limit import DEFAULT_LIMIT, is_debugged
from simkit_verification.testing.grading.exercise import Exercise, ExerciseRun, permit_exercise
from simkit_verification.testing.grading.report_words import ENGLISH, ReportWords

_JUDGE: Final = "simkit_verification.testing.grading.judge_process"  # module of the child process
_SPARE_SECONDS: Final = 60.0  # additional wall time for starting and ending the processes of a run [s]
_MAX_RESULT_BYTES: Final = 64 << 20
_MAX_LINES_SHOWN: Final = 20  # maximum number of lines of a process that failed
_NOT_STARTED: Final = "the run was not started, because a callback was stopped in an earlier run"


@dataclass(frozen=True)
class CheckGrade:
    """Grade of one check.

    Attributes:
        title: Title of the check.
        passed: True if the check passed.
        message: Result with the measured values.
        points: Achieved points.
        worth: Achievable points.
        hint: Hint for a check that failed; empty if the run ended early, for another reason.
        required: Condition that did not hold; empty for a check that passed, has no condition, or was not decided.
        time: Simulated time at which the result was known [s].
    """

    title: str
    passed: bool
    message: str
    points: float
    worth: float
    hint: str = ""
    time: float = 0.0
    required: str = ""


@dataclass(frozen=True)
class RunGrade:
    """Grade of one run.

    Attributes:
        name: Name of the run.
        seed: Seed of the sensor noise.
        time: Simulated time at the end [s].
        marks: Grade of each check.
        error: Reason for an early end; empty for a complete run.
        printed: Last lines of the output that the run printed.
    """

    name: str
    seed: int
    time: float
    marks: tuple[CheckGrade, ...]
    error: str = ""
    printed: str = ""


@dataclass(frozen=True)
class Grade:
    """Grade of one submission.

    Attributes:
        exercise: Exercise.
        hand_in: File of the plugin; empty if there is none.
        outcomes: Grades of all runs.
        label: Short name, unique among the submissions graded together.
    """

    exercise: Exercise
    hand_in: str
    outcomes: tuple[RunGrade, ...]
    label: str = ""

    @property
    def points(self) -> float:
        """Achieved points."""
        return float_sum(mark.points for outcome in self.outcomes for mark in outcome.marks)

    @property
    def worth(self) -> float:
        """Achievable points."""
        return float_sum(mark.worth for outcome in self.outcomes for mark in outcome.marks)

    @property
    def passed(self) -> bool:
        """True if the points reach the pass mark of the exercise."""
        return self.points >= self.exercise.pass_mark * self.worth - 1e-9


@dataclass(frozen=True)
class LabHandIn:
    """Files of a student's folder that are graded in a copy of the lab.

    Attributes:
        folder: Folder of the student.
        files: Files of the hand-in, relative to the folder.
    """

    folder: Path
    files: tuple[str, ...]


def grade(
    exercise: Exercise,
    hand_in: Path | None = None,
    pictures: Path | None = None,
    limit: float = DEFAULT_LIMIT,
    *,
    allow_code: bool = False,
    plugin_paths: Sequence[FilePath] = (),
) -> Grade:
    """Run an exercise with a submitted plugin, each run in its own process.

    Args:
        exercise: Exercise.
        hand_in: File of the plugin; None if the exercise needs no submission.
        pictures: Folder for a picture of each run's path.
        limit: Wall and processor time after which a callback without progress is stopped [s]; 0 for none.
        allow_code: Allow the plugin folders that the exercise names. Their code has the same rights as the user.
        plugin_paths: Allow these folders only.

    Raises:
        InputError: The exercise itself has an error: its world, its commands or its checks; or SK-SCEN-008 it needs
            code that is not allowed.
    """
    (graded,) = grade_all(exercise, [hand_in], pictures, limit=limit, allow_code=allow_code, plugin_paths=plugin_paths)
    return graded


def grade_all(
    exercise: Exercise,
    hand_ins: Sequence[Path | None],
    pictures: Path | None = None,
    jobs: int = 1,
    *,
    limit: float = DEFAULT_LIMIT,
    lab: LabHandIn | None = None,
    stopped: set[Path] | None = None,
    allow_code: bool = False,
    plugin_paths: Sequence[FilePath] = (),
    words: ReportWords = ENGLISH,
) -> Iterator[Grade]:
    """Run an exercise with several plugins; yield the grades in the order of the plugins, each as soon as possible.

    Args:
        exercise: Exercise.
        hand_ins: Files of plugins; None for a run without a submission.
        pictures: Folder for a picture of each run's path.
        jobs: Number of parallel processes.
        limit: Wall and processor time after which a callback without progress is stopped [s]; 0 for none.
        lab: Hand-in of a lab, whose files replace those of a copy of the exercise's folder.
        stopped: Plugins with a callback that was stopped; no further run of them is started. New ones are added.
        allow_code: Allow the plugin folders that the exercise names. Their code has the same rights as the user.
        plugin_paths: Allow these folders only.
        words: Language of the line of progress; the grades are in English.

    Raises:
        InputError: The exercise itself has an error, or SK-SCEN-008 it needs code that is not allowed.
    """
    exercise = permit_exercise(exercise, allow_code, plugin_paths)
    names = short_labels(hand_ins)
    stopped = set() if stopped is None else stopped
    grader = _Grader(exercise, 0.0 if is_debugged() else limit, lab, stopped)
    with ThreadPoolExecutor(jobs) as pool:

        def outcome(hand_in: Path | None, name: str, number: int) -> RunGrade:
            picture = "" if pictures is None else str((pictures / f"{name or 'exercise'}_{number + 1}.png").absolute())
            return grader.grade(number, hand_in, picture)

        runs = range(len(exercise.runs))
        submissions = [
            (hand_in, name, [pool.submit(outcome, hand_in, name, number) for number in runs])
            for hand_in, name in zip(hand_ins, names, strict=True)
        ]
        try:
            for hand_in, name, outcomes in report_each(
                "grading", submissions, len(submissions), translate=words.message
            ):
                file = "" if hand_in is None else str(hand_in)
                yield Grade(exercise, file, tuple(pending.result() for pending in outcomes), name)
        finally:  # cancel waiting runs and end running processes, even if the caller does not read all grades
            pool.shutdown(wait=False, cancel_futures=True)
            grader.processes.end()


def short_labels(hand_ins: Sequence[Path | None]) -> list[str]:
    """Return a short unique name for each file; files with the same name also get the name of their folder."""
    stems = ["" if file is None else file.stem for file in hand_ins]
    longer = [
        stem if file is None or stems.count(stem) == 1 else f"{file.absolute().parent.name}_{stem}"
        for file, stem in zip(hand_ins, stems, strict=True)
    ]
    return [
        name if longer.count(name) == 1 else f"{name}_{longer[:number].count(name) + 1}"
        for number, name in enumerate(longer)
    ]


class _Grader:
    """Grader of the runs of one exercise.

    Args:
        exercise: Exercise.
        limit: Limit of a callback [s]; 0 for none.
        lab: Hand-in of a lab; None for a plugin that stays where it is.
        stopped: Plugins with a callback that was stopped.
    """

    def __init__(self, exercise: Exercise, limit: float, lab: LabHandIn | None, stopped: set[Path]) -> None:
        self._exercise, self._limit, self._lab, self._stopped = exercise, limit, lab, stopped
        self.processes = ChildProcesses()

    def grade(self, number: int, hand_in: Path | None, picture: str) -> RunGrade:
        """Run the exercise once and grade the run."""
        variation = self._exercise.runs[number]
        checks = _required_checks(variation)
        if hand_in in self._stopped:
            result: JsonObject = {"error": _NOT_STARTED, "time": 0.0}
        else:
            result = self._run_in_process(number, hand_in, picture)
        if result.get("stuck") and hand_in is not None:
            if hand_in in self._stopped:  # told once, also by runs at the same time
                result["error"] = _NOT_STARTED
            self._stopped.add(hand_in)
        results = result.get("results")
        if results:
            marks = [
                _check_grade(check, passed, message, time)
                for check, (passed, message, time) in zip(checks, results, strict=True)
            ]
        else:
            marks = [
                CheckGrade(check.title, False, "the run ended early", 0.0, check.points, time=result["time"])
                for check in checks
            ]
        printed = result.get("printed", "")
        seed = variation.scenario.seed
        return RunGrade(variation.name, seed, result["time"], tuple(marks), result.get("error", ""), printed)

    def _run_in_process(self, number: int, hand_in: Path | None, picture: str) -> JsonObject:
        """Run an exercise in the process of a judge, which starts the one of the hand-in; return the result."""
        variation = self._exercise.runs[number]
        limit = (variation.scenario.wall_timeout or 0.0) + _SPARE_SECONDS
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
            target = Path(folder) / "result.json"
            token = secrets.token_hex()
            job = {
                "exercise": str(self._exercise.file.absolute()),
                "folders": [os.path.abspath(trusted) for trusted in self._exercise.folders],  # noqa: PTH100 (links stay)
                "allow_code": not self._exercise.code_requests,
                "hand_in": "" if hand_in is None else str(hand_in.absolute()),
                "folder": "" if self._lab is None else str(self._lab.folder.absolute()),
                "files": () if self._lab is None else self._lab.files,
                "number": number,
                "target": str(target),
                "picture": picture,
                "limit": self._limit,
                "token": token,
            }
            job_file = Path(folder) / "job.json"
            job_file.write_text(json.dumps(job), encoding="utf-8")
            environment = {**os.environ, "PYTHONIOENCODING": "utf-8"}
            done = self.processes.run(_JUDGE, [str(job_file)], environment=environment, limit=limit)
            if done.is_late:  # the judge has a shorter limit, so the hand-in has stopped the judge
                return {"error": f"the run was stopped after {limit:g} s of wall time", "time": 0.0, "stuck": True}
            result = _read_process_result(target, token, len(_required_checks(variation)))
        if result is None:
            how = f"with {done.code}" if done.code >= 0 else f"by signal {-done.code}"
            lines = "\n".join(done.last_lines(_MAX_LINES_SHOWN))
            return {"error": f"the process of the judge ended {how}", "time": 0.0, "printed": lines}
        if "fault" in result:
            text = f"{self._exercise.file}: {variation.name}: {result['fault']}"
            raise InputError(result["code"], text, shows_code=False)
        return result


def _required_checks(variation: ExerciseRun) -> list[Check]:
    """Return all checks in the order of the results."""
    scenario = variation.scenario
    until = [Check("goal", f"until {scenario.until}", scenario.until)] if scenario.until else []
    return [*until, *scenario.checks]


def _check_grade(check: Check, passed: bool, message: str, time: float) -> CheckGrade:
    """Return the grade of a check of a complete run."""
    if passed:
        return CheckGrade(check.title, True, message, check.points, check.points, time=time)
    required = "" if check.title.endswith(check.expression) else check.expression
    return CheckGrade(check.title, False, message, 0.0, check.points, check.hint, time, required)


def _read_process_result(target: Path, token: str, count: int) -> JsonObject | None:
    """Read the result of a run. Return None if simkit did not write the file; the plugin can write to it too."""
    try:
        result = json.loads(read_input(target, _MAX_RESULT_BYTES)) if target.is_file() else None
    except (OSError, ValueError):
        return None
    if not isinstance(result, dict) or result.pop("token", None) != token:
        return None
    return result if "error" in result or "fault" in result or len(result.get("results", ())) == count else None


def grade_text(graded: Grade, words: ReportWords = ENGLISH) -> Iterator[str]:
    """Yield the lines of a text report: runs, checks with results, hints for failed checks, and points.

    Expressions, texts of exceptions and printed output are as they are in any language.
    """
    exercise, say, translated = graded.exercise, words.say, words.translated
    yield translated(exercise.title) + (f" - {Path(graded.hand_in).name}" if graded.hand_in else "")
    for outcome in graded.outcomes:
        head = {"name": translated(outcome.name), "time": outcome.time, "seed": outcome.seed}
        yield f"  {say('{name}: {time:g} s simulated, seed {seed}', **head)}"
        titles = [translated(mark.title) for mark in outcome.marks]
        width = max(map(len, titles), default=0)
        for number, line in enumerate(words.message(outcome.error).splitlines()):
            yield f"      {line}" if number else f"    {say('stopped:')} {line}"
        for mark, title in zip(outcome.marks, titles, strict=True):
            sign = say("pass") if mark.passed else say("FAIL")
            yield f"    {sign}  {title:<{width}}  {points_text(mark, words)}   {words.result(mark.message)}".rstrip()
            if mark.required:
                yield f"          {say('required:')} {mark.required}"
            if mark.hint:
                yield f"          {say('hint:')} {translated(mark.hint)}"
        if outcome.printed and not all(mark.passed for mark in outcome.marks):
            yield f"    {say('printed output:')}"
            yield from (f"      {line}" for line in outcome.printed.splitlines())
    share = graded.points / graded.worth if graded.worth else 1.0
    result = {
        "points": graded.points,
        "worth": graded.worth,
        "share": f"{100.0 * share:.0f}",
        "needed": f"{100.0 * exercise.pass_mark:.0f}",
        "verdict": verdict_text(graded, words),
    }
    yield f"  {say('{points:g} of {worth:g} points ({share}%), {needed}% needed: {verdict}', **result)}"


def points_text(graded: Grade | CheckGrade, words: ReportWords) -> str:
    """Return the achieved and the achievable points."""
    return words.say("{points:g} of {worth:g}", points=graded.points, worth=graded.worth)


def verdict_text(graded: Grade, words: ReportWords) -> str:
    """Return whether a submission passed."""
    return words.say("passed") if graded.passed else words.say("not passed")


def grade_json(graded: Grade) -> JsonObject:
    """Return a grade as JSON data."""
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
    """Return one JUnit test case for each check of each run."""
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
