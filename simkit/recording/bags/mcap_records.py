"""Records of MCAP files, read with limits, because a file can be damaged or made to fill the memory.

The format is described at https://mcap.dev/spec. Each record is an opcode, a length and a body. A chunk is a record
with other records in its body, usually compressed. The libraries `mcap` and `rosbags` decompress it without a limit.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Iterator
from io import BufferedReader
from typing import Final, NamedTuple
from zlib import crc32

from simkit.number_text import counted

MAGIC: Final = b"\x89MCAP0\r\n"
LARGEST_RECORD: Final = 512 << 20  # [bytes] of a record, and of the content of a chunk; 4096 x 4096 points have 256 MiB
LATEST_TIME: Final = (1 << 63) - 1  # [ns], largest time of ROS 2
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, CHUNK_INDEX, STATISTICS = 1, 2, 3, 4, 5, 6, 8, 11
METADATA, DATA_END = 12, 15
RUN_METADATA: Final = "simkit run"
"""Name of the metadata, the first record after the header, that describe the recorded run."""
HEAD_SIZE: Final = 9  # [bytes] of opcode and length
MESSAGE_HEAD: Final = struct.Struct("<HIQQ")  # channel, sequence number, recording time, publication time
_HEAD: Final = struct.Struct("<BQ")
_CHUNK_HEAD: Final = struct.Struct("<QQQI")  # first time, last time, size of the content, checksum of the content
_LATCHED: Final = re.compile(r"durability['\"]?\s*:\s*['\"]?(?:transient_local\b|1\b)", re.IGNORECASE)


class DamagedRecord(Exception):
    """Record that cannot be read; the message has the reason.

    Attributes:
        position: first byte of the record in the file.
        is_cut: True if the file ends inside the record.
        is_too_large: True if the record exceeds a limit.
    """

    def __init__(self, position: int, reason: str, *, is_cut: bool = False, is_too_large: bool = False) -> None:
        super().__init__(f"byte {position}: {reason}")
        self.position, self.is_cut, self.is_too_large = position, is_cut, is_too_large


class Record(NamedTuple):
    """Place of a record in a file; `length` [bytes] is that of the body."""

    position: int
    opcode: int
    length: int

    @property
    def end(self) -> int:
        return self.position + HEAD_SIZE + self.length


class Schema(NamedTuple):
    """Message type with its definition, in the language `encoding`."""

    name: str
    encoding: str
    data: bytes

    @property
    def definition(self) -> str:
        """Definition as ROS 2 text; empty if the definition is in another language."""
        return self.data.decode(errors="replace") if self.encoding == "ros2msg" else ""


class Channel(NamedTuple):
    """Topic with the number of its schema."""

    schema_id: int
    topic: str
    encoding: str
    metadata: dict[str, str]

    @property
    def latched(self) -> bool:
        """Check whether the publisher kept the last message for late subscribers."""
        return is_latched(self.metadata.get("offered_qos_profiles", ""))


class Chunk(NamedTuple):
    """Chunk with its compressed content, and the times [ns] of its first and its last message."""

    start: int
    end: int
    size: int
    checksum: int
    compression: str
    data: memoryview


def is_latched(profiles: str) -> bool:
    """Check whether QoS profiles, a YAML text, have the durability `transient_local`.

    The text is not parsed as YAML, because a text from a stranger can be nested too deeply.
    """
    return bool(_LATCHED.search(profiles))


class Fields:
    """Reader of the fields of a record's body. It raises ValueError if a field exceeds the body."""

    def __init__(self, body: bytes | memoryview) -> None:
        self._body, self._at = memoryview(body), 0

    def numbers(self, layout: str | struct.Struct) -> tuple[int, ...]:
        """Return numbers in the layout of the module `struct`."""
        layout = struct.Struct(layout) if isinstance(layout, str) else layout
        if layout.size > len(self._body) - self._at:
            raise ValueError(f"a record of {counted(len(self._body), 'byte')} is too short for its fields")
        numbers: tuple[int, ...] = layout.unpack_from(self._body, self._at)
        self._at += layout.size
        return numbers

    def block(self, layout: str = "<I") -> memoryview:
        """Return the bytes after their number."""
        (size,) = self.numbers(layout)
        if size > len(self._body) - self._at:
            raise ValueError(f"a field of {size} bytes exceeds its record")
        self._at += size
        return self._body[self._at - size : self._at]

    def text(self) -> str:
        """Return a text."""
        return str(self.block(), "utf-8")

    def texts(self) -> dict[str, str]:
        """Return a table of texts."""
        table, texts = Fields(self.block()), {}
        while table._at < len(table._body):
            key = table.text()
            texts[key] = table.text()
        return texts


