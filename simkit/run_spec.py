"""Run specification: world, seed, overrides, resources, commands, limits, topics and recording.

The command line, Python, a scenario file and a bundle each make one typed, frozen and picklable `RunSpec`. The commands
run, golden, certify, bundle, grade and plot, and `Simulation.run_spec` use it.
"""

from __future__ import annotations

import fnmatch
import math
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final, Protocol, cast

from simkit.code_requests import CodeRequest, code_refusal
from simkit.diagnostic_record import Diagnostic
from simkit.errors import InputError
from simkit.run_checks import Check, CheckKind, FinalConditions, Tolerance
from simkit.run_fields import (
    LOAD_FIELDS,
    RENDERERS,
    CommandOption,
    LoadArguments,
    LoadOptions,
    PluginErrorPolicy,
    RendererName,
    RunField,
    SourceOptions,
    described_fields,
    run_field,
)
from simkit.run_files import ChangeFile, FileName, FilePath, PackagePaths, relative_path
from simkit.run_nodes import Node
from simkit.run_values import (
    BagText,
    Expression,
    Flag,
    NamedTexts,
    NamedValues,
    Nodes,
    Number,
    OneFile,
    PlainValues,
    ProgramName,
    Spawns,
    Text,
    Texts,
    Whole,
    WorldName,
    named_values,
)

__all__ = [
    "EMPTY_SPACE", "GROUND", "RENDERERS", "Check", "CheckKind", "FilePath", "JsonMapping", "JsonObject",
    "LoadArguments", "LoadOptions", "NamedValues", "PackagePaths", "PluginErrorPolicy", "Recording", "RendererName",
    "RunSpec", "SourceOptions", "SpawnRequest", "Tolerance", "named_values", "run_fields",
]  # fmt: skip

JsonObject = dict[str, Any]
JsonMapping = Mapping[str, Any]
"""Object of JSON or YAML: texts, numbers, truth values, lists and objects by name."""

GROUND: Final = "ground"
"""World of a bare model: level ground and a sun."""

EMPTY_SPACE: Final = "none"
"""World of a bare model: nothing."""

_MODEL_FILE_SUFFIXES: Final = frozenset((".config", ".sdf", ".urdf", ".xacro", ".xml"))
"""Suffixes of the files that make a folder a model."""


