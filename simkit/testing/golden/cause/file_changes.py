"""Changes outside the scene: the scenario, files, plugin code, versions, and compiled engine fields."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from simkit.testing.golden.cause.change_text import list_names, single_value_text, values_text
from simkit.testing.golden.cause.edits import Change
from simkit.testing.golden.compare.world_edits import (
    ABSENT,
    Edit,
    field_edits,
    other_edits,
)
from simkit.testing.run_record.record import RunRecord

_HEAD = 16  # number of hash characters in a world value


def changes_outside_world(
    changes: list[Change], golden: RunRecord, run: RunRecord
) -> tuple[list[Change], list[Change]]:
    """Return the changes of the world with file names added, and the changes outside the world.

    Args:
        changes: Changes of the world.
        golden: Record of the golden run.
        run: Record of the new run.
    """
    edits = other_edits(golden, run)
    named: list[Change] = []
    named_files: set[str] = set()
    for change in changes:
        old, new = _file_with_hash(golden, change.golden), _file_with_hash(run, change.run)
        if old or new:
            named_files |= {old, new}
            shown = new if old in (new, "") else old if not new else f"{old} → {new}"
            named.append(replace(change, words=change.words.replace(" has different", f" {shown} has different", 1)))
        else:
            named.append(change)
    rest = [e for e in edits if not (e.kind in ("file", "code") and e.path in named_files)]
    return named, [
        Change(e.kind, _change_text(e), e.path, _short_value(e.golden), _short_value(e.run), e.where, (e,))
        for e in rest
    ]


def _file_with_hash(record: RunRecord, content: object) -> str:
    """Return the name of the file whose content hash is the given world value; empty if there is none."""
    if not isinstance(content, str) or not content.endswith(" bytes)"):
        return ""
    return next((name for name, digest in record.sources.items() if digest[:_HEAD] == content[:_HEAD]), "")


def _short_value(value: object) -> Any:
    return None if value is ABSENT else value


def _change_text(edit: Edit) -> str:
    if edit.kind in ("file", "code"):
        what = "the code of" if edit.kind == "code" else "the content of"
        if edit.golden is ABSENT:
            return f"{edit.path} is new"
        return f"{edit.path} is gone" if edit.run is ABSENT else f"{what} {edit.path} was changed"
    if edit.kind == "version":
        if edit.path == "simkit code":
            return f"simkit's own code was changed ({edit.golden} → {edit.run})"
        return f"{edit.path} {single_value_text(edit.golden) or 'none'} → {single_value_text(edit.run) or 'none'}"
    if isinstance(edit.golden, (tuple, list)) and isinstance(edit.run, (tuple, list)):
        return f"scenario: {edit.path} {_lists(list(edit.golden), list(edit.run))}"
    return f"scenario: {edit.path} {values_text(edit.golden, edit.run)}"


def _lists(golden: list[object], run: list[object]) -> str:
    """Describe the items that only one of two lists has."""
    a, b = [_text(v) for v in golden], [_text(v) for v in run]
    gone, new = [v for v in a if v not in b], [v for v in b if v not in a]
    if len(gone) == len(new) == 1:
        return f"{single_value_text(gone[0])} → {single_value_text(new[0])}"
    parts = [f"without {single_value_text(v)}" for v in gone[:2]] + [f"with {single_value_text(v)}" for v in new[:2]]
    more = len(gone[2:]) + len(new[2:])
    return (", ".join(parts) or "has another order") + (f" and {more} more" if more else "")


def _text(value: Any) -> str:
    if isinstance(value, dict) or hasattr(value, "keys"):
        return ", ".join(f"{k} {single_value_text(v)}" for k, v in dict(value).items() if k != "where")
    return str(value)


_DERIVED_FIELDS = frozenset(
    (
        *("rbound", "aabb", "subtreemass", "invweight0", "weight0", "length0", "lengthrange", "acc0"),
        *("ipos", "iquat", "inertia", "margin", "M0", "Madr", "pos0", "poscom0", "mat0", "dir0", "gravcomp"),
    )
)
"""Fields that the engine's compiler computes from other fields; a report lists them only if no other field differs."""


def engine_changes(golden: RunRecord, run: RunRecord, changes: Sequence[Change]) -> list[Change]:
    """Return fields of the compiled model that differ although the scene values are equal.

    Args:
        golden: Record of the golden run.
        run: Record of the new run.
        changes: Changes of the world.
    """
    if not golden.fields or not run.fields:
        return []
    if any(change.kind == "model" for change in changes):
        return []
    named_entities = {edit.entity for change in changes for edit in change.edits}
    edits = [e for e in field_edits(golden, run) if not _is_explained_by_scene(e.path, named_entities)]
    first = [e for e in edits if e.path.rpartition(" ")[2] not in _DERIVED_FIELDS] or edits
    groups: dict[tuple[str, str, str], list[Edit]] = {}
    for edit in first:
        groups.setdefault((edit.path.rpartition(" ")[2], repr(edit.golden), repr(edit.run)), []).append(edit)
    return [_engine_change(several) for several in groups.values()]


def _is_explained_by_scene(path: str, named_entities: set[str]) -> bool:
    name = path.split(" ", 1)[-1].rpartition(" ")[0]
    return any(
        part and (name == part or name.startswith(part + "::") or part.startswith(name)) for part in named_entities
    )


def _engine_change(several: list[Edit]) -> Change:
    first = several[0]
    part, _, field = first.path.rpartition(" ")
    a, b = _plain_number(first.golden), _plain_number(first.run)
    words = f"{field} {values_text(a, b, {'pos': 'position'}.get(field, field))} in the compiled model"
    if len(several) == 1:
        words = f"{part}: {words}"
    else:
        words += f", in {len(several)} places: {list_names([e.path.rpartition(' ')[0] for e in several])}"
    # no edits: the compiled model is built again for every run, so its fields cannot be restored
    return Change("model", words, first.path, a, b, "", ())


def _plain_number(value: object) -> object:
    if value is ABSENT:
        return value
    array = np.asarray(value)
    if array.ndim == 0 or array.size == 1:
        return array.reshape(-1)[0].item()
    return array.reshape(-1).tolist()
