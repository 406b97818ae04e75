"""What an exercise is, and how its file is read: a scenario's with a block `exercise` more."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

from simkit.diagnostics import Diagnostics
from simkit.run_spec import JsonMapping, RunSpec
from simkit.testing.scenarios.scenario_file import is_scalar_text, parse_scenario, yaml_value_text
from simkit.testing.scenarios.yaml_document import Document, resolve_spawn_file, short_repr
from simkit.yaml_reader import finite_number

_KEYS: Final = ("title", "text", "hand_in", "robot", "parameters", "pass", "runs")
_RUN_KEYS: Final = ("name", "seed", "set", "spawn", "parameters", "duration")
_WALL_TIMEOUT: Final = 120.0  # [s] of a run whose scenario has none: who hands in an endless loop is told so


@dataclass(frozen=True)
class ExerciseRun:
    """One run of an exercise.

    Attributes:
        name: what a report calls it.
        scenario: what is run.
        parameters: of the plugin that was handed in.
    """

    name: str
    scenario: RunSpec
    parameters: JsonMapping = field(default_factory=dict)


@dataclass(frozen=True)
class Exercise:
    """What is asked of a plugin.

    Attributes:
        title: in one line.
        text: what is to be done.
        hand_in: name of the file that is handed in.
        robot: scoped name of what the plugin hangs on; empty where the world's file names the plugin itself.
        pass_mark: part of the points that is needed.
        runs: in which it is tried.
        file: it was read from.
    """

    title: str
    text: str
    hand_in: str
    robot: str
    pass_mark: float
    runs: tuple[ExerciseRun, ...]
    file: Path


def read_exercise(path: str | Path) -> Exercise:
    """The exercise in a YAML file.

    Raises:
        LoadError: with every problem of the file: SK-SCEN-001 to SK-SCEN-004, SK-SCEN-006.
    """
    diagnostics = Diagnostics()
    document = Document(Path(path), diagnostics)
    if document.values is None:
        diagnostics.raise_if_errors()
    scenario = parse_scenario(document, also=("exercise",))
    exercise = _ExerciseReader(document).exercise(scenario)
    diagnostics.raise_if_errors()
    return exercise


class _ExerciseReader:
    def __init__(self, document: Document) -> None:
        self._document = document
        block = document.values.get("exercise") if isinstance(document.values, dict) else None
        if block is None:
            hint = "exercise: {title: ..., hand_in: my_plugin.py, robot: ...}"
            document.error("SK-SCEN-004", "an exercise needs a block 'exercise'", hint=hint)
        self._said = {} if block is None else document.only(block, _KEYS, "an exercise", "exercise")

    def exercise(self, scenario: RunSpec) -> Exercise:
        if not scenario.checks and not scenario.until:
            hint = "goals, limits, no_contact, rates or until say what is asked"
            self._document.error("SK-SCEN-006", "an exercise in which nothing must hold is always passed", hint=hint)
        if scenario.wall_timeout is None:
            scenario = replace(scenario, wall_timeout=_WALL_TIMEOUT)
        parameters = self._mapping(self._said.get("parameters", {}), "exercise", "parameters")
        runs = self._runs(scenario, parameters)
        file = self._document.path
        title = self._text("title") or scenario.title
        return Exercise(
            title, self._text("text"), self._text("hand_in"), self._text("robot"), self._pass_mark(), runs, file
        )

    def _runs(self, scenario: RunSpec, parameters: Mapping[str, object]) -> tuple[ExerciseRun, ...]:
        listed = self._said.get("runs", [{}])
        if not isinstance(listed, list) or not listed:
            self._wrong(listed, "a list of runs", "exercise", "runs")
            return ()
        return tuple(self._run(one, number, scenario, parameters) for number, one in enumerate(listed))

    def _run(self, value: object, number: int, scenario: RunSpec, parameters: Mapping[str, object]) -> ExerciseRun:
        keys = ("exercise", "runs", number)
        said = self._document.only(value, _RUN_KEYS, "a run", *keys)
        seed = said.get("seed", scenario.seed)
        if not isinstance(seed, int) or isinstance(seed, bool) or seed < 0:
            self._wrong(seed, "a whole number of at least 0", *keys, "seed")
            seed = 0
        wanted = said.get("duration", scenario.duration)
        duration = finite_number(wanted)
        if duration is None or not duration > 0:
            self._wrong(wanted, "a number above 0", *keys, "duration")
            duration = scenario.duration
        spawn = self._texts(said.get("spawn", []), *keys, "spawn")
        changed = replace(
            scenario,
            seed=seed,
            duration=duration,
            overrides=(*scenario.overrides, *self._overrides(said.get("set", {}), *keys, "set")),
            spawn=(*scenario.spawn, *(resolve_spawn_file(self._document.path.parent, one) for one in spawn)),
        )
        own = self._mapping(said.get("parameters", {}), *keys, "parameters")
        name = said.get("name", f"run {number + 1}")
        if not isinstance(name, str):
            self._wrong(name, "a text", *keys, "name")
            name = ""
        return ExerciseRun(name, changed, {**parameters, **own})

    # ------------------------------------------------------------------ plain values

    def _wrong(self, value: object, allowed: str, *keys: object) -> None:
        label = ".".join(map(str, keys))
        self._document.error("SK-SCEN-003", f"{label}: found {short_repr(value)}, allowed is {allowed}", *keys)

    def _text(self, key: str) -> str:
        value = self._said.get(key, "")
        if isinstance(value, str):
            return value.strip()
        self._wrong(value, "a text", "exercise", key)
        return ""

    def _texts(self, value: object, *keys: object) -> tuple[str, ...]:
        listed = [value] if isinstance(value, str) else value
        if isinstance(listed, list) and all(isinstance(one, str) for one in listed):
            return tuple(listed)
        self._wrong(value, "a text, or a list of them", *keys)
        return ()

    def _mapping(self, value: object, *keys: object) -> JsonMapping:
        if isinstance(value, dict) and all(isinstance(one, str) for one in value):
            return value
        self._wrong(value, "a mapping", *keys)
        return {}

    def _overrides(self, value: object, *keys: object) -> tuple[str, ...]:
        if not isinstance(value, dict):
            return self._texts(value, *keys)
        for path, one in value.items():
            if not is_scalar_text(one):
                self._wrong(one, "a number, a text, true or false, or a list of them", *keys, path)
        return tuple(f"{path}={yaml_value_text(one)}" for path, one in value.items())

    def _pass_mark(self) -> float:
        value = self._said.get("pass", 1.0)
        mark = finite_number(value)
        if mark is not None and 0.0 <= mark <= 1.0:
            return mark
        self._wrong(value, "a part of the points, 0 to 1", "exercise", "pass")
        return 1.0
