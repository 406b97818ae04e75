"""Text report of a verdict for a terminal, and JUnit XML test cases."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from simkit.number_text import counted
from simkit.testing.golden.compare.difference import Cause, Comparison, Difference, Explanation, Verdict
from simkit.testing.junit import JunitCase

REGULAR_ENDINGS: Final = frozenset({"duration", "until", "timeout", "wall_timeout", ""})
"""Ends of a run that are not errors; any other end is the text of an error."""
MAX_DIFFERENCES: Final = 12
"""Maximum number of differences, checks and notes in a text; further ones are counted."""
_SAME_BITS: Final = "the same bits"  # text of `Difference.allowed` if bits must be equal
PROOF_PREFIX: Final = "; with this change undone, "
_LABEL: Final = 7  # width of the label in front of a line
_OWN_LABEL: Final = re.compile(r"([a-z]{3,7}): ")
# characters that XML cannot hold, and marks that reverse the text direction, which could disguise a name
_ILLEGAL: Final = re.compile(
    "[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff\u202a-\u202e\u2066-\u2069\u200e\u200f]"
)


def text_report(verdict: Verdict, width: int = 100, *, most: int = MAX_DIFFERENCES, mark: str = "FAILED") -> list[str]:
    """Return the report of a check as lines, most important first.

    Args:
        verdict: Verdict on one golden run.
        width: Line width in characters; a longer line is wrapped and indented.
        most: Maximum number of differences, of checks and of notes.
        mark: First word of the report if the verdict did not pass; empty for the differences alone.
    """
    if verdict.passed:
        lines = [("ok", f"{verdict.name}: {passed_text(verdict)}")]
        lines += [("note", note) for note in _limited_lines(verdict.comparison.notes, most, "notes")]
        return [line for label, text in lines for line in _wrap_lines(label, text, width, 0 if label == "ok" else 2)]
    lines = list(_body_lines(verdict, most))
    name = f"{verdict.name}: " if mark else ""
    title_lines = _wrap_lines(mark, name + headline(verdict), width, 0)
    return [*title_lines, *(line for label, text in lines for line in _wrap_lines(label, text, width, 2))]


def passed_text(verdict: Verdict) -> str:
    """Describe the comparison of a run that passed: `5 topics, 1200 messages, bit for bit; 2 checks (1.3 s)`."""
    comparison = verdict.comparison
    # where only the renderer or the ray tracer differs, the tier is "exact", and tolerances apply to their topics
    if comparison.is_identical or (comparison.tier == "exact" and not comparison.machine):
        tier = "bit for bit"
    else:
        tier = "within the tolerances" + (
            f" of another machine ({machine_text(comparison)})" if comparison.machine else ""
        )
    parts = [f"{_count(comparison.topics, 'topic')}, {_count(comparison.messages, 'message')}, {tier}"]
    if verdict.checks:
        parts.append(f"{_count(len(verdict.checks), 'check')} passed")
    return "; ".join(parts) + (f" ({verdict.elapsed:.1f} s)" if verdict.elapsed > 0.0 else "")


def headline(verdict: Verdict) -> str:
    """Return the most important fact about a verdict that did not pass."""
    if run_failed(verdict):
        lines = [line.strip() for line in verdict.run.end.splitlines() if line.strip()]
        return f"the run failed: {lines[0] if lines else 'reason unknown'}"
    first, explanation = first_difference(verdict.comparison), verdict.explanation
    if first is not None:
        if first.kind == "model" and explanation is not None and explanation.causes:
            more = len(explanation.causes) - 1
            cause = explanation.causes[0].words + (f" and {more} more" if more else "")
            return f"the world changed, but no recorded output differs: {cause}"
        return first.words
    for check in verdict.checks:
        if not check.passed:
            return f"{check.check.title}: {check.message}"
    return "passed"


def first_difference(comparison: Comparison) -> Difference | None:
    """Return the first part that is left out, else the first difference of a topic, else any.

    A part that is left out explains the other differences; readings of sensors say more than values of the state.
    """
    of_topics = (d for d in comparison.differences if d.topic or d.kind == "left out")
    return next(of_topics, comparison.differences[0] if comparison.differences else None)


def cause_lines(explanation: Explanation | None) -> list[str]:
    """Return sentences about the causes of the differences."""
    if explanation is None:
        return []
    if explanation.lines:
        return list(explanation.lines)
    sentences = [cause_text(cause) for cause in explanation.causes]
    if explanation.tick is not None:
        at = f"tick {explanation.tick}" + (f" (t = {explanation.time:.6g} s)" if explanation.time is not None else "")
        quantity = f": {explanation.quantity}" if explanation.quantity else ""
        sentences.append(f"the physics differs from {at}{quantity}")
    return sentences


def cause_text(cause: Cause) -> str:
    """Return a cause with its source position and the result of its test."""
    place = f" ({cause.where})" if cause.where and cause.where not in cause.words else ""
    return f"{cause.words}{place}{proof_text(cause)}"


def proof_text(cause: Cause) -> str:
    """Describe whether the run with the change undone gives the golden outputs; empty if this was not tested."""
    if cause.proven is None:
        return ""
    return PROOF_PREFIX + ("the outputs equal the golden run" if cause.proven else "the outputs still differ")


def difference_text(difference: Difference, *, exact: bool = False) -> str:
    """Return a difference with its tolerance; omit the tolerance if all bits must be equal."""
    allowed = allowed_text(difference, exact=exact)
    return difference.words + (f" (allowed: {allowed})" if allowed and allowed not in difference.words else "")


def allowed_text(difference: Difference, *, exact: bool) -> str:
    """Return the tolerance of a difference; empty if all bits must be equal."""
    return "" if exact and difference.allowed == _SAME_BITS else difference.allowed


def machine_text(comparison: Comparison) -> str:
    """List the properties of the machine that differ; empty if there are none."""
    return ", ".join(
        f"{name} {golden or 'none'} → {run or 'none'}" for name, (golden, run) in comparison.machine.items()
    )


def run_failed(verdict: Verdict) -> bool:
    """Check whether the run failed and the golden one did not."""
    return verdict.run.end not in REGULAR_ENDINGS and verdict.run.end != verdict.golden.end


def _body_lines(verdict: Verdict, most: int) -> Iterator[tuple[str, str]]:
    comparison, head = verdict.comparison, headline(verdict)
    for number, line in enumerate(_limited_lines(cause_lines(verdict.explanation), most, "lines")):
        labelled = _OWN_LABEL.match(line)
        yield (labelled[1], line[labelled.end() :]) if labelled else ("cause" if number == 0 else "", line)
    first = first_difference(comparison)
    exact = comparison.tier == "exact"
    allowed = allowed_text(first, exact=exact) if first is not None else ""
    if allowed and allowed not in head and not run_failed(verdict):
        yield "allowed", allowed
    is_in_headline = first is not None and (first.words == head or first.kind == "model")
    rest = [difference for difference in comparison.differences if not (difference is first and is_in_headline)]
    for number, line in enumerate(
        _limited_lines([difference_text(difference, exact=exact) for difference in rest], most, "differences")
    ):
        yield "then" if number == 0 else "", line
    failed = [check for check in verdict.checks if not check.passed]
    texts = [f"{check.check.title}: {check.message}" for check in failed]
    hints = {text: check.check.hint for text, check in zip(texts, failed, strict=True) if check.check.hint}
    for line in _limited_lines([text for text in texts if text != head or text in hints], most, "checks"):
        yield "check", line + (f" – {hints[line]}" if line in hints else "")
    if verdict.run.end not in REGULAR_ENDINGS:
        for line in _limited_lines(verdict.run.end.strip().splitlines(), most, "lines"):
            yield "run", line
    if exact:
        yield "tier", "no difference of the machine that can change bits: bits must be equal"
    else:
        yield "tier", f"other machine or versions ({machine_text(comparison) or 'unknown'}): within the tolerances"
    for note in _limited_lines(comparison.notes, most, "notes"):
        yield "note", note


def _limited_lines(lines: Sequence[str], most: int, what: str) -> list[str]:
    if len(lines) <= most:
        return list(lines)
    more = len(lines) - most
    return [*lines[:most], f"… and {more} more {what if more > 1 else what.removesuffix('s')}"]


def _wrap_lines(label: str, text: str, width: int, indent: int) -> list[str]:
    start = " " * indent + (f"{label:<{_LABEL}} " if label or indent else "")
    return textwrap.wrap(
        clean_text(" ".join(text.split())),
        max(width, len(start) + 20),
        initial_indent=start,
        subsequent_indent=" " * len(start),
        break_long_words=False,
        break_on_hyphens=False,
    ) or [start.rstrip()]


def _count(number: int, what: str) -> str:
    return counted(number, what)


def junit_cases(verdicts: Verdict | Iterable[Verdict]) -> list[JunitCase]:
    """Return the test cases for `simkit.testing.junit.write_junit`.

    A golden run is one class. Its first case, `run`, has the run's wall time and fails if the run failed. Further cases
    are every topic of either run, the physics state and the world if they differ, and every check of the scenario.
    """
    verdict_list = [verdicts] if isinstance(verdicts, Verdict) else verdicts
    return [case for verdict in verdict_list for case in _cases_of_verdict(verdict)]


def _cases_of_verdict(verdict: Verdict) -> list[JunitCase]:
    scenario = verdict.run.scenario
    classname, file = f"golden.{verdict.name}", str(scenario.file) if scenario.file is not None else ""
    report = "\n".join(text_report(verdict))
    stopped, exact = run_failed(verdict), verdict.comparison.tier == "exact"
    error = (f"the run failed: {verdict.run.end.strip().partition(chr(10))[0]}", report) if stopped else None
    cases = [JunitCase("run", classname, verdict.elapsed, error=error, output="" if stopped else report, file=file)]
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
            texts = [difference_text(difference, exact=exact) for difference in differences]
            failure = (texts[0], "\n".join([*texts, "", *causes]).strip())
        cases.append(JunitCase(name, classname, failure=failure, file=file))
    for check in verdict.checks:
        hint = f"\n{check.check.hint}" if check.check.hint else ""
        failure = None if check.passed else (check.message, f"{check.check.title}: {check.message}{hint}")
        output = check.message if check.passed else ""
        cases.append(JunitCase(check.check.title, f"{classname}.checks", failure=failure, output=output, file=file))
    return cases


def clean_text(text: str) -> str:
    """Replace control characters that a terminal or XML reader would interpret."""
    return _ILLEGAL.sub("\ufffd", text)
