"""Recover a bag whose writer was killed: copy every complete message into a new bag."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

from simkit.errors import InputError
from simkit.recording.bags.recorder import open_bag
from simkit.recording.bags.writer import Channel

if TYPE_CHECKING:
    from collections.abc import Iterator


@dataclass(frozen=True)
class RecoveredBag:
    """Contents of a recovered bag; times in nanoseconds of simulated time."""

    messages: int
    topics: int
    start: int
    end: int
    complete: bool


def recover_bag(source: Path, target: Path, *, overwrite: bool = False) -> RecoveredBag:
    """Copies what is readable of `source` (a file or a rosbag2 folder) to `target`.

    Raises:
        InputError: SK-BAG-004 nothing readable is there; SK-BAG-001/002 the target cannot be written.
    """
    files = sorted(source.glob("*.mcap")) if source.is_dir() else [source]
    if not files or not files[0].is_file():
        raise InputError(f"SK-BAG-004 no MCAP file at {source}", "SK-BAG-004")
    if any(f.absolute() == target.absolute() for f in files) or source.absolute() == target.absolute():
        raise InputError(f"SK-BAG-001 {target} is the bag to mend; give another name", "SK-BAG-001")
    progress = _ReadableMessages(files)
    records = progress.messages()
    first = next(records, None)
    if first is None:
        raise InputError(
            f"SK-BAG-004 {source} holds no readable message: {progress.reason or 'it is empty'}", "SK-BAG-004"
        )
    bag = open_bag(target, overwrite=overwrite)
    channels: dict[tuple[str, str], Channel] = {}
    try:
        for topic, type_name, latched, data, time_ns in _in_file_order(first, records):
            channel = channels.get((topic, type_name))
            if channel is None:
                channel = channels[(topic, type_name)] = bag.channel(topic, type_name, latched)
            bag.write_raw(channel, data, time_ns)
    finally:
        bag.close()
    return RecoveredBag(bag.span.count, len(channels), bag.span.start, bag.span.end, not progress.reason)


_Record = tuple[str, str, bool, bytes, int]


def _in_file_order(first: _Record, rest: Iterator[_Record]) -> Iterator[_Record]:
    yield first
    yield from rest


class _ReadableMessages:
    """Reads files record by record up to where they break off; `reason` says why they do."""

    def __init__(self, files: list[Path]) -> None:
        self.files, self.reason = files, ""

    def messages(self) -> Iterator[_Record]:
        for path in self.files:
            with path.open("rb") as file:
                yield from self._messages_of(file)

    def _messages_of(self, file: BinaryIO) -> Iterator[_Record]:
        from mcap.exceptions import McapError
        from mcap.records import Channel, Message, Schema
        from mcap.stream_reader import StreamReader

        schemas: dict[int, str] = {}
        channels: dict[int, Channel] = {}
        try:
            for record in StreamReader(file).records:
                if isinstance(record, Schema):
                    schemas[record.id] = record.name
                elif isinstance(record, Channel):
                    channels[record.id] = record
                elif isinstance(record, Message):
                    channel = channels[record.channel_id]
                    latched = "transient_local" in channel.metadata.get("offered_qos_profiles", "")
                    yield channel.topic, schemas[channel.schema_id], latched, record.data, record.log_time
        except (McapError, struct.error, ValueError, KeyError, EOFError, MemoryError) as error:
            self.reason = f"{type(error).__name__} {error}".strip()
