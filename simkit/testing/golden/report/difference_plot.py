"""Figures of differences: charts of numbers, and images side by side."""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, TypeVar

import numpy as np
import numpy.typing as npt

from simkit.number_text import counted
from simkit.recording.charts.page_chart import PageChart
from simkit.recording.charts.series import Series
from simkit.testing.golden.compare.difference import Difference, Verdict
from simkit.testing.run_record.noise_statistics import NoiseStatistics
from simkit.testing.run_record.record import Array, Column, Pictures, States, Stream

_Value = TypeVar("_Value")
_DIFFERENCE_HEIGHT: Final = 110  # height of a chart of differences [px]
_QUANTITIES: Final = 3  # maximum number of state quantities in a figure


@dataclass(frozen=True)
class PlotFigure:
    """Charts and table of one difference.

    Attributes:
        words: Description of the difference.
        caption: Content of the charts.
        charts: Charts whose lines have the classes "golden", "run" and "difference".
        heads, rows: Table above the charts; empty for no table.
    """

    words: str
    caption: str
    charts: Sequence[PageChart]
    heads: Sequence[str] = ()
    rows: Sequence[Sequence[str]] = ()

    @property
    def roles(self) -> set[str]:
        """Classes of the lines that have data."""
        return {role for chart in self.charts for line, role in chart.lines if line.count}


def plot_figure(verdict: Verdict, difference: Difference) -> PlotFigure | None:
    """Draw a difference; return None if it cannot be drawn.

    Args:
        verdict: Verdict that contains the difference.
        difference: Difference of any kind except pictures.
    """
    if difference.kind == "state":
        return _state_figure(verdict.golden.states, verdict.run.states, difference)
    golden = verdict.golden.streams.get(difference.topic)
    run = verdict.run.streams.get(difference.topic)
    if golden is None or run is None:
        return None
    if difference.kind in ("count", "time", "missing", "extra"):
        if not difference.topic:
            return None
        return PlotFigure(difference.words, "messages in each second", [_rate_chart(golden, run)])
    statistics = _common_field(golden.statistics, run.statistics, difference.field)
    if difference.kind == "statistics" and statistics is not None:
        return _noise_figure(difference, *statistics)
    for field in difference.columns or (difference.field,):
        columns = _common_field(golden.columns, run.columns, field)
        if columns is None:
            continue
        if field == difference.field or not np.array_equal(columns[0].values, columns[1].values):
            return _column_figure(difference, field, golden, run, columns)
    return None


def _column_figure(
    difference: Difference, field: str, golden: Stream, run: Stream, columns: tuple[Column, Column]
) -> PlotFigure | None:
    a, b = columns
    count = min(_message_count(a, golden), _message_count(b, run))
    packed = field.endswith((".rgb", ".rgba")) and a.values.dtype.kind == "f"  # colours stored in the bits of a float
    if count == 0 or packed or a.values.dtype.kind not in "biuf" or b.values.dtype.kind not in "biuf":
        return None
    title = f"{difference.topic}.{field}"
    if a.lengths is None and b.lengths is None and a.values[0].size == b.values[0].size == 1:
        ours, theirs = _as_vector(a.values[:count]), _as_vector(b.values[:count])
        shown = field if difference.columns else ""
        return PlotFigure(
            difference.words, shown, _time_charts(golden.times_ns[:count], ours, theirs, title, difference)
        )
    return _array_figure(difference, golden, a, b, count, title)


def _array_figure(
    difference: Difference, golden: Stream, a: Column, b: Column, count: int, title: str
) -> PlotFigure | None:
    """Draw the first message that differs as a profile, and the largest difference of every message."""
    far = np.zeros(count)
    for index in range(count):
        ours, theirs = _as_vector(a.of(index)), _as_vector(b.of(index))
        if len(ours) != len(theirs):
            far[index] = np.nan
            continue
        off = np.abs(_difference(theirs, ours))
        far[index] = float(off[np.isfinite(off)].max(initial=0.0))
    first = difference.index
    if not 0 <= first < count:
        differing = np.flatnonzero((far > 0.0) | ~np.isfinite(far))
        first = int(differing[0]) if len(differing) else 0
    ours, theirs = _as_vector(a.of(first)), _as_vector(b.of(first))
    seconds = golden.times_ns[:count] * 1e-9
    unit = _unit(difference)
    if max(len(ours), len(theirs)) <= 4:
        off = _difference(theirs, ours) if len(ours) == len(theirs) else np.zeros(0)
        worst = int(np.nanargmax(np.abs(off))) if np.isfinite(off).any() else 0
        if a.lengths is None and b.lengths is None and worst < min(len(ours), len(theirs)):
            pair = [_as_vector(column.values[:count].reshape(count, -1)[:, worst]) for column in (a, b)]
            parts = _time_charts(golden.times_ns[:count], pair[0], pair[1], f"{title}[{worst}]", difference)
            return PlotFigure(difference.words, f"component {worst}", parts)
    profile = [(_profile(ours), "golden"), (_profile(theirs), "run")]
    shared = min(len(ours), len(theirs))
    shift = _profile(_difference(theirs[:shared], ours[:shared]))
    parts = [
        PageChart(profile, f"{title} at {seconds[first]:.6g} s", "number of the value", f"value{unit}"),
        _difference_chart(shift, f"{title}: difference", "number of the value", unit),
        _difference_chart(_line(seconds, far), f"{title}: largest difference", "time [s]", unit, difference.time),
    ]
    return PlotFigure(
        difference.words,
        f"message {first} at {seconds[first]:.6g} s; below: the largest difference in each message",
        parts,
    )


