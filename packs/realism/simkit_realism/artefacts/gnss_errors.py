"""Errors of satellite receivers besides noise: types of fix, multipath, and outages with the first fix after them."""

from __future__ import annotations

import abc
import math
from dataclasses import dataclass, replace
from typing import Any, Final, NamedTuple

import numpy as np

from simkit import Params
from simkit.elementary_functions import exp
from simkit.extend import Artefact, NavSat, NavSatReading, Sensor
from simkit_realism.areas import Area, Place, read_areas

_LONGEST = 1e9  # [s] or [m]
_MOST = 1e6  # [m] largest standard deviation
NO_FIX: Final = -1  # as `STATUS_NO_FIX` of `NavSatStatus`
STATUSES: Final = {"no_fix": NO_FIX, "fix": 0, "sbas": 1, "gbas": 2}
"""Names of the values of `NavSatStatus`."""

Numbers = tuple[float, float, float]


class ReceiverArtefact(Artefact):
    """Error of a satellite receiver whose state follows the position of the receiver and the time.

    Attributes:
        state: state at the newest sample; None before the first.
    """

    follows_truth = True
    evolves = True
    state: Any = None
    sensor: NavSat

    def prepare(self) -> None:
        self._stream = self.stream("state", 8)
        self.sensor.register_noise(self)

    def restart(self) -> None:
        self.state = None

    def set_interval(self, interval: float) -> None:
        """Do nothing: each step has its own time."""

    def evolve(self, index: int, dt: float) -> None:
        sensor = self.sensor
        truth = sensor.measure(sensor.sim.mj_model, sensor.computed_data())
        x, y = sensor.plane_position(truth)
        place = Place(x, y, math.degrees(truth.latitude), math.degrees(truth.longitude))
        self.state = self.next_state(place, index, dt)

    @abc.abstractmethod
    def next_state(self, place: Place, index: int, dt: float) -> object:
        """Return the state at sample `index`, `dt` [s] after the present one, at a place."""

    def normals(self, index: int) -> Numbers:
        """Return three standard normal numbers of a sample."""
        east, north, up = self._stream.normal(index)[:3].tolist()
        return east, north, up

    def shares(self, index: int) -> tuple[float, float]:
        """Return two numbers of a sample that are uniform from 0 to 1."""
        first, second = (0.5 * (self._stream.uniform(index)[:2] + 1.0)).tolist()
        return first, second

    def moved(self, reading: NavSatReading, east: float, north: float, up: float) -> NavSatReading:
        """Return a reading displaced by metres to east, north and up."""
        latitude, longitude = self.sensor.move_over_ground(reading, east, north)
        return replace(reading, latitude=latitude, longitude=longitude, altitude=reading.altitude + up)


def next_correlated(numbers: Numbers, normals: Numbers, exponent: float) -> Numbers:
    """Return the next standard normal numbers of a Gauss-Markov process, with the correlation exp(-exponent)."""
    share = float(exp(-exponent))
    spread = math.sqrt(max(0.0, 1.0 - share * share))
    x, y, z = [share * old + spread * new for old, new in zip(numbers, normals, strict=True)]
    return x, y, z


@dataclass(frozen=True, slots=True)
class FixType:
    """Type of fix: its status, share of the time, error [m], satellites, and the areas where it occurs."""

    status: int
    weight: float
    stddev: float
    vertical_stddev: float
    satellites: int
    areas: tuple[Area, ...]


class FixState(NamedTuple):
    """State of `FixTypes`: number of the type, and the error in standard deviations."""

    kind: int
    errors: Numbers


