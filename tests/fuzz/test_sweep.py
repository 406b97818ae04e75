"""NaN, infinities, huge and negative numbers, nothing and text in every place of SDF and URDF that holds a number."""

from __future__ import annotations

import random
from collections.abc import Iterator

import pytest
from campaign import MOST, several_readers, try_many
from lxml import etree
from reader import FINE, Reader
from sweep import COMPANIONS, NUMBERS, VALUES, Place, documents, places, with_value
from test_broken_files import SECONDS, SEED, complaint
from wide_sdf import BARE, WORLD

SOME = 1  # values of a place that are always tried; other ones for each place


@pytest.fixture(scope="module")
def readers() -> Iterator[list[Reader]]:
    yield from several_readers([])


@pytest.fixture(scope="module")
def reader(readers: list[Reader]) -> Reader:
    return readers[0]


def swept(reader: Reader, place: Place, values: tuple[str, ...], folder) -> list[str]:
    problems = []
    for value in values:
        main = f"input.{place.document.rpartition('.')[2]}"
        files = {main: with_value(place, value), **COMPANIONS}
        answer = reader.read(main, files, f"{place} = {value!r}")
        if answer["outcome"] not in FINE:
            problems.append(f"{place} = {value!r}: {complaint(main, files, answer, folder)}")
    return problems


@pytest.mark.slow
@pytest.mark.parametrize("name", documents())
def test_a_document_of_the_sweep_loads(name: str, reader: Reader) -> None:
    main = f"input.{name.rpartition('.')[2]}"
    answer = reader.read(main, {main: documents()[name].encode(), **COMPANIONS})
    assert answer["outcome"] == "loaded", answer


@pytest.mark.slow
def test_odd_numbers_are_errors_or_clean_imports(reader: Reader, tmp_path) -> None:
    found: list[str] = []
    for number, place in enumerate(places()[::2]):
        some = tuple(VALUES[(number * 5 + k * 7) % len(VALUES)] for k in range(SOME))
        found += swept(reader, place, some, tmp_path)
    assert not found, "\n".join(found[:20])


@pytest.mark.fuzz
def test_every_odd_number_in_every_place_is_an_error_or_a_clean_import(readers: list[Reader], tmp_path) -> None:
    """14 352 worlds in an order that the seed draws: 2 to 10 minutes, unless twice the time ends it."""
    cases = [(place, value) for place in places() for value in VALUES]
    random.Random(SEED).shuffle(cases)

    def one(reader: Reader, index: int) -> str:
        place, value = cases[index]
        return "\n".join(swept(reader, place, (value,), tmp_path))

    try_many("odd numbers", one, readers, 2 * SECONDS, min(MOST, len(cases)))


def test_the_sweep_reaches_every_number_that_a_reader_asks_for() -> None:
    """Elements and attributes with a number in the file that has everything, by their name and their parent's."""

    def ends(text: str) -> set[str]:
        root = etree.fromstring(text, etree.XMLParser(recover=True))
        elements = [e for e in root.iter() if isinstance(e.tag, str)]
        leaves = [e for e in elements if len(e) == 0 and e.text and NUMBERS.fullmatch(e.text)]
        return {f"{e.getparent().tag}/{e.tag}" for e in leaves if e.getparent() is not None}

    swept_ = set().union(*(ends(text) for text in documents().values()))
    switches = (
        "static shadows grid gravity kinematic enable_wind self_collide allow_auto_disable cast_shadows visualize"
    )
    switches += " enable_metrics"
    missing = {e for e in ends(WORLD) | ends(BARE) if e.rpartition("/")[2] not in switches.split()} - swept_
    assert sorted(missing) == []
