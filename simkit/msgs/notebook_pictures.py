"""Pictures of messages in notebooks: scans, point clouds and paths as SVG, images and grids as PNG."""

from __future__ import annotations

import base64
import html
import importlib
import io
import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

from simkit.errors import SimkitError
from simkit.number_text import counted

_HTML: Final = "_repr_html_"  # method that notebooks call
_MOST_DOTS: Final = 360
_WIDEST: Final = 320  # pixels
_SENSOR: Final = '<circle r="2"/>'


def with_notebook_pictures(classes: Mapping[str, type]) -> None:
    """Set `_repr_html_` of the classes that notebooks show as pictures."""
    for type_name, draw in _PICTURES.items():
        setattr(classes[type_name], _HTML, draw)


def reading_html(sensor: object, title: str, reading: Any) -> str:
    """Return a sensor as a line of text and its newest reading; None for a sensor without one."""
    shown = "no reading" if reading is None else getattr(reading, _HTML, lambda: _caption(reading))()
    return f"{_caption(sensor)} {html.escape(title)}<br>{shown}"


def scan_html(scan: Any) -> str:
    """Return a scan as a line of text and an SVG from above: x of the sensor points up, and its y to the left."""
    step = max(1, math.ceil(len(scan.ranges) / _MOST_DOTS))
    rays = [
        (scan.angle_min + i * scan.angle_increment, float(scan.ranges[i])) for i in range(0, len(scan.ranges), step)
    ]
    hits = [(r * math.cos(angle), r * math.sin(angle)) for angle, r in rays if math.isfinite(r)]
    reach = max((r for _, r in rays if math.isfinite(r)), default=0.0)
    rays_text = counted(len(scan.ranges), "ray")
    farthest = f"farthest hit {reach:.2f} m" if hits else "no hit"
    return f"{_caption(scan)}<br>{_from_above(hits, _SENSOR)} {rays_text}, {farthest}"


def cloud_html(cloud: Any) -> str:
    """Return a point cloud as a line of text and an SVG from above, with at most 360 of its points."""
    import numpy as np

    try:
        found = importlib.import_module("simkit.msgs.point_arrays").points(cloud)
        places = np.stack([found[name].astype("float64") for name in ("x", "y", "z")], axis=1)
    except (SimkitError, ValueError):  # a cloud without places
        return _caption(cloud)
    places = places[np.isfinite(places).all(axis=1)]
    if "optical" in cloud.header.frame_id:  # z points forward, x to the right
        places = np.stack([places[:, 2], -places[:, 0]], axis=1)
    shown = places[:: max(1, math.ceil(len(places) / _MOST_DOTS)), :2].tolist()
    return f"{_caption(cloud)}<br>{_from_above(shown, _SENSOR)} {counted(len(places), 'point')}"


def path_html(path: Any) -> str:
    """Return a path as a line of text and an SVG from above; a circle marks its end."""
    places = [(each.pose.position.x, each.pose.position.y) for each in path.poses]
    if not places:
        return _caption(path)
    step = max(1, math.ceil(len(places) / _MOST_DOTS))
    length = math.fsum(math.dist(*pair) for pair in itertools.pairwise(places))
    shown = [*places[:-1:step], places[-1]]
    return f"{_caption(path)}<br>{_from_above(shown, '', is_line=True)} {counted(len(places), 'pose')}, {length:.2f} m"


def grid_html(grid: Any) -> str:
    """Return an occupancy grid as a line of text and an inline PNG: occupied black, free white, unknown grey."""
    import numpy as np

    info = grid.info
    cells = np.asarray(grid.data)
    if not cells.size or cells.size != info.width * info.height:
        return _caption(grid)
    shades = np.where(cells < 0, 160, 255 - np.clip(cells, 0, 100) * 2.55).astype("uint8")
    pixels = shades.reshape(info.height, info.width)[::-1]  # the first row of the grid is the lowest
    pixels = pixels.repeat(scale := max(1, _WIDEST // 2 // max(pixels.shape)), 0).repeat(scale, 1)
    size = f"{info.width * info.resolution:g} m × {info.height * info.resolution:g} m, cells of {info.resolution:g} m"
    return f"{_with_png(grid, pixels)} {size}"


def image_html(message: Any) -> str:
    """Return an image as a line of text and an inline PNG; depths are grey, near ones dark."""
    import numpy as np

    # by name, as in `simkit.msgs`: the conversion uses the message classes, which have this function
    image = importlib.import_module("simkit.msgs.image_arrays").image
    try:
        pixels = image(message)
        if pixels.dtype != "uint8":
            values = np.nan_to_num(pixels.astype("float64"), nan=0.0, posinf=math.inf)
            finite = values[values < math.inf]
            far = float(finite.max()) if finite.size and finite.max() > 0 else 1.0
            pixels = (values.clip(0.0, far) * (255.0 / far)).astype("uint8")
        return _with_png(message, pixels)
    except (SimkitError, ValueError, TypeError):  # an encoding without an array
        return _caption(message)


def _with_png(message: Any, pixels: Any) -> str:
    """Return a line of text and a picture of at most 320 pixels; the text alone without Pillow."""
    try:
        from PIL import Image
    except ImportError:
        return _caption(message)
    picture = Image.fromarray(pixels)
    picture.thumbnail((_WIDEST, _WIDEST))
    data = io.BytesIO()
    picture.save(data, "PNG")
    text = base64.b64encode(data.getvalue()).decode("ascii")
    return f'{_caption(message)}<br><img src="data:image/png;base64,{text}">'


def _from_above(places: Sequence[Sequence[float]], mark: str, *, is_line: bool = False) -> str:
    """Return places in the plane [m] as an SVG: x points up, and y to the left.

    Args:
        places: x and y of each place [m].
        mark: SVG of a mark at the origin, which the picture then contains.
        is_line: connect the places with a line, and mark the last one.
    """
    shown = [(-y, -x) for x, y in places]
    within = [*shown, (0.0, 0.0)] if mark or not shown else shown
    (left, top), (right, bottom) = ([most(each[axis] for each in within) for axis in (0, 1)] for most in (min, max))
    size = max(right - left, bottom - top) or 1.0
    dots = [(200 * (x - left) / size, 200 * (y - top) / size) for x, y in shown]
    drawn = ("M" + "L".join(f"{x:.0f} {y:.0f}" for x, y in dots)) if is_line else ""
    drawn = drawn or "".join(f"M{x:.0f} {y:.0f}h0" for x, y in dots)
    origin = f'<g transform="translate({-200 * left / size:.0f} {-200 * top / size:.0f})">{mark}</g>' if mark else ""
    end = f'<circle cx="{dots[-1][0]:.0f}" cy="{dots[-1][1]:.0f}" r="4"/>' if is_line else ""
    box, style = f"-5 -5 210 {200 * (bottom - top) / size + 10:.0f}", 'stroke-width="2" stroke-linecap="round"'
    group = f'<g fill="none" stroke="currentColor" {style}>{origin}<path d="{drawn}"/>{end}</g>'
    return f'<svg viewBox="{box}" width="210">{group}</svg>'


def _caption(message: Any) -> str:
    return f"<code>{html.escape(repr(message)[:300])}</code>"


_PICTURES: Final[dict[str, Callable[[Any], str]]] = {
    "sensor_msgs/msg/LaserScan": scan_html,
    "sensor_msgs/msg/Image": image_html,
    "sensor_msgs/msg/PointCloud2": cloud_html,
    "nav_msgs/msg/OccupancyGrid": grid_html,
    "nav_msgs/msg/Path": path_html,
}
