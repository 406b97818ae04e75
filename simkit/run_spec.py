"""The description of a run: world, seed, overrides, resources, commands, limits, topics and recording.

One typed, frozen and picklable `RunSpec` is made from the command line, from Python, from a scenario file and from a
bundle; run, golden, certify, bundle, grade, plot and `Simulation.run_spec` understand it. This module imports nothing
of simkit.
"""

from __future__ import annotations

import fnmatch
import math
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Literal, Protocol, TypedDict, cast

FilePath = str | os.PathLike[str]
JsonObject = dict[str, Any]
JsonMapping = Mapping[str, Any]
"""What JSON and YAML give: texts, numbers, truth values, lists and further objects by name."""
PluginErrorPolicy = Literal["stop", "disable"]
"""What becomes of a plugin that raises: the run ends, or it goes on without the plugin."""

NO_FILE_POSITION: Final = ""
"""Of what was not written in a file."""

_MODEL_FILE_SUFFIXES: Final = frozenset((".config", ".sdf", ".urdf", ".xacro", ".xml"))
"""Suffixes of what a folder holds that is a model's."""

CheckKind = Literal["goal", "always", "final", "apart", "rate"]
"""What a check asks: that an expression holds once, at all times, or at the end; that models never touch; that a topic
ticks."""


@dataclass(frozen=True)
class Check:
    """One thing that must hold.

    Attributes:
        kind: what is asked; `expression` belongs to goal, always and final, `models` to apart, `topic` and the rest to
            rate.
        name: what a report calls it.
        expression: in the language of `docs/conditions.md`.
        by: a goal must be reached by then [s]; None by the end.
        after: "always" and "apart" count from then on [s].
        models: scoped names of models or links: one that nothing but the ground may touch, or two that must not touch
            each other.
        rate: wanted [Hz] of simulated time; None for the rate that the sensor or plugin is set to.
        tolerance: part of the rate by which it may be off.
        points: what it is worth in an exercise.
        hint: what a report says where it does not hold.
        where: `file:line`, or NOWHERE.
    """

    kind: CheckKind
    name: str = ""
    expression: str = ""
    by: float | None = None
    after: float = 0.0
    models: tuple[str, ...] = ()
    topic: str = ""
    rate: float | None = None
    tolerance: float = 0.05
    points: float = 1.0
    hint: str = ""
    where: str = NO_FILE_POSITION

    @property
    def title(self) -> str:
        """Its name, or what it says."""
        if self.name:
            return self.name
        if self.kind == "apart":
            return " and ".join(self.models) + (" do not touch" if len(self.models) > 1 else " touches nothing")
        if self.kind == "rate":
            return f"{self.topic} ticks" + (f" at {self.rate:g} Hz" if self.rate is not None else "")
        return self.expression


@dataclass(frozen=True)
class Tolerance:
    """How far readings may be from the golden ones where they cannot be expected to be equal bit by bit.

    What is None is left to the defaults of the message's type.

    Attributes:
        pattern: a topic, a field (`/imu.linear_acceleration`), or a shell pattern of either.
        absolute: in the field's unit.
        relative: part of the golden value.
        share: part of the values of one message (rays, points, pixels) that may be further off.
        image: mean difference of a picture's values, 0 to 255.
        ssim: least structural similarity of pictures, up to 1.
        statistics: whether mean, deviation and distribution of the noise are compared instead of samples.
        ignore: whether it is not looked at.
        exact: whether bits must be equal, whatever the machine.
        where: `file:line`, or NOWHERE.
    """

    pattern: str
    absolute: float | None = None
    relative: float | None = None
    share: float | None = None
    image: float | None = None
    ssim: float | None = None
    statistics: bool | None = None
    ignore: bool = False
    exact: bool = False
    where: str = NO_FILE_POSITION


class SpawnRequest(Protocol):
    """A model that comes into the world as it is loaded; `simkit.loaders.spawned_models.SpawnedModel` is one.

    Attributes:
        source: a file or a bare name.
        place: x, y, yaw and what else is given of its pose; None for the file's own.
        name: that it gets; None for its own.
    """

    @property
    def source(self) -> FilePath: ...
    @property
    def place(self) -> tuple[float, ...] | None: ...
    @property
    def name(self) -> str | None: ...


class SourceOptions(TypedDict, total=False):
    """How a file is read: arguments that `simkit.load`, `check` and `describe` share."""

    resource_paths: Sequence[FilePath]
    package_paths: Mapping[str, FilePath]
    xacro_args: Mapping[str, str]
    base: str


class LoadOptions(SourceOptions, total=False):
    """Arguments of `simkit.load` that `RunSpec` has no field of its own for; only those that are given are in it."""

    plugin_paths: Sequence[FilePath]
    params_files: FilePath | Sequence[FilePath | tuple[str, FilePath]]
    strict: bool
    sleep: bool
    render_thread: bool | None
    on_error: PluginErrorPolicy | None


class LoadArguments(LoadOptions, total=False):
    """All keyword arguments of `simkit.load`."""

    seed: int
    overrides: Sequence[str]
    spawn: Sequence[Any]
    plugins: Sequence[object]
    change_world: Callable[[Any], Any] | None


@dataclass(frozen=True)
class Recording:
    """The bag that a run is recorded to.

    Attributes:
        path: `x.mcap` for one file, else a rosbag2 folder.
        overwrite: whether a bag that exists is replaced.
    """

    path: Path
    overwrite: bool = False


