"""Groups of samples that are made into messages when they are read, or serialised in one call for a recorder."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

from simkit import msgs
from simkit.msgs.message_types import Message
from simkit.runtime.communication.subscription import LazyMessage
from simkit.runtime.simulation import Simulation
from simkit.sensors.sample import Product, Reading, Sample

MOST_SAMPLES = 4096
"""Number of samples at which a new group begins, because a kept message keeps its whole group in memory."""
_MIN_SAMPLES = 4  # smallest number of samples that are serialised together; fewer one by one take no longer


class GroupedSampler(Protocol):
    """Interface of a sampler that a group needs; see `simkit.sensors.sampler.Sampler`."""

    sim: Simulation
    _index: int
    _products: Mapping[str, Product]

    def _message(self, sample: Sample, product: str) -> Message: ...

    def _end_group(self, group: SampleGroup) -> None: ...

    def pack_samples(self, first: int, times: Sequence[int], captures: Sequence[Reading]) -> Sequence[bytes]: ...


class SampleGroup:
    """Consecutive captured samples of a sensor, whose messages are made or serialised when one of them is needed.

    Args:
        sampler: sensor of the samples; its noise does not depend on earlier samples.
        product: product that is published.

    Attributes:
        product: product that is published.
        ticks, captures: tick and captured values of each sample.
        packed: type and CDR of each message; None until one of them is serialised, empty if they are made one by one.
    """

    def __init__(self, sampler: GroupedSampler, product: str) -> None:
        self._sampler, self.product = sampler, product
        self._first = 0  # number of the first sample
        self.ticks: list[int] = []
        self.captures: list[Reading] = []
        self._samples: dict[int, Sample] = {}
        self.packed: list[tuple[str, bytes]] | None = None
        self._type_name = sampler._products[product].type_name

    def add(self, tick: int, captured: Reading) -> PackedMessage:
        """Add a sample; return its message."""
        position = len(self.ticks)
        if not position:
            self._first = self._sampler._index + 1
        self.ticks.append(tick)
        self.captures.append(captured)
        if position == MOST_SAMPLES - 1:
            self._sampler._end_group(self)
        return PackedMessage(self, position)

    def sample(self, position: int) -> Sample:
        """Return a sample of the group, always the same object."""
        sample = self._samples.get(position)
        if sample is None:
            time_ns = self._sampler.sim.engine.clock.time_ns(self.ticks[position])
            sample = self._samples[position] = Sample(self._first + position, time_ns)
            sample.raw = self.captures[position]
        return sample

    def message(self, position: int) -> Message:
        """Return the message of a sample."""
        return self._sampler._message(self.sample(position), self.product)

    def serialised(self, position: int) -> tuple[str, bytes]:
        """Return the type and the CDR of the message of a sample; the first call serialises all samples."""
        if self.packed is None:
            self._sampler._end_group(self)
            self.packed = [(self._type_name, data) for data in self._pack()]
        return self.packed[position] if self.packed else (self._type_name, msgs.serialize(self.message(position)))

    def _pack(self) -> Sequence[bytes]:
        if len(self.ticks) < _MIN_SAMPLES:
            return ()
        clock = self._sampler.sim.engine.clock
        return self._sampler.pack_samples(self._first, [clock.time_ns(tick) for tick in self.ticks], self.captures)


class PackedMessage(LazyMessage):
    """Message of one sample of a group."""

    __slots__ = ("_group", "_position")
    is_awaited, can_wait, is_ready, work = True, True, True, None

    def __init__(self, group: SampleGroup, position: int) -> None:
        self._group, self._position = group, position

    def get(self) -> Message:
        return self._group.message(self._position)

    def serialised(self) -> object:
        packed = self._group.packed
        return packed[self._position] if packed else self._group.serialised(self._position)
