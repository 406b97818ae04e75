"""Sensors of one kind that sample together: what one call of NumPy gives for all of them is not computed one by one.

A crew changes no bit, no order and no message. Each member samples in its own turn and takes its part of what was
computed at the turn of the first; where somebody has written to the physics in between, it is computed anew.
"""

from __future__ import annotations

import abc
from collections.abc import Callable, Hashable, Sequence
from typing import TYPE_CHECKING, Any, Generic, TypeVar

if TYPE_CHECKING:
    from simkit.sensors.sampler import Sampler

MIN_MEMBERS = 4
"""So few members are as soon measured one by one."""

Member = TypeVar("Member", bound="Sampler")


class SensorBatch(abc.ABC, Generic[Member]):
    """Members of one kind that are due at the same ticks.

    Args:
        members: bound to the same model.

    Attributes:
        model: that they are bound to.
    """

    def __init__(self, members: Sequence[Member]) -> None:
        self.members, self.sim = list(members), members[0].sim
        self.model = self.sim.mj_model
        self._tick = self._edition = -1
        for place, member in enumerate(self.members):
            member.crew, member.place_in_crew = self, place

    @abc.abstractmethod
    def look(self, data: Any) -> None:
        """Takes what all members need from the data, which have everything computed."""

    @abc.abstractmethod
    def raw_of(self, place: int) -> Any:
        """What `capture` would give of a member."""

    def serve(self, member: Sampler, tick: int) -> bool:
        """Does all that there is to a sample of which every message is waited for; False where the member has to."""
        return False

    def is_ready(self, member: Sampler, tick: int) -> bool:
        """Sees to it that all is taken for a tick; False where the member has to do it by itself."""
        physics = self.sim.physics
        if tick != self._tick or physics.edition != self._edition:
            if physics.model is not self.model:  # another structure, and no new schedule yet
                return False
            self.look(member._data_now())
            # what is looked at may have to be computed first, which changes nothing
            self._tick, self._edition = tick, physics.edition
        return True


def form_batches(
    sensors: Sequence[Member],
    crew: Callable[[Sequence[Member]], SensorBatch[Member]],
    key: Callable[[Member], Hashable | None],
) -> None:
    """Makes crews of those that have the same key; None is for who works alone."""
    groups: dict[Hashable, list[Member]] = {}
    for sensor in sensors:
        sensor.crew = None
        of = key(sensor) if sensor.keeps_to_grid else None
        if of is not None:
            groups.setdefault((of, sensor.update_rate, sensor.timing.phase, sensor.count), []).append(sensor)
    for members in groups.values():
        if len(members) >= MIN_MEMBERS:
            crew(members)
