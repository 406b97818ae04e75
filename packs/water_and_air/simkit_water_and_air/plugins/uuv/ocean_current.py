"""Currents of dave that depend on depth and tide: `libdave_ocean_current_plugin.so` and its plugin for vehicles.

Parameters, topics, services and formulas are those of `ocean_current_world_plugin.cc`, `ocean_current_plugin.cpp` and
`ocean_current_model_plugin.cc`.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from simkit import ModelPlugin, Params, msgs
from simkit.extend import Options, OptionsOf, block, boolean, integer, number, offers, publishes, text, without_effect
from simkit.input_file import read_failure, read_input_text
from simkit.plugins.find_entities import find_plugin_file
from simkit_water_and_air.plugins.fluids.water_current import LAYERS, TWIST, absolute_topic, current_message
from simkit_water_and_air.plugins.uuv.tide import (
    Constituent,
    Date,
    read_tide_table,
    seconds_of,
    table_speed,
    tide_velocity,
)
from simkit_water_and_air.plugins.uuv.underwater_current import (
    GaussMarkovProcess,
    UnderwaterCurrent,
    UnderwaterCurrentOptions,
    current_endpoints,
    velocity_of,
)

if TYPE_CHECKING:
    from pathlib import Path

    from simkit import Model, Simulation
    from simkit.extend import SpecBuilder
    from simkit.msgs import Message

_TYPES: Final = "dave_gazebo_ros_plugins"
_DATABASE: Final = f"{_TYPES}/msg/StratifiedCurrentDatabase"
_SET_VELOCITY, _SET_DIRECTION = (
    f"{_TYPES}/srv/SetStratifiedCurrentVelocity",
    f"{_TYPES}/srv/SetStratifiedCurrentDirection",
)
_ANGLES: Final = {"horz_angle": 1, "vert_angle": 2}
_HEADER_LINES: Final = 3  # of the table of currents
_PERIOD: Final = 0.05  # between two messages [s]
_PARTS: Final = ("M2", "S2", "N2")
_NORTH, _EAST, _DOWN = 0, 1, 2


class StratifiedCurrentOptions(Options):
    """Options of `<transient_current>` in a world."""

    topic: str = text("stratified_current_velocity", element="topic_stratified")
    file: str = text("transientOceanCurrentDatabase.csv", element="databasefilePath")


class ConstituentOptions(Options):
    """Options of a harmonic part of the tide."""

    amp: float = number(0.0, "m/s", minimum=-1e6, maximum=1e6)
    phase: float = number(0.0, "deg", minimum=-1e6, maximum=1e6)
    speed: float = number(0.0, "deg/h", minimum=-1e6, maximum=1e6)


class ConstituentsOptions(Options):
    """Options of `<harmonic_constituents>`."""

    m2: ConstituentOptions = block(ConstituentOptions, element="M2")
    s2: ConstituentOptions = block(ConstituentOptions, element="S2")
    n2: ConstituentOptions = block(ConstituentOptions, element="N2")


class TideDirectionOptions(Options):
    """Options of `<mean_direction>`."""

    ebb: float = number(unit="deg", required=True)
    flood: float = number(unit="deg", required=True)


class StartTimeOptions(Options):
    """Options of `<world_start_time_GMT>`."""

    day: int = integer(required=True)
    month: int = integer(required=True)
    year: int = integer(required=True, minimum=1, maximum=9999)
    hour: int = integer(required=True)
    minute: int = integer(0)


class TideOptions(Options):
    """Options of `<tidal_oscillation>`."""

    file: str = text("", element="databasefilePath")
    constituents: ConstituentsOptions = block(ConstituentsOptions, element="harmonic_constituents")
    direction: TideDirectionOptions = block(TideDirectionOptions, element="mean_direction")
    start: StartTimeOptions = block(StartTimeOptions, element="world_start_time_GMT")


class OceanCurrentOptions(UnderwaterCurrentOptions):
    """Options of `OceanCurrent`."""

    layers: StratifiedCurrentOptions = block(StratifiedCurrentOptions, element="transient_current")
    tide: TideOptions = block(TideOptions, element="tidal_oscillation")


class OceanCurrent(UnderwaterCurrent):
    """Publishes the velocity of the water [m/s], that at the depths of a table, and the tide, twenty times a second.

    The table is the file `<transient_current><databasefilePath>`: three lines of text, then the velocity to the north
    and to the east [m/s] and the depth [m]. `libdave_ocean_current_model_plugin.so` makes the current at a vehicle of
    it. The tide comes from a table of NOAA or from harmonic parts.
    """

    types = _TYPES
    endpoints = (
        *current_endpoints(_TYPES),
        publishes("/{namespace}/stratified_current_velocity", LAYERS, named_by=("transient_current/topic_stratified",)),
        publishes("/{namespace}/stratified_current_velocity_database", _DATABASE),
        offers("/{namespace}/set_stratified_current_velocity", _SET_VELOCITY),
        *(offers(f"/{{namespace}}/set_stratified_current_{name}", _SET_DIRECTION) for name in _ANGLES),
    )
    options = OptionsOf(OceanCurrentOptions)
    filenames = ("libdave_ocean_current_plugin.so", "libdave_ocean_current_world_plugin.so")

    def prepare(self, scene: object, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        self._rows: list[tuple[float, float, float]] = []
        if options.layers.is_given:
            self._rows = self._read(options.layers.file, options.layers.params, builder, _read_layers) or []
        self._tide = self._read_tide(options.tide, builder) if options.tide.is_given else {}

    def _read(self, uri: str, params: Params, builder: SpecBuilder, parse: Any) -> Any:
        """Return the content of a table; None after an error."""
        path: Path | None = find_plugin_file(self, uri, builder)
        element = params.block("databasefilePath")
        if path is None:
            element.error("SK-PARAM-002", f"there is no file {uri!r}", "write a path relative to the world's file")
            return None
        try:
            return parse(read_input_text(path, inside=path.parent))
        except (OSError, UnicodeDecodeError) as error:
            element.error("SK-PARAM-002", f"{uri!r} cannot be read: {read_failure(error)}")
        except ValueError as error:
            element.error("SK-PARAM-002", f"{uri!r}, {error}")
        return None

    def _read_tide(self, tide: TideOptions, builder: SpecBuilder) -> dict[str, object]:
        """Return the fields of the tide in the message with the table."""
        start, given = tide.start, tide.constituents
        date: Date = (start.year, start.month, start.day, start.hour, start.minute)
        fields: dict[str, object] = {"ebb_direction": tide.direction.ebb, "flood_direction": tide.direction.flood}
        try:
            now = seconds_of(date)
        except (ValueError, TypeError) as error:
            if start.params.diagnostics.error_count == 0:
                start.params.error("SK-PARAM-002", f"<world_start_time_GMT> is not a date: {error}")
            return fields
        for name, value in zip(("year", "month", "day", "hour", "minute"), date, strict=True):
            fields[f"world_start_time_{name}"] = value
        if given.is_given and not tide.file:
            fields["tide_constituents"] = True
            for name in _PARTS:
                part: ConstituentOptions = getattr(given, name.lower())
                values = {"amp": part.amp, "phase": part.phase, "speed": part.speed}
                fields.update({f"{name.lower()}_{field}": value for field, value in values.items()})
            return fields
        table = self._read(tide.file, tide.params, builder, read_tide_table)
        if table is None:
            return fields
        dates, speeds = table
        if not dates or not seconds_of(dates[0]) <= now <= seconds_of(dates[-1]):
            message = "<world_start_time_GMT> is outside of the table of the tide, whose first or last speed is used"
            start.params.warning("SK-PARAM-008", message, "choose a date of the table")
        for index, name in enumerate(("year", "month", "day", "hour", "minute")):
            fields[f"time_gmt_{name}"] = [date[index] for date in dates]
        return {**fields, "tide_velocities": speeds}

    def load(self, parent: Simulation, params: Params) -> None:
        super().load(parent, params)
        speed, around, above = self._processes.values()
        self._layers = [
            (
                GaussMarkovProcess(
                    size := math.sqrt(north * north + east * east), 0.0, speed.high, speed.mu, speed.noise, size
                ),
                GaussMarkovProcess(angle := math.atan2(east, north), -math.pi, math.pi, around.mu, around.noise, angle),
                GaussMarkovProcess(0.0, -math.pi / 2, math.pi / 2, above.mu, above.noise, 0.0),
            )
            for north, east, _ in self._rows
        ]
        self._table = list(self._rows)
        self._drawn = self.random("layers", max(3 * len(self._rows), 1))
        topic = f"{self._base}/{self.options.layers.topic.strip('/')}"
        self._layer_output = self.advertise(topic, LAYERS)
        self._database_output = self.advertise(f"{topic}_database", _DATABASE)
        self.offer(f"{self._base}/set_stratified_current_velocity", _SET_VELOCITY, self._set_layer)
        for name, index in _ANGLES.items():
            call = partial(self._set_layer_angle, index)
            self.offer(f"{self._base}/set_stratified_current_{name}", _SET_DIRECTION, call)

    def before_step(self) -> None:
        """Advance the processes of all layers, and publish them when they are due."""
        step, drawn = self.period if self._index else 0.0, self._drawn.uniform(self._index).tolist()
        self._layers = [
            (
                first.after(step, 0.5 * drawn[3 * row]),
                second.after(step, 0.5 * drawn[3 * row + 1]),
                third.after(step, 0.5 * drawn[3 * row + 2]),
            )
            for row, (first, second, third) in enumerate(self._layers)
        ]
        super().before_step()

    def publish(self) -> None:
        """Publish the velocity, that of all layers, and the table."""
        super().publish()
        depths = [depth for _, _, depth in self._table]
        if self._layer_output.wanted:
            velocities = [_xyz(*velocity_of(*(process.value for process in layer))) for layer in self._layers]
            header = msgs.header(self.sim.time_ns, "/world")
            self._layer_output.publish(msgs.make(LAYERS, header=header, depths=depths, velocities=velocities))
        if self._database_output.wanted:
            velocities = [_xyz(north, east, 0.0) for north, east, _ in self._table]
            self._database_output.publish(msgs.make(_DATABASE, depths=depths, velocities=velocities, **self._tide))

    def _changed(self, row: int, changes: dict[int, float]) -> bool:
        """Set the means of processes of a layer; return False if a value or the layer is out of range."""
        if row >= len(self._layers):
            return False
        layer = list(self._layers[row])
        for index, mean in changes.items():
            if not layer[index].low <= mean <= layer[index].high:
                return False
            layer[index] = replace(layer[index], mean=mean, value=mean)
        first, second, third = layer
        self._layers[row] = first, second, third
        return True

    def _set_layer(self, request: Message) -> dict[str, object]:
        row, speed, angle = int(request.layer), float(request.velocity), float(request.horizontal_angle)
        is_set = self._changed(row, {0: speed, 1: angle, 2: float(request.vertical_angle)})
        if is_set:
            self._table[row] = math.cos(angle) * speed, math.sin(angle) * speed, self._table[row][2]
        return {"success": is_set}

    def _set_layer_angle(self, index: int, request: Message) -> dict[str, object]:
        row, angle = int(request.layer), float(request.angle)
        is_set = self._changed(row, {index: angle})
        if is_set and index == _ANGLES["horz_angle"]:
            north, east, depth = self._table[row]
            speed = math.sqrt(north * north + east * east)
            self._table[row] = math.cos(angle) * speed, math.sin(angle) * speed, depth
        return {"success": is_set}


class NoisyVelocityOptions(Options):
    """Options of one component of the current at a vehicle."""

    mean: bool = without_effect()
    mu: bool = without_effect()
    limit: float = number(0.0, "m/s", element="noiseAmp", minimum=0.0, maximum=1e6)
    noise: float = number(0.0, "m/s", element="noiseFreq", minimum=0.0, maximum=1e6)


class TransientCurrentOptions(Options):
    """Options of `<transient_current>` in a vehicle."""

    topic: str = text("stratified_current_velocity", element="topic_stratified")
    north: NoisyVelocityOptions = block(NoisyVelocityOptions, element="velocity_north")
    east: NoisyVelocityOptions = block(NoisyVelocityOptions, element="velocity_east")
    down: NoisyVelocityOptions = block(NoisyVelocityOptions, element="velocity_down")


class VehicleCurrentOptions(Options):
    """Options of `VehicleCurrent`."""

    namespace: str = text()
    topic: str = text("", element="flow_velocity_topic")
    link: bool = without_effect(element="base_link_name")
    current: TransientCurrentOptions = block(TransientCurrentOptions, element="transient_current")
    has_tide: bool = boolean(element="tide_oscillation")


class VehicleCurrent(ModelPlugin):
    """Publishes the velocity of the water [m/s] at the depth of a model, twenty times a second.

    It is interpolated in the table of `libdave_ocean_current_plugin.so`. With `<tide_oscillation>`, the velocity to the
    north is a factor of the tide. Each component has uniform noise of ± `<noiseFreq>` / 2 within ± `<noiseAmp>`.
    """

    endpoints = (publishes("/hydrodynamics/current_velocity/{model}", TWIST, named_by=("flow_velocity_topic",)),)
    options = OptionsOf(VehicleCurrentOptions)
    filenames = ("libdave_ocean_current_model_plugin.so",)

    def load(self, parent: Model, params: Params) -> None:
        options = self.options.read_all()
        self._model = parent
        space = options.namespace.strip("/")
        name = options.topic.strip("/") or f"hydrodynamics/current_velocity/{parent.name}"
        self._output = self.advertise(absolute_topic(f"{space}/{name}"), TWIST)
        self.listen(f"/hydrodynamics/{options.current.topic.strip('/')}_database", _DATABASE, self._on_database)
        self._rows: list[tuple[float, float, float]] = []
        self._times: list[float] = []
        self._speeds: list[float] = []
        self._parts: list[Constituent] = []
        self._directions, self._start = (0.0, 0.0), 0.0
        self._last, self._next_message, self._index = 0, 0.0, 0
        self._stream = self.random("current", 3)

    def _on_database(self, message: Message) -> None:
        vectors = zip(message.velocities, message.depths, strict=False)
        self._rows = [(float(v.x), float(v.y), float(depth)) for v, depth in vectors]
        if not self.options.has_tide:
            return
        self._parts, self._directions = [], (float(message.ebb_direction), float(message.flood_direction))
        if message.tide_constituents:
            for name in ("m2", "s2", "n2"):
                values = (float(getattr(message, f"{name}_{field}")) for field in ("amp", "phase", "speed"))
                self._parts.append(Constituent(*values))
        elif len(message.tide_velocities) != len(self._speeds):  # the table of a year has thousands of entries
            columns = [getattr(message, f"time_gmt_{name}") for name in ("year", "month", "day", "hour", "minute")]
            self._times = [seconds_of((*map(int, date),)) for date in zip(*columns, strict=True)]  # type: ignore[arg-type]
            self._speeds = [float(speed) / 100 for speed in message.tide_velocities]
        if self._parts or self._times:
            names = ("year", "month", "day", "hour", "minute")
            year, month, day, hour, minute = (int(getattr(message, f"world_start_time_{name}")) for name in names)
            self._start = seconds_of((year, month, day, hour, minute))

    def _at_depth(self, depth: float) -> tuple[float, float]:
        """Return the velocity to the north and the east [m/s] in the table; the last one below its end.

        As in the source, a vehicle that jumps more than two rows keeps its row.
        """
        rows = self._rows
        index = next((i for i in range(1, len(rows)) if rows[i][2] > depth), 0)
        if self._last and abs(index - self._last) > 2:
            index = min(self._last, len(rows) - 1)
        self._last = index
        if index == 0:
            return rows[-1][_NORTH], rows[-1][_EAST]
        (north, east, upper), (next_north, next_east, lower) = rows[index - 1], rows[index]
        share = (depth - upper) / (lower - upper)
        return north + share * (next_north - north), east + share * (next_east - east)

    def _mean(self) -> tuple[float, float, float]:
        north, east = self._at_depth(-float(self._model.pose.position[2]))
        if self._parts or self._times:
            time = self._start + self.sim.time
            speed = table_speed(self._times, self._speeds, time) if not self._parts else 0.0
            for part in self._parts:
                speed += part.at(time)
            tide_north, tide_east = tide_velocity(speed, *self._directions)
            north, east = tide_north * north, tide_east * north
        return north, east, 0.0

    def before_step(self) -> None:
        """Publish the velocity when it is due."""
        if self.sim.time < self._next_message - 1e-9:
            return
        self._next_message = self.sim.time + _PERIOD
        velocity = (0.0, 0.0, 0.0)
        if self._rows:
            drawn = self._stream.uniform(self._index).tolist()
            self._index += 1
            current = self.options.current
            north, east, down = (
                mean + max(-given.limit, min(given.limit, 0.5 * given.noise * number_of_part))
                for mean, given, number_of_part in zip(
                    self._mean(), (current.north, current.east, current.down), drawn, strict=True
                )
            )
            velocity = north, east, down
        self._output.publish(current_message(self.sim.time_ns, velocity))


def _read_layers(text: str) -> list[tuple[float, float, float]]:
    """Return the rows of a table of currents: velocity to the north and the east [m/s], and depth [m].

    Raises:
        ValueError: a line is invalid; the message has its number.
    """
    rows: list[tuple[float, float, float]] = []
    for line_number, line in enumerate(text.splitlines()[_HEADER_LINES:], _HEADER_LINES + 1):
        if not line.strip():
            continue
        try:
            north, east, depth = map(float, line.split(",")[:3])
        except ValueError:
            raise ValueError(f"line {line_number}: found {line!r:.60}; expected three numbers with commas") from None
        if not all(map(math.isfinite, (north, east, depth))) or (rows and depth <= rows[-1][2]):
            raise ValueError(f"line {line_number}: found {line!r:.60}; expected finite numbers and increasing depths")
        rows.append((north, east, depth))
    return rows


def _xyz(x: float, y: float, z: float) -> dict[str, float]:
    return {"x": x, "y": y, "z": z}
