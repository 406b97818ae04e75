"""Areas on the ground in which an artefact acts: boxes and polygons in the world or in latitude and longitude."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from simkit.number_text import parse_number

if TYPE_CHECKING:
    from collections.abc import Sequence

    from simkit import Params

CODE: Final = "SK-SENSOR-247"
_FARTHEST = 1e9  # [m]
_SHAPES: Final = {"box": "x_min y_min x_max y_max [m]", "polygon": "x y x y x y … [m]"}
_GEODETIC: Final = {"geodetic_polygon": "latitude longitude latitude longitude latitude longitude … [deg]"}


@dataclass(frozen=True, slots=True)
class Place:
    """Position on the ground.

    Attributes:
        x, y: position in the world [m].
        latitude, longitude: geodetic position [deg].
    """

    x: float
    y: float
    latitude: float
    longitude: float


@dataclass(frozen=True, slots=True)
class Area:
    """Area within a polygon.

    Attributes:
        corners: corners of the polygon: x and y [m], or latitude and longitude [deg].
        is_geodetic: True if the corners are latitudes and longitudes.
    """

    corners: tuple[tuple[float, float], ...]
    is_geodetic: bool = False

    def contains(self, place: Place) -> bool:
        """Check whether a place is in the area: a line from it to one side crosses an odd number of edges."""
        x, y = (place.latitude, place.longitude) if self.is_geodetic else (place.x, place.y)
        is_inside = False
        for (x1, y1), (x2, y2) in zip(self.corners, (*self.corners[1:], self.corners[0]), strict=True):
            if (y1 > y) != (y2 > y) and x < x1 + (y - y1) * (x2 - x1) / (y2 - y1):
                is_inside = not is_inside
        return is_inside


def read_area(params: Params) -> Area | None:
    """Read an `<area>`: one of `box`, `polygon` and `geodetic_polygon`; None after an error."""
    shapes = {**_SHAPES, **_GEODETIC}
    given = [name for name in shapes if params.has(name)]
    if len(given) != 1:
        found = " and ".join(f"<{name}>" for name in given) or "no shape"
        params.error(CODE, f"<area> has {found}; expected one of {', '.join(f'<{name}>' for name in shapes)}")
        return None
    (name,) = given
    element = params.block(name)
    try:
        numbers = [parse_number(word, -_FARTHEST, _FARTHEST, True) for word in element.value.split()]
    except ValueError:
        numbers = []
    if name == "box":
        is_right = len(numbers) == 4 and numbers[0] < numbers[2] and numbers[1] < numbers[3]
    else:
        is_right = len(numbers) >= 6 and len(numbers) % 2 == 0
    if not is_right:
        element.error(CODE, f"found <{name}>{element.value[:60]}</{name}>; expected {shapes[name]}")
        return None
    return Area(_corners_of_box(numbers) if name == "box" else _pairs(numbers), name in _GEODETIC)


def read_areas(params: Params) -> tuple[Area, ...]:
    """Read every `<area>` of an element."""
    areas = [read_area(block) for block in params.all("area")]
    return tuple(area for area in areas if area is not None)


def _corners_of_box(numbers: Sequence[float]) -> tuple[tuple[float, float], ...]:
    x1, y1, x2, y2 = numbers
    return (x1, y1), (x2, y1), (x2, y2), (x1, y2)


def _pairs(numbers: Sequence[float]) -> tuple[tuple[float, float], ...]:
    return tuple(zip(numbers[::2], numbers[1::2], strict=True))
