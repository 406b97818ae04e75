"""From leaves that differ to changes as a person made them: one for a moved robot, not one for each of its parts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from simkit.golden.cause.edits import Edit, same
from simkit.golden.cause.motion import Motion, local_of, motions
from simkit.golden.cause.paths import above, is_within, kind_of, parted, scoped
from simkit.golden.cause.putback import ABSENT
from simkit.golden.cause.words import call, listed, named, one, said, title
from simkit.golden.difference import CauseKind

Leaves = Mapping[str, Any]
_LOOSE = frozenset(("", "params"))
"""Elements whose values have little to do with each other."""
_ENOUGH = 0.5  # of the leaves of a part that are alike: it is the same part under another name


@dataclass(frozen=True)
class Change:
    """One change, with all the leaves that it shows in.

    Attributes:
        kind: of what.
        words: in a sentence.
        path, golden, run: of the leaf that says most.
        where: `file:line`, where there is one.
        edits: what is put back with it.
    """

    kind: CauseKind
    words: str
    path: str
    golden: Any
    run: Any
    where: str
    edits: tuple[Edit, ...] = field(repr=False)


def changes_of(edits: list[Edit], golden: Leaves, run: Leaves) -> list[Change]:
    """The changes of a world.

    Args:
        edits: its leaves that differ.
        golden, run: all of its leaves.
    """
    found: list[Change] = []
    rest = list(edits)
    if not rest:
        return found
    renamed, rest = _renamings(rest, golden, run)
    come_and_gone, rest = _parts(rest, golden, run)
    moved, rest = _motions(rest, golden, run)
    found += [*come_and_gone, *renamed, *moved, *_equal_ones(rest, golden, run)]
    order = {edit.path: n for n, edit in enumerate(edits)}
    return sorted(found, key=lambda c: min((order.get(e.path, len(order)) for e in c.edits), default=0))


# ------------------------------------------------------------------ parts that came, went, or have another name


def _whole_parts(leaves: Leaves, others: Leaves) -> list[str]:
    """The outermost parts of the world that the other one does not have."""
    theirs = {p for path in others for p in _chain(parted(path)[0])}
    mine = {p for path in leaves for p in _chain(parted(path)[0])}
    alone = mine - theirs
    return [
        p
        for p in dict.fromkeys(q for path in leaves for q in _chain(parted(path)[0]))
        if p in alone and above(p) not in alone
    ]


def _chain(owner: str) -> Iterable[str]:
    while owner:
        yield owner
        owner = above(owner)


def _within(leaves: Leaves, owner: str) -> dict[str, Any]:
    return {path[len(owner) :]: value for path, value in leaves.items() if path.startswith((owner + ".", owner + "@"))}


def _renamings(edits: list[Edit], golden: Leaves, run: Leaves) -> tuple[list[Change], list[Edit]]:
    gone, new = _whole_parts(golden, run), _whole_parts(run, golden)
    found = []
    for old in gone:
        candidates = [n for n in new if above(n) == above(old) and kind_of(n) == kind_of(old)]
        mine = _within(golden, old)
        scores = [(_likeness(mine, _within(run, n), scoped(old), scoped(n)), n) for n in candidates]
        score, best = max(scores, default=(0.0, ""))
        if score < _ENOUGH:
            continue
        new.remove(best)
        change, edits = _renaming(old, best, edits, golden, run)
        found.append(change)
    return found, edits


def _likeness(a: Mapping[str, Any], b: Mapping[str, Any], old: str, new: str) -> float:
    every = {*a, *b}
    alike = sum(1 for p in every if same(_renamed(a.get(p, ABSENT), old, new), b.get(p, ABSENT)))
    return alike / max(1, len(every))


def _renamed(value: Any, old: str, new: str) -> Any:
    """A text in which a part has its other name."""
    if isinstance(value, list):
        return [_renamed(v, old, new) for v in value]
    if not isinstance(value, str):
        return value
    if value == old or value.startswith(old + "::"):
        return new + value[len(old) :]
    short_old, short_new = old.rpartition("::")[2], new.rpartition("::")[2]
    return short_new if value == short_old else value


def _renaming(old: str, new: str, edits: list[Edit], golden: Leaves, run: Leaves) -> tuple[Change, list[Edit]]:
    """The change that a renaming is, and the edits that are left: those of the part itself under its new name."""
    a, b = scoped(old), scoped(new)
    mine: list[Edit] = []
    rest: list[Edit] = []
    for edit in edits:
        owner = parted(edit.path)[0]
        is_other_name = ABSENT not in (edit.golden, edit.run) and same(_renamed(edit.golden, a, b), edit.run)
        (mine if is_within(owner, old) or is_within(owner, new) or is_other_name else rest).append(edit)
    where = next((e.where for e in mine if e.where and is_within(parted(e.path)[0], new)), "")
    words = f"{call(old)} is called {scoped(new)} now"
    theirs = _within(run, new)
    others = []
    for tail, value in _within(golden, old).items():
        was, now = _renamed(value, a, b), theirs.get(tail, ABSENT)
        if not same(was, now) and not same(value, now):
            others.append(Edit("model", new + tail, was, now, where))
    others += [Edit("model", new + t, ABSENT, v, where) for t, v in theirs.items() if old + t not in golden]
    if others:
        words += "; " + "; ".join(said(e, run) for e in others[:3])
    return Change("model", words, new, scoped(old), scoped(new), where, tuple(mine)), rest


def _parts(edits: list[Edit], golden: Leaves, run: Leaves) -> tuple[list[Change], list[Edit]]:
    found = []
    for leaves, others, verb, is_new in ((golden, run, "gone", False), (run, golden, "new", True)):
        by_kind: dict[tuple[str, str], list[str]] = {}
        touched = {parted(e.path)[0] for e in edits}
        alone = [p for p in _whole_parts(leaves, others) if any(is_within(t, p) for t in touched)]
        for part in alone:
            by_kind.setdefault((above(part), kind_of(part)), []).append(part)
        for (_, kind), parts in by_kind.items():
            mine = [e for e in edits if any(is_within(parted(e.path)[0], p) for p in parts)]
            edits = [e for e in edits if e not in mine]
            where = next((e.where for e in mine if e.where), "")
            if len(parts) == 1:
                words = f"{call(parts[0])} is {verb}"
            else:
                words = f"{len(parts)} {kind}s are {verb}: {listed([scoped(p) for p in parts])}"
            named_there = [e for e in edits if _names_one(e, [scoped(p) for p in parts])]  # a canonical link, say
            mine += named_there
            edits = [e for e in edits if e not in named_there]
            name = scoped(parts[0])
            a, b = (None, name) if is_new else (name, None)
            found.append(Change("model", words, parts[0], a, b, where, tuple(mine)))
    return found, edits


def _names_one(edit: Edit, names: list[str]) -> bool:
    """Whether a leaf is the name of a part that came or went."""
    texts = [v for v in (edit.golden, edit.run) if isinstance(v, str)]
    return any(text == name or text.startswith(name + "::") for text in texts for name in names)


# ------------------------------------------------------------------ what moved


def _motions(edits: list[Edit], golden: Leaves, run: Leaves) -> tuple[list[Change], list[Edit]]:
    found, rest = motions(edits, golden, run)
    groups: dict[Any, list[Motion]] = {}
    for motion in found:
        groups.setdefault((kind_of(motion.owner), motion.words), []).append(motion)
    changes = []
    for (kind, words), several in groups.items():
        every = tuple(e for m in several for e in m.edits)
        main = several[0].edits[0]
        where = several[0].where
        if len(several) == 1:
            sentence = f"{call(several[0].owner)} {words}{several[0].numbers}{several[0].along}"
        else:
            names = listed([scoped(m.owner) for m in several])
            sentence = f"{len(several)} {kind}s {words}: {names}"
        changes.append(Change("model", sentence, main.path, main.golden, main.run, where, every))
    return changes, rest


# ------------------------------------------------------------------ the same in several places


def _equal_ones(edits: list[Edit], golden: Leaves, run: Leaves) -> list[Change]:
    changes, edits = _blocks(edits, golden, run)
    paths = {e.path: e for e in edits}
    heads = {e.path: local_of(e.path) for e in edits if local_of(e.path) in paths}
    followers: dict[str, list[Edit]] = {}
    for path, head in heads.items():
        followers.setdefault(head, []).append(paths[path])
    first = [e for e in edits if e.path not in heads]
    for units in _alike(_units(first)):
        change = _change(units, run)
        follow = tuple(f for e in change.edits for f in followers.get(e.path, ()))
        changes.append(replace(change, edits=(*change.edits, *follow)))
    by_factor: dict[Any, list[Change]] = {}
    for change in changes:
        by_factor.setdefault(_factor(change), []).append(change)
    found = []
    for key, alike in by_factor.items():
        if key is None or len(alike) < 3:
            found += alike
            continue
        every = tuple(e for c in alike for e in c.edits)
        shown = listed([c.words for c in alike], 3)
        words = f"{key[0]} × {key[1]:g} in {len(every)} places: {shown}"
        found.append(replace(alike[0], words=words, edits=every))
    return found


def _blocks(edits: list[Edit], golden: Leaves, run: Leaves) -> tuple[list[Change], list[Edit]]:
    """Elements that came, went, or became another kind, with all that is in them; and what is left."""
    groups: dict[str, list[Edit]] = {}
    rest = []
    kinds = {e.path for e in edits if ABSENT not in (e.golden, e.run)}
    mine, theirs = _prefixes(golden), _prefixes(run)
    hollow = [e for e in edits if _is_hollow(e)]
    for edit in sorted(edits, key=_is_hollow):
        block = _block_of(edit, kinds, theirs if edit.run is ABSENT else mine)
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
        changes.append(_of_block(block, head, several, run))
    return changes, rest


def _is_hollow(edit: Edit) -> bool:
    """Whether it only says that an element has nothing in it, on one side."""
    return (edit.golden, edit.run) in ((ABSENT, ""), ("", ABSENT))


def _prefixes(leaves: Leaves) -> set[str]:
    """The paths of all leaves and of all that holds some."""
    found: set[str] = set()
    for path in leaves:
        owner = parted(path)[0]
        while len(path) > len(owner) and path not in found:
            found.add(path)
            path = _outer(path)
    return found


def _outer(path: str) -> str:
    """A path without its last step."""
    return path[: max(path.rfind("."), path.rfind("@"), path.rfind("["), 0)]


def _block_of(edit: Edit, kinds: set[str], others: set[str]) -> str:
    """The outermost element of its part that only one of the two has, or that is of another kind in both."""
    if ABSENT not in (edit.golden, edit.run) and edit.path not in kinds:
        return ""
    owner = parted(edit.path)[0]
    path, block = edit.path, ""
    while len(path) > len(owner) + 1:
        if path in kinds and path != edit.path:
            return path
        if path not in others:
            block = path
        path = _outer(path)
    return block if ABSENT in (edit.golden, edit.run) else ""


def _of_block(block: str, head: Edit | None, several: list[Edit], run: Leaves) -> Change:
    """What became of an element."""
    owner, attribute = parted(block)
    inner = [(e.path[len(block) :].lstrip(".@"), e) for e in several if e.path.startswith((block + ".", block + "@"))]
    first = head or several[0]
    where = next((e.where for e in (first, *several) if e.where), "")
    edits = tuple(dict.fromkeys(e.path for e in ([head] if head else []) + several))
    by_path = {e.path: e for e in ([head] if head else []) + several}
    every = tuple(by_path[p] for p in edits)
    gone = listed([f"{n} {one(e.golden)}" for n, e in inner if e.run is ABSENT], 6)
    new = listed([f"{n} {one(e.run)}" for n, e in inner if e.golden is ABSENT], 6)
    if head is not None and ABSENT not in (head.golden, head.run):
        words = said(head, run) + (f", with {new}" if new else "") + (f" instead of {gone}" if gone else "")
        return Change("model", words, head.path, head.golden, head.run, where, every)
    is_gone = several[0].run is ABSENT
    state = f"is gone (it had {gone})" if is_gone else f"is new, with {new}"
    words = f"{call(owner)}: {named(attribute)} {state}"
    a, b = (one(gone), None) if is_gone else (None, one(new))
    return Change("model", words, block, a, b, where, every)


def _units(edits: list[Edit]) -> list[list[Edit]]:
    """Edits that belong together: those of one element of one part (its inertial, its material, one noise)."""
    groups: dict[Any, list[Edit]] = {}
    for number, edit in enumerate(edits):
        owner, attribute = parted(edit.path)
        inner = _outer(attribute)
        groups.setdefault((owner, inner) if inner not in _LOOSE else number, []).append(edit)
    return list(groups.values())


def _alike(units: list[list[Edit]]) -> list[list[list[Edit]]]:
    """Units in which the same became other in the same way."""
    groups: dict[Any, list[list[Edit]]] = {}
    for unit in units:
        groups.setdefault(tuple((_last(e.path), repr(e.golden), repr(e.run)) for e in unit), []).append(unit)
    return list(groups.values())


def _last(path: str) -> str:
    return named(parted(path)[1]).rpartition(".")[2]


def _factor(change: Change) -> Any:
    """What a change multiplies a number by, with the number's name."""
    a, b = change.golden, change.run
    if isinstance(a, (int, float)) and isinstance(b, (int, float)) and not isinstance(a, bool) and a and b:
        factor = round(b / a, 9)
        return (_last(change.path), factor) if factor not in (1.0, -1.0) else None
    return None


def _change(units: list[list[Edit]], run: Leaves) -> Change:
    unit = units[0]
    first = unit[0]
    head = title(first) + ": "
    # of the first the whole path, of the others in the same element the last name
    inner = [said(e, run).removeprefix(head) for e in unit]
    block = named(parted(first.path)[1]).rpartition(".")[0]
    inner[1:] = [text.removeprefix(block + ".") if block else text for text in inner[1:]]
    words = ", ".join(inner)
    owners = list(dict.fromkeys(parted(u[0].path)[0] for u in units))
    if len(owners) > 1:
        words = f"{words} in {len(owners)} places: {listed([call(o) for o in owners])}"
    else:
        words = head + words
        if len(units) > 1:
            words += f"; the same for {listed([named(parted(u[0].path)[1]) for u in units[1:]])}"
    every = tuple(e for u in units for e in u)
    return Change(first.kind, words, first.path, first.golden, first.run, first.where, every)
