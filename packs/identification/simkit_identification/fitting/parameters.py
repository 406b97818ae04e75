"""Parameters to identify: their paths, first values, bounds and scales."""

from __future__ import annotations

import fnmatch
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

from simkit.errors import InputError
from simkit.extend import did_you_mean
from simkit.scene.override_list import SettablePath, settable_paths
from simkit.sensors.default_parameters import read_parameters
from simkit_identification.fitting.codes import INVALID_PARAMETER, UNKNOWN_PATH

if TYPE_CHECKING:
    from simkit import Simulation

Vary = str | Sequence[str] | Mapping[str, object]
"""Parameters: texts `PATH`, `PATH=START`, `PATH=LOW:HIGH` or `PATH=LOW:START:HIGH`, or values by path."""

_FORMS: Final = "PATH, PATH=START, PATH=LOW:HIGH or PATH=LOW:START:HIGH"
_EITHER_SIGN: Final = re.compile(
    r"(^|\.)(x|y|z|roll|pitch|yaw|mean|bias_mean|ixy|ixz|iyz|lower|upper|reference|spring_reference|offset|gravity)$"
)
"""Last names of values that may be negative, so that they have no logarithmic scale."""
_TIMES: Final = ("latency", "delay", "phase")
"""Last names of times that act in whole steps."""
_DEVIATIONS: Final = ("stddev", "bias_stddev", "dynamic_bias_stddev", "gaussian_noise")
"""Last names of standard deviations, which change no mean trajectory."""
_RANDOM: Final = (*_DEVIATIONS, "latency_jitter", "jitter")
_WIDE: Final = 1e3  # factor to the implicit bounds of a logarithmic scale, and bound of a linear coordinate
_SPREAD: Final = 0.5  # first guess of the error of a first value, as a logarithm or in units of the value


@dataclass(frozen=True)
class Parameter:
    """Parameter to identify. The search uses a scaled coordinate u, which is 0 at the first value.

    Attributes:
        path: path of `--set`; a pattern gives all matching values the same number.
        start: first value.
        low, high: bounds of the value; infinite for none.
        is_log: True for the scale u = ln(value / start); False for u = (value - start) / scale.
        scale: unit of u on a linear scale.
        unit: SI unit; empty if unknown.
        step: period of the simulation [s] if the value is a time that acts in whole steps, else 0.
        has_bounds: True if the user gave both bounds.
    """

    path: str
    start: float
    low: float
    high: float
    is_log: bool
    scale: float = 1.0
    unit: str = ""
    step: float = 0.0
    has_bounds: bool = False

    @property
    def is_deviation(self) -> bool:
        """True for a standard deviation of noise, which the residuals tell and no trajectory."""
        return self.path.rpartition(".")[2] in _DEVIATIONS

    @property
    def name(self) -> str:
        """Shortest part of the path that a reader understands: the last entity and the last element."""
        entity, _, element = self.path.partition(".")
        return f"{entity.rpartition('::')[2]}.{element.rpartition('.')[2]}"

    def value(self, u: float) -> float:
        """Return the value of a scaled coordinate."""
        value = self.start * math.exp(u) if self.is_log else self.start + self.scale * u
        return min(max(value, self.low), self.high)

    def coordinate(self, value: float) -> float:
        """Return the scaled coordinate of a value."""
        return math.log(value / self.start) if self.is_log else (value - self.start) / self.scale

    def limits(self) -> tuple[float, float]:
        """Return the bounds of the scaled coordinate."""
        if self.is_log:
            wide = math.log(_WIDE)
            return (
                self.coordinate(self.low) if self.low > 0 else -wide,
                self.coordinate(self.high) if math.isfinite(self.high) else wide,
            )
        return max(self.coordinate(self.low), -_WIDE), min(self.coordinate(self.high), _WIDE)

    def box(self) -> tuple[float, float]:
        """Return the part of the scaled coordinate in which the first points of a search lie."""
        low, high = self.limits()
        if self.has_bounds:
            return low, high
        return max(low, -_SPREAD), min(high, _SPREAD)


def read_parameters_to_vary(sim: Simulation, vary: Vary) -> list[Parameter]:
    """Return the parameters for a world.

    Args:
        sim: loaded world, which has the first values.
        vary: parameters as the user wrote them.

    Raises:
        InputError: SK-FIT-001 an invalid parameter; SK-FIT-002 the world has no such path. All problems together.
    """
    known = settable_paths(sim.loaded.world, sim.control.source.file_arguments, read_parameters)
    problems: list[InputError] = []
    parameters: list[Parameter] = []
    for path, text in _split(vary):
        try:
            parameters.append(_parameter(path, text, known, sim.timestep))
        except InputError as error:
            problems.append(error)
    names = [parameter.path for parameter in parameters]
    for name in sorted({name for name in names if names.count(name) > 1}):
        problems.append(InputError(INVALID_PARAMETER, f"--vary {name}: the parameter is given twice"))
    if not parameters and not problems:
        problems.append(InputError(INVALID_PARAMETER, "no parameter to vary", help="name one with --vary PATH"))
    if problems:
        raise InputError(problems[0].code, "\n".join(map(str, problems)), shows_code=False)
    return parameters


def _split(vary: Vary) -> list[tuple[str, str]]:
    """Return the path and the text of the values of each parameter."""
    if isinstance(vary, Mapping):
        return [(path, _text(value)) for path, value in vary.items()]
    pairs = []
    for text in (vary,) if isinstance(vary, str) else vary:
        path, equals, value = text.partition("=")
        if equals and not value.strip():
            raise _invalid(path.strip(), f"found no value; expected {_FORMS}")
        pairs.append((path.strip(), value.strip()))
    return pairs


