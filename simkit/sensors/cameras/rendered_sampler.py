"""Sampling by drawing: compose when a sample is due, draw on the render thread, finish when it is read."""

from __future__ import annotations

import abc
import functools
from collections.abc import Callable, Iterator, Sequence

import mujoco

from simkit.diagnostics import Diagnostics
from simkit.errors import RenderError
from simkit.msgs.message_types import Message
from simkit.runtime import Publisher
from simkit.runtime.communication.subscription import NO_MESSAGE, LazyMessage
from simkit.scene import SceneSensor
from simkit.sensors.base import Sample, Sensor
from simkit.sensors.cameras.camera_options import CameraOptions
from simkit.sensors.cameras.rendering import gl_context, render_thread
from simkit.sensors.cameras.rendering.lights_and_shadows import read_lights, use_lights
from simkit.sensors.cameras.rendering.renderer import Composition, Renderer, free_renderer, renderer_of
from simkit.sensors.cameras.rendering.view import Film, Shot
from simkit.sensors.sample import Memory, Reading


class RenderedSampler(Sensor):
    """A sensor whose readings are made of drawn pictures.

    What is to be drawn is taken of the state when a sample is due; drawing, and all that is made of the pictures,
    happens on the render thread where the simulation has one and nobody is called back with the messages.

    Without a renderer it is switched off, which is said once; all else goes on.

    Attributes:
        surroundings: what besides the physics the sample at work is made of, see `capture_surroundings`.
    """

    is_deferred = True
    options: CameraOptions
    _hidden_geoms: Sequence[int]

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        self._failure: RenderError | None = None
        self._picture_error: RenderError | None = None  # what went wrong with a picture, perhaps on the render thread
        self._has_callback = False
        self.surroundings: Memory = None

    @abc.abstractmethod
    def shots(self) -> Sequence[Shot]:
        """What is drawn for one sample."""

    def finish_samples(self) -> None:
        """Measures what waits to be looked at, before something that it is made of changes."""
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
        """Composes what is to be drawn, and has it drawn: on the render thread, unless somebody waits for it."""
        expose = self._make_exposure(model, data)
        # the first picture of all is drawn here, so that it is known at once whether there is a renderer
        if self._has_callback or not (self.sim.engine.render_thread and gl_context.is_open()):
            return render_thread.run_now(expose)
        return render_thread.submit(expose)

    def capture_held(self, model: mujoco.MjModel, data: mujoco.MjData, sample: Sample) -> render_thread.RenderJob:
        # labels, temperatures, lights and what is in the world may be others by now
        self.surroundings, lights = sample.surroundings
        with use_lights(model, data, lights):
            expose = self._make_exposure(model, data)
        return render_thread.run_now(expose)

    def finish(self, raw: render_thread.RenderJob) -> object:
        return raw.result()

    def _make_exposure(self, model: mujoco.MjModel, data: mujoco.MjData) -> Callable[[], Reading]:
        """What draws and develops the pictures of a state; it needs the state no more."""
        renderer = renderer_of(self.sim)
        smooth = self.options.anti_aliasing > 0
        composition = renderer.composer.compose(
            model, data, *self._frame_in_world(data), unseen=self._hidden_geoms, smooth=smooth
        )
        return functools.partial(self._expose, renderer, composition, self.shots(), self.take_notes(model, data))

    def _expose(self, renderer: Renderer, composition: Composition, shots: Sequence[Shot], notes: Memory) -> Reading:
        films = renderer.films(composition, shots)
        try:
            return self.develop(films, notes)
        except RenderError as error:
            self._picture_error = error
            raise
        finally:
            films.close()

    def capture_surroundings(self) -> Memory:
        """Return what a sample is made of besides the physics; `take_notes` reads it in `surroundings`."""
        return None

    def _begin_sample(self, tick: int) -> Sample:
        sample = super()._begin_sample(tick)
        self.surroundings = self.capture_surroundings()
        sample.surroundings = self.surroundings, read_lights(self.sim.mj_model)
        return sample

    def take_notes(self, model: mujoco.MjModel, data: mujoco.MjData) -> Memory:
        """What `develop` needs of the state besides pictures."""
        return None

    @abc.abstractmethod
    def develop(self, films: Iterator[Film], notes: Memory) -> object:
        """The reading without noise, of what was drawn.

        Args:
            films: one of each shot, in their order; to be taken in turn.
            notes: what `take_notes` gave.
        """

    def close(self) -> None:
        render_thread.drain()
        free_renderer(self.sim)

    # ------------------------------------------------------------------ when there is no renderer

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
        # what has a latency is not waited for when it is taken
        self._has_callback = self._delayed is None and any(end.is_live for _, end, needs in self._wanted if needs)

    def _publish(self, sample: Sample, wanted: list[tuple[str, Publisher, bool]]) -> list[LazyMessage]:
        put_off = super()._publish(sample, wanted)
        drawing = self._pending_job(sample)
        # what somebody will look at is made as soon as the picture is there; what may never be seen is not
        awaited = [later for later in put_off if later.is_awaited]
        if drawing is not None and awaited:
            sample.work = render_thread.submit(functools.partial(_make_messages_early, drawing, awaited))
            for later in put_off:
                later.work = sample.work
        return put_off

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
            return NO_MESSAGE  # it has been said why

    @property
    def latest(self) -> Message:
        """The newest picture, or None before the first; raises RenderError where there is no renderer."""
        if self._failure is not None:
            raise self._failure
        return super().latest

    @property
    def truth(self) -> Message:
        """The newest picture without noise; raises RenderError where there is no renderer."""
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
        why = str(error).removeprefix(error.code).strip()
        is_known = any(d.code == error.code and d.message.endswith(why) for d in self.sim.engine.reports)
        message = f"camera {self.scoped!r} is switched off: {why}"
        self.sim.engine.reports.warning(error.code, message, self.scene.where)
        if not is_known:  # what ails all cameras is said aloud once
            self.sim.engine.log.error("%s %s", error.code, message)


def _make_messages_early(work: render_thread.RenderJob, messages: Sequence[LazyMessage]) -> None:
    """Makes messages of a picture that was drawn before."""
    work.result()
    for message in messages:
        message.get()
