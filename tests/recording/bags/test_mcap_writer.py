"""The writer of MCAP files writes the bytes of the package mcap."""

from __future__ import annotations

import io
import random
from typing import Any

from mcap.writer import CompressionType, Writer

from simkit.recording.bags.mcap_writer import McapWriter

CHUNK_BYTES = 4000


def write(writer: Any, seed: int) -> None:
    """Write random schemas, channels and messages, with times that jump back, and flush now and then."""
    source, channels = random.Random(seed), []
    if seed % 2:
        writer.add_metadata("run", {"world": "ü", "seed": "1"})
    time_ns = source.choice([0, 10**9])
    for number in range(source.choice([0, 1, 50, 400])):
        if not channels or source.random() < 0.05:
            schema = writer.register_schema(f"a/msg/T{number}", "ros2msg", source.randbytes(source.randrange(200)))
            metadata = {"qos": "reliable", "ü": "x" * source.randrange(9)} if source.random() < 0.8 else {}
            channels.append(writer.register_channel(f"/t{number}é", "cdr", schema, metadata))
        time_ns = max(0, time_ns + source.randrange(-50, 100) * 1_000_000)
        data = source.randbytes(source.randrange(300))
        writer.add_message(source.choice(channels), time_ns, data, time_ns + source.randrange(9), number)
        if source.random() < 0.03:
            writer.flush()
    writer.finish()


def test_files_have_the_same_bytes_as_those_of_the_package_mcap() -> None:
    for seed in range(60):
        expected, found = io.BytesIO(), io.BytesIO()
        theirs = Writer(expected, chunk_size=CHUNK_BYTES, compression=CompressionType.ZSTD)
        theirs.start(profile="ros2", library="simkit")
        write(theirs, seed)
        write(McapWriter(found, "ros2", "simkit", CHUNK_BYTES), seed)
        assert found.getvalue() == expected.getvalue(), f"seed {seed}"


def test_a_channel_without_messages_is_in_the_summary() -> None:
    file = io.BytesIO()
    writer = McapWriter(file, "ros2", "simkit", CHUNK_BYTES)
    writer.register_channel("/never", "cdr", writer.register_schema("a/msg/T", "ros2msg", b"int32 x"), {})
    writer.finish()
    assert b"/never" in file.getvalue()


def test_messages_that_are_added_together_have_the_bytes_of_messages_one_by_one() -> None:
    for seed in range(30):
        source = random.Random(seed)
        files, counts = (io.BytesIO(), io.BytesIO()), dict[int, int]()
        alone, together = (McapWriter(file, "ros2", "simkit", CHUNK_BYTES) for file in files)
        for writer in (alone, together):
            schema = writer.register_schema("a/msg/T", "ros2msg", b"int32 x")
            for number in range(4):
                writer.register_channel(f"/t{number}", "cdr", schema, {})
        for _ in range(20):
            count = source.randrange(1, 40)
            channels = [source.randrange(1, 5) for _ in range(count)]
            times = [source.randrange(10**12) for _ in range(count)]
            data = [source.randbytes(source.randrange(100)) for _ in range(count)]
            for channel, time_ns, content in zip(channels, times, data, strict=True):
                alone.add_message(channel, time_ns, content, time_ns, counts.setdefault(channel, 0))
                counts[channel] += 1
            together.add_messages(channels, times, data)
            assert [together.count(channel) for channel in counts] == list(counts.values())
        alone.finish()
        together.finish()
        assert files[0].getvalue() == files[1].getvalue(), f"seed {seed}"
