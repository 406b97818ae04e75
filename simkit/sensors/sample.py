"""Sample of a sensor, the messages made from it, and the noise that continues from sample to sample."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from simkit.runtime.engine.physics_state import HeldState


# Measurement of a sensor: the dataclass of the sensor's kind, or an array.
Reading = Any
# Function of a reading and of the reading's time [ns], or of the number of the reading's sample.
ReadingFunction = Callable[[Reading, int], object]
# State of a noise process or sensor that continues from sample to sample: values of its own types, never modified.
Memory = Any
# Sampler that is a member of a batch; the batch module uses this type.
Member = Any


@dataclass(frozen=True, slots=True)
class Product:
    """One kind of message that a sensor can publish.

    Attributes:
        type_name: ROS 2 type.
        make: function `make(reading, time_ns)` that returns the message.
        needs_reading: False if the message contains no measurement; `make` then accepts None as the reading.
    """

    type_name: str
    make: ReadingFunction
    needs_reading: bool = True


class Sample:
    """Sample of a sensor at one due time: its readings, or the physics state from which they are computed later.

    Attributes:
        index: number of the sample; the first is 1.
        held: physics state to measure; None once captured.
        raw: values captured from the state; None once finished.
        truth: reading without noise.
        noisy: reading with noise.
        messages: messages made so far, by product.
        noise_states: states at this sample of the noise processes that change from sample to sample.
        unpublished: products of this sample that are not published.
        surroundings: state besides the physics that the kind measures; None if the kind measures only the physics.
        work: job of another thread on this sample; a reader of the sample waits for it first.
        stamp_ns: time stamp [ns] of the messages with noise if it is not the time of the sample.
    """

    # class attributes, because creating samples without a reader must be fast
    held: HeldState | None = None
    raw: Reading = None
    truth: Reading = None
    noisy: Reading = None
    truth_message: object = None
    noise_states: tuple[object, ...] = ()
    unpublished: tuple[str, ...] = ()
    surroundings: Memory = None
    work: Any = None
    stamp_ns: int | None = None

    def __init__(self, index: int, time_ns: int) -> None:
        self.index, self.time_ns = index, time_ns
        self.messages: dict[str, object] = {}


class NoiseProcess(Protocol):
    """State besides the physics that continues from sample to sample: noise, and any other state that a kind keeps.

    Attributes:
        state: state at the newest sample. Each sample gets a new object, because an older sample that is read later
            has a reference to its own state.
    """

    state: Memory

    @property
    def evolves(self) -> bool:
        """True if `evolve` changes the state."""

    def evolve(self, index: int, dt: float) -> None:
        """Advance by `dt` [s] to sample `index`; `dt` is 0 for the first sample."""

    def restart(self) -> None:
        """Return to t = 0."""

    def set_interval(self, interval: float) -> None:
        """Set the time between samples [s] that the first sample uses, because it has no previous sample."""


class Batch(Protocol):
    """Interface between a sampler and the batch that it belongs to; see `simkit.sensors.sensor_batch`."""

    def is_ready(self, member: Member, tick: int) -> bool:
        """Capture all members once for a tick; return False if the member must capture its own state."""

    def captured(self, member_index: int) -> object:
        """Return the captured values of a member, equal to those that `capture` returns."""

    def publish_sample(self, member: Member, tick: int) -> bool:
        """Make and publish a sample; return False if the member must do so."""
