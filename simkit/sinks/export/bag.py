"""A bag as a folder of files: a table for each topic, its pictures and clouds beside it, and a page that lists them."""

from __future__ import annotations

import re
from array import array
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from simkit.errors import InputError
from simkit.sinks.bag_reader import BagTopic, open_bag_to_read
from simkit.sinks.export.clouds import CloudSeries
from simkit.sinks.export.columns import TEXT, Column, columns_of
from simkit.sinks.export.folder import INDEX, check_folder, whole_folder, write_index
from simkit.sinks.export.pictures import Film, NpzSeries, PngSeries
from simkit.sinks.export.tables import WRITERS, check_parquet
from simkit.sinks.series import time_origin
from simkit.sinks.topic_patterns import fits

if TYPE_CHECKING:
    from simkit.sinks.bag_reader import BagReader

FORMATS: Final = ("csv", "npz", "parquet")
IMAGES: Final = ("png", "mp4", "npz", "none")
CLOUDS: Final = ("npz", "ply", "none")
_PICTURES: Final = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")
_CLOUD: Final = "sensor_msgs/msg/PointCloud2"
_NS: Final = 1_000_000_000
_NO_NAME = re.compile(r"[^\w.-]+")


@dataclass(frozen=True)
class Wish:
    """What is taken out of a bag, and as what.

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
class Exported:
    """What became of one topic.

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


def export(path: Path, target: Path, wish: Wish) -> list[Exported]:
    """Writes a bag to a folder, which is there as a whole at the end or not at all.

    Raises:
        InputError: SK-BAG-011 nothing in the bag is wanted; SK-BAG-013 the folder cannot be written; SK-BAG-014 a
            format needs what is not installed; SK-CLI-030 there is no such topic; SK-CLI-035 the bag cannot be read;
            SK-CLI-036 a message is not of its type.
    """
    check_folder(target, overwrite=wish.overwrite)
    if wish.format == "parquet":
        check_parquet()
    with open_bag_to_read(path) as bag:
        topics = _wanted(bag, wish)
        with whole_folder(target, overwrite=wish.overwrite) as folder:
            found = _written(bag, topics, folder, wish)
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


def _wanted(bag: BagReader, wish: Wish) -> list[BagTopic]:
    from simkit.diagnostics import did_you_mean

    names = [topic.name for topic in bag.topics]
    for pattern in wish.topics:
        if not any(fits(name, [pattern]) for name in names):
            hint = did_you_mean(pattern, names) or "there is " + (", ".join(sorted(set(names))) or "none")
            raise InputError(f"SK-CLI-030 no topic {pattern!r} in {bag.path}; {hint}", "SK-CLI-030")
    found = [
        topic
        for topic in bag.topics
        if (not wish.topics or fits(topic.name, wish.topics)) and not fits(topic.name, wish.skip)
    ]
    if not found:
        raise InputError(f"SK-BAG-011 nothing is wanted of {bag.path}, which has {len(names)} topics", "SK-BAG-011")
    return found


def _written(bag: BagReader, topics: list[BagTopic], folder: Path, wish: Wish) -> list[Exported]:
    names = _file_names(topics)
    takers = {(t.name, t.type_name): _Taker(bag, t, names[t.name, t.type_name], folder, wish) for t in topics}
    origin = time_origin(bag)
    start = None if wish.start is None else origin + round(wish.start * _NS)
    end = None if wish.end is None else origin + round(wish.end * _NS)
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
        base = _NO_NAME.sub("_", topic.name.strip("/").replace("/", "_")).strip(".")[:120] or "topic"
        name, number = base, 1
        while name.lower() in taken:
            number += 1
            name = f"{base}_{number}"
        taken.add(name.lower())
        found[topic.name, topic.type_name] = name
    return found


class _Taker:
    """Gathers one topic."""

    def __init__(self, bag: BagReader, topic: BagTopic, name: str, folder: Path, wish: Wish) -> None:
        self._name, self._folder, self._format = name, folder, wish.format
        self._told = Exported(topic.name, topic.type_name)
        self._times = array("q")
        self._beside = self._maker(topic.type_name, wish)
        without = frozenset({"data"}) if topic.type_name in (*_PICTURES, _CLOUD) else frozenset[str]()
        self._columns = columns_of(topic.type_name, bag.store_of(topic.type_name), without)
        self._files: list[str] = []
        self._is_bad = False

    def _maker(self, type_name: str, wish: Wish) -> Any:
        """What writes pictures or clouds, made when the first comes."""
        target = self._folder / self._name
        makers: dict[str, Callable[[], Any]] = {}
        if type_name in _PICTURES:
            film = target.with_name(f"{self._name}.mp4")
            makers = {"png": lambda: PngSeries(target), "npz": lambda: NpzSeries(target), "mp4": lambda: Film(film)}
            return makers.get(wish.images)
        if type_name == _CLOUD and wish.clouds != "none":
            return lambda: CloudSeries(target, wish.clouds)
        return None

    def take(self, time_ns: int, message: Any) -> None:
        """Adds a message."""
        self._times.append(time_ns)
        for column in self._columns:
            column.take(message)
        if self._beside is None:
            return
        if callable(self._beside):
            self._beside = self._beside()
        try:
            self._files.append(self._beside.take(time_ns, message))
        except ValueError as error:
            self._files.append("")
            if not self._is_bad:
                self._told.notes.append(f"not all could be written: {error}")
            self._is_bad = True

    def close(self) -> None:
        """No more comes."""
        if self._beside is not None and not callable(self._beside):
            self._beside.close()

    def write(self) -> Exported:
        """Writes the table."""
        told, columns = self._told, self._columns
        told.count = len(self._times)
        if self._beside is not None and not callable(self._beside):
            told.notes += self._beside.notes
            told.beside = next((f.partition("/")[0] for f in self._files if f), "")
            files = Column("file", TEXT, False, lambda message: message)
            files.values = self._files
            columns = [files, *columns]
        told.file = f"{self._name}.{self._format}"
        told.notes += WRITERS[self._format](self._folder / told.file, self._times, columns)
        return told
