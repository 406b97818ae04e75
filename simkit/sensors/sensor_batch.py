"""Sensors of one kind that sample together, so that one call of NumPy computes the readings of all.

A batch changes no bit, no order and no message. Each member samples in its own turn and takes its part of what was
computed at the turn of the first; where somebody has written to the physics in between, it is computed anew.
"""

from __future__ import annotations

import abc
from collections.abc import Callable, Hashable, Sequence
from typing import Generic, TypeVar

import mujoco

from simkit.sensors.sampler import Sampler

MIN_MEMBERS = 4
"""Fewer members are measured one by one in the same time."""

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
            member.batch, member.batch_index = self, place

    @abc.abstractmethod
    def capture_all(self, data: mujoco.MjData) -> None:
        """Capture all members from the data, which have everything computed."""

    @abc.abstractmethod
    def captured(self, place: int) -> object:
        """Return what `capture` would give of a member."""

    def publish_sample(self, member: Sampler, tick: int) -> bool:
        """Make and publish a sample of which every message is waited for; False where the member has to do it."""
        return False

    def is_ready(self, member: Sampler, tick: int) -> bool:
        """Capture all members for a tick, once; False where the member has to do it by itself."""
        physics = self.sim.engine.physics
        if tick != self._tick or physics.edition != self._edition:
            if physics.model is not self.model:  # another structure, and no new schedule yet
                return False
            self.capture_all(member._computed_data())
            # what is looked at may have to be computed first, which changes nothing
            self._tick, self._edition = tick, physics.edition
        return True


def form_batches(
    sensors: Sequence[Member],
    make_batch: Callable[[Sequence[Member]], SensorBatch[Member]],
    key: Callable[[Member], Hashable | None],
) -> None:
    """Make a batch of the sensors that have the same key; one whose key is None samples by itself.

    Args:
        sensors: of one kind.
        make_batch: makes the batch, which tells its members of itself.
        key: what has to be the same for members of one batch.
    """
    groups: dict[Hashable, list[Member]] = {}
    for sensor in sensors:
        sensor.batch = None
        own_key = key(sensor) if sensor.keeps_to_grid else None
        if own_key is not None:
            groups.setdefault((own_key, sensor.update_rate, sensor.timing.phase, sensor.count), []).append(sensor)
    for members in groups.values():
        if len(members) >= MIN_MEMBERS:
            make_batch(members)
