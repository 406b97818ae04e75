"""Sample by drawing: take what is to be drawn when a sample is due, draw it on the render thread, finish it later."""

from __future__ import annotations

import abc
import functools
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from simkit.diagnostics import Diagnostics
from simkit.errors import RenderError
from simkit.runtime.communication.topic_bus import NO_MESSAGE
from simkit.sensors.base import Sample, Sensor
from simkit.sensors.cameras.camera_options import CameraOptions
from simkit.sensors.cameras.rendering import gl_context, render_thread
from simkit.sensors.cameras.rendering.lights_and_shadows import read_lights, use_lights
from simkit.sensors.cameras.rendering.renderer import Composition, Renderer, free_renderer, renderer_of
from simkit.sensors.cameras.rendering.view import Film, Shot

if TYPE_CHECKING:
    from simkit.runtime import Publisher
    from simkit.runtime.communication.topic_bus import LazyMessage
    from simkit.scene import SceneSensor


class RenderedSampler(Sensor):
    """A sensor whose readings are made of drawn pictures.

    What is to be drawn is taken of the state when a sample is due; drawing, and all that is made of the pictures,
    happens on the render thread where the simulation has one and nobody is called back with the messages.

    Without a renderer it is switched off, which is said once; all else goes on.

    Attributes:
        around: what besides the physics the sample at work is made of, see `look_around`.
    """

    is_deferred = True
    options: CameraOptions
    _unseen: Sequence[int]

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        self._failure: RenderError | None = None
        self._lost: RenderError | None = None  # what went wrong with a picture, perhaps on the render thread
        self._is_called = False
        self.around: Any = None

    @abc.abstractmethod
    def shots(self) -> Sequence[Shot]:
        """What is drawn for one sample."""

    def settle(self) -> None:
        """Measures what waits to be looked at, before something that it is made of changes."""
        try:
            for sample in self._kept():
                self._settle(sample)
        except RenderError:
            self._drop()

    def leave(self) -> None:
        self.settle()
        self.around = None

    def measure(self, model: Any, data: Any) -> Any:
        self.around = self.look_around()
        return render_thread.at_once(self._exposed(model, data)).result()

    def capture(self, model: Any, data: Any) -> render_thread.RenderJob:
        """Composes what is to be drawn, and has it drawn: on the render thread, unless somebody waits for it."""
        expose = self._exposed(model, data)
        # the first picture of all is drawn here, so that it is known at once whether there is a renderer
        if self._is_called or not (self.sim.render_thread and gl_context.is_open()):
            return render_thread.at_once(expose)
        return render_thread.submit(expose)

    def capture_held(self, model: Any, data: Any, sample: Sample) -> render_thread.RenderJob:
        # labels, temperatures, lights and what is in the world may be others by now
        self.around, lights = sample.around
        with use_lights(model, data, lights):
            expose = self._exposed(model, data)
        return render_thread.at_once(expose)

    def finish(self, raw: render_thread.RenderJob) -> Any:
        return raw.result()

    def _exposed(self, model: Any, data: Any) -> Callable[[], Any]:
        """What draws and develops the pictures of a state; it needs the state no more."""
        renderer = renderer_of(self.sim)
        smooth = self.options.anti_aliasing > 0
        composition = renderer.compose(model, data, *self._frame_in_world(data), unseen=self._unseen, smooth=smooth)
        return functools.partial(self._expose, renderer, composition, self.shots(), self.note(model, data))

    def _expose(self, renderer: Renderer, composition: Composition, shots: Sequence[Shot], notes: Any) -> Any:
        films = renderer.films(composition, shots)
        try:
            return self.develop(films, notes)
        except RenderError as error:
            self._lost = error
            raise
        finally:
            films.close()

    def look_around(self) -> Any:
        """What besides the physics a sample is made of, as it is now; `note` finds that of its sample in `around`."""
        return None

    def _begin(self, tick: int) -> Sample:
        sample = super()._begin(tick)
        self.around = self.look_around()
        sample.around = self.around, read_lights(self.sim.mj_model)
        return sample

    def note(self, model: Any, data: Any) -> Any:
        """What `develop` needs of the state besides pictures."""
        return None

    @abc.abstractmethod
    def develop(self, films: Iterator[Film], notes: Any) -> Any:
        """The reading without noise, of what was drawn.

        Args:
            films: one of each shot, in their order; to be taken in turn.
            notes: what `note` gave.
        """

    def close(self) -> None:
        render_thread.drain()
        free_renderer(self.sim)

    # ------------------------------------------------------------------ when there is no renderer

    def sample(self, tick: int) -> None:
        if self._failure is not None:
            return
        if self._lost is not None:
            self._switch_off(self._lost)
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

    def _look_who_reads(self) -> None:
        super()._look_who_reads()
        # what has a latency is not waited for when it is taken
        self._is_called = self._delayed is None and any(end.is_live for _, end, needs in self._wanted if needs)

    def _publish(self, sample: Sample, wanted: list[tuple[str, Publisher, bool]]) -> list[LazyMessage]:
        put_off = super()._publish(sample, wanted)
        drawing = self._work_on(sample)
        # what somebody will look at is made as soon as the picture is there; what may never be seen is not
        awaited = [later for later in put_off if later.is_awaited]
        if drawing is not None and awaited:
            sample.work = render_thread.submit(functools.partial(_make_messages_early, drawing, awaited))
            for later in put_off:
                later.work = sample.work
        return put_off

    def _work_on(self, sample: Sample) -> render_thread.RenderJob | None:
        drawing: render_thread.RenderJob | None = sample.raw
        return None if drawing is None or drawing.is_at_once else drawing

    def _message(self, sample: Sample, product: str) -> Any:
        if sample.work is not None and self._products[product].needs_reading:
            sample.work.wait()
        return super()._message(sample, product)

    def _message_later(self, sample: Sample, product: str) -> Any:
        try:
            return super()._message_later(sample, product)
        except RenderError:
            return NO_MESSAGE  # it has been said why

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
        if sample.work is not None:
            sample.work.wait()
        try:
            super()._settle(sample)
        except RenderError as error:
            self._switch_off(error)
            raise

    def _switch_off(self, error: RenderError) -> None:
        if self._failure is not None:
            return
        self._failure = error
        self._drop()
        why = str(error).removeprefix(error.code).strip()
        is_known = any(d.code == error.code and d.message.endswith(why) for d in self.sim.reports)
        message = f"camera {self.scoped!r} is switched off: {why}"
        self.sim.reports.warning(error.code, message, self.scene.where)
        if not is_known:  # what ails all cameras is said aloud once
            self.sim.log.error("%s %s", error.code, message)


def _make_messages_early(work: render_thread.RenderJob, messages: Sequence[LazyMessage]) -> None:
    """Makes messages of a picture that was drawn before."""
    work.result()
    for message in messages:
        message.get()
