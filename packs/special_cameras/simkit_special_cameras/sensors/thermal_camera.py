"""Thermal cameras: the temperature at each pixel."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.compiler import Compiled
from simkit.extend import Diagnostics, Product, SceneSensor, Vector
from simkit.linear_algebra import matmul
from simkit.scene import Atmosphere
from simkit.sensors.cameras import image_messages
from simkit.sensors.cameras.camera_options import CameraOptions, extend_options
from simkit.sensors.cameras.rendered_camera import RenderedCamera
from simkit.sensors.cameras.rendering.view import DrawnView, Shot, View
from simkit.sensors.sample import Reading
from simkit_special_cameras.sensors.temperature_map import Kelvins, TemperatureMap, make_temperature_map

_FINE, _COARSE = 0.01, 3.0
"""Temperature steps [K] of images with 16 and with 8 bits per pixel, as in Gazebo."""

_BITS_BY_FORMAT: Final = {"L8": 8, "L_INT8": 8, "L16": 16, "L_INT16": 16}
_NEARER: Final = 0.1
"""Ratio of the drawn near plane to the file's: Gazebo shows objects nearer than the near plane too."""


@dataclass(frozen=True, slots=True)
class ThermalOptions(CameraOptions):
    """The `<camera>` block; clip planes in m, noise relative to the largest pixel value.

    Attributes:
        bits: bits of a pixel.
        resolution: temperature [K] of one step.
        coldest, hottest: range of measurable temperatures [K].
    """

    bits: int = 16
    resolution: float = _FINE
    coldest: float = 0.0
    hottest: float = math.inf


@dataclass(frozen=True, slots=True, eq=False)
class ThermalState:
    """State that a sample needs besides the image.

    Attributes:
        heat: temperatures of the world.
        views: position [m] and rotation of the camera in the frame of each surface with a heat texture.
    """

    heat: TemperatureMap
    views: tuple[tuple[Vector, Vector], ...]


