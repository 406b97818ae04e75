"""Options of commands that write a GIF or a video."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from simkit.cli.terminal.options import option

Gif = Annotated[Path | None, option("Moving picture to write, as GIF.", "OUT.gif")]
Video = Annotated[Path | None, option("Video to write; needs the extra video.", "OUT.mp4|OUT.webm")]
Resolution = Annotated[
    str | None, option("Size of --gif and --video; default: 1280x720, 640x360 for a GIF alone.", "WxH", "--resolution")
]
Fps = Annotated[float | None, option("Frames per simulated second; default: 25, 10 for a GIF alone.", "N", "--fps")]
FilmCamera = Annotated[
    str, option("Camera of --gif and --video; auto: fixed in a room, else following.", "auto|fixed|follow", "--camera")
]
