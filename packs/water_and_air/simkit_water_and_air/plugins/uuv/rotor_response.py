"""Response of a thruster or fin to its command, and thrust of a thruster, as in uuv_simulator.

They are the blocks `<dynamics>` and `<conversion>`. Types, parameters and equations are those of `Dynamics.cc` and
`ThrusterConversionFcn.cc`. They follow D. R. Yoerger, J. G. Cooke and J.-J. E. Slotine (1990) and W. M. Bessa, M. S.
Dutra and E. Kreuzer (2006).
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from simkit.number_text import number_or_nan

if TYPE_CHECKING:
    from simkit import Params

_MOST: Final = 1e12
Response = Callable[[float, float, float], float]
"""Function from the state, the command and a time step [s] to the next state."""
_RESPONSES: Final[dict[str, tuple[str, ...]]] = {
    "ZeroOrder": (),
    "FirstOrder": ("timeConstant",),
    "Yoerger": ("alpha", "beta"),
    "Bessa": ("Jmsp", "Kv1", "Kv2", "Kt", "Rm"),
}
_CONVERSIONS: Final[dict[str, tuple[str, ...]]] = {
    "Basic": ("rotorConstant",),
    "Bessa": ("rotorConstantL", "rotorConstantR", "deltaL", "deltaR"),
    "LinearInterp": (),
}
_POSITIVE: Final = ("timeConstant", "Jmsp", "Rm")


class RotorResponse:
    """First-order model of a rotor or fin.

    Args:
        kind: type in the file.
        values: parameters in the order of the file's elements.

    Attributes:
        state: speed of the rotor [rad/s], or angle of the fin [rad].
    """

    def __init__(self, kind: str, values: tuple[float, ...]) -> None:
        self._kind, self._values, self.state = kind, values, 0.0

    def update(self, command: float, step: float) -> float:
        """Return the state after a time step [s] with a command."""
        state, values = self.state, self._values
        if self._kind == "FirstOrder":
            left = math.exp(-step / values[0])
            state = left * state + (1.0 - left) * command
        elif self._kind == "Yoerger":
            state += step * (values[1] * command - values[0] * state * abs(state))
        elif self._kind == "Bessa":
            inertia, linear, quadratic, factor, resistance = values
            state += step * (command * factor / resistance - linear * state - quadratic * state * abs(state)) / inertia
        else:
            state = command
        self.state = max(-_MOST, min(_MOST, state))
        return self.state


class ThrustCurve:
    """Thrust [N] as a function of the rotor's state.

    Attributes:
        kind: type in the file.
        values: parameters by the names that the service `get_thruster_conversion_fcn` has for them.
        table: pairs of state and thrust, by increasing state.
    """

    def __init__(self, kind: str, values: dict[str, float], table: tuple[tuple[float, float], ...] = ()) -> None:
        self.kind, self.values, self.table = kind, values, table
        self._states = [state for state, _ in table]

    def thrust(self, state: float) -> float:
        """Return the thrust [N]."""
        square = state * abs(state)
        if self.kind == "Basic":
            return self.values["rotor_constant"] * square
        if self.kind == "Bessa":
            left, right, low, high = self.values.values()
            if square <= low:
                return left * (square - low)
            return right * (square - high) if square >= high else 0.0
        place = bisect_left(self._states, state)
        if place in (0, len(self.table)):
            return self.table[min(place, len(self.table) - 1)][1]
        (x0, y0), (x1, y1) = self.table[place - 1], self.table[place]
        return (y0 * (x1 - state) + y1 * (state - x0)) / (x1 - x0)


def read_response(params: Params) -> RotorResponse:
    """Read the `<dynamics>` of a plugin; without it, the state is the command."""
    kind, values = _read(params, "dynamics", _RESPONSES, "ZeroOrder")
    return RotorResponse(kind, values)


def read_thrust_curve(params: Params) -> ThrustCurve:
    """Read the `<conversion>` of a thruster."""
    kind, values = _read(params, "conversion", _CONVERSIONS, "Basic")
    if kind == "LinearInterp":
        block = params.block("conversion")
        return ThrustCurve(kind, {}, _read_table(block))
    tags = ("rotor_constant",) if kind == "Basic" else ("rotor_constant_l", "rotor_constant_r", "delta_l", "delta_r")
    return ThrustCurve(kind, dict(zip(tags, values, strict=True)))


def _read(
    params: Params, element: str, allowed: dict[str, tuple[str, ...]], default: str
) -> tuple[str, tuple[float, ...]]:
    block = params.child(element)
    if block is None:
        params.error("SK-PARAM-001", f"found no <{element}>; expected a block with a <type>")
        block = params.block(element)
        return default, (0.0,) * len(allowed[default])
    kind = block.choice("type", tuple(allowed), required=True)
    names = allowed.get(kind, ())
    values = tuple(
        block.number(name, 0.0, required=True, minimum=1e-12 if name in _POSITIVE else -_MOST, maximum=_MOST)
        for name in names
    )
    if len(values) == len(names) and kind in allowed:
        return kind, values
    return default, (0.0,) * len(allowed[default])


def _read_table(block: Params) -> tuple[tuple[float, float], ...]:
    columns: list[list[float]] = []
    for name in ("inputValues", "outputValues"):
        written = block.text(name, required=True)
        column = [number_or_nan(word) for word in written.split()]
        if not all(abs(value) <= _MOST for value in column):
            block.error("SK-PARAM-002", f"found <{name}>{written}</{name}>; expected numbers")
            return ((0.0, 0.0),)
        columns.append(column)
    states, thrusts = columns
    if not states or len(states) != len(thrusts):
        message = f"found {len(states)} <inputValues> and {len(thrusts)} <outputValues>; expected as many, one or more"
        block.error("SK-PARAM-002", message)
        return ((0.0, 0.0),)
    return tuple(sorted(dict(zip(states, thrusts, strict=True)).items()))