class SpawnRequest(Protocol):
    """Model to add while the world is loaded; `simkit.loaders.spawned_models.SpawnedModel` implements it.

    Attributes:
        source: file or bare name.
        place: pose in the order x, y [m], yaw [rad], then further pose values; None for the pose in the file.
        name: name of the model in the world; None for the name in the file.
        namespace: namespace of the model's topics; None for the names in the file.
    """

    @property
    def source(self) -> FilePath: ...
    @property
    def place(self) -> tuple[float, ...] | None: ...
    @property
    def name(self) -> str | None: ...
    @property
    def namespace(self) -> str | None: ...


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
        nodes: programs that run in lock-step: texts `PROGRAM ARGUMENT …`, or mappings of arguments of `sim.add_node`.
        node_latency: `TIME` or `LEAST..MOST`, for all nodes without a latency; `NODE=TIME` for one node.
        node_discovery: simulated time between the creation of a publisher or subscription and its match [s].
        node_limit: wall time that a node may compute without waiting [s].
        node_restart: simulated time after which a node that raised starts anew [s]; None for never.
        ros_parameters: parameters of the parameter server of ROS 1 by absolute name, for all nodes.
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
        launch: launch file in place of a world, or `PACKAGE FILE`: the permission for its code replaces it by what it
            starts. For scenario files; `simkit.launch` returns the run of a launch file.
        launch_arguments: values of the arguments of the launch file by name.
        code_requests: code that the file asks for and the user has not allowed; such a run is refused.
        diagnostics: warnings and notes of the file that describes the run.
    """

    world: str
    duration: float = run_field(
        10.0,
        Number(least=0.0),
        CommandOption("--duration", "S", "Simulated seconds to run; default: {default}.", least=0),
    )
    seed: int = run_field(
        0,
        Whole(0),
        CommandOption("--seed", "N", "Seed of all random streams.", "world", least=0, most=2**64 - 1),
        packed="first",
        is_loaded=True,
    )
    name: str = run_field(
        "", Text(), CommandOption("--name", "NAME", "Name of the run; default: the world's or file's name.")
    )
    overrides: tuple[str, ...] = run_field(
        (),
        Texts(),
        CommandOption("--set", "PATH=VALUE", "Override one value: scoped::name.element=VALUE; repeatable.", "world"),
        key="set",
        packed="first",
        is_appended=True,
        is_loaded=True,
    )
    spawn: tuple[str | SpawnRequest | JsonMapping, ...] = run_field(
        (),
        Spawns(),
        CommandOption(
            "--spawn",
            "MODEL:x,y,yaw[:name[:namespace]]",
            "Spawn a model, by name or file; repeatable.",
            "world",
            completion="worlds",
        ),
        packed="first",
        is_appended=True,
        is_loaded=True,
    )
    model_world: str = run_field(
        GROUND,
        WorldName((GROUND, EMPTY_SPACE)),
        CommandOption(
            "--world",
            "NAME|none|FILE",
            "World of a bare model: a file, a name, or none for empty space; default: {default}.",
            "world",
            usual="level ground and a sun",
            completion="worlds",
        ),
        packed="first",
        is_loaded=True,
    )
    commands: tuple[JsonMapping, ...] = ()
    nodes: tuple[Node, ...] = run_field(
        (),
        Nodes(),
        CommandOption(
            "--node",
            "PROGRAM",
            "Run FILE.py or PACKAGE/EXECUTABLE in lock-step with the world; --ros-args … may follow; repeatable.",
        ),
        is_appended=True,
    )
    node_latency: tuple[str, ...] = run_field(
        (),
        Texts(),
        CommandOption(
            "--node-latency",
            "[NODE=]TIME",
            "Delay of messages to nodes: 5ms, or drawn from 5ms..20ms; for all nodes or for one; repeatable.",
            of_field="nodes",
        ),
        is_appended=True,
    )
    node_discovery: float = run_field(
        0.0,
        Number(least=0.0),
        CommandOption(
            "--node-discovery",
            "S",
            "Simulated time until publishers and subscriptions of nodes are matched; at least one step.",
            least=0,
            of_field="nodes",
        ),
    )
    node_limit: float = run_field(
        60.0,
        Number(above=0.0),
        CommandOption(
            "--node-limit",
            "S",
            "Wall time that a node may compute without waiting; default: 60.",
            parser="seconds",
            of_field="nodes",
        ),
    )
    node_restart: float | None = run_field(
        None,
        Number(least=0.0),
        CommandOption(
            "--node-restart",
            "S",
            "Start a node that raised an exception anew after S simulated seconds, in place of exit code 4.",
            least=0,
            of_field="nodes",
        ),
    )
    ros_parameters: Mapping[str, Any] = run_field(dict, PlainValues())
    plugins: tuple[object, ...] = ()
    topics: tuple[str, ...] = run_field(
        (),
        Texts(),
        CommandOption(
            "--topic",
            "PATTERN",
            "Record or compare only topics of this pattern; repeatable.",
            completion="source_topics",
        ),
    )
    skip: tuple[str, ...] = run_field(
        (),
        Texts(),
        CommandOption("--skip", "PATTERN", "Leave out topics of this pattern; repeatable.", completion="source_topics"),
        packed="changed",
        is_appended=True,
    )
    tolerances: tuple[Tolerance, ...] = ()
    state: bool = run_field(True, Flag())
    model: bool = run_field(True, Flag())
    picture: int = run_field(64, Whole(8))
    until: str = run_field(
        "",
        Expression(),
        CommandOption("--until", "EXPR", "End as soon as this condition holds: \"pose('tb3').x > 2\"."),
    )
    timeout: float | None = run_field(
        None,
        Number(above=0.0),
        CommandOption(
            "--timeout", "S", "Simulated time limit for --until; then exit 5.", parser="seconds", of_field="until"
        ),
    )
    wall_timeout: float | None = run_field(
        None,
        Number(above=0.0),
        CommandOption(
            "--wall-timeout", "S", "Wall time limit of a run; default: {default}.", parser="seconds", usual="none"
        ),
    )
    checks: tuple[Check, ...] = run_field(
        (),
        FinalConditions(),
        CommandOption("--assert", "EXPR", "Condition that must hold at the end, else exit 5; repeatable."),
        key=None,
        is_appended=True,
    )
    options: LoadOptions = field(default_factory=LoadOptions)
    folder: Path = field(default_factory=Path)
    file: Path | None = None
    test: str = run_field("", Text(), key=None, is_stored=True)
    bits: bool = run_field(True, Flag(), key=None, is_stored=True)
    play: str = run_field(
        "", BagText(), CommandOption("--play", "BAG", "Bag with commands, which are played at their ticks.")
    )
    play_topics: tuple[str, ...] = run_field(
        (),
        Texts(),
        CommandOption(
            "--play-topic", "TOPIC[:=NEW]", "Topic to play, optionally under a new name; repeatable.", of_field="play"
        ),
    )
    velocity: str | None = run_field(
        None, Text(), CommandOption("--cmd-vel", "V,W", "Send a constant velocity: m/s forward, rad/s left."), key=None
    )
    script: Path | None = run_field(  # noqa: RUF009
        None, OneFile(), CommandOption("--script", "FILE.yaml", "Script of timed commands."), key=None
    )
    recording: Recording | None = None
    pace: float | None = run_field(
        None,
        Number(above=0.0),
        CommandOption(
            "--rtf",
            "X",
            "Highest real-time factor; default: no limit, 1 with --teleop, --view or --web.",
            "session",
            least=1e-3,
        ),
        key=None,
    )
    paused: bool = run_field(
        False,
        Flag(),
        CommandOption("--paused", "", "Start paused; space or a service resumes the run.", "session"),
        key=None,
    )
    steps: int | None = run_field(
        None, Whole(0), CommandOption("--step", "N", "Pause after N steps.", "session", least=0), key=None
    )
    change_world: Callable[[Any], Any] | None = None
    launch: str = run_field("", ProgramName(), is_stored=False)
    launch_arguments: NamedValues = run_field((), NamedTexts(), key="arguments", is_stored=False)  # noqa: RUF009
    code_requests: tuple[CodeRequest, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()

    def value_of(self, described: RunField) -> Any:
        """Return the value of a field or load option; the default for a load option that is not given."""
        if described.is_load_option:
            return self.options.get(described.name, described.default)
        return getattr(self, described.name)

    def with_values(self, values: JsonMapping) -> RunSpec:
        """Return a specification with other values of fields and load options."""
        fields = run_fields()
        options = {name: value for name, value in values.items() if fields[name].is_load_option}
        rest = {name: value for name, value in values.items() if name not in options}
        return replace(self, **rest, options=cast(LoadOptions, {**self.options, **options}))

    def with_files(self, change: ChangeFile) -> RunSpec:
        """Return a specification in which each name of a file is changed, except that of the world itself."""
        values = {}
        for name, described in run_fields().items():
            value = self.value_of(described)
            if value and not (described.is_load_option and name not in self.options):
                values[name] = described.kind.move(value, name, change)
        return self.with_values(values)

    def with_relative_files(self, folder: Path) -> RunSpec:
        """Return a specification in which the names of files are relative to a folder, except that of the world."""

        def place(name: FileName) -> str:
            path = name.used_path(self.folder)
            return name.text if path is None else relative_path(path, folder)

        return self.with_files(place)

    def files(self) -> Iterator[FileName]:
        """Iterate over the names of files in all fields, except the world itself."""
        names: list[FileName] = []

        def note(name: FileName) -> str:
            names.append(name)
            return name.text

        self.with_files(note)
        return iter(names)

    def load_arguments(self) -> LoadArguments:
        """Return the keyword arguments of `simkit.load` for `source`; raise LoadError for code that is not allowed."""
        if self.code_requests:
            raise code_refusal(self.code_requests)
        if self.launch:
            message = f"the launch file {self.launch!r:.200} has not been executed"
            raise InputError("SK-INPUT-002", message, help="use the specification that simkit.launch returns")
        loaded = {
            name: getattr(self, name)
            for name, run_field in run_fields().items()
            if run_field.is_loaded and not run_field.is_load_option
        }
        loaded |= {"model_world": self.model_world_source, "plugins": self.plugins, "change_world": self.change_world}
        return cast(LoadArguments, {**loaded, **self.options})

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
        kind = run_fields()["model_world"].kind
        return str(kind.move(self.model_world, "model_world", lambda name: name.path_in(self.folder) or name.text))

    @property
    def beside(self) -> Path | None:
        """File or folder of the world in `folder`; None for a bare name or XML text."""
        if "<" in self.world:
            return None
        path = self.folder / self.world
        if os.path.isdir(path):  # noqa: PTH112 (a long name is no error); the folder of a golden run may have the name of its world
            return path if any(entry.suffix in _MODEL_FILE_SUFFIXES for entry in path.iterdir()) else None
        return path if os.path.isfile(path) else None  # noqa: PTH113

    def relative_world(self, folder: Path) -> str:
        """Return the world's name: a file relative to a folder; a bare name or XML text unchanged."""
        return self.world if self.beside is None else relative_path(self.beside, folder)

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


_FIELDS: Final = described_fields(RunSpec)


def run_fields() -> dict[str, RunField]:
    """Return the descriptions of the fields of a run and of its load options by name."""
    return {**_FIELDS, **LOAD_FIELDS}
