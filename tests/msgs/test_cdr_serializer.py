"""Serialisers generated from the definitions: the bytes of rosbags for every type, and refused values."""

from __future__ import annotations

import random
from typing import Any

import numpy as np
import pytest

from simkit import msgs
from simkit.errors import MessageError
from simkit.msgs.definition_parser import ARRAY, BASE, NAME
from simkit.msgs.message_types import message_type_names, type_store

DTYPES = {"byte": "uint8", "char": "uint8"}


def random_number(name: str, source: random.Random) -> Any:
    if name in ("string", "wstring"):
        return "".join(source.choice("aß€_/") for _ in range(source.randrange(12)))
    if name == "bool":
        return source.random() < 0.5
    if name.startswith("float"):
        return source.gauss(0.0, 1e3)
    limits = np.iinfo({"byte": "int8", "char": "uint8"}.get(name, name))  # a single byte is signed in rosbags
    return source.randint(int(limits.min), int(limits.max))


def random_value(node: Any, source: random.Random) -> Any:
    kind, content = int(node[0]), node[1]
    if kind == NAME:
        return random_message(content, source)
    if kind == BASE:
        return random_number(content[0], source)
    (inner_kind, inner), length = content
    count = length if kind == ARRAY else source.choice((0, 0, 1, 2, 3, 5))
    if int(inner_kind) != BASE or inner[0] in ("string", "wstring"):
        return [random_value((inner_kind, inner), source) for _ in range(count)]
    if inner[0] == "bool":
        return np.array([source.random() < 0.5 for _ in range(count)], dtype=bool)
    dtype = np.dtype(DTYPES.get(inner[0], inner[0]))
    return np.frombuffer(source.randbytes(count * dtype.itemsize), dtype)


def random_message(name: str, source: random.Random) -> Any:
    store = type_store()
    return store.types[name](*[random_value(node, source) for _, node in store.fielddefs[name][1]])


@pytest.mark.slow
def test_every_type_has_the_bytes_of_rosbags_for_random_values() -> None:
    source, store, names = random.Random(1), type_store(), message_type_names()
    for name in names:
        for _ in range(6):
            message = random_message(name, source)
            assert msgs.serialize(message) == bytes(store.serialize_cdr(message, name, little_endian=True)), name
    assert len(names) > 350


def test_a_large_array_is_written_from_any_memory_layout() -> None:
    every_second = np.arange(20_000, dtype=np.float32)[::2]
    scan = msgs.make("sensor_msgs/msg/LaserScan", ranges=every_second)
    assert np.array_equal(msgs.deserialize(msgs.serialize(scan), "sensor_msgs/msg/LaserScan").ranges, every_second)


PYTHONS_OWN = r"\S"
"""Pattern for the text of a Python error, which is another one in other versions of Python."""


@pytest.mark.parametrize(
    ("name", "field", "value", "reason"),
    [
        ("sensor_msgs/msg/Imu", "orientation_covariance", np.zeros(8), "found 8 elements of 64 bytes; expected 9"),
        ("sensor_msgs/msg/LaserScan", "ranges", np.zeros(4), "found 4 elements of 32 bytes; expected 4 of 16 bytes"),
        ("sensor_msgs/msg/LaserScan", "ranges", [1.0], PYTHONS_OWN),
        ("sensor_msgs/msg/JointState", "name", [1], PYTHONS_OWN),
        ("sensor_msgs/msg/JointState", "name", [["a"]], PYTHONS_OWN),
        ("std_msgs/msg/Float64", "data", "fast", PYTHONS_OWN),
        ("std_msgs/msg/UInt8", "data", 256, PYTHONS_OWN),
        ("std_msgs/msg/String", "data", None, PYTHONS_OWN),
        ("tf2_msgs/msg/TFMessage", "transforms", [3], PYTHONS_OWN),
        ("geometry_msgs/msg/Polygon", "points", None, PYTHONS_OWN),
    ],
)
def test_a_value_that_does_not_match_its_field_is_an_error(name: str, field: str, value: object, reason: str) -> None:
    message = msgs.make(name)
    setattr(message, field, value)
    with pytest.raises(MessageError, match=f"^{name} cannot be serialised: .*{reason}"):
        msgs.serialize(message)


def test_texts_of_ever_new_lengths_need_a_bounded_memory() -> None:
    for length in range(600):
        text = msgs.make("std_msgs/msg/String", data="x" * length)
        assert msgs.deserialize(msgs.serialize(text), "std_msgs/msg/String").data == "x" * length
        names = msgs.make("sensor_msgs/msg/JointState", name=[f"joint_{length}", "x" * length])
        assert msgs.deserialize(msgs.serialize(names), "sensor_msgs/msg/JointState").name == names.name
    from simkit.msgs.cdr_serializer import _MOST_LAYOUTS, _TEXT_BLOCKS

    assert len(_TEXT_BLOCKS) <= _MOST_LAYOUTS
