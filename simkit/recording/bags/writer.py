"""Writer of bags: one MCAP file, or a rosbag2 folder with its metadata."""

from __future__ import annotations

import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, TYPE_CHECKING

from simkit import msgs
from simkit.errors import InputError
from simkit.output_file import open_target
from simkit.recording.bags.mcap_records import RUN_METADATA
from simkit.recording.bags.mcap_writer import McapWriter
from simkit.writers.atomic_output import write_obstacle

if TYPE_CHECKING:
    from yaml import SafeDumper

_FOREVER = {"sec": 9223372036, "nsec": 854775807}


def qos_profile(latched: bool) -> dict[str, object]:
    """Return the QoS profile of a publisher: reliable; transient local for latched topics (`/tf_static`)."""
    return {
        "history": "keep_last",
        "depth": 1 if latched else 10,
        "reliability": "reliable",
        "durability": "transient_local" if latched else "volatile",
        "deadline": dict(_FOREVER),
        "lifespan": dict(_FOREVER),
        "liveliness": "automatic",
        "liveliness_lease_duration": dict(_FOREVER),
        "avoid_ros_namespace_conventions": False,
    }


def qos_profiles_yaml(profiles: list[dict[str, object]]) -> str:
    """Return QoS profiles as the YAML text for a channel's metadata."""
    import yaml

    # YAML anchors would be valid, but some bag readers do not support them.
    plain = [{k: dict(v) if isinstance(v, dict) else v for k, v in p.items()} for p in profiles]
    return str(yaml.safe_dump(plain, sort_keys=False)).strip()


_SECOND = 1_000_000_000
_CHUNK_BYTES = 4 << 20


@dataclass
class Channel:
    """Topic with one type."""

    id: int
    topic: str
    type_name: str
    latched: bool
    type_hash: str = ""


@dataclass
class Span:
    """First and last log time [ns] and number of the written messages."""

    start: int = 0
    end: int = 0
    count: int = field(default=0)

    def add(self, time_ns: int) -> None:
        if not self.count or time_ns < self.start:
            self.start = time_ns
        if time_ns > self.end:
            self.end = time_ns
        self.count += 1


