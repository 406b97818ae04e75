"""Verdicts as cases of JUnit: one for the run, one for each topic, one for each check."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from simkit.golden.difference import Difference, Verdict
from simkit.golden.report.text import breaks_off, cause_lines, difference_words, text_report

if TYPE_CHECKING:
    from simkit.sinks.junit import Case


def junit_cases(verdicts: Verdict | Iterable[Verdict]) -> list[Case]:
    """What is written by `simkit.sinks.junit.write_junit`.

    A golden run is a class. Its first case, `run`, has the run's time and fails where the run did; then comes every
    topic that either run had, the physics state and the world's meaning where they differ, and every check of the
    scenario.
    """
    found = [verdicts] if isinstance(verdicts, Verdict) else verdicts
    return [case for verdict in found for case in _of(verdict)]


def _of(verdict: Verdict) -> list[Case]:
    from simkit.sinks.junit import Case

    scenario = verdict.run.scenario
    classname, file = f"golden.{verdict.name}", str(scenario.file) if scenario.file is not None else ""
    whole = "\n".join(text_report(verdict))
    stopped, exact = breaks_off(verdict), verdict.comparison.tier == "exact"
    error = (f"the run failed: {verdict.run.end.strip().partition(chr(10))[0]}", whole) if stopped else None
    cases = [Case("run", classname, verdict.elapsed, error=error, output="" if stopped else whole, file=file)]
    causes = cause_lines(verdict.explanation)
    by_topic: dict[str, list[Difference]] = {
        topic: [] for topic in sorted(verdict.golden.streams.keys() | verdict.run.streams.keys())
    }
    for difference in verdict.comparison.differences:
        name = difference.topic or ("state" if difference.kind == "state" else "world")
        by_topic.setdefault(name, []).append(difference)
    for name, differences in by_topic.items():
        failure = None
        if differences:
            said = [difference_words(difference, exact=exact) for difference in differences]
            failure = (said[0], "\n".join([*said, "", *causes]).strip())
        cases.append(Case(name, classname, failure=failure, file=file))
    for check in verdict.checks:
        hint = f"\n{check.check.hint}" if check.check.hint else ""
        failure = None if check.passed else (check.message, f"{check.check.title}: {check.message}{hint}")
        output = check.message if check.passed else ""
        cases.append(Case(check.check.title, f"{classname}.checks", failure=failure, output=output, file=file))
    return cases
