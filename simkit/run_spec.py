"""Run specification: world, seed, overrides, resources, commands, limits, topics and recording.

The command line, Python, a scenario file and a bundle each make one typed, frozen and picklable `RunSpec`. The commands
run, golden, certify, bundle, grade and plot, and `Simulation.run_spec` use it.
"""

from __future__ import annotations

import fnmatch
import math
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Literal, Protocol, TypedDict, cast, get_args

from simkit.code_requests import CodeRequest, code_refusal
from simkit.errors import InputError
from simkit.home_folder import expand_home

FilePath = str | os.PathLike[str]
JsonObject = dict[str, Any]
JsonMapping = Mapping[str, Any]
"""Object of JSON or YAML: texts, numbers, truth values, lists and objects by name."""
PluginErrorPolicy = Literal["stop", "disable"]
"""Policy for a plugin that raises: end the run, or continue without the plugin."""
RendererName = Literal["auto", "gl", "software"]
"""Renderer of images: OpenGL, simkit's software renderer, or OpenGL if this machine has it and else software."""
RENDERERS: Final[tuple[str, ...]] = get_args(RendererName)

GROUND: Final = "ground"
"""World of a bare model: level ground and a sun."""

EMPTY_SPACE: Final = "none"
"""World of a bare model: nothing."""

NO_FILE_POSITION: Final = ""
"""Position of an item that does not come from a file."""

_MODEL_FILE_SUFFIXES: Final = frozenset((".config", ".sdf", ".urdf", ".xacro", ".xml"))
"""Suffixes of the files that make a folder a model."""

CheckKind = Literal["goal", "always", "final", "apart", "rate"]
"""Kind of a check.

- "goal", "always", "final": an expression holds once, at all times, or at the end.
- "apart": models never touch.
- "rate": a topic has the required rate.
"""


@dataclass(frozen=True)
class Check:
    """One condition that a run must meet.

    Attributes:
        kind: kind of the condition. The kinds goal, always and final use `expression`, apart uses `models`, and rate
            uses `topic`, `rate` and `tolerance`.
        name: name in a report.
        expression: expression in the language of `docs/conditions.md`.
        by: simulated time by which a goal must be reached [s]; None for the end of the run.
        after: simulated time from which "always" and "apart" are checked [s].
        models: scoped names of models or links: two names that must not touch each other, or one name that may touch
            only the ground.
        rate: required rate [Hz] of simulated time; None for the rate that is set for the sensor or plugin.
        tolerance: allowed relative deviation of the rate.
        points: points for meeting the condition in an exercise.
        hint: text of a report if the condition does not hold.
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
        """Name of the check, or its condition as text."""
        if self.name:
            return self.name
        if self.kind == "apart":
            return " and ".join(self.models) + (" do not touch" if len(self.models) > 1 else " touches nothing")
        if self.kind == "rate":
            return f"{self.topic} ticks" + (f" at {self.rate:g} Hz" if self.rate is not None else "")
        return self.expression


@dataclass(frozen=True)
class Tolerance:
    """Allowed difference between readings and golden readings, for runs that need not be equal bit by bit.

    Fields that are None use the default of the message type.

    Attributes:
        pattern: topic, field (`/imu.linear_acceleration`), or shell pattern of either.
        absolute: absolute tolerance in the field's unit.
        relative: tolerance as a fraction of the golden value.
        share: fraction of the values of one message (rays, points, pixels) that may exceed the tolerance.
        image: mean difference of an image's values, 0 to 255.
        ssim: least structural similarity of images, at most 1.
        statistics: compare mean, deviation and distribution of the noise instead of samples.
        ignore: skip the comparison.
        exact: require equal bits on every machine.
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
    """Model to add while the world is loaded; `simkit.loaders.spawned_models.SpawnedModel` implements it.

    Attributes:
        source: file or bare name.
        place: pose in the order x, y [m], yaw [rad], then further pose values; None for the pose in the file.
        name: name of the model in the world; None for the name in the file.
    """

    @property
    def source(self) -> FilePath: ...
    @property
    def place(self) -> tuple[float, ...] | None: ...
    @property
    def name(self) -> str | None: ...


NamedValues = Mapping[str, str] | Sequence[str]
"""Values by name, or texts `NAME:=VALUE` or `NAME=VALUE`."""


