"""A verdict as lines of text for a terminal, and as cases of JUnit XML."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from simkit.testing.golden.compare.difference import Cause, Comparison, Difference, Explanation, Verdict
from simkit.testing.junit import JunitCase

REGULAR_ENDINGS: Final = frozenset({"duration", "until", "timeout", "wall_timeout", ""})
"""Of a run that ended as it was meant to, or by its scenario's clock; anything else is an error's text."""
MAX_DIFFERENCES: Final = 12
"""Differences, checks and notes that a text lists; of more it says how many there are."""
_SAME_BITS: Final = "the same bits"  # what a comparison says is allowed on one machine
_LABEL: Final = 7  # letters that the words before a line's text take
_OWN_LABEL: Final = re.compile(r"([a-z]{3,7}): ")
# what XML cannot hold, and the marks that turn the order of letters round, which could make a name read as another
_ILLEGAL: Final = re.compile(
    "[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff\u202a-\u202e\u2066-\u2069\u200e\u200f]"
)


def text_report(verdict: Verdict, width: int = 100, *, most: int = MAX_DIFFERENCES, mark: str = "FAILED") -> list[str]:
    """Return the report of a check as lines, the most important first.

    Args:
        verdict: of one golden run.
        width: letters of a line; a longer one goes on below, under its own text.
        most: differences, checks and notes that are listed of each.
        mark: what the report of one that did not pass begins with; empty for what differs alone.
    """
    if verdict.passed:
        lines = [("ok", f"{verdict.name}: {passed_text(verdict)}")]
        lines += [("note", note) for note in _limited_lines(verdict.comparison.notes, most, "notes")]
        return [line for label, text in lines for line in _wrap_lines(label, text, width, 0 if label == "ok" else 2)]
    lines = list(_body_lines(verdict, most))
    name = f"{verdict.name}: " if mark else ""
    found = _wrap_lines(mark, name + headline(verdict), width, 0)
    return [*found, *(line for label, text in lines for line in _wrap_lines(label, text, width, 2))]


def passed_text(verdict: Verdict) -> str:
    """Describe how equal a passed run is: `5 topics, 1200 messages, bit for bit; 2 checks (1.3 s)`."""
    comparison = verdict.comparison
    tier = "bit for bit" if comparison.tier == "exact" else "within the tolerances"
    parts = [f"{_count(comparison.topics, 'topic')}, {_count(comparison.messages, 'message')}, {tier}"]
    if verdict.checks:
        parts.append(f"{_count(len(verdict.checks), 'check')} passed")
    return "; ".join(parts) + (f" ({verdict.elapsed:.1f} s)" if verdict.elapsed > 0.0 else "")


def headline(verdict: Verdict) -> str:
    """The one thing to know of a verdict that did not pass."""
    if run_failed(verdict):
        said = [line.strip() for line in verdict.run.end.splitlines() if line.strip()]
        return f"the run failed: {said[0] if said else 'no reason is known'}"
    first, explanation = first_difference(verdict.comparison), verdict.explanation
    if first is not None:
        if first.kind == "model" and explanation is not None and explanation.causes:
            more = len(explanation.causes) - 1
            told = explanation.causes[0].words + (f" and {more} more" if more else "")
            return f"the world is another, and nothing that is recorded shows it: {told}"
        return first.words
    for check in verdict.checks:
        if not check.passed:
            return f"{check.check.title}: {check.message}"
    return "passed"


def first_difference(comparison: Comparison) -> Difference | None:
    """The first of a topic: what a sensor gives says more than a number of the physics, which is earlier mostly."""
    of_topics = (one for one in comparison.differences if one.topic)
    return next(of_topics, comparison.differences[0] if comparison.differences else None)


def cause_lines(explanation: Explanation | None) -> list[str]:
    """Return sentences on where the differences come from."""
    if explanation is None:
        return []
    if explanation.lines:
        return list(explanation.lines)
    found = [cause_text(cause) for cause in explanation.causes]
    if explanation.tick is not None:
        at = f"tick {explanation.tick}" + (f" (t = {explanation.time:.6g} s)" if explanation.time is not None else "")
        quantity = f": {explanation.quantity}" if explanation.quantity else ""
        found.append(f"the physics differs from {at}{quantity}")
    return found


def cause_text(cause: Cause) -> str:
    """A cause with its place and whether it was proven."""
    place = f" ({cause.where})" if cause.where and cause.where not in cause.words else ""
    return f"{cause.words}{place}{proof_text(cause)}"


def proof_text(cause: Cause) -> str:
    """Describe the run with the change reverted; empty where it was not tried."""
    if cause.proven is None:
        return ""
    return "; put back, the outputs are the golden ones" if cause.proven else "; put back, the outputs still differ"


def difference_text(difference: Difference, *, exact: bool = False) -> str:
    """A difference with what is allowed; of bits that must be equal everywhere that goes without saying."""
    allowed = allowed_text(difference, exact=exact)
    return difference.words + (f" (allowed: {allowed})" if allowed and allowed not in difference.words else "")


def allowed_text(difference: Difference, *, exact: bool) -> str:
    """Describe what is allowed, unless the tier asks it of all."""
    return "" if exact and difference.allowed == _SAME_BITS else difference.allowed


def machine_text(comparison: Comparison) -> str:
    """Describe how the machine differs; empty where it does not."""
    return ", ".join(
        f"{name} {golden or 'none'} → {run or 'none'}" for name, (golden, run) in comparison.machine.items()
    )


def run_failed(verdict: Verdict) -> bool:
    """Check whether the run failed and the golden one did not."""
    return verdict.run.end not in REGULAR_ENDINGS and verdict.run.end != verdict.golden.end


def _body_lines(verdict: Verdict, most: int) -> Iterator[tuple[str, str]]:
    comparison, head = verdict.comparison, headline(verdict)
    for number, line in enumerate(_limited_lines(cause_lines(verdict.explanation), most, "lines")):
        own = _OWN_LABEL.match(line)
        yield (own[1], line[own.end() :]) if own else ("cause" if number == 0 else "", line)
    first = first_difference(comparison)
    exact = comparison.tier == "exact"
    allowed = allowed_text(first, exact=exact) if first is not None else ""
    if allowed and allowed not in head and not run_failed(verdict):
        yield "allowed", allowed
    told_already = first is not None and (first.words == head or first.kind == "model")
    rest = [one for one in comparison.differences if not (one is first and told_already)]
    for number, line in enumerate(
        _limited_lines([difference_text(one, exact=exact) for one in rest], most, "differences")
    ):
        yield "then" if number == 0 else "", line
    wrong = [check for check in verdict.checks if not check.passed]
    told = [f"{check.check.title}: {check.message}" for check in wrong]
    hints = {text: check.check.hint for text, check in zip(told, wrong, strict=True) if check.check.hint}
    for line in _limited_lines([text for text in told if text != head or text in hints], most, "checks"):
        yield "check", line + (f" – {hints[line]}" if line in hints else "")
    if verdict.run.end not in REGULAR_ENDINGS:
        for line in _limited_lines(verdict.run.end.strip().splitlines(), most, "lines"):
            yield "run", line
    if exact:
        yield "tier", "same machine and versions: bits must be equal"
    else:
        yield "tier", f"other machine ({machine_text(comparison) or 'unknown'}): within the tolerances"
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
    return f"{number} {what}" + ("" if number == 1 else "s")


def junit_cases(verdicts: Verdict | Iterable[Verdict]) -> list[JunitCase]:
    """Return the cases that `simkit.testing.junit.write_junit` writes.

    A golden run is a class. Its first case, `run`, has the run's time and fails where the run did; then comes every
    topic that either run had, the physics state and the world's meaning where they differ, and every check of the
    scenario.
    """
    found = [verdicts] if isinstance(verdicts, Verdict) else verdicts
    return [case for verdict in found for case in _cases_of_verdict(verdict)]


def _cases_of_verdict(verdict: Verdict) -> list[JunitCase]:

    scenario = verdict.run.scenario
    classname, file = f"golden.{verdict.name}", str(scenario.file) if scenario.file is not None else ""
    whole = "\n".join(text_report(verdict))
    stopped, exact = run_failed(verdict), verdict.comparison.tier == "exact"
    error = (f"the run failed: {verdict.run.end.strip().partition(chr(10))[0]}", whole) if stopped else None
    cases = [JunitCase("run", classname, verdict.elapsed, error=error, output="" if stopped else whole, file=file)]
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
            said = [difference_text(difference, exact=exact) for difference in differences]
            failure = (said[0], "\n".join([*said, "", *causes]).strip())
        cases.append(JunitCase(name, classname, failure=failure, file=file))
    for check in verdict.checks:
        hint = f"\n{check.check.hint}" if check.check.hint else ""
        failure = None if check.passed else (check.message, f"{check.check.title}: {check.message}{hint}")
        output = check.message if check.passed else ""
        cases.append(JunitCase(check.check.title, f"{classname}.checks", failure=failure, output=output, file=file))
    return cases


def clean_text(text: str) -> str:
    """A text without what a terminal or a reader would take for more than letters."""
    return _ILLEGAL.sub("\ufffd", text)
