"""Copies of an object's attributes for snapshots: an attribute that cannot be copied is left out."""

from __future__ import annotations

import copy
from collections.abc import Callable, Collection, Mapping
from typing import Any, Final

_PLAIN: Final = frozenset({bool, bytes, float, int, str, type(None)})
"""Types whose values cannot change, so that a copy is the value itself; `deepcopy` takes 0.3 µs for each."""


class AttributeState(dict[str, Any]):
    """Copied attributes by name, which `restore_attributes` copies again at each restore.

    Attributes:
        constant: names of the attributes whose copies are the values themselves; empty before the first restore.
        is_divided: True once `constant` is known.
    """

    is_divided = False
    constant: frozenset[str] = frozenset()

    def divide(self, owner: object) -> None:
        """Find the constant attributes, which need no copy at later restores."""
        memo: dict[int, object] = {id(owner): owner}
        found = [key for key, value in self.items() if type(value) in _PLAIN or copy.deepcopy(value, memo) is value]
        self.constant, self.is_divided = frozenset(found), True


def copy_attributes(
    owner: object, left_out: Collection[str], report: Callable[[str, Exception], None]
) -> AttributeState:
    """Return a copy of every attribute of an object; references to the object itself are not copied.

    Args:
        owner: object with the attributes.
        left_out: names of the attributes that are not part of the state.
        report: function that receives the name of an attribute that cannot be copied and the exception, once for each.
    """
    own = {key: value for key, value in vars(owner).items() if key not in left_out}
    memo: dict[int, object] = {id(owner): owner}
    try:
        return AttributeState(copy.deepcopy(own, memo))
    except Exception:  # noqa: BLE001 - a foreign object may raise anything when copied
        pass
    memo = {id(owner): owner}
    state, uncopied = AttributeState(), set()
    for key, value in own.items():
        try:
            state[key] = copy.deepcopy(value, memo)
        except Exception as error:  # noqa: BLE001 - a foreign object may raise anything when copied
            uncopied.add(key)
            if key not in vars(owner).get("_uncopied", set()):
                report(key, error)
    vars(owner)["_uncopied"] = uncopied
    return state


def restore_attributes(owner: object, left_out: Collection[str], state: Mapping[str, Any]) -> None:
    """Restore a state from `copy_attributes`; later attributes are deleted, except those that cannot be copied."""
    kept = {*left_out, *state, *vars(owner).get("_uncopied", ())}
    for key in [key for key in vars(owner) if key not in kept]:
        delattr(owner, key)
    if isinstance(state, AttributeState):
        if not state.is_divided:
            state.divide(owner)
        constant: Collection[str] = state.constant
    else:
        constant = [key for key, value in state.items() if type(value) in _PLAIN]
    vars(owner).update(state)
    if len(constant) < len(state):
        rest = {key: value for key, value in state.items() if key not in constant}
        vars(owner).update(copy.deepcopy(rest, {id(owner): owner}))
