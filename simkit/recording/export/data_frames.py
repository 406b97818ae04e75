"""Messages of subscriptions and bags as pandas DataFrames: `simkit.to_dataframe`."""

from __future__ import annotations

import os
from collections.abc import Iterable

from simkit.argument_checks import check_text, wrong_type
from simkit.errors import InputError
from simkit.msgs import data_frames
from simkit.msgs.data_frames import DataFrame
from simkit.msgs.message_types import Message
from simkit.msgs.topic_names import absolute_name
from simkit.number_text import counted
from simkit.recording.bags.reader import BagReader, open_bag_to_read
from simkit.runtime import Subscription


def to_dataframe(
    source: Subscription | BagReader | str | os.PathLike[str] | Iterable[Message], topic: str | None = None
) -> DataFrame:
    """Return messages of one topic as a pandas DataFrame, one row for each message.

    The index `time` [s] is the stamp of the message: its field `header.stamp`, or a field of its own that is a time.
    Messages without a stamp have their recording time in a bag, and their number elsewhere.

    Each number or text has a column with its path, such as `pose.pose.position.x`. The items of an array whose length
    is fixed to at most 12 have columns too: `k[0]`. Longer and variable arrays are NumPy arrays in one column, and
    fields of lists of messages are lists in one column: `transforms[].child_frame_id`.

    Args:
        source: subscription, path of a bag, open bag, or messages.
        topic: topic of the bag; None if the bag has only one.

    Raises:
        ArgumentTypeError: the source has another kind.
        InputError: SK-CLI-030 the topic is not in the bag; SK-CLI-035 the bag cannot be read; SK-INPUT-004 pandas is
            not installed.
        MessageError: the messages have several types.
    """
    if isinstance(source, (str, os.PathLike)):
        with open_bag_to_read(os.fspath(source)) as bag:
            return to_dataframe(bag, topic)
    if isinstance(source, BagReader):
        if topic is None:
            names = list(dict.fromkeys(known.name for known in source.topics))
            if len(names) != 1:
                text = f"{source.path} has {counted(len(names), 'topic')}; give one of them"
                raise InputError("SK-CLI-030", f"{text}: {', '.join(names) or 'none'}")
            topic = names[0]
        check_text(topic, "the topic")
        return source.to_dataframe(absolute_name(topic))
    if topic is not None:
        raise wrong_type("the topic", "None, because the source is not a bag", topic)
    if isinstance(source, Subscription):
        return source.to_dataframe()
    if not isinstance(source, Iterable):
        raise wrong_type("the source", "a subscription, a bag or messages", source)
    return data_frames.to_dataframe(source)
