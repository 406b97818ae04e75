"""Reader of bags: MCAP files, and rosbag2 folders with MCAP or SQLite, recorded by simkit or by ROS 2.

with open_bag_to_read("run.mcap") as bag:
    for message in bag.messages(["/odom"]):
        print(message.time_ns, bag.decode(message).pose.pose.position.x)
"""

from __future__ import annotations

import struct
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from simkit import msgs
from simkit.diagnostics import did_you_mean
from simkit.errors import InputError, MessageError
from simkit.input_file import open_input, read_failure, read_input_text
from simkit.msgs import message_types
from simkit.yaml_reader import NotYaml, read_yaml

if TYPE_CHECKING:
    from rosbags.interfaces import Connection
    from rosbags.interfaces.typing import Typesdict
    from rosbags.typesys.store import Typestore

LATEST_SIMULATED_TIME: Final = 100_000_000 * 1_000_000_000
"""Highest time [ns] that is regarded as simulated time (1e17 ns, March 1973 as a calendar time).

Later times are regarded as calendar times."""
_UNREADABLE = "SK-CLI-035"
_UNKNOWN_TYPE = "SK-CLI-036"


class BagMessage(NamedTuple):
    """Serialised message of a bag, with its recording time [ns]."""

    time_ns: int
    topic: str
    type_name: str
    data: bytes


@dataclass(frozen=True)
class BagTopic:
    """Topic of a bag with one type.

    Attributes:
        definition: definition of the type in the bag; empty if the bag has none.
        latched: True if the publisher kept the last message for late subscribers.
    """

    name: str
    type_name: str
    count: int
    definition: str = ""
    latched: bool = False
    format: str = "cdr"


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
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.broken = ""
        self._source = _open_storage(path)
        self.files, self.storage, self.distro = _bag_files(path)
        self.topics = sorted(self._source.topics(), key=lambda t: (t.name, t.type_name))
        self.broken = self._source.broken
        self.start, self.end = self._source.span()
        self._store: Typestore | None = None
        self._uses_bag_store: dict[str, bool] = {}

    def __enter__(self) -> BagReader:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the files of the bag."""
        self._source.close()

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

    def messages(self, topics: Sequence[str] = (), start: int | None = None) -> Iterator[BagMessage]:
        """Yield messages in the order of their times.

        Args:
            topics: topics to read; empty for all.
            start: recording time of the first message to read [ns].

        Raises:
            InputError: SK-CLI-030 the topic is not in the bag; SK-CLI-035 the bag is truncated.
        """
        known = {topic.name for topic in self.topics}
        for name in topics:
            if name not in known:
                hint = did_you_mean(name, known) or "known: " + (", ".join(sorted(known)) or "none")
                raise InputError(f"SK-CLI-030 no topic {name!r} in {self.path}; {hint}", "SK-CLI-030")
        yield from self._source.messages(frozenset(topics), start)

    def decode(self, message: BagMessage) -> message_types.Message:
        """Decode a message.

        Raises:
            InputError: SK-CLI-036 the type is unknown to the bag and to simkit, or the bytes do not match it.
        """
        store = self.store_of(message.type_name)
        try:
            return store.deserialize_cdr(message.data, message.type_name)
        except (struct.error, ValueError, AssertionError, IndexError, KeyError, UnicodeDecodeError) as error:
            text = f"SK-CLI-036 {self.path}: a message on {message.topic} is not a valid {message.type_name}: {error}"
            raise InputError(text, _UNKNOWN_TYPE) from None

    def store_of(self, type_name: str) -> Typestore:
        """Return the type store for a type: the bag's store if its definition differs from simkit's, else simkit's.

        Raises:
            InputError: SK-CLI-036 the type is unknown to the bag and to simkit.
        """
        own = self._uses_bag_store.get(type_name)
        if own is None:
            own = self._uses_bag_store[type_name] = not self._has_simkit_definition(type_name)
        return self._bag_store() if own else msgs.type_store()

    def _has_simkit_definition(self, type_name: str) -> bool:
        bags = self._bag_store().fielddefs
        try:
            msgs.full_name(type_name)
        except MessageError:
            if type_name in bags:
                return False
            text = f"SK-CLI-036 {self.path}: {type_name} is unknown, and the bag has no definition of it"
            raise InputError(text, _UNKNOWN_TYPE) from None
        ours, seen, left = msgs.type_store().fielddefs, {type_name}, [type_name]
        while left:
            name = left.pop()
            if name not in bags:
                continue
            if name not in ours or ours[name][1] != bags[name][1]:
                return False
            fresh = set(_used_types(bags[name][1])) - seen
            seen |= fresh
            left += fresh
        return True

    def _bag_store(self) -> Typestore:
        """Return the type store with the bag's own definitions."""
        if self._store is None:
            from rosbags.typesys import Stores, get_types_from_msg, get_typestore

            self._store = get_typestore(Stores.EMPTY)
            found: Typesdict = {}
            for topic in self.topics:
                if topic.definition:
                    try:
                        found.update(get_types_from_msg(topic.definition, topic.type_name))
                    except Exception as error:  # noqa: BLE001 - the parser may raise anything on invalid text
                        text = f"{self.path}: the definition of {topic.type_name} is invalid: {error}"
                        raise InputError(f"SK-CLI-036 {text}", _UNKNOWN_TYPE) from None
            self._store.register(found)
        return self._store


