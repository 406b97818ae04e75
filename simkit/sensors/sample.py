"""A sample of a sensor, the messages made from it, and the noise that continues from sample to sample."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from simkit.runtime.engine.physics_state import HeldState


# What a sensor of some kind measures: the kind's own dataclass, or an array.
Reading = Any
# Function of a reading and of its time [ns] or the number of its sample.
ReadingFunction = Callable[[Reading, int], object]
# State of some noise or sensor that continues from sample to sample: values of its own types, never written to.
Memory = Any
# The sampler that is a member of a batch; its own module uses this one.
Member = Any


@dataclass(frozen=True, slots=True)
class Product:
    """One kind of message that a sensor can give.

    Attributes:
        type_name: ROS 2 type.
        make: `make(reading, time_ns)` gives the message.
        needs_reading: False where the message says nothing of the world; its reading may then be None.
    """

    type_name: str
    make: ReadingFunction
    needs_reading: bool = True


class Sample:
    """One due time of a sensor: measured, or with the physics state to measure later.

    Attributes:
        index: 1 for the first sample.
        held: the state to measure; None once captured.
        raw: what was captured of the state; None once finished.
        truth: the reading without noise; `noisy` with it.
        messages: made so far, by product.
        drifts: states of the noise at this sample where they change from sample to sample.
        unpublished: products that are not published of it.
        surroundings: what holds for it besides the physics, where a kind reads more than that.
        work: what another thread does with it; whoever looks at the sample waits for that first.
    """

    # in the class, so that the many samples that nobody looks at are soon made
    held: HeldState | None = None
    raw: Reading = None
    truth: Reading = None
    noisy: Reading = None
    truth_message: object = None
    drifts: tuple[object, ...] = ()
    unpublished: tuple[str, ...] = ()
    surroundings: Memory = None
    work: Any = None

    def __init__(self, index: int, time_ns: int) -> None:
        self.index, self.time_ns = index, time_ns
        self.messages: dict[str, object] = {}


class NoiseProcess(Protocol):
    """State that continues from sample to sample beside the physics: noise, and whatever else a kind keeps.

    Attributes:
        state: what of it depends on the sample; never written to, only replaced, for samples that wait keep theirs.
    """

    state: Memory

    @property
    def wanders(self) -> bool:
        """Whether the state changes from sample to sample."""

    def evolve(self, index: int, dt: float) -> None:
        """Advance by `dt` [s] to sample `index`; 0 where there is no sample before it."""

    def restart(self) -> None:
        """Return to t = 0."""

    def set_interval(self, interval: float) -> None:
        """Set the time between samples [s] that is assumed where nothing else is known."""


class Batch(Protocol):
    """What a sampler needs of the batch that it is a member of; see `simkit.sensors.sensor_batch`."""

    def is_ready(self, member: Member, tick: int) -> bool:
        """Capture all members for a tick, once; False where the member has to do it by itself."""

    def captured(self, place: int) -> object:
        """Return what `capture` would give of a member."""

    def publish_sample(self, member: Member, tick: int) -> bool:
        """Make and publish a sample; False where the member has to do it."""
