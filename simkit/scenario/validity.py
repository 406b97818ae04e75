"""What is wrong with the values of a scenario that was made in Python; a YAML file's are looked at as they are read."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final, get_args

from simkit.errors import InputError
from simkit.scenario.scenario import Check, CheckKind, Scenario, Tolerance
from simkit.sinks.yaml_text import finite_number

_TEXTS: Final = ("overrides", "spawn", "topics", "skip")
_KINDS: Final = get_args(CheckKind)


def problems_of(scenario: Scenario) -> Iterator[str]:
    """Each as `attribute: found …, allowed is …`."""
    if not isinstance(scenario.world, str) or not scenario.world.strip():
        yield _wrong("world", scenario.world, "a file, a bare name, or XML text")
    yield from _numbers("", scenario, duration=False, timeout=True, wall_timeout=True)
    for key, least in (("seed", 0), ("picture", 8)):
        value = getattr(scenario, key)
        if not isinstance(value, int) or isinstance(value, bool) or value < least:
            yield _wrong(key, value, f"a whole number of at least {least}")
    for key in ("name", "until"):
        if not _is_text(scenario, key):
            yield _wrong(key, getattr(scenario, key), "a text")
    for key in _TEXTS:
        value = getattr(scenario, key)
        if not isinstance(value, (tuple, list)) or not all(isinstance(one, str) for one in value):
            yield _wrong(key, value, "a tuple of texts")
    yield from _commands(scenario.commands)
    for key, kind in (("checks", Check), ("tolerances", Tolerance)):
        value = getattr(scenario, key)
        if not isinstance(value, (tuple, list)) or not all(isinstance(one, kind) for one in value):
            yield _wrong(key, value, f"a tuple of {kind.__name__}")
        elif kind is Check:
            for number, check in enumerate(value):
                yield from _check(f"checks[{number}].", check)


def _check(label: str, check: Check) -> Iterator[str]:
    if check.kind not in _KINDS:
        yield _wrong(f"{label}kind", check.kind, f"one of {', '.join(_KINDS)}")
    yield from (
        _wrong(f"{label}{key}", getattr(check, key), "a text")
        for key in ("name", "expression", "topic", "hint")
        if not _is_text(check, key)
    )
    models: Any = check.models
    if not isinstance(models, (tuple, list)) or not all(isinstance(one, str) for one in models):
        yield _wrong(f"{label}models", models, "a tuple of texts")
    yield from _numbers(label, check, by=True, after=False, rate=True, tolerance=False, points=False)


def _numbers(label: str, of: Any, **may_be_none: bool) -> Iterator[str]:
    for key, is_free in may_be_none.items():
        value = getattr(of, key)
        number = finite_number(value)
        if (number is None or number < 0.0) and not (is_free and value is None):
            yield _wrong(f"{label}{key}", value, "a number of at least 0" + (", or None" if is_free else ""))


def _commands(commands: Any) -> Iterator[str]:
    from simkit.sinks.commands import placed_items

    if not isinstance(commands, (tuple, list)) or not all(isinstance(one, Mapping) for one in commands):
        yield _wrong("commands", commands, "a tuple of mappings with at, topic and message")
        return
    try:
        placed_items((dict(one), f"commands[{number}]") for number, one in enumerate(commands))
    except InputError as error:
        yield from (line.replace(f" {error.code}", "", 1) for line in str(error).splitlines())


def _is_text(of: Any, key: str) -> bool:
    return isinstance(getattr(of, key), str)


def _wrong(key: str, value: Any, allowed: str) -> str:
    return f"{key}: found {value!r:.60}, allowed is {allowed}"
