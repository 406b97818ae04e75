"""Why a run is not the golden one: what is other in what it was made from, and what of it makes the difference."""

from __future__ import annotations

import os
from collections.abc import Sequence

from simkit.golden.cause.again import Again, Rerun, can_be_put_back, rerun_scenario
from simkit.golden.cause.beside import beside_the_world
from simkit.golden.cause.changes import Change, changes_of
from simkit.golden.cause.edits import model_edits
from simkit.golden.cause.engine import engine_changes
from simkit.golden.cause.search import Found, effective
from simkit.golden.cause.ticks import Parting, exact_quantity, parting
from simkit.golden.difference import Cause, Comparison, Explanation
from simkit.golden.record import Record

_MOST = 8  # causes that are written out


def explain(
    golden: Record,
    run: Record,
    comparison: Comparison,
    *,
    rerun: Rerun | None = rerun_scenario,
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
    changes, beside = beside_the_world(world_changes(golden, run), golden, run)
    engine = engine_changes(golden, run, changes)
    parted = parting(golden.states, run.states)
    scenario = [c for c in beside if c.kind == "scenario"]
    others = [c for c in beside if c.kind != "scenario"]
    every = [*scenario, *changes, *engine, *others]
    proof = _Proof()
    if rerun is not None and _shows(comparison):
        proof = _prove(every, golden, run, comparison, rerun, budget_s, parted)
    causes = _ranked(every, proof)
    explanation = Explanation(
        [cause for _, cause in causes],
        None if parted is None else parted.tick,
        None if parted is None else parted.time,
        proof.quantity or ("" if parted is None else parted.quantity),
    )
    explanation.lines = _lines([cause for _, cause in causes], proof, parted, golden, run, comparison)
    return explanation


def world_changes(golden: Record, run: Record) -> list[Change]:
    """What is other in the world of a run than in that of the golden one."""
    return changes_of(model_edits(golden.leaves, run.leaves, run.leaf_places), golden.leaves, run.leaves)


class _Proof:
    """What running again has shown.

    Attributes:
        found: by number of the change; None where nothing was run.
        tried: the numbers of the changes that were put back.
        until: up to where outputs were compared [s].
        quantity: what differs first, at the very tick; "" where that was not looked at.
    """

    def __init__(self) -> None:
        self.found: Found | None = None
        self.tried: list[int] = []
        self.until = 0.0
        self.is_whole = False
        self.quantity = ""


def _shows(comparison: Comparison) -> bool:
    """Whether anything that was recorded is other, so that putting back can show something."""
    return any(difference.kind != "model" for difference in comparison.differences)


def _prove(
    every: Sequence[Change],
    golden: Record,
    run: Record,
    comparison: Comparison,
    rerun: Rerun,
    budget: float,
    parted: Parting | None,
) -> _Proof:
    proof = _Proof()
    proof.tried = [n for n, change in enumerate(every) if can_be_put_back(change, run)]
    if not proof.tried:
        return proof
    again = Again(golden, run, comparison, every, rerun, budget)
    proof.found = effective(proof.tried, again.same)
    proof.until = again.horizon
    if proof.found.needed and again.go_on():
        _look_at_all(proof, again)
    proof.is_whole = proof.until >= (run.scenario.timeout or run.scenario.duration)
    if parted is not None and parted.tick and proof.found.needed and parted.time <= again.horizon:
        at = parted.tick * run.states.timestep
        mine = again.record(frozenset(), at)
        theirs = again.record(frozenset(proof.found.needed), at) if mine is not None else None
        if mine is not None and theirs is not None:
            proof.quantity = exact_quantity(theirs.states, mine.states, by_input=parted.is_put_in)
    return proof


def _look_at_all(proof: _Proof, again: Again) -> None:
    """Whether what explains the first difference explains the whole run; if not, what else there is to it."""
    assert proof.found is not None
    answer = again.same(frozenset(proof.found.needed))
    if answer:
        proof.until = again.horizon
    elif answer is False:
        later = effective([*proof.found.needed, *(n for n in proof.tried if n not in proof.found.needed)], again.same)
        if later.all_back and later.needed and len(later.needed) + len(later.idle) == len(proof.tried):
            proof.found, proof.until = later, again.horizon


def _ranked(every: Sequence[Change], proof: _Proof) -> list[tuple[int, Cause]]:
    """The causes: proven ones first, then those of which nothing is known, then those that make no difference."""
    found = []
    for number, change in enumerate(every):
        proven: bool | None = None
        if proof.found is not None:
            if number in proof.found.needed:
                proven = True
            elif number in proof.found.idle:
                proven = False
        place = {True: 0, None: 1, False: 3}[proven]
        if proven is None and (proof.found is not None and proof.found.needed and proof.found.all_back):
            place = 2  # what is proven is enough
        elif proven is None and change.kind == "version":
            place = 2
        cause = Cause(change.kind, change.words, change.path, change.golden, change.run, change.where, proven)
        found.append((place, number, cause))
    return [(number, cause) for _, number, cause in sorted(found, key=lambda t: t[:2])]


def _lines(
    causes: Sequence[Cause],
    proof: _Proof,
    parted: Parting | None,
    golden: Record,
    run: Record,
    comparison: Comparison,
) -> list[str]:
    proven = [c for c in causes if c.proven]
    open_ = [c for c in causes if c.proven is None]
    idle = [c for c in causes if c.proven is False]
    lines: list[str] = []
    for cause in proven[:_MOST]:
        lines.append(f"cause: {_sentence(cause)}")
    if proven:
        what = "this" if len(proven) == 1 else f"these {len(proven)}"
        until = "" if proof.is_whole else f" up to t = {proof.until:g} s"
        close = ", within the tolerances" if comparison.tier == "tolerant" else ""
        lines.append(f"  proven: with {what} put back the run gives the golden outputs{until}{close}")
    elif open_:
        is_only = len(causes) == 1
        for cause in open_[:_MOST]:
            lines.append(f"{'cause' if is_only else 'changed'}: {_sentence(cause)}")
        if is_only:
            lines.append("  nothing else was changed")
        if proof.found is not None and proof.found.all_back is False:
            lines.append("  what could be put back was put back, and the outputs still differ")
    if not causes:
        lines.append(_no_cause(golden, run))
    elif not _shows(comparison):
        lines.append("  nothing that is recorded shows it")
    if proven:
        others = [c for c in open_ if c.kind != "version"]
        lines += [f"changed as well: {_sentence(cause)}" for cause in others[:3]]
    if idle:
        more = f" and {len(idle) - 3} more" if len(idle) > 3 else ""
        lines.append("changed as well, without effect: " + "; ".join(_sentence(c) for c in idle[:3]) + more)
    if len(open_) > _MOST:
        lines.append(f"and {len(open_) - _MOST} more changes")
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


def _no_cause(golden: Record, run: Record) -> str:
    same = golden.fingerprint == run.fingerprint
    where = "the same versions on the same machine" if same else "other versions or another machine"
    return f"nothing that the run is made from was changed, with {where}" + (
        "; something in it does not repeat: `simkit certify` says what" if same else ""
    )


def _sentence(cause: Cause) -> str:
    return cause.words + (f" ({_near(cause.where)})" if cause.where else "")


def _near(where: str) -> str:
    """A place as short as it can be found from here."""
    file, colon, line = where.rpartition(":")
    try:
        near = os.path.relpath(file or where)
    except ValueError:  # another drive
        return where
    return (near if len(near) < len(file) and not near.startswith("../..") else file) + colon + line