class FixTypes(ReceiverArtefact):
    """`<simkit:fix_types>` of a satellite receiver: types of fix with their errors, drawn by time and place.

    In an area that a type names, only the types that name an area with this place can occur; elsewhere, the types
    without an area. The covariance of a message is that of the noise and of the present type.

    Args:
        params: the element: `mean_duration` [s] until the type is drawn again, 0 for each sample; `correlation_time`
            [s] of the errors, 0 for white noise; and a `fix` for each type, with `status` (`no_fix`, `fix`, `sbas` or
            `gbas`), `probability`, `stddev` and `vertical_stddev` [m], `satellites`, and any number of `area`.
        sensor: the receiver.
    """

    elements = ("navsat/fix_types",)
    order = 20.0

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self.mean_duration = params.number("mean_duration", 0.0, minimum=0.0, maximum=_LONGEST)
        self.correlation_time = params.number("correlation_time", 0.0, minimum=0.0, maximum=_LONGEST)
        self.types = tuple(_read_fix(block) for block in params.all("fix"))
        if not any(kind.weight > 0 and not kind.areas for kind in self.types):
            message = "<fix_types> needs a <fix> without an <area> and with a <probability> above 0"
            params.error("SK-SENSOR-248", message, "add the type of fix that occurs outside of all areas")

    def next_state(self, place: Place, index: int, dt: float) -> FixState:
        state: FixState | None = self.state
        possible = self._possible(place)
        redraw, share = self.shares(index)
        normals = self.normals(index)
        if state is None:
            return FixState(self._draw(possible, share), normals)
        time = self.correlation_time
        errors = next_correlated(state.errors, normals, dt / time) if time > 0 else normals
        stays = float(exp(-dt / self.mean_duration)) if self.mean_duration > 0 else 0.0
        is_drawn = redraw >= stays or state.kind not in possible
        return FixState(self._draw(possible, share) if is_drawn else state.kind, errors)

    def _possible(self, place: Place) -> list[int]:
        here = [
            number
            for number, kind in enumerate(self.types)
            if kind.weight > 0 and any(area.contains(place) for area in kind.areas)
        ]
        return here or [number for number, kind in enumerate(self.types) if kind.weight > 0 and not kind.areas]

    def _draw(self, possible: list[int], share: float) -> int:
        """Draw one of the possible types at a share, from 0 to 1, of their weights."""
        total = 0.0
        for number in possible:
            total += self.types[number].weight
        left = share * total
        for number in possible:
            left -= self.types[number].weight
            if left < 0:
                return number
        return possible[-1]

    def apply(self, reading: NavSatReading, truth: NavSatReading, index: int) -> NavSatReading:
        kind = self.types[self.state.kind]
        if kind.status == NO_FIX:
            return without_fix(reading)
        east, north, up = self.state.errors
        if kind.stddev or kind.vertical_stddev:
            reading = self.moved(reading, kind.stddev * east, kind.stddev * north, kind.vertical_stddev * up)
        variances = (kind.stddev**2, kind.vertical_stddev**2)
        return replace(reading, status=kind.status, variances=variances, satellites=kind.satellites)


def _read_fix(params: Params) -> FixType:
    stddev = params.number("stddev", 0.0, minimum=0.0, maximum=_MOST)
    return FixType(
        status=STATUSES[params.choice("status", tuple(STATUSES), "fix")],
        weight=params.number("probability", 1.0, minimum=0.0, maximum=1.0),
        stddev=stddev,
        vertical_stddev=params.number("vertical_stddev", stddev, minimum=0.0, maximum=_MOST),
        satellites=params.integer("satellites", 0, minimum=0, maximum=65535),
        areas=read_areas(params),
    )


def without_fix(reading: NavSatReading) -> NavSatReading:
    """Return a reading without a position: status -1, NaN in all numbers."""
    nan = math.nan
    return NavSatReading(reading.east, reading.north, nan, nan, nan, np.full(3, nan), status=NO_FIX)


class MultipathState(NamedTuple):
    """State of `GnssMultipath`: error in standard deviations, place, and the standard deviations at this place [m]."""

    errors: Numbers
    place: Place
    stddevs: tuple[float, float]


class GnssMultipath(ReceiverArtefact):
    """`<simkit:multipath>` of a satellite receiver: reflections shift the position in some areas.

    The shift is a Gauss-Markov process in time and place: after the time t and the distance d its correlation is
    exp(-t/T - d/L). A receiver does not know the shift, so the covariance of the message does not contain it.

    Args:
        params: the element: `stddev` and `vertical_stddev` [m], `correlation_time` T [s], `correlation_length` L [m],
            0 for no dependence on the place, and any number of `area`, which may have other standard deviations;
            without an area, the shift is everywhere.
        sensor: the receiver.
    """

    elements = ("navsat/multipath",)
    order = 22.0

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self.stddevs = _read_stddevs(params, (0.0, 0.0))
        self.time = params.number("correlation_time", 60.0, minimum=1e-6, maximum=_LONGEST)
        self.length = params.number("correlation_length", 0.0, minimum=0.0, maximum=_LONGEST)
        self.is_everywhere = not params.has("area")
        blocks = zip(params.all("area"), read_areas(params), strict=False)
        self.areas = [(area, _read_stddevs(block, self.stddevs)) for block, area in blocks]

    def next_state(self, place: Place, index: int, dt: float) -> MultipathState:
        state: MultipathState | None = self.state
        normals = self.normals(index)
        if state is not None:
            distance = math.hypot(place.x - state.place.x, place.y - state.place.y)
            exponent = dt / self.time + (distance / self.length if self.length > 0 else 0.0)
            normals = next_correlated(state.errors, normals, exponent)
        return MultipathState(normals, place, self._stddevs_at(place))

    def _stddevs_at(self, place: Place) -> tuple[float, float]:
        if self.is_everywhere:
            return self.stddevs
        found = [stddevs for area, stddevs in self.areas if area.contains(place)]
        return max(found, default=(0.0, 0.0))

    def apply(self, reading: NavSatReading, truth: NavSatReading, index: int) -> NavSatReading:
        (east, north, up), (stddev, vertical) = self.state.errors, self.state.stddevs
        if reading.status == NO_FIX or not (stddev or vertical):
            return reading
        return self.moved(reading, stddev * east, stddev * north, vertical * up)


