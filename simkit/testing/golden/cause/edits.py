"""Grouping of values that differ into changes that a person made, such as one change for a moved robot."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from simkit.testing.golden.cause.change_text import (
    attribute_name,
    edit_text,
    entity_title,
    list_names,
    owner_title,
    single_value_text,
)
from simkit.testing.golden.cause.moved_bodies import Motion, find_motions, local_path
from simkit.testing.golden.compare.difference import CauseKind
from simkit.testing.golden.compare.world_edits import (
    ABSENT,
    Edit,
    entity_kind,
    is_same_value,
    is_within,
    parent_path,
    scoped_name,
    split_entity_path,
)

WorldValues = Mapping[str, Any]
_UNGROUPED_ELEMENTS = frozenset(("", "params"))
"""Elements that are not one unit: each of their values is a change of its own."""
_LEAST_LIKENESS = 0.5  # two entities with at least this share of equal values count as one renamed entity


@dataclass(frozen=True)
class Change:
    """Change by a person, with all values that differ because of this change.

    Attributes:
        kind: Kind of change.
        words: Sentence about the change.
        path, golden, run: Path of the most informative value, and the value in both runs.
        where: `file:line`; empty if unknown.
        edits: Values to restore when the change is undone.
    """

    kind: CauseKind
    words: str
    path: str
    golden: object
    run: object
    where: str
    edits: tuple[Edit, ...] = field(repr=False)


def find_changes(edits: list[Edit], golden: WorldValues, run: WorldValues) -> list[Change]:
    """Group the differences of two worlds into changes.

    Args:
        edits: Values that differ.
        golden: All values of the golden world.
        run: All values of the new world.
    """
    if not edits:
        return []
    renamed, rest = _find_renames(edits, golden, run)
    added_and_removed, rest = _entity_changes(rest, golden, run)
    moved, rest = _motions(rest, golden, run)
    found = [*added_and_removed, *renamed, *moved, *_group_equal_changes(rest, golden, run)]
    order = {edit.path: n for n, edit in enumerate(edits)}
    return sorted(found, key=lambda c: min((order.get(e.path, len(order)) for e in c.edits), default=0))


# ------------------------------------------------------------------ added, removed and renamed entities


def _whole_entities(leaves: WorldValues, others: WorldValues) -> list[str]:
    """Return the outermost entities that exist only in the first of two worlds."""
    mine = dict.fromkeys(p for path in leaves for p in _entity_chain(split_entity_path(path)[0]))
    alone = mine.keys() - {p for path in others for p in _entity_chain(split_entity_path(path)[0])}
    return [p for p in mine if p in alone and parent_path(p) not in alone]


def _entity_chain(owner: str) -> Iterable[str]:
    while owner:
        yield owner
        owner = parent_path(owner)


def _within(leaves: WorldValues, owner: str) -> dict[str, object]:
    return {path[len(owner) :]: value for path, value in leaves.items() if path.startswith((owner + ".", owner + "@"))}


def _find_renames(edits: list[Edit], golden: WorldValues, run: WorldValues) -> tuple[list[Change], list[Edit]]:
    gone, new = _whole_entities(golden, run), _whole_entities(run, golden)
    found = []
    for old in gone:
        candidates = [n for n in new if parent_path(n) == parent_path(old) and entity_kind(n) == entity_kind(old)]
        mine = _within(golden, old)
        scores = [(_likeness(mine, _within(run, n), scoped_name(old), scoped_name(n)), n) for n in candidates]
        score, best = max(scores, default=(0.0, ""))
        if score < _LEAST_LIKENESS:
            continue
        new.remove(best)
        change, edits = _rename_change(old, best, edits, golden, run)
        found.append(change)
    return found, edits


def _likeness(a: Mapping[str, object], b: Mapping[str, object], old: str, new: str) -> float:
    every = {*a, *b}
    alike = sum(1 for p in every if is_same_value(_rename_in_text(a.get(p, ABSENT), old, new), b.get(p, ABSENT)))
    return alike / max(1, len(every))


def _rename_in_text(value: object, old: str, new: str) -> object:
    """Replace an entity's old name in a value by its new name."""
    if isinstance(value, list):
        return [_rename_in_text(v, old, new) for v in value]
    if not isinstance(value, str):
        return value
    if value == old or value.startswith(old + "::"):
        return new + value[len(old) :]
    short_old, short_new = old.rpartition("::")[2], new.rpartition("::")[2]
    return short_new if value == short_old else value


