"""Reader of damaged MCAP files: it skips what is damaged and continues with the next record."""

from __future__ import annotations

import errno
import os
import re
import struct
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, NamedTuple

from simkit.input_file import open_input
from simkit.recording.bags.mcap_records import (
    CHANNEL,
    CHUNK,
    DATA_END,
    FOOTER,
    HEAD_SIZE,
    LARGEST_RECORD,
    LATEST_TIME,
    MAGIC,
    MESSAGE,
    MESSAGE_HEAD,
    SCHEMA,
    Channel,
    DamagedRecord,
    Definitions,
    Fields,
    Record,
    Schema,
    chunk_content,
    content_records,
    file_size,
    read_body,
    read_chunk,
    read_record,
)

_RECORD: Final = re.compile(rb"(?=[\x01-\x0f].{4}\0{4})", re.DOTALL)
"""Start of a possible record: a known opcode, and a length below 4 GiB."""
_FOLLOWERS: Final = 3  # records that must follow a possible record, which makes a record by chance improbable
_WINDOW: Final = 1 << 20
_DAMAGE: Final = (ValueError, struct.error, MemoryError)


class RecordedMessage(NamedTuple):
    """Message of an MCAP file with its channel; `number` is that of the channel in the file."""

    time_ns: int
    publish_ns: int
    number: int
    channel: Channel
    schema: Schema
    data: memoryview


@dataclass(frozen=True)
class Loss:
    """Part of a file that cannot be read.

    Attributes:
        position, size: place in the file [bytes].
        is_chunk: True for a chunk; its times are `start` and `end` [ns].
        saved: number of messages that were read from the part.
        is_cut: True for the end of a file that was cut off.
    """

    position: int
    size: int
    reason: str
    is_chunk: bool = False
    start: int | None = None
    end: int | None = None
    saved: int = 0
    is_cut: bool = False