class ThermalCamera(RenderedCamera):
    """Thermal camera, `thermal_camera`: temperatures as multiples of a resolution, in 16 or 8 bits.

    An object with a temperature of its own shows that temperature, uniform or by its heat signature. All other objects
    and the sky have the temperature of the air. As in Gazebo, their colour changes this temperature by up to half a
    span: black is colder, white is warmer. The span is the air's temperature gradient times the height of the view at
    its far plane.
    """

    kinds = ("thermal_camera", "thermal")
    reads_temperatures = True
    options: ThermalOptions

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        bits = _read_bits(scene, diagnostics)
        resolution = _COARSE if bits == 8 else _FINE
        self.options = extend_options(self.options, ThermalOptions, bits=bits, resolution=resolution)
        self._heat: TemperatureMap | None = None
        self._heat_of: tuple[object, object] = (None, None)

    def describe(self) -> dict[str, object]:
        """Return the description, with temperatures in K."""
        options = self.options
        return {**super().describe(), "thermal": {"bits": options.bits, "resolution": options.resolution}}

    def set_temperatures(self, coldest: float, hottest: float, resolution: float | None = None) -> None:
        """Set the range of measurable temperatures [K]; a resolution of None is not changed."""
        old = self.options
        self.options = replace(old, coldest=coldest, hottest=hottest, resolution=resolution or old.resolution)

    def prepare(self) -> None:
        air = self.sim.world.atmosphere or Atmosphere()
        self._air = air.temperature
        self._quirks = self.sim.world.gazebo_quirks
        self._temperature_gradient = abs(air.temperature_gradient)
        self._directions: Vector | None = None
        self._span = self._temperature_gradient * self._height_of_view()

    def bind(self, compiled: Compiled) -> None:
        super().bind(compiled)
        self._heat = None

    def _apply_model(self) -> None:
        super()._apply_model()
        self._span = self._temperature_gradient * self._height_of_view()
        self._directions = self._heat = None

    def leave(self) -> None:
        super().leave()
        self._heat, self._heat_of = None, (None, None)

    def _height_of_view(self) -> float:
        """Return the height of the frustum at its far plane [m]; Gazebo uses an integer aspect ratio (Sensors.cc)."""
        model = self.options.model
        aspect = model.width // model.height if self._quirks else model.width / model.height
        half = math.tan(model.hfov / 2)
        return 2.0 * model.far * (half / aspect if aspect else math.tan(math.pi / 2))

    def products(self) -> dict[str, Product]:
        return {"image": Product(image_messages.IMAGE_TYPE, self._thermal_message), "camera_info": self._info_product()}

    # ------------------------------------------------------------------ measuring

    def _drawn_view(self) -> View:
        view = super()._drawn_view()
        return replace(view, near=view.near * _NEARER)

    def shots(self) -> Sequence[Shot]:
        return (Shot(self._drawn_view(), ids=True),)

    def capture_surroundings(self) -> TemperatureMap:
        """Return the current temperatures of the world."""
        sim = self.sim
        state, structure = sim.contents.temperatures.state, sim.engine.structure
        if self._heat is None or self._heat_of[0] is not state or self._heat_of[1] is not structure:
            self._heat = make_temperature_map(sim, self._air, self._span)
            self._heat_of = state, structure
            table = self._heat.table
            if self._quirks:
                table[-1] -= self._span / 2  # the sky counts as black
                table[self._heat.is_source] = self._quantise_as_gazebo(table[self._heat.is_source])
        return self._heat

    def capture_context(self, model: mujoco.MjModel, data: mujoco.MjData) -> ThermalState:
        heat: TemperatureMap = self.surroundings
        views = []
        if heat.surfaces:
            position, rotation = self._frame_in_world(data)
            for surface in heat.surfaces:
                turn = matmul(data.xmat[surface.body].reshape(3, 3), surface.pose.matrix)
                origin = data.xpos[surface.body] + matmul(data.xmat[surface.body].reshape(3, 3), surface.pose.position)
                views.append((matmul(turn.T, position - origin), matmul(turn.T, rotation)))
        return ThermalState(heat, tuple(views))

    def make_reading(self, drawn_views: Iterator[DrawnView], context: ThermalState) -> Kelvins:
        """Return the temperatures [K], shape (height, width)."""
        drawn_view = next(drawn_views)
        assert drawn_view.ids is not None
        ids = self._pictures.distorter.distort_ids(drawn_view.ids) if self._pictures.distorter else drawn_view.ids
        kelvins = context.heat.table.take(ids, mode="wrap")
        if context.views:
            self._apply_heat_textures(kelvins, ids, context)
        options = self.options
        np.clip(kelvins, options.coldest, options.hottest, out=kelvins)
        return kelvins

    def _apply_heat_textures(self, kelvins: Kelvins, ids: npt.NDArray[np.int32], context: ThermalState) -> None:
        """Replace the temperatures of pixels on surfaces that have a heat texture."""
        if self._directions is None:
            x, y = self.options.model.directions()
            directions = np.stack((np.ones_like(x), -x, -y), axis=-1).reshape(-1, 3)
            self._directions = directions / np.linalg.norm(directions, axis=1, keepdims=True)
        flat = kelvins.reshape(-1)
        for index, pixels in context.heat.seen(ids):
            temperatures = context.heat.surfaces[index].temperatures(*context.views[index], self._directions[pixels])
            flat[pixels] = self._quantise_as_gazebo(temperatures) if self._quirks else temperatures

    def _quantise_as_gazebo(self, kelvins: Kelvins) -> Kelvins:
        """Round temperatures as Gazebo does: to 256 steps from 0 to the largest value of a pixel."""
        full = self._max_pixel_value() * self.options.resolution
        coarse: Kelvins = np.rint(np.clip(kelvins / full, 0, 1) * 255).astype(np.float32) * np.float32(full / 255)
        return coarse

    def perturb(self, reading: Reading, index: int) -> object:
        if self._pictures.noise.is_silent or self._quirks:  # Gazebo adds no noise
            return reading
        draws = self._pictures.noise.on_depths(np.zeros_like(reading), index)
        return reading + draws * np.float32(self._max_pixel_value() * self.options.resolution)

    # ------------------------------------------------------------------ messages

    def _max_pixel_value(self) -> int:
        return (1 << self.options.bits) - 1

    def _thermal_message(self, reading: Kelvins, time_ns: int) -> msgs.Image:
        options = self.options
        steps = np.clip(np.rint(reading / np.float32(options.resolution)), 0, self._max_pixel_value())
        pixels = steps.astype(np.uint8 if options.bits == 8 else "<u2")
        return image_messages.image_message(self._image_header(time_ns), pixels, f"mono{options.bits}")


def _read_bits(scene: SceneSensor, diagnostics: Diagnostics) -> int:
    """Read the bits of a pixel from its format; report a format of another kind of camera, and return 16 for it."""
    image = scene.params.block("camera").block("image")
    pixel_format = image.text("format", "").strip()
    if pixel_format and pixel_format not in _BITS_BY_FORMAT:
        message = f"<format> {pixel_format!r} has no effect on a thermal camera, whose images are L16 or L8"
        diagnostics.warning("SK-SENSOR-140", message, image.block("format").where)
    return _BITS_BY_FORMAT.get(pixel_format, 16)
