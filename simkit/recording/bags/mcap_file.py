"""MCAP file with its messages in the order of their times, read by its index, or without one from start to end."""

from __future__ import annotations

import heapq
import struct
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final, NamedTuple
from zlib import crc32

from simkit.input_file import open_input, read_failure
from simkit.recording.bags.bag_contents import BagMessage, BagTopic, damaged, unreadable
from simkit.recording.bags.mcap_records import (
    CHANNEL,
    CHUNK,
    CHUNK_INDEX,
    DATA_END,
    FOOTER,
    HEAD_SIZE,
    HEADER,
    LARGEST_RECORD,
    LATEST_TIME,
    MAGIC,
    MESSAGE,
    MESSAGE_HEAD,
    SCHEMA,
    STATISTICS,
    DamagedRecord,
    Definitions,
    Fields,
    Record,
    check_size,
    chunk_content,
    content_records,
    file_size,
    read_body,
    read_chunk,
    read_record,
    read_records,
    read_run_metadata,
)

_FOOTER_SIZE: Final = HEAD_SIZE + 20
_MOST_OPEN: Final = 2 * LARGEST_RECORD  # [bytes] of chunks whose times overlap, and which are therefore open together
_RUN_SIZE: Final = 4 << 20  # [bytes] of messages outside chunks that are sorted together
_DAMAGE: Final = (ValueError, struct.error, MemoryError)


class _Message(NamedTuple):
    """Message with its place, which orders messages of one time."""

    time_ns: int
    position: int
    number: int
    channel: int
    data: bytes


@dataclass
class _Segment:
    """Part of a file whose messages are sorted together: a chunk, or a run of messages outside chunks.

    Attributes:
        position, length: place in the file [bytes].
        start, end: times of the first and the last message [ns].
        channels: channels with messages; empty if they are unknown.
        is_chunk: True for a chunk.
    """

    position: int
    length: int
    start: int
    end: int
    channels: frozenset[int] = frozenset()
    is_chunk: bool = True