def _rename_change(
    old: str, new: str, edits: list[Edit], golden: WorldValues, run: WorldValues
) -> tuple[Change, list[Edit]]:
    """Return the change for a renamed entity and the remaining edits."""
    a, b = scoped_name(old), scoped_name(new)
    mine: list[Edit] = []
    rest: list[Edit] = []
    for edit in edits:
        is_named = ABSENT not in (edit.golden, edit.run) and is_same_value(_rename_in_text(edit.golden, a, b), edit.run)
        (mine if is_within(edit.owner, old) or is_within(edit.owner, new) or is_named else rest).append(edit)
    where = next((e.where for e in mine if e.where and is_within(e.owner, new)), "")
    theirs = _within(run, new)
    others = []
    for tail, value in _within(golden, old).items():
        was, now = _rename_in_text(value, a, b), theirs.get(tail, ABSENT)
        if not is_same_value(was, now) and not is_same_value(value, now):
            others.append(Edit("model", new + tail, was, now, where))
    others += [Edit("model", new + t, ABSENT, v, where) for t, v in theirs.items() if old + t not in golden]
    words = "; ".join([f"{entity_title(old)} was renamed to {b}", *(edit_text(e, run) for e in others[:3])])
    return Change("model", words, new, a, b, where, tuple(mine)), rest


def _entity_changes(edits: list[Edit], golden: WorldValues, run: WorldValues) -> tuple[list[Change], list[Edit]]:
    found = []
    for leaves, others, verb in ((golden, run, "gone"), (run, golden, "new")):
        by_kind: dict[tuple[str, str], list[str]] = {}
        touched = {e.owner for e in edits}
        for part in _whole_entities(leaves, others):
            if any(is_within(t, part) for t in touched):
                by_kind.setdefault((parent_path(part), entity_kind(part)), []).append(part)
        for (_, kind), parts in by_kind.items():
            names = [scoped_name(p) for p in parts]
            mine = [e for e in edits if any(is_within(e.owner, p) for p in parts)]
            where = next((e.where for e in mine if e.where), "")
            # such as the name of a canonical link
            mine += [e for e in edits if e not in mine and _contains_name(e, names)]
            edits = [e for e in edits if e not in mine]
            words = f"{len(parts)} {kind}s are {verb}: {list_names(names)}"
            if len(parts) == 1:
                words = f"{entity_title(parts[0])} is {verb}"
            a, b = (None, names[0]) if verb == "new" else (names[0], None)
            found.append(Change("model", words, parts[0], a, b, where, tuple(mine)))
    return found, edits


def _contains_name(edit: Edit, names: list[str]) -> bool:
    """Check whether a value contains the name of one of the added or removed entities."""
    texts = [v for v in (edit.golden, edit.run) if isinstance(v, str)]
    return any(text == name or text.startswith(name + "::") for text in texts for name in names)


# ------------------------------------------------------------------ motions


