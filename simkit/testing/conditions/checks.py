"""Checks during a run: one class for each kind of check, and their results."""

from __future__ import annotations

import math
import operator
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Final

from simkit.diagnostics import did_you_mean
from simkit.errors import InputError
from simkit.msgs.topic_names import absolute_name
from simkit.run_spec import Check
from simkit.testing.conditions.binder import bind
from simkit.testing.conditions.bound_expression import BoundNode, findings, value_text
from simkit.testing.conditions.parser import parse
from simkit.testing.conditions.syntax_tree import Comparison, Span, UndecidedValue, expression_error
from simkit.testing.conditions.value_types import TRUTH
from simkit.testing.conditions.world_view import AbsentTopic, WorldView

_EARLY_ENDS: Final = {
    **dict.fromkeys(("duration", "until", "timeout"), ""),
    "wall_timeout": "the run was stopped at its wall-clock limit",
}
"""End of a run -> description, if the run did not end regularly."""


@dataclass(frozen=True)
class CheckResult:
    """Result of one check.

    Attributes:
        check: Check that was evaluated.
        passed: True if the check passed.
        message: Explanation with the measured values.
        time: Simulated time at which the result was known [s].
    """

    check: Check
    passed: bool
    message: str
    time: float


def time_text(time: float) -> str:
    """Format a simulated time for a report."""
    return f"t = {time:.6g} s"


