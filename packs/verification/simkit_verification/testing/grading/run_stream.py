"""Stream of a recorded run from the process of a hand-in to its judge: frames in chunks, with a chain of hashes.

A frame is one byte for its kind, four bytes for its size, and its content. A chunk is some frames with their size, and
a keyed hash of all chunks so far. The key is sent before any code of the hand-in is imported, and stays in an object
that does not show it. So bytes that other code writes to the pipe, and missing bytes, are noticed. Code that finds this
object in the memory of its process can still write valid chunks.
"""

from __future__ import annotations

import hmac
import json
import os
import struct
import time
from collections.abc import Iterator
from hashlib import blake2b
from typing import Final

from simkit.errors import SimkitError
from simkit.run_spec import JsonObject

READY, NAMES, SOURCE, VALUE, MESSAGE, FEED, STEP, OBSERVE, BEAT, END = range(10)
"""Kinds of frames.

- READY: JSON; the process has started, and no code of the hand-in is imported yet.
- NAMES: JSON with the models, links, joints, collisions and topics of the world.
- SOURCE: JSON with the number and the key of a source, which is a value that a check reads.
- VALUE: number of a source and its new value.
- MESSAGE, FEED: number of a source and the time; a message on a topic, to count it or to observe its content.
- STEP, OBSERVE, BEAT: time; the end of a step, a sample of a path, or only a sign of progress.
- END: JSON with the end of the run.
"""
CLOCK: Final = struct.Struct("<qqd")
"""Tick, simulated time [ns], simulated time [s]."""
NUMBER: Final = struct.Struct("<I")
_FRAME: Final = struct.Struct("<BI")
_CHUNK: Final = struct.Struct("<I16s")
_LARGEST: Final = 256 << 20  # bytes of a chunk
_FULL: Final = 32 << 10  # bytes after which a chunk is sent
_LATEST: Final = 0.005  # [s] wall time after which a chunk is sent


class DamagedStreamError(SimkitError):
    """Stream with missing, foreign or invalid bytes."""


def _chain(key: bytes) -> blake2b:
    return blake2b(key=key, digest_size=16)


class FrameWriter:
    """Writer of the stream.

    Args:
        pipe: File descriptor of a pipe.
        key: Key of the hashes.
    """

    def __init__(self, pipe: int, key: bytes) -> None:
        self._pipe, self._chain = pipe, _chain(key)
        self._frames = bytearray()
        self._sent = time.monotonic()
        # references to the functions, because a hand-in may replace those in the modules
        self._write, self._clock, self._pack, self._dumps = os.write, time.monotonic, _FRAME.pack, json.dumps

    def add(self, kind: int, content: bytes = b"") -> None:
        """Add a frame; it is sent with later ones, at the latest by the first frame after 5 ms."""
        self._frames += self._pack(kind, len(content))
        self._frames += content
        if len(self._frames) >= _FULL or self._clock() - self._sent >= _LATEST:
            self.flush()

    def add_json(self, kind: int, content: object) -> None:
        """Add a frame with JSON."""
        self.add(kind, self._dumps(content).encode())

    def flush(self) -> None:
        """Send all frames.

        Raises:
            OSError: The judge has closed the pipe.
        """
        self._sent = self._clock()
        if not self._frames:
            return
        frames, self._frames = bytes(self._frames), bytearray()
        self._chain.update(frames)
        content = memoryview(_CHUNK.pack(len(frames), self._chain.copy().digest()) + frames)
        while content:
            content = content[self._write(self._pipe, content) :]


class FrameReader:
    """Reader of the stream.

    Args:
        key: Key of the hashes.
    """

    def __init__(self, key: bytes) -> None:
        self._chain = _chain(key)
        self._content = bytearray()

    def feed(self, content: bytes) -> Iterator[tuple[int, bytes]]:
        """Add bytes of the pipe; yield the kind and the content of each complete frame.

        Raises:
            DamagedStreamError: The bytes are not those that the writer sent.
        """
        self._content += content
        while len(self._content) >= _CHUNK.size:
            size, tag = _CHUNK.unpack_from(self._content)
            if size > _LARGEST:
                raise DamagedStreamError("a chunk is too large")
            if len(self._content) < _CHUNK.size + size:
                return
            frames = bytes(self._content[_CHUNK.size : _CHUNK.size + size])
            del self._content[: _CHUNK.size + size]
            self._chain.update(frames)
            if not hmac.compare_digest(self._chain.copy().digest(), tag):
                raise DamagedStreamError("it has bytes that the recorder did not write")
            yield from _frames_of(frames)


def _frames_of(frames: bytes) -> Iterator[tuple[int, bytes]]:
    at = 0
    while at < len(frames):
        if at + _FRAME.size > len(frames):
            raise DamagedStreamError("a frame is cut off")
        kind, size = _FRAME.unpack_from(frames, at)
        at += _FRAME.size
        if kind > END or at + size > len(frames):
            raise DamagedStreamError("a frame is invalid")
        yield kind, frames[at : at + size]
        at += size


def read_json(content: bytes) -> JsonObject:
    """Decode the JSON object of a frame.

    Raises:
        DamagedStreamError: The content is no JSON object.
    """
    try:
        values = json.loads(content)
    except (ValueError, RecursionError):
        values = None
    if not isinstance(values, dict):
        raise DamagedStreamError("a frame has no JSON object")
    return values
