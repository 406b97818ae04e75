"""What is other beside the world: the scenario, files, code and versions; files by what they are for."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from simkit.golden.cause.changes import Change
from simkit.golden.cause.edits import Edit, other_edits
from simkit.golden.cause.putback import ABSENT
from simkit.golden.cause.words import one, values
from simkit.golden.record import Record

_HEAD = 16  # letters of a hash that a leaf has


def beside_the_world(changes: list[Change], golden: Record, run: Record) -> tuple[list[Change], list[Change]]:
    """The world's changes, with the names of their files, and what is other beside them.

    Args:
        changes: the world's.
        golden, run: both records.
    """
    edits = other_edits(golden, run)
    named: list[Change] = []
    spoken: set[str] = set()
    for change in changes:
        old, new = _name(golden, change.golden), _name(run, change.run)
        if old or new:
            spoken |= {old, new}
            shown = new if old in (new, "") else old if not new else f"{old} → {new}"
            named.append(replace(change, words=change.words.replace(" has other", f" {shown} has other", 1)))
        else:
            named.append(change)
    rest = [e for e in edits if not (e.kind in ("file", "code") and e.path in spoken)]
    return named, [_change(edit) for edit in rest]


def _name(record: Record, content: Any) -> str:
    """The file whose content a leaf is."""
    if not isinstance(content, str) or not content.endswith(" bytes)"):
        return ""
    return next((name for name, digest in record.sources.items() if digest[:_HEAD] == content[:_HEAD]), "")


def _change(edit: Edit) -> Change:
    return Change(edit.kind, _words(edit), edit.path, _shown(edit.golden), _shown(edit.run), edit.where, (edit,))


def _shown(value: Any) -> Any:
    return None if value is ABSENT else value


def _words(edit: Edit) -> str:
    if edit.kind in ("file", "code"):
        what = "the code of" if edit.kind == "code" else "the content of"
        if edit.golden is ABSENT:
            return f"{edit.path} is new"
        return f"{edit.path} is gone" if edit.run is ABSENT else f"{what} {edit.path} was changed"
    if edit.kind == "version":
        if edit.path == "simkit code":
            return f"simkit's own code was changed ({edit.golden} → {edit.run})"
        return f"{edit.path} {one(edit.golden) or 'none'} → {one(edit.run) or 'none'}"
    return f"scenario: {_scenario(edit)}"


def _scenario(edit: Edit) -> str:
    if isinstance(edit.golden, (tuple, list)) and isinstance(edit.run, (tuple, list)):
        return f"{edit.path} {_lists(list(edit.golden), list(edit.run))}"
    return f"{edit.path} {values(edit.golden, edit.run)}"


def _lists(golden: list[Any], run: list[Any]) -> str:
    """What two lists do not have in common."""
    a, b = [_text(v) for v in golden], [_text(v) for v in run]
    gone, new = [v for v in a if v not in b], [v for v in b if v not in a]
    if len(gone) == len(new) == 1:
        return f"{one(gone[0])} → {one(new[0])}"
    parts = [f"without {one(v)}" for v in gone[:2]] + [f"with {one(v)}" for v in new[:2]]
    more = len(gone[2:]) + len(new[2:])
    return (", ".join(parts) or "in another order") + (f" and {more} more" if more else "")


def _text(value: Any) -> str:
    if isinstance(value, dict) or hasattr(value, "keys"):
        return ", ".join(f"{k} {one(v)}" for k, v in dict(value).items() if k != "where")
    return str(value)
