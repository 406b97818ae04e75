"""Charts say what the numbers say, in few bytes, and the same bytes each time."""

from __future__ import annotations

import io
import re
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

from simkit.errors import InputError
from simkit.recording.charts.chart import Chart, check_suffix, render_chart
from simkit.recording.charts.series import Series, series_over

SVG = "{http://www.w3.org/2000/svg}"


def series(label: str, values: object, unit: str = "m", step: float = 0.1, **more: object) -> Series:
    numbers = np.asarray(values, dtype=np.float64)
    return Series(label, unit, times=np.arange(len(numbers)) * step, values=numbers, **more)  # type: ignore[arg-type]


def paths(svg: bytes, colour: str = "#1f77b4", width: str = "1.4") -> list[str]:
    root = ElementTree.fromstring(svg)
    return [
        p.get("d", "") for p in root.iter(f"{SVG}path") if p.get("stroke") == colour and p.get("stroke-width") == width
    ]


def points(path: str) -> np.ndarray:
    return np.array([[float(n) for n in pair.split()] for pair in re.split("[ML]", path)[1:]])


def test_the_line_passes_through_the_values() -> None:
    found = points(paths(render_chart(Chart([series("a", [0.0, 1.0, 0.5])]), ".svg"))[0])
    assert len(found) == 3
    assert found[1, 0] - found[0, 0] == pytest.approx(found[2, 0] - found[1, 0], abs=0.11)
    up = found[0, 1] - found[:, 1]  # pixels upwards
    assert up[2] / up[1] == pytest.approx(0.5, abs=0.01)


def test_a_peak_among_a_million_numbers_is_seen_in_a_small_file() -> None:
    values = np.zeros(1_000_000)
    values[123_456] = 7.0
    svg = render_chart(Chart([series("a", values)]), ".svg")
    found = points(paths(svg)[0])
    assert len(svg) < 200_000
    assert found[:, 1].min() < found[0, 1] - 300


def test_a_line_is_split_at_missing_numbers_and_at_the_wrap_of_an_angle() -> None:
    assert len(paths(render_chart(Chart([series("a", [0, 1, np.nan, 1, 2, np.inf, 3, 4])]), ".svg"))) == 3
    turning = [3.0, 3.1, -3.1, -3.0]
    assert len(paths(render_chart(Chart([series("yaw", turning, "rad", is_angle=True)]), ".svg"))) == 2
    assert len(paths(render_chart(Chart([series("x", turning, "rad")]), ".svg"))) == 1


@pytest.mark.parametrize("values", [[np.nan] * 3, [1.0], [1e300, -1e300], [5e-324, 0.0], [7.0] * 9, [1e9, 1e9 + 1e-6]])
def test_numbers_of_any_size_are_drawn(values: list[float]) -> None:
    for ending in (".svg", ".png"):
        assert render_chart(Chart([series("a", values)]), ending)


def test_names_are_escaped() -> None:
    svg = render_chart(Chart([series("</svg><script>alert(1)</script>\0\x1b&", [0, 1])], title="<b>\ud800"), ".svg")
    root = ElementTree.fromstring(svg)
    assert not list(root.iter(f"{SVG}script")) and not list(root.iter("script"))


def test_each_unit_has_a_panel_and_all_panels_share_the_time_axis() -> None:
    svg = render_chart(Chart([series("a", [0, 1]), series("b", [0, 9], "rad"), series("c", [0, 2])]), ".svg").decode()
    assert svg.count(">length [m]<") == 1 and svg.count(">b [rad]<") == 1 and svg.count("time [s]") == 1


def test_the_same_numbers_make_the_same_bytes() -> None:
    chart = Chart([series("a", np.sin(np.arange(100))), series("b²", np.cos(np.arange(100)), "m/s²")], title="t")
    for ending in (".svg", ".png"):
        assert render_chart(chart, ending) == render_chart(chart, ending)
    picture = Image.open(io.BytesIO(render_chart(chart, ".png")))
    assert picture.format == "PNG" and picture.width == 1920
    assert len(picture.convert("RGB").getcolors(1 << 20)) > 10


def test_a_number_is_drawn_over_the_newest_value_of_another_number() -> None:
    y = series("y", [10.0, 20.0, 30.0], step=0.1)
    x = Series("x", "m", times=np.array([0.05, 0.2]), values=np.array([1.0, 2.0]))
    (found,) = series_over([y], x)
    assert found.times.tolist() == [1.0, 2.0] and found.values.tolist() == [20.0, 30.0]


def test_other_file_suffixes_are_refused() -> None:
    check_suffix("a.SVG")
    for name in ("a.pdf", "a", ""):
        with pytest.raises(InputError, match="SK-BAG-012"):
            check_suffix(name)


def test_a_chart_has_colours_for_dark_pages_and_labels_beside_its_ticks() -> None:
    svg = render_chart(Chart([series("a", [0, 1000]), series("b", [0, 9])]), ".svg").decode()
    assert "prefers-color-scheme:dark" in svg
    assert svg.count('[fill="#ffffff"]{fill:#15181c}') == 1
    found = re.search(r'<text x="([\d.]+)"[^>]*rotate[^>]*>length \[m\]', svg)
    assert found is not None
    assert 20.0 < float(found[1]) < 45.0  # [px]; the ticks end at 72 and "1000" is 27 wide


def test_the_panel_of_a_path_has_the_proportions_of_the_path() -> None:
    heights = []
    for high in (0.01, 0.07, 1.0):  # the path is 0.1 m wide
        path = replace(series("y", [0.0, high]), base_unit="m")
        svg = render_chart(Chart([path], x_label="x [m]", is_plane=True), ".svg").decode()
        heights.append(int(re.search(r'height="(\d+)"', svg)[1]))  # type: ignore[index]
    assert heights[0] < heights[1] < heights[2] < 1000
