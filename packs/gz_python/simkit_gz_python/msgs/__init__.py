"""Replacement of gz.msgs with the messages that simkit's topics support: `from gz.msgs10.twist_pb2 import Twist`.

A message of gz is a Python object, or text in protobuf's text format. The package converts gz messages to the ROS
messages of simkit's topics, and back. It has no binary protobuf format, because no message leaves the process.
"""

from __future__ import annotations

import re
from typing import Final

from simkit_gz_python.math.missing_names import missing_name_error
from simkit_gz_python.msgs.message import MESSAGE_CLASSES, Message

_ONE_WORD: Final = ("LaserScan", "NavSat", "StringMsg")


def _file_of(name: str) -> str:
    separated = name if name in _ONE_WORD else re.sub("(?<=[a-z])(?=[A-Z])", "_", name)
    return f"{separated.lower()}_pb2"


_FILES: Final = {_file_of(name): name for name in MESSAGE_CLASSES if name != "Map"}
"""Name of the message in each module of gz.msgs, such as `Twist` in `twist_pb2`."""


def message_class(name: str) -> type[Message]:
    """Return a message class by name."""
    return MESSAGE_CLASSES[name]


def contents_of(module: str) -> dict[str, object]:
    """Return the names and objects of a module such as `twist_pb2`.

    Raises:
        ModuleNotFoundError: simkit does not have this module.
    """
    name = _FILES.get(module)
    if name is None:
        listed = ", ".join(sorted(_FILES))
        message = f"simkit has no gz.msgs.{module}; supported modules of gz.msgs: {listed}"
        raise ModuleNotFoundError(message, name=f"gz.msgs.{module}")
    return {name: MESSAGE_CLASSES[name], "__all__": [name]}


def __getattr__(name: str) -> type[Message]:
    if name in MESSAGE_CLASSES:
        return MESSAGE_CLASSES[name]
    raise missing_name_error("gz.msgs", name, MESSAGE_CLASSES)
