"""What a scenario sends while it runs: its commands, and those of the recording that it plays."""

from __future__ import annotations

from types import TracebackType
from typing import TYPE_CHECKING

from simkit.scenario.scenario import Scenario

if TYPE_CHECKING:
    from simkit.runtime import Simulation
    from simkit.sinks.playback import Playback


class Sender:
    """Sends a scenario's commands at their ticks, from the present one on; a context manager.

    Args:
        scenario: what is sent.
        sim: its world.

    Raises:
        InputError: a command does not fit the world, or the recording cannot be played.
    """

    def __init__(self, scenario: Scenario, sim: Simulation) -> None:
        from simkit.sinks.commands import Commands, commands_of

        self._commands = Commands(sim, commands_of(scenario.commands, sim.topics()))
        self._played: Playback | None = None
        if scenario.recording is not None:
            from simkit.sinks.playback import Playback

            self._played = Playback(sim, scenario.recording, scenario.play_topics)

    def __enter__(self) -> Sender:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._played is not None:
            self._played.close()

    @property
    def next_tick(self) -> int | None:
        """The tick at which something is to be sent next; None when all is sent."""
        ticks = [self._commands.next_tick, None if self._played is None else self._played.next_tick]
        return min((tick for tick in ticks if tick is not None), default=None)

    def send_due(self) -> None:
        """Sends what is due at the present tick.

        Raises:
            InputError: a message does not fit its topic, or the recording breaks off.
        """
        self._commands.send_due()
        if self._played is not None:
            self._played.send_due()
