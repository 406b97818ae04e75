"""MAVLink frames: the bytes of pymavlink, and what a decoder does with pieces and with damaged data."""

from __future__ import annotations

import numpy as np
import pytest

from simkit_water_and_air.plugins.autopilots.mavlink import _LAYOUTS, MavlinkDecoder, checksum, encode

CONTROLS = tuple(0.1 * i for i in range(8)) + (0.0,) * 8
TIME = {"time_usec": 123456789}
PLACE = {"lat": 473977420, "lon": 85455940, "alt": 488000}
FRAMES = {
    "HEARTBEAT": (
        0,
        {"type": 0, "autopilot": 8, "mavlink_version": 3},
        "fd0900000001c8000000000000000008000003a9af",
    ),
    "HIL_SENSOR": (
        1,
        {
            **TIME,
            "xacc": 0.5,
            "yacc": -1.25,
            "zacc": -9.75,
            "xgyro": 0.125,
            "ygyro": -0.25,
            "zgyro": 0.375,
            "xmag": 0.21,
            "ymag": 0.01,
            "zmag": 0.43,
            "abs_pressure": 955.5,
            "diff_pressure": 0.25,
            "pressure_alt": 488.5,
            "temperature": 15.5,
            "fields_updated": 0x1FFF,
        },
        "fd3e00000101c86b000015cd5b07000000000000003f0000a0bf00001cc10000003e000080be0000c03e3d0a573e0ad7233cf628dc3e"
        "00e06e440000803e0040f44300007841ff1f0aec",
    ),
    "HIL_GPS": (
        2,
        {
            **TIME,
            **PLACE,
            "fix_type": 3,
            "eph": 100,
            "epv": 150,
            "vel": 500,
            "vn": 300,
            "ve": -400,
            "vd": -50,
            "cog": 30687,
            "satellites_visible": 10,
        },
        "fd2400000201c871000015cd5b07000000004c52401c44f417054072070064009600f4012c0170feceffdf77030a960c",
    ),
    "HIL_STATE_QUATERNION": (
        3,
        {
            **TIME,
            **PLACE,
            "attitude_quaternion": (1.0, 0.5, -0.25, 0.125),
            "rollspeed": 0.1,
            "pitchspeed": -0.2,
            "yawspeed": 0.3,
            "vx": 100,
            "vy": -200,
            "vz": 300,
            "ind_airspeed": 400,
            "true_airspeed": 500,
            "xacc": -1000,
            "yacc": 20,
            "zacc": -9800,
        },
        "fd4000000301c873000015cd5b07000000000000803f0000003f000080be0000003ecdcccc3dcdcc4cbe9a99993e4c52401c44f41705"
        "40720700640038ff2c019001f40118fc1400b8d9357d",
    ),
    "HIL_ACTUATOR_CONTROLS": (
        4,
        {**TIME, "controls": CONTROLS, "mode": 129, "flags": 1},
        "fd5100000401c85d000015cd5b0700000000010000000000000000000000cdcccc3dcdcc4c3e9a99993ecdcccc3e0000003f9a99193f"
        "3333333f0000000000000000000000000000000000000000000000000000000000000000814a6e",
    ),
}
"""Number of the frame, fields and bytes of pymavlink 2.4.50 for each message."""
VERSION_1 = bytes.fromhex(
    "fe510501c85d15cd5b0700000000010000000000000000000000cdcccc3dcdcc4c3e9a99993ecdcccc3e0000003f9a99193f3333333f"
    "000000000000000000000000000000000000000000000000000000000000000081185d"
)
COMMAND_LONG = bytes.fromhex("fd1e00000601c84c00000000e64200409c450000000000000000000000000000000000000000ff018c1f")


def test_the_checksum_is_that_of_x_25() -> None:
    assert checksum(b"123456789") == 0x6F91  # CRC-16/MCRF4XX, which MAVLink uses


def test_the_extra_bytes_are_those_of_common_xml() -> None:
    expected = {"HEARTBEAT": 50, "HIL_ACTUATOR_CONTROLS": 47, "HIL_SENSOR": 108, "HIL_GPS": 124}
    assert {name: layout.extra for name, layout in _LAYOUTS.items()} == {**expected, "HIL_STATE_QUATERNION": 4}


@pytest.mark.parametrize("name", FRAMES)
def test_frames_have_the_bytes_of_pymavlink(name: str) -> None:
    sequence, fields, expected = FRAMES[name]
    frame = encode(name, fields, sequence)
    assert frame.hex() == expected
    (message,) = MavlinkDecoder().feed(frame)
    assert message.name == name
    for field, value in fields.items():
        assert message.fields[field] == pytest.approx(value, rel=1e-7)


def test_messages_arrive_from_pieces_of_any_size_and_in_version_1() -> None:
    stream = b"".join(bytes.fromhex(frame) for _, _, frame in FRAMES.values()) + COMMAND_LONG + VERSION_1
    for size in (1, 2, 7, 100, len(stream)):
        decoder = MavlinkDecoder()
        found = [m.name for at in range(0, len(stream), size) for m in decoder.feed(stream[at : at + size])]
        assert found == [*FRAMES, "HIL_ACTUATOR_CONTROLS"] and decoder.damaged == 0


def test_a_damaged_byte_loses_one_message() -> None:
    frame = bytes.fromhex(FRAMES["HIL_ACTUATOR_CONTROLS"][2])
    for place in range(1, len(frame)):
        damaged = bytearray(frame)
        damaged[place] ^= 0x55
        decoder = MavlinkDecoder()
        found = list(decoder.feed(bytes(damaged) + frame * 5))
        assert 1 <= len(found) <= 5 and all(message.fields["mode"] == 129 for message in found), place


def test_random_bytes_give_no_message_and_no_growth() -> None:
    random, decoder = np.random.default_rng(7), MavlinkDecoder()
    for _ in range(200):
        assert not list(decoder.feed(random.bytes(1000)))
        assert len(decoder._waiting) < 300


def test_numbers_beyond_their_range_are_limited() -> None:
    frame = encode("HIL_GPS", {"vn": 1e9, "ve": -1e9, "eph": float("nan"), "lat": float("inf")}, 300)
    (message,) = MavlinkDecoder().feed(frame)
    assert (message.fields["vn"], message.fields["ve"], message.fields["eph"]) == (32767, -32768, 0)
    assert message.fields["lat"] == 2**31 - 1
