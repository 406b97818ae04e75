"""A world in which some leaves have other values: as they were in the golden run."""

from __future__ import annotations

import re
import types
import typing
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import MISSING, Field, fields, is_dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from simkit.params import Params
from simkit.pose import Pose
from simkit.scene import SceneWorld
from simkit.testing.golden.compare.world_edits import ABSENT
from simkit.testing.run_record.world_values import element_keys, escaped_key, file_content_text, item_keys, split_path

_KEPT_FIELDS = frozenset(("mjcf", "moved_by"))


class CannotPatch(Exception):
    """A leaf's golden value is not enough to make it again: the content of a file, say."""


class _PatchNode:
    """What a node is to be: its own leaf's value, and what is below it, by step.

    Attributes:
        value: of its leaf; ABSENT where it has none.
        below: field, or key in brackets -> node.
        is_touched: whether anything of it is to be other than it is.
    """

    __slots__ = ("below", "is_touched", "value")

    def __init__(self) -> None:
        self.value: object = ABSENT
        self.below: dict[str, _PatchNode] = {}
        self.is_touched = False

    @property
    def is_there(self) -> bool:
        """Whether it has a leaf at all."""
        return self.value is not ABSENT or any(one.is_there for one in self.below.values())

    def reach(self, path: str, *, touch: bool) -> _PatchNode:
        """The node of a path."""
        node = self
        node.is_touched |= touch
        for step in _steps(path):
            if step not in node.below:
                node.below[step] = _PatchNode()
            node = node.below[step]
            node.is_touched |= touch
        return node


def patch_world(
    world: SceneWorld,
    now: Mapping[str, object],
    values: Mapping[str, object],
    files: Iterable[Path] | None = None,
    order: Iterable[str] = (),
) -> SceneWorld:
    """The world with other values of some leaves.

    Args:
        world: what is changed; it stays as it is.
        now: its leaves, as `simkit.testing.run_record.world_values` gives them.
        values: path -> value, ABSENT for what is not to be there.
        files: for leaves that are the content of a file; None for those that the world names.
        order: paths in the order of the file in which they stood, so that what comes back has its old place.

    Raises:
        CannotPutBack: a value is not enough to make the thing again.
    """
    root = _PatchNode()
    for path in order:
        root.reach(path, touch=False)
    for path, value in now.items():
        if path not in values:
            root.reach(path, touch=False).value = value
    for path, value in values.items():
        root.reach(path, touch=True).value = value
    by_content = {file_content_text(file): file for file in (files_named_by(world) if files is None else files)}
    try:
        changed = _PatchedBuilder(by_content).changed(world, root, "")
    except (TypeError, ValueError, AttributeError, KeyError, IndexError) as error:
        raise CannotPatch(str(error)) from error  # leaves of another version, or of a file that was tampered with
    assert isinstance(changed, SceneWorld)
    return changed


@lru_cache(maxsize=65536)
def _steps(path: str) -> tuple[str, ...]:
    found: list[str] = []
    for field, key in split_path(path):
        found.append(field)
        if key:
            found.append(f"[{key}]")
    return tuple(found)


