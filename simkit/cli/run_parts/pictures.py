"""Run part `--picture`, `--gif` and `--video`: draw the run with its path and scan."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar, Final

from simkit.cli.run_part import OpenRun, RunPart
from simkit.cli.run_verdict import RunVerdict
from simkit.cli.terminal import options
from simkit.cli.terminal.json_report import add_to_report
from simkit.cli.terminal.options import option
from simkit.cli.terminal.output import stdout_console
from simkit.number_text import counted
from simkit.run_spec import RunSpec

if TYPE_CHECKING:
    from simkit.recording.films.film import FilmOptions
    from simkit.recording.run_picture import DrivenPath
    from simkit.runtime import Simulation

_PATH: Final = 0.05  # [s] of simulated time between two points of a path


@dataclass
class Pictures(RunPart):
    """Picture of the end and film of the run."""

    place: ClassVar[int] = 40

    picture: Annotated[Path | None, option("Picture of the end to write, with path and scan.", "OUT.png")] = None
    gif: Annotated[Path | None, option("Moving picture to write, as GIF.", "OUT.gif")] = None
    video: Annotated[Path | None, option("Video to write; needs the extra video.", "OUT.mp4|OUT.webm")] = None
    resolution: options.Resolution = None
    fps: options.Fps = None
    camera: options.FilmCamera = "auto"
    film: FilmOptions | None = field(init=False, default=None)
    driven: DrivenPath | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        """Read the options of the film."""
        values = (self.gif, self.video, self.resolution, self.fps, self.camera)
        if values != (None, None, None, None, "auto"):
            from simkit.recording.films.film import film_options  # 7 ms

            self.film = film_options(*values)

    @contextmanager
    def around_run(self, spec: RunSpec, verdict: RunVerdict) -> Iterator[None]:
        """Check the file of the picture."""
        if self.picture is not None:
            from simkit.recording.run_picture import check_target

            check_target(self.picture)
        yield

    def after_loading(self, sim: Simulation) -> None:
        """Check the renderer, and start to record the path of the robot.

        Raises:
            RenderError: SK-RENDER-001 the run requests OpenGL, which is missing.
        """
        if self.picture is not None or self.film is not None:
            from simkit.recording.run_picture import DrivenPath  # 4 ms
            from simkit.sensors.cameras.renderer_choice import check_available

            check_available(sim)
            self.driven = DrivenPath(sim)

    @contextmanager
    def around_loop(self, run: OpenRun) -> Iterator[None]:
        """Film the run and draw the picture of its end; a film is complete also after Ctrl-C or an error."""
        if self.driven is None:
            yield
            return
        run.loop.watchers.append(self.driven.sample)
        run.loop.limit_slices(_PATH)
        if self.film is None:
            yield
        else:
            with _film(run, self.film, self.driven):
                yield
        if self.picture is not None:
            _draw_picture(run.sim, self.picture, self.driven)


def _draw_picture(sim: Simulation, path: Path, driven: DrivenPath) -> None:
    """Draw the scene at the end, with the driven path."""
    from simkit.recording.run_picture import save_picture
    from simkit.sensors.cameras.overview_image import render_view

    save_picture(sim, path, render_view, driven)
    stdout_console().print(f"picture {path}")
    add_to_report(picture=str(path))


@contextmanager
def _film(run: OpenRun, options: FilmOptions, driven: DrivenPath) -> Iterator[None]:
    """Film a run inside the `with` block, with the frame that is due after the last step."""
    from simkit.recording.films.film import Film
    from simkit.sensors.cameras.overview_image import render_view

    film = Film(run.sim, options, render_view, driven)
    run.loop.senders.append(film)
    try:
        yield
        film.send_due()
    finally:
        film.close()
        names = ", ".join(map(str, options.outputs)) if film.count else "no frames"
        stdout_console().print(
            f"film {names}: {counted(film.count, 'frame')}, {float(options.frame_rate):g} per simulated second"
        )
        add_to_report(film={"files": [str(path) for path in options.outputs], "frames": film.count})
