"""What a certificate says."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from typing import Any, Final

from simkit.certify.hints import Hint
from simkit.certify.outcome import Outcome
from simkit.certify.variations import Variation

FORMAT: Final = 1


@dataclass(frozen=True)
class Row:
    """One run.

    Attributes:
        variation: its surroundings.
        outcome: what came of it.
        streams: one hash of all topics; empty where nobody listened. Of a run that listened later it is of the
            messages from then on.
        same: whether it is what the first run was.
    """

    variation: Variation
    outcome: Outcome
    streams: str
    same: bool


@dataclass(frozen=True)
class Difference:
    """The first thing that was other in a run.

    Attributes:
        variation: which run.
        words: what differs, in a sentence: `/odom: message 37 at t = 1.233 s`.
        tick: the first at which something differs; None where that is not of one tick.
        time: of that [s].
        owner: the plugin or sensor that began it: `plugin 'drive' (robot.sdf:12)`; empty where it is not known.
        how: what it did, in words.
        hints: places in its code that often are to blame.
        more: what else differs, in sentences.
    """

    variation: Variation
    words: str
    tick: int | None = None
    time: float | None = None
    owner: str = ""
    how: str = ""
    hints: tuple[Hint, ...] = ()
    more: tuple[str, ...] = ()


@dataclass
class Certificate:
    """Runs side by side.

    Attributes:
        name: of the scenario.
        world, duration, seed: what was run.
        rows: the runs; the others are compared with the first.
        differences: of each run that was other; empty for a pass.
        notes: what is other and does not count.
        fingerprint: of the machine, which it holds for.
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
    def passed(self) -> bool:
        """Whether all runs gave the same bits."""
        return not self.differences

    def to_dict(self) -> dict[str, Any]:
        """For programs; holds nothing of the wall clock, so that two of one world are equal where it is."""
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
            "runs": [_row(row) for row in self.rows],
            "differences": [_difference(one) for one in self.differences],
            "notes": self.notes,
        }


def _row(row: Row) -> dict[str, Any]:
    return {
        "name": row.variation.name,
        "other": row.variation.words,
        "state": row.outcome.state,
        "streams": row.streams,
        "same": row.same,
        "ended": str(row.outcome.failure or row.outcome.stopped or row.outcome.end),
    }


def _difference(one: Difference) -> dict[str, Any]:
    return {
        "run": one.variation.name,
        "what": one.words,
        "tick": one.tick,
        "time": one.time,
        "owner": one.owner,
        "how": one.how,
        "hints": [{"where": hint.where, "text": hint.text} for hint in one.hints],
        "more": list(one.more),
    }


def streams_hash(outcome: Outcome) -> str:
    """One hash of all that was heard; empty where nobody listened."""
    if not outcome.heard:
        return ""
    whole = hashlib.sha256()
    for topic, heard in sorted(outcome.heard.items()):
        if outcome.heard_from:
            heard_digest = hashlib.sha256(heard.digests[heard.ticks > outcome.heard_from].tobytes()).hexdigest()
        else:
            heard_digest = heard.digest
        whole.update(f"{topic} {heard.type_name} {heard_digest}\n".encode())
    return whole.hexdigest()
