"""Writer of MCAP files. It writes the same bytes as `mcap.writer.Writer`, and a message takes a fifth of the time."""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from typing import IO, Final
from zlib import crc32

import numpy as np

from simkit.recording.bags.mcap_records import (
    CHANNEL,
    CHUNK,
    CHUNK_INDEX,
    DATA_END,
    FOOTER,
    HEADER,
    MAGIC,
    MESSAGE,
    METADATA,
    SCHEMA,
    STATISTICS,
)

_MESSAGE_INDEX, _ATTACHMENT_INDEX, _METADATA_INDEX, _SUMMARY_OFFSET = 7, 10, 13, 14
_COMPRESSION: Final = "zstd"
_pack_message_head = struct.Struct("<BQHIQQ").pack  # opcode, length, and the fields of `mcap_records.MESSAGE_HEAD`
_HEAD_FIELDS: Final = ("opcode", "length", "channel", "sequence", "time", "publish")
_HEADS: Final = np.dtype(list(zip(_HEAD_FIELDS, ("u1", "<u8", "<u2", "<u4", "<u8", "<u8"), strict=True)))
_LENGTH_BYTES: Final = 9  # opcode and length
_MESSAGE_HEAD_BYTES: Final = 22
_PLACE_BYTES: Final = 16
_pack_place = struct.Struct("<QQ").pack  # time and place of a message
_FEW: Final = 8  # fewer messages are faster one by one


def _text(value: str) -> bytes:
    encoded = value.encode()
    return struct.pack("<I", len(encoded)) + encoded


def _record(opcode: int, *parts: bytes | bytearray) -> bytes:
    return struct.pack("<BQ", opcode, sum(map(len, parts))) + b"".join(parts)


def _table(numbers: dict[int, int]) -> bytes:
    """Return a table of 64-bit numbers by 16-bit numbers."""
    rows = (struct.pack("<HQ", key, value) for key, value in numbers.items())
    return struct.pack("<I", len(numbers) * 10) + b"".join(rows)


