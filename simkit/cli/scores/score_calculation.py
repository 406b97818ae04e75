"""Computation of the score of one file: the share of its parts that work as in Gazebo.

Each kind of part that the file has counts the same. The share of a kind is the mean of its parts: 1 for a part that is
used, ½ for one that is approximated, 0 for one that is left out. A file that simkit refuses has the score 0.
"""

from __future__ import annotations

import base64
import functools
import math
import operator
import re
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit.cli.scores.file_score import FileScore, KindScore, Remedy, ScoredPart, State
from simkit.cli.scores.part_list import KINDS, Part, PartKind, list_parts
from simkit.cli.scores.part_places import PartPlaces
from simkit.diagnostic_record import TEXT_SOURCE
from simkit.diagnostics import Diagnostic, Diagnostics, shorten
from simkit.errors import SimkitError
from simkit.number_text import counted
from simkit.plugins.discovery.find_plugin_class import find_plugin
from simkit.plugins.discovery.left_out import CODE, DRIVE_CODE
from simkit.recording.pictures.frames import Look
from simkit.recording.run_picture import save_picture
from simkit.run_fields import LoadArguments
from simkit.scene import ScenePlugin
from simkit.sensors.cameras.overview_image import render_view

if TYPE_CHECKING:
    from simkit.runtime import Simulation

_WORTH: Final[dict[State, Fraction]] = {"used": Fraction(1), "approximated": Fraction(1, 2), "left out": Fraction(0)}
_OWNER: Final = re.compile(r"^\w+ '[^']*'(?: of '[^']*')?: ")
_FILE_IN_PACKAGE: Final = re.compile(r"^((?:model|package)://[^/\s]+)/\S+")
_SEARCHED: Final = re.compile(r"; searched [^;]*")
_LONGEST: Final = 140  # characters of what is missing
_NO_LINK: Final = "SK-URDF-008"

EffectOf = Callable[[str, str], str]
"""Function that returns the effect of a diagnostic by its code and severity: none, approximated or left out.

It is an argument because the table of codes is in the folder of the commands, which import this folder."""


@dataclass(frozen=True)
class ScoreOptions:
    """Contents of a score, beside the numbers.

    Attributes:
        effect_of: effects of diagnostics.
        details: used parts and all diagnostics.
        picture: longest side of the picture [px]; 0 for none.
        passes: passes of the picture; 16 draws soft shadows, 1 is fast.
    """

    effect_of: EffectOf
    details: bool = True
    picture: int = 0
    passes: int = 16


def score_file(source: str | Path, arguments: LoadArguments, options: ScoreOptions) -> FileScore:
    """Check a file and return its score.

    Args:
        source: file, bare name or XML text; a path is always a file.
        arguments: further arguments of `simkit.load`.
        options: what the score contains.
    """
    from simkit.build import check_and_visit

    text = source if isinstance(source, str) and "<" in source else ""
    shown = TEXT_SOURCE if text else str(source)
    results: list[FileScore] = []

    def visit(simulation: Simulation, diagnostics: Diagnostics) -> None:
        scored = _score_parts(simulation, list(diagnostics), text, arguments, options.effect_of)
        results.append(_loaded_score(shown, simulation, scored, list(diagnostics), options))

    found = list(check_and_visit(source, visit, **arguments))
    if results and not any(item.severity == "error" for item in found):
        return results[0]
    return refused_score(shown, found, options)


def refused_score(shown: str, found: Sequence[Diagnostic], options: ScoreOptions) -> FileScore:
    """Return the score of a file with errors: 0, with the errors as what is missing."""
    errors = [item for item in found if item.severity == "error"]
    is_part = bool(errors) and all(item.code == _NO_LINK for item in errors)
    reason = "it has no link of its own: a file that others include" if is_part else ""
    if errors and not is_part:
        # an error about something that is missing is the cause of errors such as a model without a link
        first = next((item for item in errors if options.effect_of(item.code, "warning") == "left out"), errors[0])
        reason = _without_places(first.message)
        if len(errors) > 1:
            reason += f" (and {counted(len(errors) - 1, 'more error')})"
    remedies: dict[tuple[str, str], Remedy] = {}
    for item in errors:
        message = _without_places(item.message)
        new = Remedy(item.hint, message, [], None)
        remedies.setdefault((item.hint, message), new).places.append(_place(item))
    return FileScore(
        shown, "part" if is_part else "refused", 0, reason,
        remedies=[] if is_part else list(remedies.values()),
        missing=[] if is_part else list(dict.fromkeys(map(_missing_text, errors))),
        counts=_counts(found), diagnostics=[item.as_dict() for item in found] if options.details else [],
        picture_note="there is no picture of a refused file",
    )  # fmt: skip


def _score_parts(
    simulation: Simulation,
    found: Sequence[Diagnostic],
    text: str,
    arguments: LoadArguments,
    effect_of: EffectOf,
) -> list[tuple[Part, State, list[Diagnostic]]]:
    """Return the parts of a world with their states and with the diagnostics that say why."""
    plugin_paths = [*map(_as_path, arguments.get("plugin_paths", ()))]

    def is_drive(plugin: ScenePlugin) -> bool:
        cls = find_plugin(plugin, plugin_paths, Diagnostics())
        return cls is not None and cls.drives

    parts = list_parts(simulation.world, is_drive)
    effects = [(item, effect) for item in found if (effect := effect_of(item.code, item.severity)) != "none"]
    places = PartPlaces(parts, [item for item, _ in effects], text)
    states: list[State] = ["used"] * len(parts)
    problems: dict[int, list[Diagnostic]] = {}
    absent: dict[Part, list[Diagnostic]] = {}
    for item, effect in effects:
        for numbers, missing, is_whole in places.find(item, left_out=effect == "left out"):
            if missing is not None:
                absent.setdefault(missing, []).append(item)
            for number in numbers:
                problems.setdefault(number, []).append(item)
                if states[number] != "left out":
                    states[number] = "left out" if is_whole else "approximated"
    scored = [(part, states[number], problems.get(number, [])) for number, part in enumerate(parts)]
    return scored + [(part, "left out", items) for part, items in absent.items()]


