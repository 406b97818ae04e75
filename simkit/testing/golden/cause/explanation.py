"""Explanation of differences between a run and its golden run: changed inputs, and proven causes among them."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from simkit import progress
from simkit.number_text import counted
from simkit.packs import is_shipped_file
from simkit.run_spec import RunSpec
from simkit.testing.golden.cause.edits import Change, find_changes, list_names, single_value_text, values_text
from simkit.testing.golden.cause.first_tick import FirstDifferentTick, first_different_tick, largest_final_difference
from simkit.testing.golden.cause.rerun import ChangeWorld, RunChangedWorld, ScenarioRerun, can_be_undone, rerun_scenario
from simkit.testing.golden.compare.difference import Cause, Comparison, Explanation
from simkit.testing.golden.compare.world_edits import (
    ABSENT,
    Edit,
    field_edits,
    model_edits,
    other_edits,
)
from simkit.testing.run_record.fingerprint import PROCESSOR_FEATURES
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


def _short_value(value: object) -> object:
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


def _text(value: object) -> str:
    if isinstance(value, Mapping):
        return ", ".join(f"{k} {single_value_text(v)}" for k, v in value.items() if k != "where")
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
        words += f", in {counted(len(several), 'place')}: {list_names([e.path.rpartition(' ')[0] for e in several])}"
    # no edits: the compiled model is built again for every run, so its fields cannot be restored
    return Change("model", words, first.path, a, b, "", ())


def _plain_number(value: object) -> object:
    if value is ABSENT:
        return value
    array = np.asarray(value)
    if array.ndim == 0 or array.size == 1:
        return array.reshape(-1)[0].item()
    return array.reshape(-1).tolist()


IsSameRun = Callable[[frozenset[int]], bool | None]
"""Function that undoes some changes and returns True if the run gives the golden outputs; None if no time is left."""


@dataclass
class SearchResult:
    """Result of undoing changes.

    Attributes:
        needed: Changes that must be undone to get the golden outputs; no further change must be undone.
        idle: Changes without an effect on the outputs.
        all_back: True if undoing all changes gives the golden outputs; None if this was not tested.
    """

    needed: list[int] = field(default_factory=list)
    idle: list[int] = field(default_factory=list)
    all_back: bool | None = None


def find_effective_changes(order: Sequence[int], same: IsSameRun) -> SearchResult:
    """Find the changes that cause the differences.

    Args:
        order: Indices of the changes, most likely first.
        same: Function that reruns the scenario with some changes undone.
    """
    every = frozenset(order)
    search = SearchResult(all_back=same(every))
    if not search.all_back:
        return search
    if len(order) == 1:
        search.needed = list(order)
        return search
    if same(frozenset(order[:1])):  # in most cases one change is the cause, and it is ranked first
        search.needed, search.idle = [order[0]], list(order[1:])
        return search
    _bisect_changes(list(order), every, same, search)
    return search


def _bisect_changes(group: list[int], every: frozenset[int], same: IsSameRun, found: SearchResult) -> None:
    """Undo all changes except a group. Add the group to the needed or idle changes, or divide the group further."""
    answer = same(every - frozenset(group))
    if answer is None:
        return
    if answer:
        found.idle += group
        return
    if len(group) == 1:
        found.needed += group
        return
    middle = len(group) // 2
    _bisect_changes(group[:middle], every, same, found)
    _bisect_changes(group[middle:], every, same, found)


_MAX_CHANGES = 8  # maximum number of causes in a report; further causes are counted


def explain(
    golden: RunRecord,
    run: RunRecord,
    comparison: Comparison,
    *,
    rerun: RunChangedWorld | None = rerun_scenario,
    budget_s: float = 60.0,
) -> Explanation:
    """Explain the differences between a run and its golden run.

    Args:
        golden: Stored record.
        run: New record.
        comparison: Comparison of both records.
        rerun: Function that runs a scenario again in a changed world. If None, the causes are not tested.
        budget_s: Wall-clock limit of all reruns [s].
    """
    changes, beside = changes_outside_world(world_changes(golden, run), golden, run)
    engine = engine_changes(golden, run, changes)
    parted = first_different_tick(golden.states, run.states)
    scenario = [c for c in beside if c.kind == "scenario"]
    every = [*scenario, *changes, *engine, *(c for c in beside if c.kind != "scenario")]
    proof = _Proof([n for n, change in enumerate(every) if can_be_undone(change, run)])
    if proof.tried and rerun is not None and _has_recorded_difference(comparison):
        most = 2 * len(proof.tried) + 4  # a bisection of all changes, and the tests of its result
        with progress.task("searching for the cause", most, unit="runs at most", expected=budget_s) as task:

            def counted_rerun(scenario: RunSpec, change: ChangeWorld | None) -> RunRecord:
                record = rerun(scenario, change)
                task.advance()
                return record

            _prove(proof, ScenarioRerun(golden, run, comparison, every, counted_rerun, budget_s), parted)
    causes = _rank_causes(every, proof)
    explanation = Explanation(causes, lines=_lines(causes, proof, parted, golden, run, comparison))
    explanation.quantity = proof.quantity or ("" if parted is None else parted.quantity)
    if parted is not None:
        explanation.tick, explanation.time = parted.tick, parted.time
    return explanation


def world_changes(golden: RunRecord, run: RunRecord) -> list[Change]:
    """Return the changes of the world between a golden run and a new run."""
    return find_changes(model_edits(golden.leaves, run.leaves, run.leaf_places), golden.leaves, run.leaves)


@dataclass
class _Proof:
    """Results of rerunning the scenario.

    Attributes:
        tried: Indices of the changes that can be undone.
        found: Result of the search; None if nothing was run.
        until: Simulated time up to which outputs were compared [s].
        is_whole: True if the whole run was compared.
        quantity: First quantity that differs; empty if unknown.
    """

    tried: list[int]
    found: SearchResult | None = None
    until: float = 0.0
    is_whole: bool = False
    quantity: str = ""


def _has_recorded_difference(comparison: Comparison) -> bool:
    """Check whether a recorded output differs, so that undoing a change can have an effect."""
    return any(difference.kind != "model" for difference in comparison.differences)


def _prove(proof: _Proof, again: ScenarioRerun, parted: FirstDifferentTick | None) -> None:
    proof.found = find_effective_changes(proof.tried, again.same)
    proof.until = again.horizon
    if proof.found.needed and again.extend_to_whole_run():
        _explain_whole_run(proof, again)
    proof.is_whole = proof.until >= again.run.scenario.longest
    if parted is not None and parted.tick and proof.found.needed and parted.time <= again.horizon:
        at = parted.tick * again.run.states.timestep
        mine = again.record(frozenset(), at)
        theirs = again.record(frozenset(proof.found.needed), at) if mine is not None else None
        if mine is not None and theirs is not None:
            proof.quantity = largest_final_difference(theirs.states, mine.states, by_input=parted.has_other_input)


def _explain_whole_run(proof: _Proof, again: ScenarioRerun) -> None:
    """Check whether the changes that explain the first difference explain the whole run; if not, search again."""
    assert proof.found is not None
    answer = again.same(frozenset(proof.found.needed))
    if answer:
        proof.until = again.horizon
    elif answer is False:
        later = find_effective_changes(
            [*proof.found.needed, *(n for n in proof.tried if n not in proof.found.needed)], again.same
        )
        if later.all_back and later.needed and len(later.needed) + len(later.idle) == len(proof.tried):
            proof.found, proof.until = later, again.horizon


def _rank_causes(every: Sequence[Change], proof: _Proof) -> list[Cause]:
    """Order the causes: first proven causes, then untested causes, then changes without an effect."""
    ranked = []
    search = proof.found or SearchResult()
    for number, change in enumerate(every):
        proven = True if number in search.needed else False if number in search.idle else None
        place = {True: 0, None: 1, False: 3}[proven]
        if proven is None and ((search.needed and search.all_back) or change.kind == "version"):
            place = 2  # proven causes suffice, and versions cannot be tested
        cause = Cause(change.kind, change.words, change.path, change.golden, change.run, change.where, proven)
        ranked.append((place, number, cause))
    return [cause for _, _, cause in sorted(ranked, key=lambda ranking: ranking[:2])]


def _lines(
    causes: Sequence[Cause],
    proof: _Proof,
    parted: FirstDifferentTick | None,
    golden: RunRecord,
    run: RunRecord,
    comparison: Comparison,
) -> list[str]:
    proven = [c for c in causes if c.proven]
    open_ = [c for c in causes if c.proven is None]
    idle = [c for c in causes if c.proven is False]
    lines: list[str] = []
    for cause in proven[:_MAX_CHANGES]:
        lines.append(f"cause: {_sentence(cause)}")
    if proven:
        what = "this change" if len(proven) == 1 else f"these {len(proven)} changes"
        until = "" if proof.is_whole else f" up to t = {proof.until:g} s"
        close = ", within the tolerances" if comparison.tier == "tolerant" else ""
        lines.append(f"  proven: with {what} undone, the run gives the golden outputs{until}{close}")
    elif open_:
        is_only = len(causes) == 1
        for cause in open_[:_MAX_CHANGES]:
            lines.append(f"{'cause' if is_only else 'changed'}: {_sentence(cause)}")
        if is_only:
            lines.append("  no other input changed")
        if proof.found is not None and proof.found.all_back is False:
            lines.append("  with all changes undone that can be undone, the outputs still differ")
    if not causes:
        lines.append(_no_cause(golden, run))
        lines += _node_lines(run)
    elif not _has_recorded_difference(comparison):
        lines.append("  no recorded output differs")
    if proven:
        others = [c for c in open_ if c.kind != "version"]
        lines += [f"also changed: {_sentence(cause)}" for cause in others[:3]]
    if idle:
        more = f" and {len(idle) - 3} more" if len(idle) > 3 else ""
        lines.append("also changed, without effect: " + "; ".join(_sentence(c) for c in idle[:3]) + more)
    if len(open_) > _MAX_CHANGES:
        lines.append(f"and {len(open_) - _MAX_CHANGES} more changes")
    if parted is not None:
        words = parted.words
        if proof.quantity:
            words = words.partition("; first ")[0] + f"; first {proof.quantity}"
        lines.append(words)
    if golden.end != run.end:
        lines.append(f"the run ended by {_end(run.end)}, the golden run by {_end(golden.end)}")
    for code in sorted({*golden.diagnostics, *run.diagnostics}):
        a, b = golden.diagnostics.get(code, 0), run.diagnostics.get(code, 0)
        if a != b:
            lines.append(f"loading reports {code} {b} times; in the golden run {a} times")
    return lines


def _end(reason: str) -> str:
    return {"duration": "its duration", "until": "reaching its goal", "timeout": "its timeout"}.get(reason, reason)


def _no_cause(golden: RunRecord, run: RunRecord) -> str:
    if golden.fingerprint == run.fingerprint:
        return (
            "no input of the run changed; the versions and the machine are the same; "
            "the run is not deterministic: `simkit certify` finds the reason"
        )
    changed = {name for name in {*golden.fingerprint, *run.fingerprint} if _entry_differs(golden, run, name)}
    if changed == {PROCESSOR_FEATURES}:
        before, after = (record.fingerprint.get(PROCESSOR_FEATURES, "") for record in (golden, run))
        return (
            f"no input of the run changed; the processors differ ({before} → {after}): code of plugins that uses "
            "NumPy's `@`, `np.linalg` or functions such as `np.exp` gives other bits there (docs/determinism.md)"
        )
    return "no input of the run changed; the versions or the machine differ"


def _node_lines(run: RunRecord) -> list[str]:
    """Return the nodes of a run, which may be the reason of a difference without a changed input."""
    sim = run.simulation
    if sim is None or not sim.nodes:
        return []
    reported = [str(d).partition("\n")[0] for d in sim.diagnostics if d.code.startswith("SK-NODE-")]
    own = [program for program in sim.nodes if program.file is None or not is_shipped_file(str(program.file))]
    names = ", ".join(program.name if program.file is None else program.file.name for program in own or sim.nodes)
    return [f"  code of nodes can be the reason: {names}", *(f"  {line}" for line in reported[:_MAX_CHANGES])]


def _entry_differs(golden: RunRecord, run: RunRecord, name: str) -> bool:
    return golden.fingerprint.get(name, "") != run.fingerprint.get(name, "")


def _sentence(cause: Cause) -> str:
    return cause.words + (f" ({_short_path(cause.where)})" if cause.where else "")


def _short_path(where: str) -> str:
    """Return a source position relative to the working directory, if this text is shorter."""
    file, colon, line = where.rpartition(":")
    try:
        near = os.path.relpath(file or where)
    except ValueError:  # the file is on another drive
        return where
    return (near if len(near) < len(file) and not near.startswith("../..") else file) + colon + line
