"""What a comparison finds, and what it comes from."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

if TYPE_CHECKING:
    from simkit.testing.conditions import CheckResult
    from simkit.testing.run_record.record import RunRecord

DifferenceKind = Literal[
    "value", "bits", "count", "time", "missing", "extra", "text", "picture", "statistics", "state", "model", "end"
]
CauseKind = Literal["model", "file", "code", "version", "scenario", "input"]


@dataclass(frozen=True)
class Difference:
    """The first thing in which a topic's field differs.

    Attributes:
        topic: which; empty for the state.
        field: path within the message; empty for the whole topic.
        kind: of difference.
        time: of the first one [s].
        size: the largest, in the field's unit; nan where there is none.
        unit: of `size`.
        words: in a sentence: `/scan.ranges: 14 of 360 rays +12 mm from t = 3.20 s`.
        allowed: the tolerance, in words.
        index: of the first message that differs; -1 where that says nothing.
        columns: paths of the columns that `field` is made of, where it is no column itself (an orientation).
    """

    topic: str
    field: str
    kind: DifferenceKind
    time: float
    size: float
    unit: str
    words: str
    allowed: str = ""
    index: int = -1
    columns: tuple[str, ...] = ()


@dataclass
class Comparison:
    """Two records side by side.

    Attributes:
        tier: "exact" where the same machine and versions must give the same bits, else "tolerant".
        differences: that count, by time, then topic; empty for a pass.
        notes: what is other and does not count, in sentences.
        machine: what of the fingerprint is other: name -> (golden, run).
        topics: how many topics were compared.
        messages: how many messages.
    """

    tier: Literal["exact", "tolerant"]
    differences: list[Difference] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    machine: dict[str, tuple[str, str]] = field(default_factory=dict)
    topics: int = 0
    messages: int = 0

    @property
    def passed(self) -> bool:
        """Whether nothing differs that may not."""
        return not self.differences


@dataclass(frozen=True)
class Cause:
    """A change that lies behind differences.

    Attributes:
        kind: what was changed.
        words: in a sentence: `wheel_left_link::collision: radius 0.033 → 0.0333`.
        path: of the leaf, the file or the version.
        golden, run: its values.
        where: `file:line` of the run's; empty where there is none.
        proven: True where the run with this put back gives the golden outputs, False where it does not, None where it
            was not tried.
    """

    kind: CauseKind
    words: str
    path: str
    golden: Any
    run: Any
    where: str = ""
    proven: bool | None = None


@dataclass
class Explanation:
    """Where differences come from.

    Attributes:
        causes: the likeliest first.
        tick: the first at which the physics differs; None where it does not.
        time: of that [s].
        quantity: what differs there first, in words; "" where nothing does.
        lines: the whole in sentences, as a report shows them.
    """

    causes: list[Cause] = field(default_factory=list)
    tick: int | None = None
    time: float | None = None
    quantity: str = ""
    lines: list[str] = field(default_factory=list)


@dataclass
class Verdict:
    """One golden run that was checked.

    Attributes:
        name: of the golden.
        golden, run: both records.
        comparison: of them.
        explanation: None for a pass.
        checks: the scenario's own.
        elapsed: wall time of the run [s].
    """

    name: str
    golden: RunRecord
    run: RunRecord
    comparison: Comparison
    explanation: Explanation | None = None
    checks: tuple[CheckResult, ...] = ()
    elapsed: float = 0.0

    @property
    def passed(self) -> bool:
        """Whether outputs are the golden ones and every check held."""
        return self.comparison.passed and all(check.passed for check in self.checks)
