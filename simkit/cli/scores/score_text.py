"""Scores as text for a terminal."""

from __future__ import annotations

import shlex
import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

from simkit.cli.scores.file_score import FileScore, Remedy, ScoredPart, Status
from simkit.cli.scores.folder_score import FolderScore
from simkit.cli.scores.part_list import KIND_TITLES
from simkit.diagnostic_record import TEXT_SOURCE
from simkit.diagnostics import shorten

MISSING_TITLES: Final[dict[Status, str]] = {
    "refused": "refused because of",
    "runs": "left out or approximated",
}
"""Titles of what refused files lack, and of what files that run lack."""
_MOST_PARTS = 20
_MOST_REMEDIES = 8
_MOST_MISSING = 8
_MOST_PLACES = 3
_MOST_NAMES = 2  # parts of one kind that the table of a folder names
_LONGEST = 110  # characters of a problem
_COLUMNS = 180  # width of the table of a folder that is not printed on a terminal


def score_lines(score: FileScore) -> Iterator[str]:
    """Yield the lines about one file: the score, the kinds of parts, what is left out, and what would mend it."""
    yield f"{score.file}: score {score.score} of 100, {status_text(score)}"
    if score.kinds:
        width = max(len(title) for title in KIND_TITLES.values())
        yield f"  {'':{width}}   used  approximated  left out   points"
        for kind in score.kinds:
            numbers = f"{kind.used:6}{kind.approximated:14}{kind.left_out:10}"
            yield f"  {KIND_TITLES[kind.kind]:{width}} {numbers}   {kind.points:.1f} of {kind.most:.1f}"
    for state in ("left out", "approximated"):
        parts = [part for part in score.parts if part.state == state]
        if parts:
            yield f"{state}:"
            yield from (f"  {line}" for part in parts[:_MOST_PARTS] for line in _part_lines(part))
            if len(parts) > _MOST_PARTS:
                yield f"  and {len(parts) - _MOST_PARTS} more; list all with --json or --html"
    if score.remedies:
        yield "what would make it whole:"
        yield from (f"  {_remedy_line(remedy)}" for remedy in score.remedies[:_MOST_REMEDIES])
        if len(score.remedies) > _MOST_REMEDIES:
            yield f"  and {len(score.remedies) - _MOST_REMEDIES} more"


def status_text(score: FileScore) -> str:
    """Return the result for a file in words."""
    if score.status == "refused":
        return "refused"
    if score.status == "part":
        return "a part of other files"
    return "it runs" if score.parts else "it runs, and all of it works as in Gazebo"


def _part_lines(part: ScoredPart) -> Iterator[str]:
    yield f"{place_text(part.file, part.line)}: {part.element} {part.name!r} ({part.points:g} points)"


def _remedy_line(remedy: Remedy) -> str:
    places = ", ".join(remedy.places[:_MOST_PLACES])
    if len(remedy.places) > _MOST_PLACES:
        places += f" and {len(remedy.places) - _MOST_PLACES} more"
    gain = "" if remedy.points is None else f"+{remedy.points:.1f}  "
    text = f"{gain}{places}: {shorten(remedy.problem, 2 * _LONGEST)}" if places else f"{gain}{remedy.problem}"
    return f"{text}\n      help: {shorten(remedy.text, 2 * _LONGEST)}" if remedy.text else text


def place_text(file: str | None, line: int | None) -> str:
    """Return `file:line`."""
    return f"{file or TEXT_SOURCE}:{line}" if line else file or TEXT_SOURCE


def folder_lines(scores: Sequence[FileScore]) -> Iterator[str]:
    """Yield the table of the files of a folder, as wide as the terminal."""
    columns = shutil.get_terminal_size((_COLUMNS, 24)).columns
    widest = max(20, columns // 2 - 9)
    names = [score.file.replace("\n", "\\n") for score in scores]
    width = max((min(len(name), widest) for name in names), default=0)
    yield "score  file"
    for score, full_name in zip(scores, names, strict=True):
        name = full_name if len(full_name) <= width else "…" + full_name[1 - width :]  # the end of a path says more
        number = "part" if score.status == "part" else str(score.score)
        yield f"{number:>5}  {name:{width}}  {shorten(row_text(score), max(20, columns - width - 9))}".rstrip()


def row_text(score: FileScore) -> str:
    """Return what the table of a folder says about a file."""
    if score.status == "refused":
        return f"refused: {score.reason}"
    if score.status == "part":
        return score.reason
    texts = []
    for state in ("left out", "approximated"):
        parts = [part for part in score.parts if part.state == state]
        if parts:
            texts.append(f"{state}: {_grouped(parts)}")
    return "; ".join(texts)


def _grouped(parts: list[ScoredPart]) -> str:
    """Return the parts as numbers by element, with the name of the first plugin or sensor."""
    groups: dict[str, list[ScoredPart]] = {}
    for part in parts:
        groups.setdefault("drive plugin" if part.kind == "drives" else part.element, []).append(part)
    texts = []
    for element, members in groups.items():
        if len(members) <= _MOST_NAMES:
            texts.append(f"{element} " + ", ".join(_last_name(member.name) for member in members))
        else:
            texts.append(f"{len(members)} {element}s")
    return ", ".join(texts)


def _last_name(name: str) -> str:
    """Return the last part of a scoped name; all of a URI."""
    return name if "/" in name else name.rpartition("::")[2]


def summary_lines(table: FolderScore) -> Iterator[str]:
    """Yield the summary of a folder: how many files run, what is missing, and the first command to try."""
    running, whole = table.running, table.whole
    full = sum(score.score == 100 for score in running)
    parts = len(table.files) - len(whole)
    line = f"{len(running)} of {len(whole)} run as they are" + (f", {full} of them with score 100" if full else "")
    yield line + (f"; {parts} more {'are parts' if parts > 1 else 'is a part'} of others" if parts else "")
    for status, title in MISSING_TITLES.items():
        missing = table.missing(status)
        if missing:
            yield f"{title}, by the number of files:"
            yield from (f"  {count:4}  {what}" for what, count in missing[:_MOST_MISSING])
        if len(missing) > _MOST_MISSING:
            yield f"        and {len(missing) - _MOST_MISSING} more; list all with --json or --html"
    for title, count, reason, command in table.commands_of_others():
        yield f"not checked: {count} {title}: {reason}" + (f"; start one with: {command}" if command else "")
    if unreadable := table.found.unreadable:
        yield f"not searched: {shorten(', '.join(unreadable), _LONGEST)}, because this user may not read it"
    if not table.found.is_complete:
        yield "the folder has too many files; the search stopped, so check a folder in it"
    first = table.first_command()
    if first:
        yield f"try first: {first}"
    elif whole:
        file = shlex.quote(str(Path(table.folder, whole[0].file)))
        yield f"no file runs yet; see why: simkit check {file}"
