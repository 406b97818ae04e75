"""Artefacts: losses and errors of real sensors that a reading gets beside its noise, such as drop-outs of a lidar.

An artefact is an element of a `<sensor>`: `<simkit:dropout>`. Its class is in the folder `artefacts` of a pack, and
is found by the family of the sensor and the name of the element, as in `lidar/dropout`. The ground truth of a sensor
has no artefacts.
"""

from __future__ import annotations

import abc
import functools
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Final

from simkit.registry import Kinds

if TYPE_CHECKING:
    from simkit.compiler import Compiled, SpecBuilder
    from simkit.params import Params
    from simkit.runtime.engine.random_streams import RandomStream

GROUP: Final = "simkit.artefacts"
# Sensor of an artefact, and its reading; a derived class declares the kinds that it needs.
AnySensor = Any
Reading = Any


class Artefact(abc.ABC):
    """Loss or error of one sensor. To add one: derive, set `elements`, read options in `__init__`, implement `apply`.

    An artefact that has a state which continues from sample to sample also implements `NoiseProcess`, and registers
    itself in `prepare` with `sensor.register_noise`; its state then advances, restarts and is restored with the noise.

    Args:
        params: the element.
        sensor: sensor of the element, whose options are read; its simulation is not known yet.

    Attributes:
        elements: family of sensors and name of the element, such as `lidar/dropout`; the family `any` is all sensors.
        order: place among the artefacts of a sensor, which apply in ascending order; those below 0 apply before the
            noise of the file, all others after it.
        follows_truth: True if the artefact measures the sensor at every sample, in `evolve` of a noise process. The
            samples are then taken one by one, in the physics state of their time.
    """

    elements: ClassVar[tuple[str, ...]] = ()
    order: ClassVar[float] = 1.0
    follows_truth: ClassVar[bool] = False

    def __init__(self, params: Params, sensor: AnySensor) -> None:
        self.params, self.sensor = params, sensor

    def build(self, builder: SpecBuilder) -> None:
        """Find files that the element names, with `builder.find_file`; called before the model is compiled."""

    def prepare(self) -> None:
        """Open random streams and request measurements from the sensor; called once, when `sensor.sim` is known."""

    def bind(self, compiled: Compiled) -> None:
        """Find what the artefact needs in a compiled model; called again after every change of structure."""

    @abc.abstractmethod
    def apply(self, reading: Reading, truth: Reading, index: int) -> Reading:
        """Return the reading with the artefact; the same object if nothing changes.

        Args:
            reading: reading with the artefacts and the noise that apply before this one; it is never modified.
            truth: reading without artefacts and noise.
            index: number of the sample; the first is 1.
        """

    def stream(self, name: str, width: int = 1) -> RandomStream:
        """Return a stream of random numbers with the sensor's seed, drawn by the number of the sample."""
        stream: RandomStream = self.sensor.sim.engine.streams.stream(
            self.sensor.scoped, f"{self.params.name}/{name}", width
        )
        return stream


class MessageArtefact(Artefact):
    """Artefact of the messages of a sensor: it delays, loses or stamps them, and leaves the readings unchanged.

    Attributes:
        keeps_order: True if a message never arrives before an older one.
    """

    keeps_order: bool = True

    def delay(self, index: int) -> float:
        """Return the time [s] that sample `index` needs to arrive, besides the `<latency>` of the sensor."""
        return 0.0

    def is_lost(self, index: int) -> bool:
        """Check whether the newest sample, number `index`, never arrives; called when its noise is known."""
        return False

    def stamp(self, measured_ns: int, arrived_ns: int) -> int:
        """Return the time stamp [ns] of a sample.

        Args:
            measured_ns: stamp without this artefact; the time of the measurement.
            arrived_ns: time at which the message arrives.
        """
        return measured_ns

    def apply(self, reading: Reading, truth: Reading, index: int) -> Reading:
        return reading


@functools.cache
def artefact_kinds() -> Kinds[Artefact]:
    """Return every known class of artefacts by family and element, such as `lidar/dropout`."""
    return Kinds("simkit.sensors.artefacts", GROUP, Artefact, lambda cls: cls.elements, ("elements",))  # type: ignore[type-abstract]


@functools.cache
def artefact_elements() -> frozenset[str]:
    """Return the names of the elements of all known artefacts; no module of them is imported."""
    return frozenset(name.partition("/")[2] for name in artefact_kinds().written)


def read_artefacts(sensor: AnySensor, params: Params, families: Sequence[str]) -> tuple[Artefact, ...]:
    """Make the artefacts of a sensor from the unread elements of its `<sensor>`, in their order.

    Args:
        sensor: the sensor, with its options read.
        params: the `<sensor>`.
        families: families of the sensor.
    """
    found: list[Artefact] = []
    names: set[str] = set()
    for child in params.children:
        if child.was_read or child.name in names:
            continue
        cls = next((kind for family in families if (kind := artefact_kinds().get(f"{family}/{child.name}"))), None)
        if cls is not None:
            names.add(child.name)
            block = params.child(child.name)
            assert block is not None
            found.append(cls(block, sensor))
    return tuple(sorted(found, key=lambda artefact: artefact.order))
