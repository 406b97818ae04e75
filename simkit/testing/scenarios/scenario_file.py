"""Scenario files: YAML, or Python with a variable `scenario`.

All problems of a file are reported at once, with file and line.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import Any, Final

from simkit.code_requests import CodeRequest, folder_request
from simkit.diagnostics import Diagnostics, Where
from simkit.errors import InputError, LoadError
from simkit.recording.bags.reader import open_bag_to_read
from simkit.recording.command_script import script_items, validate_items
from simkit.run_fields import RunField
from simkit.run_files import FileName
from simkit.run_spec import (
    Check,
    CheckKind,
    FilePath,
    JsonObject,
    RunSpec,
    Tolerance,
    named_values,
    run_fields,
)
from simkit.testing.scenarios.code_permission import permit_code
from simkit.testing.scenarios.python_file import load_python_scenario
from simkit.testing.scenarios.yaml_document import (
    Document,
    ValueReader,
)

_SCENARIO_SUFFIXES: Final = (".yaml", ".yml", ".py")
_CHECKS: Final[dict[str, CheckKind]] = {
    "goals": "goal",
    "limits": "always",
    "at_end": "final",
    "no_contact": "apart",
    "rates": "rate",
}
_OWN_KEYS: Final = ("world", "commands", "tolerances", "statistics", "plugin_paths", *_CHECKS)
_CHECK_KEYS: Final[dict[CheckKind, tuple[str, ...]]] = {
    "goal": ("name", "that", "by", "points", "hint"),
    "always": ("name", "that", "after", "points", "hint"),
    "final": ("name", "that", "points", "hint"),
    "apart": ("name", "models", "after", "points", "hint"),
    "rate": ("name", "topic", "rate", "tolerance", "points", "hint"),
}
_TOLERANCE_KEYS: Final = tuple(f.name for f in fields(Tolerance) if f.name not in ("pattern", "where"))
TOLERANCE_MODES: Final = ("exact", "ignore", "statistics")


def scenario_keys() -> tuple[str, ...]:
    """Return the keys of a scenario file."""
    return (*_OWN_KEYS, *(one.key for one in run_fields().values() if one.key is not None))


def is_scenario_file(source: str | Path) -> bool:
    """Check whether a file name has the suffix of a scenario file."""
    return Path(source).suffix.lower() in _SCENARIO_SUFFIXES


def read_scenario(
    path: str | Path,
    folders: Sequence[FilePath] = (),
    *,
    allow_code: bool = False,
    plugin_paths: Sequence[FilePath] = (),
) -> RunSpec:
    """Read a scenario file.

    Without a permission, the plugin folders of a YAML file are in `code_requests`, and the result cannot be run.

    Args:
        path: YAML file, or Python file with `scenario = RunSpec(...)`, which is run.
        folders: Folders in which a YAML file may name files, beside its own folder and its project.
        allow_code: Allow the plugin folders that a YAML file names. Their code has the same rights as the user.
        plugin_paths: Allow these folders only; the file must not name others.

    Raises:
        LoadError: The file has problems (SK-SCEN-001 to SK-SCEN-005, SK-URI-003); the error lists all of them.
            SK-SCEN-008: it names other folders than `plugin_paths`.
    """
    file = Path(path)
    diagnostics = Diagnostics()
    if file.suffix.lower() == ".py":
        return load_python_scenario(file, diagnostics)
    document = Document(file, diagnostics, folders)
    if document.values is None:
        diagnostics.raise_if_errors()
    scenario = parse_scenario(document)
    if diagnostics.has_errors:
        _check_world(scenario, diagnostics)
    diagnostics.raise_if_errors()
    return permit_code(scenario, allow_code, plugin_paths) if allow_code or plugin_paths else scenario


def _check_world(scenario: RunSpec, diagnostics: Diagnostics) -> None:
    """Report problems of the world together with those of the scenario file."""
    from simkit.build import read_scene

    if not scenario.world:
        return
    try:
        read_scene(scenario.source, **scenario.source_options())
    except LoadError as error:
        diagnostics.extend(error.diagnostics)
    except InputError as error:
        diagnostics.error(error.code, str(error).removeprefix(error.code).strip(), Where(str(scenario.file)))


def parse_scenario(document: Document, *, also: tuple[str, ...] = ()) -> RunSpec:
    """Parse a scenario document; problems are added to its diagnostics.

    Args:
        document: Document of a scenario file.
        also: Additional keys that the caller reads.
    """
    if document.values is None:
        document.values = {}
    fields = document.only(document.values, scenario_keys() + also, "a scenario")
    if isinstance(document.values, dict) and "world" not in fields:
        document.error("SK-SCEN-004", "missing 'world'", hint="add world: FILE or the name of a bundled world")
    return ScenarioReader(document, fields).scenario()


class ScenarioReader(ValueReader):
    """Reader of the values of a scenario."""

    def scenario(self) -> RunSpec:
        if "timeout" in self._fields and "until" not in self._fields:
            hint = "add until: CONDITION, or use duration: S to end the run at a fixed time"
            self._document.error("SK-SCEN-004", "'timeout' needs 'until'", "timeout", hint=hint)
        if "timeout" in self._fields and "duration" in self._fields:
            message = "'timeout' and 'duration' both define the end of the run"
            self._document.error("SK-SCEN-003", message, "timeout", hint="with 'until', keep only 'timeout'")
        folder = self._document.path.parent
        duration = self._bag_duration()
        found = RunSpec(
            world=self.text("world", ""),
            duration=duration,
            commands=self._commands(),
            tolerances=(*self._tolerances(), *self._statistics()),
            checks=tuple(check for key, kind in _CHECKS.items() for check in self._checks(key, kind)),
            code_requests=self._code_requests(),
            folder=folder,
            file=self._document.path,
        )
        values = {name: self._value(one, duration) for name, one in run_fields().items() if one.key in self._fields}
        found = found.with_values(values).with_files(self._in_folder)
        refused = [self._document.refuses(one, *keys) for keys, one in self._document.files.refused(found)]
        return replace(found, world="") if refused else found  # nobody reads the world of such a file

    # ------------------------------------------------------------------ world and inputs

    def _value(self, described: RunField, duration: float) -> object:
        """Return the value of a key; problems are added to the diagnostics."""
        assert described.key is not None
        if described.name == "play":  # `_bag_duration` reports another value than a text
            return str(self._fields["play"])
        if described.name == "overrides":
            return self._overrides()
        if described.name == "xacro_args":
            return self._xacro_arguments()
        value = described.kind.read(self, described.key, duration if described.key == "duration" else described.default)
        return self._expression(value, "until") if described.key == "until" else value

    def _in_folder(self, name: FileName) -> object:
        """Return a name of a file that starts from the working directory instead of the folder of the document."""
        path = name.path_in(self._document.path.parent)
        if path is None or name.role in ("world", "bag"):  # a run looks for these in its own folder
            return name.text
        return str(path) if name.role in ("model", "file") else path

    def _overrides(self) -> tuple[str, ...]:
        if isinstance(self._fields.get("set"), dict):
            return tuple(f"{path}={one}" for path, one in self._strings("set").items())
        return self.texts("set")

    def _xacro_arguments(self) -> dict[str, str]:
        """Return the arguments of xacro files: a mapping, or a list of `NAME:=VALUE` texts."""
        if isinstance(self._fields["xacro_args"], dict):
            return self._strings("xacro_args")
        found: dict[str, str] = {}
        for number, text in enumerate(self.texts("xacro_args")):
            try:
                found |= named_values((text,), "xacro_args")
            except InputError:
                self._wrong(text, "NAME:=VALUE or NAME=VALUE", "xacro_args", number)
        return found

    def _commands(self) -> tuple[Mapping[str, object], ...]:
        value = self._fields.get("commands", ())
        try:
            if isinstance(value, str):
                script = self._document.path.parent / value
                is_refused = self._document.refuses(self._document.files.refusal(script), "commands")
                return () if is_refused else tuple(script_items(script))
            if isinstance(value, (list, tuple)):
                places = [str(self._document.where("commands", number)) for number in range(len(value))]
                return tuple(validate_items(zip(value, places, strict=True)))
        except InputError as error:
            for line in str(error).splitlines():
                place, _, message = line.partition(f": {error.code} ")
                file, _, number = place.rpartition(":")
                where = Where(file, int(number)) if number.isdecimal() else Where(place)
                self._document.diagnostics.error(error.code, message, where)
            return ()
        self._wrong(value, "a list of {at, topic, message}, or the name of a file with such a list", "commands")
        return ()

    def _bag_duration(self) -> float:
        """Return the duration of the bag in the key `play` [s]; 10 s without a bag."""
        bag_name = self._fields.get("play")
        if bag_name is None and "play_topics" in self._fields:
            hint = "add play: BAG with the bag whose commands are sent"
            self._document.error("SK-SCEN-004", "'play_topics' needs 'play'", "play_topics", hint=hint)
        if not isinstance(bag_name, str) or not bag_name.strip():
            if "play" in self._fields:
                self._wrong(bag_name, "the name of a bag", "play")
            return 10.0
        file = self._document.path.parent / bag_name
        if not self._document.files.allows(file):  # reported with the other files
            return 10.0
        try:
            with open_bag_to_read(file) as bag:
                return bag.duration
        except InputError as error:
            self._document.error(error.code, f"play: {str(error).removeprefix(error.code).strip()}", "play")
            return 10.0

    def _code_requests(self) -> tuple[CodeRequest, ...]:
        folder, found = self._document.path.parent, self.texts("plugin_paths")
        places = [self._document.where("plugin_paths", number) for number in range(len(found))]
        return tuple(folder_request(one, folder / one, where) for one, where in zip(found, places, strict=True))

    # ------------------------------------------------------------------ comparison

    def _tolerances(self) -> list[Tolerance]:
        found = []
        for pattern, value in self._mapping("tolerances").items():
            keys = ("tolerances", pattern)
            where = str(self._document.where(*keys))
            if isinstance(value, str) and value in TOLERANCE_MODES:
                mode: JsonObject = {value: True}
                found.append(Tolerance(absolute_topic(pattern), **mode, where=where))
            elif isinstance(value, (int, float)) and not isinstance(value, bool):
                limit = self._number_of(value, None, keys, least=0.0)
                found.append(Tolerance(absolute_topic(pattern), absolute=limit, where=where))
            elif isinstance(value, dict):
                found.append(self._tolerance(pattern, value, where))
            else:
                words, names = ", ".join(TOLERANCE_MODES), ", ".join(_TOLERANCE_KEYS)
                self._wrong(value, f"a number, one of {words}, or a mapping of {names}", *keys)
        return found

    def _tolerance(self, pattern: str, value: Mapping[str, object], where: str) -> Tolerance:
        keys = ("tolerances", pattern)
        fields = self._document.only(value, _TOLERANCE_KEYS, "a tolerance", *keys)
        found: JsonObject = {}
        for key, one in fields.items():
            if key in TOLERANCE_MODES:
                if isinstance(one, bool):
                    found[key] = one
                else:
                    self._wrong(one, "true or false", *keys, key)
            else:
                found[key] = self._number_of(one, None, (*keys, key), least=-1.0 if key == "ssim" else 0.0)
                if key in ("share", "ssim") and (found[key] or 0.0) > 1.0:
                    self._wrong(one, "a number <= 1", *keys, key)
        modes = [key for key in TOLERANCE_MODES if found.get(key)]
        if len(modes) > 1:
            self._document.error("SK-SCEN-003", f"a tolerance can have only one of {', '.join(modes)}", *keys)
        return Tolerance(absolute_topic(pattern), where=where, **found)

    def _statistics(self) -> list[Tolerance]:
        where = str(self._document.where("statistics"))
        return [Tolerance(absolute_topic(one), statistics=True, where=where) for one in self.texts("statistics")]

    # ------------------------------------------------------------------ checks

    def _checks(self, key: str, kind: CheckKind) -> list[Check]:
        value = self._fields.get(key, ())
        if isinstance(value, dict) and kind == "rate":
            value = [{"topic": topic, "rate": rate} for topic, rate in value.items()]
        if isinstance(value, (str, dict, bool)):
            value = [value]
        if not isinstance(value, (list, tuple)):
            self._wrong(value, "a list", key)
            return []
        found = [self._check(one, kind, key, number) for number, one in enumerate(value)]
        return [check for check in found if check is not None]

    def _check(self, value: object, kind: CheckKind, key: str, number: int) -> Check | None:
        keys = (key, number)
        main = "topic" if kind == "rate" else "models" if kind == "apart" else "that"
        if isinstance(value, (str, {"that": bool, "models": list}.get(main, str))):
            value = {main: value}
        fields = self._document.only(value, _CHECK_KEYS[kind], f"an entry of {key}", *keys)
        if main not in fields:
            if isinstance(value, dict):
                self._document.error("SK-SCEN-004", f"an entry of {key} needs {main!r}", *keys)
            return None
        number_of = self._number_of
        rate = fields.get("rate", "own")
        return Check(
            kind,
            name=self._text_of(fields.get("name", ""), (*keys, "name")),
            expression=self._expression(self._text_of(fields[main], (*keys, main)), *keys) if main == "that" else "",
            by=number_of(fields.get("by"), None, (*keys, "by"), least=0.0),
            after=number_of(fields.get("after", 0.0), 0.0, (*keys, "after"), least=0.0) or 0.0,
            models=self._models(fields["models"], (*keys, "models")) if kind == "apart" else (),
            topic=absolute_topic(self._text_of(fields["topic"], (*keys, "topic"))) if kind == "rate" else "",
            rate=None if rate == "own" else number_of(rate, None, (*keys, "rate"), above=0.0),
            tolerance=number_of(fields.get("tolerance", 0.05), 0.05, (*keys, "tolerance"), least=0.0) or 0.0,
            points=number_of(fields.get("points", 1.0), 1.0, (*keys, "points"), least=0.0) or 0.0,
            hint=self._text_of(fields.get("hint", ""), (*keys, "hint")),
            where=str(self._document.where(*keys)),
        )

    def _expression(self, text: str, *keys: object) -> str:
        """Validate the syntax of an expression; names in the expression are resolved later in a world."""
        from simkit.testing.conditions import parse

        if text:
            try:
                parse(text)
            except InputError as error:
                message, _, hint = str(error).removeprefix(error.code).strip().partition("\n    help: ")
                self._document.error(error.code, message, *keys, hint=hint)
        return text

    def _text_of(self, value: object, keys: tuple[object, ...]) -> str:
        if isinstance(value, str) and (value.strip() or keys[-1] not in ("that", "topic")):
            return value
        if isinstance(value, bool) and keys[-1] == "that":  # YAML converts an unquoted true or false to a bool
            return str(value).lower()
        self._wrong(value, "a string (add quotes if YAML reads it as another type)", *keys)
        return ""

    def _models(self, value: Any, keys: tuple[object, ...]) -> tuple[str, ...]:
        listed = [value] if isinstance(value, str) else value
        are_names = isinstance(listed, list) and all(isinstance(one, str) and one.strip() for one in listed)
        if are_names and len(listed) == len(set(listed)) and len(listed) in (1, 2):
            return tuple(listed)
        self._wrong(value, "the name of one model or link, or two different names", *keys)
        return ()


def absolute_topic(topic: str) -> str:
    """Return a topic or topic pattern with a leading slash."""
    return topic if topic.startswith(("/", "*")) or not topic else "/" + topic
