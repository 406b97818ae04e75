"""Export of a bag to a folder: a table for each topic, with its images and point clouds."""

from __future__ import annotations

import json
import re
import shutil
from array import array
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit import progress
from simkit.diagnostics import did_you_mean
from simkit.errors import InputError
from simkit.input_file import read_input_text
from simkit.json_reader import parse_json
from simkit.msgs.message_columns import TEXT, Column, columns_of
from simkit.number_text import counted
from simkit.recording.bags.bag_contents import matches_topic
from simkit.recording.bags.reader import BagTopic, open_bag_to_read
from simkit.recording.export.images import MessageWriter, NpzFile, PngFiles, VideoFile
from simkit.recording.export.point_clouds import CloudFiles
from simkit.recording.export.tables import WRITERS, check_parquet
from simkit.writers.atomic_output import abandoned_folders, current_umask, unfinished_folder, write_obstacle

if TYPE_CHECKING:
    from simkit.recording.bags.reader import BagReader
    from simkit.run_files import FilePath


INDEX: Final = "index.json"
_MARK: Final = "simkit bag export"
_OLD: Final = "old"


def check_folder(path: Path, *, overwrite: bool) -> None:
    """Check before reading whether an export can be written to a folder.

    Raises:
        InputError: SK-BAG-013 the folder may not be replaced, or is not writable.
    """
    try:
        if path.is_symlink() or (path.exists() and not path.is_dir()):
            raise _folder_error(f"{path} exists and is not a folder")
        if path.is_dir() and any(path.iterdir()):
            if not _is_export(path):
                raise _folder_error(f"{path} is not an export of simkit and is not overwritten")
            if not overwrite:
                raise _folder_error(f"{path} already exists", "replace it with --force")
        why = write_obstacle(path)
        if why:
            raise _folder_error(f"cannot write {path}: {why}")
    except (OSError, ValueError) as error:
        raise _folder_error(f"cannot write {path}: {getattr(error, 'strerror', None) or error}") from None


def _is_export(path: Path) -> bool:
    try:
        return bool(parse_json(read_input_text(path / INDEX, inside=path))["made_by"] == _MARK)
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return False


