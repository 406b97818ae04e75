"""sdformat's Element over a block of a world file."""

from __future__ import annotations

import copy

import pytest

from simkit import Params
from simkit_gz_python.math import Angle, Color, Pose3d, Vector2d, Vector3d
from simkit_gz_python.sdformat import Element, JointAxis


@pytest.fixture
def element() -> Element:
    params = Params.from_dict(
        {
            "force": 2.5,
            "count": 3,
            "on": True,
            "name": "left",
            "offset": (1, 2, 3),
            "pair": (4, 5),
            "place": "1 2 3 0 0 0.5",
            "paint": "1 0 0",
            "turn": 0.7,
            "wheel": [{"radius": 0.1}, {"radius": 0.2}],
            "bad": "strong",
        }
    )
    params.attributes["version"] = "7"
    return Element(params)


def test_values_are_read_by_type(element: Element) -> None:
    assert element.get_double("force") == 2.5 and element.get_int("count") == 3 and element.get_bool("on") is True
    assert element.get_string("name") == "left" and element.get_int("version") == 7
    assert element.get_vector3d("offset") == Vector3d(1, 2, 3) and element.get_vector2d("pair") == Vector2d(4, 5)
    assert element.get_pose("place") == Pose3d(1, 2, 3, 0, 0, 0.5) and element.get_angle("turn") == Angle(0.7)
    assert element.get_color("paint") == Color(1, 0, 0)


def test_a_read_with_a_default_returns_a_flag_for_the_value(element: Element) -> None:
    assert element.get_double("force", 1.0) == (2.5, True)
    assert element.get_double("weight", 1.0) == (1.0, False)
    assert element.get_double("weight") == 0.0 and element.get_string("nickname") == ""


def test_children_can_be_iterated(element: Element) -> None:
    wheel = element.find_element("wheel")
    assert wheel is not None
    radii = []
    while wheel is not None:
        radii.append(wheel.get_double("radius"))
        wheel = wheel.get_next_element("wheel")
    assert radii == [0.1, 0.2]
    first = element.get_first_element()
    assert first is not None and first.get_name() == "force" and first.get_double() == 2.5
    assert element.has_element("wheel") and not element.has_element("track") and element.find_element("track") is None


def test_attributes_are_params(element: Element) -> None:
    version = element.get_attribute("version")
    assert version is not None and version.get_as_string() == "7" and element.has_attribute("version")
    assert element.get_attribute("size") is None


def test_a_text_that_is_no_number_is_recorded_with_what_is_allowed(element: Element) -> None:
    assert element.get_double("bad") == 0.0
    (found,) = element._params.diagnostics
    assert found.code == "SK-PARAM-002" and "strong" in found.message


def test_unread_elements_can_be_reported(element: Element) -> None:
    element.get_double("force")
    assert "force" not in {child.name for child, _ in element._params.unread()}


def test_an_element_is_written_as_xml() -> None:
    made = Element()
    made.set_name("plugin")
    made.add_element("force").set_double(2.5)
    assert made.to_string() == "<plugin>\n  <force>2.5</force>\n</plugin>\n"


def test_an_axis_without_a_file_is_z() -> None:
    assert JointAxis().xyz() == Vector3d(0, 0, 1) and JointAxis().upper() == 1e16


def test_attributes_have_a_place_and_what_is_missing_a_hint() -> None:
    element = Element(Params("e", attributes={"a": "1", "b": "2"}))
    second = element.get_attribute(1)
    assert second is not None and second.get_key() == "b" and element.get_attribute(2) is None
    assert copy.deepcopy(element).get_int("b") == 2
    with pytest.raises(AttributeError, match="Element has no get_element; use find_element"):
        element.get_element  # noqa: B018