def _text(value: object) -> str:
    if value is None:
        return ""
    if isinstance(value, (list, tuple)):
        return ":".join(map(str, value))
    return str(value)


def _parameter(path: str, text: str, known: Sequence[SettablePath], timestep: float) -> Parameter:
    present, unit = _present_value(path, known)
    try:
        numbers = [float(part) for part in text.split(":")] if text else []
    except ValueError:
        numbers = [math.nan]
    if len(numbers) > 3 or not all(map(math.isfinite, numbers)):
        raise _invalid(path, f"found {text!r}; expected {_FORMS}")
    low, high = (numbers[0], numbers[-1]) if len(numbers) > 1 else (-math.inf, math.inf)
    if len(numbers) > 1 and not low < high:
        raise _invalid(path, f"the lower bound {low:g} is not below the upper bound {high:g}")
    start = numbers[1] if len(numbers) == 3 else numbers[0] if len(numbers) == 1 else present
    has_bounds = len(numbers) > 1
    if start is None or (has_bounds and len(numbers) == 2 and not low < start < high):
        if not has_bounds:
            raise _invalid(path, "the world gives it no value", "write a first value: --vary PATH=START")
        start = math.sqrt(low * high) if low > 0 else 0.5 * (low + high)
    if not low <= start <= high:
        raise _invalid(path, f"the first value {start:g} is not between {low:g} and {high:g}")
    return _scaled(Parameter(path, start, low, high, False, unit=unit, has_bounds=has_bounds), timestep)


def _scaled(parameter: Parameter, timestep: float) -> Parameter:
    path, start, low, high = parameter.path, parameter.start, parameter.low, parameter.high
    last = path.rpartition(".")[2]
    if last in _TIMES:
        parameter = replace(parameter, step=timestep, low=max(low, 0.0), unit=parameter.unit or "s")
        if not parameter.has_bounds:
            parameter = replace(parameter, high=max(0.5, 4.0 * start))
        return replace(parameter, scale=max(start, 20.0 * timestep))
    if start > 0 and low >= 0 and last not in _RANDOM and not _EITHER_SIGN.search(path):
        return replace(parameter, is_log=True)
    if start > 0 and not parameter.has_bounds and not _EITHER_SIGN.search(path):
        return replace(parameter, is_log=True, low=0.0)
    if parameter.has_bounds:
        return replace(parameter, scale=0.5 * (high - low))
    if start == 0 and not parameter.is_deviation:
        raise _invalid(
            path, "its first value is 0, which has no scale", "write bounds or a first value: --vary PATH=LOW:HIGH"
        )
    return replace(parameter, scale=abs(start) or 1.0)


def _invalid(path: str, text: str, help_: str = "") -> InputError:
    return InputError(INVALID_PARAMETER, f"--vary {path}: {text}", help=help_)


def _present_value(path: str, known: Sequence[SettablePath]) -> tuple[float | None, str]:
    """Return the value in the world and its unit; None if a sensor or plugin takes its own default.

    Raises:
        InputError: SK-FIT-002 no entity has this path; SK-FIT-001 it is not one number.
    """
    for found in known:
        if _matches(path, found.path):
            try:
                return float(found.value), found.unit
            except ValueError:
                parts = " or ".join(f"{found.path}.{part}" for part in found.parts[:2])
                more = f"name one component, such as {parts}" if parts else "only numbers can be fitted"
                raise _invalid(path, f"its value {found.value!r:.60} is not one number", more) from None
        head, _, part = path.rpartition(".")
        if part in found.parts and _matches(head, found.path):
            return float(found.value.split()[found.parts.index(part)]), found.unit.split(" ")[0]
    entity = path.partition(".")[0]
    entities = {found.path.partition(".")[0] for found in known}
    if "." in path and any(fnmatch.fnmatchcase(name, entity) for name in entities):
        names = [found.path for found in known if fnmatch.fnmatchcase(found.path.partition(".")[0], entity)]
        hint = did_you_mean(path, names)
        if hint:
            raise InputError(UNKNOWN_PATH, f"--vary {path}: {entity} has no such value; {hint}")
        return None, ""  # a sensor or plugin may read an element that its file leaves out; loading it tells
    hint = did_you_mean(path, [found.path for found in known]) or "`simkit inspect WORLD --paths` lists all paths"
    raise InputError(UNKNOWN_PATH, f"--vary {path}: the world has no such path; {hint}")


def _matches(pattern: str, path: str) -> bool:
    """Check whether a path has a name; the first names of an element may be left out, as with `--set`."""
    if fnmatch.fnmatchcase(path, pattern):
        return True
    entity, _, element = pattern.partition(".")
    known_entity, _, known_element = path.partition(".")
    return bool(element) and fnmatch.fnmatchcase(known_entity, entity) and known_element.endswith("." + element)


def without_noise(sim: Simulation, varied: Iterable[str]) -> tuple[str, ...]:
    """Return overrides that take the random numbers out of a world's readings, so that its runs give their means.

    Args:
        sim: loaded world.
        varied: paths that keep their values, because they are fitted.
    """
    kept = set(varied)
    paths = settable_paths(sim.loaded.world)
    return tuple(
        f"{found.path}=0"
        for found in paths
        if found.path.rpartition(".")[2] in _RANDOM and found.path not in kept and _is_not_zero(found.value)
    )


def _is_not_zero(text: str) -> bool:
    try:
        return float(text) != 0.0
    except ValueError:
        return False