class Definitions:
    """Schemas and channels of a file, by their numbers.

    A number with two meanings is an error, because messages could not be assigned to a topic.
    """

    def __init__(self) -> None:
        self.schemas: dict[int, Schema] = {}
        self.channels: dict[int, Channel] = {}

    def add(self, opcode: int, body: bytes | memoryview) -> None:
        """Add the schema or the channel of a record.

        Raises:
            ValueError, struct.error: the record is damaged.
        """
        fields = Fields(body)
        if opcode == SCHEMA:
            (number,) = fields.numbers("<H")
            schema = Schema(fields.text(), fields.text(), bytes(fields.block()))
            if self.schemas.setdefault(number, schema) != schema:
                raise ValueError(f"schema {number} is defined twice")
        elif opcode == CHANNEL:
            number, schema_id = fields.numbers("<HH")
            channel = Channel(schema_id, fields.text(), fields.text(), fields.texts())
            if self.channels.setdefault(number, channel) != channel:
                raise ValueError(f"channel {number} is defined twice")

    def channel(self, number: int) -> Channel:
        """Return a channel.

        Raises:
            ValueError: the channel or its schema is not defined.
        """
        channel = self.channels.get(number)
        if channel is None:
            raise ValueError(f"channel {number} of a message is not defined")
        self.schema(channel)
        return channel

    def schema(self, channel: Channel) -> Schema:
        """Return the schema of a channel; an empty one for a channel without a schema.

        Raises:
            ValueError: the schema is not defined.
        """
        if channel.schema_id == 0:
            return Schema("__schemaless__", "", b"")
        schema = self.schemas.get(channel.schema_id)
        if schema is None:
            raise ValueError(f"schema {channel.schema_id} of the topic {channel.topic!r} is not defined")
        return schema


def file_size(file: BufferedReader) -> int:
    """Return the size of an open file [bytes]."""
    return file.seek(0, 2)


def read_record(file: BufferedReader, position: int, size: int) -> Record:
    """Return the record at a position of a file of `size` bytes, without its body.

    Raises:
        DamagedRecord: there is no record.
    """
    file.seek(position)
    head = file.read(HEAD_SIZE)
    if len(head) < HEAD_SIZE:
        raise DamagedRecord(position, "the file ends inside a record", is_cut=True)
    opcode, length = _HEAD.unpack(head)
    if opcode == 0:
        raise DamagedRecord(position, "there is no record (opcode 0)")
    if length > size - position - HEAD_SIZE:
        reason = f"the file ends inside a record of {counted(length, 'byte')}"
        raise DamagedRecord(position, reason, is_cut=True)
    return Record(position, opcode, length)


def read_records(file: BufferedReader, position: int, end: int) -> Iterator[Record]:
    """Yield the records of a part of a file.

    Raises:
        DamagedRecord: there is no record at some position.
    """
    while position < end:
        record = read_record(file, position, end)
        yield record
        position = record.end


def read_body(file: BufferedReader, record: Record) -> bytes:
    """Return the body of a record.

    Raises:
        DamagedRecord: the body exceeds the limit.
    """
    check_size(record.position, "a record", record.length)
    file.seek(record.position + HEAD_SIZE)
    return file.read(record.length)


