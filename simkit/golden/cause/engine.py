"""What the engine was given otherwise than before where the scene says nothing of it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from simkit.golden.cause.changes import Change
from simkit.golden.cause.edits import Edit, field_edits
from simkit.golden.cause.paths import parted, scoped
from simkit.golden.cause.putback import ABSENT
from simkit.golden.cause.words import listed, values
from simkit.golden.record import Record

_WORKED_OUT = frozenset(
    (
        *("rbound", "aabb", "subtreemass", "invweight0", "weight0", "length0", "lengthrange", "acc0"),
        *("ipos", "iquat", "inertia", "margin", "M0", "Madr", "pos0", "poscom0", "mat0", "dir0", "gravcomp"),
    )
)
"""Fields that the engine's compiler can work out of others: they are said where there is nothing else."""


def engine_changes(golden: Record, run: Record, changes: Sequence[Change]) -> list[Change]:
    """Fields of the compiled model that are other, though nothing of their part of the scene is.

    Args:
        golden, run: both records.
        changes: the world's.
    """
    if not golden.fields or not run.fields:
        return []
    if any(change.kind == "model" for change in changes):
        return []
    spoken = {scoped(parted(edit.path)[0]) for change in changes for edit in change.edits}
    edits = [e for e in field_edits(golden, run) if not _is_spoken_of(e.path, spoken)]
    first = [e for e in edits if e.path.rpartition(" ")[2] not in _WORKED_OUT] or edits
    groups: dict[tuple[str, str, str], list[Edit]] = {}
    for edit in first:
        groups.setdefault((edit.path.rpartition(" ")[2], repr(edit.golden), repr(edit.run)), []).append(edit)
    return [_change(several) for several in groups.values()]


def _is_spoken_of(path: str, spoken: set[str]) -> bool:
    name = path.split(" ", 1)[-1].rpartition(" ")[0]
    return any(part and (name == part or name.startswith(part + "::") or part.startswith(name)) for part in spoken)


def _change(several: list[Edit]) -> Change:
    first = several[0]
    part, _, field = first.path.rpartition(" ")
    a, b = _plain(first.golden), _plain(first.run)
    said = values(a, b, {"pos": "position"}.get(field, field))
    if len(several) == 1:
        words = f"{part}: {field} {said}, as the engine has it"
    else:
        words = f"{field} {said}, as the engine has it, in {len(several)} places: " + listed(
            [e.path.rpartition(" ")[0] for e in several]
        )
    # nothing is put back with it: a compiled model is made anew for every run
    return Change("model", words, first.path, a, b, "", ())


def _plain(value: object) -> object:
    if value is ABSENT:
        return value
    array = np.asarray(value)
    if array.ndim == 0 or array.size == 1:
        return array.reshape(-1)[0].item()
    return array.reshape(-1).tolist()
