"""Which depths a camera tells: Gazebo's rule."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from simkit.params import Params
from simkit.sensors.camera_model import CameraModel
from simkit.sensors.rendering.depths import clip_depths, clip_planes, limit_of, metres
from simkit.sensors.rendering.view import Depths, View

if TYPE_CHECKING:
    from simkit.sensors.camera_options import CameraOptions

_OUTPUTS = ("depths", "points")


def read_depth_range(block: Params, model: CameraModel) -> tuple[float, float]:
    """Nearest and farthest depth [m] of a `<camera>` block: `<depth_camera><clip>`, else the camera's own `<clip>`."""
    depth = block.child("depth_camera")
    if depth is None:
        return model.near, model.far
    output = depth.text("output", "depths")
    if output not in _OUTPUTS:
        message = f"<output>{output}</output> has no effect: there are always depths and points"
        hint = "reflectance and normals of Gazebo Classic are not simulated"
        depth.diagnostics.warning("SK-SENSOR-111", message, depth.block("output").where, hint)
    clip = depth.child("clip")
    if clip is None:
        return model.near, model.far
    near, far = clip.number("near", model.near, minimum=1e-6), clip.number("far", model.far, minimum=1e-6)
    if far > near:
        return near, far
    clip.error("SK-PARAM-002", f"found depths from {near:g} to {far:g} m, allowed is a <far> beyond <near>")
    return model.near, model.far


class DepthRange:
    """The range of depths of one camera.

    What is as far from the camera as `<clip><far>`, in a straight line, has depth +inf; so has what is farther along
    the axis than the depths' own range. What is nearer along the axis than both ranges begin has -inf
    (gz-rendering, depth_camera_fs.glsl; gz-sensors, RgbdCameraSensor.cc).

    Args:
        options: of the camera.
    """

    def __init__(self, options: CameraOptions) -> None:
        model = options.model
        self._lowest = max(model.near, options.depth_near)
        self._ends = model.near, model.far
        left, up = model.rays()
        squares = left * left + (up if up.ndim == 2 else up[:, None]) ** 2
        stretch: Depths = np.sqrt(1 + squares, dtype=np.float32)
        stretch[np.isnan(stretch)] = np.inf  # where a lens shows nothing
        self._limit = limit_of(min(options.depth_far, model.far), model.far, stretch)
        self._least = float(self._limit.min())

    def planes(self) -> tuple[float, float]:
        """Clip planes to be drawn with [m]: what is too near is to be seen as such, not to be cut away."""
        return clip_planes(*self._ends)

    def metres(self, raw: Depths, view: View, out: Depths) -> Depths:
        """Depths [m] of raw ones, shape (h, w).

        Args:
            raw: drawn through `view`, and bent where the camera's lens bends.
            out: contiguous, to be written to.
        """
        return metres(raw, view.near, view.far, self._lowest, self._limit, out, least=self._least)

    def clip(self, depths: Depths) -> Depths:
        """The same rule again in place, for depths [m] that noise was added to."""
        return clip_depths(depths, self._lowest, self._limit, least=self._least)
