"""Choice of the renderer of a simulation: OpenGL, or simkit's software renderer where OpenGL cannot be opened."""

from __future__ import annotations

import atexit
import contextlib
import logging
import weakref
from collections.abc import Generator, Sequence
from functools import cache
from typing import Final, Protocol

from simkit.errors import RenderError
from simkit.runtime import Simulation
from simkit.runtime.engine.step_loop import stop_other_loops
from simkit.sensors.cameras.rendering import gl_context, render_thread
from simkit.sensors.cameras.rendering.appearance import QUALITIES, Appearance
from simkit.sensors.cameras.rendering.renderer import Renderer
from simkit.sensors.cameras.rendering.scene_composition import Composer, Composition
from simkit.sensors.cameras.rendering.view import DrawnView, Shot

GL: Final = "gl"
SOFTWARE: Final = "software"
FALLBACK: Final = "SK-RENDER-015"
"""Code of the note that OpenGL cannot be opened and the software renderer draws."""
UNKNOWN_REQUEST: Final = "SK-RENDER-016"
"""Code of the warning that `MUJOCO_GL` has an unknown value and the software renderer draws."""


class ImageBuffers(Protocol):
    """Buffers of a renderer."""

    def reserve(self, width: int, height: int) -> None:
        """Enlarge the buffers for images of this size [px]."""


class ImageRenderer(Protocol):
    """Renderer of the visuals of one simulation: `Renderer` with OpenGL, or `SoftwareRenderer`.

    Attributes:
        composer: composer of the scenes.
        uploads: buffers.
    """

    @property
    def composer(self) -> Composer: ...

    @property
    def uploads(self) -> ImageBuffers: ...

    def draw_all(self, composition: Composition, shots: Sequence[Shot]) -> Generator[DrawnView, None, None]:
        """Draw the shots of a composition one by one, and return the composition to the composer."""

    def draw(self, composition: Composition, shot: Shot) -> DrawnView:
        """Draw one image."""

    def free(self) -> None:
        """Free the memory; a later image allocates it again."""


class _Drawing:
    """Renderers of one simulation.

    Attributes:
        kinds: renderer that was chosen for each request: the request "auto" is decided once.
        renderers: renderers by kind and quality.
        size: largest image that a camera has announced [px].
    """

    def __init__(self) -> None:
        self.kinds: dict[str, str] = {}
        self.renderers: dict[tuple[str, str], ImageRenderer] = {}
        self.size = (0, 0)


_drawings: weakref.WeakKeyDictionary[Simulation, _Drawing] = weakref.WeakKeyDictionary()
_abandoned: list[ImageRenderer] = []
"""Renderers of simulations that were not closed. A finalizer does not free them: it would wait, and lose interrupts."""
_logged: set[str] = set()
"""Reasons for the software renderer that this process has logged."""


def renderer_of(sim: Simulation, quality: str = "") -> ImageRenderer:
    """Return the renderer of a simulation at a quality; all its cameras share the one of the world's quality.

    The first call decides between OpenGL and software, and for `auto` it opens OpenGL.

    Args:
        sim: simulation to draw.
        quality: fast, gazebo or high; empty for the quality of the world.
    """
    drawing = _drawing_of(sim)
    key = chosen_renderer(sim), quality or sim.world.quality
    if key not in drawing.renderers:
        while _abandoned:
            _free_quietly(_abandoned.pop())
        renderer = drawing.renderers[key] = _make(key[0], Appearance(sim.world.surroundings, QUALITIES[key[1]]))
        renderer.uploads.reserve(*drawing.size)
        with contextlib.suppress(RenderError):  # each image raises the error again
            check_available(sim)
        weakref.finalize(sim, _abandoned.append, renderer).atexit = False
    return drawing.renderers[key]


def _drawing_of(sim: Simulation) -> _Drawing:
    return _drawings.setdefault(sim, _Drawing())


