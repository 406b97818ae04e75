"""What a world means once resolved, flat: a path for each value.

A path follows the scene's dataclasses, and items of a list go by their names, so that the order in a file does not
show.

    models[turtlebot3].links[wheel_left_link].collisions[collision].geometry          "Cylinder"
    models[turtlebot3].links[wheel_left_link].collisions[collision].geometry.radius   0.033
    models[turtlebot3].plugins[gz::sim::systems::DiffDrive].params.wheel_separation   0.16
    models[turtlebot3].plugins[gz::sim::systems::DiffDrive].params.left_joint[2]      "wheel_rear_joint"
    models[turtlebot3].links[base].sensors[camera].params.camera.image@encoding       "rgb8"
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from simkit.diagnostics import Where
from simkit.params import Params
from simkit.pose import Pose
from simkit.scene import SceneSensor, SceneWorld

if TYPE_CHECKING:
    from simkit.runtime import Simulation

_LEFT_OUT: Final = frozenset(("where", "name", "scoped", "uri", "script", "skin", "missing", "mjcf", "moved_by"))
"""Fields that are places or names of files, or that are in the path already, or no plain values."""
_OF_SENSOR: Final = frozenset(("pose", "update_rate", "topic", "plugin"))
"""Elements of a sensor that are fields of it as well."""
Leaves = dict[str, Any]


def leaves_of(sim: Simulation) -> tuple[Leaves, dict[str, str]]:
    """The values that a simulation's world is made of.

    Returns:
        Path -> number, text, or list of numbers (a pose is x, y, z and a quaternion w, x, y, z); path -> `file:line`.
    """
    from simkit.golden.value_files import files_read, leaves_of_files

    leaves, places = leaves_of_world(sim.world)
    in_files, their_places, _ = leaves_of_files(files_read(sim))
    return {**leaves, **in_files}, {**places, **their_places}


def leaves_of_world(world: SceneWorld) -> tuple[Leaves, dict[str, str]]:
    """The same of a world that is not simulated."""
    walk = _Walk()
    walk.dataclass(world, "", "")
    return walk.leaves, walk.places


def split_path(path: str) -> list[tuple[str, str]]:
    """The steps of a path: (field, key), the key empty where there is none; an attribute's field begins with `@`.

    Names in brackets have `]` as `%5D` and `%` as `%25`; they come back as they are.
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


def keys_of(items: Iterable[Any]) -> list[str]:
    """What the items of a list go by in paths: their name (of a second one `name#2`), else their number from 0."""
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


def keys_of_elements(elements: Iterable[Params]) -> list[str]:
    """What elements of one parent go by: their own names, with the attribute `name` or a number from 1 where several
    have the same: `update_rate`, `left_joint[2]`, `plugin[drive]`."""
    found = list(elements)
    equal: dict[str, list[Params]] = {}
    for one in found:
        equal.setdefault(one.name, []).append(one)
    keys = {}
    for name, several in equal.items():
        names = [one.attributes.get("name", "") for one in several]
        named = all(names) and len(set(names)) == len(names)
        for number, one in enumerate(several, 1):
            if named:
                keys[id(one)] = f"{name}[{_escaped(one.attributes['name'])}]"
            else:
                keys[id(one)] = name if len(several) == 1 else f"{name}[{number}]"
    return [keys[id(one)] for one in found]


class _Walk:
    """Goes through dataclasses and elements."""

    def __init__(self) -> None:
        self.leaves: Leaves = {}
        self.places: dict[str, str] = {}

    def dataclass(self, value: Any, path: str, place: str) -> None:
        where = getattr(value, "where", None)
        if isinstance(where, Where) and where.line:
            place = str(where)
        kind: Any = type(value)
        for name in _field_names(kind):
            if name not in _LEFT_OUT:
                self.value(getattr(value, name), f"{path}.{name}" if path else name, place, value)

    def value(self, value: Any, path: str, place: str, owner: Any = None) -> None:
        if value is None or callable(value):
            return
        if isinstance(value, (bool, int, float, str)):
            self._put(path, value, place)
        elif isinstance(value, Pose):
            self._put(path, [*map(float, value.position), *map(float, value.quaternion)], place)
        elif isinstance(value, Path):
            self._put(path, content_of(value), place)
        elif isinstance(value, Params):
            self.element(value, path, place, _OF_SENSOR if isinstance(owner, SceneSensor) else frozenset())
        elif is_dataclass(value):
            if name_of_kind(value):
                self._put(path, name_of_kind(value), place)
            self.dataclass(value, path, place)
        elif isinstance(value, Mapping):
            for key in sorted(value, key=str):
                self.value(value[key], f"{path}[{_escaped(str(key))}]", place)
        elif isinstance(value, (tuple, list, frozenset)):
            self._items(value, path, place)

    def _items(self, items: Any, path: str, place: str) -> None:
        if isinstance(items, frozenset):
            items = sorted(items, key=str)
        if all(_is_plain(item) for item in items):
            if len(items):
                self._put(path, [_plain(item) for item in items], place)
            return
        for key, item in zip(keys_of(items), items, strict=True):
            self.value(item, f"{path}[{_escaped(key)}]", place)

    def element(self, params: Params, path: str, place: str, left_out: frozenset[str] = frozenset()) -> None:
        """An element with what is in it."""
        if params.where.line:
            place = str(params.where)
        for name, text in sorted(params.attributes.items()):
            self._put(f"{path}@{name}", _read(text), place)
        if params.value:
            self._put(path, _read(params.value), place)
        elif not params.children and not params.attributes:
            self._put(path, "", place)
        inner = [child for child in params.children if child.name not in left_out]
        for key, child in zip(keys_of_elements(inner), inner, strict=True):
            self.element(child, f"{path}.{key}", place)

    def _put(self, path: str, value: Any, place: str) -> None:
        self.leaves[path] = value
        if place:
            self.places[path] = place


def name_of_kind(value: Any) -> str:
    """The class of what may be of several: shapes."""
    kind = type(value)
    return kind.__name__ if kind.__module__ == "simkit.scene.geometry" else ""


@cache
def _field_names(kind: Any) -> tuple[str, ...]:
    return tuple(field.name for field in fields(kind))


def _is_plain(item: Any) -> bool:
    return isinstance(item, (bool, int, float, str)) or (
        isinstance(item, (tuple, list)) and all(_is_plain(one) for one in item)
    )


def _plain(item: Any) -> Any:
    return [_plain(one) for one in item] if isinstance(item, (tuple, list)) else item


def _escaped(key: str) -> str:
    return key.replace("%", "%25").replace("]", "%5D")


def _read(text: str) -> Any:
    """The text of an element: numbers where it is some, so that `0.10` is `0.1`; files by what is in them."""
    words = text.split()
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        if text.startswith("/") and len(text) < 4096:
            path = Path(text)
            if path.is_file():
                return content_of(path)
            if path.is_dir():
                return path.name
        return " ".join(words)
    return numbers[0] if len(numbers) == 1 else numbers


def content_of(path: Path) -> str:
    """What is in a file, in a few letters: the beginning of its SHA-256, and its size."""
    digest, size = hash_of(path)
    return f"{digest[:16]} ({size} bytes)" if digest else "missing"


def hash_of(path: Path) -> tuple[str, int]:
    """SHA-256 and size of a file; empty and 0 where it cannot be read."""
    try:
        stat = path.stat()
        return _hash_of(str(path), stat.st_mtime_ns, stat.st_size)
    except OSError:
        return "", 0


@cache
def _hash_of(path: str, _: int, size: int) -> tuple[str, int]:
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest(), size
