"""Reports of golden runs: the most important lines are first, and all names in the page are escaped."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from lxml import etree
from report_samples import CAMERA, SCAN, difference, failing, passing, record

from simkit.testing.golden.compare.difference import Cause, Comparison, Explanation, Verdict
from simkit.testing.golden.report import junit_cases, text_report, write_html
from simkit.testing.golden.report.html import report_page
from simkit.testing.run_record.record import Column

NASTY = "</title><script>alert('\"&\x00\u202e')</script>"
XHTML = "{http://www.w3.org/1999/xhtml}"
SVG = "{http://www.w3.org/2000/svg}"


def words_of(element: etree._Element) -> str:
    return "".join(map(str, element.itertext()))


def tree(*verdicts: Verdict) -> etree._Element:
    return etree.fromstring(report_page(verdicts).encode())


# ---------------------------------------------------------------------- text


def test_the_first_line_is_the_first_difference_and_the_second_line_its_cause() -> None:
    first, second, *_ = text_report(failing(), 200)
    assert first == "FAILED  drive: /scan.ranges: 14 of 360 rays +12 mm from t = 2.00 s"
    assert second == (
        "  cause   wheel::collision: radius 0.033 → 0.0333 m (model.sdf:123); with this change undone, "
        "the outputs equal the golden run"
    )


def test_a_run_that_passes_is_one_line() -> None:
    assert text_report(passing()) == ["ok      stand: 5 topics, 900 messages, bit for bit (0.5 s)"]


def test_a_run_that_another_renderer_draws_within_tolerances_is_not_called_equal() -> None:
    verdict = passing()
    verdict.comparison.machine["renderer"] = ("llvmpipe", "software")
    assert "bit for bit" in text_report(verdict)[0]
    verdict.comparison.is_identical = False
    first = text_report(verdict, 200)[0]
    assert "within the tolerances of another machine (renderer llvmpipe → software)" in first


def test_differences_checks_notes_and_versions_are_reported() -> None:
    text = "\n".join(text_report(failing(), 200))
    for said in (
        "allowed 1 mm",
        "/odom: 50 Hz became 51 Hz: 200 messages became 204",
        "check   pose('cart').x > 2: it was 1.9 at most – drive on",
        "tier    other machine or versions (mujoco 4.0.0 → 4.0.1): within the tolerances",
        "note    /imu: less than 1e-9 apart",
    ):
        assert said in text


@pytest.mark.parametrize("width", [40, 60, 100])
def test_lines_are_as_long_as_the_terminal_is_wide(width: int) -> None:
    lines = text_report(failing(), width)
    assert max(map(len, lines)) <= width
    assert all(line.startswith(("FAILED", "  ")) for line in lines)


def test_a_long_list_reports_the_number_of_omitted_items() -> None:
    verdict = failing()
    many = [difference(f"/t{i}", "x", "value", f"/t{i}.x differs") for i in range(40)]
    verdict.comparison.differences[:] = many
    lines = text_report(verdict, most=5)
    assert sum(".x differs" in line or "more diff" in line for line in lines) == 7
    assert any("… and 34 more differences" in line for line in lines)


def test_the_text_of_an_explanation_replaces_the_list_of_causes() -> None:
    verdict = failing()
    verdict.explanation = Explanation(lines=["cause: the wheel is larger", "nothing else was changed"])
    assert text_report(verdict)[1:3] == ["  cause   the wheel is larger", "          nothing else was changed"]


def test_a_failed_run_reports_the_failure_first() -> None:
    verdict = failing()
    verdict.run.end = "SK-PHYS-001 the physics diverged at 1.2 s: joint wheel\nsecond line"
    assert text_report(verdict, 200)[0].endswith(
        "the run failed: SK-PHYS-001 the physics diverged at 1.2 s: joint wheel"
    )


def test_a_world_change_without_effect_is_reported_with_its_cause() -> None:
    words = "the world is another in 2 places: [1.0, 2.0, …"
    comparison = Comparison("exact", [difference("", "", "model", words, time=0.0)])
    explanation = Explanation([Cause("model", "model wall moved 2 mm along x", "models[wall]", 2.0, 2.002)])
    verdict = Verdict("w", record(), record(), comparison, explanation)
    head = text_report(verdict, 200)[0]
    assert head == ("FAILED  w: the world changed, but no recorded output differs: model wall moved 2 mm along x")


# ---------------------------------------------------------------------- the page


def test_the_page_is_well_formed_and_loads_and_runs_nothing(tmp_path: Path) -> None:
    write_html(tmp_path / "deep" / "report.html", [passing(), failing()])
    text = (tmp_path / "deep" / "report.html").read_text(encoding="utf-8")
    root = etree.fromstring(text.encode())
    names = {element.tag for element in root.iter() if isinstance(element.tag, str)}
    assert not names & {XHTML + name for name in ("script", "link", "iframe", "object")}
    sources = [e.get("src", "") for e in root.iter(XHTML + "img")]
    assert sources
    assert all(source.startswith("data:image/png;base64,iVBOR") for source in sources)
    assert not re.search(r"(src|href)=\"(?!data:|#)", text)
    assert "default-src 'none'" in text
    assert 'name="viewport"' in text
    assert "prefers-color-scheme: dark" in text


def test_failed_runs_are_first_with_plots_pictures_and_causes() -> None:
    root = tree(passing(), failing())
    sections = root.findall(f".//{XHTML}section")
    assert [section.get("class") for section in sections] == ["failed", "passed"]
    text = words_of(sections[0])
    for said in (
        "14 of 360 rays +12 mm",
        "radius 0.033 → 0.0333 m",
        "model.sdf:123",
        "pose('cart').x > 2",
        "SK-SDF-001",
        "1 of 6 tiles of the whole picture differ",
        "4.0.1",
        "model::link.mass=2",
    ):
        assert said in text
    # a scan 3, the state 2 of each of 2 quantities, an odometry 2, noise 2, a count 1
    assert len(list(root.iter(SVG + "svg"))) == 3 + 4 + 2 + 2 + 1
    assert len(list(root.iter(XHTML + "img"))) == 2 * 3


def test_no_name_becomes_markup() -> None:
    verdict = replace(failing(), name=NASTY)
    verdict.comparison.differences = [
        replace(one, topic=NASTY if one.topic == SCAN else one.topic, words=NASTY, allowed=NASTY, unit=NASTY)
        for one in verdict.comparison.differences
    ]
    for run in (verdict.golden, verdict.run):
        stream = run.streams.pop(SCAN)
        run.streams[NASTY] = stream
        stream.topic = NASTY
        run.fingerprint = {NASTY: NASTY}
        run.diagnostics = {NASTY: id(run)}
        run.states.names[0] = NASTY
    verdict.run.end = NASTY
    verdict.explanation = Explanation([Cause("model", NASTY, NASTY, NASTY, NASTY, NASTY)], lines=[NASTY])
    root = tree(verdict, replace(passing(), name=NASTY))
    assert not list(root.iter(XHTML + "script"))
    for line in text_report(verdict):
        assert line.isprintable()
    assert junit_cases(verdict)


def test_nan_and_lists_of_different_lengths_are_drawn_or_left_out() -> None:
    verdict = failing()
    golden, run = verdict.golden.streams[SCAN], verdict.run.streams[SCAN]
    golden.columns["ranges"] = Column(np.full((40, 5), np.nan))
    run.columns["ranges"] = Column(np.arange(120.0), lengths=np.full(40, 3))
    pictures = verdict.run.streams[CAMERA].pictures
    assert pictures is not None
    pictures.small = pictures.small[:, ::2]
    pictures.encoding = "mono8"
    text = report_page([verdict])
    etree.fromstring(text.encode())
    assert "NaN" not in text
    assert "nan" not in re.sub(r"base64,[^\"]*", "", text)


def test_streams_without_messages_and_unknown_fields_are_drawn_without_an_error() -> None:
    verdict = failing()
    for stream in verdict.run.streams.values():
        stream.times_ns = stream.times_ns[:0]
    verdict.comparison.differences.append(difference("/odom", "nobody.knows", "value", "/odom.nobody.knows differs"))
    etree.fromstring(report_page([verdict]).encode())


def test_a_page_of_many_long_runs_stays_small() -> None:
    verdicts = []
    for number in range(30):
        verdict = replace(failing(), name=f"run {number}")
        for side in (verdict.golden, verdict.run):
            odom = side.streams["/odom"]
            odom.times_ns = np.arange(200_000) * 5_000_000
            odom.columns["pose.pose.position.x"] = Column(np.random.default_rng(number).normal(size=200_000))
        verdicts.append(verdict)
    text = report_page(verdicts)
    assert len(text) < 6_000_000
    assert text.count("<figure>") <= 80
    assert "run 29" in text


def test_a_long_list_of_differences_is_cut() -> None:
    verdict = failing()
    verdict.comparison.differences += [difference(f"/t{i}", "x", "value", f"/t{i}.x") for i in range(1000)]
    text = words_of(tree(verdict))
    assert "/t100.x" in text
    assert "/t900.x" not in text
    assert "808 more differences" in text


def test_stored_pictures_are_found_by_message() -> None:
    verdict = failing()
    for side in (verdict.golden, verdict.run):
        pictures = side.streams[CAMERA].pictures
        assert pictures is not None
        pictures.small, pictures.tiles, pictures.kept = pictures.small[::2], pictures.tiles[::2], np.arange(0, 20, 2)
    verdict.comparison.differences = [difference(CAMERA, "data", "picture", "it differs", index=9)]
    assert "picture 10 at 2 s" in words_of(tree(verdict))


# ---------------------------------------------------------------------- JUnit


def test_every_topic_and_check_is_a_case_and_those_that_differ_fail() -> None:
    cases = junit_cases([failing(), passing()])
    failed = {case.name for case in cases if case.failure is not None}
    assert failed == {
        "/scan",
        "/odom",
        "/imu",
        "/camera/image",
        "/camera/depth",
        "/gone",
        "state",
        "pose('cart').x > 2",
    }
    assert {case.classname for case in cases} == {"golden.drive", "golden.drive.checks", "golden.stand"}
    assert sum(case.seconds for case in cases) == 2.0
    scan = next(case for case in cases if case.name == "/scan" and case.failure)
    assert scan.failure is not None
    assert scan.failure[0] == "/scan.ranges: 14 of 360 rays +12 mm from t = 2.00 s (allowed: 1 mm)"
    assert "radius 0.033 → 0.0333 m" in scan.failure[1]


def test_a_failed_run_is_an_error() -> None:
    verdict = failing()
    verdict.run.end = "SK-PHYS-001 diverged"
    case = junit_cases(verdict)[0]
    assert case.error is not None
    assert case.error[0] == "the run failed: SK-PHYS-001 diverged"
