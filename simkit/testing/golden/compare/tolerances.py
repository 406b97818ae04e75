"""How far readings may be from the reference run on another machine, and how one field is compared."""

from __future__ import annotations

import math
import re
import tomllib
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.run_spec import RunSpec, Tolerance
from simkit.testing.golden.compare.difference import Difference
from simkit.testing.golden.compare.units import is_colour, plain_path, quantity_text, unit_of
from simkit.testing.run_record.record import Array, Column, Stream

_STEPS_PER_TOLERANCE = 8  # of a tolerance that a stored number is rounded to

_TABLES: Final = tomllib.loads(Path(__file__).with_name("default_tolerances.toml").read_text(encoding="utf-8"))
IMAGE: Final = 2.0
"""Mean difference of a picture's values that is allowed, 0 to 255."""
SSIM: Final = 0.98
"""Least structural similarity."""


@cache
def default_tolerance(type_name: str, field: str) -> Tolerance:
    """What is allowed where a scenario says nothing: every number is given.

    Args:
        type_name: the message's ROS type.
        field: path of the field within it.
    """
    path, by_unit = plain_path(field), _TABLES["by_unit"]
    absolute, relative = by_unit.get(unit_of(type_name, field), by_unit[""])
    share = 0.0
    for of_type, of_field, *numbers in _TABLES["by_field"]:
        if re.fullmatch(of_type, type_name) and re.fullmatch(of_field, path):
            absolute, relative, share = numbers
            break
    return Tolerance(field, absolute=absolute, relative=relative, share=share, image=IMAGE, ssim=SSIM, statistics=False)


def tolerance_of(scenario: RunSpec, topic: str, type_name: str, field: str) -> Tolerance:
    """What a scenario allows a field of a topic: of each number the first tolerance that names it, or the default.

    A scenario that gives an absolute tolerance means that alone: no relative one is added, and the other way round.
    """
    found = default_tolerance(type_name, field)
    said = scenario.tolerance(topic, field)
    if not said:
        return found
    first = said[0]
    for name in ("share", "image", "ssim", "statistics"):
        value = next((getattr(t, name) for t in said if getattr(t, name) is not None), getattr(found, name))
        first = replace(first, **{name: value})
    sizes = next((t for t in said if t.absolute is not None or t.relative is not None), None)
    if sizes is None:
        return replace(first, absolute=found.absolute, relative=found.relative)
    return replace(first, absolute=sizes.absolute or 0.0, relative=sizes.relative or 0.0)


def storage_step(type_name: str, field: str, scenario: RunSpec | None = None, topic: str = "") -> float:
    """What numbers of a field are rounded to in a golden: a power of two; 0 where they are kept exactly.

    Args:
        type_name: the message's ROS type.
        field: path of the field within it.
        scenario: whose tolerances count; None for the defaults.
        topic: of the message, which the scenario's tolerances are by.
    """
    found = tolerance_of(scenario, topic, type_name, field) if scenario else default_tolerance(type_name, field)
    if found.exact or not found.absolute or is_colour(field):
        return 0.0
    return math.ldexp(1.0, math.floor(math.log2(found.absolute / _STEPS_PER_TOLERANCE)))


def allowed_text(tolerance: Tolerance, unit: str) -> str:
    """Describe what a tolerance allows."""
    parts = []
    if tolerance.absolute:
        parts.append(quantity_text(tolerance.absolute, unit, signed=False))
    if tolerance.relative:
        parts.append(f"{100.0 * tolerance.relative:g} % of the value")
    words = " + ".join(parts) or "nothing"
    return words + (f", {100.0 * tolerance.share:g} % of a message further off" if tolerance.share else "")


@dataclass(frozen=True)
class FieldTerms:
    """How one field of a topic is compared.

    Attributes:
        stream: the run's.
        field: path of the field.
        tolerance: with every number given.
        is_exact: whether bits must be equal.
        count: how many messages are compared, from the first on.
        unit: SI.
    """

    stream: Stream
    field: str
    tolerance: Tolerance
    is_exact: bool
    count: int
    unit: str

    @property
    def name(self) -> str:
        """Topic and field."""
        return f"{self.stream.topic}.{self.field}" if self.field else self.stream.topic

    @property
    def allowed(self) -> str:
        """In words."""
        return "the same bits" if self.is_exact else allowed_text(self.tolerance, self.unit)

    def time(self, index: int) -> float:
        """Of a message [s]."""
        return float(self.stream.times_ns[index]) * 1e-9


@dataclass(frozen=True)
class FieldFinding:
    """What comparing a field gave.

    Attributes:
        difference: None where nothing is further off than allowed.
        excess: how many times what is allowed the largest difference is; up to 1 for a pass, inf where nothing is.
        off: the largest difference of all values that rounding does not explain, in the field's unit.
    """

    difference: Difference | None
    excess: float = 0.0
    off: float = 0.0


@dataclass(frozen=True)
class FlatValues:
    """All values of a column one after the other, and which message each belongs to."""

    values: Array
    messages: npt.NDArray[np.intp]
    widths: npt.NDArray[np.int64]

    @staticmethod
    def of(column: Column, count: int) -> FlatValues:
        """Those of the first messages of a column."""
        if column.lengths is None:
            table = column.values[:count].reshape(count, -1) if count else np.zeros((0, 1))
            widths = np.full(count, table.shape[1], np.int64)
            return FlatValues(table.reshape(-1), np.repeat(np.arange(count), widths), widths)
        widths = np.asarray(column.lengths[:count], np.int64)
        return FlatValues(column.values[: int(widths.sum())], np.repeat(np.arange(count), widths), widths)

    def first(self, count: int) -> FlatValues:
        """Those of the first messages."""
        end = int(self.widths[:count].sum())
        return FlatValues(self.values[:end], self.messages[:end], self.widths[:count])
