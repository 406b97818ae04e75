"""Messages in rospy: those of any type, and those that are made of the arguments of a call."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

from simkit_nodes.interfaces.ros1_message import Message
from simkit_nodes.ros1_modules.rospy.exceptions import ROSException

__all__ = ["AnyMsg", "args_kwds_to_message"]


class AnyMsg(Message):
    """Message of any type, as bytes.

    Attributes:
        _buff: bytes of the message.
    """

    _md5sum: ClassVar = "*"
    _type: ClassVar = "*"
    _full_text: ClassVar = ""
    __slots__ = ("_buff",)

    def __init__(self, *args: object) -> None:
        if args:
            raise ROSException("AnyMsg does not accept arguments")
        self._buff: bytes | None = None

    def serialize(self, buff: Any) -> None:
        """Write the bytes."""
        if self._buff is None:
            raise ROSException("AnyMsg is not initialized")
        buff.write(self._buff)

    def deserialize(self, data: bytes) -> AnyMsg:
        """Store the bytes."""
        self._buff = data
        return self


def args_kwds_to_message(data_class: type[Any], args: Sequence[Any], kwds: Mapping[str, Any]) -> Any:
    """Return the message that a call means: its only argument, or a new message of its arguments.

    Raises:
        TypeError: there are arguments with and without names, or a message of another type.
    """
    if args and kwds:
        raise TypeError("publish() can be called with arguments or keywords, but not both.")
    if kwds:
        return data_class(**kwds)
    if len(args) == 1 and isinstance(args[0], Message):
        (message,) = args
        if message._type == data_class._type or isinstance(message, AnyMsg):
            return message
        types = data_class._slot_types
        if not types:
            raise TypeError(f"expected [] but got [{message._type}]")
        if message._type != types[0]:
            raise TypeError(f"expected [{types[0]}] but got [{message._type}]")
    return data_class(*args)
