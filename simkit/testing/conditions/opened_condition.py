"""Condition of `sim.run_until`, given as text."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from simkit.testing.conditions.checks import Condition
from simkit.testing.conditions.syntax_tree import UndecidedValue
from simkit.testing.conditions.world_view import WorldView

if TYPE_CHECKING:
    from simkit.runtime import Simulation


@contextmanager
def opened_condition(sim: Simulation, text: str) -> Iterator[Callable[[Simulation], bool]]:
    """Make a function that evaluates an expression in the present state; its topics are received until the end.

    The function returns False while the value is unknown, for example before the first message of a topic.

    Raises:
        InputError: the expression has a syntax error or an unknown name, or is not true or false.
    """
    view = WorldView(sim, "wait" if sim.nodes else "error")
    condition = Condition(text, view)

    def holds(_: Simulation) -> bool:
        try:
            return condition.holds()
        except UndecidedValue:
            return False

    view.open()
    try:
        yield holds
    finally:
        view.close()
