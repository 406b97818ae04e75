"""Errors for names of Gazebo's Python that simkit does not have, with what to use instead."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import Final

from simkit.diagnostics import did_you_mean

PAGE: Final = "docs/gazebo_python.md lists what there is"


def missing_name_error(owner: str, name: str, offered: Iterable[str]) -> AttributeError:
    """The error for a name that an owner (`gz.sim`, `Link`, …) lacks.

    Args:
        owner: the module or class, as Gazebo calls it.
        name: what was asked for.
        offered: the public names it has, to find a near one.
    """
    if name.startswith("__"):
        return AttributeError(f"{owner!r} has no attribute {name!r}", name=name)
    instead = _advice().get(owner, {})
    near = did_you_mean(name, [n for n in offered if not n.startswith("_")])
    advice = instead.get(name) or near or instead.get("*", PAGE)
    return AttributeError(f"simkit's {owner} has no {name}; {advice}", name=name)


@cache
def _advice() -> Mapping[str, Mapping[str, str]]:
    """What to use instead of a name, by owner."""
    return tomllib.loads(Path(__file__).with_name("missing_names.toml").read_text(encoding="utf-8"))
