"""Scenario files: YAML, or Python with a variable `scenario`.

All problems of a file are reported at once, with file and line.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import fields, replace
from importlib.machinery import SourceFileLoader
from pathlib import Path
from typing import Final, get_args

from simkit.code_requests import CodeRequest, folder_request, node_requests
from simkit.diagnostics import Diagnostics, Where
from simkit.errors import InputError, LoadError
from simkit.linked_files import hide_linked_text
from simkit.recording.bags.reader import open_bag_to_read
from simkit.recording.command_script import script_items, validate_items
from simkit.run_fields import RunField
from simkit.run_files import FileName
from simkit.run_nodes import NODE_KEYS, Node, node_arguments
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
from simkit.run_values import spawns_in
from simkit.testing.scenarios.code_permission import permit_code
from simkit.testing.scenarios.yaml_document import (
    Document,
    ValueReader,
    short_repr,
)
from simkit.yaml_reader import finite_number

_TEXT_FIELDS: Final = ("overrides", "topics", "skip")
_CHECK_KINDS: Final = get_args(CheckKind)


def validate_scenario(scenario: RunSpec) -> Iterator[str]:
    """Yield a message `attribute: found …, expected …` for each invalid value."""
    if not isinstance(scenario.world, str) or not scenario.world.strip():
        yield _problem("world", scenario.world, "a file, a bare name, or XML text")
    yield from _validate_numbers("", scenario, duration=False, timeout=True, wall_timeout=True)
    for key, least in (("seed", 0), ("picture", 8)):
        value = getattr(scenario, key)
        if not isinstance(value, int) or isinstance(value, bool) or value < least:
            yield _problem(key, value, f"an integer >= {least}")
    for key in ("name", "until"):
        if not _is_valid_text(scenario, key):
            yield _problem(key, getattr(scenario, key), "a string")
    for key in _TEXT_FIELDS:
        value = getattr(scenario, key)
        if not isinstance(value, (tuple, list)) or not all(isinstance(item, str) for item in value):
            yield _problem(key, value, "a tuple of strings")
    spawn: object = scenario.spawn
    if not isinstance(spawn, (tuple, list)) or any(isinstance(model, (int, float, type(None))) for model in spawn):
        yield _problem("spawn", spawn, "a tuple of strings and mappings")
    yield from _validate_commands(scenario.commands)
    for key, kind in (("checks", Check), ("tolerances", Tolerance)):
        value = getattr(scenario, key)
        if not isinstance(value, (tuple, list)) or not all(isinstance(item, kind) for item in value):
            yield _problem(key, value, f"a tuple of {kind.__name__}")
        elif kind is Check:
            for number, check in enumerate(value):
                yield from _validate_check(f"checks[{number}].", check)


def _validate_check(label: str, check: Check) -> Iterator[str]:
    if check.kind not in _CHECK_KINDS:
        yield _problem(f"{label}kind", check.kind, f"one of {', '.join(_CHECK_KINDS)}")
    yield from (
        _problem(f"{label}{key}", getattr(check, key), "a string")
        for key in ("name", "expression", "topic", "hint")
        if not _is_valid_text(check, key)
    )
    models: object = check.models
    if not isinstance(models, (tuple, list)) or not all(isinstance(name, str) for name in models):
        yield _problem(f"{label}models", models, "a tuple of strings")
    yield from _validate_numbers(label, check, by=True, after=False, rate=True, tolerance=False, points=False)


def _validate_numbers(label: str, of: object, **may_be_none: bool) -> Iterator[str]:
    for key, is_free in may_be_none.items():
        value = getattr(of, key)
        number = finite_number(value)
        if (number is None or number < 0.0) and not (is_free and value is None):
            yield _problem(f"{label}{key}", value, "a number >= 0" + (", or None" if is_free else ""))


def _validate_commands(commands: object) -> Iterator[str]:
    if not isinstance(commands, (tuple, list)) or not all(isinstance(command, Mapping) for command in commands):
        yield _problem("commands", commands, "a tuple of mappings with at, topic and message")
        return
    try:
        validate_items((dict(command), f"commands[{number}]") for number, command in enumerate(commands))
    except InputError as error:
        yield from (line.replace(f" {error.code}", "", 1) for line in str(error).splitlines())


def _is_valid_text(of: object, key: str) -> bool:
    return isinstance(getattr(of, key), str)


def _problem(key: str, value: object, allowed: str) -> str:
    return f"{key}: found {value!r:.60}, expected {allowed}"


class _UncachedLoader(SourceFileLoader):
    """Loader that writes no byte code: the folder of a scenario gets no copy of a file that a link leads to."""

    def set_data(self, path: str, data: object, *, _mode: int = 0o666) -> None:
        """Write nothing."""


def load_python_scenario(file: Path, diagnostics: Diagnostics) -> RunSpec:
    """Run a Python file and return its `scenario`.

    Raises:
        LoadError: SK-SCEN-001 the file does not exist; SK-SCEN-005 the file failed or has no scenario;
            SK-SCEN-003 for every invalid value.
    """
    where = Where(str(file))
    problem: Callable[..., None] = diagnostics.error
    scenario: object = None
    name = f"simkit_scenario_{file.stem}"
    spec = importlib.util.spec_from_file_location(name, file, loader=_UncachedLoader(name, str(file)))
    if spec is None or spec.loader is None or not file.is_file():
        problem("SK-SCEN-001", "cannot be read: the file does not exist", where)
        raise LoadError(tuple(diagnostics))
    hide_linked_text(file)
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        line = _error_line(error, file)
        problem("SK-SCEN-005", f"running the file failed: {type(error).__name__}: {error}", Where(str(file), line))
        raise LoadError(tuple(diagnostics)) from error
    scenario = getattr(module, "scenario", None)
    if not isinstance(scenario, RunSpec):
        hint = "from simkit import RunSpec; scenario = RunSpec(world=..., duration=...)"
        problem("SK-SCEN-005", f"'scenario' is {short_repr(scenario)}, expected a RunSpec", where, hint)
        raise LoadError(tuple(diagnostics))
    for message in validate_scenario(scenario):
        problem("SK-SCEN-003", message, where)
    diagnostics.raise_if_errors()
    folder = file.parent if scenario.folder == Path() else scenario.folder
    return replace(scenario, folder=folder, file=file, spawn=spawns_in(folder, scenario.spawn))


def _error_line(error: BaseException, file: Path) -> int | None:
    """Return the last line of a file in the traceback of an error."""
    if isinstance(error, SyntaxError) and error.filename == str(file):
        return error.lineno
    line, trace = None, error.__traceback__
    while trace is not None:
        if trace.tb_frame.f_code.co_filename == str(file):
            line = trace.tb_lineno
        trace = trace.tb_next
    return line


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
    return (*_OWN_KEYS, *(described.key for described in run_fields().values() if described.key is not None))


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


def read_run(world: str, usual_duration: float = 10.0, folders: Sequence[FilePath] = ()) -> RunSpec:
    """Return the run specification of a world or scenario file, with the requests of the file for code.

    Args:
        world: world or scenario file.
        usual_duration: simulated time of a world without a scenario [s].
        folders: folders of the user in which a scenario may name files.

    Raises:
        LoadError: the scenario file has errors.
    """
    if "<" not in world and is_scenario_file(world):
        return read_scenario(world, folders)
    return RunSpec(world, duration=usual_duration)


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
        diagnostics.error(error.code, error.message, Where(str(scenario.file)), error.help)


def parse_scenario(document: Document, *, also: tuple[str, ...] = ()) -> RunSpec:
    """Parse a scenario document; problems are added to its diagnostics.

    Args:
        document: Document of a scenario file.
        also: Additional keys that the caller reads.
    """
    if document.values is None:
        document.values = {}
    fields = document.only(document.values, scenario_keys() + also, "a scenario")
    if isinstance(document.values, dict) and "world" not in fields and "launch" not in fields:
        document.error("SK-SCEN-004", "missing 'world'", hint="add world: FILE or the name of a bundled world")
    if "launch" in fields and "world" in fields:
        message = "'launch' and 'world' both name the world"
        document.error("SK-SCEN-003", message, "launch", hint="keep one of them: a launch file starts its own world")
    if "arguments" in fields and "launch" not in fields:
        document.error("SK-SCEN-004", "'arguments' needs 'launch'", "arguments", hint="add launch: FILE")
    return ScenarioReader(document, fields).scenario()


def read_node(
    document: Document, node: object, at: tuple[object, ...], *, names_program: bool = True
) -> Mapping[str, object]:
    """Return a node that is a mapping; unknown keys and values of a wrong type are reported.

    Args:
        document: Document.
        node: Value in the document.
        at: Keys of the value.
        names_program: False if the program is not a part of the document.
    """
    keys = tuple(key for key in NODE_KEYS if names_program or key != "program")
    return _NodeReader(document, document.only(node, keys, "a node", *at), at).node()


class _NodeReader(ValueReader):
    """Reader of the values of a node."""

    def node(self) -> Mapping[str, object]:
        texts = ("program", "name", "namespace", "label", "cwd")
        values: dict[str, object] = {key: self.text(key, "") for key in texts}
        values |= {"remap": self._strings("remap"), "params": self._mapping("params"), "args": self.texts("args")}
        values |= {"after": self._strings("after"), "env": self._strings("env")}
        return {**self._fields, **{key: value for key, value in values.items() if key in self._fields}}


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
        spec = RunSpec(
            world=self.text("world", ""),
            duration=duration,
            commands=self._commands(),
            tolerances=(*self._tolerances(), *self._statistics()),
            checks=tuple(check for key, kind in _CHECKS.items() for check in self._checks(key, kind)),
            folder=folder,
            file=self._document.path,
        )
        values = {
            name: self._value(described, duration)
            for name, described in run_fields().items()
            if described.key in self._fields
        }
        spec = spec.with_values(values).with_files(self._in_folder)
        spec = replace(spec, code_requests=self._code_requests(spec.nodes))
        refused = [self._document.refuses(described, *keys) for keys, described in self._document.files.refused(spec)]
        return replace(spec, world="") if refused else spec  # nobody reads the world of such a file

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
        if described.name == "nodes":
            return self._nodes()
        value = described.kind.read(self, described.key, duration if described.key == "duration" else described.default)
        return self._expression(value, "until") if described.key == "until" else value

    def _in_folder(self, name: FileName) -> object:
        """Return a name of a file that starts from the working directory instead of the folder of the document."""
        path = name.path_in(self._document.path.parent)
        if path is None or name.role in ("world", "program", "bag"):  # a run looks for these in its own folder
            return name.text
        return str(path) if name.role in ("model", "file") else path

    def _overrides(self) -> tuple[str, ...]:
        if isinstance(self._fields.get("set"), dict):
            return tuple(f"{path}={text}" for path, text in self._strings("set").items())
        return self.texts("set")

    def _xacro_arguments(self) -> dict[str, str]:
        """Return the arguments of xacro files: a mapping, or a list of `NAME:=VALUE` texts."""
        if isinstance(self._fields["xacro_args"], dict):
            return self._strings("xacro_args")
        arguments: dict[str, str] = {}
        for number, text in enumerate(self.texts("xacro_args")):
            try:
                arguments |= named_values((text,), "xacro_args")
            except InputError:
                self._wrong(text, "NAME:=VALUE or NAME=VALUE", "xacro_args", number)
        return arguments

    def _nodes(self) -> tuple[Node, ...]:
        """Return the nodes: texts, or mappings; invalid ones are reported and left out."""
        nodes = []
        for number, node in enumerate(self.entries("nodes")):
            at = ("nodes", number)
            try:
                if not isinstance(node, str):
                    node = read_node(self._document, node, at)
                node_arguments(node)
            except InputError as error:
                self._document.error("SK-SCEN-003", f"nodes.{number}: {error.message}", *at, hint=error.help)
            else:
                nodes.append(node)
        return tuple(nodes)

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
            self._document.error(error.code, f"play: {error.message}", "play", hint=error.help)
            return 10.0

    def _code_requests(self, nodes: Sequence[Node]) -> tuple[CodeRequest, ...]:
        folder, names = self._document.path.parent, self.texts("plugin_paths")
        places = [self._document.where("plugin_paths", number) for number in range(len(names))]
        folders = (folder_request(name, folder / name, where) for name, where in zip(names, places, strict=True))
        requests = (*folders, *node_requests(nodes, folder, lambda number: self._document.where("nodes", number)))
        launch = self._fields.get("launch")
        if not isinstance(launch, str) or not launch:
            return requests
        file = FileName(launch, "program", ("launch",)).used_path(folder)
        words = f"launch names the launch file {launch!r:.200}"
        return (*requests, CodeRequest(words, file, self._document.where("launch")))

    # ------------------------------------------------------------------ comparison

    def _tolerances(self) -> list[Tolerance]:
        tolerances = []
        for pattern, value in self._mapping("tolerances").items():
            keys = ("tolerances", pattern)
            where = str(self._document.where(*keys))
            if isinstance(value, str) and value in TOLERANCE_MODES:
                mode: JsonObject = {value: True}
                tolerances.append(Tolerance(absolute_topic(pattern), **mode, where=where))
            elif isinstance(value, (int, float)) and not isinstance(value, bool):
                limit = self._number_of(value, None, keys, least=0.0)
                tolerances.append(Tolerance(absolute_topic(pattern), absolute=limit, where=where))
            elif isinstance(value, dict):
                tolerances.append(self._tolerance(pattern, value, where))
            else:
                words, names = ", ".join(TOLERANCE_MODES), ", ".join(_TOLERANCE_KEYS)
                self._wrong(value, f"a number, one of {words}, or a mapping of {names}", *keys)
        return tolerances

    def _tolerance(self, pattern: str, value: Mapping[str, object], where: str) -> Tolerance:
        keys = ("tolerances", pattern)
        fields = self._document.only(value, _TOLERANCE_KEYS, "a tolerance", *keys)
        options: JsonObject = {}
        for key, item in fields.items():
            if key in TOLERANCE_MODES:
                if isinstance(item, bool):
                    options[key] = item
                else:
                    self._wrong(item, "true or false", *keys, key)
            else:
                options[key] = self._number_of(item, None, (*keys, key), least=-1.0 if key == "ssim" else 0.0)
                if key in ("share", "ssim") and (options[key] or 0.0) > 1.0:
                    self._wrong(item, "a number <= 1", *keys, key)
        modes = [key for key in TOLERANCE_MODES if options.get(key)]
        if len(modes) > 1:
            self._document.error("SK-SCEN-003", f"a tolerance can have only one of {', '.join(modes)}", *keys)
        return Tolerance(absolute_topic(pattern), where=where, **options)

    def _statistics(self) -> list[Tolerance]:
        where = str(self._document.where("statistics"))
        return [Tolerance(absolute_topic(topic), statistics=True, where=where) for topic in self.texts("statistics")]

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
        checks = [self._check(item, kind, key, number) for number, item in enumerate(value)]
        return [check for check in checks if check is not None]

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
                self._document.error(error.code, error.message, *keys, hint=error.help)
        return text

    def _text_of(self, value: object, keys: tuple[object, ...]) -> str:
        if isinstance(value, str) and (value.strip() or keys[-1] not in ("that", "topic")):
            return value
        if isinstance(value, bool) and keys[-1] == "that":  # YAML converts an unquoted true or false to a bool
            return str(value).lower()
        self._wrong(value, "a string (add quotes if YAML reads it as another type)", *keys)
        return ""

    def _models(self, value: object, keys: tuple[object, ...]) -> tuple[str, ...]:
        names = [value] if isinstance(value, str) else value
        are_names = isinstance(names, list) and all(isinstance(name, str) and name.strip() for name in names)
        if isinstance(names, list) and are_names and len(names) == len(set(names)) and len(names) in (1, 2):
            return tuple(names)
        self._wrong(value, "the name of one model or link, or two different names", *keys)
        return ()


def absolute_topic(topic: str) -> str:
    """Return a topic or topic pattern with a leading slash."""
    return topic if topic.startswith(("/", "*")) or not topic else "/" + topic