def _read_stddevs(params: Params, default: tuple[float, float]) -> tuple[float, float]:
    """Return the horizontal and vertical standard deviation [m]."""
    if not params.has("stddev"):
        return default[0], params.number("vertical_stddev", default[1], minimum=0.0, maximum=_MOST)
    stddev = params.number("stddev", 0.0, minimum=0.0, maximum=_MOST)
    return stddev, params.number("vertical_stddev", stddev, minimum=0.0, maximum=_MOST)


class OutageState(NamedTuple):
    """State of `Outages`.

    Attributes:
        is_random: True in an outage that the seed draws.
        is_blocked: True without satellites.
        search: time [s] until the first fix after an outage; 0 with a fix.
        age: time [s] since the first fix after an outage.
        drawn: number of the sample of this fix, which draws its error; 0 before the first outage.
    """

    is_random: bool
    is_blocked: bool
    search: float
    age: float
    drawn: int


class Outages(ReceiverArtefact):
    """`<simkit:outages>` of a satellite receiver: no fix at some times, in some areas, and at random.

    After an outage, the receiver needs a time until its first fix, whose error decays.

    Args:
        params: the element: any number of `window`, begin and end [s]; any number of `area`; `rate` [1/s] of random
            outages while there is none, and their `mean_duration` [s]; `time_to_fix` and `time_to_fix_stddev` [s]
            after an outage; `fix_error`, the standard deviation per axis [m] of the first fix, and `settling_time`
            [s], in which its error falls to 1/e.
        sensor: the receiver.
    """

    elements = ("navsat/outages",)
    order = 30.0

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self.windows = [block.vector("window", 2) for block in params.each("window")]
        for block, (begin, end) in zip(params.all("window"), self.windows, strict=True):
            if begin >= end:
                message = f"found <window>{block.value}</window>; expected the begin before the end [s]"
                block.error("SK-SENSOR-249", message)
        self.areas = read_areas(params)
        self.rate = params.number("rate", 0.0, minimum=0.0, maximum=1e3)
        self.mean_duration = params.number("mean_duration", 10.0, minimum=1e-3, maximum=_LONGEST)
        self.time_to_fix = params.number("time_to_fix", 0.0, minimum=0.0, maximum=_LONGEST)
        self.time_to_fix_stddev = params.number("time_to_fix_stddev", 0.0, minimum=0.0, maximum=_LONGEST)
        self.fix_error = params.number("fix_error", 0.0, minimum=0.0, maximum=_MOST)
        self.settling_time = params.number("settling_time", 10.0, minimum=1e-3, maximum=_LONGEST)

    def next_state(self, place: Place, index: int, dt: float) -> OutageState:
        before: OutageState = self.state or OutageState(False, False, 0.0, 0.0, 0)
        is_random = self._is_random(before.is_random, index, dt)
        now = self.sensor.sim.time_ns * 1e-9
        is_blocked = is_random or any(begin <= now < end for begin, end in self.windows)
        is_blocked = is_blocked or any(area.contains(place) for area in self.areas)
        if is_blocked:
            return OutageState(is_random, True, 0.0, 0.0, 0)
        if before.is_blocked:
            normal = float(self._stream.normal(index)[3])
            search = max(0.0, self.time_to_fix + self.time_to_fix_stddev * normal)
        elif before.search > 0:
            search = max(0.0, before.search - dt)
        else:
            return OutageState(is_random, False, 0.0, before.age + dt, before.drawn)
        # a remainder of rounding errors is no further sample without a fix
        search = search if search > 1e-9 else 0.0
        return OutageState(is_random, False, search, 0.0, 0 if search > 0 else index)

    def _is_random(self, was_out: bool, index: int, dt: float) -> bool:
        """Return the next state of a process with two states that begin and end at constant rates."""
        if self.rate == 0.0:
            return False
        end = 1.0 / self.mean_duration
        total = self.rate + end
        share = self.rate / total
        # exact for any time between two samples; at the first sample, the share of all times
        memory = float(exp(-total * dt)) if self.state is not None else 0.0
        probability = share + ((1.0 if was_out else 0.0) - share) * memory
        return self.shares(index)[0] < probability

    def apply(self, reading: NavSatReading, truth: NavSatReading, index: int) -> NavSatReading:
        state: OutageState = self.state
        if state.is_blocked or state.search > 0:
            return without_fix(reading)
        if reading.status == NO_FIX or not (state.drawn and self.fix_error):
            return reading
        size = self.fix_error * float(exp(-state.age / self.settling_time))
        east, north, up = self.normals(state.drawn)
        return self.moved(reading, size * east, size * north, size * up)
