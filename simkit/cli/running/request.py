"""What a run is to do."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from simkit.cli.driving.teleop import KEY_TIMEOUT
from simkit.cli.options import Source, source

OnError = Literal["stop", "disable"]


@dataclass(frozen=True)
class Request:
    """What a run is to do; one field an option."""

    world: str
    duration: float | None = None
    seed: int = 0
    record: Path | None = None
    topics: tuple[str, ...] = ()
    skip: tuple[str, ...] = ()
    force: bool = False
    rtf: float | None = None
    overrides: tuple[str, ...] = ()
    strict: bool = False
    view: bool = False
    picture: Path | None = None
    cmd_vel: str | None = None
    script: Path | None = None
    plugin_paths: tuple[Path, ...] = ()
    on_plugin_error: OnError | None = None
    verbose: bool = False
    quiet: bool = False
    watch: bool = False
    spawn: tuple[str, ...] = ()
    params_files: tuple[str, ...] = ()
    name: str | None = None
    teleop: str | None = None
    key_timeout: float = KEY_TIMEOUT
    paused: bool = False
    step: int | None = None
    source: Source = field(default_factory=lambda: source((), (), ()))

    @property
    def pace(self) -> float | None:
        """The highest real-time factor, None for none: real time for those who watch or drive and say nothing."""
        if self.rtf is None:
            return 1.0 if self.view or self.teleop is not None else None
        return self.rtf if math.isfinite(self.rtf) else None
