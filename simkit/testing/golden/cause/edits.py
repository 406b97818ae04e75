"""Changes that a person made, such as one change for a moved robot, and the texts that describe them.

The changes are groups of values that differ. A text has the names of the file, the units, and only as many digits as
needed.
"""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypeGuard

from simkit.number_text import counted
from simkit.testing.golden.cause.first_tick import distinct_digits
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

_SHORTENED_PREFIXES = re.compile(r"^(params\.|geometry\.|inertial\.|surface\.|surroundings\.)")
_WORDS = tomllib.loads(Path(__file__).with_name("change_words.toml").read_text(encoding="utf-8"))
_UNITS: Mapping[str, str] = {name: unit for unit, names in _WORDS["units"].items() for name in names}
_CONTENT = re.compile(r"^[0-9a-f]{16} \((\d+) bytes\)$")
_LONGEST = 100  # maximum length of a value in characters


def attribute_name(attribute: str) -> str:
    """Return the name of an attribute in world files."""
    text = re.sub(r"^axes\[(\d+)\]\.", lambda m: "" if m[1] == "0" else f"axis {int(m[1]) + 1} ", attribute)
    text = _SHORTENED_PREFIXES.sub("", text).replace("@", " ").strip()
    name_in_file: str = _WORDS["names_in_files"].get(text, text)
    return name_in_file


def entity_title(owner: str) -> str:
    """Return the kind and the name of an entity: `link robot::wheel`."""
    return f"{entity_kind(owner)} {scoped_name(owner)}".strip()


def owner_title(edit: Edit) -> str:
    """Return the kind and the name of the entity whose value an edit changes."""
    return entity_title(edit.owner)


def list_names(names: Sequence[str], most: int = 4) -> str:
    """Join names with commas; of a long list, show the first names and the number of further names."""
    shown_ = list(names[: most if len(names) > most + 1 else len(names)])
    more = len(names) - len(shown_)
    return ", ".join(shown_) + (f" and {more} more" if more else "")


def edit_text(edit: Edit, leaves: Mapping[str, object]) -> str:
    """Describe an edit: `collision robot::wheel::tyre: radius 0.033 → 0.0333 m (+1 %)`.

    Args:
        edit: Edit.
        leaves: All values of the new run's world; the unit of some values depends on other values.
    """
    attribute = edit.attribute
    name = attribute_name(attribute)
    last = re.split(r"[. ]", attribute.rpartition("@")[2])[-1]
    unit = world_unit(edit, last, leaves)
    return f"{owner_title(edit)}: {name} {values_text(edit.golden, edit.run, last, unit)}"


def world_unit(edit: Edit, last: str, leaves: Mapping[str, object]) -> str:
    """Return the unit of a number in a world; empty if it has none or the unit is unknown."""
    attribute = edit.attribute
    if last in ("lower", "upper", "spring_ref", "velocity") and attribute.startswith("axes["):
        is_linear = leaves.get(f"{edit.owner}.type") == "prismatic"
        base = "m" if is_linear else "rad"
        return base + "/s" if last == "velocity" else base
    if last in ("min", "max"):
        return "rad" if ".scan" not in attribute and "angle" in attribute else "m" if ".range" in attribute else ""
    if ".image." in attribute:
        return ""  # pixels
    return _UNITS.get(last, "")


def values_text(golden: object, run: object, last: str = "", unit: str = "") -> str:
    """Describe two values: `0.033 → 0.0333 m (+1 %)`, `y 1 → 1.01 m`, `is new: 5`."""
    behind = f" {unit}" if unit else ""
    if golden is ABSENT:
        return f"is new: {single_value_text(run)}{behind}"
    if run is ABSENT:
        return f"is gone (it was {single_value_text(golden)}{behind})"
    if isinstance(golden, list) and isinstance(run, list) and len(golden) == len(run) and _flat(golden) and _flat(run):
        return _components(golden, run, last, behind)
    if _is_number(golden) and _is_number(run):
        return f"{distinct_digits(golden, run)}{behind}{_percent_change(golden, run)}"
    a, b = _CONTENT.match(str(golden)), _CONTENT.match(str(run))
    if a and b:
        size = f" ({a[1]} → {b[1]} bytes)" if a[1] != b[1] else f" (still {b[1]} bytes)"
        return "has different content" + size
    return f"{single_value_text(golden)} → {single_value_text(run)}{behind}"