class McapWriter:
    """Writer of an MCAP file with compressed chunks and a summary.

    A thread compresses and writes the chunks, so that a simulation does not wait for them. At most one chunk waits for
    the thread; an error of the thread is raised with the next chunk.

    Args:
        file: file to write to.
        profile: profile of the file; `ros2` for messages in CDR.
        library: name of the program that writes the file.
        chunk_bytes: size [bytes] above which a chunk is completed.
    """

    def __init__(self, file: IO[bytes], profile: str, library: str, chunk_bytes: int) -> None:
        self._file, self._chunk_bytes = file, chunk_bytes
        self._position = 0
        self._schemas: list[bytes] = []
        self._channels: list[bytes] = []
        self._chunk_indexes: list[bytes] = []
        self._metadata_indexes: list[bytes] = []
        self._counts: dict[int, int] = {}
        self._start = self._end = 0
        self._thread = ThreadPoolExecutor(1, "mcap")
        self._written: Future[None] | None = None
        self._begin_chunk()
        self._write(MAGIC + _record(HEADER, _text(profile), _text(library)))

    def _begin_chunk(self) -> None:
        self._content = bytearray()
        self._indexes: dict[int, bytearray] = {}  # times and places in the chunk, alternately, by channel
        self._chunk_start = self._chunk_end = 0

    def add_metadata(self, name: str, texts: Mapping[str, str]) -> None:
        """Write metadata; before the first message, because the thread does not write chunks then."""
        pairs = b"".join(_text(key) + _text(value) for key, value in texts.items())
        record = _record(METADATA, _text(name), struct.pack("<I", len(pairs)), pairs)
        place = struct.pack("<QQ", self._position, len(record))
        self._metadata_indexes.append(_record(_METADATA_INDEX, place, _text(name)))
        self._write(record)

    def register_schema(self, name: str, encoding: str, data: bytes) -> int:
        """Add a message type with its definition in a language; return its number."""
        number = len(self._schemas) + 1
        size = struct.pack("<I", len(data))
        self._schemas.append(_record(SCHEMA, struct.pack("<H", number), _text(name), _text(encoding), size, data))
        self._add(self._schemas[-1])
        return number

    def register_channel(self, topic: str, encoding: str, schema_id: int, metadata: dict[str, str]) -> int:
        """Add a topic; return its number."""
        number = len(self._channels) + 1
        pairs = b"".join(_text(key) + _text(value) for key, value in metadata.items())
        head, size = struct.pack("<HH", number, schema_id), struct.pack("<I", len(pairs))
        self._channels.append(_record(CHANNEL, head, _text(topic), _text(encoding), size, pairs))
        self._add(self._channels[-1])
        return number

    def _add(self, record: bytes) -> None:
        self._content += record
        if len(self._content) > self._chunk_bytes:
            self.end_chunk()

    def count(self, channel_id: int) -> int:
        """Return the number of messages of a channel so far."""
        return self._counts.get(channel_id, 0) + len(self._indexes.get(channel_id, b"")) // _PLACE_BYTES

    def add_message(self, channel_id: int, time_ns: int, data: bytes, publish_ns: int, sequence: int) -> None:
        """Add a message with its recording time, publication time and sequence number."""
        content, index = self._content, self._indexes.get(channel_id)
        if index is None:
            index = self._begin_index(channel_id, time_ns)
        index += _pack_place(time_ns, len(content))
        self._chunk_start, self._chunk_end = min(self._chunk_start, time_ns), max(self._chunk_end, time_ns)
        size = _MESSAGE_HEAD_BYTES + len(data)
        content += _pack_message_head(MESSAGE, size, channel_id, sequence, time_ns, publish_ns)
        content += data
        if len(content) > self._chunk_bytes:
            self.end_chunk()

    def add_messages(self, channel_ids: Sequence[int], times: Sequence[int], data: Sequence[bytes]) -> None:
        """Add messages with their recording times [ns], which are also those of publication.

        The sequence number of a message is the number of earlier messages of its channel. Many messages in one call
        take a fifth of the time of `add_message`.
        """
        sizes = list(map(len, data))
        total = len(self._content) + sum(sizes) + len(sizes) * _HEADS.itemsize
        if len(sizes) < _FEW or total > self._chunk_bytes:
            for channel_id, time_ns, content in zip(channel_ids, times, data, strict=True):
                self.add_message(channel_id, time_ns, content, time_ns, self.count(channel_id))
            return
        heads, places = np.empty(len(sizes), _HEADS), np.empty((len(sizes), 2), "<u8")
        lengths = np.array(sizes) + _MESSAGE_HEAD_BYTES
        begins = np.cumsum(lengths + _LENGTH_BYTES) + (len(self._content) - _LENGTH_BYTES) - lengths
        heads["opcode"], heads["length"], heads["channel"] = MESSAGE, lengths, channel_ids
        heads["time"] = heads["publish"] = places[:, 0] = times
        places[:, 1] = begins
        numbers, sequences = np.array(channel_ids), np.empty(len(sizes), np.int64)
        for channel_id in dict.fromkeys(channel_ids):
            index = self._indexes.get(channel_id)
            if index is None:
                index = self._begin_index(channel_id, times[0])
            rows, first = np.flatnonzero(numbers == channel_id), self.count(channel_id)
            sequences[rows] = np.arange(first, first + len(rows))
            index += places[rows].tobytes()
        heads["sequence"] = sequences
        self._chunk_start, self._chunk_end = min(self._chunk_start, *times), max(self._chunk_end, *times)
        head_bytes, size = heads.tobytes(), _HEADS.itemsize
        pieces = [b""] * (2 * len(sizes))
        pieces[::2] = [head_bytes[at : at + size] for at in range(0, len(head_bytes), size)]
        pieces[1::2] = data
        self._content += b"".join(pieces)

    def _begin_index(self, channel_id: int, time_ns: int) -> bytearray:
        """Return the new table of the places of a channel's messages in the chunk."""
        index = self._indexes[channel_id] = bytearray()
        if len(self._indexes) == 1:
            self._chunk_start = time_ns
            self._start = min(self._start, time_ns) if self._counts else time_ns
        self._counts.setdefault(channel_id, 0)
        return index

    def flush(self) -> None:
        """Complete the chunk and pass all data to the operating system."""
        self.end_chunk()
        self._wait()
        self._file.flush()

    def end_chunk(self) -> None:
        """Complete the chunk; the thread writes it. Without messages, the records stay for the next chunk."""
        if not self._indexes:
            return
        content, indexes, start, end = self._content, self._indexes, self._chunk_start, self._chunk_end
        self._begin_chunk()
        self._start, self._end = min(self._start, start), max(self._end, end)
        for channel_id, index in indexes.items():
            self._counts[channel_id] += len(index) // _PLACE_BYTES
        self._wait()
        self._written = self._thread.submit(self._write_chunk, content, indexes, start, end)

    def _wait(self) -> None:
        """Wait until the last chunk is written, and raise the error of writing it."""
        written, self._written = self._written, None
        if written is not None:
            written.result()

    def _write(self, data: bytes) -> None:
        self._file.write(data)
        self._position += len(data)

    def _write_chunk(self, content: bytearray, indexes: dict[int, bytearray], start: int, end: int) -> None:
        """Write a chunk and the places of its messages."""
        import zstandard

        compressed = zstandard.compress(content)
        times, kind, size = struct.pack("<QQ", start, end), _text(_COMPRESSION), len(compressed)
        position, check = self._position, struct.pack("<QI", len(content), crc32(content))
        self._write(_record(CHUNK, times, check, kind, struct.pack("<Q", size), compressed))
        index_position, places, records = self._position, {}, []
        length = 0
        for channel_id, index in indexes.items():
            places[channel_id] = index_position + length
            records.append(_record(_MESSAGE_INDEX, struct.pack("<HI", channel_id, len(index)), index))
            length += len(records[-1])
        self._write(b"".join(records))
        place = struct.pack("<QQ", position, index_position - position), _table(places), struct.pack("<Q", length)
        self._chunk_indexes.append(_record(CHUNK_INDEX, times, *place, kind, struct.pack("<QQ", size, len(content))))
        self._file.flush()

    def finish(self) -> None:
        """Write the summary; the file is complete afterwards."""
        self.end_chunk()
        try:
            self._wait()
        finally:
            self._thread.shutdown()
        self._write(_record(DATA_END, bytes(4)))
        start, summary, offsets = self._position, bytearray(), bytearray()
        groups: tuple[tuple[int, list[bytes]], ...] = (
            (SCHEMA, self._schemas),
            (CHANNEL, self._channels),
            (STATISTICS, [self._statistics()]),
            (CHUNK_INDEX, self._chunk_indexes),
            (_ATTACHMENT_INDEX, []),
            (_METADATA_INDEX, self._metadata_indexes),
        )
        for opcode, records in groups:
            group = b"".join(records)
            offsets += _record(_SUMMARY_OFFSET, struct.pack("<BQQ", opcode, start + len(summary), len(group)))
            summary += group
        positions = struct.pack("<QQ", start, start + len(summary))
        summary += offsets
        checksum = crc32(struct.pack("<BQ", FOOTER, 20) + positions, crc32(summary))
        self._write(bytes(summary))
        self._write(_record(FOOTER, positions, struct.pack("<I", checksum)) + MAGIC)

    def _statistics(self) -> bytes:
        total, numbers = sum(self._counts.values()), (len(self._schemas), len(self._channels))
        counts = struct.pack("<QHIIII", total, *numbers, 0, len(self._metadata_indexes), len(self._chunk_indexes))
        return _record(STATISTICS, counts, struct.pack("<QQ", self._start, self._end), _table(self._counts))
