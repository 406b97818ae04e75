"""Score of one file as data: its parts with their states, and what would make the file whole."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Literal

from simkit.cli.scores.part_list import PartKind
from simkit.cli.terminal.output import JsonObject

State = Literal["used", "approximated", "left out"]
Status = Literal["runs", "refused", "part"]
"""Result for a file: it runs, it is refused, or it is a part that other files include."""


@dataclass(frozen=True)
class KindScore:
    """Parts of one kind.

    Attributes:
        kind: kind of the parts.
        used, approximated, left_out: numbers of parts.
        points: points of this kind in the score of the file, which are at most `most`.
        most: 100 divided by the number of kinds in the file.
    """

    kind: PartKind
    used: int
    approximated: int
    left_out: int
    points: float
    most: float

    @property
    def total(self) -> int:
        """Number of parts."""
        return self.used + self.approximated + self.left_out


@dataclass(frozen=True)
class ScoredPart:
    """One part with its state.

    Attributes:
        state: used, approximated or left out.
        kind: kind of the part.
        element: name of its element in the file.
        name: scoped name, or the URI of an include.
        file, line: place of its element.
        points: points that the file would gain if the part worked as in Gazebo.
        problems: diagnostics that say why it does not, as plain data.
    """

    state: State
    kind: PartKind
    element: str
    name: str
    file: str | None
    line: int | None
    points: float
    problems: list[JsonObject] = field(default_factory=list)


@dataclass(frozen=True)
class Remedy:
    """Remedy of a problem, which would make a file whole.

    Attributes:
        text: remedy.
        problem: problem that it removes.
        places: `file:line` of the problem.
        points: points that the file would gain; None for a refused file.
    """

    text: str
    problem: str
    places: list[str]
    points: float | None


@dataclass(frozen=True)
class FileScore:
    """Score of a file.

    Attributes:
        file: file, as it was given.
        status: "runs", "refused" or "part".
        score: 0 to 100.
        reason: why the file is refused or is a part; empty for one that runs.
        kinds: numbers of parts by kind.
        parts: parts that are approximated or left out, the most expensive first.
        used: parts that are used; empty in the table of a folder.
        remedies: what would make the file whole, the most valuable first.
        missing: what the file lacks, each in one line, for counts over many files.
        counts: numbers of errors, warnings and notes.
        diagnostics: all diagnostics as plain data; empty in the table of a folder.
        picture: image of the world in base64 (JPEG), or empty.
        picture_note: why there is no picture, or what it does not show.
    """

    file: str
    status: Status
    score: int
    reason: str = ""
    kinds: list[KindScore] = field(default_factory=list)
    parts: list[ScoredPart] = field(default_factory=list)
    used: list[ScoredPart] = field(default_factory=list)
    remedies: list[Remedy] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)
    counts: dict[str, int] = field(default_factory=dict)
    diagnostics: list[JsonObject] = field(default_factory=list)
    picture: str = ""
    picture_note: str = ""

    def as_dict(self) -> JsonObject:
        """Return the score as plain data."""
        return asdict(self)

    @classmethod
    def from_dict(cls, data: JsonObject) -> FileScore:
        """Return a score from plain data."""
        lists: dict[str, type] = {"kinds": KindScore, "parts": ScoredPart, "used": ScoredPart, "remedies": Remedy}
        return cls(**{**data, **{name: [kind(**item) for item in data[name]] for name, kind in lists.items()}})

    def has_working(self, kind: PartKind) -> bool:
        """Check whether a part of a kind is used or approximated."""
        return any(item.kind == kind and item.left_out < item.total for item in self.kinds)
