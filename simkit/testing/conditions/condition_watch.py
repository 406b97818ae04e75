"""Watch that evaluates the checks of a run after every step."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from types import TracebackType
from typing import TYPE_CHECKING, Final, Literal

from simkit.errors import InputError
from simkit.run_spec import Check
from simkit.testing.conditions import checks as check_kinds
from simkit.testing.conditions.checks import CheckResult, ReachedCheck, RunningCheck
from simkit.testing.conditions.world_view import WorldView

if TYPE_CHECKING:
    from simkit.runtime import Simulation

__all__ = ["CheckResult", "Watch"]

_CHECK_CLASSES: Final[dict[str, type[RunningCheck]]] = {
    "goal": ReachedCheck,
    "always": check_kinds.AlwaysCheck,
    "final": check_kinds.FinalCheck,
    "apart": check_kinds.SeparationCheck,
    "rate": check_kinds.TopicRateCheck,
}


class Watch:
    """Checks of a run; a context manager around the run.

    Conditions are evaluated on entry and after every step. Evaluation does not change the simulation.

    Args:
        sim: Simulation.
        checks: Checks.
        until: Expression that ends the run when it is true; empty for none.
        timeout: Time by which `until` must be true [s].
        absent: Behaviour for a topic without a publisher. "error" raises an error. "wait" waits for a publisher, and
            the check fails if there is none until the end of the run.

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
        self._view = WorldView(sim, absent)
        all_checks = list(checks)
        if until:
            all_checks.insert(0, Check("goal", expression=until, by=timeout))
        self._entries = self._bind_checks(all_checks)
        self._until = self._entries[0] if until else None
        self._running: list[RunningCheck] = []
        self._is_active = False
        self._end: Callable[[], None] = lambda: None

    def _bind_checks(self, checks: Sequence[Check]) -> list[RunningCheck]:
        entries: list[RunningCheck] = []
        errors: list[InputError] = []
        for check in checks:
            try:
                entries.append(_CHECK_CLASSES[check.kind](check, self._view))
            except InputError as error:
                place = f"{check.where}: " if check.where else ""
                errors.append(InputError(f"{place}{error}", error.code))
        if errors:
            raise InputError("\n".join(map(str, errors)), errors[0].code)
        return entries

    @property
    def ended(self) -> bool:
        """True if `until` was true after any step; the run then ends."""
        return isinstance(self._until, ReachedCheck) and self._until.is_reached

    def results(self, reason: str) -> tuple[CheckResult, ...]:
        """Return the results of all checks after the run; the result of `until` is the first one.

        Args:
            reason: End of the run: "duration", "until", "timeout", "wall_timeout", or the text of an error.
        """
        return tuple(entry.result(reason) for entry in self._entries)

    def __enter__(self) -> Watch:
        self._view.open()
        self._running = [entry for entry in self._entries if entry.check.kind not in ("final", "rate")]
        self.look()
        if self._running and not self.ended:
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
        time = self._sim.time
        for entry in self._running:
            entry.look(time)
        if any(entry.is_decided for entry in self._running):
            self._running = [entry for entry in self._running if not entry.is_decided]
            if self.ended:
                self._running = []
                self._sim.control.pausing.end()
