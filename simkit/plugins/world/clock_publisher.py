"""`/clock`: simulated time for whoever runs on it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit import msgs
from simkit.params import Params
from simkit.plugins.base import WorldPlugin

if TYPE_CHECKING:
    from simkit.runtime import Simulation

TYPE = "rosgraph_msgs/msg/Clock"


class ClockPublisher(WorldPlugin):
    """Publishes `rosgraph_msgs/msg/Clock` on `/clock` at 100 Hz of simulated time; part of every world."""

    after_step_rate = 100.0

    def load(self, parent: Simulation, params: Params) -> None:
        self._clock = self.advertise("/clock", TYPE)

    def after_step(self) -> None:
        if self._clock.wanted:
            self._clock.publish(msgs.type_of(TYPE)(msgs.time(self.sim.time_ns)))
