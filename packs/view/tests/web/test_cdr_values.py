"""Values of CDR for rosbridge, and the WebSocket frames of messages."""

from __future__ import annotations

import base64
import itertools
import json
import keyword
import math
from typing import Any

import numpy as np
import pytest

from simkit import msgs
from simkit.errors import MessageError
from simkit.msgs import type_store
from simkit.msgs.definition_parser import ARRAY, BASE, NAME
from simkit.msgs.message_text import field_nodes, field_value, is_message
from simkit_view.web.cdr_values import read_values
from simkit_view.web.rosbridge_topics import _MOST_SHARED, SharedFrames

TAGS = {"u2": 69, "u4": 70, "u8": 71, "i1": 72, "i2": 77, "i4": 78, "i8": 79, "f4": 85, "f8": 86}  # RFC 8746


def example(node: Any, numbers: Any, special: float) -> Any:
    """A value of a field: small numbers that differ, with a special one in between, and texts of other lengths."""
    kind, detail = int(node[0]), node[1]
    number = next(numbers)
    if kind == NAME:
        return examples(detail, numbers, special)
    if kind == BASE and detail[0] in ("string", "wstring"):
        return 'é"\\𝄞'[: number % 5]
    if kind == BASE and detail[0].startswith("float"):
        return special if number % 3 == 0 else number / 7
    if kind == BASE:
        return bool(number % 2) if detail[0] == "bool" else number % 120
    length = detail[1] if kind == ARRAY else min(number % 4, detail[1] or 3)
    return [example(detail[0], numbers, special) for _ in range(length)]


def examples(type_name: str, numbers: Any, special: float) -> dict[str, Any]:
    """Values of all fields; a field named like a Python keyword is an argument with a trailing `_`."""
    fields = field_nodes(type_name)
    return {n + "_" * keyword.iskeyword(n): example(node, numbers, special) for n, node in fields}


def plain(value: Any, is_binary: bool) -> Any:
    """The values of a decoded message, as rosbridge sends them."""
    if is_message(value):
        names = [name for name, _ in field_nodes(value.__msgtype__)]
        return {name: plain(field_value(value, name), is_binary) for name in names}
    if isinstance(value, np.ndarray) and value.dtype == np.uint8:
        return value.tobytes() if is_binary else base64.b64encode(value.tobytes()).decode()
    if isinstance(value, np.ndarray) and is_binary and value.dtype.str[1:] in TAGS:
        return TAGS[value.dtype.str[1:]], value.tobytes()
    if isinstance(value, (list, tuple, np.ndarray)):
        return [plain(item, is_binary) for item in value]
    value = value.item() if isinstance(value, np.generic) else value
    return None if not is_binary and isinstance(value, float) and not math.isfinite(value) else value


def untagged(value: Any) -> Any:
    """Values for CBOR with tags as pairs."""
    if isinstance(value, dict):
        return {name: untagged(item) for name, item in value.items()}
    if isinstance(value, list):
        return [untagged(item) for item in value]
    return (value.tag, value.value) if hasattr(value, "tag") else value


@pytest.mark.slow
@pytest.mark.parametrize("special", [0.5, math.nan, -math.inf])
def test_the_values_of_every_type_are_those_of_the_decoded_message(special: float) -> None:
    pytest.importorskip("cbor2")
    numbers = itertools.count()
    for name in sorted(type_store().fielddefs):
        data = msgs.serialize(msgs.from_dict((name,), examples(name, numbers, special)))
        decoded = msgs.deserialize(data, name)
        assert json.dumps(read_values(data, name)) == json.dumps(plain(decoded, False)), name
        assert repr(untagged(read_values(data, name, is_binary=True))) == repr(plain(decoded, True)), name


def test_big_endian_data_have_the_same_values() -> None:
    message = msgs.from_dict(("geometry_msgs/msg/PointStamped",), {"header": {"frame_id": "a"}, "point": {"y": 2.5}})
    store, name = type_store(), "geometry_msgs/msg/PointStamped"
    big = bytes(store.serialize_cdr(message, name, little_endian=False))
    assert big[1] == 0 and read_values(big, name) == read_values(msgs.serialize(message), name)


@pytest.mark.parametrize("name", ["sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Image", "tf2_msgs/msg/TFMessage"])
def test_data_that_are_cut_or_too_long_are_an_error(name: str) -> None:
    header = {"frame_id": "laser"}
    fields = {
        "sensor_msgs/msg/LaserScan": {"header": header, "ranges": [1.0, 2.0]},
        "sensor_msgs/msg/Image": {"header": header, "data": [1, 2, 3, 4]},
        "tf2_msgs/msg/TFMessage": {"transforms": [{"header": header}]},
    }
    data = msgs.serialize(msgs.from_dict((name,), fields[name]))
    for damaged in (data[:4], data[:20], data[:-1], data + bytes(4)):
        with pytest.raises(MessageError, match=name):
            read_values(damaged, name)


def test_frames_are_those_of_websockets() -> None:
    frames = pytest.importorskip("websockets.frames")
    from simkit_view.web.web_server import binary_frame, text_frame

    for size in (0, 125, 126, 65535, 65536):
        expected = frames.Frame(frames.Opcode.BINARY, bytes(size)).serialize(mask=False)
        assert binary_frame(bytes(size // 2), bytes(size - size // 2)) == expected
    assert text_frame("é") == frames.Frame(frames.Opcode.TEXT, "é".encode()).serialize(mask=False)


def test_clients_of_the_same_form_share_a_frame_until_newer_messages_displace_it() -> None:
    frames, name = SharedFrames(), "std_msgs/msg/String"
    data = msgs.serialize(msgs.from_dict((name,), {"data": "a" * 1000}))
    first = frames.find(("none", "/a", name, 1, data))
    assert frames.find(("none", "/a", name, 1, bytes(bytearray(data)))) is first
    others = [frames.find(("none", *key, data)) for key in (("/b", name, 1), ("/a", name, 2))]
    assert all(other is not first for other in others) and b'"op": "publish", "topic": "/b"' in others[0]
    for time_ns in range(3, 3 + _MOST_SHARED // len(first)):
        frames.find(("none", "/a", name, time_ns, data))
    again = frames.find(("none", "/a", name, 1, data))
    assert again == first and again is not first
