"""Convert depth images into messages: organised point clouds, and depths as ROS drivers of structured-light
cameras give them.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.sensors.cameras import image_messages
from simkit.sensors.cameras.array_pool import ArrayPool
from simkit.sensors.cameras.camera_model import CameraModel
from simkit.sensors.cameras.rendering.view import Colours, Depths
from simkit.sensors.point_cloud_messages import DATATYPES, point_cloud

CLOUD_TYPE = "sensor_msgs/msg/PointCloud2"
GZ_POINT_STEP, CLASSIC_POINT_STEP = 24, 32
"""Bytes of a point: what gz-sensors writes, and what Gazebo Classic writes (PCL's `PointXYZRGB`)."""
_COLOUR = 4  # place of the packed colour among the numbers of a point: 16 bytes from its beginning


class DepthClouds:
    """Clouds of the depth images of one camera: a point for every pixel, where the pixel's middle looks.

    Args:
        model: the camera.
        is_optical: x to the right, y down, z forward; else x forward, y left, z up.
        step: bytes of a point.
    """

    def __init__(self, model: CameraModel, is_optical: bool, step: int = GZ_POINT_STEP) -> None:
        left, up = model.rays()
        up = up if up.ndim == 2 else up[:, None]
        self._axis = 2 if is_optical else 0
        self._sides = ((0, -left), (1, -up)) if is_optical else ((1, left), (2, up))
        self._size = model.height, model.width
        offsets = (0, 4, 8, 4 * _COLOUR)
        names = ("x", "y", "z", "rgb")
        self._point = np.dtype({"names": names, "formats": ["<f4"] * 4, "offsets": offsets, "itemsize": step})
        # zeros, for the bytes between the fields are never written to
        self._spare_points = ArrayPool((*self._size, step // 4), np.float32, np.zeros)
        self._spare_colours = ArrayPool((*self._size, 4), np.uint8)

    def message(
        self, header: msgs.Header, depths: Depths, colours: Colours, shift: Depths | None = None
    ) -> msgs.PointCloud2:
        """A `PointCloud2`; infinite points keep their place.

        Args:
            header: of the message.
            depths: [m], shape (h, w).
            colours: red, green, blue (h, w, 3), or shades of grey (h, w).
            shift: what of the depths is not along the pixel's ray but added to all three coordinates [m], shape (h, w).
        """
        points = self._spare_points.take()
        is_dense = self._fill(points, depths, shift)
        self._pack(colours, points[..., _COLOUR])
        return point_cloud(header, points.reshape(-1).view(self._point), *self._size, is_dense)

    def points(self, depths: Depths, shift: Depths | None = None) -> npt.NDArray[np.float32]:
        """The coordinates alone [m], shape (h, w, 3)."""
        found = np.empty((*self._size, 3), np.float32)
        self._fill(found, depths, shift)
        return found

    def _fill(self, points: npt.NDArray[np.float32], depths: Depths, shift: Depths | None) -> bool:
        """Writes the coordinates; whether all are finite."""
        points[..., self._axis] = depths
        infinite = np.isinf(depths)
        is_dense = not infinite.any()
        with np.errstate(invalid="ignore"):
            along = depths if shift is None else depths - shift
            for place, slope in self._sides:
                np.multiply(along, slope, out=points[..., place])
                if shift is not None:
                    points[..., place] += shift
        if not is_dense:
            for place, _ in self._sides:
                np.copyto(points[..., place], depths, where=infinite)
        return is_dense

    def _pack(self, colours: Colours, out: npt.NDArray[np.float32]) -> None:
        """Colours as PCL packs them: bytes blue, green, red, 0 seen as a float."""
        import cv2

        bytes_ = self._spare_colours.take()
        cv2.cvtColor(colours, cv2.COLOR_GRAY2BGRA if colours.ndim == 2 else cv2.COLOR_RGB2BGRA, bytes_)
        np.bitwise_and(bytes_.view(np.uint32)[..., 0], np.uint32(0x00FFFFFF), out=out.view(np.uint32))


_MILLIMETRES = 1000.0
_LARGEST_16 = 65535


def depths_with_nan(image: msgs.Image, near: float, far: float) -> msgs.Image:
    """A depth image [m] (`32FC1`) that is NaN where depth is not between `near` and `far`."""
    depths = image_messages.pixels_of(image).copy()
    with np.errstate(invalid="ignore"):
        depths[~((depths > near) & (depths < far))] = np.nan
    return image_messages.image_message(image.header, depths, "32FC1")


def depths_in_millimetres(image: msgs.Image, near: float, far: float) -> msgs.Image:
    """A depth image [m] as `16UC1` in whole millimetres, cut; 0 where depth is not from `near` to `far` [m]."""
    depths = image_messages.pixels_of(image)
    with np.errstate(invalid="ignore"):
        # a millimetre's own rounding must not cost the next one: 1.5 m is 1500
        whole = np.floor(depths.astype(np.float64) * _MILLIMETRES + 1e-3)
        seen = (depths >= near) & (depths <= far) & (whole >= 0) & (whole <= _LARGEST_16)
    return image_messages.image_message(image.header, np.where(seen, whole, 0).astype(np.uint16), "16UC1")


def crop_cloud(cloud: msgs.PointCloud2, near: float, far: float) -> msgs.PointCloud2:
    """An organised cloud in optical axes, NaN where a point's depth is not between `near` and `far` [m]."""
    data = np.array(cloud.data, dtype=np.uint8)
    axes = _cloud_axes(cloud, data)
    with np.errstate(invalid="ignore"):
        outside = ~((axes["z"] > near) & (axes["z"] < far))
    for axis in "xyz":
        axes[axis][outside] = np.nan
    return replace(cloud, data=data, is_dense=not outside.any())


def _cloud_axes(cloud: msgs.PointCloud2, data: npt.NDArray[np.uint8]) -> npt.NDArray[np.void]:
    """x, y and z in the bytes of a cloud, writable."""
    fields = {field.name: field for field in cloud.fields}
    assert all(fields[axis].datatype == DATATYPES["f4"] for axis in "xyz")
    return data.view(
        np.dtype(
            {
                "names": list("xyz"),
                "formats": ["<f4"] * 3,
                "offsets": [fields[axis].offset for axis in "xyz"],
                "itemsize": cloud.point_step,
            }
        )
    )