def _motions(edits: list[Edit], golden: WorldValues, run: WorldValues) -> tuple[list[Change], list[Edit]]:
    found, rest = find_motions(edits, golden, run)
    groups: dict[tuple[str, str], list[Motion]] = {}
    for motion in found:
        groups.setdefault((entity_kind(motion.owner), motion.words), []).append(motion)
    changes = []
    for (kind, words), several in groups.items():
        first, main = several[0], several[0].edits[0]
        sentence = f"{entity_title(first.owner)} {words}{first.numbers}{first.along}"
        if len(several) > 1:
            sentence = f"{len(several)} {kind}s {words}: {list_names([scoped_name(m.owner) for m in several])}"
        every = tuple(e for m in several for e in m.edits)
        changes.append(Change("model", sentence, main.path, main.golden, main.run, first.where, every))
    return changes, rest


# ------------------------------------------------------------------ equal changes in several places


def _group_equal_changes(edits: list[Edit], golden: WorldValues, run: WorldValues) -> list[Change]:
    changes, edits = _element_changes(edits, golden, run)
    paths = {e.path: e for e in edits}
    heads = {e.path: local_path(e.path) for e in edits if local_path(e.path) in paths}
    followers: dict[str, list[Edit]] = {}
    for path, head in heads.items():
        followers.setdefault(head, []).append(paths[path])
    first = [e for e in edits if e.path not in heads]
    for units in _group_alike(_group_by_element(first)):
        change = _change(units, run)
        follow = tuple(f for e in change.edits for f in followers.get(e.path, ()))
        changes.append(replace(change, edits=(*change.edits, *follow)))
    by_factor: dict[tuple[str, float] | None, list[Change]] = {}
    for change in changes:
        by_factor.setdefault(_factor(change), []).append(change)
    found = []
    for key, alike in by_factor.items():
        if key is None or len(alike) < 3:
            found += alike
            continue
        every = tuple(e for c in alike for e in c.edits)
        shown = list_names([c.words for c in alike], 3)
        words = f"{key[0]} × {key[1]:g} in {len(every)} places: {shown}"
        found.append(replace(alike[0], words=words, edits=every))
    return found


def _element_changes(edits: list[Edit], golden: WorldValues, run: WorldValues) -> tuple[list[Change], list[Edit]]:
    """Return the changes for elements that were added, removed or replaced, and the remaining edits."""
    groups: dict[str, list[Edit]] = {}
    rest = []
    kinds = {e.path for e in edits if ABSENT not in (e.golden, e.run)}
    mine, theirs = _prefixes(golden), _prefixes(run)
    hollow = [e for e in edits if _is_empty_element(e)]
    for edit in sorted(edits, key=_is_empty_element):
        block = _changed_element(edit, kinds, theirs if edit.run is ABSENT else mine)
        if edit in hollow:
            block = next((b for b in groups if b.startswith(edit.path + ".")), block)
        if block:
            groups.setdefault(block, []).append(edit)
        else:
            rest.append(edit)
    changes = []
    for block, several in groups.items():
        head = next((e for e in edits if e.path == block), None)
        if len(several) == 1 and head in (None, several[0]):
            rest += several
            continue
        if head is not None and head in rest:
            rest.remove(head)
        changes.append(_element_change(block, head, several, run))
    return changes, rest


def _is_empty_element(edit: Edit) -> bool:
    """Check whether an edit only adds or removes an empty element."""
    return (edit.golden, edit.run) in ((ABSENT, ""), ("", ABSENT))


def _prefixes(leaves: WorldValues) -> set[str]:
    """Return the paths of all values and of the elements that contain them."""
    found: set[str] = set()
    for path in leaves:
        owner = split_entity_path(path)[0]
        while len(path) > len(owner) and path not in found:
            found.add(path)
            path = _parent_element(path)
    return found


def _parent_element(path: str) -> str:
    """Return the path of the element that contains a value: the path without its last step."""
    return path[: max(path.rfind("."), path.rfind("@"), path.rfind("["), 0)]


def _changed_element(edit: Edit, kinds: set[str], others: set[str]) -> str:
    """Return the outermost element that only one world has, or whose kind differs; empty if there is none."""
    if ABSENT not in (edit.golden, edit.run) and edit.path not in kinds:
        return ""
    owner = edit.owner
    path, block = edit.path, ""
    while len(path) > len(owner) + 1:
        if path in kinds and path != edit.path:
            return path
        if path not in others:
            block = path
        path = _parent_element(path)
    return block if ABSENT in (edit.golden, edit.run) else ""


