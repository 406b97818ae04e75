"""Explain why a run differs from its reference run: which inputs differ, and which of them make the difference."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from simkit.testing.golden.cause.edits import Change, find_changes
from simkit.testing.golden.cause.file_changes import changes_outside_world, engine_changes
from simkit.testing.golden.cause.first_tick import FirstDifferentTick, first_different_tick, largest_final_difference
from simkit.testing.golden.cause.rerun import RunChangedWorld, ScenarioRerun, can_be_put_back, rerun_scenario
from simkit.testing.golden.compare.difference import Cause, Comparison, Explanation
from simkit.testing.golden.compare.world_edits import model_edits
from simkit.testing.run_record.record import RunRecord

IsSameRun = Callable[[frozenset[int]], bool | None]
"""Whether the run with these changes put back gives the golden outputs; None where there is no time left for it."""


@dataclass
class SearchResult:
    """What putting changes back has shown.

    Attributes:
        needed: which must be put back for the golden outputs, and are enough for them.
        idle: which make no difference.
        all_back: whether everything put back gives the golden outputs; None where that was not tried.
    """

    needed: list[int] = field(default_factory=list)
    idle: list[int] = field(default_factory=list)
    all_back: bool | None = None


def find_effective_changes(order: Sequence[int], same: IsSameRun) -> SearchResult:
    """Finds which changes make the difference.

    Args:
        order: the changes, the likeliest first.
        same: runs with some of them put back.
    """
    every = frozenset(order)
    found = SearchResult(all_back=same(every))
    if not found.all_back:
        return found
    if len(order) == 1:
        found.needed = list(order)
        return found
    if same(frozenset(order[:1])):  # nearly always one change is the cause, and the ranking knows which
        found.needed, found.idle = [order[0]], list(order[1:])
        return found
    _bisect_changes(list(order), every, same, found)
    return found


def _bisect_changes(group: list[int], every: frozenset[int], same: IsSameRun, found: SearchResult) -> None:
    """Sorts a group into what is needed and what is idle: it is left as it is, with all others put back."""
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


_MAX_CHANGES = 8  # causes that are written out


def explain(
    golden: RunRecord,
    run: RunRecord,
    comparison: Comparison,
    *,
    rerun: RunChangedWorld | None = rerun_scenario,
    budget_s: float = 60.0,
) -> Explanation:
    """Why a run is not the golden one.

    Args:
        golden: what was stored.
        run: what came now.
        comparison: of both.
        rerun: runs a scenario again, in a world that is given a change; None for no proofs.
        budget_s: wall time for proofs [s].
    """
    changes, beside = changes_outside_world(world_changes(golden, run), golden, run)
    engine = engine_changes(golden, run, changes)
    parted = first_different_tick(golden.states, run.states)
    scenario = [c for c in beside if c.kind == "scenario"]
    every = [*scenario, *changes, *engine, *(c for c in beside if c.kind != "scenario")]
    proof = _Proof([n for n, change in enumerate(every) if can_be_put_back(change, run)])
    if proof.tried and rerun is not None and _has_recorded_difference(comparison):
        _prove(proof, ScenarioRerun(golden, run, comparison, every, rerun, budget_s), parted)
    causes = _rank_causes(every, proof)
    explanation = Explanation(causes, lines=_lines(causes, proof, parted, golden, run, comparison))
    explanation.quantity = proof.quantity or ("" if parted is None else parted.quantity)
    if parted is not None:
        explanation.tick, explanation.time = parted.tick, parted.time
    return explanation


def world_changes(golden: RunRecord, run: RunRecord) -> list[Change]:
    """What is other in the world of a run than in that of the golden one."""
    return find_changes(model_edits(golden.leaves, run.leaves, run.leaf_places), golden.leaves, run.leaves)


@dataclass
class _Proof:
    """What running again has shown.

    Attributes:
        tried: the numbers of the changes that can be put back.
        found: by number of the change; None where nothing was run.
        until: up to where outputs were compared [s].
        is_whole: whether that is the whole run.
        quantity: what differs first, at the very tick; "" where that was not looked at.
    """

    tried: list[int]
    found: SearchResult | None = None
    until: float = 0.0
    is_whole: bool = False
    quantity: str = ""


def _has_recorded_difference(comparison: Comparison) -> bool:
    """Whether anything that was recorded is other, so that putting back can show something."""
    return any(difference.kind != "model" for difference in comparison.differences)


def _prove(proof: _Proof, again: ScenarioRerun, parted: FirstDifferentTick | None) -> None:
    proof.found = find_effective_changes(proof.tried, again.same)
    proof.until = again.horizon
    if proof.found.needed and again.go_on():
        _explain_whole_run(proof, again)
    proof.is_whole = proof.until >= again.run.scenario.longest
    if parted is not None and parted.tick and proof.found.needed and parted.time <= again.horizon:
        at = parted.tick * again.run.states.timestep
        mine = again.record(frozenset(), at)
        theirs = again.record(frozenset(proof.found.needed), at) if mine is not None else None
        if mine is not None and theirs is not None:
            proof.quantity = largest_final_difference(theirs.states, mine.states, by_input=parted.is_put_in)


def _explain_whole_run(proof: _Proof, again: ScenarioRerun) -> None:
    """Whether what explains the first difference explains the whole run; if not, what else there is to it."""
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
    """The causes: proven ones first, then those of which nothing is known, then those that make no difference."""
    found = []
    search = proof.found or SearchResult()
    for number, change in enumerate(every):
        proven = True if number in search.needed else False if number in search.idle else None
        place = {True: 0, None: 1, False: 3}[proven]
        if proven is None and ((search.needed and search.all_back) or change.kind == "version"):
            place = 2  # what is proven is enough
        cause = Cause(change.kind, change.words, change.path, change.golden, change.run, change.where, proven)
        found.append((place, number, cause))
    return [cause for _, _, cause in sorted(found, key=lambda ranking: ranking[:2])]


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
        what = "this" if len(proven) == 1 else f"these {len(proven)}"
        until = "" if proof.is_whole else f" up to t = {proof.until:g} s"
        close = ", within the tolerances" if comparison.tier == "tolerant" else ""
        lines.append(f"  proven: with {what} put back the run gives the golden outputs{until}{close}")
    elif open_:
        is_only = len(causes) == 1
        for cause in open_[:_MAX_CHANGES]:
            lines.append(f"{'cause' if is_only else 'changed'}: {_sentence(cause)}")
        if is_only:
            lines.append("  nothing else was changed")
        if proof.found is not None and proof.found.all_back is False:
            lines.append("  what could be put back was put back, and the outputs still differ")
    if not causes:
        lines.append(_no_cause(golden, run))
    elif not _has_recorded_difference(comparison):
        lines.append("  nothing that is recorded shows it")
    if proven:
        others = [c for c in open_ if c.kind != "version"]
        lines += [f"changed as well: {_sentence(cause)}" for cause in others[:3]]
    if idle:
        more = f" and {len(idle) - 3} more" if len(idle) > 3 else ""
        lines.append("changed as well, without effect: " + "; ".join(_sentence(c) for c in idle[:3]) + more)
    if len(open_) > _MAX_CHANGES:
        lines.append(f"and {len(open_) - _MAX_CHANGES} more changes")
    if parted is not None:
        words = parted.words
        if proof.quantity:
            words = words.partition("; first ")[0] + f"; first {proof.quantity}"
        lines.append(words)
    if golden.end != run.end:
        lines.append(f"the run ended by {_end(run.end)}, the golden one by {_end(golden.end)}")
    for code in sorted({*golden.diagnostics, *run.diagnostics}):
        a, b = golden.diagnostics.get(code, 0), run.diagnostics.get(code, 0)
        if a != b:
            lines.append(f"loading reports {code} {b} times, it was {a}")
    return lines


def _end(reason: str) -> str:
    return {"duration": "its duration", "until": "reaching its goal", "timeout": "its timeout"}.get(reason, reason)


def _no_cause(golden: RunRecord, run: RunRecord) -> str:
    same = golden.fingerprint == run.fingerprint
    where = "the same versions on the same machine" if same else "other versions or another machine"
    return f"nothing that the run is made from was changed, with {where}" + (
        "; something in it does not repeat: `simkit certify` says what" if same else ""
    )


def _sentence(cause: Cause) -> str:
    return cause.words + (f" ({_short_path(cause.where)})" if cause.where else "")


def _short_path(where: str) -> str:
    """A place as short as it can be found from here."""
    file, colon, line = where.rpartition(":")
    try:
        near = os.path.relpath(file or where)
    except ValueError:  # another drive
        return where
    return (near if len(near) < len(file) and not near.startswith("../..") else file) + colon + line
