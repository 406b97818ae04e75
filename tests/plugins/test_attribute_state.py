"""Restored attributes of plugins: copies, shared objects and deleted names."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from simkit.plugins.attribute_state import copy_attributes, restore_attributes


@dataclass(frozen=True)
class Setting:
    values: Any


@dataclass
class Counter:
    count: int = 0


class Owner:
    """Object with attributes of all kinds."""

    def __init__(self) -> None:
        self.number, self.text = 1.5, "a"
        self.setting, self.open_setting = Setting((1, 2)), Setting([1, 2])
        self.rows = [1, 2]
        self.same_rows = self.rows
        self.names = {"x": 1.0}
        self.holder = {"names": self.names}
        self.matrix = np.asfortranarray(np.arange(6.0).reshape(2, 3))
        self.objects = np.array([[1]], dtype=object)
        self.counters = [Counter(1)]
        self.itself = [self]


def fail(name: str, error: Exception) -> None:
    raise AssertionError(name) from error


def test_every_restore_gives_new_copies_that_share_what_was_shared() -> None:
    owner = Owner()
    state = copy_attributes(owner, (), fail)
    for _ in range(3):
        owner.rows.append(3)
        owner.names["y"] = 2.0
        owner.matrix[0, 0] = 9.0
        owner.counters[0].count = 7
        owner.open_setting.values.append(3)
        owner.later = 1  # type: ignore[attr-defined]
        restore_attributes(owner, (), state)
        assert owner.rows == [1, 2] and owner.same_rows is owner.rows
        assert owner.names == {"x": 1.0} and owner.holder["names"] is owner.names
        assert owner.matrix.tolist() == [[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]] and owner.matrix.flags.f_contiguous
        assert owner.counters == [Counter(1)] and owner.open_setting.values == [1, 2]
        assert owner.setting.values == (1, 2) and owner.itself[0] is owner
        assert not hasattr(owner, "later")


def test_attributes_that_are_left_out_stay() -> None:
    owner = Owner()
    state = copy_attributes(owner, ("rows", "same_rows"), fail)
    owner.rows = [5]
    for _ in range(2):
        restore_attributes(owner, ("rows", "same_rows"), state)
        assert owner.rows == [5] and owner.number == 1.5
    restore_attributes(owner, ("rows",), {"number": 2.0, "names": {"z": 0.0}})  # a state of another process
    assert sorted(vars(owner)) == ["names", "number", "rows"] and owner.number == 2.0