class _PatchedBuilder:
    """Makes nodes with other leaves.

    Args:
        files: what there is, by content.
    """

    def __init__(self, files: Mapping[str, Path]) -> None:
        self._files = files

    def changed(self, node: Any, wanted: _PatchNode, owner: str) -> object:
        """A dataclass with other values of some fields.

        Args:
            node: what it is now.
            wanted: of it.
            owner: scoped name of the part of the world that it belongs to.
        """
        owner = getattr(node, "scoped", None) or owner
        others = {}
        for one in fields(node):
            inner = wanted.below.get(one.name)
            if inner is not None and inner.is_touched:
                others[one.name] = self._field(type(node), one, getattr(node, one.name), inner, owner)
        return replace(node, **others) if others else node

    def made(self, kind: type, wanted: _PatchNode, owner: str, key: str) -> object:
        """A node that is not there now, of its leaves."""
        name = re.sub(r"#\d+$", "", key)
        whole = owner if kind.__name__ == "ScenePlugin" else (f"{owner}::{name}" if owner and name else name or owner)
        given: dict[str, object] = {}
        hints = _hints(kind)
        words = {"name": name, "scoped": whole, "parent": owner, "uri": ""}
        for one in fields(kind):
            inner = wanted.below.get(one.name)
            default = default_of(one)
            if inner is not None and inner.is_there:
                given[one.name] = self._field(kind, one, None if default is MISSING else default, inner, whole)
            elif one.name in words and isinstance(words[one.name], str) and hints[one.name] is str:
                given[one.name] = words[one.name]
            elif hints[one.name] is Params:
                given[one.name] = Params(one.name)
            else:  # without a leaf there is nothing
                given[one.name] = self._nothing(one, hints[one.name])
        return kind(**given)

    def _field(self, kind: type, one: Field[Any], now: Any, wanted: _PatchNode, owner: str) -> object:
        hint = _hints(kind)[one.name]
        if one.name in _KEPT_FIELDS:
            raise CannotPatch(one.name)
        if hint is Params:
            return self._params(now if isinstance(now, Params) else Params(one.name), wanted)
        if typing.get_origin(hint) is tuple and any(step.startswith("[") for step in wanted.below):
            return self._elements(now or (), _node_kinds(hint), wanted, owner)
        if not wanted.is_there:
            return self._nothing(one, hint)
        if isinstance(now, Mapping) or typing.get_origin(hint) in (Mapping, dict):
            return self._mapping(now or {}, wanted)
        kinds = _node_kinds(hint)
        if kinds:
            return self._node(kinds, now, wanted, owner)
        return self._value(wanted.value, hint)

    def _node(self, kinds: Mapping[str, type], now: object, wanted: _PatchNode, owner: str) -> object:
        """A node of one of several kinds: the one that there is, where it is of the right one."""
        if isinstance(wanted.value, str):
            kind = kinds.get(wanted.value)
            if kind is None:
                raise CannotPatch(wanted.value)
        else:
            kind = type(now) if is_dataclass(now) else next(iter(kinds.values()))
        if type(now) is kind:
            return self.changed(now, wanted, owner)
        return self.made(kind, wanted, owner, "")

    def _nothing(self, one: Field[Any], hint: object) -> object:
        if _may_be_none(hint):
            return None
        if typing.get_origin(hint) is tuple:
            return ()
        default = default_of(one)
        if default is MISSING:
            raise CannotPatch(one.name)
        return default

    def _elements(
        self, now: Sequence[Any], kinds: Mapping[str, type], wanted: _PatchNode, owner: str
    ) -> tuple[object, ...]:
        """The items of a list, without those that are gone; new ones come behind those that they stood behind."""
        there = dict(zip(item_keys(now), now, strict=True))
        found: dict[str, object] = {}
        for key, item in there.items():
            inner = wanted.below.get(f"[{key}]")
            if inner is None or not inner.is_touched:
                found[key] = item
            elif inner.is_there:
                is_block = isinstance(item, Params)
                found[key] = self._params(item, inner) if is_block else self.changed(item, inner, owner)
        places = list(found)
        before = ""
        for step, inner in wanted.below.items():
            key = step[1:-1]
            if step.startswith("[") and key not in there and inner.is_there:
                if not kinds:
                    raise CannotPatch(step)
                found[key] = self.made(next(iter(kinds.values())), inner, owner, key)
                places.insert(places.index(before) + 1 if before in places else 0 if not before else len(places), key)
            if key in found:
                before = key
        return tuple(found[key] for key in places)

    def _mapping(self, now: Mapping[str, object], wanted: _PatchNode) -> dict[str, object]:
        found = dict(now)
        for step, inner in wanted.below.items():
            if inner.is_touched:
                if inner.below:
                    raise CannotPatch(step)
                found.pop(step[1:-1], None)
                if inner.is_there:
                    found[step[1:-1]] = _as_scene_value(inner.value, None)
        return found

    def _params(self, now: Params, wanted: _PatchNode) -> Params:
        """A block of parameters; it is a copy that nobody has read yet."""
        attributes = dict(now.attributes)
        children: list[Params] = []
        taken = set()
        elements, given = self._split(wanted)
        for key, child in zip(element_keys(now.children), now.children, strict=True):
            inner = elements.get(key)
            taken.add(key)
            if inner is None or not inner.is_touched:
                children.append(child.copied())
            elif inner.is_there:
                children.append(self._params(child, inner))
        for key, inner in elements.items():
            if key not in taken and inner.is_there:
                children.append(self._params(Params(key.partition("[")[0], diagnostics=now.diagnostics), inner))
        for name, inner in given.items():
            if inner.is_touched:
                attributes.pop(name, None)
                if inner.is_there:
                    attributes[name] = _element_text(inner.value)
        text = now.value
        if wanted.is_touched and wanted.value is not ABSENT and _text_value(text) != wanted.value:
            text = self._text_of(wanted.value)
        elif wanted.value is ABSENT and not (now.value == "" or elements):
            text = ""
        return Params(now.name, text, attributes, children, now.where, now.diagnostics)

    def _split(self, wanted: _PatchNode) -> tuple[dict[str, _PatchNode], dict[str, _PatchNode]]:
        """Elements by key, and attributes by name."""
        elements: dict[str, _PatchNode] = {}
        given: dict[str, _PatchNode] = {}
        for step, inner in wanted.below.items():
            if step.startswith("@"):
                given[step[1:]] = inner
                continue
            keyed = {k: v for k, v in inner.below.items() if k.startswith("[")}
            for key, one in keyed.items():
                elements[f"{step}[{escaped_key(key[1:-1])}]"] = one
            if inner.value is not ABSENT or len(keyed) < len(inner.below):
                elements[step] = inner
        return elements, given

    def _text_of(self, value: object) -> str:
        if isinstance(value, str) and re.fullmatch(r"[0-9a-f]{16} \(\d+ bytes\)", value):
            if value not in self._files:
                raise CannotPatch("the content of a file")
            return str(self._files[value])
        return _element_text(value)

    def _value(self, value: Any, hint: object) -> object:
        if hint is Pose:
            return Pose(value[:3], value[3:])
        if hint is Path or Path in typing.get_args(hint):
            found = self._files.get(value)
            if found is None:
                raise CannotPatch("the content of a file")
            return found
        return _as_scene_value(value, hint)


