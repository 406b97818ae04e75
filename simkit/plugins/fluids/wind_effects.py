"""Wind that pushes links: `gz::sim::systems::WindEffects` and Gazebo Classic's `libWindPlugin.so`.

How strongly it pushes at which place is a number, or pieces of space with a sum of polynomials in each.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.base import NEVER, WorldPlugin
from simkit.plugins.endpoints import listens, offers
from simkit.plugins.fluids.link_forces import PushedLinks, moving_data
from simkit.plugins.fluids.wind_gusts import GustOptions, Velocity, WindTarget, read_gusts
from simkit.plugins.one_time_warnings import OneTimeWarnings
from simkit.plugins.options import Options, OptionsOf, block, blocks, number, vector
from simkit.pose import Vector

if TYPE_CHECKING:
    from collections.abc import Mapping

    import mujoco

    from simkit.runtime import Simulation
    from simkit.runtime.engine.entity_structure import AttachedPlugin

WIND: Final = "simkit_msgs/msg/Wind"
VECTOR: Final = "geometry_msgs/msg/Vector3"
INFO: Final = "simkit_msgs/srv/WindInfo"
_FEW: Final = 8  # links, up to which plain numbers are faster than arrays
Four = tuple[float, float, float, float]
_AXES: Final = ("px", "qy", "rz")
_ZERO: Final[Four] = (0.0, 0.0, 0.0, 0.0)
_ONE: Final = ((0.0, 0.0, 0.0, 1.0), _ZERO, _ZERO)
_FARTHEST: Final = 1e6  # [m], where a polynomial is asked whether it is negative
_ALLOWED: Final = "at least 0 everywhere: wind pushes along, not against"


@dataclass(frozen=True, slots=True)
class Interval:
    """Of one coordinate [m]."""

    low: float = -math.inf
    high: float = math.inf
    has_low: bool = False
    has_high: bool = False


@dataclass(frozen=True, slots=True)
class FieldPiece:
    """k · (p(x) + q(y) + r(z)) in a box of space.

    Attributes:
        where: intervals of x, y and z.
        factor: k.
        terms: coefficients of p, q and r, from the cube down.
    """

    where: tuple[Interval, Interval, Interval]
    factor: float
    terms: tuple[Four, Four, Four]

    def at(self, places: Vector) -> Vector:
        a, b, c, d = np.array(self.terms).T
        found: Vector = self.factor * (((a * places + b) * places + c) * places + d).sum(axis=1)
        return found

    def holds(self, places: Vector) -> npt.NDArray[np.bool_]:
        inside = np.ones(len(places), bool)
        for values, interval in zip(places.T, self.where, strict=True):
            inside &= values >= interval.low if interval.has_low else values > interval.low
            inside &= values <= interval.high if interval.has_high else values < interval.high
        return inside

    def one_at(self, place: Sequence[float]) -> float | None:
        """At one place; None where this piece does not hold it."""
        for value, interval in zip(place, self.where, strict=True):
            if not (value >= interval.low if interval.has_low else value > interval.low):
                return None
            if not (value <= interval.high if interval.has_high else value < interval.high):
                return None
        p, q, r = (((a * x + b) * x + c) * x + d for x, (a, b, c, d) in zip(place, self.terms, strict=True))
        return self.factor * (p + q + r)

    @property
    def least(self) -> float:
        """The smallest value in the box, as far as `_FARTHEST` out."""
        extremes = [_extremes(c, span) for c, span in zip(self.terms, self.where, strict=True)]
        return min(self.factor * sum(corner) for corner in itertools.product(*extremes))


@dataclass(frozen=True, slots=True)
class WindField:
    """The scaling factor of the wind's force [1/s]: of the first piece that holds a place, zero outside of all.

    Attributes:
        pieces: where it is not the same everywhere.
        everywhere: where it is.
    """

    pieces: tuple[FieldPiece, ...] = ()
    everywhere: float = 0.0

    def at(self, places: Vector) -> Vector | float:
        """At places [m], shape (n, 3): shape (n,), or one for all."""
        if not self.pieces:
            return self.everywhere
        found, is_open = np.zeros(len(places)), np.ones(len(places), bool)
        for piece in self.pieces:
            inside = is_open & piece.holds(places)
            if inside.any():
                found[inside] = piece.at(places[inside])
                is_open &= ~inside
        return found

    def one_at(self, place: Sequence[float]) -> float:
        """At one place [m], in plain numbers."""
        for piece in self.pieces:
            found = piece.one_at(place)
            if found is not None:
                return found
        return 0.0 if self.pieces else self.everywhere


class FieldPieceOptions(Options):
    """A sum of polynomials: k · (p(x) + q(y) + r(z))."""

    k: float = number(1.0, minimum=-1e9, maximum=1e9)
    px: tuple[float, ...] = vector(_ZERO)
    qy: tuple[float, ...] = vector(_ZERO)
    rz: tuple[float, ...] = vector(_ZERO)


class WindFieldOptions(FieldPieceOptions):
    """The `<force_approximation_scaling_factor>` block."""

    when: tuple[FieldPieceOptions, ...] = blocks(FieldPieceOptions)


def read_field(params: Params, quirks: bool) -> WindField:
    """A plugin's `<force_approximation_scaling_factor>`; what is wrong is reported.

    Args:
        params: the plugin's.
        quirks: a plain number counts squared, as gz has it.
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
    for piece, one in zip(field.pieces, whens or (options,), strict=True):
        if piece.least < -1e-9:
            text = f"found <{one.params.name}> that comes down to {piece.least:g}, allowed is {_ALLOWED}"
            one.params.error("SK-PARAM-002", text)
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
    """The number that an element itself is."""
    try:
        value = float(block.value)
    except ValueError:
        value = math.nan
    if not abs(value) <= 1e9:
        block.error("SK-PARAM-002", f"found <{block.name}>{block.value}</{block.name}>, allowed is a number")
        return 0.0
    return value


