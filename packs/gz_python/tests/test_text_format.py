"""Protobuf's text form, and matching of messages by it."""

from __future__ import annotations

from typing import Any

import pytest

from simkit.errors import MessageError
from simkit_gz_python.msgs import message_class
from simkit_gz_python.msgs.message_matcher import MessageMatcher
from simkit_gz_python.msgs.text_format import parse_message, parse_value


def made(name: str, text: str) -> Any:
    return parse_message(message_class(name), text)


@pytest.mark.parametrize(
    "text",
    [
        "linear: {x: 3 y: -0.5}, angular { z: 1e-1 }",
        "linear < x: 3; y: -.5 > angular: <z: 0.1f>",
        "linear {x:3.0,y:-0.5,}  # a comment\nangular{z:.1}",
    ],
)
def test_every_spelling_of_a_message(text: str) -> None:
    twist = made("Twist", text)
    assert (twist.linear.x, twist.linear.y, twist.angular.z) == (3.0, -0.5, 0.1)


def test_texts_truths_enumerations_and_lists() -> None:
    entity = made("Entity", """name: 'a"b' "\\n\\x41\\101" type: MODEL id: 0x10""")
    assert (entity.name, entity.type, entity.id) == ('a"b\nAA', 2, 16)
    assert list(made("Float_V", "data: [1, 2] data: 3 data: inf").data) == [1.0, 2.0, 3.0, float("inf")]
    assert made("Boolean", "data: True").data is True
    assert made("Empty", "") == made("Empty", "unused: false")
    assert parse_value("f", " -2.5 ") == -2.5
    assert parse_value("Vector3d", "{x: 1}").x == 1.0


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("Twist", "linaer: {x: 1}", "did you mean 'linear'"),
        ("Twist", "linear: {x: 1", "ends before the message is complete"),
        ("Twist", "linear: 1", "expected {"),
        ("Twist", "linear {x 1}", "without a colon"),
        ("Twist", "linear {x: one}", "expected a number"),
        ("Int32", "data: 1.5", "whole number"),
        ("Boolean", "data: yes", "true or false"),
        ("StringMsg", "data: hello", "in quotes"),
        ("Entity", "type: ROBOT", "MODEL"),
        ("Float_V", "data: [1 2]", "comma"),
        ("Twist", "linear: {x: 1} ?", "not valid in a message"),
        ("Header", "stamp {sec: 3} data {key: 3}", "in quotes"),
    ],
)
def test_an_invalid_text_is_an_error(name: str, text: str, said: str) -> None:
    with pytest.raises(MessageError, match=said):
        made(name, text)


def test_deep_nesting_is_rejected() -> None:
    with pytest.raises(MessageError):
        made("WorldControl", "reset {" * 5000)


def met(name: str, text: str, message: str, *args: Any, **named: Any) -> bool:
    return MessageMatcher(message_class(name), text, *args, **named).meets(made(name, message))


def test_a_whole_message_has_to_be_the_same() -> None:
    assert met("Boolean", "data: true", "data: true")
    assert not met("Twist", "linear: {x: 1}", "linear: {x: 1 y: 0.1}")
    assert met("Float_V", "data: [1, 2]", "data: [1, 2]")
    assert not met("Float_V", "data: [1, 2]", "data: [2, 1]")


def test_of_a_repeated_field_the_values_have_to_be_among_those_of_the_message() -> None:
    assert met("Int32_V", "2", "data: [1, 2, 3]", "data")
    assert met("Int32_V", "[3, 1]", "data: [1, 2, 3]", "data")
    assert not met("Int32_V", "4", "data: [1, 2, 3]", "data")
    header = 'header { data {key: "state" value: "1"} data {key: "count" value: "2"} }'
    assert met("Pose", '{key: "count"}', header, "header.data")
    assert not met("Pose", '{key: "state" value: "0"}', header, "header.data")


def test_numbers_may_differ_by_the_tolerance() -> None:
    assert met("Altimeter", "-7.5", "vertical_position: -7.69", "vertical_position", 0.2)
    assert not met("Altimeter", "-7.5", "vertical_position: -7.71", "vertical_position", 0.2)
    assert met("Altimeter", "1", "vertical_position: 1.000000009", "vertical_position")
    assert not met("Altimeter", "1", "vertical_position: 1.00000002", "vertical_position")
    assert not met("Altimeter", "nan", "vertical_position: nan", "vertical_position")
    assert met("Float", "0.1", "data: 0.10000000149011612", "data", 0.0), "in single precision it is 0.1"


def test_a_negative_match_accepts_all_other_messages() -> None:
    assert met("Int32", "data: 1", "data: 2", is_positive=False)
    assert not met("Int32", "data: 1", "data: 1", is_positive=False)


@pytest.mark.parametrize(
    ("name", "field", "said"),
    [
        ("Twist", "linear.w", "no field 'w'"),
        ("Contacts", "contact.depth", "is repeated"),
        ("Double", "data.x", "plain value"),
    ],
)
def test_an_invalid_path_is_an_error(name: str, field: str, said: str) -> None:
    with pytest.raises(MessageError, match=said):
        MessageMatcher(message_class(name), "1", field)
