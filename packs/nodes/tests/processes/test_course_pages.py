"""The course's pages about nodes of ROS in separate terminals are executed."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path

import pytest

from tests.cli.course_page import Desk, blocks

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGES = ("course_ros1.md", "course_ros2.md")


@pytest.mark.slow
@pytest.mark.parametrize("name", PAGES)
def test_the_terminals_of_a_page_show_what_it_says(name: str, sockets: Path, tmp_path: Path) -> None:
    with ExitStack() as stack:
        desk = Desk(tmp_path, stack, {"TMPDIR": str(sockets)})
        desk.play((DOCS / name).read_text(encoding="utf-8"))
        desk.finish()


@pytest.mark.parametrize("name", PAGES)
def test_each_block_has_its_name_in_the_paragraph_before(name: str) -> None:
    for block in blocks((DOCS / name).read_text(encoding="utf-8")):
        assert block.paragraph.endswith(":")
        assert (block.title if block.kind == "console" else f"File `{block.title}`") in block.paragraph
