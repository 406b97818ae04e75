"""Names of entities: required, unique among siblings, and not reserved."""

from __future__ import annotations

import itertools
from collections.abc import Container
from typing import Literal

from simkit.diagnostics import Diagnostics
from simkit.number_text import counted
from simkit.params import Params

LONGEST_NAME = 1000
MOST_SIBLINGS = 100_000
Repeated = Literal["error", "renamed", "left out"]
"""Treatment of an element whose name an earlier sibling has."""


def scoped(*parts: str) -> str:
    """Join names with `::`; empty names are left out."""
    return "::".join(p for p in parts if p)


def read_name(element: Params, diagnostics: Diagnostics, version: tuple[int, int] = (1, 12)) -> str:
    """Return the `name` attribute; a missing or reserved name is an error."""
    name = element.attribute("name").strip()
    if not name:
        diagnostics.error("SK-SDF-001", f"<{element.name}> needs a name", element.where)
        return ""
    report, problem = diagnostics.error, ""
    if len(name) > LONGEST_NAME:
        problem = f"<{element.name}> has a name of {counted(len(name), 'character')}; the limit is {LONGEST_NAME}"
    elif name.startswith("__") and name.endswith("__"):
        problem = f"<{element.name} name={name!r}>: names __like_this__ are reserved"
    elif name == "world" and element.name != "world":
        report = diagnostics.error if version >= (1, 7) else diagnostics.warning
        problem = f"<{element.name} name='world'>: this name is reserved for the world"
    elif "::" in name and version >= (1, 8):
        problem = f"<{element.name} name={name!r}>: a name cannot contain '::', which separates names"
    if problem:
        report("SK-SDF-003", problem, element.where)
    return name[:LONGEST_NAME]


class FreeNames:
    """Names `name_0`, `name_1`, ... for repeated names, as Gazebo Classic numbers models.

    Args:
        taken: names that are in use.
    """

    def __init__(self, taken: Container[str]) -> None:
        self._taken = taken
        self._numbers: dict[str, itertools.count[int]] = {}

    def next(self, name: str) -> str:
        """Return the next numbered name that is not in use."""
        numbers = self._numbers.setdefault(name, itertools.count())
        return next(free for i in numbers if (free := f"{name}_{i}") not in self._taken)


def named_elements(
    elements: list[Params],
    owner: str,
    diagnostics: Diagnostics,
    version: tuple[int, int] = (1, 12),
    repeated: Repeated = "error",
) -> list[tuple[str, Params]]:
    """Return the elements that have a name, with their names.

    A repeated name is an error, or a warning where Gazebo continues: the element gets another name or is left out.
    """
    by_name: dict[str, Params] = {}
    free = FreeNames({element.attributes.get("name", "").strip() for element in elements})
    if len(elements) > MOST_SIBLINGS:
        text = f"{owner} has {len(elements)} <{elements[0].name}> elements; the limit is {MOST_SIBLINGS}"
        diagnostics.error("SK-XML-002", text, elements[MOST_SIBLINGS].where)
        return []
    for element in elements:
        name = read_name(element, diagnostics, version)
        if not name:
            continue
        if name in by_name:
            text = f"{owner} has two <{element.name}> named {name!r} (the other at line {by_name[name].where.line})"
            if repeated == "renamed":
                other = free.next(name)
                by_name[other] = element
                diagnostics.warning("SK-SDF-002", f"{text}; this one is named {other!r}", element.where)
            elif repeated == "left out":
                element.mark_all_read()
                diagnostics.warning("SK-SDF-002", f"{text}; this one is left out", element.where)
            else:
                diagnostics.error("SK-SDF-002", text, element.where)
        else:
            by_name[name] = element
    return list(by_name.items())