def open_bag_to_read(path: str | Path) -> BagReader:
    """Open a bag: an `.mcap` or `.db3` file, or a rosbag2 folder.

    Raises:
        InputError: SK-CLI-035 the bag does not exist or is unreadable.
    """
    return BagReader(Path(path))


def _used_types(fields: Sequence[tuple[str, message_types.FieldNode]]) -> Iterator[str]:
    for _, (kind, content) in fields:
        inner = content[0] if int(kind) in (3, 4) else (kind, content)
        if int(inner[0]) == 2:
            yield inner[1]


def _bag_files(path: Path) -> tuple[list[str], str, str]:
    """Return files, storage and ROS distribution of a bag, from its metadata if there is one."""
    if not path.is_dir():
        return [path.name], "sqlite3" if path.suffix == ".db3" else "mcap", "unknown"
    found = sorted([*path.glob("*.mcap"), *path.glob("*.db3"), *path.glob("*.zstd")])
    storage = "sqlite3" if any(".db3" in f.name for f in found) else "mcap"
    distro = "unknown"
    if (path / "metadata.yaml").is_file():
        try:
            text = read_input_text(path / "metadata.yaml")
            info = read_yaml(text)["rosbag2_bagfile_information"]
            names = [Path(name).name for name in info["relative_file_paths"]]
            return names, str(info["storage_identifier"]), str(info.get("ros_distro") or distro)
        except (OSError, NotYaml, KeyError, TypeError, AttributeError, UnicodeDecodeError):
            pass  # fall back to the files of the folder
    return [f.name for f in found], storage, distro


def _open_storage(path: Path) -> _CompleteBag | _TruncatedBag:
    """Open the bag with rosbags; if it is truncated, read it record by record."""
    from rosbags.rosbag2 import Reader, ReaderError

    try:
        exists = path.exists()
    except (OSError, ValueError) as error:  # an invalid file name, such as one that is too long
        why = getattr(error, "strerror", None) or error
        raise InputError(f"SK-CLI-035 {path} cannot be read: {why}", _UNREADABLE) from None
    if not exists:
        raise InputError(f"SK-CLI-035 bag {path} does not exist", _UNREADABLE)
    if path.is_dir() and not (path / "metadata.yaml").exists() and not list(path.glob("*.mcap")):
        raise InputError(f"SK-CLI-035 {path} is not a bag: it has neither metadata.yaml nor an MCAP file", _UNREADABLE)
    if not path.is_dir() and path.suffix not in (".mcap", ".db3"):
        text = f"SK-CLI-035 {path}: found the ending {path.suffix!r}; expected .mcap, .db3 or a rosbag2 folder"
        raise InputError(text, _UNREADABLE)
    if not path.is_dir() and not path.is_file():
        raise InputError(f"SK-CLI-035 {path} is neither a file nor a folder", _UNREADABLE)
    _check_kinds(path)
    try:
        reader = Reader(path)
        reader.open()
        return _CompleteBag(path, reader)
    except Exception as error:  # noqa: BLE001 - rosbags may raise anything on a damaged file
        files = [path] if path.suffix == ".mcap" else sorted(path.glob("*.mcap")) if path.is_dir() else []
        truncated = _TruncatedBag(path, files)
        if files and truncated.has_begun:
            return truncated
        reason = truncated.broken if files else error if isinstance(error, ReaderError) else f"it is damaged ({error})"
        raise InputError(f"SK-CLI-035 {path} cannot be read: {reason}", _UNREADABLE) from None


def _check_kinds(path: Path) -> None:
    """Refuse a bag with a pipe or a device, which rosbags would open without a timeout."""
    files = [path / "metadata.yaml", *(path / name for name in _bag_files(path)[0])] if path.is_dir() else [path]
    for file in files:
        try:
            open_input(file).close()
        except FileNotFoundError:
            continue  # rosbags reports the missing file
        except OSError as error:
            raise InputError(f"SK-CLI-035 {file} cannot be read: {read_failure(error)}", _UNREADABLE) from None


