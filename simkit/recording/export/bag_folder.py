"""Export a bag to a folder: a table for each topic, with its images and point clouds."""

from __future__ import annotations

import json
import re
import shutil
from array import array
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit.diagnostics import did_you_mean
from simkit.errors import InputError
from simkit.recording.bags.reader import BagTopic, open_bag_to_read
from simkit.recording.bags.recorder import matches_topic
from simkit.recording.export.images import MessageWriter, NpzFile, PngFiles, VideoFile
from simkit.recording.export.point_clouds import CloudFiles
from simkit.recording.export.tables import TEXT, WRITERS, Column, check_parquet, columns_of
from simkit.writers.atomic_output import abandoned_folders, current_umask, unfinished_folder, write_obstacle

if TYPE_CHECKING:
    from simkit.recording.bags.reader import BagReader


INDEX: Final = "index.json"
_MARK: Final = "simkit bag export"
_OLD: Final = "old"


def check_folder(path: Path, *, overwrite: bool) -> None:
    """Says before anything is read that an export cannot go there.

    Raises:
        InputError: SK-BAG-013 something is there that may not be replaced, or nothing can be written there.
    """
    try:
        if path.is_symlink() or (path.exists() and not path.is_dir()):
            raise _folder_error(f"{path} is there and is no folder")
        if path.is_dir() and any(path.iterdir()):
            if not _is_export(path):
                raise _folder_error(f"{path} is no export of simkit and is left alone")
            if not overwrite:
                raise _folder_error(f"{path} exists already and is not overwritten\n    help: --force replaces it")
        why = write_obstacle(path)
        if why:
            raise _folder_error(f"cannot write {path}: {why}")
    except (OSError, ValueError) as error:
        raise _folder_error(f"cannot write {path}: {getattr(error, 'strerror', None) or error}") from None


def _is_export(path: Path) -> bool:
    try:
        return bool(json.loads((path / INDEX).read_text(encoding="utf-8"))["made_by"] == _MARK)
    except (OSError, ValueError, KeyError, TypeError):
        return False


@contextmanager
def export_folder(path: Path, *, overwrite: bool) -> Iterator[Path]:
    """A folder beside `path` to write to, which takes its place at the end; what a killed one left is tidied away.

    Raises:
        InputError: SK-BAG-013.
    """
    path = path.absolute()
    _remove_abandoned(path)
    check_folder(path, overwrite=overwrite)
    path.parent.mkdir(parents=True, exist_ok=True)
    draft = unfinished_folder(path.parent, path.name)
    try:
        draft.chmod(0o777 & ~current_umask())
        yield draft
        if path.exists():
            old = unfinished_folder(path.parent, path.name)
            path.rename(old / _OLD)
            draft.rename(path)
            shutil.rmtree(old, ignore_errors=True)
        else:
            draft.rename(path)
    except OSError as error:
        raise _folder_error(f"cannot write {path}: {error.strerror or error}") from None
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def _remove_abandoned(path: Path) -> None:
    """Takes away what killed exports left; one that was moved aside and never replaced goes back."""
    try:
        for left in abandoned_folders(path.parent, path.name):
            if not path.exists() and _is_export(left / _OLD):
                (left / _OLD).rename(path)
            shutil.rmtree(left, ignore_errors=True)
    except OSError as error:
        raise _folder_error(f"cannot write {path}: {error.strerror or error}") from None


def write_index(folder: Path, rows: dict[str, object]) -> None:
    """The page that says what is where."""
    text = json.dumps({"made_by": _MARK, **rows}, indent=1, ensure_ascii=False)
    (folder / INDEX).write_text(text + "\n", encoding="utf-8", errors="replace")


def _folder_error(text: str) -> InputError:
    return InputError(f"SK-BAG-013 {text}", "SK-BAG-013")


WriterFactory = Callable[[], MessageWriter]
FORMATS: Final = ("csv", "npz", "parquet")
IMAGES: Final = ("png", "mp4", "npz", "none")
CLOUDS: Final = ("npz", "ply", "none")
_IMAGE_TYPES: Final = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")
_CLOUD_TYPE: Final = "sensor_msgs/msg/PointCloud2"
_NS: Final = 1_000_000_000
_NOT_IN_FILE_NAMES = re.compile(r"[^\w.-]+")


@dataclass(frozen=True)
class ExportOptions:
    """Options of an export: which topics, and in which formats.

    Attributes:
        topics: shell patterns of topics; empty for all.
        skip: shell patterns of topics that are left out.
        format: of tables: csv, npz or parquet.
        images: what becomes of pictures: png, mp4, npz or none.
        clouds: what becomes of point clouds: npz, ply or none.
        start, end: times between which messages are taken [s]: simulated ones, else from the bag's beginning.
        overwrite: whether an older export may be replaced.
    """

    topics: tuple[str, ...] = ()
    skip: tuple[str, ...] = ()
    format: str = "csv"
    images: str = "png"
    clouds: str = "npz"
    start: float | None = None
    end: float | None = None
    overwrite: bool = False


@dataclass
class ExportedTopic:
    """Result of exporting one topic.

    Attributes:
        file: its table, relative to the folder.
        beside: its film, or the folder of its pictures or clouds; empty where it has none.
        notes: what is left out or other than one would think.
    """

    topic: str
    type_name: str
    count: int = 0
    file: str = ""
    beside: str = ""
    notes: list[str] = field(default_factory=list)


