"""Changes of the elements of a `<sensor>` or plugin: removal of its errors, and elements that replace others."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from simkit.params import Params
from simkit.scene.overrides import SOURCE_PREFIX
from simkit.sensors.artefacts import artefact_elements
from simkit.sensors.presets.preset import TIMING_ELEMENTS

NOISE_ELEMENTS: Final = frozenset({"noise", "disparity_noise"})
"""Elements at any depth of a `<sensor>` that describe noise; one of them replaces the other as a whole."""

_NO_ERRORS: Final = frozenset({"phase", "point_layout", "scan_pattern"})  # choices of the user: time, form, directions
_PLUGIN_NOISE: Final = re.compile(r"gaussian_?noise|odometry_noise|drift$", re.IGNORECASE)
_SPELLINGS: Final = (frozenset({"lidar", "ray"}), frozenset({"navsat", "gps"}))


@dataclass(frozen=True, slots=True)
class NewElements:
    """Elements of one name that replace those of a file.

    Attributes:
        name: name of the elements.
        params: the elements; empty if the elements of the file are only removed.
    """

    name: str
    params: tuple[Params, ...]


def is_error_element(name: str) -> bool:
    """Check whether a direct child of a `<sensor>` is an artefact or describes its timing."""
    return name in artefact_elements() or name in TIMING_ELEMENTS


def without_errors(params: Params, removed: set[str]) -> Params:
    """Return a `<sensor>` without noise, artefacts and times of its rays and rows; add the removed names to a set."""

    def is_error(child: Params) -> bool:
        return child.name not in _NO_ERRORS and is_error_element(child.name)

    return _without(_without(params, is_error, removed, 1), _is_noise, removed)


def without_noise(params: Params, removed: set[str]) -> Params:
    """Return a block without noise at any depth; add the names of the removed elements to a set."""
    return _without(params, _is_noise, removed)


def without_children(params: Params, names: Iterable[str], removed: set[str]) -> Params:
    """Return a block without some of its direct children; add the names of the removed ones to a set."""
    names = frozenset(names)
    return _without(params, lambda child: child.name in names, removed, 1)


def without_plugin_noise(params: Params, removed: set[str]) -> Params:
    """Return the parameters of a plugin without noise of its measurements."""
    return _without(params, lambda child: bool(_PLUGIN_NOISE.search(child.name)), removed, 1)


def _is_noise(child: Params) -> bool:
    return child.name in NOISE_ELEMENTS


def is_override(element: Params) -> bool:
    """Check whether an element, or one in it, has its value from `--set`."""
    return (element.where.file or "").startswith(SOURCE_PREFIX) or any(map(is_override, element.children))


def _without(params: Params, is_unwanted: Callable[[Params], bool], removed: set[str], depth: int = 100) -> Params:
    """Return a block without some of its children; the same block if nothing changes. `--set` keeps an element."""
    children: list[Params] = []
    for child in params.children:
        if is_unwanted(child) and not is_override(child):
            removed.add(child.name)
        else:
            children.append(_without(child, is_unwanted, removed, depth - 1) if depth > 1 else child)
    if len(children) == len(params.children) and all(a is b for a, b in zip(children, params.children, strict=True)):
        return params
    return _with_children(params, children)


def with_elements(params: Params, elements: Iterable[NewElements], *, is_sensor: bool = True) -> Params:
    """Return a block with elements that replace those of the file.

    Noise, artefacts and timing elements are replaced as a whole, of all other elements only the named children.

    Args:
        params: the block.
        elements: new elements.
        is_sensor: True for a `<sensor>`; its direct children may be artefacts.
    """
    children = list(params.children)
    attributes = dict(params.attributes)
    for new in elements:
        if new.name.startswith("@"):
            attributes[new.name[1:]] = new.params[0].value
            continue
        indices = list(_indices_of(children, new.name))
        if any(is_override(children[i]) for i in indices):
            children[indices[0]] = _completed(children[indices[0]], new.params)
        elif len(new.params) == 1 and indices and not _is_replaced_as_whole(new, is_sensor):
            merged = with_elements(children[indices[0]], grouped(new.params[0].children), is_sensor=False)
            children[indices[0]] = merged
        else:
            at = indices[0] if indices else len(children)
            children = [child for i, child in enumerate(children) if i not in indices]
            children[at:at] = new.params
    return _with_children(params, children, attributes)


def _is_replaced_as_whole(new: NewElements, is_sensor: bool) -> bool:
    if new.name in NOISE_ELEMENTS or (is_sensor and is_error_element(new.name)):
        return True
    return not new.params[0].children


def _completed(element: Params, new: Sequence[Params]) -> Params:
    """Return an element that contains a value of `--set` with the new children that it lacks."""
    if not new or not element.children:
        return element
    children = list(element.children)
    for child in new[0].children:
        at = next((i for i, old in enumerate(children) if old.name == child.name), None)
        if at is None:
            children.append(child)
        else:
            children[at] = _completed(children[at], [child])
    return _with_children(element, children)


def grouped(children: Sequence[Params]) -> Iterator[NewElements]:
    """Yield elements by name, in the order of their first ones."""
    for name in dict.fromkeys(child.name for child in children):
        yield NewElements(name, tuple(child for child in children if child.name == name))


def _indices_of(children: Sequence[Params], name: str) -> Iterator[int]:
    same = next((names for names in _SPELLINGS if name in names), frozenset({name}))
    return (i for i, child in enumerate(children) if child.name in same)


def _with_children(params: Params, children: Sequence[Params], attributes: dict[str, str] | None = None) -> Params:
    attributes = params.attributes if attributes is None else attributes
    return Params(params.name, params.value, attributes, children, params.where, params.diagnostics)
