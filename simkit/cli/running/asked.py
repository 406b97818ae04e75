"""What the options of a command ask to be run: a world for some seconds, or a scenario with something over it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from simkit.cli.options import Source, source

if TYPE_CHECKING:
    from simkit.scenario import Scenario


@dataclass(frozen=True)
class Asked:
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
    source: Source = field(default_factory=lambda: source((), (), ()))
    usual_duration: float = 10.0

    def scenario(self) -> Scenario:
        """The scenario of the file, or of the world, with what the options say over it, but for their commands.

        Raises:
            LoadError: the file of the scenario has errors.
        """
        from simkit.scenario import Scenario
        from simkit.scenario.read import is_scenario_file, read_scenario

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
        from simkit.sinks.commands import read_script, steady_velocity

        found = [steady_velocity(self.cmd_vel, topics)] if self.cmd_vel is not None else []
        if self.script is not None:
            found += read_script(self.script, topics)
        return replace(scenario, commands=(*scenario.commands, *(command.plain() for command in found)))

    def _options(self) -> dict[str, Any]:
        """Keyword arguments of `load`, those that say something."""
        said: dict[str, Any] = {**self.source, "plugin_paths": self.plugin_paths, "params_files": self.params_files}
        return {name: value for name, value in said.items() if value and value != "auto"}
