"""Parameters in a wrong form: a value for a block, a list for a value, and so on."""

from __future__ import annotations

from pathlib import Path

import pytest

from simkit import Params
from simkit.extend import Diagnostics
from simkit.plugins.ros_parameter_files import ParameterFiles, read_parameter_file
from simkit_control.plugins.ros2_control.diff_drive_options import DriveOptions
from simkit_control.plugins.ros2_control.trajectory_options import read_timeout


def node(folder: Path, text: str) -> tuple[Params, Diagnostics]:
    """The parameters of a node, and where problems go."""
    path = folder / "node.yaml"
    path.write_text("node:\n  ros__parameters:\n" + "".join(f"    {line}\n" for line in text.splitlines()))
    found = Diagnostics()
    read = read_parameter_file(path, found)
    assert read is not None
    entry = ParameterFiles([read]).of_node("/node")
    assert entry is not None
    return entry.params("node", found)[0], found


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("rate: [100, 50]", "found a list for 'rate'; expected a number"),
        ("rate: []", "found a list for 'rate'; expected a number"),
        ("rate: {a: 1}", "found a block for 'rate'; expected a number"),
        ("rate:", "found rate without a value; expected a number"),
    ],
)
def test_only_a_value_is_a_number(tmp_path: Path, text: str, message: str) -> None:
    params, found = node(tmp_path, text)
    assert params.number("rate", 7.0) == 7.0
    assert [(d.line, d.message) for d in found] == [(3, message)]


@pytest.mark.parametrize("text", ["gains: 5", "gains: [1]", "gains: []", "gains: abc"])
def test_only_a_block_is_a_block(tmp_path: Path, text: str) -> None:
    params, found = node(tmp_path, text)
    assert params.block("gains").number("p", 2.0) == 2.0
    assert "for 'gains'; expected a block of names with values" in next(iter(found)).message


def test_a_name_with_nothing_below_it_is_an_empty_block(tmp_path: Path) -> None:
    params, found = node(tmp_path, "gains:")
    assert params.block("gains").number("p", 2.0) == 2.0
    assert not list(found)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("joints: {j1: 1}", "found a block for 'joints'; expected a list"),
        ("joints: [j1, {j2: 1}]", "found a block in the list 'joints'; expected a value"),
        ("joints: [j1, [j2]]", "found a list in the list 'joints'; expected values"),
    ],
)
def test_only_values_are_in_a_list(tmp_path: Path, text: str, message: str) -> None:
    params, found = node(tmp_path, text)
    params.all("joints")
    assert [d.message for d in found] == [message]


def test_a_single_value_is_a_list_of_one_and_a_list_of_numbers_a_vector(tmp_path: Path) -> None:
    params, found = node(tmp_path, "joints: j1\naxis: [1, 2.5, 3]")
    assert [one.value for one in params.all("joints")] == ["j1"]
    assert params.vector3("axis") == (1.0, 2.5, 3.0)
    assert not list(found)


def test_a_reported_value_is_not_reported_again_as_unread(tmp_path: Path) -> None:
    params, found = node(tmp_path, "rate: [1, 2]\nname: {a: 1}\njoints: {j: 1}")
    params.number("rate", 1.0)
    params.text("name", "")
    params.all("joints")
    params.report_unread("SK-CONTROL-011", "node")
    assert [d.code for d in found] == ["SK-PARAM-002"] * 3


def test_merge_keys_add_missing_keys_to_a_block(tmp_path: Path) -> None:
    params, found = node(tmp_path, "a: &a {p: 1, i: 2}\nb: {<<: *a, p: 3}\nc: {<<: [{p: 4}, {p: 5, d: 6}]}")
    assert [params.block("b").number(name) for name in "pi"] == [3.0, 2.0]
    assert [params.block("c").number(name) for name in "pd"] == [4.0, 6.0]
    assert not list(found)


def test_a_value_without_effect_is_reported_at_its_line(tmp_path: Path) -> None:
    params, found = node(tmp_path, "cmd_timeout: 0.2")
    assert read_timeout(params, 0.5) == 0.0
    wheels = "left_wheel_names: [l]\nright_wheel_names: [r]\nwheel_separation: 1\nwheel_radius: 0.1\nwheels_per_side: 2"
    params, driven = node(tmp_path, wheels)
    DriveOptions(params, "", lambda _left, _right: (None, None))
    assert [(d.code, d.line) for d in (*found, *driven)] == [("SK-CONTROL-023", 3), ("SK-CONTROL-043", 7)]
