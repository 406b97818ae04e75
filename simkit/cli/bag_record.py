"""Command `simkit bag record`: record a simulation that runs in another terminal."""

from __future__ import annotations

import re
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Option

from simkit.cli.run_loop import Interrupts
from simkit.cli.terminal import completion, options
from simkit.cli.terminal.json_report import report_errors
from simkit.cli.terminal.options import argument, compile_pattern, option
from simkit.cli.terminal.output import absolute_name, print_json, print_note, without_interrupt_message
from simkit.cli.terminal.topic_sources import LiveSource, connect_to_simulation
from simkit.diagnostics import did_you_mean
from simkit.errors import InputError
from simkit.msgs.topic_names import is_hidden
from simkit.number_text import counted

if TYPE_CHECKING:
    from simkit.cli.terminal.topic_sources import LiveFeed, ReceivedMessage, TopicEntry
    from simkit.recording.bags.writer import McapBag

_DEPTH = 20_000  # queued messages of a topic while the disk is busy
_BATCH_BYTES = 64 << 20  # [bytes] that are received before they are written, so that memory has a limit
_RECEIVE_TIMEOUT = 0.2  # [s] of wall time between two checks for Ctrl-C
_DISCOVERY_PERIOD = 1.0  # [s] of wall time between two searches for new topics


