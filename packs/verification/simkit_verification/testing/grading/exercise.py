"""Exercises and the reader of their files: a scenario file with an additional block `exercise`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

from simkit import RunSpec
from simkit.code_requests import CodeRequest
from simkit.extend import Diagnostics
from simkit.run_spec import FilePath, JsonMapping
from simkit.run_values import spawns_in
from simkit.testing.scenarios.code_permission import check_requests, permit_code
from simkit.testing.scenarios.scenario_file import parse_scenario, read_node
from simkit.testing.scenarios.yaml_document import (
    Document,
    ValueReader,
    is_scalar_text,
    yaml_value_text,
)
from simkit.yaml_reader import finite_number

_KEYS: Final = ("title", "text", "hand_in", "robot", "node", "parameters", "pass", "runs")
_RUN_KEYS: Final = ("name", "seed", "set", "spawn", "parameters", "duration")
_WALL_TIMEOUT: Final = 120.0  # default wall-clock limit of a run [s], for plugins with an endless loop


@dataclass(frozen=True)
class ExerciseRun:
    """One run of an exercise.

    Attributes:
        name: Name in reports.
        scenario: Scenario of the run.
        parameters: Arguments of the submitted plugin's constructor.
    """

    name: str
    scenario: RunSpec
    parameters: JsonMapping = field(default_factory=dict)


@dataclass(frozen=True)
class Exercise:
    """Exercise that a plugin must solve.

    Attributes:
        title: Title in one line.
        text: Description of the task.
        hand_in: Name of the file to submit.
        node: Arguments of `Simulation.add_node` for a file to submit that is a program for ROS; None for a plugin.
        own_code: Request to run the file of that name in the folder of the exercise; None without a file to submit.
        robot: Scoped name of the entity that the plugin is attached to; empty if the world file names the plugin
            itself.
        pass_mark: Share of the points needed to pass, 0 to 1.
        runs: Runs in which the plugin is tested.
        file: File of the exercise.
        folders: Folders of the user in which the file may name files.
    """

    title: str
    text: str
    hand_in: str
    robot: str
    pass_mark: float
    runs: tuple[ExerciseRun, ...]
    file: Path
    folders: tuple[FilePath, ...] = ()
    own_code: CodeRequest | None = None
    node: JsonMapping | None = None

    @property
    def code_requests(self) -> tuple[CodeRequest, ...]:
        """Plugin folders that the file names and the user has not allowed."""
        return tuple(dict.fromkeys(request for run in self.runs for request in run.scenario.code_requests))


def read_exercise(
    path: str | Path,
    folders: Sequence[FilePath] = (),
    *,
    allow_code: bool = False,
    plugin_paths: Sequence[FilePath] = (),
) -> Exercise:
    """Read an exercise from a YAML file.

    Without a permission, an exercise with plugin folders can be read, but not run.

    Args:
        path: File.
        folders: Folders in which the file may name files, beside its own folder and its project.
        allow_code: Allow the plugin folders that the file names. Their code has the same rights as the user.
        plugin_paths: Allow these folders only.

    Raises:
        LoadError: The file has problems (SK-SCEN-001 to SK-SCEN-004, SK-SCEN-006, SK-URI-003); the error lists all.
            SK-SCEN-008: it names other plugin folders than `plugin_paths`.
    """
    diagnostics = Diagnostics()
    document = Document(Path(path), diagnostics, folders)
    if document.values is None:
        diagnostics.raise_if_errors()
    scenario = parse_scenario(document, also=("exercise",))
    block = document.values.get("exercise") if isinstance(document.values, dict) else None
    if block is None:
        hint = "exercise: {title: ..., hand_in: my_plugin.py, robot: ...}"
        document.error("SK-SCEN-004", "missing block 'exercise'", hint=hint)
    fields = {} if block is None else document.only(block, _KEYS, "an exercise", "exercise")
    exercise = _ExerciseReader(document, fields, ("exercise",)).exercise(scenario)
    diagnostics.raise_if_errors()
    return permit_exercise(exercise, allow_code, plugin_paths) if allow_code or plugin_paths else exercise


def permit_exercise(exercise: Exercise, allow_code: bool = False, plugin_paths: Sequence[FilePath] = ()) -> Exercise:
    """Return an exercise whose plugin folders are allowed; see `permit_code`."""
    check_requests(exercise.code_requests, allow_code, plugin_paths)
    runs = (replace(run, scenario=permit_code(run.scenario, allow_code, plugin_paths)) for run in exercise.runs)
    return replace(exercise, runs=tuple(runs))


class _ExerciseReader(ValueReader):
    """Reader of the values of an exercise or of one run of an exercise."""

    def exercise(self, scenario: RunSpec) -> Exercise:
        if not scenario.checks and not scenario.until:
            hint = "add goals, limits, no_contact, rates or until"
            self._document.error("SK-SCEN-006", "the exercise has no checks, so every plugin would pass", hint=hint)
        if scenario.wall_timeout is None:
            scenario = replace(scenario, wall_timeout=_WALL_TIMEOUT)
        parameters = self._mapping("parameters")
        runs = self._runs(scenario, parameters)
        title, text, hand_in, robot = (self._stripped(key) for key in ("title", "text", "hand_in", "robot"))
        file = self._document.path
        self._document.refuses(self._document.files.refusal(file.parent / hand_in), *self._at, "hand_in")
        own_code = None
        if hand_in:
            words, where = f"the exercise names the plugin {hand_in!r:.200}", self._document.where(*self._at, "hand_in")
            own_code = CodeRequest(words, file.parent / hand_in, where)
        return Exercise(
            title or scenario.title, text, hand_in, robot, self._pass_mark(), runs, file,
            self._document.files.folders, own_code, self._node(),
        )  # fmt: skip

    def _node(self) -> JsonMapping | None:
        """Return the arguments of the node that is submitted: `true`, or a mapping; None for a plugin."""
        value = self._fields.get("node", False)
        if isinstance(value, bool):
            return {} if value else None
        return read_node(self._document, value, (*self._at, "node"), names_program=False)

    def _runs(self, scenario: RunSpec, parameters: JsonMapping) -> tuple[ExerciseRun, ...]:
        listed = self._fields.get("runs", [{}])
        if not isinstance(listed, list) or not listed:
            self._wrong(listed, "a list of runs", "runs")
            return ()
        runs = []
        for number, values in enumerate(listed):
            at = (*self._at, "runs", number)
            fields = self._document.only(values, _RUN_KEYS, "a run", *at)
            runs.append(_ExerciseReader(self._document, fields, at).run(number, scenario, parameters))
        return tuple(runs)

    def run(self, number: int, scenario: RunSpec, parameters: JsonMapping) -> ExerciseRun:
        duration = self.number("duration", scenario.duration, above=0.0)
        folder = self._document.path.parent
        listed = self._texts_of(self._fields.get("spawn", []), "spawn")
        spawn = spawns_in(folder, listed)
        for place, request in enumerate(spawn):
            self._document.refuses(self._document.files.spawn_refusal(request, folder), *self._at, "spawn", place)
        changed = replace(
            scenario,
            seed=self.whole("seed", scenario.seed, 0),
            duration=scenario.duration if duration is None else duration,
            overrides=(*scenario.overrides, *self._overrides()),
            spawn=(*scenario.spawn, *spawn),
        )
        name = self._fields.get("name", f"run {number + 1}")
        if not isinstance(name, str):
            self._wrong(name, "a string", "name")
        return ExerciseRun(str(name), changed, {**parameters, **self._mapping("parameters")})

    # ------------------------------------------------------------------ plain values

    def _stripped(self, key: str) -> str:
        value = self._fields.get(key, "")
        if isinstance(value, str):
            return value.strip()
        self._wrong(value, "a string", key)
        return ""

    def _texts_of(self, value: object, key: str) -> tuple[str, ...]:
        listed = [value] if isinstance(value, str) else value
        if isinstance(listed, list) and all(isinstance(text, str) for text in listed):
            return tuple(listed)
        self._wrong(value, "a string or a list of strings", key)
        return ()

    def _overrides(self) -> tuple[str, ...]:
        value = self._fields.get("set", {})
        if not isinstance(value, dict):
            return self._texts_of(value, "set")
        for path, item in value.items():
            if not is_scalar_text(item):
                self._wrong(item, "a number, a string, true or false, or a list of these", "set", path)
        return tuple(f"{path}={yaml_value_text(item)}" for path, item in value.items())

    def _pass_mark(self) -> float:
        value = self._fields.get("pass", 1.0)
        mark = finite_number(value)
        if mark is not None and 0.0 <= mark <= 1.0:
            return mark
        self._wrong(value, "a number from 0 to 1", "pass")
        return 1.0
