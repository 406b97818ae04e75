"""Display, keyboard and report options of a run in a terminal."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from simkit.bridges.teleop import KEY_TIMEOUT

if TYPE_CHECKING:
    from simkit.bridges.ros.bridge_process import RosOptions
    from simkit.bridges.web.web_process import WebOptions
    from simkit.cli.terminal.page_options import PageOptions
    from simkit.recording.films.film import FilmOptions


@dataclass(frozen=True)
class RunDisplay:
    """Display, keyboard and report options of a run.

    Attributes:
        view: True to open a viewer window.
        picture: file for a picture of the scene at the end.
        film: options of a GIF or video of the run; None for none.
        teleop: topic for the keyboard's velocities; empty for the world's only velocity topic, None for no keyboard.
        key_timeout: simulated time without a key after which driving stops [s].
        verbose: True to print every note.
        quiet: True to print no table of topics.
        watch: True to reload plugins whose files change.
        junit: file for a JUnit XML report.
        bundles: folder for the bundle of a failed run.
        ros: options of the bridge to ROS 2; None for a run without ROS.
        web_servers: options of the servers for Foxglove and rosbridge.
        page: options of the live view in a browser; None for no view.
    """

    view: bool = False
    picture: Path | None = None
    teleop: str | None = None
    key_timeout: float = KEY_TIMEOUT
    verbose: bool = False
    quiet: bool = False
    watch: bool = False
    junit: Path | None = None
    bundles: Path | None = None
    ros: RosOptions | None = None
    web_servers: tuple[WebOptions, ...] = ()
    film: FilmOptions | None = None
    page: PageOptions | None = None
