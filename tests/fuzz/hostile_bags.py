"""Small MCAP files, and damage to them: bytes, lengths, chunks, schemas and times."""

from __future__ import annotations

import io
import random
import struct
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from zlib import crc32

import zstandard
from mcap.writer import CompressionType, Writer

from simkit import msgs

MAGIC = b"\x89MCAP0\r\n"
FLOAT = "std_msgs/msg/Float64"
SECOND = 1_000_000_000
KINDS = {"zstd": CompressionType.ZSTD, "lz4": CompressionType.LZ4, "none": CompressionType.NONE}
HEADER = struct.pack("<BQ", 1, 12) + struct.pack("<I", 4) + b"ros2" + struct.pack("<I", 0)
END = struct.pack("<BQI", 15, 4, 0) + struct.pack("<BQQQI", 2, 20, 0, 0, 0) + MAGIC


@dataclass(frozen=True)
class Made:
    """Recipe of a bag with one topic.

    Attributes:
        compression: `zstd`, `lz4`, `none`, or `plain` for messages outside chunks.
        text: definition of the type; None for simkit's own.
        data: bytes of each message; None for the number of the message.
        first: time of the first message [ns]; a message each second.
    """

    compression: str = "zstd"
    topic: str = "/number"
    type_name: str = FLOAT
    text: str | None = None
    data: bytes | None = None
    encoding: str = "cdr"
    first: int = 0
    count: int = 20

    def content(self) -> bytes:
        """Return the bytes of the file, about five messages in a chunk."""
        return _content(self)


@cache
def _content(made: Made) -> bytes:
    file = io.BytesIO()
    compression = KINDS.get(made.compression, CompressionType.NONE)
    writer = Writer(file, chunk_size=200, compression=compression, use_chunking=made.compression != "plain")
    writer.start(profile="ros2", library="test")
    text = msgs.definition(made.type_name) if made.text is None else made.text
    schema = writer.register_schema(made.type_name, "ros2msg", text.encode())
    channel = writer.register_channel(made.topic, made.encoding, schema, {})
    for i in range(made.count):
        data = msgs.serialize(msgs.make(FLOAT, data=float(i))) if made.data is None else made.data
        writer.add_message(channel, made.first + i * SECOND, data, made.first + i * SECOND, i)
    writer.finish()
    return file.getvalue()


def records(content: bytes) -> list[tuple[int, int, int]]:
    """Return opcode, position and length of each record outside chunks."""
    found, at = [], len(MAGIC)
    while at + 9 <= len(content) - len(MAGIC):
        opcode, length = struct.unpack_from("<BQ", content, at)
        found.append((opcode, at, length))
        at += 9 + length
    return found


def chunks(content: bytes) -> list[tuple[int, int]]:
    """Return position and size of each chunk's record."""
    return [(at, 9 + length) for opcode, at, length in records(content) if opcode == 6]


def with_damaged_chunk(content: bytes, number: int) -> bytes:
    """Return the file with other bytes at the end of a chunk's content."""
    at, size = chunks(content)[number]
    return content[: at + size - 20] + b"\xaa" * 20 + content[at + size :]


def chunk_record(data: bytes, claim: int, compression: bytes = b"zstd", checksum: int = 0) -> bytes:
    """Return the record of a chunk that claims a size."""
    head = struct.pack("<QQQI", 0, 1, claim, checksum) + struct.pack("<I", len(compression)) + compression
    body = head + struct.pack("<Q", len(data)) + data
    return struct.pack("<BQ", 6, len(body)) + body


@cache
def zeros(size: int) -> bytes:
    """Return `size` zeros, compressed with zstd."""
    compressor, piece = zstandard.ZstdCompressor(level=1).compressobj(), b"\0" * (1 << 20)
    return b"".join([*(compressor.compress(piece) for _ in range(size >> 20)), compressor.flush()])


def mutated(content: bytes, chance: random.Random) -> bytes:
    """Return the file with one to three mutations; most are in heads of records, some fix the checksum of a chunk."""
    for _ in range(chance.choice((1, 1, 2, 3))):
        content = chance.choice(MUTATIONS)(content, chance) if content else content
    return content


def _bytes(content: bytes, chance: random.Random) -> bytes:
    changed = bytearray(content)
    for _ in range(chance.randint(1, 8)):
        changed[chance.randrange(len(changed))] = chance.randrange(256)
    return bytes(changed)


def _head(content: bytes, chance: random.Random) -> bytes:
    """Change the opcode or the length of a record."""
    _, at, length = chance.choice(records(content) or [(0, 0, 0)])
    if chance.random() < 0.3:
        return content[:at] + bytes([chance.randrange(256)]) + content[at + 1 :]
    lie = chance.choice((0, 1, 22, length - 1, length + 1, length * 2, 1 << 31, 1 << 40, (1 << 64) - 1)) % (1 << 64)
    return content[: at + 1] + struct.pack("<Q", lie) + content[at + 9 :]


def _number(content: bytes, chance: random.Random) -> bytes:
    """Write an unusual number near the beginning of a record: times, sizes, checksums, numbers of channels."""
    _, at, length = chance.choice(records(content) or [(0, 0, 8)])
    at += 9 + chance.randrange(max(1, min(length, 40)))
    value = chance.choice((0, 1, 0x7F, 1 << 31, (1 << 32) - 1, 1 << 62, (1 << 63) - 1, 1 << 63, (1 << 64) - 1))
    return content[:at] + struct.pack("<Q", value) + content[at + 8 :]


def _cut(content: bytes, chance: random.Random) -> bytes:
    return content[: chance.randrange(len(content))]


def _remove(content: bytes, chance: random.Random) -> bytes:
    _, at, length = chance.choice(records(content) or [(0, 0, 0)])
    return content[:at] + content[at + 9 + length :]


def _repeat(content: bytes, chance: random.Random) -> bytes:
    _, at, length = chance.choice(records(content) or [(0, 0, 0)])
    return (
        content[: at + 9 + length] + content[at : at + 9 + length] * chance.randint(1, 5) + content[at + 9 + length :]
    )


def _inside(content: bytes, chance: random.Random) -> bytes:
    """Change the content of a chunk, and write the new sizes and the new checksum."""
    found = chunks(content)
    if not found:
        return _bytes(content, chance)
    at, size = chance.choice(found)
    if content[at + 37 : at + 45] != b"\x04\0\0\0zstd":
        return _bytes(content, chance)
    try:
        inner = zstandard.decompress(content[at + 53 : at + size])
    except zstandard.ZstdError:
        return content
    inner = chance.choice((_bytes, _cut, _inner_number))(inner, chance) if inner else inner  # a chunk can be empty
    body = chunk_record(zstandard.compress(inner), len(inner), checksum=crc32(inner))
    return content[:at] + body + content[at + size :]


def _inner_number(content: bytes, chance: random.Random) -> bytes:
    at = chance.randrange(len(content))
    return (content[:at] + struct.pack("<Q", chance.choice((0, 1 << 40, (1 << 64) - 1))) + content[at + 8 :])[
        : len(content)
    ]


MUTATIONS: tuple[Callable[[bytes, random.Random], bytes], ...] = (
    *(_bytes, _head, _head, _number, _number, _cut, _remove, _repeat, _inside, _inside, _inside),
)