class McapSalvage:
    """Reader of the messages of an MCAP file that may be damaged at any place.

    Attributes:
        losses: damaged parts, in the order of the file; complete after the last message.
        has_end: True if the file has the last bytes of a complete file.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self.losses: list[Loss] = []
        self._definitions = Definitions()
        self.has_end = False
        self._saved = 0

    def messages(self) -> Iterator[RecordedMessage]:
        """Yield the readable messages in the order of the file.

        Raises:
            OSError: the file cannot be read.
        """
        with open_input(self._path) as self._file:
            self._size = file_size(self._file)
            self._file.seek(max(0, self._size - len(MAGIC)))
            self.has_end = self._file.read() == MAGIC
            self._file.seek(0)
            position = len(MAGIC)
            if self._file.read(position) != MAGIC:
                position = self._skip(DamagedRecord(0, "it does not begin as an MCAP file"), None)
            self._read_summary()
            while position < self._size:
                record: Record | None = None
                self._saved = 0
                try:
                    record = read_record(self._file, position, self._size)
                    if record.opcode in (DATA_END, FOOTER):
                        return
                    yield from self._record_messages(record)
                    position = record.end
                except DamagedRecord as error:
                    position = self._skip(error, record)
                except _DAMAGE as error:
                    position = self._skip(DamagedRecord(position, str(error)), record)

    # ------------------------------------------------------------------ messages

    def _record_messages(self, record: Record) -> Iterator[RecordedMessage]:
        if record.opcode == CHUNK:
            chunk = read_chunk(read_body(self._file, record))
            try:
                content = chunk_content(chunk, record.position)
            except DamagedRecord:
                if not chunk.compression:  # the records before the damage are readable
                    yield from self._content_messages(chunk.data, record.position)
                raise
            yield from self._content_messages(content, record.position)
        elif record.opcode in (SCHEMA, CHANNEL, MESSAGE):
            yield from self._message(record.opcode, memoryview(read_body(self._file, record)))

    def _content_messages(self, content: memoryview, position: int) -> Iterator[RecordedMessage]:
        for opcode, body in content_records(content, position):
            yield from self._message(opcode, body)

    def _message(self, opcode: int, body: memoryview) -> Iterator[RecordedMessage]:
        if opcode != MESSAGE:
            self._definitions.add(opcode, body)
            return
        number, _, time_ns, publish_ns = Fields(body).numbers(MESSAGE_HEAD)
        channel = self._definitions.channel(number)
        if time_ns > LATEST_TIME:
            raise ValueError(f"a message has the time {time_ns} ns; the latest of ROS 2 is {LATEST_TIME}")
        self._saved += 1
        schema = self._definitions.schema(channel)
        yield RecordedMessage(time_ns, publish_ns, number, channel, schema, body[MESSAGE_HEAD.size :])

    def _read_summary(self) -> None:
        """Read the schemas and channels at the end of the file, because the chunk that defines them may be damaged."""
        position = self._size - len(MAGIC) - HEAD_SIZE - 20
        try:
            footer = read_record(self._file, position, self._size)
            at = Fields(read_body(self._file, footer)).numbers("<QQI")[0] if footer.opcode == FOOTER else 0
            while 0 < at < position:
                record = read_record(self._file, at, position)
                if record.opcode in (SCHEMA, CHANNEL):
                    self._definitions.add(record.opcode, read_body(self._file, record))
                at = record.end
        except (DamagedRecord, OSError, *_DAMAGE):
            return

    # ------------------------------------------------------------------ damage

    def _skip(self, error: DamagedRecord, record: Record | None) -> int:
        """Note a damaged part, and return the position of the next record.

        The records in an uncompressed chunk without a readable head are found as well.
        """
        is_framed = record is not None and self._is_record(record.end)
        end = record.end if record is not None and is_framed else self._next_record(error.position + 1)
        is_chunk, start, last = self._chunk_times(error.position)
        reason = str(error).partition(": ")[2]
        is_cut = error.is_cut and end >= self._size
        loss = Loss(error.position, end - error.position, reason, is_chunk, start, last, self._saved, is_cut)
        before = self.losses[-1] if self.losses else None
        if before is not None and before.position + before.size == loss.position and not (before.is_chunk or is_chunk):
            loss = replace(before, size=before.size + loss.size, is_cut=is_cut)
            self.losses.pop()
        self.losses.append(loss)
        return end

    def _chunk_times(self, position: int) -> tuple[bool, int | None, int | None]:
        """Return True for the beginning of a chunk, and its first and last time [ns] if its head is plausible."""
        self._file.seek(position)
        head = self._file.read(HEAD_SIZE + 16)
        if len(head) < HEAD_SIZE + 16 or head[0] != CHUNK:
            return False, None, None
        length, start, last = Fields(head[1:]).numbers("<QQQ")
        if length < 16:  # the times are bytes of the next record
            return True, None, None
        return (True, start, last) if start <= last <= LATEST_TIME else (True, None, None)

    def _next_record(self, position: int) -> int:
        """Return the position of the next record; the size of the file if there is none."""
        while (position := self._next_data(position)) < self._size:
            self._file.seek(position)
            window = self._file.read(_WINDOW + HEAD_SIZE - 1)
            for match in _RECORD.finditer(window):
                if self._is_record(position + match.start()):
                    return position + match.start()
            position += _WINDOW
        return self._size

    def _next_data(self, position: int) -> int:
        """Return the next position that is not in a hole of a sparse file, where every byte is zero."""
        if not hasattr(os, "SEEK_DATA"):
            return position
        try:
            return os.lseek(self._file.fileno(), position, os.SEEK_DATA)
        except OSError as error:
            return self._size if error.errno == errno.ENXIO else position

    def _is_record(self, position: int) -> bool:
        """Check whether a record begins at a position: several records must follow it, or the end of the file."""
        if position in (self._size, self._size - len(MAGIC)):
            return True
        for _ in range(_FOLLOWERS):
            try:
                record = read_record(self._file, position, self._size)
            except DamagedRecord:
                return False
            if record.opcode > DATA_END or record.length > LARGEST_RECORD:
                return False
            position = record.end
            if record.opcode == FOOTER:
                return record.length == 20 and position + len(MAGIC) == self._size
            if position == self._size:
                return True
        return True
