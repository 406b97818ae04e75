"""Which of several changes make the difference: each is put back, in a few runs, by halving."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

Same = Callable[[frozenset[int]], bool | None]
"""Whether the run with these changes put back gives the golden outputs; None where there is no time left for it."""


@dataclass
class Found:
    """What putting changes back has shown.

    Attributes:
        needed: which must be put back for the golden outputs, and are enough for them.
        idle: which make no difference.
        all_back: whether everything put back gives the golden outputs; None where that was not tried.
    """

    needed: list[int] = field(default_factory=list)
    idle: list[int] = field(default_factory=list)
    all_back: bool | None = None


def effective(order: Sequence[int], same: Same) -> Found:
    """Finds which changes make the difference.

    Args:
        order: the changes, the likeliest first.
        same: runs with some of them put back.
    """
    every = frozenset(order)
    found = Found(all_back=same(every))
    if not found.all_back:
        return found
    if len(order) == 1:
        found.needed = list(order)
        return found
    if same(frozenset(order[:1])):  # nearly always one change is the cause, and the ranking knows which
        found.needed, found.idle = [order[0]], list(order[1:])
        return found
    _halve(list(order), every, same, found)
    return found


def _halve(group: list[int], every: frozenset[int], same: Same, found: Found) -> None:
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
    _halve(group[:middle], every, same, found)
    _halve(group[middle:], every, same, found)
