"""Wind on boats: `vrx::USVWind` of VRX, and its plugin `libusv_gazebo_wind_plugin.so` for Gazebo Classic.

The speed of the wind is its mean plus a first-order process: with the gain K, the time constant τ, the step dt and a
standard normal number N, the variable part of the next step is v·exp(-dt/τ) + K·√(1 - exp(-2dt/τ))·N. Its standard
deviation is K for every step; VRX uses an approximation that diverges for τ < dt/2. With the velocity (u, v) of the air
relative to a link, in the axes of the link, the force is (c_x·u·|u|, c_y·v·|v|) and the torque about z is -2·c_z·u·v
(A. Sarda, H. Qu, I. Bertaska and K. von Ellenrieder, "Station-keeping control of an unmanned surface vehicle exposed to
current and wind disturbances", 2016).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, ClassVar, Final

import numpy as np

from simkit import Params, WorldPlugin, msgs
from simkit.extend import (
    LARGEST,
    NEVER,
    Options,
    OptionsOf,
    blocks,
    did_you_mean,
    integer,
    number,
    publishes,
    text,
    vector3,
)
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, moving_data

if TYPE_CHECKING:
    from simkit import Simulation

_SPEED, _DIRECTION = "/vrx/debug/wind/speed", "/vrx/debug/wind/direction"
_FLOAT: Final = "std_msgs/msg/Float32"
_DOUBLE: Final = "std_msgs/msg/Float64"


class WindObjectOptions(Options):
    """Options of a `<wind_obj>`: a link that the wind pushes."""

    model: str = text(element="name", required=True)
    link_name: str = text(required=True)
    coefficients: tuple[float, float, float] = vector3((0.0, 0.0, 0.0), element="coeff_vector", required=True)


class UsvWindOptions(Options):
    """Options of the wind on boats."""

    objects: tuple[WindObjectOptions, ...] = blocks(WindObjectOptions, element="wind_obj")
    wind_direction: float = number(0.0, "deg", minimum=-1e6, maximum=1e6)
    wind_mean_velocity: float = number(0.0, "m/s", minimum=-1e4, maximum=1e4)
    gain: float = number(0.0, "m/s", element="var_wind_gain_constants", minimum=0, maximum=1e4)
    time_constant: float = number(0.1, "s", element="var_wind_time_constants", minimum=1e-6, maximum=LARGEST)
    random_seed: int = integer(0)
    update_rate: float = number(10.0, "Hz", minimum=-1.0, maximum=1e6)
    speed_topic: str = text(_SPEED, element="topic_wind_speed")
    direction_topic: str = text(_DIRECTION, element="topic_wind_direction")


class UsvWindBase(WorldPlugin):
    """Base class of the wind plugins for boats.

    Attributes:
        message_type: Type of the published numbers.
    """

    options = OptionsOf(UsvWindOptions)
    message_type: ClassVar[str] = _DOUBLE

    def load(self, parent: Simulation, params: Params) -> None:
        options = self.options.read_all()
        for item in options.objects:
            item.read_all()
        angle = math.radians(options.wind_direction)
        self._direction = np.array((math.cos(angle), math.sin(angle), 0.0))
        self._gust = 0.0  # variable part of the speed [m/s]
        self._draw = self.random(f"gusts {options.random_seed}")
        self._speed = self.advertise(options.speed_topic, self.message_type)
        self._angle = self.advertise(options.direction_topic, self.message_type)
        self.after_step_rate = options.update_rate if options.update_rate > 0 else NEVER
        self._bind()
        names = list(parent.engine.names.links)
        for item in options.objects:
            if not any(_is_link(name, item) for name in names):
                text = f"plugin {self.name!r}: there is no link {item.link_name!r} of model {item.model!r} yet"
                hint = did_you_mean(f"{item.model}::{item.link_name}", names)
                params.diagnostics.warning("SK-PLUGIN-140", text, item.params.where, hint)

    def _bind(self) -> None:
        """Find the links of the compiled model; links of models that are spawned later are found then."""
        names = self.sim.engine.names.links
        coefficients: dict[str, tuple[float, float, float]] = {}
        for item in self.options.objects:
            link = next((name for name in names if _is_link(name, item)), None)
            if link is not None:
                coefficients[link] = item.coefficients
        self._links = PushedLinks(self.sim, tuple(coefficients))
        self._coefficients = np.array([coefficients[name] for name in self._links.names]).reshape(-1, 3)

    @property
    def _wind_speed(self) -> float:
        return float(self.options.wind_mean_velocity + self._gust)

    def before_step(self) -> None:
        """Change the speed of the wind, and push the links for the next step."""
        options, step = self.options, self.period
        if options.gain:
            ratio = step / options.time_constant
            noise = options.gain * math.sqrt(-math.expm1(-2 * ratio)) * float(self._draw.normal(self.sim.tick)[0])
            self._gust = math.exp(-ratio) * self._gust + noise
        if not self._links.is_current:
            self._bind()
        links = self._links
        if not len(links):
            return
        data = moving_data(self.sim)
        axes = links.axes(data)
        air = self._direction * self._wind_speed - links.velocities(data)
        u, v, _ = np.einsum("nij,ni->jn", axes, air)
        x, y, z = self._coefficients.T
        still = np.zeros(len(links))
        force = np.column_stack((x * u * np.abs(u), y * v * np.abs(v), still))
        torque = np.column_stack((still, still, -2 * z * u * v))
        links.push(data, np.einsum("nij,nj->ni", axes, force), np.einsum("nij,nj->ni", axes, torque))

    def after_step(self) -> None:
        """Publish speed and direction of the wind."""
        if self._speed.wanted:
            self._speed.publish(msgs.make(self.message_type, data=self._wind_speed))
        if self._angle.wanted:
            self._angle.publish(msgs.make(self.message_type, data=self.options.wind_direction))


def _is_link(scoped: str, item: WindObjectOptions) -> bool:
    """Check whether a scoped name is that of the link of a `<wind_obj>`, which may itself be scoped."""
    return scoped.split("::")[0] == item.model and f"::{scoped}".endswith(f"::{item.link_name}")


class UsvWind(UsvWindBase):
    """Pushes links by a wind of variable speed, with a coefficient for each axis of the link."""

    endpoints = (
        publishes(_SPEED, _FLOAT, named_by=("topic_wind_speed",)),
        publishes(_DIRECTION, _FLOAT, named_by=("topic_wind_direction",)),
    )
    filenames = ("libUSVWind.so",)
    names = ("vrx::USVWind",)
    message_type = _FLOAT


class UsvWindPlugin(UsvWindBase):
    """Pushes links by a wind of variable speed, with a coefficient for each axis of the link."""

    endpoints = (
        publishes(_SPEED, _DOUBLE, named_by=("topic_wind_speed",)),
        publishes(_DIRECTION, _DOUBLE, named_by=("topic_wind_direction",)),
    )
    filenames = ("libusv_gazebo_wind_plugin.so",)
