"""Size of a bag, and what other compression of the same messages would give.

python benchmarks/bag_size.py BAG.mcap

Prints the bytes of compressed chunks, index and all else, then size and CPU time for levels of zstd and for chunks of
several seconds. "columns" is the size without a message layout: byte k of all messages of a topic together, which no
reader of bags accepts. A bag of the main job comes from

    simkit run turtlebot3_world --script worlds/turtlebot3_world_drive.yaml --duration 36 --record x.mcap \
        --skip '/camera/*'
"""

from __future__ import annotations

import argparse
import time
from collections import defaultdict
from pathlib import Path

import numpy as np
import zstandard
from mcap.reader import make_reader
from mcap.records import Chunk, MessageIndex
from mcap.stream_reader import StreamReader

LEVELS = (1, 3, 6, 9)
SECONDS = (1, 5, 36)
INDEX_HEAD, ENTRY = 15, 16  # bytes of an index record and of each of its messages


def compress(contents: list[bytes], level: int) -> tuple[int, float]:
    """Bytes of the compressed contents, and the least CPU time of three runs [s]."""
    times, compressor = [], zstandard.ZstdCompressor(level=level)
    for _ in range(3):
        start = time.thread_time()
        size = sum(len(compressor.compress(content)) for content in contents)
        times.append(time.thread_time() - start)
    return size, min(times)


def columns_of(path: Path) -> int:
    """Bytes of the compressed columns of all topics."""
    topics, size = defaultdict(list), 0
    with path.open("rb") as file:
        for _, channel, message in make_reader(file).iter_messages():
            topics[channel.topic, len(message.data)].append(message.data)
    for (_, length), messages in topics.items():
        rows = np.frombuffer(b"".join(messages), np.uint8).reshape(-1, length)
        size += len(zstandard.compress(rows.T.tobytes()))
    return size


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("bag", type=Path)
    path = parser.parse_args().bag
    chunks: list[bytes] = []
    packed = index = messages = 0
    with path.open("rb") as file:
        for record in StreamReader(file, emit_chunks=True).records:
            if isinstance(record, Chunk):
                chunks.append(zstandard.decompress(record.data, max_output_size=record.uncompressed_size))
                packed += len(record.data)
            elif isinstance(record, MessageIndex):
                messages += len(record.records)
                index += INDEX_HEAD + ENTRY * len(record.records)
    size = path.stat().st_size
    print(f"{size} bytes, {messages} messages: chunks {packed}, index {index}, all else {size - packed - index}")
    print(f"chunks without compression {sum(map(len, chunks))}; as columns {columns_of(path)}")
    for count in SECONDS:
        contents = [b"".join(chunks[at : at + count]) for at in range(0, len(chunks), count)]
        for level in LEVELS:
            found, cpu = compress(contents, level)
            print(f"{count:3d} chunks together, level {level}: {found} bytes, {1e3 * cpu:6.1f} ms")


if __name__ == "__main__":
    main()
