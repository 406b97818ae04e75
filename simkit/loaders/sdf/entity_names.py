"""Names of entities: required, unique among siblings, and not reserved."""

from __future__ import annotations

from simkit.diagnostics import Diagnostics
from simkit.params import Params

LONGEST_NAME = 1000
MOST_SIBLINGS = 100_000


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
        problem = f"<{element.name}> has a name of {len(name)} characters; the limit is {LONGEST_NAME}"
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


def named_elements(
    elements: list[Params], owner: str, diagnostics: Diagnostics, version: tuple[int, int] = (1, 12)
) -> list[tuple[str, Params]]:
    """Return the elements that have a name, with their names; a repeated name is an error."""
    found: dict[str, Params] = {}
    if len(elements) > MOST_SIBLINGS:
        text = f"{owner} has {len(elements)} <{elements[0].name}> elements; the limit is {MOST_SIBLINGS}"
        diagnostics.error("SK-XML-002", text, elements[MOST_SIBLINGS].where)
        return []
    for element in elements:
        name = read_name(element, diagnostics, version)
        if not name:
            continue
        if name in found:
            text = f"{owner} has two <{element.name}> named {name!r} (the other at line {found[name].where.line})"
            diagnostics.error("SK-SDF-002", text, element.where)
        else:
            found[name] = element
    return list(found.items())
