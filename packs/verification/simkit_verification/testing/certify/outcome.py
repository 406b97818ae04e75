"""Outcome of one run in a child process, its file, and the differences of two outcomes with their cause."""

from __future__ import annotations

import os
import pickle
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, TypeVar

import numpy as np
import numpy.typing as npt

from simkit.errors import SimkitError
from simkit.extend import counted
from simkit.testing import newly_left_out

STACK_FILE: Final = "stack"
"""File to which `faulthandler` writes the stack trace of a process that is stopped at its limit."""

_Value = TypeVar("_Value")
Numbers = npt.NDArray[np.uint64]


@dataclass
class TopicOutcome:
    """Hashes of the received messages of one topic.

    Attributes:
        type_name: ROS type.
        digests: Short hash of each message in CDR, shape (messages,).
        ticks: Tick at which each message was received, shape (messages,); -1 if messages were collected later.
        digest: Hexadecimal SHA-256 of all messages.
        owner: Publisher: `plugin 'drive' (robot.sdf:12)`.
    """

    type_name: str
    digests: Numbers
    ticks: npt.NDArray[np.int64]
    digest: str
    owner: str = ""


@dataclass
class PluginCall:
    """Call of a plugin.

    Attributes:
        tick: Tick of the call.
        owner: Plugin and its position: `plugin 'drive' (robot.sdf:12)`.
        hook: Name of the hook.
        before, after: Short hashes of the writable state before and after the call.
        changed: Hashes of attributes changed since the previous call; 0 for a deleted attribute.
        shown: Values of these attributes as short texts.
    """

    tick: int
    owner: str
    hook: str
    before: int
    after: int
    changed: dict[str, int] = field(default_factory=dict)
    shown: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class CodePosition:
    """Line of code that a process was executing.

    Attributes:
        file, line: Position.
        function: Name of the function.
    """

    file: str
    line: int
    function: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}"


@dataclass
class RunOutcome:
    """Results of one run.

    Attributes:
        failure: Error of loading the world; None if it was loaded.
        stopped: Reason why the process gave no result; empty if it gave one.
        is_killed: True if the system killed the process, as Linux does when memory runs out.
        stack: Code positions when the process was stopped, innermost function first.
        end: Error that ended the run; empty for a regular end.
        ticks: Number of steps.
        timestep: Time step [s].
        state: Hash of the physics at the end, as `simkit run` prints it.
        marks: Short hash of the physics after each tick, shape (ticks,).
        inputs: Short hash of the inputs at each tick, shape (ticks,).
        heard: Topic -> hashes of its received messages.
        heard_from: Tick at which the subscribers were added; only later messages are compared.
        latest: Sensor -> hash of its newest reading at the end.
        remembered: Plugin -> hashes of its attributes at the end.
        sources: Plugin or sensor -> file, first line and last line of its class.
        fingerprint: Fingerprint of the machine.
        left_out: Names of the sensors, plugins and controllers without which the world ran, with their numbers.
        events: Recorded plugin calls; empty if the calls were not recorded.
        seconds: Wall time of the run [s].
    """

    failure: SimkitError | None = None
    stopped: str = ""
    is_killed: bool = False
    stack: list[CodePosition] = field(default_factory=list)
    end: str = ""
    ticks: int = 0
    timestep: float = 0.0
    state: str = ""
    marks: Numbers = field(default_factory=lambda: np.zeros(0, np.uint64))
    inputs: Numbers = field(default_factory=lambda: np.zeros(0, np.uint64))
    heard: dict[str, TopicOutcome] = field(default_factory=dict)
    heard_from: int = 0
    latest: dict[str, int] = field(default_factory=dict)
    remembered: dict[str, dict[str, int]] = field(default_factory=dict)
    sources: dict[str, tuple[str, int, int]] = field(default_factory=dict)
    fingerprint: dict[str, str] = field(default_factory=dict)
    left_out: dict[str, int] = field(default_factory=dict)
    events: list[PluginCall] = field(default_factory=list)
    seconds: float = 0.0


def write_pickle(path: Path, value: object) -> None:
    """Write an object for the other process atomically.

    Pickle is safe here, because both processes belong to the same user and use a private folder.
    """
    beside = path.with_suffix(".part")
    beside.write_bytes(pickle.dumps(value))
    os.replace(beside, path)  # noqa: PTH105 - atomic on every platform