def export_bag(path: Path, target: Path, options: ExportOptions) -> list[ExportedTopic]:
    """Writes a bag to a folder, which is there as a whole at the end or not at all.

    Raises:
        InputError: SK-BAG-011 nothing in the bag is wanted; SK-BAG-013 the folder cannot be written; SK-BAG-014 a
            format needs what is not installed; SK-CLI-030 there is no such topic; SK-CLI-035 the bag cannot be read;
            SK-CLI-036 a message is not of its type.
    """
    check_folder(target, overwrite=options.overwrite)
    if options.format == "parquet":
        check_parquet()
    with open_bag_to_read(path) as bag:
        topics = _selected_topics(bag, options)
        with export_folder(target, overwrite=options.overwrite) as folder:
            found = _write_topics(bag, topics, folder, options)
            write_index(
                folder,
                {
                    "bag": path.name,
                    "start_ns": bag.start,
                    "end_ns": bag.end,
                    "complete": not bag.broken,
                    "topics": [
                        {
                            "topic": one.topic,
                            "type": one.type_name,
                            "messages": one.count,
                            "file": one.file,
                            **({"beside": one.beside} if one.beside else {}),
                            **({"notes": one.notes} if one.notes else {}),
                        }
                        for one in found
                    ],
                },
            )
    return found


def _selected_topics(bag: BagReader, options: ExportOptions) -> list[BagTopic]:
    names = [topic.name for topic in bag.topics]
    for pattern in options.topics:
        if not any(matches_topic(name, [pattern]) for name in names):
            hint = did_you_mean(pattern, names) or "there is " + (", ".join(sorted(set(names))) or "none")
            raise InputError(f"SK-CLI-030 no topic {pattern!r} in {bag.path}; {hint}", "SK-CLI-030")
    chosen = [topic for topic in bag.topics if not options.topics or matches_topic(topic.name, options.topics)]
    found = [topic for topic in chosen if not matches_topic(topic.name, options.skip)]
    if not found:
        raise InputError(f"SK-BAG-011 nothing is wanted of {bag.path}, which has {len(names)} topics", "SK-BAG-011")
    return found


def _write_topics(bag: BagReader, topics: list[BagTopic], folder: Path, options: ExportOptions) -> list[ExportedTopic]:
    names = _file_names(topics)
    takers = {(t.name, t.type_name): _TopicExport(bag, t, names[t.name, t.type_name], folder, options) for t in topics}
    origin = bag.time_origin
    start = None if options.start is None else origin + round(options.start * _NS)
    end = None if options.end is None else origin + round(options.end * _NS)
    try:
        for message in bag.messages(list(dict.fromkeys(t.name for t in topics)), start):
            if end is not None and message.time_ns > end:
                break
            taker = takers.get((message.topic, message.type_name))
            if taker is not None:
                taker.take(message.time_ns, bag.decode(message))
    finally:
        for taker in takers.values():
            taker.close()
    return [taker.write() for taker in takers.values()]


def _file_names(topics: list[BagTopic]) -> dict[tuple[str, str], str]:
    """A name for each topic: its own with `_` for slashes."""
    taken = {INDEX.removesuffix(".json")}
    found = {}
    for topic in topics:
        base = _NOT_IN_FILE_NAMES.sub("_", topic.name.strip("/").replace("/", "_")).strip(".")[:120] or "topic"
        name, number = base, 1
        while name.lower() in taken:
            number += 1
            name = f"{base}_{number}"
        taken.add(name.lower())
        found[topic.name, topic.type_name] = name
    return found


class _TopicExport:
    """Gathers one topic."""

    def __init__(self, bag: BagReader, topic: BagTopic, name: str, folder: Path, options: ExportOptions) -> None:
        self._name, self._folder, self._format = name, folder, options.format
        self._result = ExportedTopic(topic.name, topic.type_name)
        self._times = array("q")
        self._make_writer = self._writer_factory(topic.type_name, options)
        self._writer: MessageWriter | None = None
        without = frozenset({"data"}) if topic.type_name in (*_IMAGE_TYPES, _CLOUD_TYPE) else frozenset[str]()
        self._columns = columns_of(topic.type_name, bag.store_of(topic.type_name), without)
        self._files: list[str] = []
        self._is_bad = False

    def _writer_factory(self, type_name: str, options: ExportOptions) -> WriterFactory | None:
        """Return what makes the writer of images or clouds when the first one comes; None for other types."""
        target = self._folder / self._name
        makers: dict[str, WriterFactory] = {}
        if type_name in _IMAGE_TYPES:
            film = target.with_name(f"{self._name}.mp4")
            makers = {"png": lambda: PngFiles(target), "npz": lambda: NpzFile(target), "mp4": lambda: VideoFile(film)}
            return makers.get(options.images)
        if type_name == _CLOUD_TYPE and options.clouds != "none":
            return lambda: CloudFiles(target, options.clouds)
        return None

    def take(self, time_ns: int, message: object) -> None:
        """Adds a message."""
        self._times.append(time_ns)
        for column in self._columns:
            column.take(message)
        if self._make_writer is None:
            return
        if self._writer is None:
            self._writer = self._make_writer()
        try:
            self._files.append(self._writer.take(time_ns, message))
        except ValueError as error:
            self._files.append("")
            if not self._is_bad:
                self._result.notes.append(f"not all could be written: {error}")
            self._is_bad = True

    def close(self) -> None:
        """No more comes."""
        if self._writer is not None:
            self._writer.close()

    def write(self) -> ExportedTopic:
        """Writes the table."""
        told, columns = self._result, self._columns
        told.count = len(self._times)
        if self._writer is not None:
            told.notes += self._writer.notes
            told.beside = next((f.partition("/")[0] for f in self._files if f), "")
            files = Column("file", TEXT, False, lambda message: message)
            files.values = self._files
            columns = [files, *columns]
        told.file = f"{self._name}.{self._format}"
        told.notes += WRITERS[self._format](self._folder / told.file, self._times, columns)
        return told
