"""Messages of one type as a pandas DataFrame."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit.argument_checks import wrong_type
from simkit.errors import InputError, MessageError
from simkit.install_command import install_command
from simkit.msgs.message_columns import TEXT, Column, columns_of
from simkit.msgs.message_text import field_nodes, field_value, is_message
from simkit.msgs.message_types import Message, type_store

if TYPE_CHECKING:
    import numpy.typing as npt
    from pandas import DataFrame as DataFrame
    from rosbags.typesys.store import Typestore
else:
    DataFrame = Any  # pandas is optional

_TIME: Final = "builtin_interfaces/msg/Time"
_HEADER: Final = "std_msgs/msg/Header"
_NS: Final = 1_000_000_000
_LONGEST_SPREAD: Final = 12  # largest fixed-length array whose items have columns of their own, as in curves


def to_dataframe(
    messages: Iterable[Message], times_ns: Sequence[int] | None = None, store: Typestore | None = None
) -> DataFrame:
    """Return messages of one type as a pandas DataFrame, one row for each message.

    The index `time` [s] is the stamp of the message: its field `header.stamp`, or a field of its own that is a time.
    Messages without a stamp have their recording time, or their number if there is none.

    Each number or text has a column with its path, such as `pose.pose.position.x`. The items of an array whose length
    is fixed to at most 12 have columns too: `k[0]`. Longer and variable arrays are NumPy arrays in one column, and
    fields of lists of messages are lists in one column: `transforms[].child_frame_id`.

    Args:
        messages: messages of one type.
        times_ns: recording times of the messages [ns].
        store: type store of the messages; None for simkit's.

    Raises:
        ArgumentTypeError: a value is not a message.
        MessageError: the messages have several types.
        InputError: SK-INPUT-004 pandas is not installed.
    """
    pandas = _pandas()
    all_messages = list(messages)
    for number, message in enumerate(all_messages):
        if not is_message(message):
            raise wrong_type(f"messages[{number}]", "a message", message)
    types = list(dict.fromkeys(message.__msgtype__ for message in all_messages))
    if len(types) > 1:
        raise MessageError(f"the messages have several types: {', '.join(types)}; a table needs messages of one type")
    if not all_messages:
        return pandas.DataFrame(index=pandas.Index([], name="time", dtype=float))
    store = store or type_store()
    stamp = _stamp_path(types[0], store)
    columns = columns_of(types[0], store, frozenset({".".join(stamp)}))
    for column in columns:
        try:
            for message in all_messages:
                column.take(message)
        except (TypeError, ValueError, AttributeError, OverflowError) as error:
            raise MessageError(f"{types[0]}.{column.path} of a message has a value of a wrong kind: {error}") from None
    if stamp:
        seconds = [_seconds(message, stamp) for message in all_messages]
    else:
        seconds = [time_ns / _NS for time_ns in times_ns or ()]
    index = pandas.Index(seconds, name="time") if seconds else pandas.RangeIndex(len(all_messages), name="message")
    data = {name: pandas.Series(values, index, dtype) for c in columns for name, values, dtype in _series_of(c)}
    return pandas.DataFrame(data, index=index)


def _pandas() -> ModuleType:
    """Return the package pandas.

    Raises:
        InputError: SK-INPUT-004 the package is not installed.
    """
    try:
        return import_module("pandas")
    except ImportError:
        text = "a DataFrame needs the package pandas, which is not installed"
        raise InputError("SK-INPUT-004", text, help=install_command("pandas")) from None


def _stamp_path(type_name: str, store: Typestore) -> tuple[str, ...]:
    """Return the path of a type's time; empty if it has none."""
    nodes = field_nodes(type_name, store)
    if any(name == "header" and node[1] == _HEADER for name, node in nodes):
        return "header", "stamp"
    return next(((name,) for name, node in nodes if node[1] == _TIME), ())


def _seconds(message: Message, path: tuple[str, ...]) -> float:
    for name in path:
        message = field_value(message, name)
    return (int(message.sec) * _NS + int(message.nanosec)) / _NS


def _series_of(column: Column) -> Iterator[tuple[str, Sequence[object] | npt.NDArray[np.generic], type | None]]:
    """Yield name, values and NumPy type of each series of a column."""
    if not column.is_list:
        yield column.path, column.numbers().copy() if column.kind != TEXT else list(column.values), None
    elif column.kind == TEXT:
        yield column.path, list(column.rows()), object
    elif 0 < column.length <= _LONGEST_SPREAD:
        table = column.numbers().reshape(-1, column.length)
        for number in range(column.length):
            yield f"{column.path}[{number}]", table[:, number].copy(), None
    else:
        yield column.path, [part.copy() for part in np.split(column.numbers(), np.cumsum(column.counts)[:-1])], object