class McapFile:
    """Open MCAP file; see `BagFile`.

    A file without a usable index is read once from start to end, up to its first damaged record.

    Raises:
        InputError: SK-CLI-035 the file is unreadable.
    """

    storage = "mcap"

    def __init__(self, path: Path) -> None:
        self._path = path
        self.damage, self.start, self.end = "", 0, 0
        self._definitions = Definitions()
        self._counts: Counter[int] = Counter()
        self._segments: list[_Segment] = []
        self._open_size = 0
        try:
            self._file = open_input(path)
        except OSError as error:
            raise unreadable(path, read_failure(error)) from None
        try:
            self._size = file_size(self._file)
            self._check_beginning()
            self.run = read_run_metadata(self._file, self._size)
            try:
                is_indexed = self._read_index()
            except DamagedRecord as damaged:
                self.damage, is_indexed = f"its index is damaged ({damaged})", False
            if not is_indexed:
                self._scan()
                if not self.damage and not self._has_end():
                    self.damage = "its index is missing"
            if self.damage:
                self.damage += f"; recover it with `simkit bag recover {path}`"
        except BaseException as error:
            self._file.close()
            if isinstance(error, OSError):
                raise unreadable(path, read_failure(error)) from None
            raise

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def topics(self) -> list[BagTopic]:
        """Return the topics with their numbers of messages."""
        topics: list[BagTopic] = []
        for number, channel in self._definitions.channels.items():
            try:
                schema = self._definitions.schema(channel)
            except ValueError as error:
                if self._counts[number]:
                    raise damaged(self._path, error) from None
                continue
            entry = (schema.definition, channel.latched, channel.encoding)
            topics.append(BagTopic(channel.topic, schema.name, self._counts[number], *entry))
        return topics

    def messages(self, topics: frozenset[str], start: int | None) -> Iterator[BagMessage]:
        """Yield the messages of some topics (empty: all) from a time [ns] on, in the order of their times.

        Raises:
            InputError: SK-CLI-035 the file is damaged.
        """
        channels = self._definitions.channels
        wanted = frozenset(n for n, channel in channels.items() if not topics or channel.topic in topics)
        segments = [
            segment
            for segment in self._segments
            if (start is None or start <= segment.end) and (not segment.channels or segment.channels & wanted)
        ]
        try:
            for message in heapq.merge(*(self._sorted_messages(s, wanted, start) for s in segments)):
                if message.number:
                    channel = channels[message.channel]
                    type_name = self._definitions.schema(channel).name
                    yield BagMessage(message.time_ns, channel.topic, type_name, message.data)
        except (DamagedRecord, *_DAMAGE) as error:
            raise damaged(self._path, error) from None
        except OSError as error:
            raise unreadable(self._path, read_failure(error)) from None

    # ------------------------------------------------------------------ opening

    def _check_beginning(self) -> None:
        self._file.seek(0)
        magic = self._file.read(len(MAGIC))
        if magic != MAGIC:
            beginning = "it is empty" if not magic else f"it begins with {magic!r}; an MCAP file begins with {MAGIC!r}"
            raise unreadable(self._path, beginning)
        try:
            header = read_record(self._file, len(MAGIC), self._size)
            if header.opcode != HEADER:
                raise DamagedRecord(len(MAGIC), f"found opcode {header.opcode}; expected the header")
        except DamagedRecord as error:
            raise unreadable(self._path, error) from None
        self._data_start = header.end

    def _has_end(self) -> bool:
        if self._size < self._data_start + _FOOTER_SIZE + len(MAGIC):
            return False
        self._file.seek(self._size - len(MAGIC))
        return self._file.read() == MAGIC

    def _read_index(self) -> bool:
        """Read the summary at the end of the file; return False if it has no index of the chunks.

        Raises:
            DamagedRecord: the summary is damaged.
        """
        if not self._has_end():
            return False
        position = self._size - _FOOTER_SIZE - len(MAGIC)
        footer = read_record(self._file, position, self._size)
        if (footer.opcode, footer.length) != (FOOTER, 20):
            raise DamagedRecord(position, f"found opcode {footer.opcode}; expected the footer")
        summary_start, _, checksum = Fields(read_body(self._file, footer)).numbers("<QQI")
        if summary_start == 0:
            return False
        if not self._data_start <= summary_start <= position:
            raise DamagedRecord(position, f"the summary cannot begin at byte {summary_start}")
        check_size(summary_start, "a summary", position - summary_start)
        self._file.seek(summary_start)
        summary = self._file.read(position + _FOOTER_SIZE - 4 - summary_start)
        if checksum and crc32(summary) != checksum:
            raise DamagedRecord(summary_start, "the checksum of the summary is wrong")
        try:
            return self._index(memoryview(summary)[: position - summary_start], summary_start)
        except _DAMAGE as error:
            raise DamagedRecord(summary_start, str(error)) from None

    def _index(self, summary: memoryview, position: int) -> bool:
        definitions, counts, segments = Definitions(), Counter[int](), dict[int, _Segment]()
        total = chunks = start = end = 0
        for opcode, body in content_records(summary, position):
            fields = Fields(body)
            definitions.add(opcode, body)
            if opcode == STATISTICS:
                total, *_, chunks, start, end = fields.numbers("<QHIIIIQQ")
                counts.update(dict(struct.iter_unpack("<HQ", fields.block())))
            elif opcode == CHUNK_INDEX:
                first, last, at, length = fields.numbers("<QQQQ")
                channels = frozenset(number for number, _ in struct.iter_unpack("<HQ", fields.block()))
                fields.numbers("<Q"), fields.text()
                check_size(at, "a chunk", fields.numbers("<QQ")[1])
                segments[at] = _Segment(at, length, first, last, channels)
        if not total:
            return False
        is_complete = len(segments) == chunks > 0 and all(n in definitions.channels for n, c in counts.items() if c)
        if is_complete and sum(counts.values()) == total:
            if not start <= end <= LATEST_TIME:
                raise ValueError(f"the messages cannot lie between {start} and {end} ns")
            self._definitions, self._counts, self._segments = definitions, counts, [*segments.values()]
            self.start, self.end = start, end
            return True
        return False

    def _scan(self) -> None:
        """Read the file from start to end, up to the first damaged record.

        Raises:
            InputError: SK-CLI-035 the file has no readable message before the damage, or a record exceeds a limit.
        """
        run: _Segment | None = None
        try:
            for record in read_records(self._file, self._data_start, self._size):
                if record.opcode in (DATA_END, FOOTER):
                    return
                if record.opcode == CHUNK:
                    self._scan_chunk(record)
                elif record.opcode in (SCHEMA, CHANNEL):
                    self._definitions.add(record.opcode, read_body(self._file, record))
                elif record.opcode == MESSAGE:
                    if run is None or record.position != run.position + run.length or run.length > _RUN_SIZE:
                        run = _Segment(record.position, 0, LATEST_TIME, 0, frozenset(), is_chunk=False)
                        self._segments.append(run)
                    self._count_message(run, self._file.read(MESSAGE_HEAD.size), record)
                    run.length = record.end - run.position
            raise DamagedRecord(self._size, "the end is missing", is_cut=True)
        except DamagedRecord as error:
            self._stop_scan(error)
        except _DAMAGE as error:
            self._stop_scan(DamagedRecord(record.position, str(error)))

    def _stop_scan(self, error: DamagedRecord) -> None:
        has_end = self._has_end()
        if error.is_too_large or (not self._counts and (has_end or not error.is_cut)):
            raise damaged(self._path, error)
        if not self._counts:
            self.damage = "the recording was cut off before the first message"
        else:
            state = "the recording was cut off" if error.is_cut and not has_end else "the file is damaged"
            self.damage = f"{state} ({error})"

    def _scan_chunk(self, record: Record) -> None:
        chunk = read_chunk(read_body(self._file, record))
        segment = _Segment(record.position, record.end - record.position, LATEST_TIME, 0)
        content = chunk_content(chunk, record.position)
        counted: list[tuple[int, int]] = []
        for opcode, body in content_records(content, record.position):
            if opcode in (SCHEMA, CHANNEL):
                self._definitions.add(opcode, body)
            elif opcode == MESSAGE:
                counted.append(self._head(body, record.position))
        for channel, time_ns in counted:  # all or none, because `messages` reads whole chunks
            self._count(segment, channel, time_ns)
        segment.channels = frozenset(channel for channel, _ in counted)
        if counted:
            self._segments.append(segment)

    def _count_message(self, run: _Segment, head: bytes, record: Record) -> None:
        check_size(record.position, "a message", record.length)
        self._count(run, *self._head(head[: record.length], record.position))

    def _count(self, segment: _Segment, channel: int, time_ns: int) -> None:
        self.start = min(self.start, time_ns) if self._counts else time_ns
        self.end = max(self.end, time_ns)
        segment.start, segment.end = min(segment.start, time_ns), max(segment.end, time_ns)
        self._counts[channel] += 1

    # ------------------------------------------------------------------ messages

    def _head(self, body: bytes | memoryview, position: int) -> tuple[int, int]:
        """Return the channel and the time [ns] of a message.

        Raises:
            ValueError, struct.error, DamagedRecord: the message is damaged.
        """
        channel, _, time_ns, _ = Fields(body).numbers(MESSAGE_HEAD)
        self._definitions.channel(channel)
        if time_ns > LATEST_TIME:
            raise DamagedRecord(position, f"a message has the time {time_ns} ns; the latest of ROS 2 is {LATEST_TIME}")
        return channel, time_ns

    def _sorted_messages(self, segment: _Segment, wanted: frozenset[int], start: int | None) -> Iterator[_Message]:
        """Yield the messages of a segment, sorted by time, after an empty message (`number` is 0) with its start.

        `heapq.merge` takes the first item of every segment, so the content is read after the first item.
        """
        yield _Message(segment.start, segment.position, 0, 0, b"")
        size = 0
        try:
            if segment.is_chunk:
                content = self._chunk_content(segment)
                records = content_records(content, segment.position)
                bodies: Iterator[memoryview] = (body for opcode, body in records if opcode == MESSAGE)
                size = len(content)
            else:
                bodies = self._run_bodies(segment)
                size = segment.length
            self._open_size += size
            if self._open_size > _MOST_OPEN:
                raise DamagedRecord(segment.position, f"chunks of more than {_MOST_OPEN >> 20} MiB overlap in time")
            heads = [(*self._head(body, segment.position), body) for body in bodies]
            chosen = [h for h in heads if h[0] in wanted and (start is None or h[1] >= start)]
            for number, (channel, time_ns, body) in enumerate(sorted(chosen, key=lambda h: h[1]), 1):
                yield _Message(time_ns, segment.position, number, channel, bytes(body[MESSAGE_HEAD.size :]))
        finally:
            self._open_size -= size

    def _chunk_content(self, segment: _Segment) -> memoryview:
        record = read_record(self._file, segment.position, self._size)
        if record.opcode != CHUNK or record.end - record.position != segment.length:
            raise DamagedRecord(segment.position, "the index names a chunk here, but there is none")
        content = chunk_content(read_chunk(read_body(self._file, record)), segment.position)
        for opcode, body in content_records(content, segment.position):
            self._definitions.add(opcode, body)
        return content

    def _run_bodies(self, segment: _Segment) -> Iterator[memoryview]:
        for record in read_records(self._file, segment.position, segment.position + segment.length):
            yield memoryview(read_body(self._file, record))