def read_run_metadata(file: BufferedReader, size: int) -> dict[str, str]:
    """Return the metadata of the recorded run; empty if a file of `size` bytes has none."""
    try:
        record = read_record(file, read_record(file, len(MAGIC), size).end, size)
        if record.opcode == METADATA:
            fields = Fields(read_body(file, record))
            return fields.texts() if fields.text() == RUN_METADATA else {}
    except (DamagedRecord, ValueError, struct.error):
        pass  # the reader of the messages reports it
    return {}


def check_size(position: int, what: str, size: int) -> None:
    """Check a size [bytes] against the limit.

    Raises:
        DamagedRecord: the size exceeds the limit.
    """
    if size > LARGEST_RECORD:
        reason = f"{what} of {size} bytes; the largest that simkit reads has {LARGEST_RECORD >> 20} MiB"
        raise DamagedRecord(position, reason, is_too_large=True)


def read_chunk(body: bytes) -> Chunk:
    """Return the chunk in the body of a record, still compressed.

    Raises:
        ValueError, struct.error: the record is damaged.
    """
    fields = Fields(body)
    start, end, size, checksum = fields.numbers(_CHUNK_HEAD)
    return Chunk(start, end, size, checksum, fields.text(), fields.block("<Q"))


def chunk_content(chunk: Chunk, position: int) -> memoryview:
    """Return the content of a chunk. Its stated size is checked before and during the decompression.

    Raises:
        DamagedRecord: the content is damaged or exceeds the limit.
    """
    check_size(position, "a chunk", chunk.size)
    try:
        content = decompress(chunk.compression, chunk.data, chunk.size)
    except ValueError as error:
        raise DamagedRecord(position, f"a chunk cannot be decompressed: {error}") from None
    if len(content) != chunk.size:
        size = f"more than {chunk.size}" if len(content) > chunk.size else str(len(content))
        raise DamagedRecord(position, f"a chunk has {size} bytes, but its head says {chunk.size}")
    if chunk.checksum and crc32(content) != chunk.checksum:
        raise DamagedRecord(position, "the checksum of a chunk is wrong")
    return memoryview(content)


def decompress(compression: str, data: bytes | memoryview, limit: int) -> bytes | memoryview:
    """Decompress `data` up to one byte more than `limit`.

    Args:
        compression: `zstd`, `lz4`, or empty for no compression.
        data: compressed data.
        limit: expected or largest size [bytes].

    Raises:
        ValueError: the data is damaged, or the compression is unknown.
    """
    if not compression:
        return data
    if compression not in ("zstd", "lz4"):
        raise ValueError(f"its compression {compression!r} is unknown; expected zstd, lz4 or none")
    try:
        if compression == "zstd":
            import zstandard

            return zstandard.ZstdDecompressor().stream_reader(data, read_across_frames=True).read(limit + 1)
        from lz4.frame import LZ4FrameDecompressor  # type: ignore[import-untyped]

        content: bytes = LZ4FrameDecompressor().decompress(bytes(data), max_length=limit + 1)
        return content
    except Exception as error:  # noqa: BLE001 - each library has its own errors
        raise ValueError(str(error).strip() or type(error).__name__) from None


def content_records(content: memoryview, position: int) -> Iterator[tuple[int, memoryview]]:
    """Yield the opcodes and bodies of the records in the content of a chunk.

    Args:
        content: uncompressed content.
        position: first byte of the chunk in the file, for messages.

    Raises:
        DamagedRecord: there is no record at some place of the content.
    """
    at, size = 0, len(content)
    while at < size:
        opcode, length = _HEAD.unpack_from(content, at) if at + HEAD_SIZE <= size else (0, 0)
        at += HEAD_SIZE + length
        if opcode == 0 or at > size:
            raise DamagedRecord(position, f"byte {at - length - HEAD_SIZE} of the content of a chunk is not a record")
        yield opcode, content[at - length : at]
