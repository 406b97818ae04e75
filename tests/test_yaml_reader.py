"""Whatever somebody writes as YAML is read, or told why not."""

from __future__ import annotations

import pytest

from simkit.yaml_reader import NotYaml, finite_number, read_yaml


@pytest.mark.parametrize(
    ("text", "value"), [("1e-3", 0.001), ("-1E6", -1e6), (".5e1", 5.0), ("1.e2", 100.0), ("+2e+0", 2.0), ("1.5", 1.5)]
)
def test_a_number_with_an_exponent_is_a_number(text: str, value: float) -> None:
    assert read_yaml(f"{{x: {text}, y: [{text}]}}") == {"x": value, "y": [value]}


@pytest.mark.parametrize("text", ["e3", "1e", "1e3x", "'1e3'", "v1e3"])
def test_a_text_that_is_not_a_number_stays_a_text(text: str) -> None:
    assert read_yaml(text) == text.strip("'")


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("{x: 2024-13-45}", "a value does not fit its type"),
        ("!!timestamp foo", "a value does not fit its type"),
        ("!!bool foo", "a value does not fit its type"),
        ("!!int foo", "a value does not fit its type"),
        ("!!int ''", "a value does not fit its type"),
        ("!!float foo", "a value does not fit its type"),
        ("9" * 5000, "1000 digits"),
        ("&a {x: *a}", "nested too deep"),
        ("&a [*a]", "nested too deep"),
        ("[" * 3000, "nested too deep"),
        ("[" * 150 + "]" * 150, "nested too deep"),
        ("{x: [}", "expected the node content"),
        ("!!python/name:os.system x", "could not determine a constructor"),
        ("\0", "special characters are not allowed"),
    ],
)
def test_an_invalid_text_is_reported_with_a_short_reason(text: str, why: str) -> None:
    with pytest.raises(NotYaml, match=why):
        read_yaml(text)


def test_a_short_text_that_expands_too_much_is_refused() -> None:
    text = "a0: &a0 [1, 1]\n" + "".join(f"a{i}: &a{i} [*a{i - 1}, *a{i - 1}]\n" for i in range(1, 40))
    with pytest.raises(NotYaml, match="expands to more than"):
        read_yaml(text)


def test_a_text_that_expands_too_much_by_merging_is_refused() -> None:
    base = "".join(f"  k{i}: {i}\n" for i in range(1000))
    text = f"base: &base\n{base}" + "".join(f"a{i}: {{<<: *base}}\n" for i in range(1200))
    with pytest.raises(NotYaml, match="expands to more than") as caught:
        read_yaml(text)
    assert caught.value.line is not None


@pytest.mark.parametrize("text", ["12:30", "-1:30:00", "1:30.5"])
def test_a_time_of_day_is_a_text(text: str) -> None:
    assert read_yaml(f"x: {text}") == {"x": text}


@pytest.mark.parametrize("value", [10**400, -(10**400), float("nan"), float("inf"), True, "1", None, [1]])
def test_finite_number_returns_none_for_other_values(value: object) -> None:
    assert finite_number(value) is None and finite_number(10**20) == 1e20


@pytest.mark.parametrize("digits", ["0x" + "f" * 5000, "9" * 5000, "0b" + "1" * 1500], ids=["hex", "decimal", "binary"])
def test_an_integer_with_more_digits_than_a_message_can_show_is_not_yaml(digits: str) -> None:
    with pytest.raises(NotYaml, match="an integer has more than 1000 digits") as raised:
        read_yaml(f"a: 1\nworld: {digits}\n")
    assert raised.value.line == 2