@contextmanager
def export_folder(path: Path, *, overwrite: bool) -> Iterator[Path]:
    """Yield a temporary folder next to `path` that replaces `path` at the end.

    First, temporary folders of exports that were killed are removed.

    Raises:
        InputError: SK-BAG-013 the folder may not be replaced, or is not writable.
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
    """Remove temporary folders of killed exports; move an older export back if it was moved and not replaced."""
    try:
        for left in abandoned_folders(path.parent, path.name):
            if not path.exists() and _is_export(left / _OLD):
                (left / _OLD).rename(path)
            shutil.rmtree(left, ignore_errors=True)
    except OSError as error:
        raise _folder_error(f"cannot write {path}: {error.strerror or error}") from None


def write_index(folder: Path, rows: dict[str, object]) -> None:
    """Write the index file of an export."""
    text = json.dumps({"made_by": _MARK, **rows}, indent=1, ensure_ascii=False)
    (folder / INDEX).write_text(text + "\n", encoding="utf-8", errors="replace")


def _folder_error(text: str, hint: str = "") -> InputError:
    return InputError("SK-BAG-013", text, help=hint)


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
    """Options of an export: topics, formats and times.

    Attributes:
        topics: shell patterns of the topics to export; empty for all.
        skip: shell patterns of topics to leave out.
        format: format of the tables: csv, npz or parquet.
        images: format of the images: png, mp4, npz or none.
        clouds: format of the point clouds: npz, ply or none.
        start, end: limits of the exported times [s]; calendar times are counted from the start of the bag.
        overwrite: True to replace an older export.
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
        file: table of the topic, relative to the folder.
        beside: video, or folder of images or point clouds; empty if the topic has no images or point clouds.
        notes: missing or converted content.
    """

    topic: str
    type_name: str
    count: int = 0
    file: str = ""
    beside: str = ""
    notes: list[str] = field(default_factory=list)


def export_bag(path: FilePath, target: FilePath, options: ExportOptions) -> list[ExportedTopic]:
    """Export a bag to a folder. The folder is written completely or not at all.

    Args:
        path: bag, as for `open_bag_to_read`.
        target: folder of the exported files.
        options: topics and formats.

    Returns:
        One entry for each topic.

    Raises:
        InputError: SK-BAG-011 no topic is selected; SK-BAG-013 the folder is not writable; SK-BAG-014 a format needs a
            missing package; SK-CLI-030 a topic does not exist; SK-CLI-035 the bag is unreadable; SK-CLI-036 a message
            does not match its type.
    """
    path, target = Path(path), Path(target)
    check_folder(target, overwrite=options.overwrite)
    if options.format == "parquet":
        check_parquet()
    with open_bag_to_read(path) as bag:
        topics = _selected_topics(bag, options)
        with export_folder(target, overwrite=options.overwrite) as folder:
            exports = _write_topics(bag, topics, folder, options)
            write_index(
                folder,
                {
                    "bag": path.name,
                    "start_ns": bag.start,
                    "end_ns": bag.end,
                    "complete": not bag.broken,
                    "topics": [
                        {
                            "topic": exported.topic,
                            "type": exported.type_name,
                            "messages": exported.count,
                            "file": exported.file,
                            **({"beside": exported.beside} if exported.beside else {}),
                            **({"notes": exported.notes} if exported.notes else {}),
                        }
                        for exported in exports
                    ],
                },
            )
    return exports


def _selected_topics(bag: BagReader, options: ExportOptions) -> list[BagTopic]:
    names = [topic.name for topic in bag.topics]
    for pattern in options.topics:
        if not any(matches_topic(name, [pattern]) for name in names):
            hint = did_you_mean(pattern, names) or "known: " + (", ".join(sorted(set(names))) or "none")
            raise InputError("SK-CLI-030", f"no topic {pattern!r} in {bag.path}; {hint}")
    chosen = [topic for topic in bag.topics if not options.topics or matches_topic(topic.name, options.topics)]
    selected = [topic for topic in chosen if not matches_topic(topic.name, options.skip)]
    if not selected:
        raise InputError("SK-BAG-011", f"the options select none of the {counted(len(names), 'topic')} of {bag.path}")
    return selected


def _write_topics(bag: BagReader, topics: list[BagTopic], folder: Path, options: ExportOptions) -> list[ExportedTopic]:
    names = _file_names(topics)
    exports = {(t.name, t.type_name): _TopicExport(bag, t, names[t.name, t.type_name], folder, options) for t in topics}
    origin = bag.time_origin
    start = None if options.start is None else origin + round(options.start * _NS)
    end = None if options.end is None else origin + round(options.end * _NS)
    with ExitStack() as stack:
        for opened in exports.values():
            stack.callback(opened.close)
        task = stack.enter_context(progress.task("exporting messages", sum(t.count for t in topics)))
        for message in bag.messages(list(dict.fromkeys(t.name for t in topics)), start):
            if end is not None and message.time_ns > end:
                break
            export = exports.get((message.topic, message.type_name))
            if export is not None:
                export.take(message.time_ns, bag.decode(message))
                task.advance(message.topic)
    return [export.write() for export in progress.report_each("writing files", exports.values(), len(exports))]


def _file_names(topics: list[BagTopic]) -> dict[tuple[str, str], str]:
    """Return a unique file name for each topic: the topic's name with `_` for slashes."""
    used_names = {INDEX.removesuffix(".json")}
    names = {}
    for topic in topics:
        base = _NOT_IN_FILE_NAMES.sub("_", topic.name.strip("/").replace("/", "_")).strip(".")[:120] or "topic"
        name, number = base, 1
        while name.lower() in used_names:
            number += 1
            name = f"{base}_{number}"
        used_names.add(name.lower())
        names[topic.name, topic.type_name] = name
    return names


class _TopicExport:
    """Export of one topic."""

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
        """Return the factory of the writer of images or point clouds; None for other types."""
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
        """Add a message."""
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
                self._result.notes.append(f"some messages could not be written: {error}")
            self._is_bad = True

    def close(self) -> None:
        """Close the writer after the last message."""
        if self._writer is not None:
            self._writer.close()

    def write(self) -> ExportedTopic:
        """Write the table."""
        result, columns = self._result, self._columns
        result.count = len(self._times)
        if self._writer is not None:
            result.notes += self._writer.notes
            result.beside = next((f.partition("/")[0] for f in self._files if f), "")
            files = Column("file", TEXT, False, lambda message: message)
            files.values = self._files
            columns = [files, *columns]
        result.file = f"{self._name}.{self._format}"
        result.notes += WRITERS[self._format](self._folder / result.file, self._times, columns)
        return result
