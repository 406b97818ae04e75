"""The tables of elements: they know exactly the names that the readers ask for, and the page says what they say."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path

import pytest
from wide_sdf import BARE, BARE_INCLUDE, BOX, WORLD

from simkit.loaders.sdf.element_table import sdf_elements
from simkit.loaders.sdf.load_context import Workspace
from simkit.loaders.sdf.loader import SdfLoader
from simkit.params import Params

ELEMENTS = sdf_elements()
DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture
def asked(load, write, monkeypatch) -> dict[str, set[str]]:
    """Place in the tables -> names of elements and attributes that a reader asked for there."""
    roots: list[Params] = []
    read = SdfLoader.load

    def spy(self, document, request):
        seen = Workspace.file

        def note(workspace, *args):
            file = seen(workspace, *args)
            roots.append(file.root)
            return file

        with monkeypatch.context() as patch:
            patch.setattr(Workspace, "file", note)
            return read(self, document, request)

    monkeypatch.setattr(SdfLoader, "load", spy)
    folder = write("models/box/model.sdf", BOX).parents[1]
    for text in (WORLD, BARE, BARE_INCLUDE):
        load(text, (folder,))
    found: dict[str, set[str]] = defaultdict(set)

    def visit(element: Params, place: str) -> None:
        found[place] |= element.asked | {f"@{name}" for name in element.attributes_asked}
        for child in element.children:
            if child.was_read and ELEMENTS.row(place, child.name):
                visit(child, ELEMENTS.content_place(place, child.name))

    for root in roots:
        visit(root, "sdf")
    return found


@pytest.mark.parametrize("table", ELEMENTS.tables, ids=lambda t: t.element)
def test_a_table_has_the_names_that_its_readers_ask_for(asked, table):
    for place in [p for p in {table.element, *asked} if p.split("/")[0] == table.element]:
        rows = {*ELEMENTS.elements(place), *(f"@{a}" for a in ELEMENTS.attributes(place))}
        used = {name for name in rows if ELEMENTS.row(place, name).use.read}
        if table.open:
            assert {n for n in used if not n.startswith("@")} <= asked[place] | {"plugin"}
        else:
            assert asked[place] - rows == set(), f"{place}: read, and not in the table"
            assert used - asked[place] == set(), f"{place}: in the table, and never read"


def test_every_place_with_rows_was_visited(asked):
    places = {p.rpartition("/")[0] for p, row in ELEMENTS.rows.items() if row.use.read}
    assert places - set(asked) == set()


def test_the_page_is_what_the_tables_say():
    from simkit.loaders.elements_page import page

    hint = "write it anew: python -m simkit.loaders.elements_page > docs/elements.md"
    assert (DOCS / "elements.md").read_text() == page(), hint


@pytest.mark.parametrize("table", ELEMENTS.tables, ids=lambda t: t.element)
def test_every_reference_from_a_table_leads_to_one(table):
    names = {t.element for t in ELEMENTS.tables}
    assert {row.like for row in table.rows if row.like} <= names
