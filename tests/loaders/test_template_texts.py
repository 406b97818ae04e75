"""Texts that a launch file, xacro or a template was to fill in are told with their remedy."""

from __future__ import annotations

from pathlib import Path

import pytest

import simkit
from simkit.template_texts import find_template_text


def model(name: str, mass: str) -> str:
    link = f"<link name='{name}'><inertial><mass>{mass}</mass></inertial></link>"
    return f"<sdf version='1.9'><model name='m'>{link}</model></sdf>"


@pytest.mark.parametrize(
    ("text", "advice"),
    [
        ("$(arg m)", "load the .xacro file itself"),
        ("${m * 2}", "load the .xacro file itself"),
        ("{{ m }}", "a template engine"),
        ("__MASS__", "simkit launch"),
        ("@BODY_MASS@", "simkit launch"),
    ],
)
def test_a_number_that_nobody_filled_in_is_an_error_with_the_remedy(text: str, advice: str) -> None:
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(model("base", text))
    (error,) = (d for d in caught.value.diagnostics if d.code == "SK-PARAM-002")
    assert advice in error.hint


@pytest.mark.parametrize("text", ["$(find pkg)/x.dae", "$(find-pkg-share pkg)/x", "__model__", "a_{b}", "$5", "__x"])
def test_other_texts_are_no_templates(text: str) -> None:
    assert find_template_text(text) == ("", "")


def test_a_name_that_nobody_filled_in_is_a_warning_once_a_file(tmp_path: Path) -> None:
    file = tmp_path / "part.sdf"
    file.write_text(model("$(arg prefix)base", "1"), encoding="utf-8")
    include = f"<include><uri>{file.name}</uri><name>{{}}</name></include>"
    world = tmp_path / "w.sdf"
    includes = include.format("a") + include.format("b")
    world.write_text(f"<sdf version='1.9'><world name='w'>{includes}</world></sdf>", encoding="utf-8")
    found = [d for d in simkit.check(world) if d.code == "SK-XML-006"]
    assert [(d.severity, d.file, d.message) for d in found] == [
        ("warning", str(file), "the text '$(arg prefix)' was not filled in")
    ]


def test_a_comment_with_such_a_text_is_no_problem(tmp_path: Path) -> None:
    assert not [d for d in simkit.check(f"<!-- $(arg m) -->{model('base', '1')}") if d.code == "SK-XML-006"]


def test_a_urdf_that_xacro_did_not_expand_tells_it() -> None:
    text = "<robot name='r'><link name='l'><inertial><mass value='${m}'/></inertial></link></robot>"
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(text)
    assert any("load the .xacro file itself" in d.hint for d in caught.value.diagnostics if d.code == "SK-URDF-013")
