"""Messages whose parts have no order by meaning, in one order: that of models in a file shows nowhere."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from operator import attrgetter
from typing import Any, Final

import numpy as np

_CONTACTS: Final = "ros_gz_interfaces/msg/Contacts"
_PARTS: Final[dict[str, tuple[str, Callable[[Any], Any]]]] = {
    "tf2_msgs/msg/TFMessage": ("transforms", attrgetter("child_frame_id", "header.frame_id")),
    _CONTACTS: ("contacts", attrgetter("collision1.name", "collision2.name")),
    "gazebo_msgs/msg/ContactsState": ("states", attrgetter("collision1_name", "collision2_name")),
}
"""A list of parts that each say whose they are, and what they say; those that say the same keep their order."""
_POINTS: Final[dict[str, tuple[str, ...]]] = {
    _CONTACTS: ("positions", "normals", "depths", "wrenches"),
    "gazebo_msgs/msg/ContactsState": ("contact_positions", "contact_normals", "depths", "wrenches"),
}
"""Lists side by side, of the points where two things touch; the first says where."""
_ACROSS: Final = (1.0, math.sqrt(0.5), math.sqrt(1.0 / 3.0))
"""Points are in order along this direction, which is none that the corners of a box have in common."""
_ROWS: Final[dict[str, tuple[str, ...]]] = {
    "gazebo_msgs/msg/ModelStates": ("name", "pose", "twist"),
    "gazebo_msgs/msg/LinkStates": ("name", "pose", "twist"),
}
"""Lists side by side, of all that a world holds; the first has the names."""


def in_order(message: Any, type_name: str) -> Any:
    """A message with its parts by name; itself where they are, or where their order means something.

    Args:
        message: which is not changed.
        type_name: of it.
    """
    if type_name in _PARTS:
        field, key = _PARTS[type_name]
        parts = getattr(message, field)
        if type_name == _CONTACTS and any(one.collision1.id or one.collision2.id for one in parts):
            return in_order(replace(message, contacts=[_by_name_only(one) for one in parts]), type_name)
        if type_name in _POINTS:
            parts = [_along(part, _POINTS[type_name]) for part in parts]
        ordered = sorted(parts, key=key)
        if all(a is b for a, b in zip(ordered, getattr(message, field), strict=True)):
            return message
        return replace(message, **{field: ordered})
    if type_name in _ROWS:
        names = list(getattr(message, _ROWS[type_name][0]))
        order = sorted(range(len(names)), key=names.__getitem__)
        columns = {field: getattr(message, field) for field in _ROWS[type_name]}
        if order == list(range(len(names))) or any(len(column) != len(names) for column in columns.values()):
            return message
        return replace(message, **{field: [column[i] for i in order] for field, column in columns.items()})
    return message


def _along(part: Any, fields: tuple[str, ...]) -> Any:
    """A contact with its points in one order: the engine's depends on which of the two came first in the file."""
    columns = {field: getattr(part, field) for field in fields}
    places = columns[fields[0]]
    keys = [p.x * _ACROSS[0] + p.y * _ACROSS[1] + p.z * _ACROSS[2] for p in places]
    order = sorted(range(len(keys)), key=keys.__getitem__)
    if order == list(range(len(keys))):
        return part
    moved = {field: _picked(column, order) for field, column in columns.items() if len(column) == len(keys)}
    return replace(part, **moved)


def _picked(column: Any, order: list[int]) -> Any:
    return column[order] if isinstance(column, np.ndarray) else [column[i] for i in order]


def _by_name_only(contact: Any) -> Any:
    """A contact without the numbers of what touches: they count the parts of the file, and names stand beside them."""
    wrenches = [
        replace(w, body_1_id=replace(w.body_1_id, data=0), body_2_id=replace(w.body_2_id, data=0))
        for w in contact.wrenches
    ]
    return replace(
        contact,
        collision1=replace(contact.collision1, id=0),
        collision2=replace(contact.collision2, id=0),
        wrenches=wrenches,
    )
