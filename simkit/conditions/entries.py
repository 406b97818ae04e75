"""The checks of a run while they are looked at: one class a kind."""

from __future__ import annotations

import math
import operator
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any

from simkit.conditions.binding import bind
from simkit.conditions.faults import Span, Undecided
from simkit.conditions.kinds import TRUTH
from simkit.conditions.parser import parse
from simkit.conditions.parts import Part, findings, shown
from simkit.conditions.results import CheckResult, clock, cut_short
from simkit.conditions.syntax import Comparison
from simkit.conditions.view import AbsentTopic
from simkit.errors import InputError

if TYPE_CHECKING:
    from simkit.conditions.view import View


_ORDERS = {"<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge}


class Condition:
    """An expression in a world; one that names a topic which nobody publishes yet is bound as soon as somebody does.

    Args:
        source: the expression.
        view: the world.

    Raises:
        InputError: it cannot be read, or names what the world does not have, or is not true or false.
    """

    def __init__(self, source: str, view: View) -> None:
        self.source, self._view = source, view
        self._expression = parse(source)
        self._part: Part | None = None
        self._fault = ""
        self._awaited = self._topic = ""
        self._revision = -1
        self._bind()

    def holds(self) -> bool:
        """Whether it is true now.

        Raises:
            Undecided: that is not known.
        """
        if self._part is None:
            self._bind_late()
        if self._part is None:
            raise Undecided(self._fault or self._awaited)
        return bool(self._part.get())

    def gap(self) -> tuple[bool, float, str]:
        """Whether it holds, and where two numbers are compared how far they are apart, else no number; with the text.

        Raises:
            Undecided: that is not known.
        """
        part = self._part
        if part is None or not isinstance(part.node, Comparison) or part.node.signs[0] not in _ORDERS:
            return self.holds(), math.nan, ""
        if len(part.below) > 2:
            return self.holds(), math.nan, ""
        left, right = part.below
        a, b = left.get(), right.get()
        text = left.node.span.text(self.source)
        return _ORDERS[part.node.signs[0]](a, b), abs(a - b), f"{text} was {shown(a)}"

    def findings(self, *, wanted: bool = True) -> str:
        """The values that make it hold or not."""
        if self._part is None:
            return self._fault or self._awaited
        return ", ".join(findings(self.source, self._part, wanted=wanted))

    def _bind(self) -> None:
        try:
            part = bind(self._expression, self._view)
        except AbsentTopic as absent:
            self._awaited = str(absent)
            self._topic = absent.topic
            return
        if part.kind is not TRUTH:
            from simkit.conditions.faults import fault

            message = f"the expression is {part.kind}, where true or false is wanted"
            span = part.node.span
            raise fault("SK-COND-004", message, self.source, span, "compare it: < <= > >= == !=")
        self._part = part

    def _bind_late(self) -> None:
        """Once the topic that is waited for is there; what does not fit then makes it fail, not the run."""
        bus = self._view.sim.bus
        if self._fault or bus.revision == self._revision:
            return
        self._revision = bus.revision
        if self._topic not in bus.all_topics():
            return
        try:
            self._bind()
        except InputError as error:
            self._fault = str(error)


class Entry(ABC):
    """A check of a run.

    Args:
        check: a `simkit.scenario.Check`.
        view: the world.
    """

    def __init__(self, check: Any, view: View) -> None:
        self.check, self._sim = check, view.sim
        self.is_decided = False
        self._result: CheckResult | None = None

    def look(self, time: float) -> None:
        """Looks at the state after a step [s]; called until it is decided."""

    def result(self, reason: str) -> CheckResult:
        """What became of it, at the end of the run."""
        if self._result is None:
            self._result = self._at_end(cut_short(reason))
        return self._result

    @abstractmethod
    def _at_end(self, cut: str) -> CheckResult:
        """What became of it where nothing was decided before the end; `cut` says why that came early, if it did."""

    def _decide(self, passed: bool, message: str, time: float | None = None) -> CheckResult:
        self.is_decided = True
        self._result = CheckResult(self.check, passed, message, self._sim.time if time is None else time)
        return self._result


class Goal(Entry):
    """Must hold once."""

    def __init__(self, check: Any, view: View) -> None:
        super().__init__(check, view)
        self._condition = Condition(check.expression, view)
        self._nearest, self._nearest_text, self._nearest_time = math.inf, "", 0.0

    @property
    def is_reached(self) -> bool:
        """Whether it has been."""
        return self._result is not None and self._result.passed

    def look(self, time: float) -> None:
        by = self.check.by
        if by is not None and time > by + 1e-9:
            self._decide(False, f"was not reached by {clock(by)}: {self._how_far()}", by)
            return
        try:
            holds, gap, text = self._condition.gap()
        except Undecided:
            return
        if holds:
            self._decide(True, f"was reached at {clock(time)}: {self._condition.findings(wanted=False)}", time)
        elif gap < self._nearest:
            self._nearest, self._nearest_text, self._nearest_time = gap, text, time

    def _how_far(self) -> str:
        """The values now, and where they were nearer before, those of then."""
        found = self._condition.findings()
        if not self._nearest_text or self._nearest_text in found:
            return found
        return f"{found}; nearest, at {clock(self._nearest_time)}, {self._nearest_text}"

    def _at_end(self, cut: str) -> CheckResult:
        end = f"was not reached by {clock(self._sim.time)}"
        if cut:
            end += f", where {cut}"
        return self._decide(False, f"{end}: {self._how_far()}")


class Always(Entry):
    """Must hold at every step, as soon as its values are known."""

    def __init__(self, check: Any, view: View) -> None:
        super().__init__(check, view)
        self._condition = Condition(check.expression, view)
        self._since: float | None = None
        self._last = 0.0

    def look(self, time: float) -> None:
        if time < self.check.after - 1e-9:
            return
        try:
            holds = self._condition.holds()
        except Undecided:
            return
        if self._since is None:
            self._since = time
        self._last = time
        if not holds:
            self._decide(False, f"did not hold at {clock(time)}: {self._condition.findings()}", time)

    def _at_end(self, cut: str) -> CheckResult:
        now = clock(self._sim.time)
        if self._since is None:
            reason = self._condition.findings()
            if self._sim.time < self.check.after:
                reason = f"the run ended at {now}, before {clock(self.check.after)}"
            return self._decide(False, f"was never looked at: {reason}")
        if cut:
            return self._decide(False, f"held until {now}, where {cut}")
        found = self._condition.findings(wanted=False)
        if self._last < self._sim.time - 0.5 * self._sim.timestep:
            return self._decide(True, f"held from {clock(self._since)} to {clock(self._last)}, then: {found}")
        return self._decide(True, f"held from {clock(self._since)} to {now}: {found}")


class Final(Entry):
    """Must hold at the end."""

    def __init__(self, check: Any, view: View) -> None:
        super().__init__(check, view)
        self._condition = Condition(check.expression, view)

    def _at_end(self, cut: str) -> CheckResult:
        now = clock(self._sim.time)
        if cut:
            return self._decide(False, f"was not looked at: at {now} {cut}")
        try:
            holds = self._condition.holds()
        except Undecided:
            holds = False
        return self._decide(holds, f"{self._condition.findings(wanted=not holds)} at {now}")


class Apart(Entry):
    """Models or links that must not touch."""

    def __init__(self, check: Any, view: View) -> None:
        from simkit.conditions.touching import Touching

        super().__init__(check, view)
        names, source = check.models, " ".join(map(repr, check.models))
        if not 1 <= len(names) <= 2:
            message = f"SK-COND-009 {len(names)} models are to be apart; allowed are one, that touches nothing, or two"
            raise InputError(message, "SK-COND-009")
        spans, at = [], 0
        for name in names:
            spans.append(Span(at, at + len(repr(name))))
            at = spans[-1].end + 1
        self._touching = Touching(
            view.sim, *(view.scoped(name, source, span) for name, span in zip(names, spans, strict=True))
        )

    def look(self, time: float) -> None:
        if time >= self.check.after - 1e-9 and self._touching.now():
            self._decide(False, f"{self._touching.describe()} at {clock(time)}", time)

    def _at_end(self, cut: str) -> CheckResult:
        now = clock(self._sim.time)
        if cut:
            return self._decide(False, f"nothing touched until {now}, where {cut}")
        if self._sim.time < self.check.after:
            return self._decide(False, f"was never looked at: the run ended at {now}")
        return self._decide(True, f"nothing touched until {now}")
