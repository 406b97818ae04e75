"""What the options of a command ask to be run."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from simkit.cli.terminal.options import SourceArguments, source_arguments
from simkit.cli.terminal.teleop import KEY_TIMEOUT

if TYPE_CHECKING:
    from simkit.testing.scenarios import Scenario


OnError = Literal["stop", "disable"]


@dataclass(frozen=True)
class RunOptions:
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
    source: SourceArguments = field(default_factory=lambda: source_arguments((), (), ()))
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


@dataclass(frozen=True)
class ScenarioOptions:
    """A run; one field an option, and none says anything where it was not given.

    Attributes:
        world: a world, or the file of a scenario.
        duration: simulated time [s].
        seed: of all noise.
        topics, skip: patterns of topics.
        overrides: `PATH=VALUE` texts.
        spawn: `MODEL:x,y,yaw[:name]` texts.
        params_files: `[MODEL=]FILE` texts.
        cmd_vel: `V,W`.
        script: a file of commands.
        plugin_paths: folders.
        source: how the world's file is read.
        usual_duration: of a world that no scenario gives a length [s].
    """

    world: str
    duration: float | None = None
    seed: int | None = None
    topics: tuple[str, ...] = ()
    skip: tuple[str, ...] = ()
    overrides: tuple[str, ...] = ()
    spawn: tuple[str, ...] = ()
    params_files: tuple[str, ...] = ()
    cmd_vel: str | None = None
    script: Path | None = None
    plugin_paths: tuple[Path, ...] = ()
    source: SourceArguments = field(default_factory=lambda: source_arguments((), (), ()))
    usual_duration: float = 10.0

    def scenario(self) -> Scenario:
        """The scenario of the file, or of the world, with what the options say over it, but for their commands.

        Raises:
            LoadError: the file of the scenario has errors.
        """
        from simkit.testing.scenarios import Scenario
        from simkit.testing.scenarios.scenario_file import is_scenario_file, read_scenario

        if "<" not in self.world and is_scenario_file(self.world):
            found = read_scenario(self.world)
        else:
            found = Scenario(self.world, duration=self.usual_duration)
        return replace(
            found,
            duration=found.duration if self.duration is None else self.duration,
            seed=found.seed if self.seed is None else self.seed,
            topics=self.topics or found.topics,
            skip=(*found.skip, *self.skip),
            overrides=(*found.overrides, *self.overrides),
            spawn=(*found.spawn, *self.spawn),
            options={**found.options, **self._options()},
        )

    @property
    def changes_scenario(self) -> bool:
        """Whether any option says something else than the file of a scenario does."""
        said = (self.topics, self.skip, self.overrides, self.spawn, self.cmd_vel, self.script, self._options())
        return self.duration is not None or self.seed is not None or any(said)

    def commanded(self, scenario: Scenario, topics: dict[str, str]) -> Scenario:
        """The scenario with the commands of `--cmd-vel` and `--script` too.

        Args:
            scenario: of this.
            topics: topic -> type of its world.

        Raises:
            InputError: SK-CLI-010 no such speeds, or no topic for them; SK-CLI-011 what is wrong with the script.
        """
        from simkit.recording.commands import read_script, steady_velocity

        found = [steady_velocity(self.cmd_vel, topics)] if self.cmd_vel is not None else []
        if self.script is not None:
            found += read_script(self.script, topics)
        return replace(scenario, commands=(*scenario.commands, *(command.plain() for command in found)))

    def _options(self) -> dict[str, Any]:
        """Keyword arguments of `load`, those that say something."""
        said: dict[str, Any] = {**self.source, "plugin_paths": self.plugin_paths, "params_files": self.params_files}
        return {name: value for name, value in said.items() if value and value != "auto"}