def _time_charts(times_ns: Array, ours: Array, theirs: Array, title: str, difference: Difference) -> list[PageChart]:
    seconds, unit = times_ns * 1e-9, _unit(difference)
    lines = [(_line(seconds, ours), "golden"), (_line(seconds, theirs), "run")]
    mark = difference.time
    return [
        PageChart(lines, title, "time [s]", f"value{unit}", mark=mark),
        _difference_chart(_line(seconds, _difference(theirs, ours)), f"{title}: difference", "time [s]", unit, mark),
    ]


def _difference_chart(line: Series, title: str, x_label: str, unit: str, mark: float | None = None) -> PageChart:
    return PageChart([(line, "difference")], title, x_label, f"Δ{unit}", _DIFFERENCE_HEIGHT, mark)


def _rate_chart(golden: Stream, run: Stream) -> PageChart:
    """Draw the number of messages in each simulated second, except for the last second, which may be incomplete."""
    lines = []
    seconds = max([1, *(int(stream.times_ns[-1]) // 10**9 for stream in (golden, run) if len(stream.times_ns))])
    for stream, role in ((golden, "golden"), (run, "run")):
        counts = np.bincount((stream.times_ns // 10**9).astype(np.int64), minlength=seconds)[:seconds]
        x = np.repeat(np.arange(seconds + 1.0), 2)[1:-1]
        lines.append((_line(x, np.repeat(counts.astype(float), 2)), role))
    return PageChart(lines, golden.topic, "time [s]", "messages a second")


def _state_figure(golden: States, run: States, difference: Difference) -> PlotFigure | None:
    """Draw the quantities with the largest differences at the first stored state that differs."""
    shared = sorted(set(golden.names) & set(run.names))
    ticks, ours_at, theirs_at = np.intersect1d(golden.ticks, run.ticks, return_indices=True)
    if not shared or len(ticks) == 0:
        return None
    ours = golden.values[ours_at][:, [golden.names.index(name) for name in shared]]
    theirs = run.values[theirs_at][:, [run.names.index(name) for name in shared]]
    off = np.abs(_difference(theirs, ours))
    differing = np.flatnonzero((off > 0.0).any(axis=1))
    if len(differing) == 0:
        return None
    order = np.argsort(-np.nan_to_num(off[differing[0]]), kind="stable")[:_QUANTITIES]
    seconds = ticks * golden.timestep
    parts = []
    for number in order:
        if not (off[:, number] > 0.0).any():
            continue
        lines = [(_line(seconds, ours[:, number]), "golden"), (_line(seconds, theirs[:, number]), "run")]
        parts.append(PageChart(lines, shared[number], "time [s]", "value", 150))
        line = _line(seconds, _difference(theirs[:, number], ours[:, number]))
        below = _difference_chart(line, f"{shared[number]}: difference", "time [s]", "")
        parts.append(replace(below, caption=shared[number]))
    return PlotFigure(
        difference.words, "the quantities with the largest differences in the first state that differs", parts
    )


def _noise_figure(difference: Difference, golden: NoiseStatistics, run: NoiseStatistics) -> PlotFigure | None:
    rows = []
    for number in range(min(len(golden.mean), len(run.mean))):
        moments = [(s.mean[number], s.deviation[number]) for s in (golden, run)]
        rows.append([str(number), *(f"{mean:.6g} ± {deviation:.6g}" for mean, deviation in moments)])
    unit = _unit(difference)
    worst = _worst_component(golden, run)
    parts = []
    if worst is not None and golden.quantiles.shape[1] > 1 and golden.quantiles.shape == run.quantiles.shape:
        share = np.linspace(0.0, 1.0, golden.quantiles.shape[1])
        lines = [(_line(share, golden.quantiles[worst]), "golden"), (_line(share, run.quantiles[worst]), "run")]
        parts.append(PageChart(lines, "quantiles", f"share of samples, component {worst}", f"noise{unit}"))
    if worst is not None and len(golden.taus) > 1 and golden.allan.shape == run.allan.shape:
        lines = [(_line(golden.taus, golden.allan[worst]), "golden"), (_line(run.taus, run.allan[worst]), "run")]
        label = f"Allan deviation{unit}"
        parts.append(PageChart(lines, label, "averaging time [s]", label, is_log=True))
    heads = ["component", f"golden mean ± deviation{unit}", "run"]
    return PlotFigure(
        difference.words, f"{golden.count} and {counted(run.count, 'sample')} of the noise", parts, heads, rows
    )


def _worst_component(golden: NoiseStatistics, run: NoiseStatistics) -> int | None:
    shared = min(len(golden.mean), len(run.mean))
    if shared == 0:
        return None
    scale = np.maximum(golden.deviation[:shared], 1e-300)
    with np.errstate(all="ignore"):
        off = np.abs(run.mean[:shared] - golden.mean[:shared]) / scale
        off += np.abs(run.deviation[:shared] - golden.deviation[:shared]) / scale
    return int(np.nan_to_num(off).argmax())


def _line(x: Array, y: Array) -> Series:
    return Series("", times=np.asarray(x, np.float64), values=np.asarray(y, np.float64))


def _common_field(golden: Mapping[str, _Value], run: Mapping[str, _Value], field: str) -> tuple[_Value, _Value] | None:
    """Return the values of a field in both runs, or of a nested or enclosing field."""
    both = sorted(golden.keys() & run.keys())
    near = [name for name in both if name == field]
    near += [name for name in both if field and field.startswith((f"{name}.", f"{name}["))]
    near += [name for name in both if field and name.startswith(f"{field}.")]
    return (golden[near[0]], run[near[0]]) if near else None


def _message_count(column: Column, stream: Stream) -> int:
    return min(len(column.values) if column.lengths is None else len(column.lengths), len(stream.times_ns))


def _as_vector(values: npt.ArrayLike) -> Array:
    return np.asarray(values, np.float64).reshape(-1)


def _difference(run: Array, golden: Array) -> Array:
    """Subtract golden from run; 0 where both are the same infinity, NaN where only one is finite."""
    with np.errstate(invalid="ignore"):
        off = run - golden
    same = (run == golden) | (np.isnan(run) & np.isnan(golden))
    return np.where(same, 0.0, np.where(np.isfinite(off), off, np.nan))


def _profile(values: Array) -> Series:
    return _line(np.arange(float(len(values))), values)


def _unit(difference: Difference) -> str:
    return f" [{difference.unit}]" if difference.unit and difference.kind != "count" else ""


_LARGEST: Final = 256  # larger pictures are reduced to this size [px]
_BLUE_FIRST: Final = ("bgr", "8UC3")


@dataclass(frozen=True)
class ImageRow:
    """Images of one message, each with a name and a `data:` URL."""

    images: Sequence[tuple[str, str]]
    caption: str


@dataclass(frozen=True)
class ImageFigure:
    """Images of one difference, which `words` describes."""

    words: str
    rows: Sequence[ImageRow]


def image_figure(verdict: Verdict, difference: Difference) -> ImageFigure | None:
    """Show the first images that differ: golden, run, and the amplified difference; None without images.

    Args:
        verdict: Verdict that contains the difference.
        difference: Difference in a topic of images.
    """
    streams = [record.streams.get(difference.topic) for record in (verdict.golden, verdict.run)]
    if streams[0] is None or streams[1] is None or streams[0].pictures is None or streams[1].pictures is None:
        return None
    golden, run = streams[0].pictures, streams[1].pictures
    messages = np.intersect1d(golden.messages, run.messages)
    count = len(messages)
    if count == 0:
        return None
    golden, run = golden.at(messages), run.at(messages)
    # the first stored picture that was sent with or after the first different message
    index = int(np.searchsorted(messages, difference.index)) if difference.index >= 0 else -1
    times = streams[0].times_ns
    rows = []
    for place in _shown_messages(golden, run, count, index):
        message = int(messages[place])
        seconds = f" at {times[message] * 1e-9:.6g} s" if message < len(times) else ""
        rows.append(_image_row(golden, run, place, f"picture {message}{seconds}"))
    return ImageFigure(difference.words, rows)


def _shown_messages(golden: Pictures, run: Pictures, count: int, index: int) -> list[int]:
    """Select the first picture that differs and the picture with the largest difference."""
    if golden.small.shape[1:] != run.small.shape[1:]:
        return [index if 0 <= index < count else 0]
    far = np.array([_mean_difference(_pixel_difference(golden.small[i], run.small[i])) for i in range(count)])
    first = index if 0 <= index < count else int((far > 0.0).argmax())
    worst = int(np.nan_to_num(far).argmax())
    return [first, worst] if far[worst] > 1.5 * far[first] and worst != first else [first]


def _image_row(golden: Pictures, run: Pictures, index: int, caption: str) -> ImageRow:
    ours, theirs = _downsample(golden.small[index]), _downsample(run.small[index])
    low, high = _value_range(ours, theirs)
    shown = [
        ("golden", _display_pixels(ours, golden.encoding, low, high)),
        ("run", _display_pixels(theirs, run.encoding, low, high)),
    ]
    if ours.dtype.kind == "f" or ours.dtype == np.uint16:
        caption += f", from {low:.4g} (dark) to {high:.4g} (bright)"
    if ours.shape == theirs.shape:
        full = high - low if ours.dtype != np.uint8 else 255.0
        factor, amplified = _amplified_difference(_pixel_difference(ours, theirs), full)
        shown.append((f"difference × {factor:.3g}", amplified))
    tiles = _tile_text(golden, run, index)
    return ImageRow([(name, _png(image)) for name, image in shown], caption + tiles)


def _tile_text(golden: Pictures, run: Pictures, index: int) -> str:
    if index >= min(len(golden.tiles), len(run.tiles)) or golden.tiles.shape[1:] != run.tiles.shape[1:]:
        return ""
    differing = golden.tiles[index] != run.tiles[index]
    return (
        f"; {int(differing.sum())} of {counted(differing.size, 'tile')} of the whole picture differ"
        if differing.size
        else ""
    )


def _downsample(image: Array) -> Array:
    step = -(-max(image.shape[:2]) // _LARGEST)
    return image[::step, ::step]


def _value_range(*images: Array) -> tuple[float, float]:
    """Return the lowest and highest of all finite values."""
    values = [image[np.isfinite(image)] if image.dtype.kind == "f" else image.reshape(-1) for image in images]
    values = [v for v in values if v.size]
    low = min((float(v.min()) for v in values), default=0.0)
    high = max((float(v.max()) for v in values), default=1.0)
    return low, high if high > low else low + 1.0


def _pixel_difference(ours: Array, theirs: Array) -> Array:
    """Return the absolute difference; 0 where neither value is finite, NaN where only one is."""
    return np.abs(_difference(np.asarray(theirs, np.float64), np.asarray(ours, np.float64)))


def _mean_difference(difference: Array) -> float:
    """Return the mean of a difference; a pixel that is finite in one image only counts as 255."""
    return float(np.nan_to_num(difference, nan=255.0).mean()) if difference.size else 0.0


def _amplified_difference(difference: Array, full: float) -> tuple[float, Array]:
    """Return an amplification factor and the amplified difference; values that are not finite are white."""
    most = float(difference[np.isfinite(difference)].max(initial=0.0))
    factor = max(1.0, full / most) if most > 0.0 else 1.0
    scaled = np.where(np.isfinite(difference), difference * factor * 255.0 / full, 255.0)
    return factor, _three_channels(np.clip(scaled, 0, 255).astype(np.uint8))


def _display_pixels(image: Array, encoding: str, low: float, high: float) -> Array:
    """Convert an image to three channels, blue first, as OpenCV writes it."""
    if image.dtype != np.uint8:
        finite = np.isfinite(image)
        scaled = np.where(finite, (np.where(finite, image, low).astype(np.float64) - low) / (high - low), 0.0)
        return _three_channels(np.clip(scaled * 255.0, 0, 255).astype(np.uint8))
    if image.ndim == 3 and image.shape[2] >= 3:
        three = image[:, :, :3]
        return three if encoding.lower().startswith(_BLUE_FIRST[0]) or encoding == _BLUE_FIRST[1] else three[:, :, ::-1]
    return _three_channels(image)


def _three_channels(image: Array) -> Array:
    plane = image if image.ndim == 2 else image[:, :, 0]
    return np.repeat(plane[:, :, None], 3, axis=2)


def _png(image: Array) -> str:
    import cv2

    written, data = cv2.imencode(".png", np.ascontiguousarray(image))
    return "data:image/png;base64," + base64.b64encode(data.tobytes()).decode() if written else ""
