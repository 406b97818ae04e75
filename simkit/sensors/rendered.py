"""What all rendered cameras share."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.diagnostics import Diagnostics
from simkit.errors import RenderError
from simkit.msgs.topics import valid_topic
from simkit.sensors import camera_info, pictures
from simkit.sensors.base import Product, Sample, Sensor
from simkit.sensors.buffers import Spares
from simkit.sensors.camera_info import CameraInfoMaker
from simkit.sensors.camera_model import Distorter
from simkit.sensors.camera_options import CameraOptions, read_options
from simkit.sensors.image_noise import ImageNoise
from simkit.sensors.names import sibling_topic
from simkit.sensors.rendering.depths import clip_depths, metres
from simkit.sensors.rendering.renderer import free_renderer, renderer_of
from simkit.sensors.rendering.view import Film, Shot, View

if TYPE_CHECKING:
    from simkit.runtime import Simulation
    from simkit.scene import SceneSensor

_TRIGGER_TYPES = ("std_msgs/msg/Bool", "std_msgs/msg/Empty")


@dataclass(frozen=True)
class Picture:
    """Colours (h, w, 3), or brightness (h, w); depths (h, w) along the optical axis [m], None for a plain camera."""

    colours: npt.NDArray[np.uint8]
    depths: npt.NDArray[np.float32] | None


class NoisyPicture:
    """A picture with noise, drawn when it is asked for: who wants no depths pays for none."""

    def __init__(self, picture: Picture, noise: ImageNoise, index: int, near: float, far: float) -> None:
        self._picture, self._noise, self._index = picture, noise, index
        self._near, self._far = near, far

    @functools.cached_property
    def colours(self) -> npt.NDArray[np.uint8]:
        return self._noise.on_colours(self._picture.colours, self._index)

    @functools.cached_property
    def depths(self) -> npt.NDArray[np.float32] | None:
        if self._picture.depths is None:
            return None
        return clip_depths(self._noise.on_depths(self._picture.depths, self._index), self._near, self._far)


class RenderedSensor(Sensor):
    """A camera: looks along its x axis, y to its left, z up.

    Without a renderer it is switched off, which is said once; all else goes on.
    """

    has_depth: ClassVar[bool] = False
    options: CameraOptions

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        scene.params.child("camera")
        self.options = read_options(scene.params)
        self._failure: RenderError | None = None
        self._is_triggered = self._waits = False
        self._baseline = 0.0

    def describe(self) -> dict[str, Any]:
        model = self.options.model
        block = {"width": model.width, "height": model.height, "hfov": model.hfov, "near": model.near, "far": model.far}
        return {"camera": block}

    def attach(self, sim: Simulation) -> None:
        options = self.options
        self._noise = ImageNoise(options.noise, sim.streams, self.scoped)
        self._view: View | None = None
        self._info = CameraInfoMaker(options.model, self._baseline)
        size = options.model.height, options.model.width
        self._spare_colours, self._spare_depths = Spares((*size, 3), np.uint8), Spares(size, np.float32)
        super().attach(sim)
        if options.triggered:
            self.trigger_on(valid_topic(options.trigger_topic) if options.trigger_topic else self.topic + "/trigger")

    def _aimed(self) -> View:
        """The frustum; found out at the first picture, since a lens takes a while."""
        if self._view is None:
            model = self.options.model
            self._distorter = Distorter(model) if model.distortion else None
            # surfaces nearer than the range of depths are to be seen as such, not to be cut away
            near = min(model.near, self.options.depth_near) * 0.1 if self.has_depth else model.near
            self._view = model.view(near, self._distorter.margin if self._distorter else 0)
        return self._view

    def shots(self) -> Sequence[Shot]:
        """What is drawn for one sample."""
        return (Shot(self._aimed(), depth=self.has_depth),)

    def bound_depths(self, near: float | None, far: float | None) -> None:
        """Sets the range of depths [m]; None leaves an end as it is."""
        old = self.options
        near, far = old.depth_near if near is None else near, old.depth_far if far is None else far
        self.options = replace(old, depth_near=near, depth_far=far)
        self._view = None

    def set_baseline(self, baseline: float) -> None:
        """Says how far [m] the left camera of a stereo pair is; it shows in the projection matrix."""
        self._baseline = baseline
        self._info = CameraInfoMaker(self.options.model, baseline)

    def trigger_on(self, topic: str) -> None:
        """Takes pictures only when a message has come in on `topic`: one at the next due time."""
        self._waits = True
        self.sim.bus.listen(topic, _TRIGGER_TYPES, self._on_trigger)

    def _on_trigger(self, _: Any) -> None:
        self._is_triggered = True

    def accepts(self, tick: int) -> bool:
        if not self._waits:
            return True
        triggered, self._is_triggered = self._is_triggered, False
        return triggered

    def bind(self, compiled: Any) -> None:
        try:
            for sample in self._kept():
                self._settle(sample)
        except RenderError:
            self._drop()
        super().bind(compiled)
        renderer_of(self.sim).reserve(self.options.model.width, self.options.model.height)

    def measure(self, model: Any, data: Any) -> Any:
        renderer = renderer_of(self.sim)
        composition = renderer.compose(model, data, *self._frame_in_world(data))
        notes = self.note(model, data)
        return self.develop(renderer.films(composition, self.shots()), notes)

    def note(self, model: Any, data: Any) -> Any:
        """What `develop` needs of the state besides pictures."""
        return None

    def develop(self, films: Iterator[Film], notes: Any) -> Any:
        """The reading without noise, of what was drawn.

        Args:
            films: one of each shot, in their order; to be taken in turn.
            notes: what `note` gave.
        """
        options, film = self.options, next(films)
        colours, raw, view = film.colours, film.depths, film.view
        assert colours is not None
        depths = None
        if raw is not None:
            if self._distorter and self._distorter.margin:
                edge = self._distorter.margin
                raw = raw[edge:-edge, edge:-edge]
            far = options.depth_far if options.depth_far < view.far else np.inf
            depths = metres(raw, view.near, view.far, options.depth_near, far, self._spare_depths.take())
        if self._distorter:
            colours = self._distorter.bend(colours)
        if pictures.is_grey(options.encoding):
            colours = pictures.grey(colours)
        elif not self._distorter:
            kept = self._spare_colours.take()
            np.copyto(kept, colours)
            colours = kept
        return Picture(colours, depths)

    def perturb(self, reading: Picture, index: int) -> Any:
        if self._noise.is_silent:
            return reading
        return NoisyPicture(reading, self._noise, index, self.options.depth_near, self.options.depth_far)

    def memory(self) -> Any:
        return self._is_triggered

    def remember(self, memory: Any) -> None:
        self._is_triggered = memory

    def restart(self) -> None:
        self._is_triggered = False

    def close(self) -> None:
        free_renderer(self.sim)

    # ------------------------------------------------------------------ when there is no renderer

    def sample(self, tick: int) -> None:
        if self._failure is not None:
            return
        try:
            super().sample(tick)
        except RenderError as error:
            self._switch_off(error)

    @property
    def latest(self) -> Any | None:
        """The newest picture, or None before the first; raises RenderError where there is no renderer."""
        if self._failure is not None:
            raise self._failure
        return super().latest

    @property
    def truth(self) -> Any | None:
        """The newest picture without noise; raises RenderError where there is no renderer."""
        if self._failure is not None:
            raise self._failure
        return super().truth

    def _settle(self, sample: Sample) -> None:
        try:
            super()._settle(sample)
        except RenderError as error:
            self._switch_off(error)
            raise

    def _switch_off(self, error: RenderError) -> None:
        self._failure = error
        self._drop()
        message = f"camera {self.scoped!r} is switched off: {str(error).removeprefix(error.code).strip()}"
        self.sim.reports.warning(error.code, message, self.scene.where)
        self.sim.log.error("%s %s", error.code, message)

    # ------------------------------------------------------------------ messages

    def _header(self, time_ns: int) -> Any:
        return msgs.header(time_ns, self.frame_id)

    def _colour_product(self) -> Product:
        return Product(pictures.TYPE, self._colour_message)

    def _info_product(self) -> Product:
        return Product(camera_info.TYPE, self._info_message, needs_reading=False)

    def _colour_message(self, reading: Any, time_ns: int) -> Any:
        return pictures.colour_message(self._header(time_ns), reading.colours, self.options.encoding)

    def _info_message(self, _: Any, time_ns: int) -> Any:
        return self._info.make(time_ns, self.frame_id)

    def _info_topic(self, beside: str) -> str:
        given = self.options.info_topic
        return valid_topic(given) if given else sibling_topic(beside, "camera_info")