def _interval(block: Params, axis: str) -> Interval:
    low, has_low = _bound(block, axis + "ge", axis + "gt", -math.inf)
    high, has_high = _bound(block, axis + "le", axis + "lt", math.inf)
    return Interval(low, high, has_low, has_high)


def _bound(block: Params, closed: str, opened: str, default: float) -> tuple[float, bool]:
    given = [(name, block.attribute(name)) for name in (closed, opened) if block.attribute(name)]
    if len(given) == 2:
        block.error("SK-PARAM-002", f"found {closed} and {opened} on one <{block.name}>, allowed is one of the two")
    for name, text in given[:1]:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if math.isfinite(value):
            return value, name == closed
        block.error("SK-PARAM-002", f'found {name}="{text}", allowed is a number [m]')
    return default, False


def _extremes(terms: Four, span: Interval) -> list[float]:
    """Values of a cubic at the ends of an interval and where its slope is zero within."""
    low, high = max(span.low, -_FARTHEST), min(span.high, _FARTHEST)
    slope = np.polyder(np.poly1d(terms)).coeffs
    turns = [float(r.real) for r in np.roots(slope) if abs(r.imag) < 1e-12] if np.any(slope) else []
    points = [low, high, *(t for t in turns if low < t < high)]
    return [float(np.polyval(terms, point)) for point in points]


class WindEffectsOptions(GustOptions):
    """Options of `WindEffects`."""

    force_approximation_scaling_factor: WindFieldOptions = block(WindFieldOptions)


