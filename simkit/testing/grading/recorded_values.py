"""Bytes of the values that the checks of an exercise read: poses, velocities, joints, contacts and messages.

Each value is `=` and its bytes, or `?` and the reason why it is unknown.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any, Final

import numpy as np

from simkit import msgs
from simkit.pose import Pose, Vector
from simkit.testing.conditions.syntax_tree import UndecidedValue
from simkit.testing.grading.run_stream import DamagedStreamError

JOINT_VALUES: Final = ("position", "velocity", "effort", "lower", "upper")
_POSE, _TWIST, _CONTACTS = struct.Struct("<7d"), struct.Struct("<6d"), struct.Struct("<Id")
_MOST_TEXT: Final = 4096  # bytes of a description
_SCALAR: Final = 255  # count of numbers of a value that is one number and no list


def known(read: Callable[[], bytes]) -> bytes:
    """Return the bytes of a value, or the reason why it is unknown."""
    try:
        return b"=" + read()
    except UndecidedValue as reason:
        return b"?" + str(reason).encode()[:_MOST_TEXT]


def value_bytes(content: bytes) -> bytes:
    """Return the bytes of a known value.

    Raises:
        UndecidedValue: The value is unknown.
        DamagedStreamError: The content is no value.
    """
    if content[:1] == b"=":
        return content[1:]
    if content[:1] == b"?":
        raise UndecidedValue(_text(content[1:]))
    raise DamagedStreamError("a value is invalid")


def encode_pose(pose: Pose) -> bytes:
    """Encode a pose."""
    return _POSE.pack(*pose.position.tolist(), *pose.quaternion.tolist())


def decode_pose(content: bytes) -> Pose:
    """Decode a pose."""
    numbers = _numbers(_POSE, content)
    return Pose(tuple(numbers[:3]), tuple(numbers[3:]))


def encode_twist(twist: tuple[Vector, Vector]) -> bytes:
    """Encode the linear and the angular velocity."""
    return _TWIST.pack(*twist[0].tolist(), *twist[1].tolist())


def decode_twist(content: bytes) -> tuple[Vector, Vector]:
    """Decode the linear and the angular velocity."""
    numbers = _numbers(_TWIST, content)
    return np.array(numbers[:3]), np.array(numbers[3:])


def encode_joint(joint: Any) -> bytes:
    """Encode position, velocity, effort and limits of a joint."""
    out = bytearray()
    for name in JOINT_VALUES:
        value = np.asarray(getattr(joint, name), dtype="<f8")
        out.append(_SCALAR if value.ndim == 0 else value.size)
        out += value.tobytes()
    return bytes(out)


def decode_joint(content: bytes) -> dict[str, Any]:
    """Decode position, velocity, effort and limits of a joint."""
    found: dict[str, Any] = {}
    at = 0
    for name in JOINT_VALUES:
        count = content[at] if at < len(content) else 0
        size = 8 * (1 if count == _SCALAR else count)
        numbers = np.frombuffer(content[at + 1 : at + 1 + size], "<f8").astype(np.float64)
        found[name] = float(numbers[0]) if count == _SCALAR and len(numbers) else numbers
        at += 1 + size
    if at != len(content):
        raise DamagedStreamError("a value is invalid")
    return found


def encode_contacts(contacts: Any) -> bytes:
    """Encode number, force and description of contacts."""
    count = len(contacts.now())
    if not count:
        return _CONTACTS.pack(0, 0.0)
    text: bytes = contacts.describe().encode()
    return _CONTACTS.pack(count, contacts.force()) + text[:_MOST_TEXT]


def decode_contacts(content: bytes) -> tuple[int, float, str]:
    """Decode number, force and description of contacts."""
    count, force = _numbers(_CONTACTS, content[: _CONTACTS.size])
    return int(count), force, _text(content[_CONTACTS.size :])


def encode_message(message: Any) -> bytes:
    """Encode a message with its type."""
    content: bytes = msgs.type_name(message).encode() + b"\0" + msgs.serialize(message)
    return content


def decode_message(content: bytes) -> Any:
    """Decode a message."""
    name, _, data = content.partition(b"\0")
    try:
        return msgs.deserialize(data, _text(name))
    except Exception as error:  # noqa: BLE001 (the decoder raises many kinds for invalid bytes)
        raise DamagedStreamError(f"a message is invalid: {type(error).__name__}") from None


def _numbers(form: struct.Struct, content: bytes) -> tuple[float, ...]:
    if len(content) != form.size:
        raise DamagedStreamError("a value is invalid")
    return form.unpack(content)


def _text(content: bytes) -> str:
    return content.decode("utf-8", "replace")