@dataclass(frozen=True)
class RunSpec:
    """A run: a world, what is done in it, what is recorded and what must hold.

    Attributes:
        world: a file (relative to `folder`), a bare name, or XML text.
        duration: longest simulated time [s]; infinite for a run that somebody stops.
        seed: of all noise.
        name: what reports call it; else the world's.
        overrides: `PATH=VALUE` as of `--set`.
        spawn: models put into the world, as of `--spawn`.
        commands: what is sent while it runs: mappings as in a `--script`, each with its place under "where".
        plugins: plugins made in Python, as of `simkit.load`; from Python only.
        topics: shell patterns of the topics that are recorded or compared; empty for all but clocks.
        skip: shell patterns of topics that are left out.
        tolerances: the first whose pattern fits counts, a field's before its topic's.
        state: whether the physics state itself is compared too.
        model: whether a world that means something else is a difference even where no output shows it.
        picture: longest side of a kept picture [px].
        until: an expression that ends the run; reaching it is a check of its own.
        timeout: simulated time [s] by which `until` must hold; None for the duration.
        wall_timeout: wall time [s] after which the run is given up.
        checks: what must hold.
        options: how the world is loaded: resources and further arguments of `simkit.load`.
        folder: what relative paths are relative to.
        file: where it was read from; None where it was made in Python.
        test: of what only a test can do again (it made plugins, or stepped by itself): `FILE.py::NAME`.
        bits: whether bits must be equal on the same machine; else tolerances count there too. From Python only.
        play: a bag whose commands are sent again at their ticks (relative to `folder`); empty for none.
        play_topics: `TOPIC` or `OLD:=NEW`, as of `--play-topic`; empty for all that the world takes.
        velocity: `V,W` [m/s, rad/s] that is sent once, as of `--cmd-vel`; None for none.
        script: a file of further commands, as of `--script`.
        recording: the bag that topics are recorded to; None for none.
        pace: highest real-time factor; None for as fast as it goes.
        paused: whether it begins paused.
        steps: steps after which it is paused; None for not at all.
        change_world: is given the resolved world and returns what is built instead. From Python only.
    """

    world: str
    duration: float = 10.0
    seed: int = 0
    name: str = ""
    overrides: tuple[str, ...] = ()
    spawn: tuple[str | SpawnRequest, ...] = ()
    commands: tuple[JsonMapping, ...] = ()
    plugins: tuple[object, ...] = ()
    topics: tuple[str, ...] = ()
    skip: tuple[str, ...] = ()
    tolerances: tuple[Tolerance, ...] = ()
    state: bool = True
    model: bool = True
    picture: int = 64
    until: str = ""
    timeout: float | None = None
    wall_timeout: float | None = None
    checks: tuple[Check, ...] = ()
    options: LoadOptions = field(default_factory=LoadOptions)
    folder: Path = field(default_factory=Path)
    file: Path | None = None
    test: str = ""
    bits: bool = True
    play: str = ""
    play_topics: tuple[str, ...] = ()
    velocity: str | None = None
    script: Path | None = None
    recording: Recording | None = None
    pace: float | None = None
    paused: bool = False
    steps: int | None = None
    change_world: Callable[[Any], Any] | None = None

    def load_arguments(self) -> LoadArguments:
        """Return the keyword arguments of `simkit.load` for `source`."""
        arguments = LoadArguments(
            seed=self.seed,
            overrides=self.overrides,
            spawn=self.spawn,
            plugins=self.plugins,
            change_world=self.change_world,
        )
        return cast(LoadArguments, {**arguments, **self.options})

    def source_options(self) -> SourceOptions:
        """Return the options that say how the world's file is read, those that are given."""
        names = SourceOptions.__optional_keys__
        return cast(SourceOptions, {name: value for name, value in self.options.items() if name in names})

    @property
    def longest(self) -> float:
        """Simulated time after which the run ends at the latest [s]: its timeout, else its duration."""
        return self.duration if self.timeout is None else self.timeout

    @property
    def is_endless(self) -> bool:
        """Whether the run has no duration of its own."""
        return math.isinf(self.duration)

    @property
    def played_bag(self) -> Path | None:
        """The bag whose commands are played; None for none."""
        return self.folder / self.play if self.play else None

    @property
    def title(self) -> str:
        """Its name, or that of the world's file."""
        if self.name:
            return self.name
        return "world" if "<" in self.world else Path(self.world).stem

    @property
    def source(self) -> str:
        """What `simkit.load` is given: the world beside the scenario's file, where there is one."""
        if "<" in self.world:
            return self.world
        return self.world if self.beside is None else str(self.beside)

    @property
    def beside(self) -> Path | None:
        """The world's file, or its folder, beside the scenario's; None where it is a bare name, or text."""
        if "<" in self.world:
            return None
        place = self.folder / self.world
        if place.is_dir():  # a golden run may have the name of its world
            return place if any(one.suffix in _MODEL_FILE_SUFFIXES for one in place.iterdir()) else None
        return place if place.is_file() else None

    def tolerance(self, topic: str, field_: str = "") -> Sequence[Tolerance]:
        """Those that speak of a field of a topic, the most particular first."""

        name = f"{topic}.{field_}" if field_ else topic
        of_field = [
            t
            for t in self.tolerances
            if field_
            and "." in t.pattern
            and (fnmatch.fnmatchcase(name, t.pattern) or name.startswith(t.pattern + "."))
        ]
        of_topic = [t for t in self.tolerances if "." not in t.pattern and fnmatch.fnmatchcase(topic, t.pattern)]
        return [*of_field, *of_topic]
