"""Typed reading of a block of parameters."""

from __future__ import annotations

import importlib
import math

import pytest

from simkit.diagnostics import Diagnostics
from simkit.loaders.resources.xml_reader import parse_text
from simkit.params import Params
from simkit.plugins.unread_parameters import names_read


def block(text: str) -> Params:
    params = parse_text(f"<p>{text}</p>", Diagnostics(), "f.sdf")
    assert params is not None
    return params


def problems(params: Params) -> list[tuple[str, str]]:
    return [(d.code, d.hint) for d in params.diagnostics]


def test_values_are_read_with_their_types_and_defaults():
    p = block("<a>1.5</a><b>360.0</b><c>True</c><d> x </d><e>1 2 3</e>")
    assert (p.number("a"), p.integer("b"), p.boolean("c"), p.text("d"), p.vector3("e")) == (
        1.5,
        360,
        True,
        "x",
        (1, 2, 3),
    )
    assert (p.number("z", 7), p.boolean("z", True), p.text("z", "q")) == (7, True, "q")
    assert not problems(p)


def test_an_empty_number_has_the_default_as_in_sdformat():
    p = block("<a></a>")
    assert p.number("a", 4.0) == 4.0
    assert problems(p) == [("SK-PARAM-005", "")]
    assert block("<a></a>").number("a", 4.0, required=True) == 4.0


@pytest.mark.parametrize("text", ["x", "nan", "1_0", "inf"])
def test_an_invalid_number_is_an_error_and_returns_the_default(text):
    p = block(f"<a>{text}</a>")
    assert p.number("a", 4.0) == 4.0
    assert problems(p) == [("SK-PARAM-002", "")]


def test_a_truth_value_for_a_number_is_one_or_zero_with_a_warning():
    p = block("<a>false</a><b>True</b><c>false</c><d>yes</d>")
    assert (p.number("a", 5.0), p.integer("b"), p.number("c", 2.0, minimum=1.0), p.number("d", 3.0)) == (
        0.0,
        1,
        2.0,
        3.0,
    )
    assert [d.code for d in p.diagnostics] == ["SK-PARAM-005"] * 3 + ["SK-PARAM-002"] * 2
    assert "<a>false</a> is not a number, 0 is used" in [d.message for d in p.diagnostics]


def test_letters_after_a_number_are_ignored_with_a_warning_as_in_gazebo():
    p = block("<a>1.5m</a><b>0 0 1 0 0 -1.92s</b><c>-2kg</c><d>m1</d>")
    assert (p.number("a"), p.pose("b").rpy[2]) == (1.5, pytest.approx(-1.92))
    assert (p.number("a"), p.number("c", 4.0, minimum=0.0), p.number("d", 3.0)) == (1.5, 4.0, 3.0)
    assert [d.code for d in p.diagnostics] == ["SK-PARAM-005"] * 2 + ["SK-PARAM-002"] * 2
    assert "<c>-2kg</c>" in list(p.diagnostics)[2].message


def test_the_error_for_a_number_out_of_range_has_the_range():
    p = block("\n<a>-1</a>")
    p.number("a", minimum=0, maximum=2)
    (error,) = p.diagnostics
    assert "from 0 to 2" in error.message and (error.file, error.line) == ("f.sdf", 2)


def test_a_required_element_that_is_missing_names_the_closest():
    p = block("<lef_joint>x</lef_joint>")
    assert p.text("left_joint", required=True) == ""
    assert problems(p) == [("SK-PARAM-001", "did you mean 'lef_joint'?")]


def test_unread_elements_are_reported_except_foreign_prefixes():
    p = block("<a>1</a><raduis>2</raduis><gz:x/><sub><y/></sub>")
    p.number("a"), p.number("radius", 1.0), p.block("sub").text("z", "")
    p.report_unread("SK-PARAM-003", "plugin 'q'")
    assert problems(p) == [("SK-PARAM-003", "did you mean 'radius'?"), ("SK-PARAM-003", "")]