def read_pickle(path: Path, kind: type[_Value]) -> _Value:
    """Read the object that the other process wrote.

    Raises:
        pickle.UnpicklingError: The file is damaged, or the object is of another kind.
    """
    value = pickle.loads(path.read_bytes())
    if not isinstance(value, kind):
        raise pickle.UnpicklingError(f"{path} has a {type(value).__name__}, not a {kind.__name__}")
    return value


_MAX_LISTED: Final = 5


@dataclass(frozen=True)
class OutcomeDifference:
    """Difference between two runs.

    Attributes:
        words: Sentence that describes the difference.
        tick: First tick that differs; None if the difference has no tick.
        owner: Plugin or sensor that caused it; empty if unknown.
    """

    words: str
    tick: int | None = None
    owner: str = ""


def differences(one: RunOutcome, other: RunOutcome) -> list[OutcomeDifference]:
    """Return all differences between the first run and another run, earliest first."""
    if other.stopped:
        return [OutcomeDifference(other.stopped)]
    if other.failure is not None:
        return [OutcomeDifference(f"the world cannot be loaded: {other.failure}")]
    unsorted = [
        *_physics_differences(one, other),
        *_topic_differences(one, other),
        *_ending_differences(one, other),
        *_latest_differences(one, other),
    ]
    last = max(one.ticks, other.ticks) + 1
    return [*_left_out_differences(one, other), *sorted(unsorted, key=lambda f: last if f.tick is None else f.tick)]


def first_tick(differences: list[OutcomeDifference]) -> int | None:
    """Return the earliest tick of all differences; None if no difference has a tick."""
    return min((f.tick for f in differences if f.tick is not None), default=None)


def _left_out_differences(one: RunOutcome, other: RunOutcome) -> list[OutcomeDifference]:
    """Return what only one of the two worlds has; it is the cause of the other differences."""
    pairs = ((one.left_out, other.left_out, "this run"), (other.left_out, one.left_out, "the first run"))
    return [
        OutcomeDifference(f"only the world of {run} is without {name}")
        for before, now, run in pairs
        for name in newly_left_out(before, now)
    ]


def _physics_differences(one: RunOutcome, other: RunOutcome) -> list[OutcomeDifference]:
    unequal = []
    state, inputs = _first_different_row(one.marks, other.marks), _first_different_row(one.inputs, other.inputs)
    if inputs is not None and (state is None or inputs <= state):
        tick = inputs + 1
        unequal.append(
            OutcomeDifference(f"inputs from plugins (controls, forces) differ at {tick_text(tick, one)}", tick)
        )
    if state is not None:
        same = "" if inputs is not None and inputs <= state else "; until then all inputs are equal"
        unequal.append(OutcomeDifference(f"the physics differs from {tick_text(state + 1, one)}{same}", state + 1))
    elif one.state != other.state:
        unequal.append(OutcomeDifference("the state hash at the end differs"))
    return unequal


def _topic_differences(one: RunOutcome, other: RunOutcome) -> list[OutcomeDifference]:
    if not one.heard or not other.heard:
        return []
    unequal = []
    for topic in sorted({*one.heard, *other.heard}):
        mine, theirs = one.heard.get(topic), other.heard.get(topic)
        if mine is None or theirs is None:
            known = mine or theirs
            if known is not None and (len(known.digests) or not (one.heard_from or other.heard_from)):
                where = "the first run" if theirs is None else "this run"
                unequal.append(OutcomeDifference(f"{topic}: only in {where}", None, known.owner))
            continue
        if mine.type_name != theirs.type_name:
            unequal.append(OutcomeDifference(f"{topic}: {theirs.type_name}, not {mine.type_name}", None, mine.owner))
        index, tick = _first_message(mine, theirs, max(one.heard_from, other.heard_from))
        if index is not None:
            words = f"{topic}: message {index + 1}" + (f" at {tick_text(tick, one)}" if tick is not None else "")
            if len(mine.digests) != len(theirs.digests) and not other.heard_from:
                words += f"; {counted(len(mine.digests), 'message')} became {len(theirs.digests)}"
            unequal.append(OutcomeDifference(words, tick, mine.owner))
    return unequal


def _first_message(mine: TopicOutcome, theirs: TopicOutcome, after: int) -> tuple[int | None, int | None]:
    """Compare the messages after a tick; return the index and the tick of the first message that differs."""
    left, right = _after_tick(mine, after), _after_tick(theirs, after)
    index = _first_different_row(mine.digests[left], theirs.digests[right])
    if index is None:
        return None, None
    for heard, chosen in ((mine, left), (theirs, right)):
        ticks = heard.ticks[chosen]
        if index < len(ticks) and ticks[index] >= 0:
            return index + int((mine.ticks <= after).sum() if after else 0), int(ticks[index])
    return index, None