_ORDER_OPERATORS = {"<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge}


class Condition:
    """Expression in a world; an expression with an unknown topic is bound when the topic gets a publisher.

    Args:
        source: Text of the expression.
        view: World.

    Raises:
        InputError: The expression has a syntax error or an unknown name, or is not true or false.
    """

    def __init__(self, source: str, view: WorldView) -> None:
        self.source, self._view = source, view
        self._expression = parse(source)
        self._part: BoundNode | None = None
        self._fault = ""
        self._waiting_reason = self._topic = ""
        self._revision = -1
        self._bind()

    def holds(self) -> bool:
        """Return the present value of the condition.

        Raises:
            UndecidedValue: The value is unknown.
        """
        if self._part is None:
            self.bind_late()
        if self._part is None:
            raise UndecidedValue(self._fault or self._waiting_reason)
        return bool(self._part.get())

    def gap(self) -> tuple[bool, float, str]:
        """Return the value of the condition, the difference of two compared numbers, and a text for reports.

        For other conditions, the difference is NaN and the text is empty.

        Raises:
            UndecidedValue: The value is unknown.
        """
        part = self._part
        node = None if part is None else part.node
        if part is None or not isinstance(node, Comparison) or len(part.below) > 2:
            return self.holds(), math.nan, ""
        holds = _ORDER_OPERATORS.get(node.signs[0])
        if holds is None:
            return self.holds(), math.nan, ""
        left, right = part.below
        a, b = left.get(), right.get()
        return holds(a, b), abs(a - b), f"{left.node.span.text(self.source)} was {value_text(a)}"

    def findings(self, *, expected: bool = True) -> str:
        """Return the values that make the condition true or false."""
        if self._part is None:
            return self._fault or self._waiting_reason
        return ", ".join(findings(self.source, self._part, expected=expected))

    def _bind(self) -> None:
        try:
            part = bind(self._expression, self._view)
        except AbsentTopic as absent:
            self._waiting_reason = str(absent)
            self._topic = absent.topic
            return
        if part.kind is not TRUTH:
            message = f"the expression is {part.kind}, but must be true or false"
            span = part.node.span
            raise expression_error("SK-COND-004", message, self.source, span, "compare it with < <= > >= == !=")
        self._part = part

    def bind_late(self) -> None:
        """Bind the expression when its topic exists. An error in the expression then fails the check, not the run."""
        view = self._view
        if self._part is not None or self._fault or view.topics_revision == self._revision:
            return
        self._revision = view.topics_revision
        if self._topic not in view.all_topics():
            return
        try:
            self._bind()
        except InputError as error:
            self._fault = str(error)


class RunningCheck(ABC):
    """Check during a run.

    Args:
        check: Check.
        view: World.
    """

    def __init__(self, check: Check, view: WorldView) -> None:
        self.check, self._clock = check, view.clock
        self.is_decided = False
        self._result: CheckResult | None = None

    def look(self, time: float) -> None:
        """Evaluate the check after a step at a simulated time [s], until the result is known."""

    def result(self, reason: str) -> CheckResult:
        """Return the result at the end of the run."""
        if self._result is None:
            self._result = self._at_end(_EARLY_ENDS.get(reason, f"the run ended with {reason}"))
        return self._result

    @abstractmethod
    def _at_end(self, early_end: str) -> CheckResult:
        """Return the result of a check that is still open at the end of the run.

        Args:
            early_end: Description of an early end of the run; empty after a regular end.
        """

    def _decide(self, passed: bool, message: str, time: float | None = None) -> CheckResult:
        self.is_decided = True
        self._result = CheckResult(self.check, passed, message, self._clock.time if time is None else time)
        return self._result


class ConditionCheck(RunningCheck):
    """Check that evaluates a condition.

    Attributes:
        condition: Condition.
    """

    def __init__(self, check: Check, view: WorldView) -> None:
        super().__init__(check, view)
        self.condition = Condition(check.expression, view)


class ReachedCheck(ConditionCheck):
    """Condition that must be true once."""

    _nearest, _nearest_text, _nearest_time = math.inf, "", 0.0

    @property
    def is_reached(self) -> bool:
        """True if the condition was true."""
        return self._result is not None and self._result.passed

    def look(self, time: float) -> None:
        by = self.check.by
        if by is not None and time > by + 1e-9:
            self._decide(False, f"was not reached by {time_text(by)}: {self._nearest_values()}", by)
            return
        try:
            holds, gap, text = self.condition.gap()
        except UndecidedValue:
            return
        if holds:
            self._decide(True, f"was reached at {time_text(time)}: {self.condition.findings(expected=False)}", time)
        elif gap < self._nearest:
            self._nearest, self._nearest_text, self._nearest_time = gap, text, time

    def _nearest_values(self) -> str:
        """Return the present values, and earlier values if these were nearer to the goal."""
        present = self.condition.findings()
        if not self._nearest_text or self._nearest_text in present:
            return present
        return f"{present}; nearest at {time_text(self._nearest_time)}: {self._nearest_text}"

    def _at_end(self, early_end: str) -> CheckResult:
        end = f"was not reached by {time_text(self._clock.time)}" + (f", when {early_end}" if early_end else "")
        return self._decide(False, f"{end}: {self._nearest_values()}")


class AlwaysCheck(ConditionCheck):
    """Condition that must be true at every step, from the first step at which its values are known."""

    _since: float | None = None
    _last = 0.0

    def look(self, time: float) -> None:
        if time < self.check.after - 1e-9:
            return
        try:
            holds = self.condition.holds()
        except UndecidedValue:
            return
        if self._since is None:
            self._since = time
        self._last = time
        if not holds:
            self._decide(False, f"did not hold at {time_text(time)}: {self.condition.findings()}", time)

    def _at_end(self, early_end: str) -> CheckResult:
        now = time_text(self._clock.time)
        if self._since is None:
            reason = self.condition.findings()
            if self._clock.time < self.check.after:
                reason = f"the run ended at {now}, before {time_text(self.check.after)}"
            return self._decide(False, f"was never evaluated: {reason}")
        if early_end:
            return self._decide(False, f"held until {now}, when {early_end}")
        values = self.condition.findings(expected=False)
        if self._last < self._clock.time - 0.5 * self._clock.timestep:
            return self._decide(True, f"held from {time_text(self._since)} to {time_text(self._last)}, then: {values}")
        return self._decide(True, f"held from {time_text(self._since)} to {now}: {values}")


class FinalCheck(ConditionCheck):
    """Condition that must be true at the end."""

    def _at_end(self, early_end: str) -> CheckResult:
        now = time_text(self._clock.time)
        if early_end:
            return self._decide(False, f"was not evaluated: at {now} {early_end}")
        try:
            holds = self.condition.holds()
        except UndecidedValue:
            holds = False
        return self._decide(holds, f"{self.condition.findings(expected=not holds)} at {now}")


class SeparationCheck(RunningCheck):
    """Model or link without contacts, or two of them that must not touch each other."""

    def __init__(self, check: Check, view: WorldView) -> None:
        super().__init__(check, view)
        names, source = check.models, " ".join(map(repr, check.models))
        if not 1 <= len(names) <= 2:
            message = f"the check 'apart' has {len(names)} models; expected one or two"
            raise InputError("SK-COND-009", message)
        spans, at = [], 0
        for name in names:
            spans.append(Span(at, at + len(repr(name))))
            at = spans[-1].end + 1
        self._touching = view.contacts(
            *(view.scoped_name(name, source, span) for name, span in zip(names, spans, strict=True))
        )

    def look(self, time: float) -> None:
        if time >= self.check.after - 1e-9 and self._touching.now():
            self._decide(False, f"{self._touching.describe()} at {time_text(time)}", time)

    def _at_end(self, early_end: str) -> CheckResult:
        now = time_text(self._clock.time)
        if early_end:
            return self._decide(False, f"no contact until {now}, when {early_end}")
        if self._clock.time < self.check.after:
            return self._decide(False, f"was never evaluated: the run ended at {now}")
        return self._decide(True, f"no contact until {now}")


_MAX_LATENESS = 2.5  # a topic counts as stopped after this number of periods without a message


class TopicRateCheck(RunningCheck):
    """Message rate between the first and the last message; a topic that stops before the end fails the check."""

    def __init__(self, check: Check, view: WorldView) -> None:
        super().__init__(check, view)
        if not check.topic:
            raise InputError("SK-COND-009", "a rate check has no topic")
        self._topic = absolute_name(check.topic)
        self._counter, self._view = view.message_counter(self._topic), view

    def _at_end(self, early_end: str) -> CheckResult:
        clock, counter, check = self._clock, self._counter, self.check
        now = time_text(clock.time)
        if early_end:
            return self._decide(False, f"{counter.count} messages received until {now}, when {early_end}")
        if not counter.count:
            topics = self._view.all_topics()
            if self._topic in topics:
                return self._decide(False, f"no message received on {self._topic} until {now}")
            near = did_you_mean(self._topic, topics)
            return self._decide(False, f"no publisher on {self._topic}" + (f"; {near}" if near else ""))
        target = check.rate if check.rate is not None else self._view.configured_rate(self._topic)
        rate = counter.rate()
        first, last = time_text(counter.first / 1e9), time_text(counter.last / 1e9)
        if rate is None:
            message = f"only one message received on {self._topic} until {now}, at {last}"
            return self._decide(
                False, message if counter.count == 1 else f"{counter.count} messages received, all at {last}"
            )
        text = f"{self._topic}: {rate:.6g} Hz ({counter.count} messages from {first} to {last})"
        if target is None:
            target, expected = rate, ""
        else:
            expected = f", expected {target:.6g} Hz"
        if abs(rate - target) > check.tolerance * target:
            return self._decide(False, f"{text}{expected} ± {check.tolerance * 100:.3g} %")
        if clock.time - counter.last / 1e9 > _MAX_LATENESS / target + 1.5 * clock.timestep:
            return self._decide(False, f"{text}, and no further message until {now}")
        return self._decide(True, text + expected)