class McapBag:
    """Writer of messages to one MCAP file with the ROS 2 profile.

    Args:
        path: file to create.
        overwrite: True to replace an existing file.
        run: metadata of the recorded run; see `recorded_run.describe_run`.

    Raises:
        FileExistsError: the file exists, and `overwrite` is not set.
        OSError: the file is not writable.
    """

    def __init__(self, path: Path, *, overwrite: bool = False, run: Mapping[str, str] | None = None) -> None:
        self.path = path
        self.span = Span()
        self.channels: dict[tuple[str, str], Channel] = {}
        self._schemas: dict[tuple[str, str, bytes], int] = {}
        self._second = -1
        self._file: IO[bytes] = open_target(path, overwrite=overwrite)
        # Half a minute of an RGB-D camera is 2 GB; compression reduces images without noise to a tenth.
        self._writer = McapWriter(self._file, "ros2", "simkit", _CHUNK_BYTES)
        if run:
            self._writer.add_metadata(RUN_METADATA, run)
        self._file.flush()

    def channel(self, topic: str, type_name: str, latched: bool, renderer: str = "") -> Channel:
        """Return the channel of a topic and a type; register it on first use.

        Args:
            topic: name of the topic.
            type_name: name of the type.
            latched: True if the publisher keeps the last message for late subscribers.
            renderer: renderer that draws the messages, for the metadata of the channel; empty for none.
        """
        channel = self.channels.get((topic, type_name))
        if channel is None:
            metadata = {
                "offered_qos_profiles": qos_profiles_yaml([qos_profile(latched)]),
                "topic_type_hash": msgs.rihs(type_name),
                **({"renderer": renderer} if renderer else {}),
            }
            channel = self.add_channel(topic, type_name, latched, msgs.definition(type_name).encode(), metadata)
        return channel

    def add_channel(
        self,
        topic: str,
        type_name: str,
        latched: bool,
        definition: bytes,
        metadata: dict[str, str],
        encodings: tuple[str, str] = ("cdr", "ros2msg"),
    ) -> Channel:
        """Register a channel with its own definition of the type.

        Args:
            topic: name of the topic.
            type_name: name of the type.
            latched: True if the publisher keeps the last message for late subscribers.
            definition: definition of the type.
            metadata: metadata of the channel.
            encodings: encodings of the messages and of the definition.
        """
        key = (type_name, encodings[1], definition)
        if key not in self._schemas:
            self._schemas[key] = self._writer.register_schema(type_name, encodings[1], definition)
        number = self._writer.register_channel(topic, encodings[0], self._schemas[key], metadata)
        channel = Channel(number, topic, type_name, latched, metadata.get("topic_type_hash", ""))
        self.channels.setdefault((topic, type_name), channel)
        return channel

    def write_raw(self, channel: Channel, data: bytes, time_ns: int, publish_ns: int | None = None) -> None:
        """Append one serialised message. The time of publication is the recording time, unless it is given."""
        self._begin_second(time_ns // _SECOND)
        publish_ns = time_ns if publish_ns is None else publish_ns
        self._writer.add_message(channel.id, time_ns, data, publish_ns, self._writer.count(channel.id))
        self.span.add(time_ns)

    def write_all(self, channels: Sequence[Channel], data: Sequence[bytes], times: Sequence[int]) -> None:
        """Append serialised messages of one second with their recording times [ns]; see `McapWriter.add_messages`."""
        first, last = min(times), max(times)
        self._begin_second(first // _SECOND)
        self._writer.add_messages([channel.id for channel in channels], times, data)
        self.span.add(first)
        self.span.add(last)
        self.span.count += len(data) - 2

    def _begin_second(self, second: int) -> None:
        if second != self._second:
            if self._second >= 0:
                self.end_chunk()
            self._second = second

    def end_chunk(self) -> None:
        """Complete the chunk; a thread passes it to the operating system."""
        self._writer.end_chunk()

    def flush(self) -> None:
        """Complete the chunk and pass all data to the operating system."""
        self._writer.flush()

    def close(self) -> None:
        """Write the summary; the file is complete afterwards."""
        if self._file.closed:
            return
        try:
            self._writer.finish()
        finally:
            self._file.close()


_VERSION = 9  # rosbag2 metadata format of ROS 2 Jazzy


class Rosbag2Folder(McapBag):
    """Writer of messages to `folder/<name>_0.mcap`; `close()` writes `metadata.yaml`.

    Raises:
        FileExistsError: the folder exists and `overwrite` is not set, or the folder is not a bag.
        OSError: the folder is not writable.
    """

    def __init__(self, folder: Path, *, overwrite: bool = False, run: Mapping[str, str] | None = None) -> None:
        if folder.exists():
            if not overwrite:
                raise FileExistsError(folder)
            if any(folder.iterdir()) and not (folder / "metadata.yaml").exists() and not list(folder.glob("*.mcap")):
                raise FileExistsError(f"{folder} is not a bag")
            shutil.rmtree(folder)
        folder.mkdir(parents=True)
        self.folder = folder
        super().__init__(folder / f"{folder.name}_0.mcap", run=run)

    def close(self) -> None:
        """Complete the file and write the metadata."""
        super().close()
        import yaml

        target = self.folder / "metadata.yaml"
        draft = target.with_suffix(".yaml.tmp")
        content = {"rosbag2_bagfile_information": self._information()}
        try:
            draft.write_text(yaml.dump(content, Dumper=_plain_dumper(), sort_keys=False), encoding="utf-8")
            draft.replace(target)
        except BaseException:  # a full disk, or an interrupt
            draft.unlink(missing_ok=True)
            raise

    def _information(self) -> dict[str, object]:
        start = {"nanoseconds_since_epoch": self.span.start}
        duration = {"nanoseconds": self.span.end - self.span.start}
        return {
            "version": _VERSION,
            "storage_identifier": "mcap",
            "duration": duration,
            "starting_time": start,
            "message_count": self.span.count,
            "topics_with_message_count": [
                {
                    "topic_metadata": {
                        "name": channel.topic,
                        "type": channel.type_name,
                        "serialization_format": "cdr",
                        "offered_qos_profiles": [qos_profile(channel.latched)],
                        "type_description_hash": channel.type_hash,
                    },
                    "message_count": self._writer.count(channel.id),
                }
                for channel in self.channels.values()
            ],
            "compression_format": "",
            "compression_mode": "",
            "relative_file_paths": [self.path.name],
            "files": [
                {"path": self.path.name, "starting_time": start, "duration": duration, "message_count": self.span.count}
            ],
            "custom_data": None,
            "ros_distro": "jazzy",
        }


def _plain_dumper() -> type[SafeDumper]:
    """Return a YAML dumper that repeats equal values instead of using anchors."""
    import yaml

    class Plain(yaml.SafeDumper):
        def ignore_aliases(self, data: object) -> bool:
            return True

    return Plain


def is_single_file(path: Path) -> bool:
    """Check whether a path names one MCAP file (`x.mcap`) instead of a rosbag2 folder."""
    return path.suffix.lower() == ".mcap"


def check_target(path: Path, *, overwrite: bool = False) -> None:
    """Check before a run whether a bag can be written.

    Raises:
        InputError: SK-BAG-001 the path exists; SK-BAG-002 the path is not writable.
    """
    if _path_exists(path) and not overwrite:
        remedy = "replace it with --force, in Python with overwrite=True"
        raise InputError("SK-BAG-001", f"{path} already exists", help=remedy)
    if path.is_dir() and is_single_file(path):
        raise InputError("SK-BAG-002", f"cannot write {path}: it is a folder")
    if is_single_file(path) and not path.absolute().parent.is_dir():
        raise InputError("SK-BAG-002", f"cannot write {path}: folder {path.absolute().parent} does not exist")
    why = write_obstacle(path)
    if why:
        raise InputError("SK-BAG-002", f"cannot write {path}: {why}")


def _path_exists(path: Path) -> bool:
    """Check whether a path exists.

    Raises:
        InputError: SK-BAG-002 the path is invalid, for example too long.
    """
    try:
        return path.exists()
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        raise InputError("SK-BAG-002", f"cannot write {path}: {why}") from None


def open_bag(path: Path, *, overwrite: bool = False, run: Mapping[str, str] | None = None) -> McapBag:
    """Create a bag: one MCAP file or a rosbag2 folder, by the suffix of `path`.

    Raises:
        InputError: SK-BAG-001 the path exists; SK-BAG-002 the path is not writable.
    """
    check_target(path, overwrite=overwrite)
    try:
        if is_single_file(path):
            return McapBag(path, overwrite=overwrite, run=run)
        return Rosbag2Folder(path, overwrite=overwrite, run=run)
    except FileExistsError as error:
        raise InputError("SK-BAG-001", f"{path} is not overwritten: {error}") from None
    except OSError as error:
        raise InputError("SK-BAG-002", f"cannot write {path}: {error.strerror or error}") from None
