"""Histogram from which an artefact draws: values and weights of an element or of a CSV file beside the world."""

from __future__ import annotations

import bisect
from collections.abc import Sequence
from itertools import accumulate
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit.input_file import read_failure, read_input_text
from simkit.number_text import parse_number

if TYPE_CHECKING:
    from simkit import Params
    from simkit.extend import SpecBuilder

CODE: Final = "SK-SENSOR-245"


class Histogram:
    """Discrete distribution of values.

    Args:
        values: values, in any order.
        weights: weight of each value; their sum is above 0.
        width: width of a bin, over which each value is spread evenly; 0 for exact values.
    """

    def __init__(self, values: Sequence[float], weights: Sequence[float], width: float = 0.0) -> None:
        self.values, self.width = tuple(values), width
        self._sums = tuple(accumulate(weights))

    def value(self, share: float, place: float = 0.0) -> float:
        """Return the value at a share of the total weight, from 0 to 1.

        Args:
            share: share of the weight.
            place: place in the bin, from -1 to 1.
        """
        row = bisect.bisect_right(self._sums, share * self._sums[-1])
        return self.values[min(row, len(self.values) - 1)] + 0.5 * self.width * place


class HistogramReader:
    """Reader of the elements `values` and `weights`, or `file`, of an artefact.

    Args:
        params: element of the artefact.
        column: name of the first column of the file: `seconds` or `frames`. The second column is `weight`.
        minimum, maximum: least and greatest value.
        is_whole: True if the values are whole numbers.
    """

    def __init__(self, params: Params, column: str, minimum: float, maximum: float, is_whole: bool = False) -> None:
        self._params, self._column, self._is_whole = params, column, is_whole
        self._bounds = minimum, maximum
        self._uri = params.text("file", "")
        self.histogram: Histogram | None = None
        self.is_given = bool(self._uri) or params.has("values")
        self.width = 0.0 if is_whole else params.number("bin_width", 0.0, minimum=0.0, maximum=maximum)
        if self._uri and params.has("values"):
            params.block("file").error(CODE, "found <file> and <values>", "remove one of the two")
        elif params.has("values"):
            self._read_elements()
        else:
            params.child("weights")

    def _read_elements(self) -> None:
        values, weights = self._params.block("values"), self._params.child("weights")
        rows = values.value.split()
        shares = weights.value.split() if weights is not None else ["1"] * len(rows)
        if len(rows) != len(shares):
            values.error(CODE, f"found {len(rows)} <values> and {len(shares)} <weights>; expected as many", "")
            return
        try:
            self._set([self._row(*row) for row in zip(rows, shares, strict=True)])
        except ValueError as error:
            values.error(CODE, f"the histogram has {error}", self._allowed())

    def find(self, builder: SpecBuilder) -> None:
        """Read the file, if the element names one."""
        if not self._uri or self.histogram is not None:
            return
        element = self._params.block("file")
        folder = Path(element.where.file).resolve().parent if element.where.file else None
        try:
            path = builder.find_file(self._uri, folder)
            if path is None or not path.is_file():
                element.error(CODE, f"there is no file {self._uri!r}", "write a path relative to the world's file")
                return
            builder.files_read.append(path)
            self._set(self._rows(read_input_text(path, inside=path.parent)))
        except (OSError, UnicodeDecodeError) as error:
            element.error(CODE, f"{self._uri!r} cannot be read: {read_failure(error)}")
        except ValueError as error:
            element.error(CODE, f"{self._uri!r}: {error}", self._allowed())

    def _rows(self, text: str) -> list[tuple[float, float]]:
        """Return the values and weights of a CSV file; empty lines and those that begin with `#` are left out."""
        lines = [(number, line.strip()) for number, line in enumerate(text.removeprefix("\ufeff").splitlines(), 1)]
        lines = [(number, line) for number, line in lines if line and not line.startswith("#")]
        header = f"{self._column},weight"
        if not lines or lines[0][1].replace(" ", "") != header:
            raise ValueError(f"expected the first line {header!r}")
        rows = []
        for number, line in lines[1:]:
            try:
                value, weight = line.split(",")
                rows.append(self._row(value, weight))
            except ValueError:
                raise ValueError(f"line {number}: found {line!r}") from None
        return rows

    def _row(self, value: str, weight: str) -> tuple[float, float]:
        try:
            number, share = (
                parse_number(value.strip(), *self._bounds, True),
                parse_number(weight.strip(), 0, 1e15, True),
            )
        except ValueError:
            raise ValueError(f"the value {value!r} with the weight {weight!r}") from None
        if self._is_whole and number != int(number):
            raise ValueError(f"the value {value!r}")
        return number, share

    def _set(self, rows: Sequence[tuple[float, float]]) -> None:
        kept = [(value, weight) for value, weight in rows if weight > 0]
        if not kept:
            raise ValueError("no weight above 0")
        self.histogram = Histogram([value for value, _ in kept], [weight for _, weight in kept], self.width)

    def _allowed(self) -> str:
        low, high = self._bounds
        kind = "whole numbers" if self._is_whole else "numbers"
        return f"write {kind} from {low:g} to {high:g} with weights of at least 0; columns {self._column},weight"
