"""Scenario files in Python: run the file, read the variable `scenario`, and validate its values."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from importlib.machinery import SourceFileLoader
from pathlib import Path
from typing import Any, Final, get_args

from simkit.diagnostics import Diagnostics, Where
from simkit.errors import InputError, LoadError
from simkit.linked_files import hide_linked_text
from simkit.recording.command_script import validate_items
from simkit.run_spec import Check, CheckKind, RunSpec, Tolerance
from simkit.run_values import spawns_in
from simkit.testing.scenarios.yaml_document import short_repr
from simkit.yaml_reader import finite_number

_TEXT_FIELDS: Final = ("overrides", "spawn", "topics", "skip")
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
        if not isinstance(value, (tuple, list)) or not all(isinstance(one, str) for one in value):
            yield _problem(key, value, "a tuple of strings")
    yield from _validate_commands(scenario.commands)
    for key, kind in (("checks", Check), ("tolerances", Tolerance)):
        value = getattr(scenario, key)
        if not isinstance(value, (tuple, list)) or not all(isinstance(one, kind) for one in value):
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
    if not isinstance(models, (tuple, list)) or not all(isinstance(one, str) for one in models):
        yield _problem(f"{label}models", models, "a tuple of strings")
    yield from _validate_numbers(label, check, by=True, after=False, rate=True, tolerance=False, points=False)


def _validate_numbers(label: str, of: object, **may_be_none: bool) -> Iterator[str]:
    for key, is_free in may_be_none.items():
        value = getattr(of, key)
        number = finite_number(value)
        if (number is None or number < 0.0) and not (is_free and value is None):
            yield _problem(f"{label}{key}", value, "a number >= 0" + (", or None" if is_free else ""))


def _validate_commands(commands: object) -> Iterator[str]:
    if not isinstance(commands, (tuple, list)) or not all(isinstance(one, Mapping) for one in commands):
        yield _problem("commands", commands, "a tuple of mappings with at, topic and message")
        return
    try:
        validate_items((dict(one), f"commands[{number}]") for number, one in enumerate(commands))
    except InputError as error:
        yield from (line.replace(f" {error.code}", "", 1) for line in str(error).splitlines())


def _is_valid_text(of: object, key: str) -> bool:
    return isinstance(getattr(of, key), str)


def _problem(key: str, value: object, allowed: str) -> str:
    return f"{key}: found {value!r:.60}, expected {allowed}"


class _UncachedLoader(SourceFileLoader):
    """Loader that writes no byte code: the folder of a scenario gets no copy of a file that a link leads to."""

    def set_data(self, path: str, data: Any, *, _mode: int = 0o666) -> None:
        """Write nothing."""


def load_python_scenario(file: Path, diagnostics: Diagnostics) -> RunSpec:
    """Run a Python file and return its `scenario`.

    Raises:
        LoadError: SK-SCEN-001 the file does not exist; SK-SCEN-005 the file failed or has no scenario;
            SK-SCEN-003 for every invalid value.
    """
    where = Where(str(file))
    problem: Callable[..., None] = diagnostics.error
    found: Any = None
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
    found = getattr(module, "scenario", None)
    if not isinstance(found, RunSpec):
        hint = "from simkit import RunSpec; scenario = RunSpec(world=..., duration=...)"
        problem("SK-SCEN-005", f"'scenario' is {short_repr(found)}, expected a RunSpec", where, hint)
        raise LoadError(tuple(diagnostics))
    for message in validate_scenario(found):
        problem("SK-SCEN-003", message, where)
    diagnostics.raise_if_errors()
    folder = file.parent if found.folder == Path() else found.folder
    return replace(found, folder=folder, file=file, spawn=spawns_in(folder, tuple(map(str, found.spawn))))


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
