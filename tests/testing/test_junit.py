"""JUnit XML: required attributes, escaping of any text, and atomic writes."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from lxml import etree

from simkit.errors import InputError
from simkit.testing.junit import LONGEST, JunitCase, junit_text, write_junit
from simkit.writers.atomic_output import write_atomically

CASES = [
    JunitCase("straight", "drive", 1.25),
    JunitCase("turn", "drive", 0.5, failure=("/odom +3 mm", "/odom.x: +3 mm\nfrom t = 1 s"), output="a note"),
    JunitCase("world", "drive", error=("SK-XML-001 not XML", "w.sdf:1: …"), file="drive/w.sdf"),
    JunitCase("camera", "drive", skipped="no renderer"),
]


def tree(cases: list[JunitCase]) -> etree._Element:
    return etree.fromstring(junit_text("golden", cases).encode())


def test_a_suite_counts_its_cases_and_adds_their_times() -> None:
    root = tree(CASES)
    for element in (root, root[0]):
        counted = {name: element.get(name) for name in ("tests", "failures", "errors", "skipped", "time")}
        assert counted == {"tests": "4", "failures": "1", "errors": "1", "skipped": "1", "time": "1.750"}


def test_each_case_has_its_result() -> None:
    passed, failed, wrong, skipped = tree(CASES)[0]
    assert (passed.get("classname"), passed.get("name"), passed.get("time")) == ("drive", "straight", "1.250")
    assert len(passed) == 0
    failure = failed.find("failure")
    assert failure is not None
    assert (failure.get("message"), failure.text) == ("/odom +3 mm", "/odom.x: +3 mm\nfrom t = 1 s")
    assert failed.findtext("system-out") == "a note"
    assert wrong.get("file") == "drive/w.sdf"
    assert wrong.find("error") is not None
    reason = skipped.find("skipped")
    assert reason is not None
    assert reason.get("message") == "no renderer"


@pytest.mark.parametrize(
    ("text", "read"),
    [
        ('<script>&"]]>', '<script>&"]]>'),
        ("a\x00b\x1bc", "a\ufffdb\ufffdc"),
        ("\x1b[1;31mred\x1b[0m", "red"),
        ("half \ud83d pair", "half \ufffd pair"),
        ("größer → µm 🤖", "größer → µm 🤖"),
        ("two\r\nlines", "two\nlines"),
    ],
)
def test_any_text_is_read_back_without_characters_invalid_in_xml(text: str, read: str) -> None:
    root = tree([JunitCase(text, text, failure=(text, text), output=text)])
    failure = root[0][0].find("failure")
    assert failure is not None
    assert failure.text == read
    assert failure.get("message") == " ".join(read.split())
    assert root[0][0].get("name") == " ".join(read.split())


def test_a_long_text_keeps_its_beginning_and_its_end() -> None:
    text = tree([JunitCase("c", output="first" + "x" * 10 * LONGEST + "last")])[0][0].findtext("system-out")
    assert text is not None
    assert text.startswith("first")
    assert text.endswith("last")
    assert len(text) < LONGEST + 100
    assert "characters left out" in text


def test_nan_and_negative_times_are_written_as_zero() -> None:
    assert tree([JunitCase("c", seconds=float("nan")), JunitCase("d", seconds=-1.0)])[0].get("time") == "0.000"


def test_a_suite_without_cases_is_a_valid_file() -> None:
    assert tree([])[0].get("tests") == "0"


def test_equal_cases_give_equal_files_in_a_folder_that_is_made(tmp_path: Path) -> None:
    for name in ("a/b/one.xml", "two.xml"):
        write_junit(tmp_path / name, "golden", CASES)
    assert (tmp_path / "a/b/one.xml").read_bytes() == (tmp_path / "two.xml").read_bytes()
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a", "two.xml"]


def test_a_failed_write_is_an_error_and_leaves_no_file(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    for path in (tmp_path, tmp_path / "file" / "out.xml"):
        with pytest.raises(InputError, match="SK-CLI-016 cannot write"):
            write_junit(path, "golden", [])
    assert [p.name for p in tmp_path.iterdir()] == ["file"]


def test_a_link_stays_a_link_and_the_mask_of_the_process_counts(tmp_path: Path) -> None:
    (tmp_path / "real").write_bytes(b"old")
    (tmp_path / "link").symlink_to("real")
    old = os.umask(0o027)
    try:
        write_atomically(tmp_path / "link", b"new")
    finally:
        os.umask(old)
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "real").read_bytes() == b"new"
    assert (tmp_path / "real").stat().st_mode & 0o777 == 0o640


def test_a_report_can_be_written_to_a_pipe(tmp_path: Path) -> None:
    read, write = os.pipe()
    write_atomically(f"/dev/fd/{write}", b"<xml/>")
    os.close(write)
    assert os.read(read, 100) == b"<xml/>"
    os.close(read)
