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
    until: str = ""
    timeout: float | None = None
    wall_timeout: float | None = None
    asserts: tuple[str, ...] = ()
    junit: Path | None = None
    source: Source = field(default_factory=lambda: source((), (), ()))
    play: Path | None = None
    play_topics: tuple[str, ...] = ()
    bundles: Path | None = None

    def longest(self, played: float | None = None) -> float | None:
        """The simulated time [s] after which the run ends at the latest; None for until Ctrl-C.

        Args:
            played: how long the recording is that is played, which is the run's length where nothing else is said.
        """
        duration = played if self.duration is None else self.duration
        return min((t for t in (duration, self.timeout) if t is not None), default=None)

    @property
    def pace(self) -> float | None:
        """The highest real-time factor, None for none: real time for those who watch or drive and say nothing."""
        if self.rtf is None:
            return 1.0 if self.view or self.teleop is not None else None
        return self.rtf if math.isfinite(self.rtf) else None
