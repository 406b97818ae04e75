"""Errors for names of Gazebo's Python modules that simkit does not have; the message suggests a replacement."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import Final

from simkit.extend import did_you_mean

PAGE: Final = "docs/gazebo_python.md lists the supported names"


def missing_name_error(owner: str, name: str, offered: Iterable[str]) -> AttributeError:
    """Create the error for a name that a module or class of Gazebo has, but simkit does not have.

    Args:
        owner: Gazebo's name of the module or class, such as `gz.sim` or `Link`.
        name: missing name.
        offered: public names of the module or class in simkit, for a suggestion.
    """
    if name.startswith("__"):
        return AttributeError(f"{owner!r} has no attribute {name!r}", name=name)
    replacements = _replacements().get(owner, {})
    near = did_you_mean(name, [n for n in offered if not n.startswith("_")])
    advice = replacements.get(name) or near or replacements.get("*", PAGE)
    return AttributeError(f"simkit's {owner} has no {name}; {advice}", name=name)


@cache
def _replacements() -> Mapping[str, Mapping[str, str]]:
    """Read the replacement of each missing name, by module or class."""
    return tomllib.loads(Path(__file__).with_name("missing_names.toml").read_text(encoding="utf-8"))
