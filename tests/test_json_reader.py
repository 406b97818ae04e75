"""JSON of strangers: depth, number of values and digits have limits."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from simkit.errors import SimkitError
from simkit.json_reader import MAX_DEPTH, MAX_VALUES, parse_json
from simkit.loaders.resources.fuel_cache import read_lock
from tests.limited_memory import run_limited


@pytest.mark.parametrize(("left", "right"), [("[", "]"), ('{"a":', "}")])
def test_the_depth_has_a_limit(left: str, right: str) -> None:
    def nested(depth: int) -> str:
        return left * depth + "1" + right * depth

    assert parse_json(nested(MAX_DEPTH)) == json.loads(nested(MAX_DEPTH))
    for depth in (MAX_DEPTH + 1, 900, 100_000):
        with pytest.raises(ValueError, match=f"nested deeper than {MAX_DEPTH}"):
            parse_json(nested(depth))


def test_the_number_of_values_has_a_limit() -> None:
    assert len(parse_json(b"[" + b"0," * (MAX_VALUES - 1) + b"0]")) == MAX_VALUES
    with pytest.raises(ValueError, match=f"more than {MAX_VALUES} values"):
        parse_json(b"[" + b"0," * MAX_VALUES + b"0]")


def test_digits_without_end_are_an_error_in_plain_words() -> None:
    with pytest.raises(ValueError, match="more than 4300 digits"):
        parse_json("9" * 5000)
    assert parse_json('"\\ud800"') == "\ud800"


def test_a_lock_file_of_nested_lists_is_refused(tmp_path: Path) -> None:
    (tmp_path / "simkit.lock").write_text("[" * 100_000)
    with pytest.raises(SimkitError, match="SK-FETCH-007"):
        read_lock(tmp_path / "simkit.lock")


def test_a_mesh_of_millions_of_empty_lists_takes_no_memory(tmp_path: Path) -> None:
    mesh = "<mesh><uri>m.gltf</uri></mesh>"
    link = f'<link name="l"><visual name="v"><geometry>{mesh}</geometry></visual></link>'
    (tmp_path / "w.sdf").write_text(f'<sdf version="1.9"><world name="w"><model name="m">{link}</model></world></sdf>')
    (tmp_path / "m.gltf").write_bytes(b'{"asset":{"version":"2.0"},"x":[' + b"[]," * 10_000_000 + b"0]}")
    result = run_limited(["check", str(tmp_path / "w.sdf")], 900)
    assert result.returncode == 0 and "more than 5000000 values" in result.stdout + result.stderr, result.stderr[-300:]