def _after_tick(heard: TopicOutcome, tick: int) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    return (heard.ticks > tick) | (heard.ticks < 0) if tick else np.ones(len(heard.ticks), bool)


def _ending_differences(one: RunOutcome, other: RunOutcome) -> list[OutcomeDifference]:
    if one.end != other.end:
        text = f"ended with: {other.end}" if other.end else f"ended regularly; the first run ended with: {one.end}"
        return [OutcomeDifference(text, min(one.ticks, other.ticks))]
    if one.ticks != other.ticks:
        return [OutcomeDifference(f"ended after {counted(other.ticks, 'step')}, the first run after {one.ticks}", None)]
    return []


def _latest_differences(one: RunOutcome, other: RunOutcome) -> list[OutcomeDifference]:
    names = [n for n in one.latest if one.latest[n] != other.latest.get(n)]
    return [OutcomeDifference(f"{name}: the last reading differs", None, name) for name in names[:_MAX_LISTED]]


def _first_different_row(one: Numbers, other: Numbers) -> int | None:
    """Return the index of the first difference of two rows; None if they are equal."""
    count = min(len(one), len(other))
    unequal = np.flatnonzero(one[:count] != other[:count])
    if len(unequal):
        return int(unequal[0])
    return None if len(one) == len(other) else count


def tick_text(tick: int, outcome: RunOutcome) -> str:
    """Format a tick with its time."""
    return f"tick {tick} (t = {tick * outcome.timestep:.6g} s)"


# ---------------------------------------------------------------------- cause


@dataclass(frozen=True)
class Culprit:
    """Plugin or sensor that caused the first difference.

    Attributes:
        owner: Plugin or sensor.
        tick: Tick of the cause.
        how: Description of the cause.
        matters: True if the state or an output differs, False if only an attribute of the plugin differs.
    """

    owner: str
    tick: int
    how: str
    matters: bool = True


def find_culprit(one: RunOutcome, other: RunOutcome) -> Culprit | None:
    """Find the plugin or sensor that caused the first difference between two runs; None if unknown.

    Both runs must have recorded plugin calls.
    """
    called = _first_different_call(one.events, other.events, one)
    ticks = {f.tick: f for f in reversed(_topic_differences(one, other)) if f.owner and f.tick is not None}
    tick = min(ticks, default=None)
    if tick is None or (called is not None and called.tick <= tick):
        return called
    return Culprit(ticks[tick].owner, tick, f"its output differs: {ticks[tick].words}")


def _first_different_call(ours: list[PluginCall], theirs: list[PluginCall], outcome: RunOutcome) -> Culprit | None:
    """Return the plugin whose call first had a different effect on the state.

    If there is none, return the plugin whose attributes differed first.
    """
    remembers: Culprit | None = None
    known: set[str] = set()
    for mine, yours in zip(ours, theirs, strict=False):
        if (mine.tick, mine.owner, mine.hook) != (yours.tick, yours.owner, yours.hook):
            early = min(mine, yours, key=lambda event: event.tick)
            if remembers and remembers.owner == early.owner:
                return remembers
            words = f"its {early.hook} is called at {tick_text(early.tick, outcome)} in only one of the runs"
            return Culprit(early.owner, early.tick, words)
        if mine.before != yours.before:
            return remembers
        attributes = _different_attributes(mine, yours)
        if attributes and mine.owner not in known:
            known.add(mine.owner)
            words = f"after its {mine.hook} at {tick_text(mine.tick, outcome)} its attributes differ"
            remembers = remembers or Culprit(mine.owner, mine.tick, f"{words}: {attributes}", matters=False)
        if mine.after != yours.after:
            cause = f"; {remembers.how}" if remembers and remembers.owner == mine.owner else ""
            return Culprit(mine.owner, mine.tick, f"its {mine.hook} writes different inputs{cause}")
    return remembers


def _different_attributes(mine: PluginCall, yours: PluginCall) -> str:
    """Describe the attributes that differ: `phase (0.25, not 0.75), seen`."""
    names = [n for n in sorted({*mine.changed, *yours.changed}) if mine.changed.get(n) != yours.changed.get(n)]
    texts = []
    for name in names[:3]:
        here, there = mine.shown.get(name, ""), yours.shown.get(name, "")
        texts.append(f"{name} ({there}, not {here})" if here and there and here != there else name)
    return ", ".join(texts) + (f" and {len(names) - 3} more" if len(names) > 3 else "")