def default_of(one: Field[Any]) -> object:
    """A field's default; MISSING where it has none."""
    return one.default_factory() if one.default_factory is not MISSING else one.default


def _text_value(text: str) -> object:
    words = text.split()
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        return " ".join(words)
    return (numbers[0] if len(numbers) == 1 else numbers) if numbers else ""


def _as_scene_value(value: object, hint: object) -> object:
    """Lists as the scene has them, and whole numbers as it has them."""
    if isinstance(value, list):
        inner = [a for a in typing.get_args(hint) if a is not Ellipsis]
        return tuple(_as_scene_value(v, inner[0] if inner else None) for v in value)
    is_float = hint is float or float in typing.get_args(hint)
    return float(value) if is_float and isinstance(value, int) and not isinstance(value, bool) else value


def _element_text(value: object) -> str:
    if isinstance(value, list):
        return " ".join(_element_text(v) for v in value)
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float) and value == int(value) and abs(value) < 1e15:
        return str(int(value))  # of what was written as a whole number some readers take nothing else
    return str(value)


def _may_be_none(hint: object) -> bool:
    return type(None) in typing.get_args(hint)


@lru_cache(maxsize=256)
def _node_kinds(hint: Any) -> Mapping[str, type]:
    """The dataclasses that may stand in a field, by name."""
    if is_dataclass(hint) and isinstance(hint, type) and hint is not Pose:
        return {hint.__name__: hint}
    if typing.get_origin(hint) in (tuple, typing.Union, types.UnionType):
        return {name: kind for one in typing.get_args(hint) for name, kind in _node_kinds(one).items()}
    return {}


@lru_cache(maxsize=256)
def _hints(kind: type) -> dict[str, object]:
    return typing.get_type_hints(kind)


def files_named_by(value: object) -> list[Path]:
    """The files that a world, or a part of one, names."""
    if isinstance(value, Path):
        return [value]
    if is_dataclass(value) and not isinstance(value, type):
        return [
            p for one in fields(value) if one.name not in _KEPT_FIELDS for p in files_named_by(getattr(value, one.name))
        ]
    if isinstance(value, (tuple, list)):
        return [p for item in value for p in files_named_by(item)]
    return []
