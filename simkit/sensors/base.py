"""What every sensor shares: when it samples, what it keeps, what it publishes. A kind only says what it measures."""

from __future__ import annotations

import abc
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

from simkit.diagnostics import Diagnostics
from simkit.msgs.topics import valid_topic
from simkit.pose import Pose, Vector
from simkit.sensors.names import entity_topic, given_frame
from simkit.sensors.noise import Noise, NoiseModel, UniformNoise

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Publisher, Simulation
    from simkit.scene import SceneSensor

_READ_BY_ALL = ("always_on", "visualize", "enable_metrics", "pose", "update_rate", "topic")


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


@dataclass(slots=True)
class Sample:
    """One due time: either measured, or the physics state to measure later.

    Attributes:
        index: 1 for the first sample.
        held: the state to measure; None once captured.
        raw: what was captured of the state; None once finished.
        truth: the reading without noise; `noisy` with it.
        messages: made so far, by product.
    """

    index: int
    time_ns: int
    held: Any = None
    raw: Any = None
    truth: Any = None
    noisy: Any = None
    messages: dict[str, Any] = field(default_factory=dict)
    truth_message: Any = None


class Sensor(abc.ABC):
    """A sensor of a model. Derive, name `kinds`, read options in `__init__`, and say what `measure` gives.

    Attributes:
        kinds: `<sensor type>` names in files.
        example: the smallest content that a `<sensor>` of the kind needs besides what all sensors have.
        belongs_to: where it may stand in a file: `link`, `joint` or both.
        is_deferred: whether noise and message of a captured sample may wait until somebody looks.
        needs_acceleration: whether `measure` reads body accelerations or forces between bodies.
        reads_contacts: whether `measure` reads contacts; what rests on a static link with such a sensor never sleeps.
        name, scoped, kind: as in the file.
        update_rate: [Hz]; 0 is every step. Change it with `set_rate`.
        frame_id: of the messages.
        options: the kind's own parameters.
        noise: of its channels, where a kind sets it in `attach`; the base then evolves, restarts and remembers it.
    """

    kinds: ClassVar[tuple[str, ...]] = ()
    example: ClassVar[str] = ""
    belongs_to: ClassVar[tuple[str, ...]] = ("link",)
    needs_acceleration: ClassVar[bool] = False
    reads_contacts: ClassVar[bool] = False
    is_deferred: bool = False

    sim: Simulation
    options: Any = None
    noise: Noise | UniformNoise | None = None

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        self.scene, self.diagnostics = scene, diagnostics
        self.name, self.scoped, self.kind = scene.name, scene.scoped, scene.kind
        self.update_rate = scene.rate
        self.frame_id = given_frame(scene.params) or scene.scoped
        for element in _READ_BY_ALL:
            scene.params.child(element)
        self._topics: dict[str, str] = {}
        self._products: Mapping[str, Product] = {}
        self._publishers: dict[str, Publisher] = {}
        self._ends: list[tuple[str, Publisher, bool]] = []
        self._sample: Sample | None = None
        self._index, self._time_ns = 0, -1

    # ------------------------------------------------------------------ what a kind says

    def describe(self) -> dict[str, Any]:
        """The kind's block in `inspect --json`."""
        return {}

    def build(self, builder: SpecBuilder) -> None:
        """Before the compile: adds what the kind needs to the spec."""

    @abc.abstractmethod
    def products(self) -> dict[str, Product]:
        """The messages it can give; the first is what `latest` shows."""

    @abc.abstractmethod
    def default_topics(self) -> dict[str, str]:
        """Product -> topic, as Gazebo would name it; the first is what `latest` shows."""

    @abc.abstractmethod
    def measure(self, model: Any, data: Any) -> Any:
        """The reading without noise, of data with everything computed; arrays in it are never written to again."""

    def capture(self, model: Any, data: Any) -> Any:
        """What must be taken from the data at once; `finish` makes the reading of it. As a rule that is the reading."""
        return self.measure(model, data)

    def finish(self, raw: Any) -> Any:
        """The reading without noise, of what was captured."""
        return raw

    def perturb(self, reading: Any, index: int) -> Any:
        """The reading with the noise of a sample; the same object where there is none."""
        return reading

    def evolve(self, index: int, dt: float) -> None:
        """Moves noise that has a memory on by `dt` [s] (0 at the first sample), read or not."""
        if self.noise is not None:
            self.noise.evolve(index, dt)

    def restart(self) -> None:
        """Back at t = 0: draws what is drawn once."""
        if self.noise is not None:
            self.noise.restart()

    def memory(self) -> Any:
        """What the kind itself remembers from sample to sample, as values of its own."""
        return None if self.noise is None else self.noise.memory()

    def remember(self, memory: Any) -> None:
        """Takes back what `memory` gave."""
        if self.noise is not None:
            self.noise.remember(memory)

    def accepts(self, tick: int) -> bool:
        """Whether a due time gives a sample."""
        return True

    # ------------------------------------------------------------------ readings

    @property
    def topic(self) -> str:
        """Topic of what `latest` shows."""
        return next(iter(self._topics.values()), "")

    @property
    def latest(self) -> Any | None:
        """The newest message, or None before the first."""
        if self._sample is None:
            return None
        return self._message(self._sample, next(iter(self._topics)))

    @property
    def truth(self) -> Any | None:
        """The newest message as it would be without noise, or None before the first."""
        sample = self._sample
        if sample is None:
            return None
        self._settle(sample)
        if sample.truth_message is None:
            sample.truth_message = self._products[next(iter(self._topics))].make(sample.truth, sample.time_ns)
        return sample.truth_message

    @property
    def pose(self) -> Pose:
        """Of the sensor in the world, now."""
        data = self.sim.fresh_data()
        return Pose(data.xpos[self._body], data.xquat[self._body]) @ self._offset

    def set_rate(self, rate: float) -> None:
        """Samples at `rate` [Hz] from now on; 0 is every step."""
        if not (math.isfinite(rate) and rate >= 0):
            raise ValueError(f"a rate is a number of at least 0 [Hz], got {rate}")
        self.update_rate = float(rate)
        self.sim.reschedule()

    def publish_on(self, topics: Mapping[str, str]) -> None:
        """Publishes these products on these topics, and nothing else (what a sensor plugin does).

        Args:
            topics: product -> absolute topic; the first is what `latest` shows.
        """
        bus = self.sim.bus
        for publisher in self._publishers.values():
            bus.close(publisher)
        self._topics = dict(topics)
        self._publishers = {p: bus.advertise(t, self._products[p].type_name) for p, t in self._topics.items()}
        self._ends = [(p, publisher, self._products[p].needs_reading) for p, publisher in self._publishers.items()]

    # ------------------------------------------------------------------ what the simulation calls

    def prepare(self) -> None:
        """Once, when `sim` is known: makes the noise and whatever else the kind keeps."""

    def attach(self, sim: Simulation) -> None:
        """Once: opens topics and random streams."""
        self.sim = sim
        self.prepare()
        self._products = self.products()
        self.publish_on(self.default_topics())
        self.restart()

    def bind(self, compiled: Any) -> None:
        """Finds itself in a compiled model, also after every change of structure."""
        if self._sample is not None:
            self._settle(self._sample)  # what is held belongs to the model before
            self.sim.bus.settle()  # and so does what waits to be looked at
        self._link_name = self._find_link(compiled.names)
        link = compiled.names.link(self._link_name)
        self._body = int(link.body)
        self._offset: Pose = link.offset @ self.scene.pose_link
        self._offset_position: Vector = self._offset.position
        self._offset_rotation: Vector = self._offset.matrix

    def sample(self, tick: int) -> None:
        """The due tick: measures and publishes where somebody reads, else keeps the physics state."""
        if not self.accepts(tick):
            return
        sim = self.sim
        time_ns = sim.clock.time_ns(tick)
        self._index += 1
        self.evolve(self._index, (time_ns - self._time_ns) * 1e-9 if self._time_ns >= 0 else 0.0)
        self._time_ns = time_ns
        sample = self._sample = Sample(self._index, time_ns)
        wanted = [end for end in self._ends if end[1].wanted]
        needs_reading = False
        for end in wanted:
            needs_reading = needs_reading or end[2]
        if needs_reading:
            data = sim.fresh_acceleration() if self.needs_acceleration else sim.fresh_data()
            sample.raw = self.capture(sim.mj_model, data)
        else:
            sample.held = sim.hold_state()
        for product, publisher, _ in wanted:
            if self.is_deferred:
                publisher.publish_later(partial(self._message, sample, product))
            else:
                publisher.publish(self._message(sample, product))

    def reset(self) -> None:
        """Back at t = 0."""
        self._sample, self._index, self._time_ns = None, 0, -1
        self.restart()

    def get_state(self) -> Any:
        # a sample is only ever completed, never changed, so it may be shared
        return self._index, self._time_ns, self._sample, self.update_rate, self.memory()

    def set_state(self, state: Any) -> None:
        self._index, self._time_ns, self._sample, self.update_rate, memory = state
        self.remember(memory)

    def close(self) -> None:
        """When the simulation closes."""

    def __deepcopy__(self, memo: dict[int, Any]) -> Sensor:
        return self

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.scoped!r}>"

    # ------------------------------------------------------------------ within

    def _make_noise(self, models: Sequence[NoiseModel], group: str) -> Noise:
        """The noise of a few channels, one model each; for `self.noise`."""
        noise = Noise(models, self.sim.streams, self.scoped, group)
        self.is_deferred = not noise.wanders
        return noise

    def _make_uniform_noise(self, model: NoiseModel, width: int, group: str) -> UniformNoise:
        """The same noise on every one of many channels; for `self.noise`."""
        noise = UniformNoise(model, width, self.sim.streams, self.scoped, group)
        self.is_deferred = not noise.wanders
        return noise

    def _default_topic(self, suffix: str) -> str:
        """`<topic>` where the file gives it, else Gazebo's."""
        return valid_topic(self.scene.topic) if self.scene.topic else self._entity_topic(suffix)

    def _entity_topic(self, suffix: str) -> str:
        return entity_topic(self.sim.world.name, self.scene, suffix)

    def _frame_in_world(self, data: Any) -> tuple[Vector, Vector]:
        """Position (3,) [m] and rotation matrix (3, 3) of the sensor."""
        rotation = data.xmat[self._body].reshape(3, 3)
        return data.xpos[self._body] + rotation @ self._offset_position, rotation @ self._offset_rotation

    def _find_link(self, names: Any) -> str:
        """The link that the sensor is on; for a joint's sensor the joint's child link."""
        parent = self.scene.parent
        return str(names.joint(parent).scene.child_link) if self.scene.on_joint else parent

    def _settle(self, sample: Sample) -> None:
        """Measures what was kept, once."""
        if sample.held is not None:
            sample.raw = self.capture(sample.held.model, self.sim.data_of(sample.held))
            sample.held = None
        if sample.raw is not None:
            sample.truth = self.finish(sample.raw)
            sample.noisy = self.perturb(sample.truth, sample.index)
            sample.raw = None

    def _message(self, sample: Sample, product: str) -> Any:
        message = sample.messages.get(product)
        if message is None:
            if self._products[product].needs_reading:
                self._settle(sample)
            message = sample.messages[product] = self._products[product].make(sample.noisy, sample.time_ns)
        return message
