"""Parameter files of ROS: layouts, name patterns, values, lines, and invalid files."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent

import pytest

from simkit.diagnostics import Diagnostics
from simkit.params import Params
from simkit.plugins.ros_parameter_files import ParameterFile, ParameterFiles, node_matches, read_parameter_file


def read(folder: Path, text: str) -> tuple[ParameterFile | None, Diagnostics]:
    path, found = folder / "params.yaml", Diagnostics()
    path.write_text(dedent(text), encoding="utf-8")
    return read_parameter_file(path, found), found


def node(folder: Path, text: str, name: str) -> Params:
    file, found = read(folder, text)
    assert file is not None
    assert not found.has_errors
    entry = ParameterFiles([file]).of_node(name)
    assert entry is not None, f"no parameters for {name}"
    return entry.params("node", found)[0]


def test_ros_2_layout_gives_each_node_its_parameters_with_their_lines(tmp_path: Path) -> None:
    text = """\
    controller_manager:
      ros__parameters:
        update_rate: 100
    arm:
      ros__parameters:
        joints: [a, b]
        gains:
          a: {p: 1.5, i: 0}
        gains.b.p: 2
        open_loop: yes
        far: .inf
    """
    params = node(tmp_path, text, "/arm")
    assert [j.value for j in params.all("joints")] == ["a", "b"]
    assert params.block("gains").block("a").number("p") == 1.5
    assert params.block("gains").block("b").number("p") == 2.0
    assert params.boolean("open_loop") is True
    assert params.number("far", finite=False) == float("inf")
    assert params.block("gains").block("a").child("p").where.line == 8  # type: ignore[union-attr]
    assert not list(params.unread())[1:]  # only i, which nobody asked for


@pytest.mark.parametrize(
    ("pattern", "name", "fits"),
    [
        ("/arm", "/arm", True),
        ("/arm", "/robot/arm", False),
        ("/robot/arm", "/robot/arm", True),
        ("/**", "/robot/arm", True),
        ("/**/arm", "/arm", True),
        ("/**/arm", "/a/b/arm", True),
        ("/*/arm", "/robot/arm", True),
        ("/*/arm", "/arm", False),
        ("/robot/*", "/robot/arm", True),
        ("/robot/*", "/other/arm", False),
        ("/a+b", "/aab", False),
    ],
)
def test_node_names_match_patterns(pattern: str, name: str, fits: bool) -> None:
    assert node_matches(pattern, name) is fits


@pytest.mark.parametrize(
    "text",
    [
        "/robot:\n  arm:\n    ros__parameters: {rate: 5}\n",
        "robot:\n  arm:\n    ros__parameters: {rate: 5}\n",
        "/robot/arm:\n  ros__parameters: {rate: 5}\n",
        "/**:\n  ros__parameters: {rate: 5}\n",
        "/**:\n  arm:\n    ros__parameters: {rate: 5}\n",
        "/**/arm:\n  ros__parameters: {rate: 5}\n",
    ],
)
def test_namespaces_are_written_in_many_ways(tmp_path: Path, text: str) -> None:
    assert node(tmp_path, text, "/robot/arm").number("rate") == 5.0


def test_later_values_replace_earlier_ones_key_by_key(tmp_path: Path) -> None:
    text = """\
    /**:
      ros__parameters:
        rate: 5
        gains: {a: {p: 1.0, d: 7.0}}
    arm:
      ros__parameters:
        gains: {a: {p: 2.0}}
    """
    params = node(tmp_path, text, "/arm")
    gains = params.block("gains").block("a")
    assert (params.number("rate"), gains.number("p"), gains.number("d")) == (5.0, 2.0, 7.0)


def test_ros_1_layout_is_the_tree_of_names_itself(tmp_path: Path) -> None:
    text = """\
    rrbot:
      one:
        type: effort_controllers/JointPositionController
        joint: j1
        pid: {p: 100.0, i: 0.01, d: 10.0}
    """
    params = node(tmp_path, text, "/rrbot/one")
    assert params.text("joint") == "j1"
    assert params.block("pid").number("p") == 100.0


@pytest.mark.parametrize(
    ("text", "code", "line", "words"),
    [
        ("arm:\n  ros__parameters:\n    joints: [a, b\n    rate: 1\n", "SK-CONTROL-002", 4, "not valid YAML"),
        ("arm:\n\tros__parameters: 1\n", "SK-CONTROL-002", 2, "not valid YAML"),
        ("just text\n", "SK-CONTROL-002", 1, "names of nodes"),
        ("- a\n- b\n", "SK-CONTROL-002", 1, "names of nodes"),
        ("arm:\n  ros__parameters: 7\n", "SK-CONTROL-002", 2, "names with values"),
        ("? [a, b]\n: 1\n", "SK-CONTROL-002", 1, "as a name"),
        ("a: &x [*x]\n", "SK-CONTROL-002", None, "nested too deeply"),
    ],
)
def test_a_broken_file_is_an_error_at_its_line(
    tmp_path: Path, text: str, code: str, line: int | None, words: str
) -> None:
    _, found = read(tmp_path, text)
    problem = next(d for d in found if d.severity == "error")
    assert (problem.code, problem.line) == (code, line)
    assert words in problem.message


def test_a_file_with_endlessly_repeated_anchors_is_refused(tmp_path: Path) -> None:
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x, x]"]
    lines += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]" for i in range(1, 10)]
    _, found = read(tmp_path, "\n".join(lines))
    assert [d.code for d in found] == ["SK-CONTROL-002"]


@pytest.mark.parametrize("text", ["", "# nothing\n", "---\n"])
def test_an_empty_file_is_reported(tmp_path: Path, text: str) -> None:
    file, found = read(tmp_path, text)
    assert file is not None
    assert [(d.code, d.severity) for d in found] == [("SK-CONTROL-003", "warning")]


def test_a_misspelt_ros_parameters_key_is_reported(tmp_path: Path) -> None:
    _, found = read(tmp_path, "arm:\n  ros_parameters: {rate: 5}\n")
    problem = next(iter(found))
    assert problem.code == "SK-CONTROL-003"
    assert "ros__parameters" in problem.hint


def test_a_duplicate_key_is_reported_with_both_lines(tmp_path: Path) -> None:
    _, found = read(tmp_path, "arm:\n  ros__parameters:\n    rate: 1\n    rate: 2\n")
    problem = next(iter(found))
    assert (problem.code, problem.line) == ("SK-CONTROL-004", 4)
    assert "line 3" in problem.message


def test_a_binary_file_is_an_error(tmp_path: Path) -> None:
    path, found = tmp_path / "params.yaml", Diagnostics()
    path.write_bytes(b"arm: \xff\xfe")
    assert read_parameter_file(path, found) is None
    assert [(d.code, d.severity) for d in found] == [("SK-CONTROL-002", "error")]
