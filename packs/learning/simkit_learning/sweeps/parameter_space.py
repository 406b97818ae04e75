"""Spaces of the values that a sweep gives to its parameters.

A space is written as plain data, so that YAML files and Python use the same form:

    [0.2, 0.5, 1.0]                        each value (a grid)
    {"linspace": [0.0, 1.0, 5]}            five values from 0 to 1 (a grid)
    {"uniform": [0.1, 0.2]}                numbers between two bounds
    {"log_uniform": [1e-3, 1.0]}           numbers whose logarithm is uniform
    {"normal": [0.5, 0.1]}                 mean and standard deviation, optionally with "limits": [low, high]
    {"integers": [1, 6]}                   whole numbers, both bounds included
    {"choice": ["a", "b"], "weights": [3, 1]}
    {"normal": [[0, 1], [0.1, 0.2]], "correlation": [[1, 0.8], [0.8, 1]]}   several parameters together

Every random value is computed from a number between 0 and 1, so random, Sobol and Latin hypercube designs share this
code. In Python, a frozen distribution of SciPy is a space too.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import NormalDist
from typing import Final, Protocol, TypeAlias

import numpy as np

from simkit.argument_checks import shown
from simkit.diagnostics import shorten
from simkit.extend import counted, did_you_mean
from simkit.float_sum import float_sum
from simkit.linear_algebra import matmul
from simkit.matrix_decompositions import cholesky

Names: TypeAlias = tuple[str, ...]
"""Names of the parameters of a space; several for a correlated space."""
Scalar: TypeAlias = bool | int | float | str
ParameterValue: TypeAlias = Scalar | list[Scalar]
"""Value of a parameter: plain data, as in JSON."""
Values: TypeAlias = Mapping[str, ParameterValue]
"""Values of parameters by name."""
Description: TypeAlias = Mapping[object, object]
"""Description of a space, such as `{"uniform": [0.1, 0.2]}`."""
Spaces: TypeAlias = Mapping[str, object] | Mapping[Names, object] | Mapping[str | Names, object]
"""Descriptions of spaces, or lists of values, by the name of a parameter or the names of correlated ones."""
_Converter: TypeAlias = Callable[[Sequence[float]], list[ParameterValue]]

_EDGE: Final = 2.0**-54
"""Smallest distance from 0 and 1 of the numbers for an inverse distribution; at 0, a normal value is infinite."""


class _Distribution(Protocol):
    """Frozen distribution of SciPy, which has no types."""

    def ppf(self, share: float) -> float: ...


class InvalidSpace(ValueError):
    """Description of a space that has an error; the message says what was found and what is allowed."""


@dataclass(frozen=True)
class ParameterSpace:
    """Values of one parameter, or of several correlated parameters.

    Attributes:
        names: names of the parameters.
        description: plain description, which identifies the space in a stored sweep.
        levels: listed values of a grid; None for a distribution.
        convert: function from numbers between 0 and 1, one for each name, to the values; None for a grid.
    """

    names: Names
    description: object
    levels: tuple[ParameterValue, ...] | None = None
    convert: _Converter | None = None

    def values(self, unit: Sequence[float]) -> dict[str, ParameterValue]:
        """Return the values by name for numbers between 0 and 1, one for each name."""
        assert self.convert is not None
        inside = [min(max(float(number), _EDGE), 1.0 - _EDGE) for number in unit]
        return dict(zip(self.names, self.convert(inside), strict=True))


def parameter_space(names: str | Names, description: object) -> ParameterSpace:
    """Return the space that a plain description means.

    Raises:
        InvalidSpace: the description has an error.
    """
    if not isinstance(names, (str, tuple, list)):
        raise InvalidSpace(f"the name {shown(names)} is not a text")
    together = (names,) if isinstance(names, str) else tuple(names)
    if hasattr(description, "ppf"):
        return _frozen_distribution(together, description)
    if not isinstance(description, Mapping):
        if hasattr(description, "tolist"):  # an array or a number of NumPy
            description = description.tolist()
        levels = list(description) if isinstance(description, (list, tuple, range)) else [description]
        return _grid(together, levels, levels)
    kind = next((key for key in description if _plain_name(key) in _KINDS), None)
    if kind is None:
        first = next(iter(description), "")
        hint = did_you_mean(str(first), _NAMES) or f"available: {', '.join(_NAMES)}"
        raise InvalidSpace(f"found {shorten(repr(dict(description)), 60)}, which names no distribution; {hint}")
    make, further = _KINDS[_plain_name(kind)]
    unknown = [str(key) for key in description if key != kind and key not in further]
    if unknown:
        allowed = f"allowed beside it: {', '.join(further)}" if further else "it takes no further keys"
        raise InvalidSpace(f"{kind} has no key {unknown[0]!r}; {allowed}")
    if len(together) > 1 and make is not _normal:
        raise InvalidSpace(f"{kind} describes one parameter, but {len(together)} are named; write normal for these")
    return make(together, dict(description), description[kind])


def _plain_name(key: object) -> str:
    return str(key).lower().replace("_", "").replace("-", "")


def _frozen_distribution(names: Names, distribution: _Distribution) -> ParameterSpace:
    """Return the space of a frozen distribution of SciPy, which a text identifies in a stored sweep."""
    kind = getattr(getattr(distribution, "dist", None), "name", type(distribution).__name__)
    text = f"{kind}{getattr(distribution, 'args', ())}{sorted(getattr(distribution, 'kwds', {}).items())}"
    return ParameterSpace(names, text, convert=lambda u: [float(distribution.ppf(u[0]))])


def _grid(names: Names, levels: Iterable[object], description: object) -> ParameterSpace:
    plain = tuple(map(plain_value, levels))
    if not plain:
        raise InvalidSpace("the list of values is empty")
    return ParameterSpace(names, description, levels=plain)


def plain_value(value: object) -> ParameterValue:
    """Return a value of a parameter as plain data: a number, a text, true or false, or a list of these.

    Raises:
        InvalidSpace: the value is of another kind.
    """
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, tuple):
        value = list(value)
    if isinstance(value, list) and all(isinstance(item, (bool, int, float, str)) for item in value):
        return value
    if not isinstance(value, (bool, int, float, str)):
        raise InvalidSpace(
            f"found {shorten(repr(value), 60)}; expected a number, a text, true, false or a list of these"
        )
    return value


# ---------------------------------------------------------------------- kinds


def _numbers(value: object, count: int, what: str) -> list[float]:
    listed = list(value) if isinstance(value, (list, tuple)) else []
    if len(listed) != count or not all(_is_number(item) for item in listed):
        raise InvalidSpace(f"found {shorten(repr(value), 60)}; expected {what}")
    return [float(item) for item in listed]


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def _bounds(value: object, *, above: float = -math.inf) -> tuple[float, float]:
    low, high = _numbers(value, 2, "two numbers, the lower and the upper bound")
    if not above < low < high:
        limit = f" above {above:g}" if above > -math.inf else ""
        raise InvalidSpace(f"found {value!r}; expected a lower bound{limit} that is smaller than the upper bound")
    return low, high


def _listed(names: Names, description: Description, value: object) -> ParameterSpace:
    if not isinstance(value, (list, tuple)):
        raise InvalidSpace(f"found {shorten(repr(value), 60)}; expected a list of values")
    return _grid(names, value, description)


def _linspace(names: Names, description: Description, value: object) -> ParameterSpace:
    low, high, count = _numbers(value, 3, "the first number, the last number and their count")
    if count != int(count) or count < 1:
        raise InvalidSpace(f"found a count of {count:g}; expected a whole number of at least 1")
    steps = max(int(count) - 1, 1)
    return _grid(names, [low + (high - low) * step / steps for step in range(int(count))], description)


def _uniform(names: Names, description: Description, value: object) -> ParameterSpace:
    low, high = _bounds(value)
    return ParameterSpace(names, description, convert=lambda u: [low + (high - low) * u[0]])


def _log_uniform(names: Names, description: Description, value: object) -> ParameterSpace:
    low, high = _bounds(value, above=0.0)
    ratio = math.log(high / low)
    return ParameterSpace(names, description, convert=lambda u: [min(max(low * math.exp(ratio * u[0]), low), high)])


def _integers(names: Names, description: Description, value: object) -> ParameterSpace:
    low, high = _numbers(value, 2, "two whole numbers, the lower and the upper bound")
    if low != int(low) or high != int(high) or low > high:
        raise InvalidSpace(f"found {value!r}; expected two whole numbers, the lower bound first")
    count = int(high) - int(low) + 1
    return ParameterSpace(names, description, convert=lambda u: [int(low) + min(int(count * u[0]), count - 1)])


def _choice(names: Names, description: Description, value: object) -> ParameterSpace:
    items = list(value) if isinstance(value, (list, tuple)) else []
    if not items:
        raise InvalidSpace(f"found {shorten(repr(value), 60)}; expected a list of values to choose from")
    choices = [plain_value(item) for item in items]
    weights = description.get("weights", [1.0] * len(items))
    parts = _numbers(weights, len(items), f"{counted(len(items), 'weight')}, one for each value")
    if min(parts) < 0 or float_sum(parts) <= 0:
        raise InvalidSpace(f"found the weights {weights!r}; expected numbers of at least 0, not all of them 0")
    sums = [float_sum(parts[: count + 1]) / float_sum(parts) for count in range(len(parts))]

    def convert(unit: Sequence[float]) -> list[ParameterValue]:
        return [next((item for item, edge in zip(choices, sums, strict=True) if unit[0] < edge), choices[-1])]

    return ParameterSpace(names, description, convert=convert)


def _normal(names: Names, description: Description, value: object) -> ParameterSpace:
    """Return a normal distribution: of one parameter, or of several with a matrix of correlations."""
    standard = NormalDist()
    if len(names) > 1:
        return _correlated(names, description, value)
    if "correlation" in description:
        raise InvalidSpace("a correlation needs several parameters")
    mean, deviation = _numbers(value, 2, "two numbers, the mean and the standard deviation")
    if deviation <= 0:
        raise InvalidSpace(f"found a standard deviation of {deviation:g}; expected a positive number")
    below, above = 0.0, 1.0
    if "limits" in description:
        low, high = _bounds(description["limits"])
        below, above = (standard.cdf((edge - mean) / deviation) for edge in (low, high))
        if above - below < 1e-12:
            raise InvalidSpace(f"the limits {description['limits']!r} leave almost no part of the distribution")

    def convert(unit: Sequence[float]) -> list[ParameterValue]:
        inside = min(max(below + (above - below) * unit[0], _EDGE), 1.0 - _EDGE)
        return [mean + deviation * standard.inv_cdf(inside)]

    return ParameterSpace(names, description, convert=convert)


def _correlated(names: Names, description: Description, value: object) -> ParameterSpace:
    count = len(names)
    rows = list(value) if isinstance(value, (list, tuple)) else []
    if len(rows) != 2:
        raise InvalidSpace(
            f"expected two lists for {counted(count, 'parameter')}: the means and the standard deviations"
        )
    means, deviations = (_numbers(row, count, f"{count} numbers, one for each parameter") for row in rows)
    if "limits" in description:
        raise InvalidSpace("limits are possible only for one parameter")
    try:
        matrix = np.array(description.get("correlation", np.eye(count)), dtype=float)
        if matrix.shape != (count, count) or not np.array_equal(matrix, matrix.T) or not np.all(np.diag(matrix) == 1.0):
            raise ValueError
        factor = cholesky(matrix)
    except (ValueError, np.linalg.LinAlgError):
        expected = f"a symmetric, positive definite matrix of {count} × {count} numbers with 1 on its diagonal"
        raise InvalidSpace(f"found the correlation {description.get('correlation')!r}; expected {expected}") from None
    if min(deviations) <= 0:
        raise InvalidSpace(f"found the standard deviations {deviations}; expected positive numbers")
    standard = NormalDist()

    def convert(unit: Sequence[float]) -> list[ParameterValue]:
        drawn = matmul(factor, [standard.inv_cdf(number) for number in unit])
        return [
            mean + deviation * float(number) for mean, deviation, number in zip(means, deviations, drawn, strict=True)
        ]

    return ParameterSpace(names, description, convert=convert)


_Maker: TypeAlias = Callable[[Names, Description, object], ParameterSpace]
_NAMES: Final = ("grid", "linspace", "uniform", "log_uniform", "normal", "integers", "choice")
_KINDS: Final[dict[str, tuple[_Maker, tuple[str, ...]]]] = {
    "grid": (_listed, ()),
    "linspace": (_linspace, ()),
    "uniform": (_uniform, ()),
    "loguniform": (_log_uniform, ()),
    "log": (_log_uniform, ()),
    "normal": (_normal, ("limits", "correlation")),
    "integers": (_integers, ()),
    "choice": (_choice, ("weights",)),
}