def named_values(values: NamedValues | None, option: str) -> dict[str, str]:
    """Return values by name; `NAME:=VALUE` is the form of ROS.

    Args:
        values: mapping, texts, or None for no values.
        option: name of the option for an error message.

    Raises:
        InputError: SK-CLI-018 a text has another form.
    """
    if values is None or isinstance(values, Mapping):
        return dict(values or {})
    found: dict[str, str] = {}
    for text in (values,) if isinstance(values, str) else values:
        name, equals, value = str(text).partition("=")
        name = name.strip().removesuffix(":").strip()
        if not equals or not name:
            message = f"SK-CLI-018 {option}: found {text!r}; expected NAME:=VALUE or NAME=VALUE"
            raise InputError(message, "SK-CLI-018")
        found[name] = value
    return found


PackagePaths = Mapping[str, FilePath] | Sequence[FilePath]
"""Folders of ROS packages by name, or a list of workspaces and of texts `NAME=DIR`."""


def split_package_paths(paths: PackagePaths | None) -> tuple[dict[str, Path], list[Path]]:
    """Return the folders of packages by name, and the workspaces, which are folders without a name."""
    if isinstance(paths, Mapping):
        return {name: expand_home(path) for name, path in paths.items()}, []
    named: dict[str, Path] = {}
    workspaces: list[Path] = []
    for item in (paths,) if isinstance(paths, str) else paths or ():
        name, equals, path = str(item).partition("=")
        name = name.strip().removesuffix(":").strip()
        if isinstance(item, str) and equals and name and "/" not in name:
            named[name] = expand_home(path)
        else:
            workspaces.append(expand_home(item))
    return named, workspaces


def change_package_paths(paths: PackagePaths, change: Callable[[FilePath], FilePath]) -> PackagePaths:
    """Return the same packages and workspaces with every folder replaced."""
    if isinstance(paths, Mapping):
        return {name: change(path) for name, path in paths.items()}
    named, workspaces = split_package_paths(paths)
    return [*(f"{name}={change(path)}" for name, path in named.items()), *map(change, workspaces)]


class SourceOptions(TypedDict, total=False):
    """Options for reading a file, shared by `simkit.load`, `check` and `describe`."""

    resource_paths: Sequence[FilePath]
    package_paths: PackagePaths
    xacro_args: NamedValues
    base: str


class LoadOptions(SourceOptions, total=False):
    """Arguments of `simkit.load` that a run passes and that are not fields of `RunSpec`."""

    plugin_paths: Sequence[FilePath]
    interfaces: Sequence[FilePath]
    params_files: FilePath | Sequence[FilePath | tuple[str, FilePath]]
    strict: bool
    sleep: bool
    render_thread: bool | None
    on_error: PluginErrorPolicy | None
    renderer: RendererName | None


class LoadArguments(LoadOptions, total=False):
    """All keyword arguments of `simkit.load`."""

    seed: int
    overrides: Sequence[str]
    spawn: Sequence[Any]
    model_world: str
    plugins: Sequence[object]
    change_world: Callable[[Any], Any] | None


@dataclass(frozen=True)
class Recording:
    """Bag that a run is recorded to.

    Attributes:
        path: `x.mcap` for one file, else a rosbag2 folder.
        overwrite: replace an existing bag.
    """

    path: Path
    overwrite: bool = False


