"""Recovery of a bag whose writer was killed: every complete message is copied into a new bag."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain
from pathlib import Path

from simkit.errors import InputError
from simkit.recording.bags.reader import McapRecords
from simkit.recording.bags.recorder import open_bag


@dataclass(frozen=True)
class RecoveredBag:
    """Contents of a recovered bag; times are simulated times [ns]."""

    messages: int
    topics: int
    start: int
    end: int
    complete: bool


def recover_bag(source: Path, target: Path, *, overwrite: bool = False) -> RecoveredBag:
    """Copy the readable part of `source` (a file or a rosbag2 folder) to `target`.

    Raises:
        InputError: SK-BAG-004 the source has no readable message; SK-BAG-001/002 the target is not writable.
    """
    files = sorted(source.glob("*.mcap")) if source.is_dir() else [source]
    if not files or not files[0].is_file():
        raise InputError(f"SK-BAG-004 no MCAP file at {source}", "SK-BAG-004")
    if any(f.absolute() == target.absolute() for f in files) or source.absolute() == target.absolute():
        raise InputError(f"SK-BAG-001 {target} is the bag to recover; give another name for the new bag", "SK-BAG-001")
    records = McapRecords(files)
    messages = records.messages()
    first = next(messages, None)
    if first is None:
        reason = records.reason or "it is empty"
        raise InputError(f"SK-BAG-004 {source} has no readable message: {reason}", "SK-BAG-004")
    bag = open_bag(target, overwrite=overwrite)
    try:
        for message in chain((first,), messages):
            bag.write_raw(bag.channel(message.topic, message.type_name, message.latched), message.data, message.time_ns)
    finally:
        bag.close()
    return RecoveredBag(bag.span.count, len(bag.channels), bag.span.start, bag.span.end, not records.reason)