@report_errors
@without_interrupt_message
def record(
    topics: Annotated[list[str] | None, argument("Topics to record.", "[TOPIC]...", completion.topics)] = None,
    all_: Annotated[bool, Option("--all", "-a", help="Record all topics, including new ones.")] = False,
    regex: Annotated[
        str | None, option("Record the topics that match.", "REGEX", "--regex", "-e", show_default=False)
    ] = None,
    exclude: Annotated[
        str | None,
        option("Exclude topics that match.", "REGEX", "--exclude-regex", "--exclude", "-x", show_default=False),
    ] = None,
    topics_too: Annotated[
        list[str], option("Topic to record; repeatable.", "TOPIC", "--topics", complete=completion.topics)
    ] = [],
    output: Annotated[
        Path | None, option("NAME.mcap: one file; else a rosbag2 folder.", "OUT", "--output", "-o", show_default=False)
    ] = None,
    duration: Annotated[float | None, option("Simulated seconds to record.", "S", "--duration", "-d", min=0)] = None,
    max_rate: Annotated[
        float | None, option("Record at most N messages of a topic per simulated second.", "N", min=1e-6)
    ] = None,
    hidden: Annotated[bool, Option("--include-hidden-topics", help="Include hidden topics.")] = False,
    storage: Annotated[str, option("Storage format; only mcap.", "mcap", "--storage", "-s")] = "mcap",
    force: options.Force = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> int:
    """Record topics of a running simulation until Ctrl-C. `simkit run --record` drops no message at any speed."""
    from simkit.recording.bags.writer import open_bag

    named = [absolute_name(t) for t in (*(topics or ()), *topics_too)]
    selection = _TopicSelection(
        named, all_, compile_pattern(regex, "--regex"), compile_pattern(exclude, "--exclude-regex"), hidden
    )
    if storage != "mcap":
        raise InputError("SK-CLI-018", f"--storage: found {storage!r}; expected mcap")
    target = output or Path(time.strftime("rosbag2_%Y_%m_%d-%H_%M_%S"))
    with connect_to_simulation(sim) as client:
        recording = _Recording(LiveSource(client), selection, duration, max_rate)
        with Interrupts() as stop:
            recording.subscribe()  # before the bag is created, because a topic may have no messages on this machine
            bag = open_bag(target, overwrite=force)
            try:
                recording.run(bag, stop)
            finally:
                bag.close()
    lost = recording.lost_by_topic()
    summary = {"path": str(target), "messages": bag.span.count, "topics": len(bag.channels)}
    summary |= {"lost": sum(lost.values()), "lost_by_topic": lost}
    if json_:
        print_json(summary)
    else:
        print_note(f"{target}: {counted(bag.span.count, 'message')} on {counted(len(bag.channels), 'topic')}")
        if lost:
            counts = ", ".join(f"{count} of {topic}" for topic, count in lost.items())
            text = f"note: {counted(sum(lost.values()), 'message')} dropped ({counts})"
            print_note(f"{text}; `simkit run --record` drops none")
    return stop.exit_code


class _TopicSelection:
    """Selection of the topics to record."""

    def __init__(
        self, named: list[str], all_: bool, regex: re.Pattern[str] | None, exclude: re.Pattern[str] | None, hidden: bool
    ) -> None:
        if not named and not all_ and regex is None:
            text = "no topics to record; give names, --all or --regex"
            raise InputError("SK-CLI-018", text)
        self._named, self._all, self._regex, self._exclude, self._hidden = set(named), all_, regex, exclude, hidden
        self.named = named

    def __contains__(self, topic: str) -> bool:
        if self._exclude is not None and self._exclude.search(topic):
            return False
        if topic in self._named:
            return True
        if is_hidden(topic) and not self._hidden:
            return False
        return self._all or (self._regex is not None and bool(self._regex.search(topic)))


class _Recording:
    """Recording of the selected topics of a running simulation."""

    def __init__(
        self, source: LiveSource, selection: _TopicSelection, duration: float | None, max_rate: float | None = None
    ) -> None:
        self._period_ns = 0 if max_rate is None else round(1e9 / max_rate)
        self._due_ns: dict[str, int] = {}  # earliest time of the next message of a topic
        self._source, self._selection, self._duration = source, selection, duration
        self._feeds: list[LiveFeed] = []
        self._known: set[str] = set()
        self._unlisted: dict[str, TopicEntry] = {}
        self._latched: set[str] = set()
        self._looked = -_DISCOVERY_PERIOD
        self._begun_ns: int | None = None
        self._is_past_end = False
        existing = source.topics()
        for name in selection.named:
            if name not in existing:
                hint = did_you_mean(name, existing)
                print_note(f"note: topic {name} does not exist yet{'; ' + hint if hint else ''}")

    def lost_by_topic(self) -> dict[str, int]:
        """Return the number of dropped messages of each topic that has lost any, the largest number first."""
        lost = {topic: count for feed in self._feeds for topic, count in feed.lost_by_topic().items() if count}
        return dict(sorted(lost.items(), key=lambda item: -item[1]))

    def run(self, bag: McapBag, stop: Interrupts) -> None:
        """Record until the end of the simulation, the end of the duration or Ctrl-C."""
        from simkit.live import LiveClosed

        try:
            started_ns = self._now_ns()
            while not stop.exit_code:
                self.subscribe()
                self._list_topics(bag)
                received = self._take_messages()
                if self._write(bag, received) or (not received and any(feed.is_over for feed in self._feeds)):
                    return
                if self._duration is not None and not received:
                    begun_ns = started_ns if self._begun_ns is None else self._begun_ns
                    if self._now_ns() - begun_ns > self._duration * 1e9:
                        return
            self._source.client.flush()  # receives the messages that were sent before Ctrl-C
        except LiveClosed as closed:
            if closed.code != "SK-LIVE-005":
                raise
            if not any(feed.is_over for feed in self._feeds):
                print_note(f"note: {str(closed).removeprefix('SK-LIVE-005 ')}")
        self._write(bag, self._take_messages(wait=0.0))

    def _now_ns(self) -> int:
        return int(self._source.client.state()["time_ns"])

    def _write(self, bag: McapBag, messages: list[ReceivedMessage]) -> bool:
        """Write the messages within the duration; return True after its end, when no more of them arrive.

        Large messages arrive later than small ones that were published at the same time.
        """
        count = 0
        for received in messages:
            time_ns = int(received.time_ns)
            self._begun_ns = time_ns if self._begun_ns is None else min(self._begun_ns, time_ns)
            if self._duration is not None and time_ns - self._begun_ns > self._duration * 1e9:
                self._is_past_end = True
                continue
            if self._period_ns and not self._is_due(received.topic, time_ns):
                continue
            channel = bag.channel(received.topic, received.type_name, received.topic in self._latched)
            bag.write_raw(channel, received.data, time_ns)
            count += 1
        return self._is_past_end and not count

    def _is_due(self, topic: str, time_ns: int) -> bool:
        """Check whether the rate limit allows a message; latched topics such as /tf_static have no limit."""
        if topic in self._latched:
            return True
        due_ns = self._due_ns.get(topic, time_ns)
        if time_ns < due_ns:
            return False
        is_on_time = time_ns - due_ns < self._period_ns  # then the next message is due one period after this one was
        self._due_ns[topic] = (due_ns if is_on_time else time_ns) + self._period_ns
        return True

    def _take_messages(self, wait: float = _RECEIVE_TIMEOUT) -> list[ReceivedMessage]:
        """Return received messages, sorted by time; if there are none, wait for them [s, wall time]."""
        if not self._feeds:
            time.sleep(wait)
            return []
        messages: list[ReceivedMessage] = []
        size = 0
        for number, feed in enumerate(self._feeds):
            while size < _BATCH_BYTES:
                received = feed.take(wait if number == 0 and not messages else 0.0)
                if received is None:
                    break
                messages.append(received)
                size += len(received.data)
            if feed.is_over:
                break
        for feed in self._feeds if any(f.is_over for f in self._feeds) else ():
            feed.is_over = True
            while (received := feed.take(0.0)) is not None:
                messages.append(received)
        return sorted(messages, key=lambda r: int(r.time_ns))

    def subscribe(self) -> None:
        """Subscribe to new topics of the selection."""
        if time.monotonic() - self._looked < _DISCOVERY_PERIOD:
            return
        self._looked = time.monotonic()
        fresh = {n: e for n, e in self._source.topics().items() if n in self._selection and n not in self._known}
        if not fresh:
            return
        for name, entry in fresh.items():
            if any(end.latched for end in entry.publishers):
                self._latched.add(name)
        self._feeds.append(self._source.feed(list(fresh), _DEPTH))
        self._known |= set(fresh)
        self._unlisted |= fresh
        for name in fresh:
            print_note(f"[INFO] [rosbag2_recorder]: Subscribed to topic '{name}'")

    def _list_topics(self, bag: McapBag) -> None:
        """Add the new topics to the bag, which lists a topic even if no message arrives."""
        for name, entry in self._unlisted.items():
            for end in entry.publishers[:1] or entry.subscribers[:1]:
                bag.channel(name, end.types[0], end.latched)
        self._unlisted.clear()