def _components(golden: list[object], run: list[object], last: str, unit: str) -> str:
    names = _WORDS["components"].get(last) or ("xyz" if len(golden) == 3 else [f"[{i}]" for i in range(len(golden))])
    differing = [i for i, (a, b) in enumerate(zip(golden, run, strict=True)) if a != b]
    if len(differing) > 6:
        first = differing[0]
        return (
            f"{len(differing)} of {counted(len(golden), 'number')}, the first {_pair(golden[first], run[first], unit)}"
        )
    return ", ".join(f"{names[i] if i < len(names) else f'[{i}]'} {_pair(golden[i], run[i], unit)}" for i in differing)


def _pair(a: object, b: object, unit: str) -> str:
    return (
        distinct_digits(a, b) + unit + _percent_change(a, b)
        if _is_number(a) and _is_number(b)
        else f"{single_value_text(a)} → {single_value_text(b)}"
    )


def _percent_change(golden: float, run: float) -> str:
    """Return the change in per cent; empty for integers, other signs and changes of 100 % or more."""
    if isinstance(golden, int) and isinstance(run, int):
        return ""  # a count or a seed
    if not golden or not math.isfinite(golden) or not math.isfinite(run) or golden * run < 0:
        return ""
    percent = (run / golden - 1) * 100
    return f" ({percent:+.3g} %)" if abs(percent) < 100 else ""


def _flat(value: list[object]) -> bool:
    return not any(isinstance(v, list) for v in value)


def _is_number(value: object) -> TypeGuard[float]:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def single_value_text(value: object) -> str:
    """Format one value; shorten a long one."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, (list, tuple)):
        text = " ".join(single_value_text(v) for v in value) if _flat(list(value)) else str(value)
    elif isinstance(value, str):
        text = value if value else '""'
    else:
        text = str(value)
    text = " ".join(text.split())
    return text if len(text) <= _LONGEST else text[: _LONGEST - 3] + "..."


WorldValues = Mapping[str, object]
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
    changes = [*added_and_removed, *renamed, *moved, *_group_equal_changes(rest, golden, run)]
    order = {edit.path: n for n, edit in enumerate(edits)}
    return sorted(changes, key=lambda c: min((order.get(e.path, len(order)) for e in c.edits), default=0))


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
    renames = []
    for old in gone:
        candidates = [n for n in new if parent_path(n) == parent_path(old) and entity_kind(n) == entity_kind(old)]
        mine = _within(golden, old)
        scores = [(_likeness(mine, _within(run, n), scoped_name(old), scoped_name(n)), n) for n in candidates]
        score, best = max(scores, default=(0.0, ""))
        if score < _LEAST_LIKENESS:
            continue
        new.remove(best)
        change, edits = _rename_change(old, best, edits, golden, run)
        renames.append(change)
    return renames, edits


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
    changes = []
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
            changes.append(Change("model", words, parts[0], a, b, where, tuple(mine)))
    return changes, edits


def _contains_name(edit: Edit, names: list[str]) -> bool:
    """Check whether a value contains the name of one of the added or removed entities."""
    texts = [v for v in (edit.golden, edit.run) if isinstance(v, str)]
    return any(text == name or text.startswith(name + "::") for text in texts for name in names)


# ------------------------------------------------------------------ motions


def _motions(edits: list[Edit], golden: WorldValues, run: WorldValues) -> tuple[list[Change], list[Edit]]:
    motions, rest = find_motions(edits, golden, run)
    groups: dict[tuple[str, str], list[Motion]] = {}
    for motion in motions:
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
    grouped = []
    for key, alike in by_factor.items():
        if key is None or len(alike) < 3:
            grouped += alike
            continue
        every = tuple(e for c in alike for e in c.edits)
        shown = list_names([c.words for c in alike], 3)
        words = f"{key[0]} × {key[1]:g} in {counted(len(every), 'place')}: {shown}"
        grouped.append(replace(alike[0], words=words, edits=every))
    return grouped


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
    prefixes: set[str] = set()
    for path in leaves:
        owner = split_entity_path(path)[0]
        while len(path) > len(owner) and path not in prefixes:
            prefixes.add(path)
            path = _parent_element(path)
    return prefixes


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
        words = f"{words} in {counted(len(owners), 'place')}: {list_names([entity_title(o) for o in owners])}"
    else:
        same = list_names([attribute_name(u[0].attribute) for u in units[1:]])
        words = head + words + (f"; the same for {same}" if same else "")
    every = tuple(e for u in units for e in u)
    return Change(first.kind, words, first.path, first.golden, first.run, first.where, every)
