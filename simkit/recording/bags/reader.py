"""Reader of bags: MCAP files, and rosbag2 folders with MCAP or SQLite, recorded by simkit or by ROS 2.

with open_bag_to_read("run.mcap") as bag:
    for message in bag.messages(["/odom"]):
        print(message.time_ns, bag.decode(message).pose.pose.position.x)
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.diagnostics import did_you_mean
from simkit.errors import InputError, MessageError
from simkit.msgs import message_types
from simkit.msgs.definition_parser import FieldNode
from simkit.number_text import counted
from simkit.recording.bags.bag_contents import BagMessage, BagTopic, unreadable
from simkit.recording.bags.bag_files import bag_layout, open_files
from simkit.recording.bags.mcap_records import LARGEST_RECORD, decompress
from simkit.recording.bags.type_definitions import define_types, definition_store

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

    from simkit.msgs.data_frames import DataFrame
    from simkit.run_files import FilePath

__all__ = ["LATEST_SIMULATED_TIME", "BagMessage", "BagReader", "BagTopic", "open_bag_to_read"]

LATEST_SIMULATED_TIME: Final = 100_000_000 * 1_000_000_000
"""Highest time [ns] that is regarded as simulated time (1e17 ns, March 1973 as a calendar time).

Later times are regarded as calendar times."""
_UNKNOWN_TYPE: Final = "SK-CLI-036"


class BagReader:
    """Open bag; a context manager.

    Attributes:
        path: path of the bag.
        files: files with the messages, relative to the bag's folder.
        storage: `mcap` or `sqlite3`.
        distro: ROS distribution of the recorder, or `unknown`.
        start, end: recording time of the first and the last message [ns]; 0 for an empty bag.
        topics: topics, sorted by name.
        broken: reason why the bag is truncated; empty for a complete bag.
        run: description of the recorded run, as texts by name; empty if the bag has none. See
            `recorded_run.describe_run`.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._layout = bag_layout(path)
        self._closing = ExitStack()
        try:
            self._files = open_files(self._layout, self._closing)
            self.topics = self._merged_topics()
        except BaseException:
            self._closing.close()
            raise
        self.files, self.distro = self._layout.names, self._layout.distro
        self.run = self._files[0].run if self._files else {}
        self.storage = self._files[0].storage if self._files else "mcap"
        self.broken = "; ".join(dict.fromkeys(p for p in (self._layout.problem, *(f.damage for f in self._files)) if p))
        filled = [file for file in self._files if any(t.count for t in file.topics())]
        self.start = min((file.start for file in filled), default=0)
        self.end = max((file.end for file in filled), default=0)
        self._stores: dict[str, Typestore] = {}

    def __repr__(self) -> str:
        counts = f"{counted(len(self.topics), 'topic')}, {counted(self.count, 'message')}"
        return f"<BagReader {str(self.path)!r}: {counts}, {self.duration:.6g} s>"

    def __enter__(self) -> BagReader:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the files of the bag."""
        self._closing.close()

    @property
    def count(self) -> int:
        """Number of messages in the bag."""
        return sum(topic.count for topic in self.topics)

    @property
    def time_origin(self) -> int:
        """Time [ns] from which times are counted: 0 for simulated times, the bag's start for calendar times."""
        return 0 if self.start < LATEST_SIMULATED_TIME else self.start

    @property
    def duration(self) -> float:
        """Time from `time_origin` to the last message [s]."""
        return max(0.0, (self.end - self.time_origin) * 1e-9)

    @property
    def size(self) -> int:
        """Size of the bag's files [bytes]."""
        folder = self.path if self.path.is_dir() else self.path.parent
        return sum((folder / name).stat().st_size for name in self.files if (folder / name).is_file())

    def messages(self, topics: str | Sequence[str] = (), start: int | None = None) -> Iterator[BagMessage]:
        """Yield messages in the order of their times.

        Args:
            topics: topic or topics to read; empty for all.
            start: recording time of the first message to read [ns].

        Raises:
            InputError: SK-CLI-030 the topic is not in the bag; SK-CLI-035 the bag is damaged.
        """
        known = {topic.name for topic in self.topics}
        topics = [topics] if isinstance(topics, str) else topics
        for name in topics:
            if name not in known:
                hint = did_you_mean(name, known) or "known: " + (", ".join(sorted(known)) or "none")
                raise InputError("SK-CLI-030", f"no topic {name!r} in {self.path}; {hint}")
        for file in self._files:
            for message in file.messages(frozenset(topics), start):
                yield self._decompressed(message) if self._layout.has_compressed_messages else message

    def _decompressed(self, message: BagMessage) -> BagMessage:
        try:
            data = bytes(decompress("zstd", message.data, LARGEST_RECORD))
        except ValueError as error:
            raise unreadable(self.path, f"a message on {message.topic!r} is damaged: {error}") from None
        if len(data) > LARGEST_RECORD:
            text = f"a message on {message.topic!r} has more than {LARGEST_RECORD >> 20} MiB"
            raise unreadable(self.path, text)
        return message._replace(data=data)

    def _merged_topics(self) -> list[BagTopic]:
        """Return the topics of all files, sorted by name, with the sums of their counts."""
        merged: dict[tuple[str, str], BagTopic] = {}
        for file in self._files:
            for topic in file.topics():
                key = (topic.name, topic.type_name)
                before = merged.get(key)
                merged[key] = topic if before is None else replace(before, count=before.count + topic.count)
        return [merged[key] for key in sorted(merged)]

    def decode(self, message: BagMessage) -> message_types.Message:
        """Decode a message.

        Raises:
            InputError: SK-CLI-036 the type is unknown to the bag and to simkit, or the bytes do not match it.
        """
        store = self.store_of(message.type_name)
        try:
            return store.deserialize_cdr(message.data, message.type_name)
        except Exception as error:  # noqa: BLE001 - the decoder may raise anything if the data does not match
            reason = str(error).strip() or type(error).__name__
            text = f"{self.path}: a message on {message.topic} is not a valid {message.type_name}: {reason:.300}"
            raise InputError(_UNKNOWN_TYPE, text) from None

    def to_dataframe(self, topic: str) -> DataFrame:
        """Return the messages of a topic as a pandas DataFrame, one row for each; see `simkit.to_dataframe`.

        Raises:
            InputError: SK-CLI-030 the topic is not in the bag; SK-CLI-035 the bag is damaged.
        """
        from simkit.msgs.data_frames import to_dataframe  # imported late: bags are listed without NumPy

        messages = list(self.messages([topic]))
        times = [message.time_ns for message in messages]
        types = dict.fromkeys(message.type_name for message in messages)
        stores = [self.store_of(name) for name in types]
        return to_dataframe([self.decode(message) for message in messages], times, *stores[:1])

    def store_of(self, type_name: str) -> Typestore:
        """Return the type store for a type: the bag's own if its definition differs from simkit's, else simkit's.

        Raises:
            InputError: SK-CLI-036 the type is unknown to the bag and to simkit, its definition is invalid, or its
                messages are not encoded as CDR.
        """
        store = self._stores.get(type_name)
        if store is None:
            store = self._stores[type_name] = self._new_store(type_name)
        return store

    def define_types(self, topics: Container[str]) -> None:
        """Define the types of some topics in this process if it does not know them, so that they can be published.

        Raises:
            InputError: SK-CLI-036 a definition is invalid; SK-INTERFACE-00x ROS 2 would refuse it.
        """
        chosen = [topic for topic in self.topics if topic.name in topics and topic.definition]
        for topic in chosen:
            self.store_of(topic.type_name)
        define_types({topic.type_name: topic.definition for topic in chosen})

    def _new_store(self, type_name: str) -> Typestore:
        topics = [topic for topic in self.topics if topic.type_name == type_name]
        for topic in topics:
            if topic.format != "cdr":
                text = f"{self.path}: the encoding of {topic.name} is {topic.format!r}; expected 'cdr'"
                raise InputError(_UNKNOWN_TYPE, text)
        try:
            is_known = bool(msgs.full_name(type_name))
        except MessageError:
            is_known = False
        definition = next((topic.definition for topic in topics if topic.definition), "")
        if not definition:
            if is_known:
                return msgs.type_store()
            text = f"{self.path}: {type_name} is unknown, and the bag has no definition of it"
            raise InputError(_UNKNOWN_TYPE, text)
        store = definition_store(type_name, definition)
        return msgs.type_store() if is_known and _is_as_in_simkit(type_name, store) else store


def open_bag_to_read(path: FilePath) -> BagReader:
    """Open a bag: an `.mcap` or `.db3` file, or a rosbag2 folder.

    Raises:
        InputError: SK-CLI-035 the bag does not exist or is unreadable.
    """
    return BagReader(Path(path))


def _is_as_in_simkit(type_name: str, store: Typestore) -> bool:
    """Check whether a type and the types that it uses are defined as in simkit."""
    ours, theirs, seen, left = msgs.type_store().fielddefs, store.fielddefs, {type_name}, [type_name]
    while left:
        name = left.pop()
        if name not in theirs:
            continue
        if name not in ours or ours[name][1] != theirs[name][1]:
            return False
        fresh = set(_used_types(theirs[name][1])) - seen
        seen |= fresh
        left += fresh
    return True


def _used_types(fields: Sequence[tuple[str, FieldNode]]) -> Iterator[str]:
    for _, (kind, content) in fields:
        inner = content[0] if int(kind) in (3, 4) else (kind, content)
        if int(inner[0]) == 2:
            yield inner[1]
