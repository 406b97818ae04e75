"""The course's page about the ROS 2 graph is executed: what its terminals show is what the page says."""

from __future__ import annotations

import re
from contextlib import ExitStack
from pathlib import Path

import pytest

from tests.cli.course_page import TEXT, WITHOUT_ROS, Desk, blocks, pattern_of


@pytest.mark.slow
def test_the_terminals_of_the_page_show_what_it_says(place: Path, tmp_path: Path) -> None:
    with ExitStack() as stack:
        desk = Desk(tmp_path, stack, {"TMPDIR": str(place)})  # no simulation of anybody else
        desk.play(WITHOUT_ROS)
        desk.finish()


def test_each_block_has_its_name_in_the_paragraph_before() -> None:
    found = blocks(TEXT)
    assert len(found) > 40
    for block in found:
        assert block.paragraph.endswith(":")
        assert (block.title if block.kind == "console" else f"File `{block.title}`") in block.paragraph


def test_whole_numbers_and_words_of_the_page_count_and_decimal_numbers_do_not() -> None:
    pattern = pattern_of("[INFO] [12.5] [adder]: 2 + 40 = 42\n…\nend …\n")
    assert re.search(pattern, "[INFO] [7.25] [adder]: 2 + 40 = 42\nmore\nend of it\n")
    assert not re.search(pattern, "[INFO] [12.5] [adder]: 2 + 40 = 43\nmore\nend of it\n")
    assert not re.search(pattern, "[WARN] [12.5] [adder]: 2 + 40 = 42\nend of it\n")
    assert not re.search(pattern, "first\n[INFO] [12.5] [adder]: 2 + 40 = 42\nend of it\n")
