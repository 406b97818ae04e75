"""Pictures of messages in notebooks: a scan as SVG, an image as PNG."""

from __future__ import annotations

import base64
import html
import importlib
import io
import math
from collections.abc import Callable, Mapping
from typing import Any, Final

from simkit.errors import SimkitError

_HTML: Final = "_repr_html_"  # method that notebooks call
_MOST_RAYS: Final = 360
_WIDEST: Final = 320  # pixels


def with_notebook_pictures(classes: Mapping[str, type]) -> None:
    """Set `_repr_html_` of the classes that notebooks show as pictures."""
    for type_name, draw in _PICTURES.items():
        setattr(classes[type_name], _HTML, draw)


def scan_html(scan: Any) -> str:
    """Return a scan as a line of text and an SVG from above: x of the sensor points up, and its y to the left."""
    step = max(1, math.ceil(len(scan.ranges) / _MOST_RAYS))
    rays = [(index, float(scan.ranges[index])) for index in range(0, len(scan.ranges), step)]
    hits = [(index, r) for index, r in rays if math.isfinite(r)]
    reach = max((r for _, r in hits), default=1.0) or 1.0
    first, between = math.degrees(scan.angle_min), math.degrees(scan.angle_increment)
    dots = "".join(
        f'<path d="M{100 * r / reach:.1f} 0h1" transform="rotate({-first - index * between:.1f})"/>'
        for index, r in hits
    )
    return (
        f'{_caption(scan)}<br><svg viewBox="-105 -105 210 210" width="210"><g transform="rotate(-90)" '
        f'fill="none" stroke="currentColor" stroke-width="2"><circle r="2"/>{dots}</g></svg> '
        f"{len(scan.ranges)} rays, farthest hit {reach:.2f} m"
    )


def image_html(message: Any) -> str:
    """Return an image as a line of text and an inline PNG; depths are grey, near ones dark."""
    import numpy as np

    # by name, as in `simkit.msgs`: the conversion uses the message classes, which have this function
    image = importlib.import_module("simkit.msgs.image_arrays").image
    try:
        from PIL import Image

        pixels = image(message)
        if pixels.dtype != "uint8":
            values = np.nan_to_num(pixels.astype("float64"), nan=0.0, posinf=math.inf)
            finite = values[values < math.inf]
            far = float(finite.max()) if finite.size and finite.max() > 0 else 1.0
            pixels = (values.clip(0.0, far) * (255.0 / far)).astype("uint8")
        picture = Image.fromarray(pixels)
    except (ImportError, SimkitError, ValueError, TypeError):  # an encoding without an array
        return _caption(message)
    picture.thumbnail((_WIDEST, _WIDEST))
    data = io.BytesIO()
    picture.save(data, "PNG")
    text = base64.b64encode(data.getvalue()).decode("ascii")
    return f'{_caption(message)}<br><img src="data:image/png;base64,{text}">'


def _caption(message: Any) -> str:
    return f"<code>{html.escape(repr(message)[:300])}</code>"


_PICTURES: Final[dict[str, Callable[[Any], str]]] = {
    "sensor_msgs/msg/LaserScan": scan_html,
    "sensor_msgs/msg/Image": image_html,
}
