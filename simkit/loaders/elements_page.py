"""`docs/elements.md`: what each element of SDF and URDF becomes, written from the loaders' own tables.

`python -m simkit.loaders.elements_page > docs/elements.md` writes the page; a test compares it with the tables.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Iterator
from pathlib import Path

from simkit.loaders.sdf.element_table import Row, Table, sdf_elements

_INTRODUCTION = """# What each element becomes

Written from the tables in `simkit/loaders`; do not edit. Attributes begin with `@`.

- **used**: it means what the format says.
- **approximated**: it is read, and something near to it happens.
- **ignored**: a setting of another engine or of Gazebo's windows; one note (`SK-SDF-010`) names all of a file.
- **not simulated**: a warning (`SK-SDF-012`) for each.

Anything else is not known: a warning with line and closest name (`SK-SDF-011` for an element, `SK-SDF-037` for an
attribute, `SK-SDF-038` for text where elements belong). Names with a prefix (`gz:…`) belong to whoever asks for them.
"""


def page() -> str:
    """The whole page as Markdown."""
    return "\n".join([_INTRODUCTION, "## SDF 1.0 to 1.12", "", *_sdf(), *_urdf()])


def _sdf() -> Iterator[str]:
    for one in sdf_elements().tables:
        yield from _section(one)


def _section(one: Table) -> Iterator[str]:
    yield f"### `<{one.element}>`" if " " not in one.element else f"### {one.element.capitalize()}"
    yield ""
    yield from _head("element", "is", "becomes")
    for row in one.rows:
        path = row.path.replace("#text", "(text)")
        yield f"| `{path}` | {row.use.value} | {_cell(row.becomes)}{_link(row)} |"
    yield ""


def _link(row: Row) -> str:
    if not row.like:
        return ""
    anchor = row.like.replace(" ", "-")
    return f" ([{row.like}](#{anchor}))"


def urdf_elements() -> list[tuple[str, str]]:
    """URDF's own table: each path, and what it becomes.

    A path is element names from `<robot>` down, `@name` an attribute. `gazebo[link]`, `gazebo[joint]` and
    `gazebo[robot]` are the extensions whose reference names a link, a joint, or nothing.
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
