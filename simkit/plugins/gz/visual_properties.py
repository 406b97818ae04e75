"""Properties of visuals that cameras measure: labels and temperatures.

The systems are `gz::sim::systems::Label`, `gz::sim::systems::Thermal` and `gz::sim::systems::ThermalSensor`.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from simkit.loaders.meshes.companion_files import read_pixels
from simkit.loaders.meshes.mesh_part import MeshFileError
from simkit.params import Params
from simkit.plugins.base import Plugin, SensorPlugin
from simkit.plugins.options import Options, OptionsOf, integer, number, text
from simkit.runtime.handles.visual import MAX_LABEL, HeatSignature, Temperature
from simkit.scene import Atmosphere, SceneModel, SceneVisual

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model, Simulation, Visual
    from simkit.sensors.base import Sensor

_WITHOUT_EFFECT = "SK-SENSOR-141"


class ThermalOptions(Options):
    """Options of `Thermal`."""

    heat_signature: str = text()
    temperature: float = number(None, "K")
    min_temp: float = number(None, "K")
    max_temp: float = number(None, "K")


class Thermal(Plugin):
    """Sets the temperature [K] of its visual, or an image of temperatures on its surface.

    On a model or a link, the plugin sets the temperature of every visual there that has no temperature of its own.
    Gazebo ignores such a plugin.
    """

    options = OptionsOf(ThermalOptions)
    parent_kind = ("visual", "model")
    lets_sleep = True
    filenames = ("gz-sim-thermal-system",)
    names = ("gz::sim::systems::Thermal",)

    def prepare(self, scene: SceneModel | SceneVisual, params: Params, builder: SpecBuilder) -> None:
        self._temperature: Temperature | None = None
        self._range: tuple[float | None, float | None] = (None, None)
        self._picture: Path | None = None
        if params.has("heat_signature"):
            if params.has("temperature"):
                params.child("temperature")
                message = "found both <temperature> and <heat_signature>: <heat_signature> is used, as in Gazebo"
                params.diagnostics.warning(_WITHOUT_EFFECT, message, params.block("temperature").where)
            self._range = _read_range(params)
            self._picture = _find_picture(self.options, builder)
        elif params.has("temperature"):
            self._temperature = _read_kelvins(params, "temperature")
            for name in ("min_temp", "max_temp"):
                if params.has(name):
                    message = f"<{name}> has no effect with <temperature>: it belongs to <heat_signature>"
                    params.diagnostics.warning(_WITHOUT_EFFECT, message, params.block(name).where)
        else:
            params.error("SK-PARAM-001", f"plugin {self.name!r} needs <temperature> [K] or <heat_signature>")
        if not self._has_place(scene, builder.world.gazebo_quirks):
            message = f"plugin {self.name!r} on {self.scoped!r} has no effect: it is not on a visual"
            params.diagnostics.warning(_WITHOUT_EFFECT, message, self.where, "move it into the <visual>")
            self._temperature = self._picture = None

    def _has_place(self, scene: SceneVisual | SceneModel, quirks: bool) -> bool:
        if isinstance(scene, SceneVisual):
            return True
        return not quirks and self.scoped in (scene.scoped, *(link.scoped for link in scene.links))

    def load(self, parent: object, params: Params) -> None:
        temperature = self._temperature
        if self._picture is not None:
            temperature = HeatSignature(self._picture, *_sorted_range(self._range, self.sim))
        if temperature is not None:
            self.sim.contents.temperatures[self.scoped] = temperature


def _read_kelvins(params: Params, name: str) -> float:
    temperature = params.number(name)
    if temperature < 0:
        message = f"found <{name}> {temperature:g}; expected at least 0 K: 0 is used, as in Gazebo"
        params.diagnostics.warning(_WITHOUT_EFFECT, message, params.block(name).where)
    return max(temperature, 0.0)


def _read_range(params: Params) -> tuple[float | None, float | None]:
    """Return the temperatures [K] of black and red pixels of a heat signature; None if an element is missing."""
    low, high = (_read_kelvins(params, name) if params.has(name) else None for name in ("min_temp", "max_temp"))
    if low is not None and high is not None and low > high:
        message = f"found <min_temp> {low:g} above <max_temp> {high:g}: the two are swapped, as in Gazebo"
        params.diagnostics.warning(_WITHOUT_EFFECT, message, params.block("min_temp").where)
    return low, high


def _find_picture(options: ThermalOptions, builder: SpecBuilder) -> Path | None:
    """Return the image file of a heat signature.

    Without a readable file, the surface gets the temperature of the air.
    """
    params, uri = options.params, options.heat_signature
    element = params.block("heat_signature")
    file = params.where.file  # not that of the element, which can be the text of an override
    path = builder.find_file(uri, Path(file).parent if file else None)
    problem = "is not found"
    if path is not None:
        try:
            read_pixels(path)
            builder.files_read.append(path)
            return path
        except MeshFileError as error:
            problem = str(error)
    element.warning("SK-SENSOR-142", f"heat signature {uri!r} {problem}; the surface gets the temperature of the air")
    return None


def _sorted_range(limits: tuple[float | None, float | None], sim: Simulation) -> tuple[float, float]:
    """Return the temperatures [K] of black and red pixels in rising order; None becomes the temperature of the air."""
    air = (sim.world.atmosphere or Atmosphere()).temperature
    low, high = (air if limit is None else limit for limit in limits)
    return min(low, high), max(low, high)


class ThermalSensorOptions(Options):
    """Options of `ThermalSensor`."""

    resolution: float = number()
    min_temp: float = number(0.0, "K", finite=False)
    max_temp: float = number(math.inf, "K", finite=False)


class ThermalSensor(SensorPlugin):
    """Sets the range [K] and the resolution [K] of a thermal camera."""

    options = OptionsOf(ThermalSensorOptions)
    filenames = ("gz-sim-thermal-sensor-system",)
    names = ("gz::sim::systems::ThermalSensor",)

    def load(self, parent: Sensor, params: Params) -> None:
        if not hasattr(parent, "set_temperatures"):
            self.refuse(parent, "thermal_camera")
            params.mark_all_read()
            return
        resolution = self._resolution(params)
        low = self.options.min_temp
        high = self.options.max_temp
        if low > high:
            message = f"found <min_temp> {low:g} above <max_temp> {high:g}: all temperatures are shown, as in Gazebo"
            params.diagnostics.warning(_WITHOUT_EFFECT, message, params.block("min_temp").where)
            low, high = 0.0, math.inf
        parent.set_temperatures(max(low, 0.0), high, resolution)

    def _resolution(self, params: Params) -> float | None:
        if not params.has("resolution"):
            return None
        resolution = self.options.resolution
        if resolution > 0:
            return resolution
        message = f"found <resolution> {resolution:g}; expected a number above 0: the default is used, as in Gazebo"
        params.diagnostics.warning(_WITHOUT_EFFECT, message, params.block("resolution").where)
        return None


class LabelOptions(Options):
    """Options of `Label`."""

    label: int = integer(minimum=0, maximum=MAX_LABEL, required=True)


class Label(Plugin):
    """Sets the label of a model or a visual: the number that segmentation and bounding box cameras publish.

    The label of a visual overrides the label of its model. The label of a nested model overrides the label of the outer
    model. If an element has two labels, the later label is used.
    """

    options = OptionsOf(LabelOptions)
    parent_kind = ("model", "visual")
    lets_sleep = True
    gives_labels: ClassVar[bool] = True
    filenames = ("gz-sim-label-system",)
    names = ("gz::sim::systems::Label",)

    def prepare(self, scene: SceneModel | SceneVisual, params: Params, builder: SpecBuilder) -> None:
        self._label = self.options.label
        self._is_misplaced = self.scoped != scene.scoped
        if self._is_misplaced:
            message = f"plugin {self.name!r} has no effect on {self.scoped!r}: it labels a model or a visual"
            params.diagnostics.warning("SK-PLUGIN-007", message, self.where, "move it into the <model> or a <visual>")

    def load(self, parent: Model | Visual, params: Params) -> None:
        if not self._is_misplaced:
            self.sim.contents.labels[parent.scoped] = self._label