def test_a_name_in_another_style_is_closer_than_one_with_another_letter():
    p = block("<distortion_k1>0</distortion_k1>")
    p.number("distortionT1", 0.0), p.number("distortionK1", 0.0)
    p.report_unread("SK-PARAM-003", "plugin 'q'")
    assert problems(p) == [("SK-PARAM-003", "did you mean 'distortionK1'?")]


READER = """
class Reader:
    def load(self, params):
        self.gain = params.number(default=1.0, name="gain")
        # self.limit = params.number("limit")
        self.title = params.text(
            # shown in the window
            "title",
        )
"""


def test_a_call_in_a_comment_reads_no_parameter_and_keywords_have_any_order(tmp_path, monkeypatch):
    (tmp_path / "commented_plugin.py").write_text(READER)
    monkeypatch.syspath_prepend(tmp_path)
    assert names_read(importlib.import_module("commented_plugin").Reader) == {"gain", "title"}


def test_the_second_of_two_equal_elements_is_reported():
    p = block("<max>1</max><max>2</max>")
    assert p.number("max") == 1.0
    p.report_unread("SK-PARAM-003", "sonar")
    assert problems(p) == [("SK-PARAM-003", "the first <max> is")]


def test_a_pose_may_be_in_degrees_or_a_quaternion():
    p = block("<a degrees='true'>0 0 0 0 0 90</a><b rotation_format='quat_xyzw'>1 2 3 0 0 0 1</b><c>1 2</c>")
    assert p.pose("a").rpy[2] == pytest.approx(math.pi / 2)
    assert tuple(p.pose("b").position) == (1, 2, 3)
    p.pose("c")
    assert [code for code, _ in problems(p)] == ["SK-PARAM-002"]


def test_a_pose_with_too_few_numbers_has_no_rotation_and_one_with_too_many_ignores_them() -> None:
    """Gazebo Classic reads these poses so; later versions refuse them."""
    p = block("<a>1 2 3 0.5 0.5</a><b>1 2 3 0 0 0.5 7 8</b><c>1 2 3</c>")
    short = p.pose("a")
    assert tuple(short.position) == (1, 2, 3) and tuple(short.rpy) == (0, 0, 0)
    assert p.pose("b").rpy[2] == pytest.approx(0.5)
    assert tuple(p.pose("c").position) == (1, 2, 3)
    assert {(d.code, d.severity) for d in p.diagnostics} == {("SK-PARAM-006", "warning")}
    assert "it is 0, as in Gazebo Classic" in next(iter(p.diagnostics)).message


def test_a_block_made_in_python_reads_like_one_from_a_file():
    p = Params.from_dict({"joint": ["a", "b"], "on": True, "size": (1, 2, 3), "inner": {"k": 4}})
    assert [j.value for j in p.all("joint")] == ["a", "b"]
    assert p.boolean("on") and p.vector3("size") == (1, 2, 3) and p.block("inner").number("k") == 4


def test_surplus_numbers_are_ignored_with_a_warning():
    p = block("<a>1 2</a><e>1 2 3 4</e><f>1 2 x 4</f>")
    assert (p.number("a"), p.vector3("e")) == (1.0, (1.0, 2.0, 3.0))
    assert [(d.code, d.severity) for d in p.diagnostics] == [("SK-PARAM-006", "warning")] * 2
    p.vector3("f")
    assert problems(p)[-1][0] == "SK-PARAM-002"


def test_an_element_that_was_read_is_not_suggested_for_a_missing_element() -> None:
    diagnostics = Diagnostics()
    params = Params.from_dict({"front_left_joint": "a", "frnt_right_joint": "b"}, "plugin", diagnostics)
    params.text("front_left_joint", required=True)
    params.text("front_right_joint", required=True)
    params.text("back_left_joint", required=True)
    assert ["frnt_right_joint" in d.hint for d in diagnostics] == [True, False]
    assert not any("front_left_joint" in d.hint for d in diagnostics)
