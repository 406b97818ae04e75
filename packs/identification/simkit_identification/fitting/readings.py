"""Numbers in the messages of topics over time, in the same columns for a recording and for a run."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.errors import InputError
from simkit.extend import did_you_mean
from simkit.msgs.message_columns import TEXT, Column, columns_of
from simkit.recording import matches_topic

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

    from simkit import Simulation
    from simkit.recording import BagReader

Floats = npt.NDArray[np.float64]

_ABOUT_RUN: Final = frozenset(
    {
        "rosgraph_msgs/msg/Clock", "rcl_interfaces/msg/Log", "rcl_interfaces/msg/ParameterEvent",
        "ros_gz_interfaces/msg/WorldStatistics",
    }
)  # fmt: skip
"""Types of messages about the run, not about the robot."""
_WITHOUT_NUMBERS: Final = frozenset(
    {
        "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage", "sensor_msgs/msg/CameraInfo",
        "sensor_msgs/msg/PointCloud2", "nav_msgs/msg/OccupancyGrid", *_ABOUT_RUN,
    }
)  # fmt: skip
"""Types whose numbers tell nothing about a trajectory, or are too many."""
_LEFT_OUT: Final = ("stamp", "sec", "nanosec", "seq", "time_from_start")
_CONSTANTS: Final = ("covariance", "_min", "_max", "_increment", "_time")
_WIDEST: Final = 64  # numbers of one list; a longer one, such as a scan, is thinned out


@dataclass(frozen=True)
class Channel:
    """Messages of one topic with the same texts and lengths, such as one transform of `/tf`.

    Attributes:
        topic: topic.
        texts: texts of its messages, such as names of frames and joints.
        columns: names of the numbers.
    """

    topic: str
    texts: tuple[object, ...]
    columns: tuple[str, ...]

    @property
    def label(self) -> str:
        """Topic, and the frame of a transform."""
        return f"{self.topic} [{self.texts[-1]}]" if self.topic.startswith("/tf") and self.texts else self.topic

    @property
    def quaternions(self) -> list[int]:
        """Index of the x of each quaternion among the columns, whose sign has no meaning."""
        names = self.columns
        return [
            i
            for i in range(len(names) - 3)
            if [name.rpartition(".")[2] for name in names[i : i + 4]] == ["x", "y", "z", "w"]
            and len({name.rpartition(".")[0] for name in names[i : i + 4]}) == 1
        ]


@dataclass
class Readings:
    """Readings of a channel.

    Attributes:
        channel: channel.
        times: times [s], shape (n,), ascending.
        values: numbers, shape (n, columns); NaN where a message has none.
    """

    channel: Channel
    times: Floats
    values: Floats


class _TopicColumns:
    """Columns of the messages of one type.

    Args:
        columns: columns of the type.
    """

    def __init__(self, columns: Sequence[Column]) -> None:
        numbers = [column for column in columns if _is_compared(column)]
        self._scalars = [column for column in numbers if not column.is_list]
        self._lists = [column for column in numbers if column.is_list]
        self._texts = [column for column in columns if column.kind == TEXT and not column.path.endswith("encoding")]
        self._read_scalars = [column.read for column in self._scalars]
        self._read_texts = [column.read for column in self._texts]
        self.rows: dict[tuple[object, ...], tuple[Channel, list[float], list[list[float]]]] = {}

    def take(self, topic: str, time: float, message: Any) -> None:
        """Store the numbers of a message."""
        row = [read(message) for read in self._read_scalars]
        texts = tuple([_hashable(read(message)) for read in self._read_texts])
        lists = [column.read(message) for column in self._lists]
        key = (*texts, *map(len, lists))
        rows = self.rows.get(key)
        if rows is None:
            rows = self.rows[key] = (Channel(topic, texts, self._names(message, lists)), [], [])
        for values in lists:
            row.extend(values if len(values) <= _WIDEST else [values[i] for i in _chosen(len(values))])
        rows[1].append(time)
        rows[2].append(row)

    def _names(self, message: Any, lists: Sequence[Any]) -> tuple[str, ...]:
        names = [column.path for column in self._scalars]
        texts = [column.read(message) for column in self._texts if column.is_list]
        for column, values in zip(self._lists, lists, strict=True):
            words = next((words for words in texts if len(words) == len(values)), range(len(values)))
            is_inside = "[]" in column.path
            for i in _chosen(len(values)):
                name = f"[{words[i]}]"
                names.append(column.path.replace("[]", name, 1) if is_inside else f"{column.path}{name}")
        return tuple(names)


def _hashable(value: object) -> object:
    return tuple(value) if isinstance(value, (list, np.ndarray)) else value


@cache
def _chosen(count: int) -> tuple[int, ...]:
    """Return the indices of the numbers of a list that are compared."""
    if count <= _WIDEST:
        return tuple(range(count))
    return tuple(np.linspace(0, count - 1, _WIDEST).round().astype(int).tolist())


class ReadingCollector:
    """Collector of the numbers of messages, by topic."""

    def __init__(self) -> None:
        self._columns: dict[tuple[str, str], _TopicColumns] = {}

    def take(self, topic: str, time: float, message: Any, store: Typestore) -> None:
        """Store the numbers of a message.

        Args:
            topic: topic of the message.
            time: time of its publication [s].
            message: message.
            store: type store with the definition of its type.
        """
        type_name = msgs.type_name(message) if store is msgs.type_store() else message.__msgtype__
        columns = self._columns.get((topic, type_name))
        if columns is None:
            columns = _TopicColumns(columns_of(type_name, store))
            self._columns[topic, type_name] = columns
        columns.take(topic, time, message)

    def readings(self) -> list[Readings]:
        """Return the readings of all channels in the order of their first messages."""
        readings = []
        for columns in self._columns.values():
            for channel, times, rows in columns.rows.values():
                if channel.columns:
                    values = np.array(rows, dtype=np.float64)
                    values[~np.isfinite(values)] = np.nan
                    readings.append(Readings(channel, np.array(times), values))
        return readings


def _is_compared(column: Column) -> bool:
    """Check whether a column has readings, and neither stamps nor constants of a sensor."""
    last = column.path.rpartition(".")[2]
    if column.kind[0] not in "fi" or column.kind == "i1" or last in _LEFT_OUT or last.endswith(_CONSTANTS):
        return False
    return not column.path.endswith(".count") or not column.is_list


def has_numbers(type_name: str) -> bool:
    """Check whether messages of a type have numbers to compare."""
    return type_name not in _WITHOUT_NUMBERS


def is_about_run(type_name: str) -> bool:
    """Check whether messages of a type tell about the run, such as its clock and log."""
    return type_name in _ABOUT_RUN


def bag_readings(bag: BagReader, topics: Sequence[str], until: float) -> list[Readings]:
    """Return the readings of topics of a bag up to a time [s].

    Raises:
        InputError: SK-CLI-035 the bag is damaged; SK-CLI-036 a message does not match its type.
    """
    collector = ReadingCollector()
    for message in bag.messages(topics) if topics else ():
        time = (message.time_ns - bag.time_origin) * 1e-9
        if time > until + 1e-9:
            break
        collector.take(message.topic, time, bag.decode(message), bag.store_of(message.type_name))
    return collector.readings()


class RunReadings:
    """Collector of readings of a running simulation; a context manager.

    Args:
        sim: simulation.
        topics: topics to collect; their sensors measure.
    """

    def __init__(self, sim: Simulation, topics: Sequence[str]) -> None:
        self._sim, self._collector = sim, ReadingCollector()
        self._store = msgs.type_store()
        self._taps = [sim.communication.bus.tap(topic, self._receiver(topic)) for topic in topics]

    def __enter__(self) -> RunReadings:
        return self

    def __exit__(self, *_: object) -> None:
        for tap in self._taps:
            tap.close()

    def _receiver(self, topic: str) -> Callable[[Any], None]:
        return lambda message: self._collector.take(topic, self._sim.time, message, self._store)

    def readings(self) -> list[Readings]:
        """Return the readings collected so far."""
        return self._collector.readings()


def common_topics(sim: Simulation, bag: BagReader) -> Iterator[tuple[str, str]]:
    """Yield each topic that a world publishes and a bag has, with its type, in the order of their names."""
    published = {
        topic
        for topic, endpoint, _, role in sim.communication.bus.endpoints()
        if role == "publishes" and endpoint.active
    }
    for topic in bag.topics:
        if topic.name in published:
            yield topic.name, topic.type_name


def aligned(recorded: Readings, simulated: Readings | None) -> Floats:
    """Return the simulated readings at the times of the recorded ones, shape of the recorded values.

    Between two messages of the run, numbers are interpolated linearly. Each quaternion gets the sign of the recorded
    one. Without messages the numbers are NaN.
    """
    shape = recorded.values.shape
    if simulated is None or not len(simulated.times):
        return np.full(shape, np.nan)
    values = simulated.values.copy()
    quaternions = recorded.channel.quaternions
    for at in quaternions:
        products = np.sum(values[1:, at : at + 4] * values[:-1, at : at + 4], axis=1)
        signs = np.cumprod(np.concatenate(([1.0], np.where(products < 0, -1.0, 1.0))))
        values[:, at : at + 4] *= signs[:, None]
    if np.array_equal(recorded.times, simulated.times):
        result = values
    else:
        result = np.empty(shape)
        for column in range(shape[1]):
            result[:, column] = np.interp(recorded.times, simulated.times, values[:, column])
    for at in quaternions:
        products = np.sum(result[:, at : at + 4] * recorded.values[:, at : at + 4], axis=1)
        result[:, at : at + 4] *= np.where(products < 0, -1.0, 1.0)[:, None]
    return result


def topic_pattern(text: str) -> str:
    """Return the topic of a text `TOPIC` or `TOPIC.FIELD`."""
    return text.partition(".")[0]


def is_compared(topic: str, column: str, compare: Sequence[str]) -> bool:
    """Check whether a column of a topic is compared.

    Args:
        topic: topic.
        column: column, such as `angular_velocity.x`.
        compare: texts `TOPIC` or `TOPIC.FIELD`; empty for all.
    """
    if not compare:
        return True
    for text in compare:
        pattern, _, field = text.partition(".")
        if matches_topic(topic, [pattern]) and (
            not field or column == field or column.startswith((f"{field}.", f"{field}["))
        ):
            return True
    return False


def check_fields(chosen: Sequence[str], columns: Sequence[tuple[str, str]]) -> None:
    """Check that each text of `--compare` selects a column.

    Args:
        chosen: texts `TOPIC` or `TOPIC.FIELD`.
        columns: topic and name of each column.

    Raises:
        InputError: SK-CLI-030 a text selects no column.
    """
    for text in chosen:
        if not any(is_compared(topic, column, [text]) for topic, column in columns):
            topic, _, field = text.partition(".")
            known = list(dict.fromkeys(column for name, column in columns if matches_topic(name, [topic])))
            hint = did_you_mean(field, known) or f"fields: {', '.join(known[:20]) or 'none'}"
            raise InputError("SK-CLI-030", f"--compare {text}: the readings have no such field; {hint}")


def check_topics(chosen: Sequence[str], available: Sequence[str]) -> None:
    """Check that each pattern of `--compare` matches a topic.

    Raises:
        InputError: SK-CLI-030 a pattern matches no topic that both have.
    """
    for pattern in chosen:
        topic = topic_pattern(pattern)
        if not any(matches_topic(known, [topic]) for known in available):
            hint = did_you_mean(topic, available) or f"topics of both: {', '.join(available) or 'none'}"
            raise InputError("SK-CLI-030", f"--compare {pattern}: the bag and the world have no such topic; {hint}")