class _CompleteBag:
    """Complete bag, read with rosbags."""

    broken = ""

    def __init__(self, path: Path, reader: Any) -> None:
        self._path, self._reader = path, reader

    def topics(self) -> list[BagTopic]:
        return [
            BagTopic(c.topic, c.msgtype, c.msgcount, _definition(c), _is_latched(c), c.ext.serialization_format)
            for c in self._reader.connections
        ]

    def span(self) -> tuple[int, int]:
        if not self._reader.message_count:
            return 0, 0
        return self._reader.start_time, self._reader.end_time - 1

    def messages(self, topics: frozenset[str], start: int | None) -> Iterator[BagMessage]:
        selected = [c for c in self._reader.connections if not topics or c.topic in topics]
        if not selected:
            return
        messages = self._reader.messages(selected, start)
        while True:
            try:
                connection, time_ns, data = next(messages)
            except StopIteration:
                return
            except Exception as error:  # noqa: BLE001 - the file is damaged in the middle
                raise InputError(f"SK-CLI-035 {self._path} is damaged: {error}", _UNREADABLE) from None
            yield BagMessage(time_ns, connection.topic, connection.msgtype, bytes(data))

    def close(self) -> None:
        if self._reader.is_open:
            self._reader.close()


def _definition(connection: Connection) -> str:
    return str(connection.msgdef.data) if connection.msgdef.format.name == "MSG" else ""


def _is_latched(connection: Any) -> bool:
    profiles = connection.ext.offered_qos_profiles
    return any(p.durability.name == "TRANSIENT_LOCAL" for p in profiles)


class _TruncatedBag:
    """Bag whose end is missing. The file is read record by record, once for the topics and once for each use."""

    def __init__(self, path: Path, files: list[Path]) -> None:
        self._records = McapRecords(files)
        self.broken = ""
        counts: Counter[tuple[str, str, bool]] = Counter()
        self._span = (0, 0)
        for record in self._records.messages():
            first, last = self._span if counts else (record.time_ns, record.time_ns)
            self._span = (min(first, record.time_ns), max(last, record.time_ns))
            counts[record.topic, record.type_name, record.latched] += 1
        definitions, reason = self._records.definitions, self._records.reason
        self._topics = [BagTopic(t, k, n, definitions[k], latched) for (t, k, latched), n in counts.items()]
        if self._topics:
            hint = f"recover it with `simkit bag recover {path}`"
            self.broken = f"the recording was cut off ({reason or 'its end is missing'}); {hint}"
        elif self.has_begun:
            self.broken = "the recording was cut off before the first message"
        else:
            self.broken = reason

    @property
    def has_begun(self) -> bool:
        return self._records.has_begun

    def topics(self) -> list[BagTopic]:
        return self._topics

    def span(self) -> tuple[int, int]:
        return self._span

    def messages(self, topics: frozenset[str], start: int | None) -> Iterator[BagMessage]:
        for record in self._records.messages():
            if (not topics or record.topic in topics) and (start is None or record.time_ns >= start):
                yield BagMessage(record.time_ns, record.topic, record.type_name, record.data)

    def close(self) -> None:
        """Do nothing, because no file stays open between two uses."""


class RecordedMessage(NamedTuple):
    """Message of an MCAP file. `latched` is True if its publisher kept the last message for late subscribers."""

    time_ns: int
    topic: str
    type_name: str
    data: bytes
    latched: bool


class McapRecords:
    """Reads MCAP files record by record; each file is read up to its end or to the first damaged record.

    Attributes:
        definitions: definitions of the types that were read so far.
        has_begun: True after the first record.
        reason: error at the end of a truncated file; empty for complete files.
    """

    def __init__(self, files: list[Path]) -> None:
        self._files = files
        self.definitions: dict[str, str] = {}
        self.has_begun = False
        self.reason = ""

    def messages(self) -> Iterator[RecordedMessage]:
        """Yield the messages of all files."""
        from mcap.exceptions import McapError
        from mcap.records import Channel, Message, Schema
        from mcap.stream_reader import StreamReader

        for path in self._files:
            schemas: dict[int, Schema] = {}
            channels: dict[int, Channel] = {}
            with open_input(path) as file:
                try:
                    for record in StreamReader(file).records:
                        self.has_begun = True
                        if isinstance(record, Schema):
                            schemas[record.id] = record
                            self.definitions[record.name] = bytes(record.data).decode(errors="replace")
                        elif isinstance(record, Channel):
                            channels[record.id] = record
                        elif isinstance(record, Message):
                            channel = channels[record.channel_id]
                            latched = "transient_local" in channel.metadata.get("offered_qos_profiles", "")
                            name = schemas[channel.schema_id].name
                            yield RecordedMessage(record.log_time, channel.topic, name, bytes(record.data), latched)
                except (McapError, struct.error, ValueError, KeyError, EOFError, MemoryError) as error:
                    self.reason = f"{type(error).__name__} {error}".strip()
