"""`docs/elements.md`: what each element of SDF and URDF becomes, written from the loaders' own tables.

`python -m simkit.loaders.elements_page > docs/elements.md` writes the page; a test compares it with the tables.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator

from simkit.loaders.sdf.elements import TABLES, Row, Table, Use

_SIGNS = {
    Use.USED: "used",
    Use.APPROXIMATED: "approximated",
    Use.IGNORED: "ignored",
    Use.NOT_SIMULATED: "not simulated",
}
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
    for one in TABLES:
        yield from _section(one)


def _section(one: Table) -> Iterator[str]:
    yield f"### `<{one.element}>`" if " " not in one.element else f"### {one.element.capitalize()}"
    yield ""
    yield from _head("element", "is", "becomes")
    for row in one.rows:
        path = row.path.replace("#text", "(text)")
        yield f"| `{path}` | {_SIGNS[row.use]} | {_cell(row.becomes)}{_link(row)} |"
    yield ""


def _link(row: Row) -> str:
    if not row.like:
        return ""
    anchor = row.like.replace(" ", "-")
    return f" ([{row.like}](#{anchor}))"


def _urdf() -> Iterator[str]:
    """URDF's own table, of pairs of a path and what it becomes."""
    from simkit.loaders.urdf.elements import ELEMENTS

    rows: Iterable[tuple[str, str]] = ELEMENTS
    yield from ("## URDF", "")
    yield from _head("element", "becomes")
    for path, becomes in rows:
        yield f"| `{path}` | {_cell(becomes)} |"
    yield ""


def _head(*names: str) -> Iterator[str]:
    yield "| " + " | ".join(names) + " |"
    yield "|" + " --- |" * len(names)


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("<", "&lt;").replace(">", "&gt;")


if __name__ == "__main__":
    sys.stdout.write(page())
