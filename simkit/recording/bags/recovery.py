"""Recovery of a damaged bag: every readable message is copied into a new bag."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from simkit.errors import InputError
from simkit.input_file import open_input, read_failure
from simkit.number_text import counted
from simkit.progress import report_each
from simkit.recording.bags.mcap_records import file_size, read_run_metadata
from simkit.recording.bags.mcap_salvage import Loss, McapSalvage
from simkit.recording.bags.writer import Channel, McapBag, check_target, open_bag
from simkit.writers.atomic_output import remove_abandoned, unfinished_folder

_NS: Final = 1e-9
_MOST_CHANNELS: Final = (1 << 16) - 1  # the number of a channel has 16 bits


@dataclass(frozen=True)
class RecoveredBag:
    """Contents of a recovered bag; times are simulated times [ns].

    Attributes:
        complete: True if the old bag was complete.
        losses: file names and damaged parts.
    """

    messages: int
    topics: int
    start: int
    end: int
    complete: bool
    losses: tuple[tuple[str, Loss], ...] = ()

    @property
    def state(self) -> str:
        """State of the old bag, in words."""
        if self.complete:
            return "the bag was complete"
        return "the bag was damaged" if any(not loss.is_cut for _, loss in self.losses) else "the bag was cut off"

    def loss_lines(self) -> list[str]:
        """Return a line for each damaged part."""
        return [f"{name}: {_loss_text(loss)}" for name, loss in self.losses]


def _loss_text(loss: Loss) -> str:
    part = "a chunk of " if loss.is_chunk else ""
    times = "" if loss.start is None or loss.end is None else f", {loss.start * _NS:.9g} s to {loss.end * _NS:.9g} s"
    rest = f"; {loss.saved} of its messages are saved, and may be wrong" if loss.saved else ""
    return f"lost {part}{counted(loss.size, 'byte')} at byte {loss.position}{times} ({loss.reason}){rest}"


def recover_bag(source: Path, target: Path, *, overwrite: bool = False) -> RecoveredBag:
    """Copy the readable part of `source` (an MCAP file or a rosbag2 folder with MCAP files) to `target`.

    The target appears when it is complete. A target that exists stays as it is until then.

    Raises:
        InputError: SK-BAG-004 the source has no readable message; SK-BAG-001/002 the target is not writable.
    """
    try:
        files = sorted(source.glob("*.mcap")) if source.is_dir() else [source]
        if not files or not files[0].is_file():
            raise _nothing(f"there is no MCAP file at {source}")
    except (OSError, ValueError) as error:
        raise _nothing(f"{source} cannot be read: {read_failure(error)}") from None
    if any(f.absolute() == target.absolute() for f in files) or source.absolute() == target.absolute():
        raise InputError("SK-BAG-001", f"{target} is the bag to recover; give another name for the new bag")
    check_target(target, overwrite=overwrite)
    salvages = [McapSalvage(file) for file in files]
    with _unfinished_bag(target, overwrite=overwrite) as draft:
        with open_input(files[0]) as file_:
            bag = open_bag(draft, run=read_run_metadata(file_, file_size(file_)))
        channels: dict[object, Channel] = {}
        try:
            for file, salvage in zip(files, salvages, strict=True):
                _copy_messages(file, salvage, bag, channels)
            if not bag.span.count:
                reasons = [_loss_text(loss) for salvage in salvages for loss in salvage.losses[:1]]
                raise _nothing(f"{source} has no readable message: {'; '.join(reasons) or 'it is empty'}")
        finally:
            bag.close()
    losses = tuple((file.name, loss) for file, s in zip(files, salvages, strict=True) for loss in s.losses)
    complete = not losses and all(salvage.has_end for salvage in salvages)
    return RecoveredBag(bag.span.count, len(bag.channels), bag.span.start, bag.span.end, complete, losses)


def _nothing(text: str) -> InputError:
    return InputError("SK-BAG-004", text)


def _copy_messages(file: Path, salvage: McapSalvage, bag: McapBag, channels: dict[object, Channel]) -> None:
    """Copy the messages of a file; `channels` has the channels of the new bag, which several files share."""
    messages = report_each("copying messages", salvage.messages())
    while True:
        try:
            message = next(messages, None)
        except OSError as error:
            raise _nothing(f"{file} cannot be read: {read_failure(error)}") from None
        if message is None:
            return
        old, schema = message.channel, message.schema
        key = (old.topic, old.encoding, schema)
        channel = channels.get(key)
        if channel is None:
            if len(channels) == _MOST_CHANNELS:
                raise _nothing(f"{file} has more than {_MOST_CHANNELS} topics, which do not fit into one file")
            encodings = (old.encoding, schema.encoding)
            channel = bag.add_channel(old.topic, schema.name, old.latched, schema.data, old.metadata, encodings)
            channels[key] = channel
        bag.write_raw(channel, bytes(message.data), message.time_ns, message.publish_ns)


@contextmanager
def _unfinished_bag(target: Path, *, overwrite: bool) -> Iterator[Path]:
    """Yield a path in a temporary folder next to `target`; at the end, move what was written there to `target`.

    Raises:
        InputError: SK-BAG-002 the target is not writable.
    """
    target = target.absolute()
    try:
        remove_abandoned(target.parent, target.name)
        target.parent.mkdir(parents=True, exist_ok=True)
        folder = unfinished_folder(target.parent, target.name)
        try:
            yield folder / target.name
            check_target(target, overwrite=overwrite)
            if target.is_dir():
                target.rename(folder / "old")
            (folder / target.name).replace(target)
        finally:
            shutil.rmtree(folder, ignore_errors=True)
    except OSError as error:
        raise InputError("SK-BAG-002", f"cannot write {target}: {error.strerror or error}") from None
