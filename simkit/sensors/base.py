"""Base class of all sensors: it samples, keeps and publishes readings; each kind defines its measurement."""

from __future__ import annotations

import abc
import math
import re
from collections.abc import Callable, Mapping, Sequence
from itertools import chain
from typing import Any, ClassVar, Generic, TypeVar

import mujoco
import numpy as np

from simkit import msgs
from simkit.argument_checks import checked_number
from simkit.compiler import Compiled, SpecBuilder
from simkit.compiler.name_map import NameMap
from simkit.diagnostic_record import TEXT_SOURCE
from simkit.diagnostics import Diagnostics, Severity, Where
from simkit.errors import InputError
from simkit.linear_algebra import matmul
from simkit.msgs.message_types import M, Message
from simkit.msgs.notebook_pictures import reading_html
from simkit.msgs.topic_names import valid_topic
from simkit.packs import is_shipped
from simkit.params import Params
from simkit.pose import Pose, Vector
from simkit.runtime import Simulation
from simkit.runtime.array_rules import CannotBatchError, SensorRule, array_rule_of
from simkit.runtime.communication.publisher import Tally
from simkit.runtime.engine.random_streams import RandomStreams
from simkit.runtime.engine.simulated_time import TickGrid
from simkit.scene import SceneSensor
from simkit.sensors.artefacts import MessageArtefact, read_artefacts
from simkit.sensors.noise import NO_NOISE, Noise, NoiseModel, SettableNoise, UniformNoise
from simkit.sensors.sample import NoiseProcess, Product, Reading, Sample
from simkit.sensors.sample_times import DelayedReadings, SampleTimes, read_timing
from simkit.sensors.sampler import Sampler
from simkit.sensors.topics_and_frames import check_topic, entity_topic, read_frame_id

__all__ = ["Product", "Sample", "Sensor"]


_COMMON_ELEMENTS = ("visualize", "pose", "update_rate", "topic")
_RATE_TYPE = "std_msgs/msg/Float64"
_BODY = int(mujoco.mjtObj.mjOBJ_XBODY)

AnyNoiseProcess = TypeVar("AnyNoiseProcess", bound=NoiseProcess)


