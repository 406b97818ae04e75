"""World plugin that moves a directional light like the sun, by date, time and location."""

from __future__ import annotations

import math
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from simkit.install_command import install_command
from simkit.params import Params
from simkit.plugins.base import WorldPlugin
from simkit.plugins.find_entities import find_light
from simkit.plugins.options import Options, OptionsOf, number, text
from simkit.plugins.world.sun_position import Site, SunPath, clear_sky
from simkit.pose import Pose
from simkit.scene import Atmosphere, SceneWorld, SphericalCoordinates
from simkit.sensors.environment.atmosphere import air_column

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Light, Simulation
    from simkit.runtime.handles.light import LightState
    from simkit.scene.geometry import Vec3

_DISTANCE = 149_597_870_700.0  # [m], one astronomical unit
_MOST_KELVIN = 1000.0
_FASTEST = 1e6  # largest number of seconds that the sun advances per simulated second: a year in half a minute
_LOWEST, _HIGHEST = -500.0, 11_000.0  # [m]
_DATE = "a date and time such as 2024-06-21T10:30:00Z (UTC without an offset)"


class SunOptions(Options):
    """Options of `Sun`."""

    start: str = text()
    time_scale: float = number(1.0, minimum=0, maximum=_FASTEST)
    update_rate: float = number(10.0, "Hz", minimum=0)
    latitude_deg: float = number(0.0, "deg", minimum=-90.0, maximum=90.0)
    longitude_deg: float = number(0.0, "deg", minimum=-360.0, maximum=360.0)
    elevation: float = number(0.0, "m", minimum=-500.0, maximum=11000.0)
    heading_deg: float = number(0.0, "deg", minimum=-360.0, maximum=360.0)
    pressure: float = number(unit="Pa", minimum=0.0, maximum=1000000.0)
    temperature: float = number(285.15, "K", minimum=1.0, maximum=_MOST_KELVIN)
    irradiance: str = text("clear_sky")
    light_name: str = text()


class Sun(WorldPlugin):
    """Moves a directional light like the sun: its pose, direction, on/off state and irradiance.

    `<start>` (required) is the date and time at the start of the simulation, in ISO 8601; without an offset the time is
    UTC. The machine's clock is never used. `<light_name>` is the light, by default the world's first directional light.
    `<time_scale>` is the number of seconds that the sun advances per simulated second, by default 1. The location is
    the world's `<spherical_coordinates>`; the plugin's own `<latitude_deg>`, `<longitude_deg>`, `<elevation>` [m] and
    `<heading_deg>` override it. `<irradiance>` is `clear_sky` (default) or a number [W/m²]. `<pressure>` [Pa] and
    `<temperature>` [K] of the air determine the refraction and the light of a clear sky. Their defaults are the
    standard atmosphere's pressure at the elevation, and 285.15 K. `<update_rate>` [Hz] is the rate at which the drawn
    light moves, by default 10. Sensors that measure the light use the sun's exact position at their own time.
    """

    reads_at_load = ("direction", "direction_world", "irradiance", "on")
    options = OptionsOf(SunOptions)
    names = ("simkit::Sun",)
    filenames = ("simkit-sun",)

    def prepare(self, scene: SceneWorld, params: Params, builder: SpecBuilder) -> None:
        from simkit.sensors.environment.solar_irradiance import read_irradiance

        self._start = _start(self.options)
        self._scale = self.options.time_scale
        self.before_step_rate = self.options.update_rate
        self._site = _site(self.options, scene.spherical_coordinates)
        self._irradiance = read_irradiance(params, self.options.irradiance, "clear_sky")
        self._path: SunPath | None = None
        try:
            self._path = SunPath(self._site)
        except ImportError as error:
            message = f"the sun's position needs pvlib: {error}"
            params.diagnostics.error("SK-SENSOR-084", message, self.where, install_command("sun"))

    def load(self, parent: Simulation, params: Params) -> None:
        self._light = _find_sun(self.sim, self.options)
        self._known: tuple[int, LightState] | None = None
        if self._light is None or self._path is None:
            return
        self._outshone = self._light.state
        self._light.follow(self.state)

    def before_step(self) -> None:
        if self._light is not None:
            self._light.draw()

    def state(self, time_ns: int) -> LightState:
        """Return pose, on/off state and irradiance of the light at a simulated time [ns]."""
        from simkit.runtime.handles.light import LightState

        if self._known is None or self._known[0] != time_ns:
            assert self._path is not None and self._light is not None
            sun = self._path.at(self._start + self._scale * time_ns * 1e-9)
            shines = sun.elevation > 0.0
            irradiance = self._irradiance
            if irradiance is None:
                irradiance = clear_sky(sun.elevation, self._site.pressure)
            x, y, z = sun.direction.tolist()
            turn = _shortest_rotation(self._light.scene.direction, (-x, -y, -z))
            pose = Pose(_DISTANCE * sun.direction, turn)
            on = shines and self._outshone.on
            self._known = time_ns, LightState(pose, on, irradiance if shines else 0.0)
        return self._known[1]


