"""Sampling by drawing: compose the scene when a sample is due, draw on the render thread, finish when read."""

from __future__ import annotations

import abc
import functools
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import mujoco

from simkit.diagnostics import Diagnostics
from simkit.errors import RenderError
from simkit.msgs.message_types import M, Message
from simkit.runtime import Publisher
from simkit.runtime.array_rules import CannotBatchError
from simkit.runtime.communication.subscription import NO_MESSAGE, LazyMessage
from simkit.runtime.particle_clouds import has_sources
from simkit.scene import SceneSensor
from simkit.sensors.base import Sample, Sensor
from simkit.sensors.cameras import renderer_choice
from simkit.sensors.cameras.camera_options import CameraOptions
from simkit.sensors.cameras.renderer_choice import ImageRenderer
from simkit.sensors.cameras.rendering import render_thread
from simkit.sensors.cameras.rendering.lights_and_shadows import read_lights, use_lights
from simkit.sensors.cameras.rendering.scene_composition import Composition
from simkit.sensors.cameras.rendering.view import DrawnView, Shot
from simkit.sensors.measured_rows import MeasuredRows
from simkit.sensors.particle_echoes import drawer_of_particles
from simkit.sensors.sample import Memory, Reading


class RenderedSampler(Sensor[M]):
    """Sensor whose readings are made of drawn images.

    The scene is composed from the state when a sample is due. The render thread draws it and processes the images, if
    the simulation has a render thread and no callback waits for the messages. Without a renderer, the sensor switches
    off with one report, and the simulation continues.

    Attributes:
        surroundings: state besides the physics for the current sample, see `capture_surroundings`.
    """

    needs_renderer = True
    is_deferred = True
    options: CameraOptions
    _hidden_geoms: Sequence[int]

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        self._failure: RenderError | None = None
        self._picture_error: RenderError | None = None  # error of an image, possibly on the render thread
        self._has_callback = False
        self.surroundings: Memory = None

    @abc.abstractmethod
    def shots(self) -> Sequence[Shot]:
        """Return the views to draw for one sample."""

    def finish_samples(self) -> None:
        """Measure the samples that wait for a reader, before the state that they depend on changes."""
        try:
            for sample in self._kept_samples():
                self._finish_sample(sample)
        except RenderError:
            self._drop_samples()

    def leave(self) -> None:
        self.finish_samples()
        self.surroundings = None

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> object:
        self.surroundings = self.capture_surroundings()
        return render_thread.run_now(self._make_exposure(model, data)).result()

    def capture(self, model: mujoco.MjModel, data: mujoco.MjData) -> render_thread.RenderJob:
        """Compose the scene, and draw it on the render thread, or at once if a callback waits for it."""
        expose = self._make_exposure(model, data)
        # the first image is drawn here, so that a missing renderer is detected at once
        if self._has_callback or not (self.sim.engine.render_thread and renderer_choice.is_ready(self.sim)):
            return render_thread.run_now(expose)
        return render_thread.submit(expose)

    def capture_other(self, model: mujoco.MjModel, data: mujoco.MjData) -> render_thread.RenderJob:
        self.surroundings = self.capture_surroundings()
        return self.capture(model, data)

    def capture_held(self, model: mujoco.MjModel, data: mujoco.MjData, sample: Sample) -> render_thread.RenderJob:
        # labels, temperatures, lights and structure may have changed since the sample
        self.surroundings, lights = sample.surroundings
        with use_lights(model, data, lights):
            expose = self._make_exposure(model, data)
        return render_thread.run_now(expose)

    def finish(self, raw: render_thread.RenderJob) -> object:
        return raw.result()

    def _make_exposure(self, model: mujoco.MjModel, data: mujoco.MjData) -> Callable[[], Reading]:
        """Return a function that draws and processes the images of a state without reading the state again."""
        renderer = renderer_choice.renderer_of(self.sim)
        smooth = self.options.anti_aliasing > 0
        composition = renderer.composer.compose(
            model,
            data,
            *self._frame_in_world(data),
            self._particle_drawer(float(data.time)),
            unseen=self._hidden_geoms,
            smooth=smooth,
        )
        return functools.partial(self._expose, renderer, composition, self.shots(), self.capture_context(model, data))

    def _particle_drawer(self, time: float) -> Callable[[mujoco.MjvScene], None] | None:
        """Return the function that draws the particles; None without, or if the sensor reads which geom is seen."""
        if not has_sources(self.sim) or any(shot.ids for shot in self.shots()):
            return None
        return drawer_of_particles(self.sim, time)

    def _expose(
        self, renderer: ImageRenderer, composition: Composition, shots: Sequence[Shot], context: Memory
    ) -> Reading:
        drawn_views = renderer.draw_all(composition, shots)
        try:
            return self.make_reading(drawn_views, context)
        except RenderError as error:
            self._picture_error = error
            raise
        finally:
            drawn_views.close()

    def capture_surroundings(self) -> Memory:
        """Return the state besides the physics that a sample depends on; `capture_context` reads `surroundings`."""
        return None

    def _begin_sample(self, tick: int) -> Sample:
        sample = super()._begin_sample(tick)
        self.surroundings = self.capture_surroundings()
        sample.surroundings = self.surroundings, read_lights(self.sim.mj_model)
        return sample

    def capture_context(self, model: mujoco.MjModel, data: mujoco.MjData) -> Memory:
        """Return the values of the state that `make_reading` needs besides images."""
        return None

    @abc.abstractmethod
    def make_reading(self, drawn_views: Iterator[DrawnView], context: Memory) -> object:
        """Return the reading without noise, made from the drawn images.

        Args:
            drawn_views: one drawn view of each shot, in their order, drawn one by one as they are read.
            context: result of `capture_context`.
        """

    def close(self) -> None:
        render_thread.drain()
        renderer_choice.free_renderer(self.sim)

    # ------------------------------------------------------------------ without a renderer

    def check_available(self) -> None:
        """Open the renderer, so that a reader of the images gets an error at once instead of no image.

        Raises:
            RenderError: the simulation requests OpenGL, which is missing.
        """
        try:
            renderer_choice.check_available(self.sim)
        except RenderError as error:
            message = f"camera {self.scoped!r} has no images: {error.message}"
            raise RenderError(error.code, message, self.scene.where) from None

    def sample(self, tick: int) -> None:
        if self._failure is not None:
            return
        if self._picture_error is not None:
            self._switch_off(self._picture_error)
            return
        try:
            super().sample(tick)
        except RenderError as error:
            self._switch_off(error)

    def take_held(self) -> None:
        try:
            super().take_held()
        except RenderError as error:
            self._switch_off(error)

    def _update_readers(self) -> None:
        super()._update_readers()
        # a callback of a delayed sample does not wait at the time of the sample
        is_live = any(publisher.is_live for _, publisher, needs_reading in self._read_publishers if needs_reading)
        self._has_callback = self._delayed is None and is_live

    def _publish(self, sample: Sample, read_publishers: list[tuple[str, Publisher, bool]]) -> list[LazyMessage]:
        deferred = super()._publish(sample, read_publishers)
        drawing = self._pending_job(sample)
        # messages that a reader certainly reads are made as soon as the image is drawn, all others only when read
        awaited = [later for later in deferred if later.is_awaited]
        if drawing is not None and awaited:
            sample.work = render_thread.submit(functools.partial(_make_messages_early, drawing, awaited))
            for later in deferred:
                later.work = sample.work
        return deferred

    def _pending_job(self, sample: Sample) -> render_thread.RenderJob | None:
        drawing: render_thread.RenderJob | None = sample.raw
        return None if drawing is None or drawing.is_at_once else drawing

    def _message(self, sample: Sample, product: str) -> Message:
        if sample.work is not None and self._products[product].needs_reading:
            sample.work.wait()
        return super()._message(sample, product)

    def _message_on_demand(self, sample: Sample, product: str) -> object:
        try:
            return super()._message_on_demand(sample, product)
        except RenderError:
            return NO_MESSAGE  # the reason was already reported

    @property
    def latest(self) -> M | Any:
        """Newest image, or None before the first.

        Raises:
            RenderError: there is no renderer.
        """
        if self._failure is not None:
            raise self._failure
        return super().latest

    @property
    def truth(self) -> M | Any:
        """Newest image without noise, or None before the first.

        Raises:
            RenderError: there is no renderer.
        """
        if self._failure is not None:
            raise self._failure
        return super().truth

    def _finish_sample(self, sample: Sample) -> None:
        if sample.work is not None:
            sample.work.wait()
        try:
            super()._finish_sample(sample)
        except RenderError as error:
            self._switch_off(error)
            raise

    def _switch_off(self, error: RenderError) -> None:
        if self._failure is not None:
            return
        self._failure = error
        self._drop_samples()
        is_known = any(d.code == error.code and d.message.endswith(error.message) for d in self.sim.engine.reports)
        message = f"camera {self.scoped!r} is switched off: {error.message}"
        self.sim.engine.reports.warning(error.code, message, self.scene.where)
        if not is_known:  # an error common to all cameras is logged once
            self.sim.engine.log.error("%s %s", error.code, message)


def camera_rule(camera: RenderedSampler) -> MeasuredRows:
    """Return the array rule of a camera, which draws the simulations one after another with one renderer.

    Raises:
        CannotBatchError: particles are in front of the camera.
    """
    if has_sources(camera.sim):
        raise CannotBatchError(f"particles in front of sensor {camera.scoped!r}")
    return MeasuredRows(camera)


def _make_messages_early(work: render_thread.RenderJob, messages: Sequence[LazyMessage]) -> None:
    """Make the messages of an image that is already drawn."""
    work.result()
    for message in messages:
        message.get()
