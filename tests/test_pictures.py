"""The script of the pictures draws each picture that a page shows, and no other."""

from __future__ import annotations

import re
import runpy
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[1]
LINK = re.compile(r"!\[[^\]]*\]\(([^)\s]+)\)|<img[^>]+src=\"([^\"]+)\"")
OF_THE_REPOSITORY = "https://github.com/simkit-robotics/simkit/raw/main/"
GALLERY = "docs/images/gallery/"  # `.ci/gallery.py` draws these
BY_HAND = {"docs/images/architecture.svg"}
OF_LABS = re.compile(r"labs/.*")  # the tests of a lab draw its picture from the solution, and compare it
LARGEST = 150_000  # bytes of a picture that does not move


def pages() -> list[Path]:
    parts = ("docs/**/*.md", "packs/*/docs/**/*.md", "packs/*/README.md", "labs/*/*.md", "benchmarks/*.md", "*.md")
    return sorted(page for part in parts for page in ROOT.glob(part))


def shown() -> set[str]:
    """Return the paths of all pictures that a page shows, relative to the root."""
    found = set()
    for page in pages():
        for one, other in LINK.findall(page.read_text(encoding="utf-8")):
            link = one or other
            if link.startswith(OF_THE_REPOSITORY):
                found.add(link.removeprefix(OF_THE_REPOSITORY))
            elif not link.startswith(("http:", "https:", "data:")):
                found.add((page.parent / link).resolve().relative_to(ROOT).as_posix())
    return found


@pytest.fixture(scope="module")
def table() -> dict[str, Any]:
    pytest.importorskip("av", reason="the script of the pictures reads videos")
    found: dict[str, Any] = runpy.run_path(str(ROOT / ".ci" / "pictures.py"))["PICTURES"]
    return found


def test_the_script_draws_each_picture_of_a_page(table: dict[str, Any]) -> None:
    missing = {path for path in shown() - set(table) - BY_HAND if not path.startswith(GALLERY)}
    assert {path for path in missing if not OF_LABS.fullmatch(path)} == set()


def test_a_page_shows_each_picture_that_the_script_draws(table: dict[str, Any]) -> None:
    assert set(table) - shown() == set()


def test_each_picture_of_a_page_exists_and_is_small() -> None:
    sizes = {path: (ROOT / path).stat().st_size for path in shown() if Path(path).suffix != ".webp"}
    assert len(sizes) > 80
    assert {path: size for path, size in sizes.items() if size > LARGEST} == {}
