"""Values of a resolved world as a flat table with one path for each value, including controller and motion files."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from simkit.diagnostics import Where
from simkit.input_file import open_input, read_input_text
from simkit.number_text import counted
from simkit.params import Params
from simkit.pose import Pose
from simkit.run_spec import JsonObject
from simkit.scene import SceneSensor, SceneWorld
from simkit.scene.model import NO_OPTICS, Optics
from simkit.yaml_reader import yaml_loader

if TYPE_CHECKING:
    from simkit.runtime import Simulation


_IGNORED_FIELDS: Final = frozenset(
    ("where", "name", "scoped", "uri", "script", "skin", "missing", "mjcf", "moved_by", "urdf", "renderer")
)
"""Fields with source positions or file names, fields that are part of the path, fields without plain values, and the
requested renderer: the fingerprint contains the renderer that was used."""
_SENSOR_FIELDS: Final = frozenset(("pose", "update_rate", "topic", "plugin"))
"""Elements that are left out because the sensor object has a field with the same value."""
WorldValues = JsonObject


def values_of_simulation(sim: Simulation) -> tuple[WorldValues, dict[str, str]]:
    """Return the values of a simulation's world and of the files that its plugins have read.

    Returns:
        Path -> number, text, or list of numbers (a pose is x, y, z and a quaternion w, x, y, z); path -> `file:line`.
    """
    leaves, places = values_of_world(sim.world)
    in_files, their_places, _ = values_of_files(plugin_value_files(sim))
    return {**leaves, **in_files}, {**places, **their_places}


def values_of_world(world: SceneWorld) -> tuple[WorldValues, dict[str, str]]:
    """Return the values of a world and their source positions, without a simulation."""
    walk = _WorldWalk()
    walk.dataclass(world, "", "")
    return walk.leaves, walk.places


def split_path(path: str) -> list[tuple[str, str]]:
    """Split a path into steps (field, key); the key may be empty, and the field of an attribute begins with `@`.

    In keys, `]` is written as `%5D` and `%` as `%25`; the result has the original characters.
    """
    steps: list[tuple[str, str]] = []
    at = 0
    while at < len(path):
        if path[at] == ".":
            at += 1
        start = at
        at += path[at : at + 1] == "@"
        while at < len(path) and path[at] not in ".[@":
            at += 1
        name, key = path[start:at], ""
        if path[at : at + 1] == "[":
            stop = path.find("]", at)
            stop = len(path) if stop < 0 else stop
            key, at = path[at + 1 : stop].replace("%5D", "]").replace("%25", "%"), stop + 1
        steps.append((name, key))
    return steps


def item_keys(items: Iterable[object]) -> list[str]:
    """Return keys for the items of a list: the name (`name#2` for a second one), else the index."""
    seen: dict[str, int] = {}
    keys = []
    for number, item in enumerate(items):
        name = str(getattr(item, "name", "") or getattr(item, "filename", ""))
        if not name:
            keys.append(str(number))
            continue
        seen[name] = seen.get(name, 0) + 1
        keys.append(name if seen[name] == 1 else f"{name}#{seen[name]}")
    return keys


def element_keys(elements: Iterable[Params]) -> list[str]:
    """Return keys for the child elements of one parent: `update_rate`, `left_joint[2]`, `plugin[drive]`.

    The key is the element's name. If several elements have the same name, the key adds the attribute `name` or a number
    from 1.
    """
    children = list(elements)
    equal: dict[str, list[Params]] = {}
    for child in children:
        equal.setdefault(child.name, []).append(child)
    keys = {}
    for name, several in equal.items():
        names = [child.attributes.get("name", "") for child in several]
        named = all(names) and len(set(names)) == len(names)
        for number, child in enumerate(several, 1):
            if named:
                keys[id(child)] = f"{name}[{escaped_key(child.attributes['name'])}]"
            else:
                keys[id(child)] = name if len(several) == 1 else f"{name}[{number}]"
    return [keys[id(child)] for child in children]


class _WorldWalk:
    """Visitor that collects the values of dataclasses and elements."""

    def __init__(self) -> None:
        self.leaves: WorldValues = {}
        self.places: dict[str, str] = {}

    def dataclass(self, value: object, path: str, place: str) -> None:
        where = getattr(value, "where", None)
        if isinstance(where, Where) and where.line:
            place = str(where)
        kind: object = type(value)
        for name in _field_names(kind):
            if name not in _IGNORED_FIELDS:
                self.value(getattr(value, name), f"{path}.{name}" if path else name, place, value)

    def value(self, value: object, path: str, place: str, owner: object = None) -> None:
        if value is None or callable(value):
            return
        if isinstance(value, (bool, int, float, str)):
            self._put(path, value, place)
        elif isinstance(value, Pose):
            self._put(path, [*map(float, value.position), *map(float, value.quaternion)], place)
        elif isinstance(value, Path):
            self._put(path, file_content_text(value), place)
        elif isinstance(value, Params):
            self.element(value, path, place, _SENSOR_FIELDS if isinstance(owner, SceneSensor) else frozenset())
        elif isinstance(value, Optics) and value == NO_OPTICS:
            return  # references from before this property existed stay valid
        elif is_dataclass(value):
            if shape_class_name(value):
                self._put(path, shape_class_name(value), place)
            self.dataclass(value, path, place)
        elif isinstance(value, Mapping):
            for key in sorted(value, key=str):
                self.value(value[key], f"{path}[{escaped_key(str(key))}]", place)
        elif isinstance(value, (tuple, list, frozenset)):
            self._items(value, path, place)

    def _items(self, items: Collection[object], path: str, place: str) -> None:
        if isinstance(items, frozenset):
            items = sorted(items, key=str)
        if all(_is_scalar(item) for item in items):
            if len(items):
                self._put(path, [_scalar(item) for item in items], place)
            return
        for key, item in zip(item_keys(items), items, strict=True):
            self.value(item, f"{path}[{escaped_key(key)}]", place)

    def element(self, params: Params, path: str, place: str, left_out: frozenset[str] = frozenset()) -> None:
        """Add an element and its children."""
        if params.where.line:
            place = str(params.where)
        for name, text in sorted(params.attributes.items()):
            self._put(f"{path}@{name}", _element_value(text), place)
        if params.value:
            self._put(path, _element_value(params.value), place)
        elif not params.children and not params.attributes:
            self._put(path, "", place)
        inner = [child for child in params.children if child.name not in left_out]
        for key, child in zip(element_keys(inner), inner, strict=True):
            self.element(child, f"{path}.{key}", place)

    def _put(self, path: str, value: object, place: str) -> None:
        self.leaves[path] = value
        if place:
            self.places[path] = place


def shape_class_name(value: object) -> str:
    """Return the class name of a shape; empty for other values."""
    kind = type(value)
    return kind.__name__ if kind.__module__ == "simkit.scene.geometry" else ""


@cache
def _field_names(kind: type) -> tuple[str, ...]:
    return tuple(field.name for field in fields(kind))


def _is_scalar(item: object) -> bool:
    return isinstance(item, (bool, int, float, str)) or (
        isinstance(item, (tuple, list)) and all(_is_scalar(element) for element in item)
    )


def _scalar(item: object) -> object:
    return [_scalar(element) for element in item] if isinstance(item, (tuple, list)) else item


def escaped_key(key: str) -> str:
    """Escape a name for the brackets of a path."""
    return key.replace("%", "%25").replace("]", "%5D")


def _element_value(text: str) -> object:
    """Convert the text of an element to numbers (`0.10` equals `0.1`), or the path of a file to its content hash."""
    words = text.split()
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        if text.startswith("/") and len(text) < 4096:
            path = Path(text)
            if path.is_file():
                return file_content_text(path)
            if path.is_dir():
                return path.name
        return " ".join(words)
    return numbers[0] if len(numbers) == 1 else numbers


def file_content_text(path: Path) -> str:
    """Return a short text for the content of a file: 16 characters of its SHA-256, and its size."""
    digest, size = file_hash(path)
    return f"{digest[:16]} ({counted(size, 'byte')})" if digest else "missing"


def file_hash(path: Path) -> tuple[str, int]:
    """Return the SHA-256 and the size of a file [bytes]; an empty text and 0 if the file cannot be read."""
    try:
        stat = path.stat()
        return _cached_file_hash(str(path), stat.st_mtime_ns, stat.st_size)
    except OSError:
        return "", 0


@cache
def _cached_file_hash(path: str, _: int, size: int) -> tuple[str, int]:
    with open_input(path) as file:
        return hashlib.file_digest(file, "sha256").hexdigest(), size


_SUFFIXES: Final = frozenset((".yaml", ".yml"))
_MAX_FILE_VALUES: Final = 100_000
_MAX_YAML_DEPTH: Final = 60
_PLAIN_YAML_VALUE: Final = re.compile(r"[\w/*:-]+")


def plugin_value_files(sim: Simulation) -> list[Path]:
    """Return the files with values that plugins have read, without duplicates."""
    return list(dict.fromkeys(path.resolve() for path in sim.engine.structure.builder.files_read))


def values_of_files(paths: Iterable[Path]) -> tuple[dict[str, object], dict[str, str], set[Path]]:
    """Read the values in YAML files.

    Args:
        paths: Files; other file types are ignored.

    Returns:
        Path of a value (`files[controllers.yaml].arm.gains.p`) -> value, `file:line`, and the files that were read.
    """
    leaves: dict[str, object] = {}
    places: dict[str, str] = {}
    read = set()
    for path in sorted(set(paths)):
        root = _parse_document(path)
        if root is None:
            continue
        taken = any(key.startswith(f"files[{path.name}]") for key in leaves)
        name = f"{path.parent.name}/{path.name}" if taken else path.name
        document: dict[str, tuple[object, int]] = {}
        if _flatten_document(root, f"files[{escaped_key(name)}]", document, 0):
            leaves.update({key: value for key, (value, _) in document.items()})
            places.update({key: f"{path}:{line}" for key, (_, line) in document.items()})
            read.add(path)
    return leaves, places, read


def _parse_document(path: Path) -> object:
    """Parse a YAML file; return None if the file is not YAML or is too large."""
    if path.suffix.lower() not in _SUFFIXES:
        return None
    import yaml

    try:
        return yaml.compose(read_input_text(path), Loader=yaml_loader())
    except (OSError, UnicodeDecodeError, yaml.YAMLError, RecursionError):
        return None


def _flatten_document(node: Any, path: str, values: dict[str, tuple[object, int]], depth: int) -> bool:
    """Add the values of a document; return False if the document is too large or contains itself."""
    if depth > _MAX_YAML_DEPTH or len(values) > _MAX_FILE_VALUES:
        return False
    line = node.start_mark.line + 1
    if node.id == "mapping":
        for key, value in node.value:
            name = str(key.value) if key.id == "scalar" else "?"
            step = f".{name}" if _PLAIN_YAML_VALUE.fullmatch(name) else f".of[{escaped_key(name)}]"
            if not _flatten_document(value, path + step, values, depth + 1):
                return False
        return True
    if node.id == "sequence":
        if all(item.id == "scalar" for item in node.value):
            values[path] = ([_yaml_scalar(item) for item in node.value], line)
            return True
        return all(_flatten_document(item, f"{path}.item[{n}]", values, depth + 1) for n, item in enumerate(node.value))
    values[path] = (_yaml_scalar(node), line)
    return True


def _yaml_scalar(node: Any) -> object:
    """Return the value of a YAML node: a number, True, False or a text."""
    try:
        return float(node.value) if not node.style else node.value
    except ValueError:
        return {"true": True, "false": False}.get(node.value.lower(), node.value) if not node.style else node.value
