"""Data types for differences, their causes, and the verdict on a golden run."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from simkit.testing.conditions import CheckResult
    from simkit.testing.run_record.record import RunRecord

DifferenceKind = Literal[
    "value", "bits", "count", "time", "missing", "extra", "text", "picture", "statistics", "state", "model", "end",
    "left out",
]  # fmt: skip
CauseKind = Literal["model", "file", "code", "version", "scenario", "input"]


@dataclass(frozen=True)
class Difference:
    """First difference in a field of a topic.

    Attributes:
        topic: Topic; empty for the physics state.
        field: Path of the field within the message; empty for the whole topic.
        kind: Kind of difference.
        time: Time of the first difference [s].
        size: Largest difference in the field's unit; NaN for a difference without a size.
        unit: Unit of `size`.
        words: Sentence such as `/scan.ranges: 14 of 360 rays +12 mm from t = 3.20 s`.
        allowed: Tolerance in words.
        index: Index of the first message that differs; -1 if the difference is not in a message.
        columns: Paths of the columns if `field` has several columns (an orientation); empty otherwise.
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
    """Result of comparing two records.

    Attributes:
        tier: "exact" if no difference of machine or versions can change bits, else "tolerant".
        differences: Differences beyond their tolerance, by time, then topic; empty for a pass.
        notes: Sentences about differences within the tolerances, and about data that are not compared.
        machine: Entries of the fingerprint that differ: name -> (golden, run).
        topics: Number of compared topics.
        messages: Number of compared messages.
        is_identical: True if all compared outputs have the same bits, although the machine may differ.
    """

    tier: Literal["exact", "tolerant"]
    differences: list[Difference] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    machine: dict[str, tuple[str, str]] = field(default_factory=dict)
    topics: int = 0
    messages: int = 0
    is_identical: bool = True

    @property
    def passed(self) -> bool:
        """True if no difference exceeds its tolerance."""
        return not self.differences

    @property
    def can_be_blessed(self) -> bool:
        """True if outputs differ, have other bits on another machine, or are those of another version of simkit.

        A golden run of the present version of simkit is compared bit for bit again.
        """
        return not self.passed or "simkit" in self.machine or (bool(self.machine) and not self.is_identical)


@dataclass(frozen=True)
class Cause:
    """Change that may have caused the differences.

    Attributes:
        kind: Kind of change.
        words: Sentence such as `wheel_left_link::collision: radius 0.033 → 0.0333`.
        path: Path of the world value, the file or the version.
        golden, run: Values in both runs.
        where: `file:line` in the files of the run; empty if unknown.
        proven: True if the run with this change undone gives the golden outputs, False if it does not, None if this was
            not tested.
    """

    kind: CauseKind
    words: str
    path: str
    golden: object
    run: object
    where: str = ""
    proven: bool | None = None


@dataclass
class Explanation:
    """Causes of the differences.

    Attributes:
        causes: Causes, most likely first.
        tick: First tick at which the physics differs; None if it does not differ.
        time: Simulated time of that tick [s].
        quantity: First quantity of the physics state that differs, in words; empty if there is none.
        lines: Complete explanation, as shown in reports.
    """

    causes: list[Cause] = field(default_factory=list)
    tick: int | None = None
    time: float | None = None
    quantity: str = ""
    lines: list[str] = field(default_factory=list)


@dataclass
class Verdict:
    """Result of checking one golden run.

    Attributes:
        name: Name of the golden run.
        golden, run: Records of both runs.
        comparison: Comparison of the records.
        explanation: Causes of the differences; None for a pass.
        checks: Results of the scenario's own checks.
        elapsed: Wall time of the run [s].
        world_pictures: Name and JPEG file of a picture of each world; empty if none were drawn.
        world_note: Reason why there are no pictures of the worlds.
    """

    name: str
    golden: RunRecord
    run: RunRecord
    comparison: Comparison
    explanation: Explanation | None = None
    checks: tuple[CheckResult, ...] = ()
    elapsed: float = 0.0
    world_pictures: tuple[tuple[str, bytes], ...] = ()
    world_note: str = ""

    @property
    def passed(self) -> bool:
        """True if the outputs equal the golden run and every check passed."""
        return self.comparison.passed and all(check.passed for check in self.checks)
