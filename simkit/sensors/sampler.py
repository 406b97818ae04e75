"""Sampling of a sensor: samples are taken at due times, stored until they are read, and published when they arrive."""

from __future__ import annotations

import abc
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import ClassVar, Self

import mujoco

from simkit.in_process import InProcess
from simkit.msgs.message_types import Message
from simkit.runtime import Publisher, Simulation
from simkit.runtime.communication.subscription import LazyMessage, PendingWork
from simkit.runtime.engine.physics_state import HeldState
from simkit.runtime.engine.scheduler import Timetable
from simkit.runtime.engine.simulated_time import TickGrid
from simkit.sensors.artefacts import Artefact, MessageArtefact
from simkit.sensors.lasting_samples import LastingSample, LastingSamples, LastingTimetable
from simkit.sensors.noise import NoiseKeeper
from simkit.sensors.sample import Batch, Memory, Product, Reading, Sample
from simkit.sensors.sample_packing import SampleGroup
from simkit.sensors.sample_times import DelayedReadings, LatencyTimetable, SampleTimes, TimingOptions

_MAX_GATHERED = 64  # number of gathered captures at which samples are made from them


class Sampler(NoiseKeeper, InProcess, abc.ABC):
    """Base class of `Sensor` that takes, keeps and publishes the samples."""

    needs_acceleration: ClassVar[bool] = False
    reads_contacts: ClassVar[bool] = False
    gathers: ClassVar[bool] = False
    is_deferred: bool = False
    sim: Simulation
    update_rate: float
    timing: TimingOptions
    batch: Batch | None = None
    batch_index = 0
    lasting: LastingSamples | None = None  # samples that are being measured, of a kind whose measurement lasts
    is_manual = False  # True if only calls of `sample` take samples, and none are taken at the rate
    _times: SampleTimes
    _is_switched = False  # True if the sensor can be without power

    def __init__(self) -> None:
        super().__init__()
        self._topics: dict[str, str] = {}
        self._products: Mapping[str, Product] = {}
        self._has_plugin_topics = False
        self._publishers: list[tuple[str, Publisher, bool]] = []
        self._newest: Sample | None = None
        self._gathered: list[tuple[int, Reading]] = []
        self._group: SampleGroup | None = None  # samples whose readers do not need them at once
        self._revision, self._patience = -1, 0.0
        self._read_publishers: list[tuple[str, Publisher, bool]] = []
        self._is_read = self._gathers = self._is_served = self._is_unread = self._is_direct = False
        self._skipped = 0  # unread samples; only the last of them can still be read
        self._held: tuple[int, HeldState] | None = None  # tick and physics state of that last sample
        self._index, self._time_ns = 0, -1
        self._delayed: DelayedReadings | None = None
        self._latency_timetable: LatencyTimetable | None = None
        # these flags avoid a call at every sample of a method that the kind does not override
        self._selects_ticks, self._selects_products_of_sample = self._overrides("accepts"), self._overrides("publishes")
        self._evolves = self._overrides("evolve")
        self._is_on: Callable[[], bool] = lambda: True
        self._set_artefacts(())

    def _set_artefacts(self, artefacts: Sequence[Artefact]) -> None:
        """Set the artefacts, in the order in which they apply."""
        self.artefacts: tuple[Artefact, ...] = tuple(artefacts)
        self._before_noise = tuple(artefact for artefact in artefacts if artefact.order < 0)
        self._after_noise = tuple(artefact for artefact in artefacts if artefact.order >= 0)
        self._message_artefacts = tuple(a for a in artefacts if isinstance(a, MessageArtefact))
        # each of these samples is taken at its time, whether or not it has a reader
        self._needs_each_sample = bool(self._message_artefacts) or any(a.follows_truth for a in artefacts)

    def sample_only_while(self, is_on: Callable[[], bool]) -> None:
        """Sample at due times only while `is_on()` returns true; a sensor without power has no samples."""
        self._is_on, self._selects_ticks, self._is_switched = is_on, True, True

    def _overrides(self, method: str) -> bool:
        return getattr(type(self), method) is not getattr(Sampler, method)

    # ------------------------------------------------------------------ methods that a kind overrides

    @abc.abstractmethod
    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> object:
        """Return the reading without noise, from up-to-date data; the reading's arrays are never modified later."""

    def capture(self, model: mujoco.MjModel, data: mujoco.MjData) -> object:
        """Copy from the data the values that `finish` needs; by default, the reading itself."""
        return self.measure(model, data)

    def capture_other(self, model: mujoco.MjModel, data: mujoco.MjData) -> object:
        """Capture a state of another simulation of the same world, whose forward pass is up to date."""
        return self.capture(model, data)

    def capture_held(self, model: mujoco.MjModel, data: mujoco.MjData, sample: Sample) -> object:
        """Capture the physics state held for a sample; overridden by kinds that measure more than the physics."""
        return self.capture(model, data)

    def finish(self, raw: Reading) -> object:
        """Return the reading without noise, made from the captured values."""
        return raw

    def perturb(self, reading: Reading, index: int) -> object:
        """Return the reading with the noise of a sample; the same object if there is no noise."""
        return reading

    def accepts(self, tick: int) -> bool:
        """Check whether a sample is taken at a due tick."""
        return True

    def publishes(self, product: str, raw: Reading) -> bool:
        """Check whether a capture is published as `product`; `latest` and `truth` show it in both cases."""
        return True

    def check_available(self) -> None:
        """Raise a SimkitError if this machine cannot make the readings; called for every reader of a reading."""

    def packs(self, product: str) -> bool:
        """Check whether `pack_samples` can serialise a product, and whether captures are small enough to be stored."""
        return False

    def pack_samples(self, first: int, times: Sequence[int], captures: Sequence[Reading]) -> Sequence[bytes]:
        """Return the serialised messages of samples; empty if only `finish` and the product can make them now.

        Overridden by kinds with many samples a second, whose noise does not drift.

        Args:
            first: number of the first sample.
            times: time of each sample [ns].
            captures: captured values of each sample.
        """
        return ()

    @property
    def makes_directly(self) -> bool:
        """True if `make_directly` makes the message of the only product with the present noise."""
        return False

    def make_directly(self, raw: Reading, index: int, time_ns: int) -> Message:
        """Return the message of a sample from its captured values, because a reading takes as long as a message."""

    # a kind whose measurement lasts sets `lasting` before it is attached, and overrides the next four methods and
    # `capture_held`, which makes the reading from the surroundings that `end_measurement` returns

    def measurement_ticks(self, index: int) -> int:
        """Return the number of ticks from the time stamp of a sample to the end of its measurement."""
        return 0

    def begin_measurement(self, index: int, tick: int) -> Memory:
        """Begin the measurement of a sample, and return its progress: values that are never modified."""

    def continue_measurement(self, sample: LastingSample, tick: int) -> Memory:
        """Measure what the sample has had time for, because the model is about to be modified; return the progress."""

    def end_measurement(self, sample: LastingSample, tick: int) -> Memory:
        """Return what `capture_held` needs besides the physics of this tick, at which the measurement ends."""

    @classmethod
    def make_batches(cls, sensors: Sequence[Self]) -> None:
        """Make batches of the sensors of this kind that can sample together; see `simkit.sensors.sensor_batch`."""

    # ------------------------------------------------------------------ methods that the simulation calls

    @property
    def keeps_to_grid(self) -> bool:
        """True if a message is published at every tick of the rate and phase, with noise that does not drift."""
        is_plain = self._delayed is None and self.timing.jitter == 0 and not self._evolves
        return is_plain and not (self.selects_ticks or self._selects_products_of_sample)

    @property
    def selects_ticks(self) -> bool:
        """True if the sensor may take no sample at a due tick."""
        return self._selects_ticks

    @property
    def is_read_now(self) -> bool:
        """True if a subscriber or a recorder reads the measurements."""
        if self._revision != self.sim.communication.bus.revision:
            self._update_readers()
        return self._is_read

    @property
    def has_subscriber(self) -> bool:
        """True if a topic of the sensor is read, also by readers that need no measurement."""
        return any(publisher.wanted for _, publisher, _ in self._publishers)

    def sample_now(self, tick: int) -> None:
        """Take a sample at the present tick unless there is one, and measure it now."""
        if self.lasting is not None:  # its samples take their time
            return
        now = self.sim.time_ns
        sample = self._sample
        if sample is None or sample.time_ns != now:
            if self._revision != self.sim.communication.bus.revision:
                self._update_readers()
            if self._is_unread and not self._selects_ticks:  # the state need not be kept to measure it now
                sample = self._newest = self._begin_sample(tick)
                sample.raw = self._capture_now(tick)
                return
            self.sample(tick)
            sample = self._sample
        if sample is not None and sample.held is not None and sample.time_ns == now:
            # measured in the present data, whose forward pass the next step needs anyway
            sample.raw, sample.held = self._capture_now(tick), None

    def _publish_served(self, tick: int) -> bool:
        """Publish the message that the batch or `make_directly` makes for a new sample; false if there is none."""
        if self.batch is not None and self.batch.publish_sample(self, tick):
            return True
        if not self._is_direct:
            return False
        index, time_ns = self._index + 1, self.sim.engine.clock.time_ns(tick)
        raw = self._capture_now(tick)
        sample = Sample(index, time_ns)
        sample.raw = raw  # read by `latest` and `truth`
        message = sample.messages[next(iter(self._products))] = self.make_directly(raw, index, time_ns)
        self.publish_made(sample, message)
        return True

    def publish_made(self, sample: Sample, message: Message) -> None:
        """Take over a sample whose only message a batch has made, and publish it."""
        self._index, self._time_ns, self._newest = sample.index, sample.time_ns, sample
        for _, publisher, _ in self._read_publishers:
            publisher.publish(message)

    @property
    def count(self) -> int:
        """Number of samples taken."""
        self._process_pending()
        return self._index

    def timetable(self) -> Timetable | None:
        """Return the ticks at which `sample` must be called at the current rate; None is every step."""
        grid = self._times.grid(self.update_rate)
        if self.lasting is not None and self._delayed is not None and grid is not None:
            times = grid, self._delayed, lambda: self._index + 1, self.lasting, self.measurement_ticks
            self._latency_timetable = LastingTimetable(*times)
            return self._latency_timetable
        if self._delayed is None or grid is None:
            self._latency_timetable = None
            return grid
        self._latency_timetable = LatencyTimetable(grid, self._delayed, lambda: self._index + 1)
        return self._latency_timetable

    def scene_timetable(self) -> Timetable | None:
        """Return the ticks at which the scenery must have its pose; None is every step."""
        return None if self.lasting is not None else self.timetable()

    @property
    def is_silent(self) -> bool:
        """True if a sample calls no code that may read another sensor."""
        if self._revision != self.sim.communication.bus.revision:
            self._update_readers()
        return not self._read_publishers

    @property
    def keeps_last(self) -> bool:
        """True if only the last of several samples at due ticks can be read; `skip` counts the others."""
        is_usual = self.lasting is None and not (self._selects_ticks or self._overrides("sample"))
        return is_usual and self.is_silent and self._is_unread and isinstance(self.timetable(), TickGrid)

    def skip(self, count: int) -> None:
        """Count samples that are not taken, because only a later one can be read."""
        self._skipped += count

    def sample(self, tick: int) -> None:
        """Sample at a due tick: measure and publish if the sensor has a reader, else keep the physics state."""
        if self._delayed is not None:
            if self.lasting is not None:
                self._end_measurements(self.lasting, self._delayed, tick)
            if not self._deliver_and_check_due(self._delayed, tick):
                return
        if self._selects_ticks and not (self._is_on() and self.accepts(tick)):
            return
        sim = self.sim
        if self._revision != sim.communication.bus.revision:
            self._update_readers()
        # five ways to take a sample; the first that the readers allow is the cheapest
        if self._is_unread:  # only `latest` can still ask for a sample, and it shows the last one
            self._skipped += 1
            self._held = tick, sim.engine.physics.hold()
            return
        # every reader needs its message at once: a batch makes the messages of its sensors together, and a kind may
        # make its message from the captured values, without a reading
        if self._is_served and not self.artefacts and self._publish_served(tick):
            return
        if self._group is not None:  # no reader needs its message at once: many samples become messages together
            packed = self._group.add(tick, self._capture_now(tick))
            for _, publisher, _ in self._read_publishers:
                publisher.publish_packed(packed)
            return
        if self._gathers:  # queues keep only their newest messages, so the others need no message at all
            self._gathered.append((tick, self._capture_now(tick)))
            if len(self._gathered) >= _MAX_GATHERED:
                self._process_pending()
            return
        sample, read_publishers = self._begin_sample(tick), self._read_publishers
        if self._message_artefacts and self._loses(sample):
            return
        if self.lasting is not None and self._delayed is not None:
            end = tick + self.measurement_ticks(sample.index)
            self.lasting.begin(sample, tick, end, self.begin_measurement(sample.index, tick))
            self._end_measurements(self.lasting, self._delayed, tick)
            self._deliver(self._delayed, tick)
            return
        if self._is_read:
            # the noise and the message can wait, but the data change with the next step
            sample.raw = self._capture_now(tick)
            if self._selects_products_of_sample:
                self._select_products(sample)
        else:
            sample.held = sim.engine.physics.hold()
        if self._delayed is not None:
            arrival = self._delayed.add(tick, sample)
            if self._message_artefacts:
                self._stamp(sample, arrival)
            self._deliver(self._delayed, tick)
            return
        if self._message_artefacts:
            self._stamp(sample, tick)
        self._sample = sample
        if read_publishers:
            self._publish(sample, read_publishers)

    def take_held(self) -> None:
        """Capture the samples that are not captured yet, before their model is modified."""
        for sample in self._kept_samples():
            self._capture_sample(sample)
        if self.lasting is not None and self.lasting.samples:
            tick = self.sim.engine.tick
            self.lasting.advance(lambda sample: self.continue_measurement(sample, tick))

    def leave(self) -> None:
        """Finish the samples that may still be read; called when the sensor's model is removed."""
        self._process_pending()
        for sample in self._kept_samples():
            self._finish_sample(sample)

    def reset(self) -> None:
        """Return to t = 0."""
        self._process_pending()
        self._drop_samples()
        self._index, self._time_ns = 0, -1
        self.restart()

    def get_state(self) -> object:
        self._process_pending()
        # a sample is completed and never changed afterwards, so snapshots may share it
        flight = tuple(self._delayed.samples) if self._delayed is not None else ()
        lasting = self.lasting.samples if self.lasting is not None else ()
        return self._index, self._time_ns, self._sample, flight, self.update_rate, self.memory(), lasting

    def set_state(self, state: Memory) -> None:
        self._process_pending()  # pending captures belong to the present run; later they would follow restored samples
        self._index, self._time_ns, self._sample, flight, rate, memory, lasting = state
        if self.lasting is not None:
            self.lasting.samples = lasting
        if self._delayed is not None:
            self._delayed.samples.clear()
            self._delayed.samples.extend(flight)
        if rate != self.update_rate:
            self._apply_rate(rate)
        self.remember(memory)

    # ------------------------------------------------------------------ helpers

    @property
    def _sample(self) -> Sample | None:
        """Newest sample that has arrived."""
        if self._gathered or self._skipped or self._group is not None:
            self._process_pending()
        return self._newest

    @_sample.setter
    def _sample(self, sample: Sample | None) -> None:
        self._newest = sample

    def _begin_sample(self, tick: int) -> Sample:
        """Begin the next sample, and advance to it the noise that has a state."""
        time_ns = self.sim.engine.clock.time_ns(tick)
        self._index = index = self._index + 1
        if self._evolves:
            # a bias drifts with the time since the last sample, which is not constant with jitter or a changed rate
            self.evolve(index, (time_ns - self._time_ns) * 1e-9 if self._time_ns >= 0 else 0.0)
        self._time_ns = time_ns
        sample = Sample(index, time_ns)
        if self._evolving:
            sample.noise_states = tuple([noise.state for noise in self._evolving])
        return sample

    def _loses(self, sample: Sample) -> bool:
        """Check whether the message of the newest sample is lost."""
        return any(artefact.is_lost(sample.index) for artefact in self._message_artefacts)

    def _stamp(self, sample: Sample, arrival: int) -> None:
        """Set the time stamp of a sample that arrives at the tick `arrival`."""
        arrived_ns, stamp_ns = self.sim.engine.clock.time_ns(arrival), sample.time_ns
        for artefact in self._message_artefacts:
            stamp_ns = artefact.stamp(stamp_ns, arrived_ns)
        if stamp_ns != sample.time_ns:
            sample.stamp_ns = stamp_ns

    def _capture_now(self, tick: int) -> object:
        """Capture the state of this tick, from the batch if the sensor belongs to one."""
        batch = self.batch
        if batch is not None:
            if batch.is_ready(self, tick):
                return batch.captured(self.batch_index)
            self.batch = None  # the sensor samples alone until the simulation schedules its sensors again
        return self.capture(self.sim.mj_model, self.computed_data())

    def computed_data(self) -> mujoco.MjData:
        """Return MuJoCo's data after computing the quantities that `measure` reads."""
        if self.needs_acceleration or self.reads_contacts:
            return self.sim.engine.physics.fresh_accelerations()
        return self.sim.engine.physics.fresh()

    def _update_readers(self) -> None:
        """Update the products that have readers, and decide whether captures may be gathered."""
        self._process_pending()
        self._revision = self.sim.communication.bus.revision
        self._read_publishers = [end for end in self._publishers if end[1].wanted]
        self._is_read = any(needs_reading for _, _, needs_reading in self._read_publishers)
        publishers = [publisher for _, publisher, _ in self._read_publishers]
        self._is_served = bool(publishers) and all(publisher.is_live for publisher in publishers)
        patience = [publisher.patience for publisher in publishers]
        selects = self._selects_ticks or self._selects_products_of_sample
        is_plain = self._delayed is None and not (selects or self._needs_each_sample)
        self._gathers = self.gathers and self.is_deferred and is_plain and self._is_read and all(patience)
        changes = self._evolves or self._evolving or self._overrides("_begin_sample")
        # a drifting noise advances at every sample, and a delayed sample is delivered later, so neither is skipped
        self._is_unread = not (self._read_publishers or changes or self._delayed or self._needs_each_sample)
        self._patience = max(patience, default=0.0)
        self._is_direct = is_plain and self._is_read and not changes and self.makes_directly
        products = {product for product, _, _ in self._read_publishers}
        is_packed = is_plain and self.is_deferred and self._is_read and not (changes or self.artefacts)
        is_packed = is_packed and not any(publisher.is_live for publisher in publishers)
        is_packed = is_packed and len(products) == 1 and self.packs(*products)
        self._group = SampleGroup(self, *products) if is_packed else None

    def _process_pending(self) -> None:
        """Make samples of the gathered captures, and publish the newest ones, which a reader's queue can keep."""
        if self._held is not None and self._skipped:
            (tick, is_held), count = self._held, self._skipped
            self._skipped, self._held = 0, None
            self._index += count - 1  # skipped samples count: a reader must not change the noise of later samples
            self._newest = self._begin_sample(tick)
            self._newest.held = is_held
        if self._group is not None:
            self._end_group(self._group)
        if not self._gathered:
            return
        rows, self._gathered = self._gathered, []
        unseen = len(rows) - self._patience
        for number, (tick, raw) in enumerate(rows):
            sample = self._newest = self._begin_sample(tick)
            sample.raw = raw
            if number >= unseen:
                self._publish(sample, self._read_publishers)

    def _end_group(self, group: SampleGroup) -> None:
        """Begin a new group of samples, if samples are added to this one."""
        if group is self._group and group.ticks:
            count = len(group.ticks)
            self._index, self._time_ns = self._index + count, self.sim.engine.clock.time_ns(group.ticks[-1])
            self._newest = group.sample(count - 1)
            self._group = SampleGroup(self, group.product)

    def _apply_rate(self, rate: float) -> None:
        self.update_rate = rate
        for noise in self._noises:
            noise.set_interval(self._times.nominal_interval(rate))

    def _kept_samples(self) -> Iterator[Sample]:
        """Yield every sample that may still be read."""
        if self._sample is not None:
            yield self._sample
        if self._delayed is not None:
            yield from (sample for _, sample in self._delayed.samples)

    def _drop_samples(self) -> None:
        """Drop all samples."""
        self._sample = None
        if self._delayed is not None:
            self._delayed.samples.clear()
        if self.lasting is not None:
            self.lasting.samples = ()

    def _end_measurements(self, lasting: LastingSamples, delayed: DelayedReadings, tick: int) -> None:
        """Capture the samples whose measurement ends at this tick; they arrive after the sensor's latency."""
        for begun in lasting.take_ended(tick):
            sample = begun.ended()
            sample.surroundings = self.end_measurement(begun, tick)
            if self.is_read_now:
                sample.raw = self.capture_held(self.sim.mj_model, self.computed_data(), sample)
            else:
                sample.held = self.sim.engine.physics.hold()
            arrival = delayed.add(tick, sample)
            if self._message_artefacts:
                self._stamp(sample, arrival)

    def _deliver_and_check_due(self, delayed: DelayedReadings, tick: int) -> bool:
        """Deliver the samples that have arrived, and check whether a sample is due as well."""
        self._deliver(delayed, tick)
        return self._latency_timetable is None or self._latency_timetable.is_sample(tick)

    def _deliver(self, delayed: DelayedReadings, tick: int) -> None:
        for sample in delayed.arrived(tick):
            self._sample = sample
            read_publishers = [end for end in self._publishers if end[1].wanted]
            if any(needs_reading for _, _, needs_reading in read_publishers):
                self._capture_sample(sample)
            self._publish(sample, read_publishers)

    def _publish(self, sample: Sample, read_publishers: list[tuple[str, Publisher, bool]]) -> list[LazyMessage]:
        """Publish the messages that have readers, and return those that are made from the reading later."""
        deferred = []
        for product, publisher, needs_reading in read_publishers:
            if product in sample.unpublished:
                continue
            if self.is_deferred and not publisher.is_live:
                work = self._pending_job(sample) if needs_reading else None
                make = partial(self._message_on_demand, sample, product)
                later = publisher.publish_later(make, work, can_wait=self.gathers)
                if needs_reading and later is not None:
                    deferred.append(later)
            else:
                publisher.publish(self._message(sample, product))
        return deferred

    def _pending_job(self, sample: Sample) -> PendingWork | None:
        """Return the job of another thread that a sample waits for; None by default."""
        return None

    def _message_on_demand(self, sample: Sample, product: str) -> object:
        """Make a message after its sample was published; return `NO_MESSAGE` if that is no longer possible."""
        return self._message(sample, product)

    def _select_products(self, sample: Sample) -> None:
        """Select the products of a captured sample that are not published."""
        sample.unpublished = tuple(product for product in self._topics if not self.publishes(product, sample.raw))

    def _capture_sample(self, sample: Sample) -> None:
        """Capture the physics state that a sample holds, once."""
        if sample.held is not None:
            sample.raw = self.capture_held(sample.held.model, self.sim.engine.physics.data_of(sample.held), sample)
            sample.held = None
            if self._selects_products_of_sample:
                self._select_products(sample)

    def _finish_sample(self, sample: Sample) -> None:
        """Make the reading of a sample, and its noise, once."""
        if sample.held is not None:
            self._capture_sample(sample)
        if sample.raw is not None:
            sample.truth = truth = self.finish(sample.raw)
            if sample.noise_states:
                sample.noisy = self._with_noise_of(sample, self._with_errors, truth, sample.index)
            else:
                sample.noisy = self._with_errors(truth, sample.index)
            sample.raw = sample.surroundings = None  # the reading replaces the captured values, such as an image

    def _with_errors(self, truth: Reading, index: int) -> object:
        """Return the reading with the noise and the artefacts of a sample."""
        if not self.artefacts:
            return self.perturb(truth, index)
        reading = truth
        for artefact in self._before_noise:
            reading = artefact.apply(reading, truth, index)
        reading = self.perturb(reading, index)
        for artefact in self._after_noise:
            reading = artefact.apply(reading, truth, index)
        return reading

    def _message(self, sample: Sample, product: str) -> Message:
        message = sample.messages.get(product)
        if message is None:
            if self._products[product].needs_reading:
                self._finish_sample(sample)
            stamp_ns = sample.time_ns if sample.stamp_ns is None else sample.stamp_ns
            message = sample.messages[product] = self._make_message(sample, product, sample.noisy, stamp_ns)
        return message

    def _make_message(self, sample: Sample, product: str, reading: Reading, stamp_ns: int) -> object:
        make = self._products[product].make
        if sample.noise_states:
            return self._with_noise_of(sample, make, reading, stamp_ns)
        return make(reading, stamp_ns)
