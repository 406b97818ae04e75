"""Batches of sensors of one kind that sample together: one NumPy call computes the readings of all members.

A batch changes no bit, no order and no message. Each member samples in its own turn. The first member's turn computes
the readings of all members, and each later member takes its part. If the physics state is modified in between, the
readings are computed again.
"""

from __future__ import annotations

import abc
from collections.abc import Callable, Hashable, Sequence
from typing import Generic, TypeVar

import mujoco

from simkit.sensors.sampler import Sampler

MIN_MEMBERS = 4
"""Smallest size of a batch: measuring fewer members one by one takes no longer."""

Member = TypeVar("Member", bound="Sampler")


class SensorBatch(abc.ABC, Generic[Member]):
    """Members of one kind that are due at the same ticks.

    Args:
        members: sensors bound to the same model.

    Attributes:
        model: model that the members are bound to.
    """

    def __init__(self, members: Sequence[Member]) -> None:
        self.members, self.sim = list(members), members[0].sim
        self.model = self.sim.mj_model
        self._tick = self._edition = -1
        for index, member in enumerate(self.members):
            member.batch, member.batch_index = self, index

    @abc.abstractmethod
    def capture_all(self, data: mujoco.MjData) -> None:
        """Capture all members from data in which everything that they need is computed."""

    @abc.abstractmethod
    def captured(self, member_index: int) -> object:
        """Return the captured values of a member, equal to those that `capture` returns."""

    def publish_sample(self, member: Sampler, tick: int) -> bool:
        """Make and publish a sample if readers wait for all its messages; return False if the member must do so."""
        return False

    def is_ready(self, member: Sampler, tick: int) -> bool:
        """Capture all members once for a tick; return False if the member must capture its own state."""
        physics = self.sim.engine.physics
        if tick != self._tick or physics.edition != self._edition:
            if physics.model is not self.model:  # the structure has changed and the batches are not rebuilt yet
                return False
            self.capture_all(member.computed_data())
            # computing the data may change the edition but no value, so the edition is read afterwards
            self._tick, self._edition = tick, physics.edition
        return True


def form_batches(
    sensors: Sequence[Member],
    make_batch: Callable[[Sequence[Member]], SensorBatch[Member]],
    key: Callable[[Member], Hashable | None],
) -> None:
    """Make a batch of the sensors that have the same key; a sensor whose key is None samples alone.

    Args:
        sensors: sensors of one kind.
        make_batch: function that makes a batch, which sets `batch` of its members.
        key: function that returns the properties that members of one batch have in common.
    """
    groups: dict[Hashable, list[Member]] = {}
    for sensor in sensors:
        sensor.batch = None
        if len(sensors) < MIN_MEMBERS:
            continue
        own_key = key(sensor) if sensor.keeps_to_grid else None
        if own_key is not None:
            groups.setdefault((own_key, sensor.update_rate, sensor.timing.phase, sensor.count), []).append(sensor)
    for members in groups.values():
        if len(members) >= MIN_MEMBERS:
            make_batch(members)
