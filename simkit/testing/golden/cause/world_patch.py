"""Copies of a world in which some values are restored to those of the golden run."""

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
    """Error of a golden value from which an object cannot be restored, such as the hash of a file."""


class _PatchNode:
    """Requested state of a world node: the value of the node and its child nodes.

    Attributes:
        value: Value of the node; ABSENT if it has none.
        children: Field, or key in brackets -> child node.
        is_touched: True if the node or a descendant must change.
    """

    __slots__ = ("children", "is_touched", "value")

    def __init__(self) -> None:
        self.value: object = ABSENT
        self.children: dict[str, _PatchNode] = {}
        self.is_touched = False

    @property
    def has_value(self) -> bool:
        """True if the node or a descendant has a value."""
        return self.value is not ABSENT or any(child.has_value for child in self.children.values())

    def reach(self, path: str, *, touch: bool) -> _PatchNode:
        """Return the node at a path; create missing nodes."""
        node = self
        node.is_touched |= touch
        for step in _steps(path):
            if step not in node.children:
                node.children[step] = _PatchNode()
            node = node.children[step]
            node.is_touched |= touch
        return node


def patch_world(
    world: SceneWorld,
    now: Mapping[str, object],
    values: Mapping[str, object],
    files: Iterable[Path] | None = None,
    order: Iterable[str] = (),
) -> SceneWorld:
    """Return a copy of a world with changed values.

    Args:
        world: World; it is not modified.
        now: Values of the world from `simkit.testing.run_record.world_values`.
        values: Path -> new value; ABSENT removes the value.
        files: Files from which content can be restored; None for the files that the world uses.
        order: Paths in file order, so that a restored element gets its old position.

    Raises:
        CannotPatch: A value is not sufficient to restore the object.
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
        # the values come from another version of simkit or from a manipulated file
        raise CannotPatch(str(error)) from error
    assert isinstance(changed, SceneWorld)
    return changed


@lru_cache(maxsize=65536)
def _steps(path: str) -> tuple[str, ...]:
    steps: list[str] = []
    for field, key in split_path(path):
        steps.append(field)
        if key:
            steps.append(f"[{key}]")
    return tuple(steps)


class _PatchedBuilder:
    """Builder of changed world nodes.

    Args:
        files: Available files by content.
    """

    def __init__(self, files: Mapping[str, Path]) -> None:
        self._files = files

    def changed(self, node: Any, patch: _PatchNode, owner: str) -> object:
        """Return a copy of a dataclass with changed fields.

        Args:
            node: Present node.
            patch: Requested state.
            owner: Scoped name of the entity that contains the node.
        """
        owner = getattr(node, "scoped", None) or owner
        others = {}
        for attribute in fields(node):
            inner = patch.children.get(attribute.name)
            if inner is not None and inner.is_touched:
                others[attribute.name] = self._field(type(node), attribute, getattr(node, attribute.name), inner, owner)
        return replace(node, **others) if others else node

    def created(self, kind: type, patch: _PatchNode, owner: str, key: str) -> object:
        """Create a node that does not exist yet from its values."""
        name = re.sub(r"#\d+$", "", key)
        scoped = owner if kind.__name__ == "ScenePlugin" else (f"{owner}::{name}" if owner and name else name or owner)
        arguments: dict[str, object] = {}
        hints = _hints(kind)
        words = {"name": name, "scoped": scoped, "parent": owner, "uri": ""}
        for attribute in fields(kind):
            inner = patch.children.get(attribute.name)
            default = default_of(attribute)
            if inner is not None and inner.has_value:
                arguments[attribute.name] = self._field(
                    kind, attribute, None if default is MISSING else default, inner, scoped
                )
            elif attribute.name in words and isinstance(words[attribute.name], str) and hints[attribute.name] is str:
                arguments[attribute.name] = words[attribute.name]
            elif hints[attribute.name] is Params:
                arguments[attribute.name] = Params(attribute.name)
            else:  # the field has no value and is empty
                arguments[attribute.name] = self._nothing(attribute, hints[attribute.name])
        return kind(**arguments)

    def _field(self, kind: type, attribute: Field[object], now: Any, patch: _PatchNode, owner: str) -> object:
        hint = _hints(kind)[attribute.name]
        if attribute.name in _KEPT_FIELDS:
            raise CannotPatch(attribute.name)
        if hint is Params:
            return self._params(now if isinstance(now, Params) else Params(attribute.name), patch)
        if typing.get_origin(hint) is tuple and any(step.startswith("[") for step in patch.children):
            return self._elements(now or (), _node_kinds(hint), patch, owner)
        if not patch.has_value:
            return self._nothing(attribute, hint)
        if isinstance(now, Mapping) or typing.get_origin(hint) in (Mapping, dict):
            return self._mapping(now or {}, patch)
        kinds = _node_kinds(hint)
        if kinds:
            return self._node(kinds, now, patch, owner)
        return self._value(patch.value, hint)

    def _node(self, kinds: Mapping[str, type], now: object, patch: _PatchNode, owner: str) -> object:
        """Return a node of one of several types; reuse the present node if it has the right type."""
        if isinstance(patch.value, str):
            kind = kinds.get(patch.value)
            if kind is None:
                raise CannotPatch(patch.value)
        else:
            kind = type(now) if is_dataclass(now) else next(iter(kinds.values()))
        if type(now) is kind:
            return self.changed(now, patch, owner)
        return self.created(kind, patch, owner, "")

    def _nothing(self, attribute: Field[object], hint: object) -> object:
        if _may_be_none(hint):
            return None
        if typing.get_origin(hint) is tuple:
            return ()
        default = default_of(attribute)
        if default is MISSING:
            raise CannotPatch(attribute.name)
        return default

    def _elements(
        self, now: Sequence[Any], kinds: Mapping[str, type], patch: _PatchNode, owner: str
    ) -> tuple[object, ...]:
        """Return the items of a list without removed items; added items get their position in the golden run."""
        there = dict(zip(item_keys(now), now, strict=True))
        items_by_key: dict[str, object] = {}
        for key, item in there.items():
            inner = patch.children.get(f"[{key}]")
            if inner is None or not inner.is_touched:
                items_by_key[key] = item
            elif inner.has_value:
                is_block = isinstance(item, Params)
                items_by_key[key] = self._params(item, inner) if is_block else self.changed(item, inner, owner)
        places = list(items_by_key)
        before = ""
        for step, inner in patch.children.items():
            key = step[1:-1]
            if step.startswith("[") and key not in there and inner.has_value:
                if not kinds:
                    raise CannotPatch(step)
                items_by_key[key] = self.created(next(iter(kinds.values())), inner, owner, key)
                places.insert(places.index(before) + 1 if before in places else 0 if not before else len(places), key)
            if key in items_by_key:
                before = key
        return tuple(items_by_key[key] for key in places)

    def _mapping(self, now: Mapping[str, object], patch: _PatchNode) -> dict[str, object]:
        mapping = dict(now)
        for step, inner in patch.children.items():
            if inner.is_touched:
                if inner.children:
                    raise CannotPatch(step)
                mapping.pop(step[1:-1], None)
                if inner.has_value:
                    mapping[step[1:-1]] = _as_scene_value(inner.value, None)
        return mapping

    def _params(self, now: Params, patch: _PatchNode) -> Params:
        """Return a changed copy of a parameter block; the copy reports all its parameters as unread."""
        attributes = dict(now.attributes)
        children: list[Params] = []
        taken = set()
        elements, attribute_patches = self._split(patch)
        for key, child in zip(element_keys(now.children), now.children, strict=True):
            inner = elements.get(key)
            taken.add(key)
            if inner is None or not inner.is_touched:
                children.append(child.copied())
            elif inner.has_value:
                children.append(self._params(child, inner))
        for key, inner in elements.items():
            if key not in taken and inner.has_value:
                children.append(self._params(Params(key.partition("[")[0], diagnostics=now.diagnostics), inner))
        for name, inner in attribute_patches.items():
            if inner.is_touched:
                attributes.pop(name, None)
                if inner.has_value:
                    attributes[name] = _element_text(inner.value)
        text = now.value
        if patch.is_touched and patch.value is not ABSENT and _text_value(text) != patch.value:
            text = self._text_of(patch.value)
        elif patch.value is ABSENT and not (now.value == "" or elements):
            text = ""
        return Params(now.name, text, attributes, children, now.where, now.diagnostics)

    def _split(self, patch: _PatchNode) -> tuple[dict[str, _PatchNode], dict[str, _PatchNode]]:
        """Return two mappings: the child elements by key, and the attributes by name."""
        elements: dict[str, _PatchNode] = {}
        attribute_patches: dict[str, _PatchNode] = {}
        for step, inner in patch.children.items():
            if step.startswith("@"):
                attribute_patches[step[1:]] = inner
                continue
            keyed = {k: v for k, v in inner.children.items() if k.startswith("[")}
            for key, keyed_patch in keyed.items():
                elements[f"{step}[{escaped_key(key[1:-1])}]"] = keyed_patch
            if inner.value is not ABSENT or len(keyed) < len(inner.children):
                elements[step] = inner
        return elements, attribute_patches

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
            content = self._files.get(value)
            if content is None:
                raise CannotPatch("the content of a file")
            return content
        return _as_scene_value(value, hint)


def default_of(attribute: Field[object]) -> object:
    """Return the default of a field; MISSING if it has none."""
    return attribute.default_factory() if attribute.default_factory is not MISSING else attribute.default


def _text_value(text: str) -> object:
    words = text.split()
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        return " ".join(words)
    return (numbers[0] if len(numbers) == 1 else numbers) if numbers else ""


def _as_scene_value(value: object, hint: object) -> object:
    """Convert lists to tuples and integers to floats where the scene requires it."""
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
        return str(int(value))  # some parsers accept only an integer text for integer values
    return str(value)


def _may_be_none(hint: object) -> bool:
    return type(None) in typing.get_args(hint)


@lru_cache(maxsize=256)
def _node_kinds(hint: Any) -> Mapping[str, type]:
    """Return the dataclasses that a field accepts, by name."""
    if is_dataclass(hint) and isinstance(hint, type) and hint is not Pose:
        return {hint.__name__: hint}
    if typing.get_origin(hint) in (tuple, typing.Union, types.UnionType):
        return {name: kind for argument in typing.get_args(hint) for name, kind in _node_kinds(argument).items()}
    return {}


@lru_cache(maxsize=256)
def _hints(kind: type) -> dict[str, object]:
    return typing.get_type_hints(kind)


def files_named_by(value: object) -> list[Path]:
    """Return the files that a world or one of its objects uses."""
    if isinstance(value, Path):
        return [value]
    if is_dataclass(value) and not isinstance(value, type):
        return [
            p
            for attribute in fields(value)
            if attribute.name not in _KEPT_FIELDS
            for p in files_named_by(getattr(value, attribute.name))
        ]
    if isinstance(value, (tuple, list)):
        return [p for item in value for p in files_named_by(item)]
    return []
