"""Tables of elements: they list exactly the names that the readers read, and the page is generated from them."""

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
def read_names(load, write, monkeypatch) -> dict[str, set[str]]:
    """Return the names of elements and attributes that a reader read, by place in the tables."""
    roots: list[Params] = []
    original_load = SdfLoader.load

    def load_and_record_roots(self, document, request):
        original_file = Workspace.file

        def record_root(workspace, *args):
            file = original_file(workspace, *args)
            roots.append(file.root)
            return file

        with monkeypatch.context() as patch:
            patch.setattr(Workspace, "file", record_root)
            return original_load(self, document, request)

    monkeypatch.setattr(SdfLoader, "load", load_and_record_roots)
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
def test_a_table_lists_exactly_the_names_that_its_readers_read(read_names, table):
    for place in [p for p in {table.element, *read_names} if p.split("/")[0] == table.element]:
        rows = {*ELEMENTS.elements(place), *(f"@{a}" for a in ELEMENTS.attributes(place))}
        used = {name for name in rows if ELEMENTS.row(place, name).use.read}
        if table.open:
            assert {n for n in used if not n.startswith("@")} <= read_names[place] | {"plugin"}
        else:
            assert read_names[place] - rows == set(), f"{place}: read, and not in the table"
            assert used - read_names[place] == set(), f"{place}: in the table, and never read"


def test_the_test_files_visit_every_place_with_rows(read_names):
    places = {p.rpartition("/")[0] for p, row in ELEMENTS.rows.items() if row.use.read}
    assert places - set(read_names) == set()


def test_the_page_is_generated_from_the_tables():
    from simkit.loaders.elements_page import page

    hint = "generate it again: python -m simkit.loaders.elements_page > docs/elements.md"
    assert (DOCS / "elements.md").read_text() == page(), hint


@pytest.mark.parametrize("table", ELEMENTS.tables, ids=lambda t: t.element)
def test_every_reference_of_a_table_names_an_existing_table(table):
    names = {t.element for t in ELEMENTS.tables}
    assert {row.like for row in table.rows if row.like} <= names