class Sensor(Sampler, Generic[M]):
    """Sensor of a model. To add a kind: derive, set `kinds`, override `read_options` and implement `measure`.

    The type parameter is the class of `latest` and `truth`, with the kind's default topics.

    Attributes:
        kinds: `<sensor type>` names in files.
        example: smallest content that a `<sensor>` of the kind needs besides the elements common to all sensors.
        belongs_to: parent elements in a file: `link`, `joint` or both.
        is_deferred: True if noise and message of a captured sample may be computed later, when they are read.
        gathers: True if the captured values are so small that the sensor may capture many samples before it makes
            their messages. It does so only while no callback waits for the messages.
        needs_acceleration: True if `measure` reads body accelerations or forces between bodies.
        reads_contacts: True if `measure` reads contacts. Bodies that rest on a static link with such a sensor never
            sleep.
        needs_renderer: True if the readings are drawn images.
        sees_scene: True if other objects can change a reading without contact, as for cameras and rays. Plugins that
            move scenery then move it before each sample.
        has_dynamic_bias: True if the bias of this kind drifts in Gazebo, which then passes the time between samples to
            the noise.
        artefact_families: families of artefacts that the kind can have, besides `any`.
        name, scoped, kind: names as in the file.
        update_rate: rate [Hz]; 0 is every step. Change it with `set_rate`.
        frame_id: frame of the messages.
        options: parameters of the kind.
        noise: noise of the channels, if the kind sets it in `prepare`. The base class advances, restarts and saves
            this noise. During a run, a `NoiseModel`, one for each channel, or a standard deviation may be set.
    """

    kinds: ClassVar[tuple[str, ...]] = ()
    example: ClassVar[str] = ""
    belongs_to: ClassVar[tuple[str, ...]] = ("link",)
    needs_renderer: ClassVar[bool] = False
    sees_scene: ClassVar[bool] = True
    has_dynamic_bias: ClassVar[bool] = False
    artefact_families: ClassVar[tuple[str, ...]] = ()

    _names_for_users: ClassVar[tuple[str, ...]] = (
        *("name", "scoped", "kind", "topic", "topics", "frame_id", "update_rate", "set_rate", "pose"),
        *("latest", "truth", "noise", "options", "sim"),
    )
    options: Any = None
    noise: Any = SettableNoise()

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__()
        self.scene, self.diagnostics = scene, diagnostics
        self.name, self.scoped, self.kind = scene.name, scene.scoped, scene.kind
        self.update_rate = scene.rate
        self.frame_id = read_frame_id(scene.params) or scene.scoped
        for element in _COMMON_ELEMENTS:
            scene.params.child(element)
        self._read_common(scene)
        self.options = self.read_options(scene.params)
        self._set_artefacts(read_artefacts(self, scene.params, (*self.artefact_families, "any")))

    def _read_common(self, scene: SceneSensor) -> None:
        params = scene.params
        check_topic(scene.topic, params)
        params.boolean("always_on", True)
        if params.boolean("enable_metrics", False):
            message = "<enable_metrics> publishes nothing here: wall-clock rates would differ from run to run"
            params.diagnostics.note("SK-SENSOR-025", message, params.block("enable_metrics").where, "simkit bench")
        self.timing = read_timing(params, scene.rate)
        check_topic(self.timing.set_rate_topic, params, "set_rate_topic")

    def __dir__(self) -> list[str]:
        """Return the names that users read or call, for completion: those of all kinds and those that the kind adds.

        A kind of a user adds all its names, a kind of simkit those in `_names_for_users`.
        """
        names: set[str] = set()
        for cls in type(self).__mro__[: type(self).__mro__.index(Sensor) + 1]:
            names.update(vars(cls).get("_names_for_users", ()))
            if re.match(r"simkit\b|simkit_", cls.__module__) is None:
                names.update(name for name in vars(cls) if not name.startswith("_") and not hasattr(Sensor, name))
        return sorted(names)

    # ------------------------------------------------------------------ methods that a kind overrides

    def read_options(self, params: Params) -> object:
        """Read the kind's own options from its `<sensor>`; called once, at the end of `__init__`."""
        return self.options

    def describe(self) -> dict[str, object]:
        """Return the kind's own data for `simkit inspect --json`."""
        return {}

    def build_with_artefacts(self, builder: SpecBuilder) -> None:
        """Add what kind and artefacts need to MuJoCo's specification, before it is compiled."""
        self.build(builder)
        for artefact in self.artefacts:
            artefact.build(builder)

    def build(self, builder: SpecBuilder) -> None:
        """Add what the kind needs to MuJoCo's specification, before it is compiled."""

    @abc.abstractmethod
    def products(self) -> dict[str, Product]:
        """Return the messages that the kind can publish, by product; `latest` shows the first product."""

    def default_topics(self) -> dict[str, str]:
        """Return Gazebo's default topic of each product; by default only of the first one, which it is named after."""
        first = next(iter(self.products()))
        return {first: self._default_topic(first)}

    def array_rule(self) -> SensorRule | None:
        """Return what the sensor reads in many simulations at once, which a batch of environments needs.

        The method does not hold for derived classes. Without it, a world with an observation of the sensor is not
        batched.

        Raises:
            CannotBatchError: the sensor cannot be computed as arrays with its present options.
        """
        return None

    # ------------------------------------------------------------------ readings

    def make_first_message(self, reading: Reading, time_ns: int) -> Message:
        """Return the message of a reading that `latest` would show."""
        return self._products[next(iter(self._topics))].make(reading, time_ns)

    @property
    def topics(self) -> Mapping[str, str]:
        """Topic of each product that is published."""
        return self._topics

    def product_type(self, product: str) -> str:
        """Return the ROS type of a product."""
        return self._products[product].type_name

    @property
    def topic(self) -> str:
        """Topic of the message that `latest` shows."""
        return next(iter(self._topics.values()), "")

    @property
    def latest(self) -> M | Any:  # `Any` stands for None, so that a type checker asks for no check
        """Newest message that has arrived, or None before the first."""
        self.sim.engine.check_open()
        if self._sample is None:
            return None
        return self._message(self._sample, next(iter(self._topics)))

    @property
    def truth(self) -> M | Any:  # as `latest`
        """Newest message without noise, or None before the first."""
        self.sim.engine.check_open()
        sample = self._finished_sample()
        if sample is None:
            return None
        if sample.truth_message is None:
            sample.truth_message = self._make_message(sample, next(iter(self._topics)), sample.truth, sample.time_ns)
        return sample.truth_message

    def _finished_sample(self) -> Sample | None:
        """Return the newest sample with its readings, or None before the first."""
        sample = self._sample
        if sample is not None:
            self._finish_sample(sample)
        return sample

    def _true_reading(self) -> Reading | None:
        """Return the newest reading without noise, or None before the first."""
        sample = self._finished_sample()
        return None if sample is None else sample.truth

    @property
    def body(self) -> int:
        """MuJoCo's body of the sensor's link."""
        return self._body

    @property
    def pose(self) -> Pose:
        """Current pose of the sensor in the world."""
        self.sim.engine.check_open()
        data = self.sim.engine.physics.fresh()
        return Pose(data.xpos[self._body], data.xquat[self._body]) @ self._offset

    def set_rate(self, rate: float) -> None:
        """Sample at `rate` [Hz] from now on; 0 samples at every step. The grid of samples still begins at t = 0.

        Raises:
            ValueError: the rate is negative, NaN or infinite.
            InputError: SK-SENSOR-203 the sensor cannot measure at this rate.
        """
        rate = checked_number(rate, "rate", 0.0, unit="Hz")
        self.sim.engine.check_open()
        problem = self.rate_problem(rate)
        if problem:
            raise InputError("SK-SENSOR-203", f"sensor {self.scoped!r} cannot sample at {rate:g} Hz: {problem}")
        self.sim.communication.bus.settle()
        if self._noises and self._sample is not None:
            self.latest  # noqa: B018 - make this message now, because it may contain the rate of its sample
        self._apply_rate(rate)
        self.sim.engine.reschedule()

    def rate_problem(self, rate: float) -> str:
        """Return why the sensor cannot measure at a rate [Hz]; empty if it can."""
        return ""

    def optical_frames(self) -> dict[str, Pose]:
        """Return the poses of all other frames that the messages name, in the sensor's frame."""
        return {}

    def publish_on(self, topics: Mapping[str, str]) -> None:
        """Publish these products on these topics instead of the default ones, as a sensor plugin does.

        A second plugin on the same sensor adds its topics to those of the first.

        Args:
            topics: absolute topic of each product; `latest` shows the first product.
        """
        if not self._has_plugin_topics:
            for _, publisher, _ in self._publishers:
                self.sim.communication.bus.close(publisher)
            self._topics, self._publishers = {}, []
            self._has_plugin_topics = True
        self._open(topics)

    def _open(self, topics: Mapping[str, str]) -> None:
        self._revision = -1
        for product, topic in topics.items():
            spec = self._products[product]
            check = self.check_available if spec.needs_reading and self.needs_renderer else None
            publisher = self.sim.communication.bus.advertise(
                topic, spec.type_name, check=check, pending=self._process_pending
            )
            publisher.tally = self.tally
            self._topics.setdefault(product, publisher.topic)
            self._publishers.append((product, publisher, spec.needs_reading))

    def tally(self) -> Tally | None:
        """Return the number of samples, each of which is a message; None if a sample may have no message.

        It is also None for a kind of the user: its measurements are made when the messages are counted, so that an
        error in them ends the run.
        """
        selects = self._selects_ticks or self._selects_products_of_sample or self._overrides("sample")
        is_irregular = self._delayed is not None or self.lasting is not None or self.is_manual
        if selects or is_irregular or self._message_artefacts or not is_shipped(type(self)):
            return None
        return self.count, self._time_ns, self.timetable()

    # ------------------------------------------------------------------ methods that the simulation calls

    def prepare(self) -> None:
        """Make the noise and any other state of the kind; called once, when `sim` is known."""

    def attach(self, sim: Simulation) -> None:
        """Open topics and random streams; called once."""
        self.sim = sim
        options, quirks = self.timing, sim.world.gazebo_quirks
        self._times = SampleTimes(options, sim.engine.clock, sim.engine.streams, self.scoped, in_milliseconds=quirks)
        delays, keeps_order = self._message_delays()
        if options.latency > 0 or delays or self.lasting is not None:
            origin = options, sim.engine.clock, sim.engine.streams, self.scoped
            self._delayed = DelayedReadings(*origin, delays, keeps_order)
        self._report_timing(sim)
        if options.set_rate_topic:
            sim.communication.bus.listen(valid_topic(options.set_rate_topic), (_RATE_TYPE,), self._on_rate)
        self.prepare()
        if self.noise is not None:
            self.register_noise(self.noise)  # a kind may make its noise without `_make_noise`
        for artefact in self.artefacts:
            artefact.prepare()
            self.is_deferred = True
        self._products = self.products()
        self._open(self.default_topics())
        self.restart()

    def _message_delays(self) -> tuple[list[Callable[[int], float]], bool]:
        """Return the functions of the artefacts that delay messages, and whether messages keep their order."""
        late = [a for a in self._message_artefacts if type(a).delay is not MessageArtefact.delay]
        return [artefact.delay for artefact in late], all(artefact.keeps_order for artefact in late)

    def _report_timing(self, sim: Simulation) -> None:
        """Report options that are impossible with the length of a step."""
        rate, jitter, step = self.update_rate, self.timing.jitter, sim.timestep
        if self._times.is_too_fast(rate):
            message = f"sensor {self.scoped!r}: {rate:g} Hz is more than the {1 / step:g} steps a second"
            sim.engine.reports.note("SK-SENSOR-028", f"{message}; it samples at every step", self.scene.where)
        if 0 < jitter < 0.5 * step:
            message = f"sensor {self.scoped!r}: <jitter>{jitter:g}</jitter> is less than half a step of {step:g} s"
            sim.engine.reports.warning("SK-SENSOR-023", f"{message} and has no effect", self.scene.where)

    def set_frame_id(self, frame: str) -> None:
        """Set the frame of the messages of all later samples."""
        self._make_pending_messages()
        if self._sample is not None and not self.needs_renderer:
            self.latest  # noqa: B018 - made now, because it has the frame of its sample
        self.frame_id = frame

    def _make_pending_messages(self) -> None:
        """Make the messages of earlier samples with the present noise, frame and options."""
        for _, publisher, _ in self._publishers:
            self.sim.communication.bus.settle_topic(publisher.topic)

    def bind(self, compiled: Compiled) -> None:
        """Find the sensor in a compiled model; called again after every change of structure."""
        self._finish_kept_samples()  # the physics states of the samples belong to the previous model
        self._link_name = self._find_link(compiled.names)
        link = compiled.names.link(self._link_name)
        self._body = int(link.body)
        self._offset: Pose = link.offset @ self.scene.pose_link
        self._offset_position: Vector = self._offset.position
        self._offset_rotation: Vector = self._offset.matrix
        for artefact in self.artefacts:
            artefact.bind(compiled)

    def measure_pending(self, state: Any) -> None:
        """Make the readings of the samples of a state from `get_state`, so that the state can be pickled."""
        for sample in (state[2], *(sample for _, sample in state[3])):
            if sample is not None:
                self._finish_sample(sample)
                sample.work = None

    def close(self) -> None:
        """Release the resources of the kind; called when the simulation closes."""

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.scoped!r}>"

    def _repr_html_(self) -> str:
        facts = f"{self.update_rate:g} Hz" if self.update_rate else "every step"
        title = ", ".join([facts, *self._topics.values()])
        return reading_html(self, title, None if self.sim.engine.is_closed else self.latest)

    # ------------------------------------------------------------------ helpers

    def _make_noise(self, models: Sequence[NoiseModel], group: str) -> Noise:
        """Make the noise of a few channels with one model each, for `self.noise`."""
        quirks, names = self.sim.world.gazebo_quirks, self._noise_stream_names(group)
        models = [self._effective_noise(m) for m in models]
        return self.register_noise(Noise(models, *names, interval=self._noise_interval(), random_sign=quirks))

    def _make_uniform_noise(self, model: NoiseModel, width: int, group: str) -> UniformNoise:
        """Make noise with the same model on each of many channels, for `self.noise`."""
        quirks = self.sim.world.gazebo_quirks
        if quirks and model.is_quantized:
            model = NO_NOISE  # Gazebo adds no quantised noise to rays
        else:
            model = self._effective_noise(model)
        names, interval = self._noise_stream_names(group), self._noise_interval()
        return self.register_noise(UniformNoise(model, width, *names, interval=interval, random_sign=quirks))

    def _noise_stream_names(self, group: str) -> tuple[RandomStreams, str, str]:
        return self.sim.engine.streams, self.scoped, group

    def _noise_interval(self) -> float:
        return self._times.nominal_interval(self.update_rate)

    def _effective_noise(self, model: NoiseModel) -> NoiseModel:
        return model.as_gazebo(self.has_dynamic_bias) if self.sim.world.gazebo_quirks else model

    def register_noise(self, noise: AnyNoiseProcess) -> AnyNoiseProcess:
        """Add a process that advances, restarts and is restored with the sensor; return it."""
        if noise not in self._noises:
            self._noises.append(noise)
        if noise.evolves:
            self._evolving = tuple(n for n in self._noises if n.evolves)
            self._evolves = True
        self.is_deferred = True
        return noise

    def _finish_kept_samples(self) -> None:
        self._process_pending()
        for sample in self._kept_samples():
            self._finish_sample(sample)
        for _, publisher, _ in self._publishers:  # messages that wait for a reader
            self.sim.communication.bus.settle_topic(publisher.topic)

    def _noise_changed(self) -> None:
        super()._noise_changed()
        self._evolves = self._evolves or bool(self._evolving)
        self._revision = -1
        self.sim.engine.reschedule()

    def change_noise(self, value: float | NoiseModel | Sequence[NoiseModel]) -> None:
        super().change_noise(value)
        self.sim.engine.numbers.keep("sensor", self.scoped, "noise", self.noise_models())

    def _on_rate(self, message: msgs.Float64) -> None:
        """Apply a rate received on a topic; with `<gazebo_quirks>`, the rate of the file is the upper limit."""
        rate, file_rate = float(message.data), self.scene.rate
        problem = ""
        if not (math.isfinite(rate) and rate >= 0):
            problem = "expected a finite number of at least 0"
        elif self.sim.world.gazebo_quirks and file_rate > 0 and not 0 < rate <= file_rate:
            problem = f"Gazebo allows at most {file_rate:g} Hz, the rate of the file"
        problem = problem or self.rate_problem(rate)
        if not problem:
            self.set_rate(rate)
            return
        message_text = f"sensor {self.scoped!r}: ignored {rate:g} Hz from {self.timing.set_rate_topic!r}: {problem}"
        self.sim.engine.reports.warning("SK-SENSOR-026", message_text, self.scene.where)

    def _default_topic(self, suffix: str) -> str:
        """Return the file's `<topic>`, or Gazebo's default where the file has none."""
        file_topic = self.scene.topic
        return valid_topic(file_topic) if file_topic else entity_topic(self.sim.world.name, self.scene, suffix)

    def _frame_in_world(self, data: mujoco.MjData) -> tuple[Vector, Vector]:
        """Return the position (3,) [m] and the rotation matrix (3, 3) of the sensor in the world."""
        rotation = data.xmat[self._body].reshape(3, 3)
        return data.xpos[self._body] + matmul(rotation, self._offset_position), matmul(rotation, self._offset_rotation)

    def _velocity_in_world(self, model: mujoco.MjModel, data: mujoco.MjData, lever: Vector) -> Vector:
        """Return the velocity [m/s] in the world of the point at `lever` (world axes, [m]) from the body's origin."""
        motion = np.empty(6)
        mujoco.mj_objectVelocity(model, data, _BODY, self._body, motion, 0)
        wx, wy, wz, vx, vy, vz = motion.tolist()
        x, y, z = lever.tolist()
        return np.array((vx + wy * z - wz * y, vy + wz * x - wx * z, vz + wx * y - wy * x))

    def _find_link(self, names: NameMap) -> str:
        """Return the name of the sensor's link; a sensor on a joint belongs to the joint's child link."""
        parent = self.scene.parent
        return str(names.joint(parent).scene.child_link) if self.scene.on_joint else parent