def _loaded_score(
    shown: str,
    simulation: Simulation,
    scored: Sequence[tuple[Part, State, list[Diagnostic]]],
    found: Sequence[Diagnostic],
    options: ScoreOptions,
) -> FileScore:
    by_kind = Counter(part.kind for part, _, _ in scored)
    shares = {kind: Fraction(100, len(by_kind) * count) for kind, count in by_kind.items()}
    lost = _total(shares[part.kind] * (1 - _WORTH[state]) for part, state, _ in scored)
    rows = [
        ScoredPart(
            state, part.kind, part.element, part.name, part.where.file, part.where.line,
            round(float(shares[part.kind] * (1 - _WORTH[state])), 2), [item.as_dict() for item in items],
        )
        for part, state, items in scored
    ]  # fmt: skip
    faulty = sorted((row for row in rows if row.state != "used"), key=lambda row: (-row.points, KINDS.index(row.kind)))
    picture, note = _picture(simulation, options) if options.picture else ("", "")
    return FileScore(
        shown, "runs", max(1, math.floor(100 - lost)),
        kinds=[_kind_score(kind, rows, shares[kind] * by_kind[kind]) for kind in KINDS if kind in by_kind],
        parts=faulty, used=[row for row in rows if row.state == "used"] if options.details else [],
        remedies=_remedies(faulty),
        missing=list(dict.fromkeys(_missing_text(item) for _, _, items in scored for item in _causes(items))),
        counts=_counts(found), diagnostics=[item.as_dict() for item in found] if options.details else [],
        picture=picture, picture_note=note,
    )  # fmt: skip


def _total(numbers: Iterable[Fraction]) -> Fraction:
    """Return the exact sum of fractions."""
    return functools.reduce(operator.add, numbers, Fraction(0))


def _kind_score(kind: PartKind, rows: Iterable[ScoredPart], most: Fraction) -> KindScore:
    states = Counter(row.state for row in rows if row.kind == kind)
    worth = _total(_WORTH[state] * count for state, count in states.items()) / states.total()
    numbers = states["used"], states["approximated"], states["left out"]
    return KindScore(kind, *numbers, round(float(most * worth), 2), round(float(most), 2))


def _remedies(faulty: Iterable[ScoredPart]) -> list[Remedy]:
    """Return the remedies of parts, the most valuable first; each part counts for its first problem with a remedy."""
    points: dict[tuple[str, str], float] = {}
    places: dict[tuple[str, str], dict[str, None]] = {}
    for row in faulty:
        causes = _causes([Diagnostic(**item) for item in row.problems])
        main = next((item for item in causes if item.hint), causes[0])
        key = main.hint, _without_places(main.message)
        points[key] = points.get(key, 0.0) + row.points
        places.setdefault(key, {}).setdefault(_place(main))
    ordered = sorted(points, key=lambda key: -points[key])
    return [
        Remedy(hint, message, list(places[hint, message]), round(points[hint, message], 2)) for hint, message in ordered
    ]


def _causes(items: Sequence[Diagnostic]) -> Sequence[Diagnostic]:
    """Return the diagnostics without those that only say that something is left out because of the others."""
    return [item for item in items if item.code not in (CODE, DRIVE_CODE)] or items


def _without_places(message: str) -> str:
    """Return a message without the list of the folders that were searched."""
    return _SEARCHED.sub("", message)


def _missing_text(item: Diagnostic) -> str:
    """Return the problem of a diagnostic in a form that is equal for the same problem of several files."""
    text = item.message.split("; ")[0].split(" (name ")[0].split(" and nothing is downloaded")[0]
    text = _FILE_IN_PACKAGE.sub(r"\1/…", _OWNER.sub("", text))
    return f"{item.code}: {shorten(text, _LONGEST)}"


def _counts(found: Iterable[Diagnostic]) -> dict[str, int]:
    counts = Counter(item.severity for item in found)
    return {"errors": counts["error"], "warnings": counts["warning"], "notes": counts["note"]}


def _place(item: Diagnostic) -> str:
    return f"{item.file}:{item.line}" if item.file and item.line else item.file or ""


def _as_path(path: object) -> Path:
    return Path(str(path))


def _picture(simulation: Simulation, options: ScoreOptions) -> tuple[str, str]:
    """Return the picture of a world in base64, and a note about it."""
    with tempfile.TemporaryDirectory(prefix="simkit-score-") as folder:
        path = Path(folder) / "picture.jpg"
        look = Look(width=options.picture, height=options.picture * 5 // 8, passes=options.passes)
        try:
            save_picture(simulation, path, render_view, look=look)
            return base64.b64encode(path.read_bytes()).decode(), ""
        except SimkitError as error:
            return "", f"there is no picture: {error}"
