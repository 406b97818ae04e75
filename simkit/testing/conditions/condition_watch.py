"""Watch that evaluates the checks of a run after every step."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from types import TracebackType
from typing import TYPE_CHECKING, Literal

from simkit.run_spec import Check
from simkit.testing.conditions.check_list import CheckList
from simkit.testing.conditions.checks import CheckResult
from simkit.testing.conditions.world_view import WorldView

if TYPE_CHECKING:
    from simkit.runtime import Simulation

__all__ = ["CheckResult", "Watch"]


class Watch:
    """Checks of a run; a context manager around the run.

    Conditions are evaluated on entry and after every step. Evaluation does not change the simulation.

    Args:
        sim: Simulation.
        checks: Checks.
        until: Expression that ends the run when it is true; empty for none.
        timeout: Time by which `until` must be true [s].
        absent: Behaviour for a topic without a publisher. "error" raises an error, unless the run has nodes, which
            open their publishers later. "wait" waits for a publisher, and the check fails if there is none until the
            end of the run.

    Raises:
        InputError: Expressions have syntax errors or unknown names; the message lists all errors.
    """

    def __init__(
        self,
        sim: Simulation,
        checks: Sequence[Check],
        *,
        until: str = "",
        timeout: float | None = None,
        absent: Literal["error", "wait"] = "error",
    ) -> None:
        self._sim = sim
        self._view = WorldView(sim, "wait" if sim.nodes else absent)
        self._checks = CheckList(self._view, checks, until=until, timeout=timeout)
        self._is_active = False
        self._end: Callable[[], None] = lambda: None

    @property
    def ended(self) -> bool:
        """True if `until` was true after any step; the run then ends."""
        return self._checks.ended

    def results(self, reason: str) -> tuple[CheckResult, ...]:
        """Return the results of all checks after the run; the result of `until` is the first one.

        Args:
            reason: End of the run: "duration", "until", "timeout", "wall_timeout", or the text of an error.
        """
        return self._checks.results(reason)

    def __enter__(self) -> Watch:
        self._view.open()
        self._checks.begin()
        self._end_if_over()
        if self._checks.are_running:
            self._is_active = True
            on_demand = self._sim.communication.on_demand
            self._end = on_demand.add(lambda: self._is_active, None, lambda _: self.look(), "after")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._is_active = False
        self._end()
        self._sim.control.pausing.is_over = False
        self._view.close()

    def look(self) -> None:
        """Evaluate the checks for the present state; this method is called automatically after every step."""
        if self._checks.are_running:
            self._checks.look()
            self._end_if_over()

    def _end_if_over(self) -> None:
        if self.ended:
            self._sim.control.pausing.end()
