"""Places in a depth image that have returns less often: borders, corners, cells of a map, the wedge of a projector."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from simkit import Params
from simkit.sensors.cameras.camera_model import CameraModel

Numbers = npt.NDArray[np.float32]
_MOST_CELLS = 4096


@dataclass(frozen=True, slots=True)
class LossPlaces:
    """Shares of pixels with a return by place in the image.

    Attributes:
        border: width [px] of the border without returns: left, right, top, bottom.
        vignetting: share without a return in the corners; it grows with the fourth power of the distance to the centre.
        rows: share with a return in each cell of a grid over the image, row by row; empty for none.
    """

    border: tuple[float, ...]
    vignetting: float
    rows: tuple[tuple[float, ...], ...]

    def valid(self, model: CameraModel) -> Numbers | None:
        """Return the share of samples in which each pixel has a return, shape (h, w); None if it is 1 everywhere."""
        height, width = model.height, model.width
        left, right, top, bottom = self.border
        if not (any(self.border) or self.vignetting or self.rows):
            return None
        across, down = np.arange(width) + 0.5, np.arange(height) + 0.5
        valid = np.ones((height, width))
        if self.vignetting:
            squares = (2 * across / width - 1) ** 2 + (2 * down[:, None] / height - 1) ** 2
            valid -= self.vignetting * (squares / 2) ** 2
        if self.rows:
            cells = np.array(self.rows)
            row = (down * len(cells) / height).astype(np.intp)
            column = (across * cells.shape[1] / width).astype(np.intp)
            valid *= cells[row[:, None], column]
        valid[:, (across < left) | (across > width - right)] = 0.0
        valid[(down < top) | (down > height - bottom)] = 0.0
        return valid.astype(np.float32)


def read_places(params: Params) -> LossPlaces:
    """Read `<border>`, `<vignetting>` and `<map>`."""
    border = params.vector("border", 4, (0.0, 0.0, 0.0, 0.0))
    vignetting = params.number("vignetting", 0.0, minimum=0.0, maximum=1.0)
    block = params.child("map")
    return LossPlaces(border, vignetting, () if block is None else _read_rows(block))


def _read_rows(block: Params) -> tuple[tuple[float, ...], ...]:
    """Read the rows of a map; report one that is not a row of shares as long as the first."""
    rows: list[tuple[float, ...]] = []
    for element in block.all("row"):
        try:
            row = tuple(float(word) for word in element.value.split())
        except ValueError:
            row = ()
        is_good = all(0.0 <= share <= 1.0 for share in row) and 0 < len(row) <= _MOST_CELLS
        if not is_good or (rows and len(row) != len(rows[0])):
            found = f"found <row>{element.value[:60]}</row>"
            message = f"{found}; expected shares from 0 to 1, as many as in the first <row>"
            element.error("SK-SENSOR-226", message, "write one <row> of shares for each row of cells")
            return ()
        rows.append(row)
    return tuple(rows)


@dataclass(frozen=True, slots=True)
class Wedge:
    """Part of the image that the projector, or the second eye, does not reach at short range.

    The limit of the projector's cone is a plane. In the image it is a line that moves with the reciprocal of the depth:
    across the whole image from depth `start`, where it enters at one corner or side, to `end`.

    Attributes:
        start: depth [m] below which the wedge is in the image; infinite for a wedge that is always there.
        end: depth [m] below which the wedge covers the image.
        direction: direction in the image from the side where the wedge enters [rad]: 0 to the right, π/2 upwards.
    """

    start: float
    end: float
    direction: float

    def positions(self, model: CameraModel) -> Numbers:
        """Return the place of each pixel between the sides, 0 where the wedge enters to 1, shape (h, w)."""
        right, up = math.cos(self.direction), math.sin(self.direction)
        across = np.arange(model.width) + 0.5
        down = np.arange(model.height)[:, None] + 0.5
        places = right * across - up * down
        lowest = min(right * model.width, 0.0) - max(up * model.height, 0.0)
        size = abs(right) * model.width + abs(up) * model.height
        return ((places - lowest) / size).astype(np.float32)

    def hides(self, depths: Numbers, positions: Numbers) -> npt.NDArray[np.bool_]:
        """Return True for the pixels in the wedge."""
        nearest, farthest = 1.0 / self.end, 1.0 / self.start
        with np.errstate(divide="ignore"):
            line = (np.float32(1.0) / depths - np.float32(farthest)) * np.float32(1.0 / (nearest - farthest))
        hidden: npt.NDArray[np.bool_] = positions < line
        return hidden


def read_wedge(params: Params) -> Wedge | None:
    """Read `<wedge>`; return None without it."""
    block = params.child("wedge")
    if block is None:
        return None
    end = block.number("end", required=True, minimum=1e-3, maximum=1e3)
    start = block.number("start", math.inf, minimum=1e-3, finite=False)
    direction = block.number("direction", 0.0, minimum=-7.0, maximum=7.0)
    if start > end:
        return Wedge(start, end, direction)
    found = f"found <start>{start:g}</start> and <end>{end:g}</end>; expected a <start> beyond <end>"
    hint = "<start> is the depth at which the wedge enters the image, <end> the depth at which it covers the image"
    block.error("SK-SENSOR-227", found, hint)
    return None
