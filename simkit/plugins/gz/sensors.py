"""Sensor systems of Gazebo: Sensors, which sets the colours of camera images, and Magnetometer.

simkit simulates sensors without these plugins.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from simkit.params import Params
from simkit.plugins.base import Plugin
from simkit.plugins.options import Options, OptionsOf, boolean, vector
from simkit.plugins.plugin_names import aliases
from simkit.scene import Scene, SceneModel, ScenePlugin, SceneWorld, Surroundings
from simkit.scene.model import Colour

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder

_COLOURS = {"background_color": "background", "ambient_light": "ambient"}
"""Parameter name -> colour of the scene."""


class SensorsSystemOptions(Options):
    """Options of `SensorsSystem`."""

    disable_on_drained_battery: bool = boolean()
    background_color: tuple[float, ...] = vector(None, size=4)
    ambient_light: tuple[float, ...] = vector(None, size=4)


class SensorsSystem(Plugin):
    """Sets the background and ambient colours of camera images, which replace the scene's colours.

    Sensors run without this plugin. With `<disable_on_drained_battery>`, cameras and GPU lidars of a model stop while
    its battery is empty. `with_sensors_colours` applies the colours before the world is built.
    """

    options = OptionsOf(SensorsSystemOptions)
    parent_kind = "any"
    lets_sleep = True
    filenames = ("gz-sim-sensors-system",)
    names = ("gz::sim::systems::Sensors",)
    stops_without_power = False

    def prepare(self, scene: object, params: Params, builder: SpecBuilder) -> None:
        elements = {child.name for child in params.children} - {"disable_on_drained_battery"}
        self.stops_without_power = self.options.disable_on_drained_battery
        params.mark_all_read()
        used: list[str] = []
        overridden: list[str] = []
        for name, place in _COLOURS.items():
            colour = _colour(params, name)
            if colour is not None:
                is_used = colour == getattr(builder.world.surroundings, place)
                (used if is_used else overridden).append(f"<{name}>")
        unused = [f"<{name}>" for name in sorted(elements - set(_COLOURS))]
        message = "plugin 'Sensors' is not needed: simkit simulates sensors without it"
        if used:
            message += f"; used instead of the scene's colours: {', '.join(used)}"
        if unused:
            message += f"; not used: {', '.join(unused)}"
        params.diagnostics.note("SK-PLUGIN-005", message, self.where)
        for name in overridden:
            message = f"{name} of plugin 'Sensors' has no effect: another setting defines the scene's colour"
            hint = "keep one Sensors plugin, in the world; --set scene.ambient and scene.background override it"
            params.diagnostics.warning("SK-PLUGIN-011", message, self.where, hint)

    def load(self, parent: object, params: Params) -> None:
        """Do nothing."""


def with_sensors_colours(scene: Scene) -> Scene:
    """Return the scene with the colours of its Sensors system, which override those of `<scene>`, as in Gazebo.

    The system may be in the world or, as in many robots, in a model.
    """
    worlds = tuple(_coloured(world, world.plugins, world.models) for world in scene.worlds)
    if any(new is not old for new, old in zip(worlds, scene.worlds, strict=True)):
        scene = replace(scene, worlds=worlds)
    if scene.model is not None:
        around = scene.around or SceneWorld()
        coloured = _coloured(around, (), (scene.model,))
        if coloured is not around:
            scene = replace(scene, around=coloured)
    return scene


def _coloured(world: SceneWorld, plugins: tuple[ScenePlugin, ...], models: tuple[SceneModel, ...]) -> SceneWorld:
    all_plugins = [
        *plugins,
        *(plugin for model in models for nested in model.all_models() for plugin in nested.plugins),
    ]
    colours: dict[str, Any] = {}
    for plugin in all_plugins:
        if _is_sensors_system(plugin):
            for name, place in _COLOURS.items():
                colour = _colour(plugin.params, name)
                if colour is not None:
                    colours.setdefault(place, colour)
    if not colours:
        return world
    around: Surroundings = replace(world.surroundings, **colours)
    return replace(world, surroundings=around)


def _is_sensors_system(plugin: ScenePlugin) -> bool:
    return any(name in (*SensorsSystem.filenames, *SensorsSystem.names) for name in aliases(plugin))


def _colour(params: Params, name: str) -> Colour | None:
    """Read a colour of three or four numbers from 0 to 1; None if it is missing or invalid."""
    element = params.child(name)
    if element is None:
        return None
    size = 4 if len(element.value.split()) > 3 else 3
    numbers = params.vector(name, size, (math.nan,) * size)
    if math.isnan(numbers[0]):  # params.vector has reported the error
        return None
    red, green, blue, alpha = (min(1.0, max(0.0, number)) for number in (*numbers, 1.0)[:4])
    return red, green, blue, alpha


class MagnetometerSystemOptions(Options):
    """Options of `MagnetometerSystem`."""

    use_units_gauss: bool = boolean(True)
    use_earth_frame_ned: bool = boolean(True)


class MagnetometerSystem(Plugin):
    """Reads the options of Gazebo's Magnetometer system.

    `<use_units_gauss>` and `<use_earth_frame_ned>` define the Earth's field. Gazebo's default for both is true. simkit
    applies this default only in a world with `<gazebo_quirks>`. In other worlds an option has an effect only if the
    file contains it.
    """

    options = OptionsOf(MagnetometerSystemOptions)
    parent_kind = "any"
    filenames = ("gz-sim-magnetometer-system",)
    names = ("gz::sim::systems::Magnetometer",)

    def prepare(self, scene: object, params: Params, builder: SpecBuilder) -> None:
        present = [name for name in self.options.fields() if params.has(name)]
        _ = self.options.use_units_gauss, self.options.use_earth_frame_ned
        if not present:
            message = "plugin 'Magnetometer' is not needed: simkit simulates magnetometers without it"
            params.diagnostics.note("SK-PLUGIN-005", message, self.where)

    def load(self, parent: object, params: Params) -> None:
        """Do nothing."""
