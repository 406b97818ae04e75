"""What a sensor samples: a due time with what was measured then, the messages it gives, and what goes on between."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol


@dataclass(frozen=True, slots=True)
class Product:
    """One kind of message that a sensor can give.

    Attributes:
        type_name: ROS 2 type.
        make: `make(reading, time_ns)` gives the message.
        needs_reading: False where the message says nothing of the world; its reading may then be None.
    """

    type_name: str
    make: Callable[[Any, int], Any]
    needs_reading: bool = True


class Sample:
    """One due time: either measured, or the physics state to measure later.

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
    held: Any = None
    raw: Any = None
    truth: Any = None
    noisy: Any = None
    truth_message: Any = None
    drifts: tuple[Any, ...] = ()
    unpublished: tuple[str, ...] = ()
    surroundings: Any = None
    work: Any = None

    def __init__(self, index: int, time_ns: int) -> None:
        self.index, self.time_ns = index, time_ns
        self.messages: dict[str, Any] = {}


class NoiseProcess(Protocol):
    """What goes on from sample to sample beside the physics: noise, and whatever else a kind remembers.

    Attributes:
        state: what of it depends on the sample; never written to, only replaced, for samples that wait keep theirs.
    """

    state: Any

    @property
    def wanders(self) -> bool:
        """Whether the state changes from sample to sample."""

    def evolve(self, index: int, dt: float) -> None:
        """Moves on by `dt` [s] to sample `index`; 0 where there is no sample before it."""

    def restart(self) -> None:
        """Back at t = 0."""

    def set_interval(self, interval: float) -> None:
        """Says that samples are `interval` [s] apart from now on, if nothing else is known of one."""

    def memory(self) -> Any:
        """What `remember` takes back."""

    def remember(self, memory: Any) -> None:
        """Takes back what `memory` gave."""


class Batch(Protocol):
    """What a sampler needs of the batch that it is a member of; see `simkit.sensors.batch`."""

    def is_ready(self, member: Any, tick: int) -> bool:
        """Capture all members for a tick, once; False where the member has to do it by itself."""

    def captured(self, place: int) -> Any:
        """Return what `capture` would give of a member."""

    def publish_sample(self, member: Any, tick: int) -> bool:
        """Make and publish a sample; False where the member has to do it."""
