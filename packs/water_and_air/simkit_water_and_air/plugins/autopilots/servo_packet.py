"""ArduPilot's JSON interface for simulators: servo packets in, one line of JSON out.

The protocol is described in ArduPilot's repository, `libraries/SITL/examples/JSON/readme.md`. A servo packet is binary
and little-endian: a magic number, the frame rate [Hz], the number of the frame, and 16 or 32 pulse widths [µs].
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

LONGEST: Final = 1024
"""Number of bytes that are read of a datagram; a packet with 32 channels has 72."""

_LAYOUTS: Final = {16: (18458, struct.Struct("<HHI16H")), 32: (29569, struct.Struct("<HHI32H"))}


@dataclass(frozen=True, slots=True)
class ServoPacket:
    """Outputs of ArduPilot for one frame.

    Attributes:
        frame_rate: wanted rate of the physics [Hz].
        frame: number of the frame; a restarted ArduPilot begins again.
        pulse_widths: output of each channel [µs].
    """

    frame_rate: int
    frame: int
    pulse_widths: tuple[int, ...]


def decode_servo_packet(data: bytes, channels: int) -> ServoPacket | str:
    """Return the content of a datagram, or the reason why it is not a servo packet.

    Args:
        data: content of the datagram.
        channels: number of channels, 16 or 32.
    """
    magic, layout = _LAYOUTS[channels]
    if len(data) < 2:
        return f"found {len(data)} bytes; expected {layout.size}"
    number_found = int.from_bytes(data[:2], "little")
    if number_found != magic:
        other = next((n for n, (number, _) in _LAYOUTS.items() if number == number_found), None)
        named = f" (of packets with {other} channels)" if other else ""
        return f"found the magic number {number_found}{named}; expected {magic}"
    if len(data) != layout.size:
        return f"found {len(data)} bytes; expected {layout.size}"
    _, rate, frame, *pulse_widths = layout.unpack(data)
    return ServoPacket(rate, frame, tuple(pulse_widths))


def encode_state(
    timestamp: float,
    gyro: Sequence[float],
    accelerations: Sequence[float],
    position: Sequence[float],
    quaternion: Sequence[float],
    velocity: Sequence[float],
    more: Mapping[str, object],
) -> bytes:
    """Return the line of JSON for ArduPilot.

    Args:
        timestamp: simulated time [s].
        gyro: angular rate in the axes of the body, forward-right-down [rad/s].
        accelerations: specific force in the same axes [m/s²].
        position: position, north-east-down [m].
        quaternion: rotation from body to north-east-down, w x y z.
        velocity: velocity, north-east-down [m/s].
        more: further fields, such as `rng_1`.
    """
    state = {
        "timestamp": timestamp,
        "imu": {"gyro": list(gyro), "accel_body": list(accelerations)},
        "position": list(position),
        "quaternion": list(quaternion),
        "velocity": list(velocity),
        **more,
    }
    # ArduPilot's parser skips `":` after a name, so there must be no spaces
    return f"\n{json.dumps(state, separators=(',', ':'))}\n".encode()