def _start(options: SunOptions) -> float:
    """Return `<start>` in seconds since 1970-01-01 UTC."""
    text, params = options.start, options.params
    if not text:
        params.error("SK-PARAM-001", f"<{params.name}> needs <start>: {_DATE}")
        return 0.0
    try:
        moment = datetime.fromisoformat(text)
        return (moment if moment.tzinfo else moment.replace(tzinfo=UTC)).timestamp()
    except (ValueError, OverflowError):
        params.block("start").error("SK-PARAM-002", f"found <start>{text}</start>; expected {_DATE}")
        return 0.0


def _site(options: SunOptions, world: SphericalCoordinates | None) -> Site:
    """Return the location in the plugin's parameters, or else the world's location."""
    params = options.params
    has_angles = params.has("latitude_deg"), params.has("longitude_deg")
    if world is None and not all(has_angles):
        hint = "or add <spherical_coordinates> to the world"
        params.error("SK-PARAM-001", f"<{params.name}> needs <latitude_deg> and <longitude_deg> [degrees]", hint)
    elif world is not None and world.surface != "EARTH_WGS84":
        message = f"the sun of the Earth is used; <surface_model> {world.surface} is ignored"
        params.diagnostics.warning("SK-SENSOR-085", message, world.where)

    def angle(name: str, default: float, most: float) -> float:
        return math.radians(params.number(name, math.degrees(default), minimum=-most, maximum=most))

    elevation = params.number("elevation", world.elevation if world else 0.0, minimum=_LOWEST, maximum=_HIGHEST)
    if not params.has("elevation") and not _LOWEST <= elevation <= _HIGHEST:
        message = f"the world's <elevation> is {elevation:g} m; the sun needs one from {_LOWEST:g} to {_HIGHEST:g} m"
        params.error("SK-PARAM-002", message, "or add <elevation> to the plugin")
        elevation = 0.0
    return Site(
        latitude=angle("latitude_deg", world.latitude if world else 0.0, 90),
        longitude=angle("longitude_deg", world.longitude if world else 0.0, 360),
        elevation=elevation,
        heading=angle("heading_deg", world.heading if world else 0.0, 360),
        pressure=params.number("pressure", air_column(Atmosphere()).at(elevation).pressure, minimum=0, maximum=1e6),
        temperature=options.temperature,
    )


def _find_sun(sim: Simulation, options: SunOptions) -> Light | None:
    """Return the light to move, or None after an error."""
    name, params = options.light_name, options.params
    suns = [
        light for light in sim.contents.lights.values() if light.scene.type == "directional" and not light.scene.link
    ]
    if not name:
        if not suns:
            params.error("SK-PLUGIN-003", "the world has no directional light for the sun", "add model://sun")
        return suns[0] if suns else None
    light = find_light(sim, name, params)
    if light is None or light in suns:
        return light
    what = f"on the link {light.scene.link!r}" if light.scene.link else f"a {light.scene.type} light"
    params.error("SK-PLUGIN-003", f"light {name!r} is {what}; the sun needs a directional light of the world")
    return None


def _shortest_rotation(start: Vec3, end: Vec3) -> tuple[float, float, float, float]:
    """Return the shortest rotation (w, x, y, z), of any length, from one unit vector to another."""
    (ax, ay, az), (bx, by, bz) = start, end
    w = 1.0 + ax * bx + ay * by + az * bz
    if w < 1e-12:
        # a half turn about any perpendicular axis
        return (0.0, 0.0, az, -ay) if abs(ax) < 0.9 else (0.0, -az, 0.0, ax)
    return (w, ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)
