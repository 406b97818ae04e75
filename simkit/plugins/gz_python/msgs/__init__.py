"""The subset of gz.msgs that simkit's topics carry: `from gz.msgs10.twist_pb2 import Twist` and the like.

Messages of gz are Python objects, or text in protobuf's text format. The package converts them to the ROS messages of
simkit's topics, and back. It does not serialise them as protobuf, and nothing leaves the process.
"""

from __future__ import annotations

import re
from typing import Final

from simkit.plugins.gz_python.math.missing_names import missing_name_error
from simkit.plugins.gz_python.msgs.message import MESSAGE_CLASSES, Message

_ONE_WORD: Final = ("LaserScan", "NavSat", "StringMsg")


def _file_of(name: str) -> str:
    separated = name if name in _ONE_WORD else re.sub("(?<=[a-z])(?=[A-Z])", "_", name)
    return f"{separated.lower()}_pb2"


_FILES: Final = {_file_of(name): name for name in MESSAGE_CLASSES if name != "Map"}
"""Message of each module of gz.msgs."""


def message_class(name: str) -> type[Message]:
    """Return a message class by name."""
    return MESSAGE_CLASSES[name]


def contents_of(module: str) -> dict[str, object]:
    """Return the contents of a module such as `twist_pb2`.

    Raises:
        ModuleNotFoundError: simkit does not have this module.
    """
    name = _FILES.get(module)
    if name is None:
        listed = ", ".join(sorted(_FILES))
        raise ModuleNotFoundError(f"simkit has no gz.msgs.{module}; it has {listed}", name=f"gz.msgs.{module}")
    return {name: MESSAGE_CLASSES[name], "__all__": [name]}


def __getattr__(name: str) -> type[Message]:
    if name in MESSAGE_CLASSES:
        return MESSAGE_CLASSES[name]
    raise missing_name_error("gz.msgs", name, MESSAGE_CLASSES)
