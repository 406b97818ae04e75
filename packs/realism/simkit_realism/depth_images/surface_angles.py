"""Angles at which the rays of a depth camera meet the surfaces, from the gradients of a depth image."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from simkit.sensors.cameras.camera_model import CameraModel

Depths = npt.NDArray[np.float32]


class SurfaceAngles:
    """Angles of incidence for one camera.

    The reciprocal depth of a plane is q = a·x + b·y + c, where (x, y, 1) is the direction of the pixel, so the plane's
    normal is along (a, b, c) and its angle to the ray has the cosine q / (|(a, b, c)|·|(x, y, 1)|).

    Args:
        model: optics of the camera.
    """

    def __init__(self, model: CameraModel) -> None:
        left, up = model.rays()
        shape = model.height, model.width
        self._x = np.broadcast_to(np.nan_to_num(left), shape)
        self._y = np.broadcast_to(np.nan_to_num(up if up.ndim == 2 else up[:, None]), shape)
        self._square_length = 1 + self._x * self._x + self._y * self._y
        with np.errstate(divide="ignore"):
            # a lens that folds back has no step between two pixels, and no angle there
            self._across = np.float32(1.0) / np.diff(self._x, axis=1)
            self._down = np.float32(1.0) / np.diff(self._y, axis=0)

    def cosines(self, depths: Depths, rows: slice) -> Depths:
        """Return the cosine of the angle of incidence for some rows of an image; 0 where there is no surface.

        Args:
            depths: depths of the whole image [m], shape (h, w).
            rows: first row, and the row after the last.
        """
        above, below = max(rows.start - 1, 0), min(rows.stop + 1, len(depths))
        x, y = self._x[rows], self._y[rows]
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse = np.float32(1.0) / depths[above:below]
            down = np.diff(inverse, axis=0)
            down *= self._down[above : below - 1]
            # the slopes to the row above and to the row below; the first and the last row have only one of them
            first, last = down[:1] if above == rows.start else down[:0], down[-1:] if below == rows.stop else down[:0]
            b = _smaller(
                np.concatenate((first, down[: rows.stop - rows.start - len(first)])),
                np.concatenate((down[1 - len(first) :], last)),
            )
            inverse = inverse[rows.start - above : rows.stop - above]
            across = np.diff(inverse, axis=1)
            across *= self._across[rows]
            a = _smaller(
                np.concatenate((across[:, :1], across), axis=1), np.concatenate((across, across[:, -1:]), axis=1)
            )
            c = inverse - a * x
            c -= b * y
            a *= a
            b *= b
            c *= c
            a += b
            a += c
            a *= self._square_length[rows]
            np.sqrt(a, out=a)
            inverse /= a
        cosines = inverse
        cosines[~(cosines > 0)] = 0.0  # no surface, or one that is nearer than the range
        limited: Depths = np.minimum(cosines, np.float32(1.0), out=cosines)
        return limited


def _smaller(before: Depths, after: Depths) -> Depths:
    """Return the smaller of two slopes in size, so that an edge on one side of a pixel does not count."""
    np.copyto(after, before, where=np.abs(before) < np.abs(after))
    return after
