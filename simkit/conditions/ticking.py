"""Topics that must tick at their rate."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from simkit.conditions.entries import Entry
from simkit.conditions.results import CheckResult, clock
from simkit.diagnostics import did_you_mean
from simkit.errors import InputError
from simkit.runtime.topics import absolute

if TYPE_CHECKING:
    from simkit.conditions.view import View
    from simkit.runtime import Simulation

_LATE = 2.5  # periods without a message after which a topic has stopped


def set_rate(sim: Simulation, topic: str) -> float | None:
    """The rate that what publishes on a topic is set to [Hz], of several together; None where that is not known."""
    owners: list[Any] = [sensor for sensor in sim.structure.all_sensors() if topic in sensor._topics.values()]
    if not owners:
        for _, end, _, what in sim.bus.ends(topic):
            if what == "publishes" and end.active:
                owners.append(None if getattr(end, "latched", False) else end.owner)
    rates = [_rate_of(owner, sim.timestep) for owner in owners]
    return sum(rate for rate in rates if rate is not None) if rates and None not in rates else None


def _rate_of(owner: Any, timestep: float) -> float | None:
    """Of a sensor its update rate, where zero is every step; of a plugin that of its hook after steps."""
    rate = getattr(owner, "update_rate", None)
    if isinstance(rate, (int, float)) and hasattr(owner, "scoped") and hasattr(owner, "sample"):
        return min(float(rate), 1.0 / timestep) if rate > 0 else 1.0 / timestep
    rate = getattr(owner, "after_step_rate", None)
    return float(rate) if isinstance(rate, (int, float)) and rate > 1e-3 else None


class Ticking(Entry):
    """Messages per simulated second, from the first to the last; a topic that stops before the end has failed."""

    def __init__(self, check: Any, view: View) -> None:
        super().__init__(check, view)
        if not check.topic:
            raise InputError("SK-COND-009 a check of a rate names no topic", "SK-COND-009")
        self._topic = absolute(check.topic)
        self._tally = view.tally(self._topic)

    def _at_end(self, cut: str) -> CheckResult:
        sim, tally, check = self._sim, self._tally, self.check
        now = clock(sim.time)
        if cut:
            return self._decide(False, f"{tally.count} messages came until {now}, where {cut}")
        if not tally.count:
            topics = sim.bus.all_topics()
            if self._topic in topics:
                return self._decide(False, f"no message came on {self._topic} until {now}")
            near = did_you_mean(self._topic, topics)
            return self._decide(False, f"nobody publishes on {self._topic}" + (f"; {near}" if near else ""))
        wanted = check.rate if check.rate is not None else set_rate(sim, self._topic)
        found = tally.rate()
        first, last = clock(tally.first / 1e9), clock(tally.last / 1e9)
        if found is None:
            message = f"one message came on {self._topic}, at {last}, until {now}"
            return self._decide(False, message if tally.count == 1 else f"{tally.count} messages came, all at {last}")
        text = f"{self._topic}: {found:.6g} Hz ({tally.count} messages from {first} to {last})"
        if wanted is None:
            wanted, asked = found, ""
        else:
            asked = f", wanted are {wanted:.6g} Hz"
        if abs(found - wanted) > check.tolerance * wanted:
            return self._decide(False, f"{text}{asked} ± {check.tolerance * 100:.3g} %")
        if sim.time - tally.last / 1e9 > _LATE / wanted + 1.5 * sim.timestep:
            return self._decide(False, f"{text}, and none from then until {now}")
        return self._decide(True, text + asked)