def _element_change(block: str, head: Edit | None, several: list[Edit], run: WorldValues) -> Change:
    """Return one change for all values of an element that was added, removed or replaced."""
    owner, attribute = split_entity_path(block)
    inner = [(e.path[len(block) :].lstrip(".@"), e) for e in several if e.path.startswith((block + ".", block + "@"))]
    every = tuple({e.path: e for e in ([head] if head else []) + several}.values())
    where = next((e.where for e in every if e.where), "")
    gone = list_names([f"{n} {single_value_text(e.golden)}" for n, e in inner if e.run is ABSENT], 6)
    new = list_names([f"{n} {single_value_text(e.run)}" for n, e in inner if e.golden is ABSENT], 6)
    if head is not None and ABSENT not in (head.golden, head.run):
        words = edit_text(head, run) + (f", with {new}" if new else "") + (f" instead of {gone}" if gone else "")
        return Change("model", words, head.path, head.golden, head.run, where, every)
    is_gone = several[0].run is ABSENT
    state = f"is gone (it had {gone})" if is_gone else f"is new, with {new}"
    words = f"{entity_title(owner)}: {attribute_name(attribute)} {state}"
    a, b = (single_value_text(gone), None) if is_gone else (None, single_value_text(new))
    return Change("model", words, block, a, b, where, every)


def _group_by_element(edits: list[Edit]) -> list[list[Edit]]:
    """Group the edits by element, such as an inertial, a material or a noise model."""
    groups: dict[object, list[Edit]] = {}
    for number, edit in enumerate(edits):
        owner, attribute = split_entity_path(edit.path)
        inner = _parent_element(attribute)
        groups.setdefault((owner, inner) if inner not in _UNGROUPED_ELEMENTS else number, []).append(edit)
    return list(groups.values())


def _group_alike(units: list[list[Edit]]) -> list[list[list[Edit]]]:
    """Group elements in which the same values changed in the same way."""
    groups: dict[object, list[list[Edit]]] = {}
    for unit in units:
        groups.setdefault(tuple((_last(e.path), repr(e.golden), repr(e.run)) for e in unit), []).append(unit)
    return list(groups.values())


def _last(path: str) -> str:
    return attribute_name(split_entity_path(path)[1]).rpartition(".")[2]


def _factor(change: Change) -> tuple[str, float] | None:
    """Return the name and the factor of a change that multiplies a number; None for other changes."""
    a, b = change.golden, change.run
    if isinstance(a, (int, float)) and isinstance(b, (int, float)) and not isinstance(a, bool) and a and b:
        factor = round(b / a, 9)
        return (_last(change.path), factor) if factor not in (1.0, -1.0) else None
    return None


def _change(units: list[list[Edit]], run: WorldValues) -> Change:
    unit = units[0]
    first = unit[0]
    head = owner_title(first) + ": "
    # the first text has the whole path; further texts of the same element have only the last name
    inner = [edit_text(e, run).removeprefix(head) for e in unit]
    block = attribute_name(first.attribute).rpartition(".")[0]
    inner[1:] = [text.removeprefix(block + ".") if block else text for text in inner[1:]]
    words = ", ".join(inner)
    owners = list(dict.fromkeys(u[0].owner for u in units))
    if len(owners) > 1:
        words = f"{words} in {len(owners)} places: {list_names([entity_title(o) for o in owners])}"
    else:
        same = list_names([attribute_name(u[0].attribute) for u in units[1:]])
        words = head + words + (f"; the same for {same}" if same else "")
    every = tuple(e for u in units for e in u)
    return Change(first.kind, words, first.path, first.golden, first.run, first.where, every)
