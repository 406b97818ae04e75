"""Wind that pushes links: `gz::sim::systems::WindEffects` and Gazebo Classic's `libWindPlugin.so`."""

from __future__ import annotations

import math
from itertools import takewhile
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.base import NEVER, WorldPlugin
from simkit.plugins.endpoints import listens, offers
from simkit.plugins.fluids.link_forces import PushedLinks, moving_data
from simkit.plugins.fluids.wind_field import WindField, WindFieldOptions, read_field
from simkit.plugins.fluids.wind_gusts import GustOptions, WindTarget, read_gusts
from simkit.plugins.one_time_warnings import OneTimeWarnings
from simkit.plugins.options import OptionsOf, block

if TYPE_CHECKING:
    from collections.abc import Mapping

    import mujoco

    from simkit.pose import Vector
    from simkit.runtime import Simulation
    from simkit.runtime.engine.entity_structure import AttachedPlugin


WIND: Final = "simkit_msgs/msg/Wind"
VECTOR: Final = "geometry_msgs/msg/Vector3"
INFO: Final = "simkit_msgs/srv/WindInfo"
_FEW: Final = 8  # links, up to which plain numbers are faster than arrays
Velocity = tuple[float, float, float]


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
        return list(takewhile(lambda plugin: plugin is not self, self.sim.engine.structure.all_plugins()))

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
