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
LARGEST_IN: Final = 256 << 10
"""Characters of the definitions in one frame to a simulation, which reads 1 MB in about 0.6 s."""
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
        texts = {name: text for name, text in own_interfaces.texts_used_by(named).items() if name not in self._sent}
        self._sent.update(texts)
        return {**content, _KEY: texts} if texts else content


def detach(content: JsonObject, most: int | None = None) -> dict[str, str]:
    """Remove the definitions from the content of a frame and return them, by the name of the type.

    Args:
        content: content of the frame, which is changed.
        most: largest number of characters of all definitions; None for no limit.

    Raises:
        BadFrame: the definitions are not texts, or are too long.
    """
    texts = content.pop(_KEY, None) or {}
    if not isinstance(texts, dict) or not all(isinstance(text, str) for text in texts.values()):
        raise BadFrame("the definitions of types in a frame are not texts")
    if most is not None and sum(map(len, texts.values())) > most:
        raise BadFrame(f"the definitions of types in a frame have more than {most} characters")
    return texts


def _texts(value: JsonValue, depth: int) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, (dict, list, tuple)) and depth:
        for item in value.values() if isinstance(value, dict) else value:
            yield from _texts(item, depth - 1)
