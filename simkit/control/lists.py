"""Lists of names and of numbers in controllers' parameters."""

from __future__ import annotations

from collections.abc import Sequence

from simkit.diagnostics import did_you_mean
from simkit.params import Params


def numbers(params: Params, name: str, default: Sequence[float], minimum: float | None = None) -> list[float]:
    """The numbers of a list; one of another length than the default's is an error, and the default is taken."""
    given = params.each(name)
    if not any(child.value for one in given for child in one.children):
        return list(default)
    found = [one.number(name, minimum=minimum) for one in given]
    if len(found) == len(default):
        return found
    message = f"found {len(found)} numbers in {name!r}, allowed are {len(default)}"
    params.diagnostics.error("SK-PARAM-002", message, given[0].where)
    return list(default)


def names(params: Params, name: str, *, required: bool = False, code: str = "SK-PARAM-002") -> list[str]:
    """The texts of a list; one that comes twice is an error, as two claims of one interface are.

    Args:
        params: where it stands.
        name: of the list.
        required: whether it is an error that there is none, or nothing in it.
        code: of the error about a name that comes twice.
    """
    before = params.diagnostics.error_count
    found = [one for one in params.all(name) if one.value or one.children]
    for k, one in enumerate(found):
        if one.value in [other.value for other in found[:k]]:
            message = f"{one.value!r} comes twice in {name!r}, allowed is each name once"
            params.diagnostics.error(code, message, one.where)
    if required and not found and params.diagnostics.error_count == before:
        near = did_you_mean(name, [one.name for one in params.children if one.name != name])
        params.error("SK-PARAM-001", f"<{params.name}> needs <{name}>: a list of names", near)
    return list(dict.fromkeys(one.value for one in found))
