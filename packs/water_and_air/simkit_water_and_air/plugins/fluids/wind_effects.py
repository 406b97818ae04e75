"""Wind that pushes links: `gz::sim::systems::WindEffects` and Gazebo Classic's `libWindPlugin.so`.

The scaling factor of the force is a number, or a function of position: a sum of polynomials in each of several boxes.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np
import numpy.typing as npt

from simkit import Params, WorldPlugin
from simkit.extend import NEVER, Options, OptionsOf, Vector, block, blocks, listens, number, offers
from simkit.float_sum import float_sum
from simkit.msgs import valid_topic
from simkit.number_text import number_or_nan
from simkit.plugins.options import vector
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, moving_data
from simkit_water_and_air.plugins.fluids.wind_gusts import GustOptions, Velocity, WindTarget, read_gusts

if TYPE_CHECKING:
    from collections.abc import Mapping

    import mujoco

    from simkit import Simulation
    from simkit.msgs import Vector3, Wind

WIND: Final = "simkit_msgs/msg/Wind"
VECTOR: Final = "geometry_msgs/msg/Vector3"
INFO: Final = "simkit_msgs/srv/WindInfo"
_FEW: Final = 8  # links; up to this number of links, Python floats are faster than arrays
Four = tuple[float, float, float, float]
_AXES: Final = ("px", "qy", "rz")
_ZERO: Final[Four] = (0.0, 0.0, 0.0, 0.0)
_ONE: Final = ((0.0, 0.0, 0.0, 1.0), _ZERO, _ZERO)
_FARTHEST: Final = 1e6  # [m], largest coordinate up to which a polynomial is checked for negative values
_ALLOWED: Final = "a factor of at least 0 everywhere, because wind cannot push against its direction"


@dataclass(frozen=True, slots=True)
class Interval:
    """Interval of one coordinate [m].

    Attributes:
        low, high: Ends of the interval.
        has_low, has_high: True if the interval includes this end.
    """

    low: float = -math.inf
    high: float = math.inf
    has_low: bool = False
    has_high: bool = False


@dataclass(frozen=True, slots=True)
class FieldPiece:
    """Sum of polynomials k · (p(x) + q(y) + r(z)), which is valid in one box of space.

    Attributes:
        where: Box, as intervals of x, y and z.
        factor: Factor k.
        terms: Coefficients of p, q and r, from the cubic term to the constant term.
    """

    where: tuple[Interval, Interval, Interval]
    factor: float
    terms: tuple[Four, Four, Four]

    def at(self, places: Vector) -> Vector:
        """Return the values at points [m], shape (n, 3), as an array of shape (n,)."""
        a, b, c, d = np.array(self.terms).T
        speeds: Vector = self.factor * (((a * places + b) * places + c) * places + d).sum(axis=1)
        return speeds

    def holds(self, places: Vector) -> npt.NDArray[np.bool_]:
        """Return for each point [m] of an array of shape (n, 3) whether the point is in the box."""
        inside = np.ones(len(places), bool)
        for values, interval in zip(places.T, self.where, strict=True):
            inside &= values >= interval.low if interval.has_low else values > interval.low
            inside &= values <= interval.high if interval.has_high else values < interval.high
        return inside

    def one_at(self, place: Sequence[float]) -> float | None:
        """Return the value at one point, or None if the point is outside the box."""
        for value, interval in zip(place, self.where, strict=True):
            if not (value >= interval.low if interval.has_low else value > interval.low):
                return None
            if not (value <= interval.high if interval.has_high else value < interval.high):
                return None
        p, q, r = (((a * x + b) * x + c) * x + d for x, (a, b, c, d) in zip(place, self.terms, strict=True))
        return self.factor * (p + q + r)

    @property
    def least(self) -> float:
        """Smallest value in the box, for coordinates from −`_FARTHEST` to `_FARTHEST`."""
        extremes = [_extremes(c, span) for c, span in zip(self.terms, self.where, strict=True)]
        return min(self.factor * float_sum(corner) for corner in itertools.product(*extremes))


@dataclass(frozen=True, slots=True)
class WindField:
    """Scaling factor of the wind's force [1/s] as a function of position.

    Attributes:
        pieces: Pieces of the function. The first piece that contains a point is valid there; outside all pieces, the
            factor is zero.
        everywhere: Constant factor, if there are no pieces.
    """

    pieces: tuple[FieldPiece, ...] = ()
    everywhere: float = 0.0

    def at(self, places: Vector) -> Vector | float:
        """Return the factor at each point [m] of an array of shape (n, 3): shape (n,), or one number if constant."""
        if not self.pieces:
            return self.everywhere
        speeds, is_open = np.zeros(len(places)), np.ones(len(places), bool)
        for piece in self.pieces:
            inside = is_open & piece.holds(places)
            if inside.any():
                speeds[inside] = piece.at(places[inside])
                is_open &= ~inside
        return speeds

    def one_at(self, place: Sequence[float]) -> float:
        """Return the factor at one point [m]."""
        for piece in self.pieces:
            speed = piece.one_at(place)
            if speed is not None:
                return speed
        return 0.0 if self.pieces else self.everywhere


class FieldPieceOptions(Options):
    """Options of a sum of polynomials: k · (p(x) + q(y) + r(z))."""

    k: float = number(1.0, minimum=-1e9, maximum=1e9)
    px: tuple[float, ...] = vector(_ZERO)
    qy: tuple[float, ...] = vector(_ZERO)
    rz: tuple[float, ...] = vector(_ZERO)


class WindFieldOptions(FieldPieceOptions):
    """Options of the `<force_approximation_scaling_factor>` block."""

    when: tuple[FieldPieceOptions, ...] = blocks(FieldPieceOptions)


def read_field(params: Params, quirks: bool) -> WindField:
    """Return the field that `<force_approximation_scaling_factor>` describes, and report invalid values.

    Args:
        params: Parameters of the plugin.
        quirks: True to square a constant factor, as Gazebo does.
    """
    name = "force_approximation_scaling_factor"
    block = params.child(name)
    if block is None:
        return WindField(everywhere=1.0)
    if not block.children:
        value = params.number(name, 1.0, minimum=0, maximum=1e9)
        return WindField(everywhere=value * value if quirks else value)
    options = WindFieldOptions(block)
    whens: tuple[FieldPieceOptions, ...] = options.when
    field = WindField(tuple(_piece(when) for when in whens) if whens else (_piece(options, is_bounded=False),))
    for piece, piece_options in zip(field.pieces, whens or (options,), strict=True):
        if piece.least < -1e-9:
            text = f"found <{piece_options.params.name}> with a minimum of {piece.least:g}; expected {_ALLOWED}"
            piece_options.params.error("SK-PARAM-002", text)
    return field


def _piece(options: FieldPieceOptions, is_bounded: bool = True) -> FieldPiece:
    block = options.params
    x, y, z = (_interval(block, axis) if is_bounded else Interval() for axis in "xyz")
    if not block.children:
        value = _number_of(block)
        return FieldPiece((x, y, z), value, _ONE)
    p, q, r = ((a, b, c, d) for a, b, c, d in (options.px, options.qy, options.rz))
    return FieldPiece((x, y, z), options.k, (p, q, r))


def _number_of(block: Params) -> float:
    """Return the text of an element as a number; 0 after an error."""
    value = number_or_nan(block.value)
    if not abs(value) <= 1e9:
        block.error("SK-PARAM-002", f"found <{block.name}>{block.value}</{block.name}>; expected a number")
        return 0.0
    return value


def _interval(block: Params, axis: str) -> Interval:
    low, has_low = _bound(block, axis + "ge", axis + "gt", -math.inf)
    high, has_high = _bound(block, axis + "le", axis + "lt", math.inf)
    return Interval(low, high, has_low, has_high)


def _bound(block: Params, closed: str, opened: str, default: float) -> tuple[float, bool]:
    bounds = [(name, block.attribute(name)) for name in (closed, opened) if block.attribute(name)]
    if len(bounds) == 2:
        block.error("SK-PARAM-002", f"found {closed} and {opened} on one <{block.name}>; expected one of the two")
    for name, text in bounds[:1]:
        value = number_or_nan(text)
        if math.isfinite(value):
            return value, name == closed
        block.error("SK-PARAM-002", f'found {name}="{text}"; expected a number [m]')
    return default, False


def _extremes(terms: Four, span: Interval) -> list[float]:
    """Return the values of a cubic polynomial at the ends of an interval and at its extrema within the interval."""
    low, high = max(span.low, -_FARTHEST), min(span.high, _FARTHEST)
    slope = np.polyder(np.poly1d(terms)).coeffs
    turns = [float(r.real) for r in np.roots(slope) if abs(r.imag) < 1e-12] if np.any(slope) else []
    points = [low, high, *(t for t in turns if low < t < high)]
    return [float(np.polyval(terms, point)) for point in points]


class WindEffectsOptions(GustOptions):
    """Options of `WindEffects`."""

    force_approximation_scaling_factor: WindFieldOptions = block(WindFieldOptions)


class WindPluginBase(WorldPlugin):
    """Changes the world's wind over time, with gusts and noise, and pushes the links that have `<enable_wind>`.

    The force on a link of mass m is m · factor · (air velocity − link velocity), at the centre of mass. The topic
    `/world/<world>/wind` sets the mean wind, and the service `/world/<world>/wind_info` returns it.
    """

    reads_at_load = ("inertial", "geometry")  # masses and areas are computed once

    endpoints = (
        listens("/world/{world}/wind", WIND, VECTOR),
        offers("/world/{world}/wind_info", INFO),
    )
    options = OptionsOf(GustOptions)
    has_field = True

    def load(self, parent: Simulation, params: Params) -> None:
        self._gusts = read_gusts(self.options, self.period)
        self._field = WindField(everywhere=1.0)
        if self.has_field:
            self._field = read_field(params, parent.world.gazebo_quirks)
        self._target: WindTarget = self._gusts.start(parent.world.wind)
        self._streams = {channel: self.random(channel, 3) for channel in ("wind", "wind bias")}
        self._last_velocity: tuple[int, Velocity] | None = None
        self._links: PushedLinks | None = None
        self._bind()
        self._is_second = any(isinstance(plugin, WindPluginBase) for plugin in self._before())
        if self._is_second:
            message = f"plugin {self.name!r}: the world already has a wind plugin; this one has no effect"
            params.diagnostics.warning("SK-PLUGIN-111", message, self.where, "remove one of them")
            return
        parent.engine.wind.source = self.velocity
        base = valid_topic(f"/world/{parent.world.name}")
        self.listen(f"{base}/wind", (WIND, VECTOR), self.set_wind)
        self.offer(f"{base}/wind_info", INFO, self._on_wind_info)

    @property
    def before_step_rate(self) -> float | None:
        """`NEVER` while the wind pushes no link, otherwise None (every step).

        The value is computed again after a spawn or a removal.
        """
        is_idle = self._links is not None and self._links.is_current and (not len(self._links) or self._is_calm)
        return NEVER if is_idle or self._is_second else None

    @before_step_rate.setter
    def before_step_rate(self, rate: float | None) -> None:
        raise AttributeError("before_step_rate of a wind plugin is read-only: it follows the links in the wind")

    def _before(self) -> list[Any]:
        """Return the plugins that run before this plugin."""
        return list(itertools.takewhile(lambda plugin: plugin is not self, self.sim.engine.structure.all_plugins()))

    @property
    def _is_calm(self) -> bool:
        """True while the wind is off; the air then has no effect on links."""
        return not self._target.blows

    # ------------------------------------------------------------------ velocity and forces

    def velocity(self, tick: int) -> Velocity:
        """Return the velocity of the air [m/s] in the world frame, during the step after a tick."""
        if self._last_velocity is None or self._last_velocity[0] != tick:
            self._last_velocity = tick, self._gusts.at(self._target, tick, self._draw)
        return self._last_velocity[1]

    def _draw(self, channel: str, index: int) -> Vector:
        return self._streams[channel].normal(index)

    def before_step(self) -> None:
        """Apply the force of the wind to the links for the next step."""
        if self._links is None or not self._links.is_current:
            self._bind()
            self.sim.engine.reschedule()
        links = self._links
        if not links or self._is_calm:
            return
        data = moving_data(self.sim)
        if len(links) <= _FEW:
            self._push_few(links, data)
            return
        air = np.array(self.velocity(self.sim.tick)) - links.velocities(data)
        strength = self._masses * self._field.at(data.xpos[links.bodies])
        links.push(data, (strength * air.T).T)

    def _push_few(self, links: PushedLinks, data: mujoco.MjData) -> None:
        """Apply the force of the wind to a few links, computed with Python floats."""
        x, y, z = self.velocity(self.sim.tick)
        field, everywhere = self._field, None if self._field.pieces else self._field.everywhere
        places = data.xpos[links.bodies].tolist()
        wrenches = {}
        for index, (mass, place, (u, v, w)) in enumerate(
            zip(self._masses.tolist(), places, links.velocities_few(data, places), strict=True)
        ):
            strength = mass * (field.one_at(place) if everywhere is None else everywhere)
            wrenches[index] = (strength * (x - u), strength * (y - v), strength * (z - w), 0.0, 0.0, 0.0)
        links.push_some(data, wrenches)

    def _bind(self) -> None:
        names = self.sim.engine.names.links
        windy = {name: binding.scene for name, binding in names.items() if binding.scene.enable_wind}
        self._links = PushedLinks(self.sim, list(windy))
        self._masses = np.array([windy[name].inertial.mass for name in self._links.names], float)

    def set_state(self, state: Mapping[str, object]) -> None:
        """Restore a state from `get_state`."""
        super().set_state(state)
        self._last_velocity = None

    # ------------------------------------------------------------------ commands

    def set_wind(self, message: Wind | Vector3) -> None:
        """Set the mean wind from a message."""
        vector = cast("Vector3", getattr(message, "linear_velocity", message))
        velocity = float(vector.x), float(vector.y), float(vector.z)
        if not all(map(math.isfinite, velocity)) or max(map(abs, velocity)) > 1e6:
            self._once.not_finite("a wind")
            return
        blows = bool(getattr(message, "enable_wind", True))
        for sensor in self.sim.engine.structure.all_sensors():
            sensor.take_held()  # pending readings belong to the old wind
        self._target = self._gusts.changed(self._target, velocity, blows, self.sim.tick)
        self._last_velocity = None
        self.sim.engine.reschedule()

    def _on_wind_info(self, request: object) -> dict[str, object]:
        target = self._target
        wind = {"linear_velocity": _fields(target.velocity), "enable_wind": target.blows}
        return {"wind": wind, "velocity": _fields(self.velocity(self.sim.tick))}


def _fields(vector: Velocity) -> dict[str, float]:
    return dict(zip("xyz", map(float, vector), strict=True))


class WindEffects(WindPluginBase):
    """Changes the world's wind over time, with gusts and noise, and pushes the links that have `<enable_wind>`.

    `<force_approximation_scaling_factor>` [1/s] is a number, or a sum of polynomials for each `<when>`.
    """

    options = OptionsOf(WindEffectsOptions)
    filenames = ("gz-sim-wind-effects-system",)
    names = ("gz::sim::systems::WindEffects",)


class WindPlugin(WindPluginBase):
    """Changes the world's wind over time, with gusts and noise, and pushes the links that have `<enable_wind>`.

    The horizontal and the vertical wind have separate strengths.
    """

    filenames = ("libWindPlugin.so",)
    has_field = False
