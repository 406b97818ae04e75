"""Hashes of plugin attributes depend only on their values."""

from __future__ import annotations

import os
import subprocess
import sys
from collections import deque
from pathlib import Path

import numpy as np
import pytest

from simkit_verification.testing.certify.run_hashes import short_value_text, value_hash

ROOT = Path(__file__).resolve().parents[4]


class Thing:
    def __init__(self, value: object) -> None:
        self.value = value


class Slotted:
    __slots__ = ("value",)

    def __init__(self, value: object) -> None:
        self.value = value


def test_equal_values_have_equal_hashes_and_others_have_not() -> None:
    values = [
        *(None, 0, 1, 1.0, -0.0, 0.0, float("nan"), "a", b"a", (1, 2), [1, 2], {"a": 1}, {1, 2}, deque([1])),
        *(np.array([1.0, 2.0]), np.array([[1.0, 2.0]]), np.array([1.0, 2.0], np.float32), np.float64(3.0)),
        *(Thing(1), Thing(2), Thing([1]), Slotted(1), Slotted(2), np.random.default_rng(1), np.random.default_rng(2)),
    ]
    hashes = [value_hash(value) for value in values]
    assert len(set(hashes)) == len(values)
    assert value_hash(Thing([1, {"a": np.arange(3)}])) == value_hash(Thing([1, {"a": np.arange(3)}]))


def test_an_object_that_contains_itself_has_a_hash() -> None:
    thing = Thing(None)
    thing.value = [thing]
    assert value_hash(thing) == value_hash(thing)


@pytest.mark.slow
def test_hashes_do_not_depend_on_set_order_or_hash_seed() -> None:
    script = "from simkit_verification.testing.certify.run_hashes import value_hash as digest\n"
    script += "print(digest({'x': {'alpha', 'beta', 'gamma'}, 'y': object()}))"
    answers = {
        subprocess.run(
            [sys.executable, "-c", script],
            env={**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(ROOT)},
            capture_output=True,
            check=True,
        ).stdout
        for seed in ("0", "1")
    }
    assert len(answers) == 1
    assert value_hash({"a": 1, "b": 2}) == value_hash({"b": 2, "a": 1})


def test_only_short_values_are_shown() -> None:
    assert (
        short_value_text(0.25) == "0.25"
        and short_value_text((1, 2.5)) == "(1, 2.5)"
        and short_value_text(np.arange(3)) == "(0, 1, 2)"
    )
    assert (
        short_value_text(np.arange(100)) == ""
        and short_value_text(object()) == ""
        and len(short_value_text("x" * 100)) == 60
    )
