"""What broadcasters share: reading lists of numbers, and making messages of arrays."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from simkit import msgs
from simkit.params import Params
from simkit.pose import Vector


def numbers(params: Params, name: str, default: Sequence[float]) -> list[float]:
    """The numbers of a list; one of another length than the default's is an error, and the default is taken."""
    given = params.each(name)
    if not given:
        return list(default)
    found = [one.number(name) for one in given]
    if len(found) == len(default):
        return found
    message = f"found {len(found)} numbers in {name!r}, allowed are {len(default)}"
    params.diagnostics.error("SK-PARAM-002", message, given[0].where)
    return list(default)


def names(params: Params, name: str) -> list[str]:
    """The texts of a list; one that comes twice is an error, as two claims of one interface are."""
    found = params.all(name)
    for k, one in enumerate(found):
        if one.value in [other.value for other in found[:k]]:
            message = f"{one.value!r} comes twice in {name!r}, allowed is each name once"
            params.diagnostics.error("SK-PARAM-002", message, one.where)
    return list(dict.fromkeys(one.value for one in found))


def vector(values: Vector) -> Any:
    """A `geometry_msgs/msg/Vector3`."""
    return msgs.type_of("geometry_msgs/msg/Vector3")(*values.tolist())