def sensor_rule(sensor: Sensor) -> SensorRule:
    """Return the array rule of a sensor that samples at its rate alone.

    Raises:
        CannotBatchError: the sensor cannot be computed as arrays.
    """
    if "array_rule" not in vars(type(sensor)):
        raise CannotBatchError(f"sensor {sensor.scoped!r} ({sensor.kind})")
    if sensor.lasting is not None:
        raise CannotBatchError(f"the sweep of sensor {sensor.scoped!r}")
    if not sensor.keeps_to_grid:
        raise CannotBatchError(f"latency, jitter, drifting noise or a battery of sensor {sensor.scoped!r}")
    if sensor.artefacts:
        raise CannotBatchError(f"artefacts of sensor {sensor.scoped!r}")
    if not (sensor.is_manual or isinstance(sensor.timetable(), (TickGrid, type(None)))):
        raise CannotBatchError(f"the phase of sensor {sensor.scoped!r}")
    rule = array_rule_of(sensor, SensorRule)  # type: ignore[type-abstract]
    if rule is None:
        raise CannotBatchError(f"sensor {sensor.scoped!r} ({sensor.kind})")
    return rule


def report_once(sensor: Sensor, severity: Severity, code: str, message: str, where: Where, hint: str = "") -> None:
    """Add a diagnostic unless the same code was already reported for the same place."""
    known = chain(sensor.diagnostics, sensor.sim.engine.reports)
    if not any(d.code == code and (d.file, d.line) == (where.file or TEXT_SOURCE, where.line) for d in known):
        sensor.diagnostics.add(severity, code, message, where, hint)
