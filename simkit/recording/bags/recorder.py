"""Recorder of a simulation's topics to a bag during the run."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from operator import lt
from pathlib import Path
from typing import TYPE_CHECKING

from simkit.errors import SimkitError
from simkit.recording.bags.bag_contents import matches_topic
from simkit.recording.bags.recorded_run import describe_run
from simkit.recording.bags.writer import McapBag, is_single_file, open_bag
from simkit.recording.message_taps import MessageQueue, TopicTaps

if TYPE_CHECKING:
    from simkit.runtime import Simulation

_SECOND = 1_000_000_000


class RecordError(SimkitError):
    """Error that stopped a recording during a run. The flushed part of the bag is readable."""

    code = "SK-BAG-003"
    _shows_class_code = True


class Recorder:
    """Recorder of published messages to a bag; a context manager around the run.

    The log time of a message is the simulated time. After a reset, or a restored earlier snapshot, log times continue
    from the last one, because readers sort by them and would mix the messages of both times; stamps begin again.

    Args:
        sim: simulation to record; every recorded sensor measures because of the recording.
        path: `x.mcap` for one file, else a rosbag2 folder.
        overwrite: True to replace an existing bag.
        topics: shell patterns of the topics to record; empty for all topics except those in the bus's `aside` (`/stats`
            and other topics about the whole world).
        skip: shell patterns of topics to leave out.
        choose: function that returns True for a topic to record; replaces `topics`.

    Raises:
        InputError: SK-BAG-001 the bag exists; SK-BAG-002 the path is not writable.
        RenderError: images are to be recorded, and the simulation requests OpenGL, which is missing.
    """

    def __init__(
        self,
        sim: Simulation,
        path: str | os.PathLike[str],
        *,
        overwrite: bool = False,
        topics: Sequence[str] = (),
        skip: Sequence[str] = (),
        choose: Callable[[str], bool] | None = None,
    ) -> None:
        self.path = Path(path)
        self.failure: RecordError | None = None
        self._sim, self._patterns, self._skip = sim, tuple(topics), tuple(skip)
        self._choose = choose
        self._count = 0
        self._check_available()
        folder = self.path.parent if is_single_file(self.path) else self.path
        run = describe_run(sim, folder, self._is_recorded)
        self._bag: McapBag | None = open_bag(self.path, overwrite=overwrite, run=run)
        # while an image is rendered, later messages wait as bytes, so that all messages stay in order
        self._queue = MessageQueue(self._write, serialises=True)
        self._newest_ns = self._shift_ns = 0  # newest log time, and log time minus simulated time
        self._first_tick = self._end_tick = 0  # ticks of the present second, from the first message of the second on
        self._taps = TopicTaps(sim, self._receiver_of, self._queue.deliver_ready)
        self._taps.open()

    @property
    def message_count(self) -> int:
        """Number of messages written so far."""
        self._queue.deliver_ready()
        return self._count if self._bag is None else self._bag.span.count

    def __enter__(self) -> Recorder:
        return self

    def __exit__(self, kind: object, *_: object) -> None:
        self.close()
        if kind is None:
            self.check()

    def check(self) -> None:
        """Raise the error of the recording, if there is one.

        Raises:
            RecordError: the disk is full or gone.
        """
        if self.failure is not None:
            raise self.failure

    def close(self) -> None:
        """End the recording and complete the bag. A second call does nothing."""
        self._taps.close()
        self._queue.deliver_all()
        bag, self._bag = self._bag, None
        if bag is None:
            return
        self._count = bag.span.count
        try:
            bag.close()
        except OSError as error:
            self._fail(error)

    def _receiver_of(self, topic: str, _: str) -> Callable[[object], None] | None:
        if not self._is_recorded(topic):
            return None
        physics, add = self._sim.engine.physics, self._queue.add

        def receive(message: object) -> None:
            tick = physics.tick
            if not self._first_tick <= tick < self._end_tick:
                self._end_second()
            add(topic, tick, message)

        return receive

    def _end_second(self) -> None:
        """Pass the messages of a simulated second to the operating system, unless one of its images is not rendered."""
        tick, clock = self._sim.tick, self._sim.engine.clock
        second = clock.time_ns(tick) // _SECOND
        end = clock.ticks_to_cover(second + 1)
        is_rounded = clock.time_ns(end - 1) // _SECOND > second
        self._first_tick, self._end_tick = tick, end - 1 if is_rounded else end
        self._queue.deliver_ready()
        if self._bag is not None and not self._queue:
            try:
                self._bag.end_chunk()
            except OSError as error:
                self._stop(error)

    def _check_available(self) -> None:
        """Check before the bag is created that the messages of all recorded topics can be made."""
        bus = self._sim.communication.bus
        failed: list[str] = []
        first: SimkitError | None = None
        for topic in filter(self._is_recorded, bus.all_topics()):
            try:
                bus.check_available(topic)
            except SimkitError as error:
                failed, first = [*failed, f"--skip {topic}"], first or error
        if first is not None:
            first.args = (f"{first}\n    help: or leave its topics out: {' '.join(failed)}",)
            raise first

    def _is_recorded(self, topic: str) -> bool:
        return (self._choose or self._is_selected)(topic) and not matches_topic(topic, self._skip)

    def _is_selected(self, topic: str) -> bool:
        if self._patterns:
            return matches_topic(topic, self._patterns)
        return topic not in self._sim.communication.bus.aside

    def records(self, topic: str) -> bool:
        """Check whether the options select the topic."""
        return topic in self._taps

    def _write(self, topics: list[str], ticks: list[int], contents: list[tuple[str, bytes]]) -> None:
        """Write serialised messages, each a tuple of type and CDR."""
        bag, times = self._bag, self._log_times(self._sim.engine.clock.times_ns(ticks))
        if bag is None:
            return
        types, data = zip(*contents, strict=True)
        try:
            channels = list(map(bag.channels.get, zip(topics, types, strict=True)))
            known = [channel for channel in channels if channel is not None]
            if len(known) == len(data) and min(times) // _SECOND == max(times) // _SECOND:
                bag.write_all(known, data, times)
                return
            for topic, time_ns, (type_name, content) in zip(topics, times, contents, strict=True):
                channel = bag.channels.get((topic, type_name))
                if channel is None:
                    bus = self._sim.communication.bus
                    drawn_by = self._sim.engine.renderer if bus.check_available(topic) else ""
                    channel = bag.channel(topic, type_name, topic in bus.latched(), drawn_by)
                bag.write_raw(channel, content, time_ns)
        except OSError as error:
            self._stop(error)

    def _log_times(self, times: list[int]) -> list[int]:
        """Return the log times [ns] of messages in the order of their publication."""
        if self._shift_ns or times[0] < self._newest_ns or any(map(lt, times[1:], times)):
            shifted = []
            newest, shift = self._newest_ns, self._shift_ns
            for time_ns in times:
                shift = max(shift, newest - time_ns)
                newest = time_ns + shift
                shifted.append(newest)
            times, self._shift_ns = shifted, shift
        self._newest_ns = times[-1]
        return times

    def _stop(self, error: OSError) -> None:
        """Store an error instead of raising it, because the publisher that calls the recorder did not cause it."""
        self._fail(error)
        self._queue.clear()
        self.close()

    def _fail(self, error: OSError) -> None:
        self.failure = self.failure or RecordError(
            f"recording to {self.path} stopped at t={self._sim.time:.3f} s: {error.strerror or error}; "
            "recover the earlier messages with `simkit bag recover`"
        )
