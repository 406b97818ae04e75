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

    def cosines(self, depths: Depths) -> Depths:
        """Return the cosine of each pixel's angle of incidence, shape (h, w); 0 where there is no surface."""
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse = np.float32(1.0) / depths
            a = _smaller_step(np.diff(inverse, axis=1) * self._across)
            b = _smaller_step((np.diff(inverse, axis=0) * self._down).T).T
            c = inverse - a * self._x - b * self._y
            cosines = inverse / np.sqrt((a * a + b * b + c * c) * self._square_length)
        cosines[~(cosines > 0)] = 0.0  # no surface, or one that is nearer than the range
        limited: Depths = np.minimum(cosines, np.float32(1.0))
        return limited


def _smaller_step(steps: Depths) -> Depths:
    """Return the slope of each pixel: that to the left or the right, whichever is smaller, so that edges do not count.

    Args:
        steps: slopes between neighbours, shape (rows, columns - 1).
    """
    first, last = steps[:, :1], steps[:, -1:]
    before, after = np.concatenate((first, steps), axis=1), np.concatenate((steps, last), axis=1)
    is_nearer = np.abs(before) < np.abs(after)
    return np.where(is_nearer, before, after)
