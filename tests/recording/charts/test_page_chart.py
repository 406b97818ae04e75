"""Charts inside a page: lines stay true when they are thinned, labels tell values apart, gaps stay gaps."""

from __future__ import annotations

import numpy as np
import pytest
from lxml import etree

from simkit.recording.charts.axis import thin_line
from simkit.recording.charts.page_chart import PageChart, page_chart_svg
from simkit.recording.charts.series import Series

SVG = "{http://www.w3.org/2000/svg}"


def svg_of(values: np.ndarray, **more: object) -> etree._Element:
    series = Series("", times=np.arange(float(len(values))), values=values)
    return etree.fromstring(page_chart_svg(PageChart([(series, "run")], "t", "x", "value", **more)))  # type: ignore[arg-type]


def labels(svg: etree._Element) -> list[str]:
    return ["".join(map(str, text.itertext())) for text in svg.iter(SVG + "text")]


def test_a_thinned_line_keeps_the_highest_and_the_lowest_of_each_pixel() -> None:
    rng = np.random.default_rng(1)
    x, y = np.sort(rng.uniform(0.0, 400.0, 100_000)), rng.normal(size=100_000)
    y[12_345] = 50.0
    xs, ys = thin_line(np.column_stack((x, y)), 1.0).T
    assert len(xs) <= 4 * 401
    assert np.all(np.diff(xs) >= 0.0)
    for column in (0, 17, 399):
        whole, kept = y[x.astype(int) == column], ys[xs.astype(int) == column]
        assert (kept.min(), kept.max()) == (whole.min(), whole.max())
    assert 50.0 in ys


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ([0.0, 1.0], "0.5"),
        ([0.0, 1e-9], "5e-10"),
        ([9.80665, 9.80665 + 1e-7], "value, less 9.8066500"),
        ([3.0, 3.0], "3.00"),
        ([-1e7, 1e7], "5e6"),
        ([np.nan, np.inf], "0.5"),
    ],
)
def test_labels_of_different_values_differ_at_any_magnitude(values: list[float], expected: str) -> None:
    found = labels(svg_of(np.array(values)))
    assert any(label.startswith(expected.rstrip("0")) for label in found), found
    assert len(set(found)) >= len(found) - 4  # of two axes, labels may be alike; of one they are not


def test_missing_values_interrupt_the_line_and_a_single_value_is_a_dot() -> None:
    svg = svg_of(np.array([1.0, 2.0, np.nan, 3.0, np.inf, 4.0, 5.0]))
    path = next(p for p in svg.iter(SVG + "path") if "run" in (p.get("class") or ""))
    d = path.get("d") or ""
    assert d.count("M") == 3
    assert d.count("h.01") == 1


def test_a_logarithmic_chart_has_powers_of_ten_and_omits_values_without_logarithm() -> None:
    series = Series("", times=np.array([1.0, 10.0, 100.0, 1000.0]), values=np.array([1.0, 0.0, 10.0, 100.0]))
    svg = etree.fromstring(page_chart_svg(PageChart([(series, "run")], "t", "x", "y", is_log=True)))
    assert {"1e0", "1e1", "1e2", "1e3"} <= set(labels(svg))
    path = next(p for p in svg.iter(SVG + "path") if "run" in (p.get("class") or ""))
    assert (path.get("d") or "").count("M") == 2
