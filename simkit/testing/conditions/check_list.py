"""Checks of a run that are evaluated together, one state of the world after another."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from simkit.errors import InputError, raise_together
from simkit.run_spec import Check
from simkit.testing.conditions import checks as check_kinds
from simkit.testing.conditions.checks import CheckResult, ConditionCheck, ReachedCheck, RunningCheck
from simkit.testing.conditions.world_view import WorldView

_CHECK_CLASSES: Final[dict[str, type[RunningCheck]]] = {
    "goal": ReachedCheck,
    "always": check_kinds.AlwaysCheck,
    "final": check_kinds.FinalCheck,
    "apart": check_kinds.SeparationCheck,
    "rate": check_kinds.TopicRateCheck,
}
_AT_END: Final = ("final", "rate")  # kinds of checks that are evaluated only at the end


class CheckList:
    """Checks of a run, bound to a view of its world.

    Args:
        view: World.
        checks: Checks.
        until: Expression that ends the run when it is true; empty for none.
        timeout: Time by which `until` must be true [s].

    Raises:
        InputError: Expressions have syntax errors or unknown names; the message lists all errors.
    """

    def __init__(
        self, view: WorldView, checks: Sequence[Check], *, until: str = "", timeout: float | None = None
    ) -> None:
        self._view = view
        all_checks = list(checks)
        if until:
            all_checks.insert(0, Check("goal", expression=until, by=timeout))
        self._entries = self._bind_checks(all_checks)
        self._until = self._entries[0] if until else None
        self._running: list[RunningCheck] = []

    def _bind_checks(self, checks: Sequence[Check]) -> list[RunningCheck]:
        entries: list[RunningCheck] = []
        errors: list[InputError] = []
        for check in checks:
            try:
                entries.append(_CHECK_CLASSES[check.kind](check, self._view))
            except InputError as error:
                place = f"{check.where}: " if check.where else ""
                errors.append(InputError(error.code, f"{place}{error}", shows_code=False))
        raise_together(errors)
        return entries

    def bind_waiting(self) -> None:
        """Bind the conditions that wait for a topic, if the topic exists now."""
        for entry in self._entries:
            if isinstance(entry, ConditionCheck):
                entry.condition.bind_late()

    def begin(self) -> None:
        """Evaluate the checks for the first state."""
        self._running = [entry for entry in self._entries if entry.check.kind not in _AT_END]
        self.look()

    def look(self) -> None:
        """Evaluate the checks for the present state."""
        time = self._view.clock.time
        for entry in self._running:
            entry.look(time)
        if any(entry.is_decided for entry in self._running):
            self._running = [] if self.ended else [entry for entry in self._running if not entry.is_decided]

    @property
    def are_running(self) -> bool:
        """True if a later state can change a result before the end of the run."""
        return bool(self._running)

    @property
    def ended(self) -> bool:
        """True if `until` was true in any state; the run then ends."""
        return isinstance(self._until, ReachedCheck) and self._until.is_reached

    @property
    def need_every_step(self) -> bool:
        """True if a check is evaluated in every step, and not only at the end."""
        return any(entry.check.kind not in _AT_END for entry in self._entries)

    def results(self, reason: str) -> tuple[CheckResult, ...]:
        """Return the results of all checks after the run; the result of `until` is the first one.

        Args:
            reason: End of the run: "duration", "until", "timeout", "wall_timeout", or the text of an error.
        """
        return tuple(entry.result(reason) for entry in self._entries)
