"""One MCAP file, written as the run goes.

Chunks span at most one simulated second and reach the operating system as soon as they are complete, so what a killed
process leaves is readable up to its last flush. Times are simulated ones and nothing else varies: two runs of one seed
write the same bytes.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import IO

from simkit import msgs
from simkit.sinks.qos import as_yaml, profile

_SECOND = 1_000_000_000
_CHUNK_BYTES = 4 << 20


@dataclass
class Channel:
    """One topic with one type, and what was written of it."""

    id: int
    topic: str
    type_name: str
    latched: bool
    count: int = 0


@dataclass
class Span:
    """First and last log time [ns] of what was written."""

    start: int = 0
    end: int = 0
    count: int = field(default=0)

    def add(self, time_ns: int) -> None:
        self.start = time_ns if self.count == 0 else min(self.start, time_ns)
        self.end = max(self.end, time_ns)
        self.count += 1


class McapBag:
    """Writes messages to one MCAP file with the ROS 2 profile.

    Args:
        path: the file; made anew.
        overwrite: whether an existing file may be replaced.

    Raises:
        FileExistsError: the file exists and may not be replaced.
        OSError: it cannot be written.
    """

    def __init__(self, path: Path, *, overwrite: bool = False) -> None:
        from mcap.writer import CompressionType, Writer

        self.path = path
        self.span = Span()
        self.channels: dict[tuple[str, str], Channel] = {}
        self._schemas: dict[str, int] = {}
        self._second = -1
        self._file: IO[bytes] = path.open("wb" if overwrite else "xb")
        # Half a minute of an RGB-D camera is two gigabytes; what is drawn without noise shrinks to a tenth.
        self._writer = Writer(self._file, chunk_size=_CHUNK_BYTES, compression=CompressionType.ZSTD)
        self._writer.start(profile="ros2", library="simkit")
        self._file.flush()

    def channel(self, topic: str, type_name: str, latched: bool) -> Channel:
        """The channel of a topic and a type, registered when first asked for."""
        found = self.channels.get((topic, type_name))
        if found is None:
            schema = self._schemas.get(type_name)
            if schema is None:
                text = msgs.definition(type_name).encode()
                schema = self._schemas[type_name] = self._writer.register_schema(type_name, "ros2msg", text)
            metadata = {
                "offered_qos_profiles": as_yaml([profile(latched)]),
                "topic_type_hash": msgs.rihs(type_name),
            }
            number = self._writer.register_channel(topic, "cdr", schema, metadata)
            found = self.channels[(topic, type_name)] = Channel(number, topic, type_name, latched)
        return found

    def write_raw(self, channel: Channel, data: bytes, time_ns: int) -> None:
        """Appends one serialised message."""
        second = time_ns // _SECOND
        if second != self._second:
            if self._second >= 0:
                self.flush()
            self._second = second
        self._writer.add_message(channel.id, time_ns, data, time_ns, channel.count)
        channel.count += 1
        self.span.add(time_ns)

    def flush(self) -> None:
        """Completes the chunk and hands everything to the operating system."""
        self._writer.flush()

    def close(self) -> None:
        """Writes the summary; the file is complete afterwards."""
        if self._file.closed:
            return
        try:
            self._writer.finish()
        finally:
            self._file.close()
