"""Reading XML: lines, limits and refused content."""

from __future__ import annotations

import pytest

from simkit.diagnostics import Diagnostics
from simkit.loaders.resources import xml_reader
from simkit.loaders.resources.xml_reader import parse_text


def test_every_element_knows_its_line_and_keeps_its_prefix():
    root = parse_text("\n<?xml version='1.0'?>\n<a>\n <gz:b x='1'>t</gz:b></a>", Diagnostics())
    assert root is not None
    child = root.children[0]
    assert (root.where.line, child.where.line, child.name, child.value, child.attributes) == (
        3,
        4,
        "gz:b",
        "t",
        {"x": "1"},
    )


def test_broken_xml_is_an_error_with_its_line():
    found = Diagnostics()
    assert parse_text("<a>\n<b>\n</a>", found, "f.sdf") is None
    (error,) = found
    assert (error.code, error.file, error.line) == ("SK-XML-001", "f.sdf", 3)
    assert "<b>" in error.message


def test_entities_are_refused():
    found = Diagnostics()
    assert parse_text('<!DOCTYPE a [<!ENTITY x "y">]><a>&x;</a>', found) is None
    assert [d.code for d in found] == ["SK-XML-003"]


@pytest.mark.parametrize("text", ["<!-- a -- b --><a/>", "<!-- licence -->\n<?xml version='1.0'?><a/>"])
def test_faults_before_the_root_element_cause_only_a_warning(text):
    found = Diagnostics()
    assert parse_text(text, found) is not None
    assert [(d.code, d.severity) for d in found] == [("SK-XML-004", "warning")]


def test_depth_and_number_of_elements_are_limited(monkeypatch):
    found = Diagnostics()
    assert parse_text("<a>" * 300 + "</a>" * 300, found) is None
    monkeypatch.setattr(xml_reader, "MAX_ELEMENTS", 10)
    assert parse_text("<a>" + "<b/>" * 20 + "</a>", found) is None
    assert {d.code for d in found} == {"SK-XML-002"}


def test_bytes_after_a_zero_byte_are_ignored_with_a_warning():
    found = Diagnostics()
    root = parse_text(b'<robot name="r"><link name="a"/></robot>\r\n\0 rest', found)
    assert root is not None
    assert [c.attribute("name") for c in root.children] == ["a"]
    assert [(d.code, d.severity) for d in found] == [("SK-XML-004", "warning")]
    assert parse_text(b'<robot name="r">\0<link name="a"/></robot>', Diagnostics()) is None


@pytest.mark.parametrize("text", ["Salt & pepper", "a&b", "<![CDATA[a & b]]> & c", "&amp; & &#38;"])
def test_a_plain_ampersand_is_accepted_with_a_warning(text: str) -> None:
    diagnostics = Diagnostics()
    root = parse_text(f"<d>{text}</d>", diagnostics)
    assert root is not None
    assert "&" in root.value
    assert "&amp;" not in root.value
    assert [(d.severity, d.code) for d in diagnostics] == [("warning", "SK-XML-004")]


def test_an_entity_that_is_not_declared_is_an_error() -> None:
    diagnostics = Diagnostics()
    assert parse_text("<d>&pepper;</d>", diagnostics) is None
    assert [(d.severity, d.code) for d in diagnostics] == [("error", "SK-XML-001")]