@dataclass(frozen=True)
class RunSpec:
    """Specification of a run: its world, commands, recording and conditions.

    Attributes:
        world: file (relative to `folder`), bare name, or XML text.
        duration: longest simulated time [s]; infinite for a run without an end.
        seed: seed of all noise.
        name: name in reports; empty for the world's name.
        overrides: `PATH=VALUE` texts as for `--set`.
        spawn: models to add to the world, as for `--spawn`.
        model_world: world of a bare model: "ground" for level ground and a sun, "none" for empty space, a file
            (relative to `folder`), or a bare name. The model stands on what is below it.
        commands: commands to send during the run: mappings as in a `--script`, each with its file position under
            "where".
        plugins: plugins made in Python, as for `simkit.load`; from Python only.
        topics: shell patterns of the topics to record or compare; empty for all topics except clocks.
        skip: shell patterns of topics to leave out.
        tolerances: allowed differences; the first match applies, patterns of fields before patterns of topics.
        state: compare the physics state too.
        model: report a changed world as a difference even if all outputs are equal.
        picture: longest side of a stored image [px].
        until: expression that ends the run when it becomes true; a run in which this never happens fails.
        timeout: simulated time [s] by which `until` must hold; None for the duration.
        wall_timeout: wall time [s] after which the run is aborted.
        checks: conditions that must hold.
        options: load options: resources and further arguments of `simkit.load`.
        folder: folder that relative paths start from.
        file: file of the specification; None if it was made in Python.
        test: `FILE.py::NAME` of the only test that can repeat the run; for tests that create plugins or step the
            simulation.
        bits: require equal bits on the same machine; if false, tolerances also apply there. From Python only.
        play: bag whose commands are sent again at their ticks (relative to `folder`); empty for none.
        play_topics: `TOPIC` or `OLD:=NEW`, as for `--play-topic`; empty for all topics that the world subscribes to.
        velocity: `V,W` [m/s, rad/s] to send once, as for `--cmd-vel`; None for none.
        script: file of further commands, as for `--script`.
        recording: bag for the recorded topics; None for none.
        pace: highest real-time factor; None for full speed.
        paused: start the run paused.
        steps: number of steps before a pause; None for no pause.
        change_world: function that receives the resolved world and returns the world to build. From Python only.
        code_requests: code that the file asks for and the user has not allowed; such a run is refused.
    """

    world: str
    duration: float = 10.0
    seed: int = 0
    name: str = ""
    overrides: tuple[str, ...] = ()
    spawn: tuple[str | SpawnRequest, ...] = ()
    model_world: str = GROUND
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
    code_requests: tuple[CodeRequest, ...] = ()

    def load_arguments(self) -> LoadArguments:
        """Return the keyword arguments of `simkit.load` for `source`; raise LoadError for code that is not allowed."""
        if self.code_requests:
            raise code_refusal(self.code_requests)
        arguments = LoadArguments(
            seed=self.seed, overrides=self.overrides, spawn=self.spawn, model_world=self.model_world_source,
            plugins=self.plugins, change_world=self.change_world,
        )  # fmt: skip
        return cast(LoadArguments, {**arguments, **self.options})

    def source_options(self) -> SourceOptions:
        """Return those load options that are used for reading the world's file."""
        names = SourceOptions.__optional_keys__
        return cast(SourceOptions, {name: value for name, value in self.options.items() if name in names})

    @property
    def longest(self) -> float:
        """Simulated time at which the run ends at the latest [s]: the timeout, else the duration."""
        return self.duration if self.timeout is None else self.timeout

    @property
    def is_endless(self) -> bool:
        """True for a run without a duration."""
        return math.isinf(self.duration)

    @property
    def played_bag(self) -> Path | None:
        """Path of the bag whose commands are played; None for none."""
        return self.folder / self.play if self.play else None

    @property
    def title(self) -> str:
        """Name of the run, or of the world's file."""
        if self.name:
            return self.name
        return "world" if "<" in self.world else Path(self.world).stem

    @property
    def source(self) -> str:
        """Argument `source` of `simkit.load`: the path of the world's file in `folder` if it exists, else `world`."""
        if "<" in self.world:
            return self.world
        return self.world if self.beside is None else str(self.beside)

    @property
    def model_world_source(self) -> str:
        """Argument `model_world` of `simkit.load`: the path of a file in `folder` if it exists, else `model_world`."""
        if self.model_world in (GROUND, EMPTY_SPACE) or "<" in self.model_world:
            return self.model_world
        path = self.folder / self.model_world
        return str(path) if os.path.isfile(path) else self.model_world  # noqa: PTH113 (a long name is no error)

    @property
    def beside(self) -> Path | None:
        """File or folder of the world in `folder`; None for a bare name or XML text."""
        if "<" in self.world:
            return None
        path = self.folder / self.world
        if os.path.isdir(path):  # noqa: PTH112 (a long name is no error); the folder of a golden run may have the name of its world
            return path if any(entry.suffix in _MODEL_FILE_SUFFIXES for entry in path.iterdir()) else None
        return path if os.path.isfile(path) else None  # noqa: PTH113

    def tolerance(self, topic: str, field_: str = "") -> Sequence[Tolerance]:
        """Return the tolerances that match a field of a topic, the most specific first."""
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
