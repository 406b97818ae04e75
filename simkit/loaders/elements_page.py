"""Generator of `docs/elements.md`, the list of all SDF and URDF elements and how simkit uses each one.

`python -m simkit.loaders.elements_page > docs/elements.md` writes the page. A test compares the page with the tables.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Iterator
from pathlib import Path

from simkit.loaders.sdf.element_table import Row, Table, sdf_elements

_INTRODUCTION = """# What each element becomes

This page is generated from the tables in `simkit/loaders`; do not edit it. Attributes begin with `@`.

- **used**: has the meaning that the format defines.
- **approximated**: is read, and simkit does something similar.
- **ignored**: configures another engine or Gazebo's windows; one note (`SK-SDF-010`) lists all of them.
- **not simulated**: has no effect; each one causes a warning (`SK-SDF-012`).

Every other name is unknown and causes a warning with line and closest known name: `SK-SDF-011` for an element,
`SK-SDF-037` for an attribute, `SK-SDF-038` for text where only elements are allowed. Names with a prefix (`gz:…`)
belong to the plugin or sensor that reads them.
"""


def page() -> str:
    """Return the whole page as Markdown."""
    return "\n".join([_INTRODUCTION, "## SDF 1.0 to 1.12", "", *_sdf(), *_urdf()])


def _sdf() -> Iterator[str]:
    for table in sdf_elements().tables:
        yield from _section(table)


def _section(table: Table) -> Iterator[str]:
    yield f"### `<{table.element}>`" if " " not in table.element else f"### {table.element.capitalize()}"
    yield ""
    yield from _head("element", "is", "becomes")
    for row in table.rows:
        path = row.path.replace("#text", "(text)")
        yield f"| `{path}` | {row.use.value} | {_cell(row.becomes)}{_link(row)} |"
    yield ""


def _link(row: Row) -> str:
    if not row.like:
        return ""
    anchor = row.like.replace(" ", "-")
    return f" ([{row.like}](#{anchor}))"


def urdf_elements() -> list[tuple[str, str]]:
    """Return the table of URDF's elements as pairs: path of the element, and its use in simkit.

    A path lists element names from `<robot>` down; `@name` is an attribute. `gazebo[link]`, `gazebo[joint]` and
    `gazebo[robot]` are the `<gazebo>` extensions that refer to a link, to a joint, or to the whole robot.
    """
    with Path(__file__).with_name("urdf").joinpath("elements.csv").open(encoding="utf-8", newline="") as file:
        return [(line["path"], line["becomes"]) for line in csv.DictReader(file)]


def _urdf() -> Iterator[str]:
    yield from ("## URDF", "")
    yield from _head("element", "becomes")
    for path, becomes in urdf_elements():
        yield f"| `{path}` | {_cell(becomes)} |"
    yield ""


def _head(*names: str) -> Iterator[str]:
    yield "| " + " | ".join(names) + " |"
    yield "|" + " --- |" * len(names)


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("<", "&lt;").replace(">", "&gt;")


if __name__ == "__main__":
    sys.stdout.write(page())
