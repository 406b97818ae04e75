"""Texts of strangers: the time to read them is proportional to their length, also if nothing in them fits."""

from __future__ import annotations

import subprocess
import sys

import pytest

from simkit.loaders.resources.xml_reader import without_comments
from simkit.plugins.ros_parameter_files import node_matches

# The time of the expressions before was quadratic or exponential: minutes to years for these lengths.
READERS = {
    "digits in YAML": "from simkit.yaml_reader import read_yaml; read_yaml('x: ' + '0' * 1_000_000 + '!')",
    "spaces in a message definition": (
        "from simkit.msgs import definition_parser; list(definition_parser._items('a' + ' ' * 1_000_000 + '!'))"
    ),
    "items in a message definition": (
        "from simkit.msgs import definition_parser; list(definition_parser._items(' ' + '1,' * 400_000))"
    ),
    "wildcards of nodes": (
        "from simkit.plugins.ros_parameter_files import node_matches; node_matches('/**' * 300 + '/x', '/a' * 3000)"
    ),
    "comments in a processing instruction": (
        "import simkit; simkit.check('<robot name=\"r\" xmlns:xacro=\"x\"><?a $' + '<!--' * 1_000_000 + '?></robot>')"
    ),
}


@pytest.mark.parametrize("name", READERS)
def test_a_long_text_that_does_not_fit_takes_seconds(name: str) -> None:
    result = subprocess.run(
        [sys.executable, "-c", READERS[name]], capture_output=True, text=True, timeout=60, check=False
    )
    assert result.returncode == 0, result.stderr


@pytest.mark.parametrize(
    ("pattern", "name", "fits"),
    [
        ("/**", "/a/b", True),
        ("/**", "/", True),
        ("/a/**", "/a", False),
        ("/a/**", "/a/b/c", True),
        ("/**/c", "/c", True),
        ("/**/c", "/a/b/c", True),
        ("/**/b/**/c", "/a/b/x/c", True),
        ("/**/b/**/c", "/a/x/c", False),
        ("/*/c", "/a/c", True),
        ("/*/c", "/a/b/c", False),
        ("/*", "/a", True),
        ("/a", "/a/b", False),
        ("/a/b", "/a", False),
    ],
)
def test_wildcards_of_nodes_are_those_of_ros(pattern: str, name: str, fits: bool) -> None:
    assert node_matches(pattern, name) is fits


def test_comments_are_removed_and_their_lines_can_stay() -> None:
    text = b"<a><!-- 1\n2 --><b/><!--\n--><!-- no end <c/>"
    assert without_comments(text) == b"<a><b/><!-- no end <c/>"
    assert without_comments(text, keep_lines=True) == b"<a>\n<b/>\n<!-- no end <c/>"
