"""Frames on the socket of a running simulation, and the errors of the client and the server."""

from __future__ import annotations

import json
import struct
from hmac import compare_digest
from typing import Any, Final

from simkit.errors import InputError
from simkit.number_text import counted


class LiveError(InputError):
    """Error for a simulation that does not answer, or that answered with an error.

    Attributes:
        code: code of the simulation's error (such as `SK-SERVICE-001`), else one of `SK-LIVE-001` to 009.
    """

    def __init__(self, code: str, message: str | None = None) -> None:
        super().__init__(code, message, shows_code=code not in (message or ""))  # an answer may have the code


class LiveClosed(LiveError):
    """Error for a simulation that has ended or has closed the connection; the message has the reason if it is known."""

    code = "SK-LIVE-005"
    _shows_class_code = True


class BadFrame(Exception):
    """Error for received bytes that are not a frame of the protocol."""


# JSON value as a Python object.
JsonValue = Any
JsonObject = dict[str, JsonValue]
PROTOCOL: Final = 1
ASK, ANSWER, TELL, MESSAGE = 1, 2, 3, 4
HEAD: Final = struct.Struct("<IB")
MESSAGE_HEAD: Final = struct.Struct("<IIqQ")
MESSAGE_FRAME_HEAD: Final = struct.Struct(HEAD.format + MESSAGE_HEAD.format[1:])
"""Head of a frame with a message: `HEAD` and `MESSAGE_HEAD`."""
NUMBER: Final = struct.Struct("<I")
LARGEST_IN: Final = 16 << 20  # [bytes] in a frame to the simulation
_COPY_BYTES: Final = 2048  # [bytes] below which copying a frame is faster than a view
LARGEST_OUT: Final = 256 << 20  # [bytes] in a frame from the simulation


def json_default(value: object) -> object:
    """Convert a value that JSON does not support: arrays, bytes and sets."""
    if hasattr(value, "tolist"):  # arrays and scalars of NumPy
        return value.tolist()
    if isinstance(value, (bytes, bytearray, memoryview)):
        return list(value)
    if isinstance(value, (set, frozenset)):
        return sorted(value)
    raise TypeError(f"{type(value).__name__} cannot be sent")


def json_frame(kind: int, content: JsonObject, data: bytes = b"") -> bytes:
    """Return a frame of JSON, optionally followed by CDR."""
    text = json.dumps(content, default=json_default, separators=(",", ":")).encode()
    return b"".join((HEAD.pack(4 + len(text) + len(data), kind), NUMBER.pack(len(text)), text, data))


def message_frame(number: int, data: bytes) -> bytes:
    """Return a frame with a message to the simulation."""
    return b"".join((HEAD.pack(4 + len(data), MESSAGE), NUMBER.pack(number), data))


def read_json_frame(body: bytes) -> tuple[JsonObject, bytes]:
    """Return the JSON of a frame's body, and the bytes after it.

    Raises:
        BadFrame: the body is not a JSON frame.
    """
    if len(body) < 4:
        raise BadFrame("a frame of JSON is shorter than the length of its text")
    end = 4 + NUMBER.unpack_from(body)[0]
    if end > len(body):
        raise BadFrame("the JSON text of a frame is longer than the frame")
    try:
        content = json.loads(body[4:end])
    except (ValueError, RecursionError):
        raise BadFrame("a frame is not JSON, or has a number with too many digits") from None
    if not isinstance(content, dict):
        raise BadFrame("the JSON of a frame is not an object")
    return content, body[end:]


class FrameReader:
    """Splitter of received bytes into frames.

    Args:
        largest: largest accepted body [bytes].
        kinds: accepted kinds of frames.
        token: bytes that must come before the first frame.
    """

    def __init__(self, largest: int, kinds: tuple[int, ...], token: bytes = b"") -> None:
        self._largest, self._kinds, self._token = largest, kinds, token
        self._buffer = bytearray()
        self._begin = 0

    def feed(self, data: bytes | memoryview) -> None:
        """Append received bytes."""
        if self._begin:
            del self._buffer[: self._begin]
            self._begin = 0
        self._buffer += data

    @property
    def is_in_frame(self) -> bool:
        """True if a frame, or a part of one, is in the buffer."""
        return len(self._buffer) > self._begin

    def next(self) -> tuple[int, bytes] | None:
        """Return the kind and the body of the next whole frame; None until a frame is complete.

        Raises:
            BadFrame: the frame has an unknown kind, or is larger than allowed, or the token before it is wrong.
        """
        if self._token and not self._take_token():
            return None
        buffer, begin = self._buffer, self._begin
        available = len(buffer)
        if available - begin < 5:
            return None
        length, kind = HEAD.unpack_from(buffer, begin)
        if kind not in self._kinds:
            raise BadFrame(f"a frame has kind {kind}; expected {' or '.join(map(str, self._kinds))}")
        if length > self._largest:
            raise BadFrame(f"a frame has {counted(length, 'byte')}; the limit is {self._largest}")
        end = begin + 5 + length
        if available < end:
            return None
        self._begin = end
        if length < _COPY_BYTES:
            return kind, bytes(buffer[begin + 5 : end])
        return kind, bytes(memoryview(buffer)[begin + 5 : end])

    def _take_token(self) -> bool:
        """Compare the first bytes with the token; return False until they are complete."""
        token = self._token
        if len(self._buffer) < len(token):
            return False
        if not compare_digest(bytes(self._buffer[: len(token)]), token):
            raise BadFrame("the first bytes are not the token of the simulation")
        self._begin, self._token = len(token), b""
        return True
