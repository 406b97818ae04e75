"""How a field is compared, and its values in a row."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from simkit.golden.difference import Difference
from simkit.golden.record import Array, Column, Stream
from simkit.golden.tolerances import Allowed
from simkit.scenario import Tolerance


@dataclass(frozen=True)
class Terms:
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
        return "the same bits" if self.is_exact else str(Allowed(self.tolerance, self.unit))

    def time(self, index: int) -> float:
        """Of a message [s]."""
        return float(self.stream.times_ns[index]) * 1e-9


@dataclass(frozen=True)
class Found:
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
class Flat:
    """All values of a column one after the other, and which message each belongs to."""

    values: Array
    messages: npt.NDArray[np.intp]
    widths: npt.NDArray[np.int64]

    @staticmethod
    def of(column: Column, count: int) -> Flat:
        """Those of the first messages of a column."""
        if column.lengths is None:
            table = column.values[:count].reshape(count, -1) if count else np.zeros((0, 1))
            widths = np.full(count, table.shape[1], np.int64)
            return Flat(table.reshape(-1), np.repeat(np.arange(count), widths), widths)
        widths = np.asarray(column.lengths[:count], np.int64)
        return Flat(column.values[: int(widths.sum())], np.repeat(np.arange(count), widths), widths)

    def first(self, count: int) -> Flat:
        """Those of the first messages."""
        end = int(self.widths[:count].sum())
        return Flat(self.values[:end], self.messages[:end], self.widths[:count])
