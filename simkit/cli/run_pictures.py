"""Picture and film of a run on the command line."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from simkit.cli.run_loop import CommandSender
from simkit.cli.terminal.json_report import add_to_report
from simkit.cli.terminal.output import print_status, stdout_console
from simkit.errors import RenderError

if TYPE_CHECKING:
    from simkit.recording.films.film import FilmOptions
    from simkit.recording.run_picture import DrivenPath
    from simkit.runtime import Simulation


def draw_picture(sim: Simulation, path: Path, driven: DrivenPath) -> None:
    """Draw the scene at the end, with the driven path."""
    from simkit.recording.run_picture import save_picture
    from simkit.sensors.cameras.overview_image import render_view

    save_picture(sim, path, render_view, driven)
    stdout_console().print(f"picture {path}")
    add_to_report(picture=str(path))


def check_renderer(sim: Simulation) -> None:
    """Check before a run whether its picture can be drawn.

    Raises:
        RenderError: SK-RENDER-001 the run requests OpenGL, which is missing.
    """
    from simkit.sensors.cameras.renderer_choice import check_available

    check_available(sim)


def note_missing_gl(sim: Simulation) -> None:
    """Print a note if the simulation has cameras and this machine has no OpenGL.

    With the renderer `auto`, the note names the software renderer. Only the first image opens OpenGL, so that a run
    whose cameras nobody reads starts without it.
    """
    if not any(sensor.needs_renderer for sensor in sim.contents.sensors.values()) or sim.world.renderer == "software":
        return
    from simkit.sensors.cameras.renderer_choice import chosen_renderer
    from simkit.sensors.cameras.rendering.gl_context import find_library

    try:
        find_library()
    except RenderError as error:
        if chosen_renderer(sim) == "gl":
            print_status(f"note: {error.code} cameras have no images: {error.message}")


@contextmanager
def film_run(
    sim: Simulation, options: FilmOptions | None, driven: DrivenPath | None, senders: list[CommandSender]
) -> Iterator[Callable[[], None]]:
    """Film a run inside the `with` block; the files are complete at its end, also after Ctrl-C or an error.

    Args:
        sim: simulation to film.
        options: options of the film; None for no film.
        driven: paths and goals to draw.
        senders: senders of the run loop; the film is added, so that the loop stops at its ticks.

    Yields:
        Function that draws the frame that is due after the last step.
    """
    if options is None or driven is None:
        yield lambda: None
        return
    from simkit.recording.films.film import Film
    from simkit.sensors.cameras.overview_image import render_view

    film = Film(sim, options, render_view, driven)
    senders.append(film)
    try:
        yield film.send_due
    finally:
        film.close()
        names = ", ".join(map(str, options.outputs)) if film.count else "no frames"
        stdout_console().print(f"film {names}: {film.count} frames, {float(options.frame_rate):g} per simulated second")
        add_to_report(film={"files": [str(path) for path in options.outputs], "frames": film.count})
