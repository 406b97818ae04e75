"""A certificate as a terminal shows it."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from simkit.certify.certificate import Certificate, Difference, Row

_SHOWN: Final = 12  # letters of a hash


def header() -> str:
    """Of the table."""
    return f"{'run':<12}  {'state':<{_SHOWN}}  {'streams':<{_SHOWN}}  {'':<9}  what is other"


def line(row: Row) -> str:
    """One run."""
    outcome = row.outcome
    state = outcome.state[:_SHOWN] if outcome.state else "-"
    streams = ("second half" if outcome.heard_from else row.streams[:_SHOWN]) or "-"
    verdict = "same" if row.same else "DIFFERENT"
    return f"{row.variation.name:<12}  {state:<{_SHOWN}}  {streams:<{_SHOWN}}  {verdict:<9}  {row.variation.words}"


def conclusion(made: Certificate) -> list[str]:
    """What stands below the table, the most important first."""
    first = made.rows[0].outcome
    lines: list[str] = []
    for number, (one, also) in enumerate(_alike(made.differences)):
        lines += _difference(one, also, is_first=number == 0)
    if made.passed:
        messages = sum(len(heard.digests) for heard in first.heard.values())
        told = f"{first.ticks} steps ({made.duration:g} s), {messages} messages on {len(first.heard)} topics"
        lines.append(f"the same bits in {len(made.rows)} runs: {told}, seed {made.seed}")
        if first.end:
            lines.append(f"every run ended with: {first.end}")
    else:
        lines.append(f"{len(made.differences)} of {len(made.rows) - 1} runs differ from the first")
    lines += [_from_here(f"note: {note}") for note in made.notes]
    shown = ", ".join(f"{name} {value}" for name, value in made.fingerprint.items() if value)
    return [*lines, f"on: {shown}"]


def _alike(differences: Sequence[Difference]) -> list[tuple[Difference, list[str]]]:
    """Differences that somebody else began, each with the names of the other runs that show the same."""
    found: dict[object, tuple[Difference, list[str]]] = {}
    for one in differences:
        key = (one.owner, one.hints) if one.owner else (one.words, one.how)
        if key in found:
            found[key][1].append(one.variation.name)
        else:
            found[key] = one, []
    return list(found.values())


def _difference(one: Difference, also: Sequence[str], *, is_first: bool) -> list[str]:
    lines = [f"{one.variation.name}: {one.words}" + (f"; and in: {', '.join(also)}" if also else "")]
    if one.owner:
        when = "" if one.tick is None else f" at tick {one.tick} (t = {one.time:.6g} s)"
        lines.append(f"    begun by {one.owner}{when}" + (f": {one.how}" if one.how else ""))
    elif one.how:
        lines.append(f"    {one.how}")
    lines += [f"    hint: {hint.where}: {hint.text}" for hint in one.hints]
    lines += [f"    also: {words}" for words in one.more] if is_first else []
    return [_from_here(text) for text in lines]


def _from_here(text: str) -> str:
    """With paths below the working directory as they are from there."""
    here = f"{Path.cwd()}{os.sep}"
    return text.replace(here, "")
