"""Groups of joints for the panel of the page: kinematic chains, with the arm first and the wheels last."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import takewhile
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.linear_algebra import matmul

if TYPE_CHECKING:
    from simkit import Joint, Simulation

_MOST_WHEEL_JOINTS: Final = 2  # from the base to a wheel: a suspension or the fork of a caster, and the axle
_LEVEL: Final = 0.7  # largest vertical part of the axis of a wheel; it is 1 for a mast that turns
_SUFFIX: Final = re.compile(r"[_ ]*joint[_ ]*$", re.IGNORECASE)
_CUT_WORD: Final = re.compile(r"(?<![A-Za-z])[A-Za-z]+$")


@dataclass
class _Chain:
    """Joints one after the other from the base to the tip, without a branch, and the chains that begin at its end."""

    joints: list[int]
    ends: list[_Chain]


def joint_groups(sim: Simulation, joints: Sequence[Joint]) -> list[tuple[str, list[int]]]:
    """Return heading and joints of each group, model by model; joints with several axes are in no group.

    In a model, the longest chain comes first, then the chains at its end; wheels come last. The heading is what the
    names of the joints have in common, else the first and the last name.

    Args:
        sim: simulation with the joints.
        joints: joints; a group has their numbers in this list.
    """
    parents = _parents(sim, joints)
    children: dict[tuple[str, int | None], list[int]] = {}
    for number, parent in parents.items():
        model = _model(joints[number])
        is_same = parent is not None and _model(joints[parent]) == model
        children.setdefault((model, parent if is_same else None), []).append(number)
    models = list(dict.fromkeys(model for model, _ in children))
    groups = []
    for model in models:
        roots = [_chain_from(children, model, number) for number in children[model, None]]
        wheels = [number for root in roots if _is_wheel(sim, joints, root) for number in root.joints]
        others = _merged([root for root in roots if root.joints[0] not in wheels])
        found = [chain.joints for chain in _in_order(others)]
        headings = _headings([[joints[number].name for number in group] for group in found])
        rows = [*zip(headings, found, strict=True), *([("wheels", wheels)] if wheels else [])]
        groups += [(f"{model}: {heading}" if len(models) > 1 else heading, group) for heading, group in rows]
    return groups


def _model(joint: Joint) -> str:
    return joint.scoped.split("::", 1)[0]


def _parents(sim: Simulation, joints: Sequence[Joint]) -> dict[int, int | None]:
    """Return the next joint towards the base for each joint with one axis; None at the base."""
    model = sim.mj_model
    by_body: dict[int, list[int]] = {}
    for number, joint in enumerate(joints):
        if joint.dof == 1:
            by_body.setdefault(int(model.dof_bodyid[joint.mj_dofs[0]]), []).append(number)
    parents: dict[int, int | None] = {}
    for body, numbers in by_body.items():
        above = int(model.body_parentid[body])
        while above and above not in by_body:
            above = int(model.body_parentid[above])
        before = by_body[above][-1] if above else None
        for number in numbers:
            parents[number], before = before, number
    return dict(sorted(parents.items()))


def _chain_from(children: dict[tuple[str, int | None], list[int]], model: str, first: int) -> _Chain:
    numbers = [first]
    while len(following := children.get((model, numbers[-1]), [])) == 1:
        numbers += following
    return _Chain(numbers, _merged([_chain_from(children, model, number) for number in following]))


def _merged(chains: Sequence[_Chain]) -> list[_Chain]:
    """Make one group of the chains that are a single joint, such as the fingers of a gripper."""
    singles = [chain for chain in chains if len(chain.joints) == 1 and not chain.ends]
    if len(singles) < 2:
        return list(chains)
    others = [chain for chain in chains if chain not in singles]
    return [*others, _Chain([chain.joints[0] for chain in singles], [])]


def _is_wheel(sim: Simulation, joints: Sequence[Joint], chain: _Chain) -> bool:
    """Check whether a chain at the base ends at a wheel: a joint without limits whose axis is level."""
    last = joints[chain.joints[-1]]
    if chain.ends or len(chain.joints) > _MOST_WHEEL_JOINTS or last.type != "continuous":
        return False
    model = sim.mj_model
    number = int(model.dof_jntid[last.mj_dofs[0]])
    body = sim.mj_data.xmat[model.jnt_bodyid[number]].reshape(3, 3)
    return abs(float(matmul(body, np.asarray(model.jnt_axis[number]))[2])) < _LEVEL


def _in_order(chains: Sequence[_Chain]) -> Iterator[_Chain]:
    """Yield all chains, the longest first, each followed by the chains at its end."""
    left = list(_all_chains(chains))
    while left:
        longest = max(left, key=lambda chain: len(chain.joints))
        for chain in [longest, *_in_order(longest.ends)]:
            if any(chain is one for one in left):
                yield chain
        done = [longest, *_all_chains(longest.ends)]
        left = [chain for chain in left if not any(chain is one for one in done)]


def _all_chains(chains: Sequence[_Chain]) -> Iterator[_Chain]:
    for chain in chains:
        yield chain
        yield from _all_chains(chain.ends)


def _headings(names_by_group: Sequence[Sequence[str]]) -> list[str]:
    """Return a heading for the names of each group."""
    common = [_common_words(names) for names in names_by_group]
    counts = Counter(common)
    ends = [
        " … ".join(dict.fromkeys(_words(name) or name for name in (names[0], names[-1]))) for names in names_by_group
    ]
    return [text if text and counts[text] == 1 else other for text, other in zip(common, ends, strict=True)]


def _common_words(names: Sequence[str]) -> str:
    """Return the words that all names begin with; empty if there are none."""
    if len(names) == 1:
        return _words(names[0])
    pairs = zip(min(names), max(names), strict=False)
    start = "".join(letter for letter, _ in takewhile(lambda pair: pair[0] == pair[1], pairs))
    following = {name[len(start) : len(start) + 1] for name in names}
    if not start.endswith("_") and any(character.isalpha() for character in following):
        start = _CUT_WORD.sub("", start)
    return _words(start.rstrip("_0123456789- "))


def _words(name: str) -> str:
    """Return a name of a joint as words: without the suffix `_joint`, and with spaces."""
    return _SUFFIX.sub("", name).replace("_", " ").strip()
