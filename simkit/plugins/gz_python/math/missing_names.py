"""Errors for names of Gazebo's Python that simkit does not have, with what to use instead."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Final

from simkit.diagnostics import did_you_mean

PAGE: Final = "docs/gazebo_python.md lists what there is"


def missing_name_error(
    owner: str, name: str, offered: Iterable[str], instead: Mapping[str, str], otherwise: str = PAGE
) -> AttributeError:
    """The error for a name that an owner (`gz.sim`, `Link`, …) lacks.

    Args:
        owner: the module or class, as Gazebo calls it.
        name: what was asked for.
        offered: the public names it has, to find a near one.
        instead: name -> what to say of it.
        otherwise: what to say where no name is near.
    """
    if name.startswith("__"):
        return AttributeError(f"{owner!r} has no attribute {name!r}", name=name)
    near = did_you_mean(name, [n for n in offered if not n.startswith("_")])
    advice = instead.get(name) or near or otherwise
    return AttributeError(f"simkit's {owner} has no {name}; {advice}", name=name)
