"""`simkit.compare`: two recordings, a recording and the run that repeats its commands, or two sets of runs."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from simkit import RunSpec
from simkit.argument_checks import wrong_type
from simkit.errors import InputError
from simkit.extend import did_you_mean
from simkit.msgs.data_frames import DataFrame
from simkit_identification.comparison.alignment import ALIGNMENTS, Align, alignment_offset
from simkit_identification.comparison.charts import charts_of
from simkit_identification.comparison.paired_runs import compare_sets, is_set
from simkit_identification.comparison.rows import rows_of_one, rows_of_two
from simkit_identification.comparison.sources import (
    TopicChoice,
    has_simulated_times,
    is_bag,
    read_bag,
    repeat_recording,
    world_spec,
)
from simkit_identification.comparison.table import Comparison
from simkit_identification.comparison.tolerances import INVALID, Tolerance, parse_tolerances, unused_tolerances
from simkit_identification.measures.recording import SignalRecording

_NOTHING_IN_COMMON: Final = "SK-COMPARE-002"
_NEAR: Final = 1.0  # [s] up to which two simulated clocks count as the same


def compare(
    a: str | os.PathLike[str] | DataFrame,
    b: str | os.PathLike[str] | RunSpec | DataFrame | None = None,
    *,
    names: Mapping[str, str] | None = None,
    topics: str | Sequence[str] = (),
    skip: str | Sequence[str] = (),
    commands: Sequence[str] = (),
    align: Align = "auto",
    tolerances: Mapping[str, float | str] | None = None,
    confidence: float = 0.95,
    seed: int | None = None,
    allow_code: bool = False,
) -> Comparison:
    """Compare two recordings, a recording with the run that repeats its commands, or two sets of runs.

    Args:
        a: bag; or a set of runs: the folder of a sweep, a folder of bags, or the table of `simkit.sweep`.
        b: bag, or a world or run specification, which is run with the commands of `a`; None for the figures of `a`
            alone; a set of runs if `a` is one.
        names: topic of `b` by topic of `a`, where they differ.
        topics: shell patterns of the topics to compare; empty for all.
        skip: shell patterns of topics to leave out.
        commands: topics to play into the world, `TOPIC` or `OLD:=NEW`; empty for every topic that it subscribes to.
        align: "none", "start", "correlation" of a signal, or "auto": none for a run and for simulated times, else
            correlation.
        tolerances: differences that count as none, by QUANTITY, /TOPIC or /TOPIC:QUANTITY (shell patterns): a number in
            the unit of the row, or a text such as "5%"; 0.1 % for all others.
        confidence: confidence of each interval, and of all verdicts together.
        seed: seed of the run; None for that of the specification.
        allow_code: allow the plugin folders that the file of a specification names.

    Returns:
        Table with a row for each quantity of each topic.

    Raises:
        InputError: SK-COMPARE-001 to 004; SK-CLI-035 a bag cannot be read.
        SimkitError: the world has errors, or the run fails.
    """
    checked = parse_tolerances({} if tolerances is None else tolerances)
    _check_options(align, confidence)
    if is_set(a):
        return compare_sets(a, b, confidence, checked)
    choice = TopicChoice(_texts(topics), _texts(skip), dict(names or {}), tuple(commands))
    path = _bag_path(a)
    first = read_bag(path, choice.takes)
    if b is None:
        return _report(first, choice, confidence)
    if isinstance(b, RunSpec) or not is_bag(Path(_file(b))):
        first, second = repeat_recording(world_spec(_world(b), seed), path, first, choice, allow_code=allow_code)
        second.commands, first.commands = first.commands, first.commands
        return _compare(first, second, "none", choice, confidence, checked, played=frozenset(first.commands))
    other = Path(_file(b))
    old_names = choice.old_names
    second = read_bag(other, lambda topic: choice.takes(old_names.get(topic, topic)))
    _check_names(first, second, choice)
    second = second.renamed(old_names)
    if align == "auto" and has_simulated_times(path) and has_simulated_times(other) and _begin_together(first, second):
        align = "none"
    return _compare(first, second, align, choice, confidence, checked)


def _texts(texts: str | Sequence[str]) -> tuple[str, ...]:
    return (texts,) if isinstance(texts, str) else tuple(texts)


def _check_options(align: str, confidence: float) -> None:
    problems = []
    if align not in ALIGNMENTS:
        hint = did_you_mean(align, ALIGNMENTS) or f"expected one of {', '.join(ALIGNMENTS)}"
        problems.append(f"align: found {align!r}; {hint}")
    if not 0.5 <= confidence < 1.0:
        problems.append(f"confidence: found {confidence:g}; expected 0.5 or more and less than 1, such as 0.95")
    if problems:
        raise InputError(INVALID, f"\n{INVALID} ".join(problems))


def _file(value: Any) -> str:
    if not isinstance(value, (str, os.PathLike)):
        raise wrong_type("the source", "a path of a bag, a world or a run specification", value)
    return os.fspath(value)


def _world(b: str | os.PathLike[str] | RunSpec) -> str | RunSpec:
    return b if isinstance(b, RunSpec) else _file(b)


def _bag_path(a: Any) -> Path:
    path = Path(_file(a))
    if not is_bag(path):
        text = (
            f"{path} is not a recording; the first source is an .mcap or .db3 file, a rosbag2 folder or a set of runs"
        )
        raise InputError("SK-COMPARE-001", text, help="record one: simkit run WORLD --duration 10 --record drive.mcap")
    return path


def _begin_together(a: SignalRecording, b: SignalRecording) -> bool:
    starts = [min((float(s.received[0]) for s in side.streams.values() if s.count), default=0.0) for side in (a, b)]
    return abs(starts[0] - starts[1]) < _NEAR


def _chosen(recording: SignalRecording, choice: TopicChoice) -> list[str]:
    return [topic for topic in recording.streams if choice.takes(topic)]


def _notes(*sides: SignalRecording) -> list[str]:
    notes: dict[str, None] = {}
    for side in sides:
        notes.update(dict.fromkeys(side.notes))
        for topic, stream in side.streams.items():
            notes.update(dict.fromkeys(f"{topic}: {note}" for note in stream.notes))
    return list(notes)


def _report(a: SignalRecording, choice: TopicChoice, confidence: float) -> Comparison:
    rows = rows_of_one(a, _chosen(a, choice), confidence)
    table = Comparison(a.name, "", rows, confidence, _notes(a))
    table.charts = charts_of(a, None, rows)
    return table


def _compare(
    a: SignalRecording,
    b: SignalRecording,
    align: Align,
    choice: TopicChoice,
    confidence: float,
    tolerances: list[Tolerance],
    played: frozenset[str] = frozenset(),
) -> Comparison:
    topics = [t for t in _chosen(a, choice) if t not in played]
    topics += [t for t in _chosen(b, choice) if t not in a.streams and t not in played]
    if not any(t in a.streams and t in b.streams for t in topics):
        raise _nothing_in_common(a, b, played)
    offset, sentence = alignment_offset(a, b, align)
    b = b.shifted(offset)
    if sentence:
        b.notes.append(sentence)
    start = max(_start(a), _start(b))
    end = min(a.duration, b.duration)
    if end - start <= 0.0:
        text = f"after alignment ({sentence or 'none'}) {a.name} and {b.name} have no time in common"
        raise InputError(_NOTHING_IN_COMMON, text, help="align them by their first messages: --align start")
    a, b = a.between(start, end), b.between(start, end)
    rows = rows_of_two(a, b, topics, confidence, tolerances)
    b.notes += [f"tolerance {t.pattern}: no row is called so" for t in unused_tolerances(tolerances[:-1], rows)]
    table = Comparison(a.name, b.name, rows, confidence, _notes(a, b))
    table.charts = charts_of(a, b, rows)
    return table


def _check_names(a: SignalRecording, b: SignalRecording, choice: TopicChoice) -> None:
    """Check that the topics of `names` are in the recordings, each with its own names."""
    problems: list[str] = []
    for old, new in choice.names.items():
        if not choice.takes(old):
            continue
        for side, topic in ((a, old), (b, new)):
            if topic not in side.streams:
                known = sorted(side.streams)
                hint = did_you_mean(topic, known) or f"it has {', '.join(known)}"
                problems.append(f"--map {old}={new}: {side.name} has no topic {topic}; {hint}")
    if problems:
        raise InputError(INVALID, f"\n{INVALID} ".join(problems))


def _nothing_in_common(a: SignalRecording, b: SignalRecording, played: frozenset[str]) -> InputError:
    """Return the error for recordings without a common topic besides the commands."""
    names = [", ".join(sorted(set(side.streams) - played)) or "none" for side in (a, b)]
    besides = f" besides the commands {', '.join(sorted(played))}" if played else ""
    text = f"{a.name} and {b.name} have no topic in common{besides}; a has {names[0]}; b has {names[1]}"
    return InputError(_NOTHING_IN_COMMON, text, help="name topics that correspond: --map /scan=/lidar/scan")


def _start(recording: SignalRecording) -> float:
    """Return the time of the first message on any topic that is not latched [s]."""
    return min((float(s.received[0]) for s in recording.streams.values() if s.count > 1), default=0.0)
