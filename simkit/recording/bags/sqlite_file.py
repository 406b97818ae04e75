"""SQLite file of rosbag2, read only from plain tables, because a view or a generated column can run without end."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

from simkit.recording.bags.bag_contents import BagMessage, BagTopic, unreadable
from simkit.recording.bags.mcap_records import LARGEST_RECORD, LATEST_TIME, is_latched

_DAMAGE: Final = (sqlite3.Error, ValueError, OverflowError, MemoryError, RecursionError)


class SqliteFile:
    """Open SQLite file of rosbag2; see `BagFile`.

    Raises:
        InputError: SK-CLI-035 the file is unreadable.
    """

    storage, damage = "sqlite3", ""

    def __init__(self, path: Path) -> None:
        self._path, self.run = path, dict[str, str]()
        try:
            # "immutable" ignores journals, so that a read-only folder can be read
            self._database = sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro&immutable=1", uri=True)
        except sqlite3.Error as error:
            raise unreadable(path, error) from None
        try:
            self._database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LARGEST_RECORD)
            self._tables = self._plain_tables()
            missing = [name for name in ("messages", "topics") if name not in self._tables]
            if missing:
                raise ValueError(f"it has no table {' and no table '.join(missing)}")
            self._names = self._read_topics()
            self._definitions = self._read_definitions()
            self._counts = dict(self._rows("SELECT topic_id, count(*) FROM messages GROUP BY topic_id", int, int))
            ((first, last),) = self._database.execute("SELECT min(timestamp), max(timestamp) FROM messages")
            if first is not None:
                self._check_time(first)
                self._check_time(last)
            self.start, self.end = first or 0, last or 0
        except _DAMAGE as error:
            self._database.close()
            raise unreadable(path, error) from None

    def close(self) -> None:
        """Close the file."""
        self._database.close()

    def topics(self) -> list[BagTopic]:
        """Return the topics with their numbers of messages."""
        return [
            BagTopic(name, kind, self._counts.get(n, 0), self._definitions.get(kind, ""), is_latched(qos), encoding)
            for n, (name, kind, encoding, qos) in self._names.items()
        ]

    def messages(self, topics: frozenset[str], start: int | None) -> Iterator[BagMessage]:
        """Yield the messages of some topics (empty: all) from a time [ns] on, in the order of their times.

        Raises:
            InputError: SK-CLI-035 the file is damaged.
        """
        wanted = [n for n, (name, *_) in self._names.items() if not topics or name in topics]
        selected = ",".join(map(str, wanted))
        query = f"SELECT topic_id, timestamp, data FROM messages WHERE topic_id IN ({selected}) AND timestamp >= ?"
        try:
            for row in self._database.execute(f"{query} ORDER BY timestamp, rowid", (start or 0,)):
                number, time_ns, data = row
                self._check_time(time_ns)
                if not isinstance(data, bytes):
                    raise ValueError(f"a message has no bytes, but a value of SQLite type {type(data).__name__}")
                name, type_name, *_ = self._names[number]
                yield BagMessage(time_ns, name, type_name, data)
        except _DAMAGE as error:
            raise unreadable(self._path, f"it is damaged: {error}") from None

    def _plain_tables(self) -> dict[str, set[str]]:
        """Return the columns of the tables that are stored in the file, without views and generated columns."""
        rows = self._rows("SELECT name FROM sqlite_master WHERE type = 'table' AND rootpage > 0", str)
        return {
            name: {column for column, hidden in self._columns(name) if not hidden}
            for (name,) in rows
            if name in ("messages", "topics", "message_definitions")
        }

    def _columns(self, table: str) -> list[tuple[str, int]]:
        return [(row[1], row[6]) for row in self._database.execute(f"PRAGMA table_xinfo({table})")]

    def _read_topics(self) -> dict[int, tuple[str, str, str, str]]:
        """Return name, type, encoding and QoS profiles of each topic, by its number."""
        if not {"topic_id", "timestamp", "data"} <= self._tables["messages"]:
            raise ValueError("the table messages needs the columns topic_id, timestamp and data")
        if not {"id", "name", "type", "serialization_format"} <= self._tables["topics"]:
            raise ValueError("the table topics needs the columns id, name, type and serialization_format")
        profiles = "offered_qos_profiles" if "offered_qos_profiles" in self._tables["topics"] else "''"
        query = f"SELECT id, name, type, serialization_format, {profiles} FROM topics"
        return {n: (name, kind, form, qos) for n, name, kind, form, qos in self._rows(query, int, str, str, str, str)}

    def _read_definitions(self) -> dict[str, str]:
        """Return the definitions of the types as ROS 2 text; bags before ROS 2 Iron have none."""
        columns = {"topic_type", "encoding", "encoded_message_definition"}
        if not columns <= self._tables.get("message_definitions", set()):
            return {}
        query = "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions"
        return {kind: text for kind, form, text in self._rows(query, str, str, str) if form == "ros2msg"}

    def _rows(self, query: str, *types: type) -> Iterator[tuple[Any, ...]]:
        """Yield rows whose values have the given types. SQLite stores any value in any column."""
        for row in self._database.execute(query):
            if not all(isinstance(value, kind) for value, kind in zip(row, types, strict=True)):
                raise ValueError(f"found the values {row!r:.200}; expected {', '.join(t.__name__ for t in types)}")
            yield row

    def _check_time(self, time_ns: object) -> None:
        if not isinstance(time_ns, int) or not 0 <= time_ns <= LATEST_TIME:
            raise ValueError(f"a message has the time {time_ns!r:.40}; expected 0 to {LATEST_TIME} ns")
