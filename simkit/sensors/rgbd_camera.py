"""Cameras with depth: `rgbd_camera`, `depth_camera` and Classic's `depth`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
import numpy.typing as npt

from simkit.sensors import pictures
from simkit.sensors.base import Product
from simkit.sensors.clouds import point_cloud
from simkit.sensors.rendered import RenderedSensor

if TYPE_CHECKING:
    from simkit.runtime import Simulation

CLOUD = "sensor_msgs/msg/PointCloud2"
_POINT = np.dtype([(name, "<f4") for name in ("x", "y", "z", "rgb")])


class RgbdCamera(RenderedSensor):
    """Colour, depth along the optical axis, and an organised cloud in the camera's frame (x forward), of one pass.

    Depth is +inf where nothing is in range and -inf for what is nearer than the range. Noise is in metres for depths
    and in units of white for colours.
    """

    kinds: ClassVar[tuple[str, ...]] = ("rgbd_camera",)
    has_depth = True

    def attach(self, sim: Simulation) -> None:
        self._columns, self._rows = self.options.model.rays()
        super().attach(sim)

    def products(self) -> dict[str, Product]:
        return {
            "image": self._colour_product(),
            "depth_image": Product(pictures.TYPE, self._depth_message),
            "points": Product(CLOUD, self._cloud),
            "camera_info": self._info_product(),
            "depth_camera_info": self._info_product(),
        }

    def default_topics(self) -> dict[str, str]:
        base = self._default_topic("")
        topics = {product: f"{base}/{product}" for product in ("image", "depth_image", "points")}
        return {**topics, "camera_info": self._info_topic(base + "/image")}

    def _depth_message(self, reading: Any, time_ns: int) -> Any:
        return pictures.image_message(self._header(time_ns), reading.depths, "32FC1")

    def _cloud(self, reading: Any, time_ns: int) -> Any:
        depths: npt.NDArray[np.float32] = reading.depths
        height, width = depths.shape
        points = np.empty((height, width), dtype=_POINT)
        points["x"] = depths
        with np.errstate(invalid="ignore"):
            np.multiply(depths, self._columns, out=points["y"])
            np.multiply(depths, self._rows[:, None], out=points["z"])
        infinite = np.isinf(depths)
        is_dense = not infinite.any()
        if not is_dense:
            for axis in "yz":
                np.copyto(points[axis], depths, where=infinite)
        points["rgb"] = _packed(self._cloud_colours(reading))
        return point_cloud(self._header(time_ns), points.reshape(-1), height, width, is_dense)

    def _cloud_colours(self, reading: Any) -> npt.NDArray[np.uint8]:
        colours: npt.NDArray[np.uint8] = reading.colours
        return colours


class DepthCamera(RgbdCamera):
    """Depth alone, and its cloud in shades of grey: near is bright."""

    kinds = ("depth_camera", "depth")

    def default_topics(self) -> dict[str, str]:
        topic = self._default_topic("depth_image")
        return {"depth_image": topic, "points": topic + "/points", "camera_info": self._info_topic(topic)}

    def _cloud_colours(self, reading: Any) -> npt.NDArray[np.uint8]:
        far = np.float32(self.options.depth_far)
        shades: npt.NDArray[np.float32] = 255.0 - np.clip(reading.depths, 0, far) * np.float32(255.0 / far)
        return shades.astype(np.uint8)


def _packed(colours: npt.NDArray[np.uint8]) -> npt.NDArray[np.float32]:
    """Colours (h, w, 3) or (h, w) as PCL packs them: bytes blue, green, red, 0 seen as a float, shape (h, w)."""
    out = np.zeros((*colours.shape[:2], 4), dtype=np.uint8)
    if colours.ndim == 2:
        out[..., :3] = colours[..., None]
    else:
        out[..., 2], out[..., 1], out[..., 0] = colours[..., 0], colours[..., 1], colours[..., 2]
    packed: npt.NDArray[np.float32] = out.view(np.float32)[..., 0]
    return packed