def _make(kind: str, appearance: Appearance) -> ImageRenderer:
    if kind == GL:
        return Renderer(appearance)
    from simkit.sensors.cameras.rendering.software import software_renderer

    _end_drawing_at_exit()
    return software_renderer.SoftwareRenderer(appearance)


@cache
def _end_drawing_at_exit() -> None:
    """Finish the images that are being drawn before the interpreter ends, as the OpenGL context does for its own."""

    def end() -> None:
        stop_other_loops()
        render_thread.end()

    atexit.register(end)


def chosen_renderer(sim: Simulation) -> str:
    """Return the renderer of a simulation, `gl` or `software`; the first call decides.

    `gl` is returned as it was requested, also if OpenGL cannot be opened; then each image raises a RenderError.
    """
    requested, kinds = sim.world.renderer, _drawing_of(sim).kinds
    if requested not in kinds:
        kinds[requested] = _open_gl_or_software(sim) if requested == "auto" else requested
        if kinds[requested] == SOFTWARE and (unknown := gl_context.unknown_request()):
            message = f"{unknown}; the software renderer draws"
            sim.engine.reports.warning(UNKNOWN_REQUEST, message, hint=gl_context.help_for_request())
    return kinds[requested]


def _open_gl_or_software(sim: Simulation) -> str:
    """Open OpenGL and return its name; if it cannot be opened, return `software` with a note."""
    try:
        gl_context.ensure_open()
    except RenderError as error:
        if gl_context.unknown_request():
            return SOFTWARE
        reason = error.message.replace(gl_context.HINT, gl_context.WAYS_TO_GET_GL)
        message = f"images are drawn by the software renderer: {reason}"
        sim.engine.reports.note(FALLBACK, message)
        if reason not in _logged:
            _logged.add(reason)
            logging.getLogger("simkit").warning("note: %s %s", FALLBACK, message)
        return SOFTWARE
    return GL


def is_ready(sim: Simulation) -> bool:
    """Check whether a missing renderer would be known by now: images need not be drawn at once to detect it."""
    return chosen_renderer(sim) == SOFTWARE or gl_context.is_open()


def check_available(sim: Simulation) -> None:
    """Open the renderer of a simulation, and store its description in `sim.engine.renderer`.

    Raises:
        RenderError: SK-RENDER-001 the simulation requests OpenGL, and no library provides it.
    """
    if chosen_renderer(sim) == GL:
        gl_context.ensure_open()
        sim.engine.use_renderer(gl_context.describe_renderer() or "unknown")
        return
    from simkit.sensors.cameras.rendering.software import software_renderer

    sim.engine.use_renderer(software_renderer.describe_renderer())


def reserve_image(sim: Simulation, width: int, height: int) -> None:
    """Announce images of this size [px], so that buffers are enlarged once; no renderer is chosen yet."""
    drawing = _drawing_of(sim)
    drawing.size = max(width, drawing.size[0]), max(height, drawing.size[1])
    for renderer in drawing.renderers.values():
        renderer.uploads.reserve(*drawing.size)


def describe_renderer(sim: Simulation) -> str:
    """Return the renderer that draws the images of a simulation, such as `software (simkit, OpenCV 5.0.0)`.

    The text of OpenGL is the driver's, such as `llvmpipe (LLVM 15.0.6, 256 bits) through EGL`. Without the requested
    OpenGL, it is `none (SK-RENDER-001)`.
    """
    try:
        check_available(sim)
    except RenderError as error:
        return f"none ({error.code})"
    return sim.engine.renderer


def fell_back(sim: Simulation) -> bool:
    """Check whether the software renderer has drawn because OpenGL could not be opened."""
    return _drawing_of(sim).kinds.get("auto") == SOFTWARE


def free_renderer(sim: Simulation) -> None:
    """Free the memory of the renderers of a simulation that closes."""
    drawing = _drawing_of(sim)
    while drawing.renderers:
        _free_quietly(drawing.renderers.popitem()[1])


def _free_quietly(renderer: ImageRenderer) -> None:
    with contextlib.suppress(RenderError, RuntimeError):
        renderer.free()