class WindPluginBase(WorldPlugin):
    """Makes the world's wind rise, turn, swell and flutter, and pushes the links with `<enable_wind>` by it.

    A link of mass m feels m · factor · (velocity of the air − its own) at its centre of mass. `/world/<world>/wind`
    sets the wind that is asked for, `/world/<world>/wind_info` tells it.
    """

    endpoints = (
        listens("/world/{world}/wind", WIND, VECTOR),
        offers("/world/{world}/wind_info", INFO),
    )
    options = OptionsOf(GustOptions)
    has_field = True

    def load(self, parent: Simulation, params: Params) -> None:
        self.once = OneTimeWarnings(self)
        self._gusts = read_gusts(self.options, self.period)
        self._field = WindField(everywhere=1.0)
        if self.has_field:
            self._field = read_field(params, parent.world.gazebo_quirks)
        self._seed: WindTarget = self._gusts.start(parent.world.wind)
        self._streams = {channel: self.random(channel, 3) for channel in ("wind", "wind bias")}
        self._felt: tuple[int, Velocity] | None = None
        self._links: PushedLinks | None = None
        self._bind()
        self._is_second = any(isinstance(plugin, WindPluginBase) for plugin in self._before())
        if self._is_second:
            message = f"plugin {self.name!r}: the world has a wind plugin already; this one has no effect"
            params.diagnostics.warning("SK-PLUGIN-111", message, self.where, "leave one of them")
            return
        parent.engine.wind.source = self.velocity
        base = valid_topic(f"/world/{parent.world.name}")
        self.listen(f"{base}/wind", (WIND, VECTOR), self._on_wind)
        self.offer(f"{base}/wind_info", INFO, self._tell)

    @property
    def before_step_rate(self) -> float | None:
        """Never while nothing feels the wind; after a spawn or a removal that is looked at anew."""
        is_idle = self._links is not None and self._links.is_current and (not len(self._links) or self._is_calm)
        return NEVER if is_idle or self._is_second else None

    @before_step_rate.setter
    def before_step_rate(self, rate: float | None) -> None:
        raise AttributeError("a wind is called as long as something feels it")

    def _before(self) -> list[AttachedPlugin]:
        """The plugins that stand before this one."""
        return list(itertools.takewhile(lambda plugin: plugin is not self, self.sim.engine.structure.all_plugins()))

    @property
    def _is_calm(self) -> bool:
        """Off: nothing is pushed, and what moves is not braked."""
        return not self._seed.blows

    # ------------------------------------------------------------------ what it is

    def velocity(self, tick: int) -> Velocity:
        """Velocity of the air [m/s], world frame, in the step that follows a tick."""
        if self._felt is None or self._felt[0] != tick:
            self._felt = tick, self._gusts.at(self._seed, tick, self._draw)
        return self._felt[1]

    def _draw(self, channel: str, index: int) -> Vector:
        return self._streams[channel].normal(index)

    def before_step(self) -> None:
        """Pushes for the step to come."""
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
        """The same in plain numbers."""
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
        """Back to a state from `get_state`."""
        super().set_state(state)
        self._felt = None

    # ------------------------------------------------------------------ commands

    def _on_wind(self, message: Any) -> None:
        vector = getattr(message, "linear_velocity", message)
        velocity = float(vector.x), float(vector.y), float(vector.z)
        if not all(map(math.isfinite, velocity)) or max(map(abs, velocity)) > 1e6:
            self.once.not_finite("a wind")
            return
        blows = bool(getattr(message, "enable_wind", True))
        for sensor in self.sim.engine.structure.all_sensors():
            sensor.take_held()  # what was held was measured in the old one
        self._seed = self._gusts.changed(self._seed, velocity, blows, self.sim.tick)
        self._felt = None
        self.sim.engine.reschedule()

    def _tell(self, request: object) -> dict[str, object]:
        seed = self._seed
        wind = {"linear_velocity": _fields(seed.velocity), "enable_wind": seed.blows}
        return {"wind": wind, "velocity": _fields(self.velocity(self.sim.tick))}


def _fields(vector: Velocity) -> dict[str, float]:
    return dict(zip("xyz", map(float, vector), strict=True))


class WindEffects(WindPluginBase):
    """The world's wind, as it rises, turns, swells and flutters; it pushes links with `<enable_wind>`.

    `<force_approximation_scaling_factor>` [1/s] is a number, or a sum of polynomials by `<when>`.
    """

    options = OptionsOf(WindEffectsOptions)
    filenames = ("gz-sim-wind-effects-system",)
    names = ("gz::sim::systems::WindEffects",)


class WindPlugin(WindPluginBase):
    """The world's wind, as it rises, turns, swells and flutters; it pushes links with `<enable_wind>`.

    What is asked for is a wind over the ground and a vertical one, each of its own strength.
    """

    filenames = ("libWindPlugin.so",)
    has_field = False
