"""Base of Gazebo Classic's drives that receive a forward speed and a turn rate on a topic."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.plugins.base import ModelPlugin
from simkit.plugins.drives.odometry import COMMAND_TYPES, TrueMotion, command_of

if TYPE_CHECKING:
    from simkit.msgs import Twist, TwistStamped
    from simkit.runtime import Model


class CommandedDrive(ModelPlugin):
    """Drive whose last command stays active until the next."""

    drives = True
    _canonical: str

    def start(self, parent: Model, topic: str, rate: float) -> None:
        """Subscribe to commands, and set the rate [Hz] of both hooks; `load` must call this method first."""
        self.before_step_rate = self.after_step_rate = rate
        self._true = TrueMotion(parent, self.sim.link(self._canonical))
        self._command = (0.0, 0.0)
        self._last_ns = self.sim.time_ns
        self.command_topic = self.ros.topic(topic)
        self.listen(topic, COMMAND_TYPES, self._on_command)

    def _on_command(self, message: Twist | TwistStamped) -> None:
        command = command_of(message)
        if command is None:
            self._once.not_finite()
        else:
            self._command = command

    def _elapsed(self) -> float:
        """Return the time since the last call [s]."""
        now = self.sim.time_ns
        elapsed, self._last_ns = (now - self._last_ns) * 1e-9, now
        return elapsed
