"""MAVLink: encoder and decoder of the few messages between PX4 and a simulator, driven by a table of their fields.

The frames are described in MAVLink's "Packet Serialization", the messages in its `common.xml`. A library is not needed
for five messages; the tests compare the bytes with those of pymavlink.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

Value = float | Sequence[float]

_FIELDS: Final[Mapping[str, tuple[int, str, str]]] = {
    "HEARTBEAT": (
        0,
        "uint8_t type, uint8_t autopilot, uint8_t base_mode, uint32_t custom_mode, uint8_t system_status, "
        "uint8_t mavlink_version",
        "",
    ),
    "HIL_ACTUATOR_CONTROLS": (93, "uint64_t time_usec, float[16] controls, uint8_t mode, uint64_t flags", ""),
    "HIL_SENSOR": (
        107,
        "uint64_t time_usec, float xacc, float yacc, float zacc, float xgyro, float ygyro, float zgyro, float xmag, "
        "float ymag, float zmag, float abs_pressure, float diff_pressure, float pressure_alt, float temperature, "
        "uint32_t fields_updated",
        "uint8_t id",
    ),
    "HIL_GPS": (
        113,
        "uint64_t time_usec, uint8_t fix_type, int32_t lat, int32_t lon, int32_t alt, uint16_t eph, uint16_t epv, "
        "uint16_t vel, int16_t vn, int16_t ve, int16_t vd, uint16_t cog, uint8_t satellites_visible",
        "uint8_t id, uint16_t yaw",
    ),
    "HIL_STATE_QUATERNION": (
        115,
        "uint64_t time_usec, float[4] attitude_quaternion, float rollspeed, float pitchspeed, float yawspeed, "
        "int32_t lat, int32_t lon, int32_t alt, int16_t vx, int16_t vy, int16_t vz, uint16_t ind_airspeed, "
        "uint16_t true_airspeed, int16_t xacc, int16_t yacc, int16_t zacc",
        "",
    ),
}
"""Number of each message, its fields in the order of `common.xml`, and the extension fields, which come last."""

_LETTERS: Final = {
    "uint8_t": "B",
    "int16_t": "h",
    "uint16_t": "H",
    "int32_t": "i",
    "uint32_t": "I",
    "uint64_t": "Q",
    "float": "f",
}
_START: Final = {0xFE: 6, 0xFD: 10}  # first byte of version 1 and of version 2 -> bytes before the payload
_FIRST_BYTE: Final = re.compile(b"[\xfd\xfe]")
_IS_SIGNED: Final = 0x01  # flag of a frame with a signature
_SIGNATURE: Final = 13  # bytes
_HIGHEST: Final = {"B": (0, 255), "h": (-32768, 32767), "H": (0, 65535), "i": (-(2**31), 2**31 - 1)}
_HIGHEST_REST: Final = {"I": (0, 2**32 - 1), "Q": (0, 2**64 - 1)}


@dataclass(frozen=True, slots=True)
class _Layout:
    """Layout of one message.

    Attributes:
        number: number of the message.
        fields: name, letter of `struct` and number of values of each field, in the order of the payload.
        payload: all fields.
        extra: byte that begins the checksum with the names and types of the fields.
    """

    number: int
    fields: tuple[tuple[str, str, int], ...]
    payload: struct.Struct
    extra: int


@dataclass(frozen=True, slots=True)
class MavlinkMessage:
    """Received message.

    Attributes:
        name: name of the message.
        fields: values by name of the field; an array is a tuple.
    """

    name: str
    fields: Mapping[str, float | tuple[float, ...]]


def _crc_row(byte: int) -> int:
    for _ in range(8):
        byte = (byte >> 1) ^ (0x8408 if byte & 1 else 0)
    return byte


_CRC_TABLE: Final = tuple(map(_crc_row, range(256)))


def checksum(data: bytes, crc: int = 0xFFFF) -> int:
    """Return the X.25 checksum of bytes, continued from `crc`."""
    for byte in data:
        crc = (crc >> 8) ^ _CRC_TABLE[(crc ^ byte) & 0xFF]
    return crc


def _parse(fields: str) -> list[tuple[str, str, int]]:
    """Return type, name and number of values of each field; the number is 0 for a single value."""
    layout = []
    for field in filter(None, fields.split(", ")):
        kind, name = field.split()
        kind, _, count = kind.rstrip("]").partition("[")
        layout.append((kind, name, int(count or 0)))
    return layout


def _layout(name: str) -> _Layout:
    number, written, extension = _FIELDS[name]
    main = sorted(_parse(written), key=lambda field: -struct.calcsize(_LETTERS[field[0]]))  # stable, as in MAVLink
    crc = checksum(f"{name} ".encode())
    for kind, field, count in main:
        crc = checksum(f"{kind} {field} ".encode() + bytes([count] if count else []), crc)
    ordered = [*main, *_parse(extension)]
    letters = "".join(f"{count or ''}{_LETTERS[kind]}" for kind, _, count in ordered)
    fields = tuple((field, _LETTERS[kind], count) for kind, field, count in ordered)
    return _Layout(number, fields, struct.Struct(f"<{letters}"), (crc & 0xFF) ^ (crc >> 8))


_LAYOUTS: Final = {name: _layout(name) for name in _FIELDS}
_NAMES: Final = {layout.number: name for name, layout in _LAYOUTS.items()}


def encode(name: str, fields: Mapping[str, Value], sequence: int, system: int = 1, component: int = 200) -> bytes:
    """Return a frame of MAVLink 2.

    Args:
        name: name of the message.
        fields: values by name; a missing field is zero. Integers are rounded and limited to their range.
        sequence: number of the frame.
        system: number of the sending vehicle.
        component: number of the sending part.
    """
    layout = _LAYOUTS[name]
    values: list[float] = []
    for field, letter, count in layout.fields:
        field_value = fields.get(field, (0,) * count if count else 0)
        listed = list(field_value) if isinstance(field_value, Sequence) else [field_value]
        values += listed if letter == "f" else [_integer(value, letter) for value in listed]
    payload = layout.payload.pack(*values).rstrip(b"\0") or b"\0"  # zeros at the end are not sent
    head = struct.pack("<BBBBBB", len(payload), 0, 0, sequence & 0xFF, system, component)
    body = head + layout.number.to_bytes(3, "little") + payload
    crc = checksum(bytes([layout.extra]), checksum(body))
    return b"\xfd" + body + crc.to_bytes(2, "little")


def _integer(value: float, letter: str) -> int:
    low, high = _HIGHEST.get(letter) or _HIGHEST_REST[letter]
    return 0 if value != value else int(max(low, min(high, round(max(-1e30, min(1e30, value))))))


class MavlinkDecoder:
    """Decoder of a stream of bytes; it finds the next frame after damaged data. Its memory is bounded.

    Attributes:
        damaged: number of bytes that belonged to no valid frame.
    """

    def __init__(self) -> None:
        self.damaged = 0
        self._waiting = bytearray()

    def clear(self) -> None:
        """Forget an incomplete frame, for a new connection."""
        self._waiting.clear()

    def feed(self, data: bytes) -> Iterator[MavlinkMessage]:
        """Yield the messages that bytes complete. Frames of messages that are not in the table are skipped."""
        self._waiting += data
        start = 0
        waiting = bytes(self._waiting)
        while start < len(waiting):
            if waiting[start] not in _START:
                following = _FIRST_BYTE.search(waiting, start)
                end = len(waiting) if following is None else following.start()
                self.damaged += end - start
                start = end
                continue
            size = _frame_size(waiting, start)
            if not size or start + size > len(waiting):
                break
            number = _frame_number(waiting, start)
            if number in _NAMES:
                message = _decode(waiting[start : start + size], _NAMES[number])
                if message is None:
                    self.damaged += 1
                    start += 1
                    continue
                yield message
            start += size
        self._waiting = bytearray(waiting[start:])


def _frame_size(data: bytes, start: int) -> int:
    """Return the number of bytes of a frame; 0 if its head is not complete."""
    head = _START[data[start]]
    if start + head > len(data):
        return 0
    is_signed = data[start] == 0xFD and data[start + 2] & _IS_SIGNED
    return head + data[start + 1] + 2 + (_SIGNATURE if is_signed else 0)


def _frame_number(data: bytes, start: int) -> int:
    if data[start] == 0xFE:
        return data[start + 5]
    return int.from_bytes(data[start + 7 : start + 10], "little")


def _decode(frame: bytes, name: str) -> MavlinkMessage | None:
    """Return the message of a whole frame; None if its checksum is wrong."""
    layout, head = _LAYOUTS[name], _START[frame[0]]
    end = head + frame[1]
    crc = checksum(bytes([layout.extra]), checksum(frame[1:end]))
    if int.from_bytes(frame[end : end + 2], "little") != crc:
        return None
    payload = frame[head:end][: layout.payload.size].ljust(layout.payload.size, b"\0")
    values = iter(layout.payload.unpack(payload))
    fields: dict[str, float | tuple[float, ...]] = {}
    for field, _, count in layout.fields:
        fields[field] = tuple(next(values) for _ in range(count)) if count else next(values)
    return MavlinkMessage(name, fields)
