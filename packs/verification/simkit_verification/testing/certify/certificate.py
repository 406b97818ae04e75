"""Determinism certificate: compared runs, their differences, and the text for a terminal."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from simkit.extend import counted
from simkit.run_spec import JsonObject
from simkit_verification.testing.certify.code_hints import CodeHint
from simkit_verification.testing.certify.outcome import RunOutcome
from simkit_verification.testing.certify.variations import Variation

FORMAT: Final = 1


@dataclass(frozen=True)
class Row:
    """Result of one run of a certificate.

    Attributes:
        variation: Environment of the run.
        outcome: Result of the run.
        streams: Hash of the messages of all topics; empty without subscribers. If the subscribers were added during
            the run, the hash covers only the messages after that time.
        same: True if the results of the run equal those of the first run.
    """

    variation: Variation
    outcome: RunOutcome
    streams: str
    same: bool


@dataclass(frozen=True)
class Difference:
    """First difference between a run and the first run.

    Attributes:
        variation: Environment of the run.
        words: Sentence such as `/odom: message 37 at t = 1.233 s`.
        tick: First tick that differs; None if the difference has no tick.
        time: Simulated time of that tick [s].
        owner: Plugin or sensor that caused it: `plugin 'drive' (robot.sdf:12)`; empty if unknown.
        how: Description of the cause.
        hints: Code lines of this plugin or sensor that often cause such differences.
        more: Sentences about further differences.
    """

    variation: Variation
    words: str
    tick: int | None = None
    time: float | None = None
    owner: str = ""
    how: str = ""
    hints: tuple[CodeHint, ...] = ()
    more: tuple[str, ...] = ()


@dataclass
class Certificate:
    """Certificate of several runs.

    Attributes:
        name: Name of the scenario.
        world, duration, seed: World, simulated duration [s] and seed of the runs.
        rows: Results of all runs; every run is compared with the first run.
        differences: First difference of each run that differs; empty if the certificate passed.
        notes: Sentences about differences that do not make the certificate fail.
        fingerprint: Fingerprint of the machine for which the certificate is valid.
    """

    name: str
    world: str
    duration: float
    seed: int
    rows: list[Row]
    differences: list[Difference] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    fingerprint: dict[str, str] = field(default_factory=dict)

    @property
    def left_out(self) -> dict[str, int]:
        """Names of the sensors, plugins and controllers without which the first run was made, with their numbers.

        The certificate says nothing about these.
        """
        return self.rows[0].outcome.left_out

    @property
    def passed(self) -> bool:
        """True if all runs gave exactly the same results."""
        return not self.differences

    def to_dict(self) -> JsonObject:
        """Return JSON data without wall-clock times, so that equal runs give equal data."""
        first = self.rows[0].outcome
        topics = {
            topic: {"type": heard.type_name, "count": len(heard.digests), "sha256": heard.digest}
            for topic, heard in first.heard.items()
        }
        return {
            "format": FORMAT,
            "passed": self.passed,
            "scenario": {"name": self.name, "world": self.world, "duration": self.duration, "seed": self.seed},
            "ticks": first.ticks,
            "state": first.state,
            "streams": self.rows[0].streams,
            "topics": topics,
            "fingerprint": self.fingerprint,
            "left_out": self.left_out,
            "runs": [_certificate_row(row) for row in self.rows],
            "differences": [_difference_dict(difference) for difference in self.differences],
            "notes": self.notes,
        }


def _certificate_row(row: Row) -> JsonObject:
    return {
        "name": row.variation.name,
        "other": row.variation.words,
        "state": row.outcome.state,
        "streams": row.streams,
        "same": row.same,
        "ended": str(row.outcome.failure or row.outcome.stopped or row.outcome.end),
    }


def _difference_dict(difference: Difference) -> JsonObject:
    return {
        "run": difference.variation.name,
        "what": difference.words,
        "tick": difference.tick,
        "time": difference.time,
        "owner": difference.owner,
        "how": difference.how,
        "hints": [{"where": hint.where, "text": hint.text} for hint in difference.hints],
        "more": list(difference.more),
    }


def streams_hash(outcome: RunOutcome) -> str:
    """Return one hash of all received messages; empty without subscribers."""
    if not outcome.heard:
        return ""
    digest = hashlib.sha256()
    for topic, heard in sorted(outcome.heard.items()):
        if outcome.heard_from:
            heard_digest = hashlib.sha256(heard.digests[heard.ticks > outcome.heard_from].tobytes()).hexdigest()
        else:
            heard_digest = heard.digest
        digest.update(f"{topic} {heard.type_name} {heard_digest}\n".encode())
    return digest.hexdigest()


_HASH_WIDTH: Final = 12  # characters of a hash


def table_header() -> str:
    """Return the header line of the table."""
    return f"{'run':<12}  {'state':<{_HASH_WIDTH}}  {'streams':<{_HASH_WIDTH}}  {'':<9}  what differs"


def table_row(row: Row) -> str:
    """Return the table line of one run."""
    outcome = row.outcome
    state = outcome.state[:_HASH_WIDTH] if outcome.state else "-"
    streams = ("second half" if outcome.heard_from else row.streams[:_HASH_WIDTH]) or "-"
    verdict = "same" if row.same else "DIFFERENT"
    hashes = f"{state:<{_HASH_WIDTH}}  {streams:<{_HASH_WIDTH}}"
    return f"{row.variation.name:<12}  {hashes}  {verdict:<9}  {row.variation.words}"


def conclusion_text(certificate: Certificate) -> list[str]:
    """Return the lines that are printed below the table, the most important line first."""
    first = certificate.rows[0].outcome
    lines: list[str] = []
    for number, (difference, also) in enumerate(_group_by_cause(certificate.differences)):
        lines += _difference_text(difference, also, is_first=number == 0)
    if certificate.passed:
        messages = sum(len(heard.digests) for heard in first.heard.values())
        size = (
            f"{counted(first.ticks, 'step')} ({certificate.duration:g} s), "
            f"{counted(messages, 'message')} on {counted(len(first.heard), 'topic')}"
        )
        lines.append(f"the same bits in {len(certificate.rows)} runs: {size}, seed {certificate.seed}")
        if first.end:
            lines.append(f"every run ended with: {first.end}")
    else:
        lines.append(f"{len(certificate.differences)} of {len(certificate.rows) - 1} runs differ from the first")
    lines += [f"not certified, because the world runs without it: {name}" for name in certificate.left_out]
    lines += [_relative_paths(f"note: {note}") for note in certificate.notes]
    shown = ", ".join(f"{name} {value}" for name, value in certificate.fingerprint.items() if value)
    return [*lines, f"on: {shown}"]


def _group_by_cause(differences: Sequence[Difference]) -> list[tuple[Difference, list[str]]]:
    """Group differences with the same cause. Return the first difference of each group and the further runs' names."""
    groups: dict[object, tuple[Difference, list[str]]] = {}
    for difference in differences:
        key = (difference.owner, difference.hints) if difference.owner else (difference.words, difference.how)
        if key in groups:
            groups[key][1].append(difference.variation.name)
        else:
            groups[key] = difference, []
    return list(groups.values())


def _difference_text(difference: Difference, also: Sequence[str], *, is_first: bool) -> list[str]:
    lines = [f"{difference.variation.name}: {difference.words}" + (f"; and in: {', '.join(also)}" if also else "")]
    if difference.owner:
        when = "" if difference.tick is None else f" at tick {difference.tick} (t = {difference.time:.6g} s)"
        lines.append(f"    caused by {difference.owner}{when}" + (f": {difference.how}" if difference.how else ""))
    elif difference.how:
        lines.append(f"    {difference.how}")
    lines += [f"    hint: {hint.where}: {hint.text}" for hint in difference.hints]
    lines += [f"    also: {words}" for words in difference.more] if is_first else []
    return [_relative_paths(text) for text in lines]


def _relative_paths(text: str) -> str:
    """Replace absolute paths below the working directory by relative paths."""
    here = f"{Path.cwd()}{os.sep}"
    return text.replace(here, "")
