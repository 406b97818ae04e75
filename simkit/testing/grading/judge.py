"""Judge of a recorded run: it evaluates the checks of an exercise from the stream of the run."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from simkit.run_spec import RunSpec
from simkit.testing.conditions.check_list import CheckList
from simkit.testing.conditions.checks import CheckResult
from simkit.testing.grading import run_stream
from simkit.testing.grading.recorded_view import Key, RecordedNames, RecordedView
from simkit.testing.grading.run_stream import CLOCK, NUMBER, DamagedStreamError, read_json

_KINDS_OF_SOURCES = frozenset(("pose", "twist", "joint", "exists", "contacts", "latest", "count"))
_MOST_SOURCES = 10_000


class RunJudge:
    """Judge of one run.

    Args:
        scenario: Scenario of the run with its checks, from the exercise and not from the hand-in.

    Attributes:
        end: JSON values of the end of the run; None before the end.
    """

    def __init__(self, scenario: RunSpec) -> None:
        self._scenario = scenario
        self._view = RecordedView()
        self._checks: CheckList | None = None
        self._sources: list[Key] = []
        self._steps = 0
        self._foreign: tuple[str, ...] = ()
        self.end: dict[str, Any] | None = None

    @property
    def time(self) -> float:
        """Simulated time of the newest frame [s]."""
        return self._view.clock.time

    def is_over(self) -> bool:
        """Check whether the run has ended: later frames have no meaning."""
        return self.end is not None

    def take(self, kind: int, content: bytes) -> None:
        """Take the next frame.

        Raises:
            DamagedStreamError: The frame is invalid, or does not follow from the ones before.
            InputError: The checks do not fit the recorded world.
        """
        if kind == run_stream.VALUE:
            self._view.set_value(self._source(content), content[NUMBER.size :])
        elif kind == run_stream.STEP:
            self._take_step(content)
        elif kind in (run_stream.OBSERVE, run_stream.BEAT):
            self._set_clock(content)
            if kind == run_stream.OBSERVE:
                self._view.observe("", 100.0)
        elif kind in (run_stream.MESSAGE, run_stream.FEED):
            topic = self._source(content)[1]
            self._set_clock(content[NUMBER.size :])
            if kind == run_stream.MESSAGE:
                self._view.count_message(topic)
            else:
                self._view.observe(topic)
        elif kind == run_stream.SOURCE:
            self._add_source(read_json(content))
        elif kind == run_stream.NAMES:
            self._take_names(RecordedNames.from_json(read_json(content)))
        elif kind == run_stream.END:
            self.end = read_json(content)

    def results(self) -> tuple[Sequence[CheckResult], str]:
        """Return the results of all checks after the end of the run, and the reason if the run has no valid end."""
        if self._checks is None or self.end is None:
            raise DamagedStreamError("it has no steps")
        for topic, rate in dict(self.end.get("rates", {})).items():
            self._view.rates[str(topic)] = None if rate is None else float(rate)
        reason = str(self.end.get("reason", ""))
        if self._checks.ended:
            return self._checks.results("until"), ""
        if reason == "wall_timeout":
            return self._checks.results(reason), ""
        if self.time < self._scenario.longest - 1.5 * self._view.clock.timestep - 1e-9:
            return (), f"the run ended at t = {self.time:.6g} s, before t = {self._scenario.longest:g} s"
        return self._checks.results("timeout" if self._scenario.until else "duration"), ""

    def foreign_text(self) -> str:
        """Return an error text if the hand-in publishes on a topic of the exercise; else an empty text."""
        if not self._foreign:
            return ""
        return f"the hand-in publishes on {', '.join(self._foreign[:3])}, which only the exercise may do"

    # ------------------------------------------------------------------ frames

    def _take_step(self, content: bytes) -> None:
        before = self._view.clock.tick
        self._set_clock(content)
        if self._checks is None:
            self._checks = CheckList(
                self._view, self._scenario.checks, until=self._scenario.until, timeout=self._scenario.longest
            )
            self._checks.begin()
            return
        if self._checks.ended:
            raise DamagedStreamError("the run goes on after its end")
        if self._checks.need_every_step and self._view.clock.tick > before + 1:
            raise DamagedStreamError(f"steps before t = {self.time:.6g} s are missing")
        self._view.observe("", None)
        self._checks.look()

    def _take_names(self, names: RecordedNames) -> None:
        self._foreign = self._foreign or names.foreign
        self._view.set_names(names)
        if self._checks is not None:
            self._checks.bind_waiting()

    def _add_source(self, found: dict[str, Any]) -> None:
        key = found.get("key")
        texts = tuple(text for text in key if isinstance(text, str)) if isinstance(key, list) else ()
        if len(texts) < 2 or texts[0] not in _KINDS_OF_SOURCES or len(self._sources) >= _MOST_SOURCES:
            raise DamagedStreamError("a source is invalid")
        self._sources.append(texts)

    def _source(self, content: bytes) -> Key:
        number = NUMBER.unpack_from(content)[0] if len(content) >= NUMBER.size else len(self._sources)
        if number >= len(self._sources):
            raise DamagedStreamError("a source is unknown")
        return self._sources[number]

    def _set_clock(self, content: bytes) -> None:
        if len(content) != CLOCK.size:
            raise DamagedStreamError("a time is invalid")
        clock = self._view.clock
        clock.tick, clock.time_ns, clock.time = CLOCK.unpack(content)
