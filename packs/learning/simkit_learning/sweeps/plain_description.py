"""Descriptions of run specifications, metrics and other values as plain data, for the fingerprint of a sweep.

A stored sweep continues only with an equal fingerprint. Descriptions therefore stay equal from version to version: they
do not depend on the present module of simkit's own classes, nor on fields that came later and have their defaults.
"""

from __future__ import annotations

import functools
import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import MISSING, fields, is_dataclass
from pathlib import Path
from types import CellType, CodeType, FunctionType, MethodType
from typing import Final, TypeAlias, cast

from simkit.moved_modules import first_name
from simkit.packs import is_shipped

Plain: TypeAlias = "bool | int | float | str | list[Plain] | dict[str, Plain] | None"
"""Plain data, as in JSON."""
_Seen: TypeAlias = dict[int, tuple[int, object]]
"""Objects that are described already, by identity: their number, and the object itself, which thus lives on."""

_PLACES: Final = ("file", "folder", "where", "code_requests", "diagnostics")
"""Fields that say where a value stands, which differs between machines and working folders, or what is allowed."""
_FIRST_FIELDS: Final[Mapping[str, tuple[str, ...]]] = {
    "RunSpec": (
        "world", "duration", "seed", "name", "overrides", "spawn", "model_world", "commands", "plugins", "topics",
        "skip", "tolerances", "state", "model", "picture", "until", "timeout", "wall_timeout", "checks", "options",
        "test", "bits", "play", "play_topics", "velocity", "script", "recording", "pace", "paused", "steps",
        "change_world",
    ),
    "Check": (
        "kind", "name", "expression", "by", "after", "models", "topic", "rate", "tolerance", "points", "hint",
    ),
    "Tolerance": (
        "pattern", "absolute", "relative", "share", "image", "ssim", "statistics", "ignore", "exact",
    ),
    "Recording": ("path", "overwrite"),
    "SpawnedModel": ("source", "place", "name"),
}  # fmt: skip
"""Fields of simkit's dataclasses that each description has. Later fields are described if they have no default value.

Do not add names: stored sweeps have these fields in their fingerprints, and no others with default values.
"""


def plain_description(value: object, seen: _Seen | None = None) -> Plain:
    """Return any value as plain data that is equal in all processes; functions are described by their names.

    Args:
        value: value to describe.
        seen: objects that are described already.
    """
    seen = {} if seen is None else seen
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, Mapping):
        return {str(key): plain_description(item, seen) for key, item in value.items() if key != "where"}
    if isinstance(value, range) and len(value) > 1000:
        return repr(value)
    if isinstance(value, (set, frozenset)):
        return sorted((plain_description(item, seen) for item in value), key=repr)
    if isinstance(value, (list, tuple, range)):
        return [plain_description(item, seen) for item in value]
    if is_dataclass(value) and not isinstance(value, type):
        described = {name: plain_description(content, seen) for name, content in _described_fields(value)}
        return {"type": type(value).__name__, **described}
    if isinstance(value, Path):
        return str(value)
    if isinstance(value, functools.partial):
        return [plain_description(part, seen) for part in (value.func, value.args, value.keywords)]
    if hasattr(value, "tolist"):  # an array or a number of NumPy
        return cast(Plain, value.tolist())
    if isinstance(value, MethodType):
        return [plain_description(value.__func__, seen), plain_description(value.__self__, seen)]
    if isinstance(value, FunctionType):
        cells = [_cell_content(cell) for cell in value.__closure__ or ()]
        bound = plain_description([value.__defaults__, value.__kwdefaults__, *cells], seen)
        return [f"{first_name(value.__module__)}.{value.__qualname__}", _code_hash(value.__code__), bound]
    if text := getattr(value, "fingerprint_text", ""):  # a `FileMetric`
        return str(text)
    if name := getattr(value, "__qualname__", ""):  # a class
        return f"{first_name(value.__module__)}.{name}"
    return _object_description(value, seen)


def _described_fields(value: object) -> Iterator[tuple[str, object]]:
    """Yield name and value of those fields of a dataclass that belong to its description."""
    first = _FIRST_FIELDS.get(type(value).__name__) if is_shipped(type(value)) else None
    for field in fields(value):  # type: ignore[arg-type]  # a dataclass
        content = getattr(value, field.name)
        if field.name in _PLACES:
            continue
        if first is not None and field.name not in first:
            default = field.default if field.default_factory is MISSING else field.default_factory()
            if content == default:
                continue
        yield field.name, content


def _object_description(value: object, seen: _Seen) -> Plain:
    """Return the class of an object with the code of its methods, and its attributes; MuJoCo's objects have none."""
    if id(value) in seen:
        return f"again object {seen[id(value)][0]}"
    seen[id(value)] = len(seen), value
    kind = type(value)
    methods: list[Plain] = []
    if not is_shipped(kind):
        functions = [member for _, member in sorted(vars(kind).items()) if isinstance(member, FunctionType)]
        methods += [_code_hash(function.__code__) for function in functions]
    attributes = {name: item for name, item in getattr(value, "__dict__", {}).items() if not name.startswith("__")}
    return [f"a {first_name(kind.__module__)}.{kind.__qualname__}", methods, plain_description(attributes, seen)]


def _constant_text(value: object) -> str:
    return repr(sorted(map(repr, value))) if isinstance(value, frozenset) else repr(value)


def _cell_content(cell: CellType) -> object:
    """Return the content of a variable of an outer function; None for a function or a variable without a value."""
    try:
        return None if isinstance(cell.cell_contents, FunctionType) else cell.cell_contents
    except ValueError:
        return None


def _code_hash(code: CodeType) -> str:
    """Return a hash of a function's code that does not depend on its file and lines."""
    inner = [
        _code_hash(constant) if isinstance(constant, CodeType) else _constant_text(constant)
        for constant in code.co_consts
    ]
    return hashlib.sha256(repr((code.co_code, inner, code.co_names)).encode()).hexdigest()[:16]
