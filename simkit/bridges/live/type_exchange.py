"""Definitions of the user's types, which travel with the first frame that names a type.

Each side of a connection sends the definition of a type once, before its first message. Both sides can then decode the
messages, and name the fields, without the folder of the definitions.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from simkit.bridges.live.protocol import BadFrame, JsonObject, JsonValue
from simkit.msgs import own_interfaces

_KEY: Final = "interfaces"
_MOST_TYPES: Final = 1000  # types in one frame, and types that clients define in one run
_LONGEST_TEXT: Final = 64 << 10  # characters
_DEEPEST: Final = 4  # levels of lists and objects in a frame that are searched for the names of types


class SentTypes:
    """Types whose definitions the other side of a connection has."""

    def __init__(self) -> None:
        self._sent: set[str] = set()

    def attach(self, content: JsonObject) -> JsonObject:
        """Return the content of a frame with the definitions of all types that it names, except those sent before."""
        if not own_interfaces.has_any():
            return content
        named = set(_texts(content, _DEEPEST)) - self._sent
        found = {name: text for name, text in own_interfaces.texts_used_by(named).items() if name not in self._sent}
        self._sent.update(found)
        return {**content, _KEY: found} if found else content


def detach(content: JsonObject) -> dict[str, str]:
    """Remove the definitions from the content of a frame and return them, by the name of the type.

    Raises:
        BadFrame: the definitions are not texts, or are too many or too long.
    """
    found = content.pop(_KEY, None) or {}
    if (
        not isinstance(found, dict)
        or len(found) > _MOST_TYPES
        or not all(isinstance(text, str) and len(text) <= _LONGEST_TEXT for text in found.values())
    ):
        raise BadFrame("the definitions of types in a frame are not texts of moderate length")
    return found


def _texts(value: JsonValue, depth: int) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, (dict, list, tuple)) and depth:
        for item in value.values() if isinstance(value, dict) else value:
            yield from _texts(item, depth - 1)
