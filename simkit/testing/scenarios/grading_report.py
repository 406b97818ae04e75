"""What an exercise gave, for people, for programs and for JUnit."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from simkit.run_spec import JsonObject
from simkit.testing.junit import JunitCase
from simkit.testing.scenarios.grading import Grade, RunGrade


def grade_text(graded: Grade) -> Iterator[str]:
    """Lines for a terminal: each run, each check with what was found, hints where one did not hold, the points."""
    exercise = graded.exercise
    yield exercise.title + (f" - {Path(graded.hand_in).name}" if graded.hand_in else "")
    for outcome in graded.outcomes:
        yield f"  {outcome.name}: {outcome.time:g} s simulated, seed {outcome.seed}"
        width = max((len(mark.title) for mark in outcome.marks), default=0)
        if outcome.error:
            yield from (f"    stopped: {line}" if not n else f"      {line}" for n, line in _plural(outcome.error))
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


def _plural(text: str) -> Iterator[tuple[int, str]]:
    return iter(enumerate(text.splitlines()))


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
