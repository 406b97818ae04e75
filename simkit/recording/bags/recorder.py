"""Record the topics of a simulation to a bag as the run goes."""

from __future__ import annotations

import fnmatch
import os
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from simkit import msgs
from simkit.errors import InputError, SimkitError
from simkit.recording.bags.writer import McapBag, Rosbag2Folder
from simkit.recording.message_taps import MessageQueue, TopicTaps
from simkit.writers.atomic_output import write_obstacle

if TYPE_CHECKING:
    from simkit.runtime import Simulation


def matches_topic(topic: str, patterns: Iterable[str]) -> bool:
    """Check whether a topic matches one of the shell patterns; `scan` and `/scan` are the same."""
    return any(fnmatch.fnmatchcase(topic, p if p.startswith(("/", "*")) else f"/{p}") for p in patterns)


def _serialise(message: object) -> tuple[str, bytes]:
    return msgs.type_name(message), msgs.serialize(message)


class RecordError(SimkitError):
    """Recording stopped in the middle of a run; what was flushed before is readable."""

    code = "SK-BAG-003"


def is_single_file(path: Path) -> bool:
    """`x.mcap` is one file, anything else a rosbag2 folder."""
    return path.suffix.lower() == ".mcap"


def check_target(path: Path, *, overwrite: bool = False) -> None:
    """Says before anything is computed that a bag cannot be written there.

    Raises:
        InputError: SK-BAG-001 something is there already; SK-BAG-002 the place cannot be written.
    """
    if _path_exists(path) and not overwrite:
        raise InputError(
            f"SK-BAG-001 {path} exists already and is not overwritten\n    help: --force replaces it", "SK-BAG-001"
        )
    if path.is_dir() and is_single_file(path):
        raise InputError(f"SK-BAG-002 cannot write {path}: it is a folder", "SK-BAG-002")
    if is_single_file(path) and not path.absolute().parent.is_dir():
        raise InputError(f"SK-BAG-002 cannot write {path}: there is no folder {path.absolute().parent}", "SK-BAG-002")
    why = write_obstacle(path)
    if why:
        raise InputError(f"SK-BAG-002 cannot write {path}: {why}", "SK-BAG-002")


def _path_exists(path: Path) -> bool:
    """Check whether a path exists.

    Raises:
        InputError: SK-BAG-002 nothing can be, such as under a name that is too long.
    """
    try:
        return path.exists()
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        raise InputError(f"SK-BAG-002 cannot write {path}: {why}", "SK-BAG-002") from None


def open_bag(path: Path, *, overwrite: bool = False) -> McapBag:
    """A new bag: one MCAP file or a rosbag2 folder, by the suffix of `path`.

    Raises:
        InputError: SK-BAG-001 or SK-BAG-002.
    """
    check_target(path, overwrite=overwrite)
    try:
        if is_single_file(path):
            return McapBag(path, overwrite=overwrite)
        return Rosbag2Folder(path, overwrite=overwrite)
    except FileExistsError as error:
        raise InputError(f"SK-BAG-001 {path} is not overwritten: {error}", "SK-BAG-001") from None
    except OSError as error:
        raise InputError(f"SK-BAG-002 cannot write {path}: {error.strerror or error}", "SK-BAG-002") from None


class Recorder:
    """Writes what is published to a bag; use it as a context manager around the run.

    Args:
        sim: the simulation; recording it makes every recorded sensor measure.
        path: `x.mcap` for one file, else a rosbag2 folder.
        overwrite: whether an existing bag may be replaced.
        topics: shell patterns of the topics to record; when empty, all but those that the bus has aside (`/stats` and
            what else tells of the whole world).
        skip: shell patterns of topics to leave out.
        choose: says of a topic whether it is recorded, instead of `topics`.

    Raises:
        InputError: SK-BAG-001 the bag exists; SK-BAG-002 it cannot be written.
    """

    def __init__(
        self,
        sim: Simulation,
        path: str | os.PathLike[str],
        *,
        overwrite: bool = False,
        topics: Sequence[str] = (),
        skip: Sequence[str] = (),
        choose: Callable[[str], bool] | None = None,
    ) -> None:
        self.path = Path(path)
        self.failure: RecordError | None = None
        self._sim, self._patterns, self._skip = sim, tuple(topics), tuple(skip)
        self._choose = choose
        self._count = 0
        self._bag: McapBag | None = open_bag(self.path, overwrite=overwrite)
        # behind a picture that is still being drawn, other messages wait as bytes, so that all stay in order
        self._queue = MessageQueue(self._write, _serialise)
        self._taps = TopicTaps(sim, self._receiver_of)
        self._taps.open()

    @property
    def message_count(self) -> int:
        """Messages written so far."""
        return self._count if self._bag is None else self._bag.span.count

    def __enter__(self) -> Recorder:
        return self

    def __exit__(self, kind: object, *_: object) -> None:
        self.close()
        if kind is None:
            self.check()

    def check(self) -> None:
        """Raises what went wrong while writing, if anything did.

        Raises:
            RecordError: the disk is full or gone.
        """
        if self.failure is not None:
            raise self.failure

    def close(self) -> None:
        """Ends the recording and completes the bag; does nothing the second time."""
        self._taps.close()
        self._queue.deliver_all()
        bag, self._bag = self._bag, None
        if bag is None:
            return
        self._count = bag.span.count
        try:
            bag.close()
        except OSError as error:
            self._fail(error)

    def _receiver_of(self, topic: str, _: str) -> Callable[[object], None] | None:
        if not (self._choose or self._is_selected)(topic) or matches_topic(topic, self._skip):
            return None
        sim, queue = self._sim, self._queue
        return lambda message: queue.add((topic, sim.time_ns), message)

    def _is_selected(self, topic: str) -> bool:
        if self._patterns:
            return matches_topic(topic, self._patterns)
        return topic not in self._sim.communication.bus.aside

    def records(self, topic: str) -> bool:
        """Check whether the options select the topic."""
        return topic in self._taps

    def _write(self, label: tuple[str, int], message: tuple[str, bytes]) -> None:
        bag, (topic, time_ns), (type_name, data) = self._bag, label, message
        if bag is None:
            return
        try:
            channel = bag.channels.get((topic, type_name))
            if channel is None:
                channel = bag.channel(topic, type_name, topic in self._sim.communication.bus.latched())
            bag.write_raw(channel, data, time_ns)
        except OSError as error:
            # Not raised here: this runs inside whoever publishes, and it is not the publisher's fault.
            self._fail(error)
            self._queue.clear()
            self.close()

    def _fail(self, error: OSError) -> None:
        self.failure = self.failure or RecordError(
            f"SK-BAG-003 recording to {self.path} stopped at t={self._sim.time:.3f} s: {error.strerror or error}; "
            "what was written before stays readable (simkit bag recover mends it)"
        )
