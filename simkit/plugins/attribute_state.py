"""Copies of an object's attributes for snapshots: an attribute that cannot be copied is left out."""

from __future__ import annotations

import copy
from collections import Counter
from collections.abc import Callable, Collection, Mapping, Set
from dataclasses import fields
from functools import partial
from typing import Any, Final

import numpy as np

_PLAIN: Final = frozenset({bool, bytes, float, int, str, type(None)})
"""Types whose values cannot change, so that a copy is the value itself; `deepcopy` takes 0.3 µs for each."""


class AttributeState(dict[str, object]):
    """Copied attributes by name, which `restore_attributes` copies again at each restore.

    The attributes are divided at the first restore, because `deepcopy` takes 20 to 100 µs for a plugin and most of its
    values are numbers, handles, and arrays or lists of them.

    Attributes:
        shallow: attributes that a simple copy reproduces: no other attribute refers to them, and their elements are
            constant.
        deep: names of the other attributes that are not constant.
        kept: names of all attributes that a restore does not delete.
        is_divided: True once the other attributes of this class are known.
    """

    is_divided = False
    kept: Set[str] = frozenset()
    shallow: tuple[tuple[str, Callable[[], object]], ...] = ()
    deep: tuple[str, ...] = ()

    def divide(self, owner: object) -> None:
        """Find the attributes that need a copy at later restores."""
        changing = {key: value for key, value in self.items() if not _is_constant(value, owner)}
        counts = Counter(map(id, changing.values()))
        simple = {id(value) for value in changing.values() if counts[id(value)] == 1 and _is_flat(value, owner)}
        memo: dict[int, object] = {id(owner): owner}
        copy.deepcopy([value for value in changing.values() if id(value) not in simple], memo)
        simple -= memo.keys()
        self.shallow = tuple((key, _copier(value)) for key, value in changing.items() if id(value) in simple)
        self.deep = tuple(key for key, value in changing.items() if id(value) not in simple)
        self.is_divided = True


def _is_constant(value: Any, owner: object) -> bool:
    """Check whether the copy of a value is the value itself, or an unchangeable equal one."""
    if type(value) in _PLAIN:
        return True
    own_parameters = vars(type(value)).get("__dataclass_params__")
    if own_parameters is not None and own_parameters.frozen:
        names = {attribute.name for attribute in fields(value)}
        return getattr(value, "__dict__", {}).keys() <= names and all(
            _is_constant(getattr(value, name), owner) for name in names
        )
    return copy.deepcopy(value, {id(owner): owner}) is value


def _is_flat(value: Any, owner: object) -> bool:
    """Check whether a value is an array, a list, a set or a dictionary whose elements need no copy."""
    if type(value) is np.ndarray:
        return not value.dtype.hasobject
    if type(value) is dict:
        return all(_is_constant(element, owner) for element in (*value, *value.values()))
    return type(value) in (list, set) and all(_is_constant(element, owner) for element in value)


def _copier(value: Any) -> Callable[[], object]:
    """Return the function that copies a flat value; an array keeps its order in memory, as with `deepcopy`."""
    return partial(value.copy, "K") if type(value) is np.ndarray else value.copy


def copy_attributes(
    owner: object, left_out: Collection[str], report: Callable[[str, Exception], None]
) -> AttributeState:
    """Return a copy of every attribute of an object; references to the object itself are not copied.

    Args:
        owner: object with the attributes.
        left_out: names of the attributes that are not part of the state.
        report: function that receives the name of an attribute that cannot be copied and the exception, once for each.
    """
    attributes = {key: value for key, value in vars(owner).items() if key not in left_out}
    memo: dict[int, object] = {id(owner): owner}
    try:
        return AttributeState(copy.deepcopy(attributes, memo))
    except Exception:  # noqa: BLE001 - a foreign object may raise anything when copied
        pass
    memo = {id(owner): owner}
    state, uncopied = AttributeState(), set()
    for key, value in attributes.items():
        try:
            state[key] = copy.deepcopy(value, memo)
        except Exception as error:  # noqa: BLE001 - a foreign object may raise anything when copied
            uncopied.add(key)
            if key not in vars(owner).get("_uncopied", set()):
                report(key, error)
    vars(owner)["_uncopied"] = uncopied
    return state


def restore_attributes(owner: object, left_out: Collection[str], state: Mapping[str, object]) -> None:
    """Restore a state from `copy_attributes`; later attributes are deleted, except those that cannot be copied."""
    attributes = vars(owner)
    if isinstance(state, AttributeState):
        if not state.is_divided:
            state.divide(owner)
            state.kept = state.keys() | set(left_out)
        lasting_names = state.kept
    else:
        lasting_names = state.keys() | set(left_out)
    if not attributes.keys() <= lasting_names:
        for key in attributes.keys() - lasting_names - {"_uncopied", *attributes.get("_uncopied", ())}:
            delattr(owner, key)
    if not isinstance(state, AttributeState):  # a plugin has made its own state
        attributes.update(copy.deepcopy(dict(state), {id(owner): owner}))
        return
    attributes.update(state)
    for key, copied in state.shallow:
        attributes[key] = copied()
    if state.deep:
        attributes.update(copy.deepcopy({key: state[key] for key in state.deep}, {id(owner): owner}))
