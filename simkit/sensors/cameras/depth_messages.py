"""Conversion of depth images into point clouds, and into the depth formats of ROS camera drivers."""

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
"""Size of a point in bytes: in gz-sensors, and in Gazebo Classic (PCL's `PointXYZRGB`)."""
_COLOUR = 4  # index of the packed colour among a point's floats, 16 bytes from its beginning


class DepthClouds:
    """Point clouds of the depth images of one camera, with a point for every pixel along the ray of the pixel's middle.

    Args:
        model: model of the camera.
        is_optical: True for x to the right, y down, z forward; False for x forward, y left, z up.
        step: size of a point in bytes.
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
        # zeros, because the bytes between the fields are never written
        self._spare_points = ArrayPool((*self._size, step // 4), np.float32, np.zeros)
        self._spare_colours = ArrayPool((*self._size, 4), np.uint8)

    def message(
        self, header: msgs.Header, depths: Depths, colours: Colours, shift: Depths | None = None
    ) -> msgs.PointCloud2:
        """Make a `PointCloud2` in which infinite points, and points that are NaN, keep their index.

        Args:
            header: header of the message.
            depths: depths [m], shape (h, w).
            colours: red, green, blue (h, w, 3), or shades of grey (h, w).
            shift: part of the depths that is added to all three coordinates instead of along the ray [m], shape (h, w).
        """
        points = self._spare_points.take()
        is_dense = self._fill(points, depths, shift)
        self._pack(colours, points[..., _COLOUR])
        return point_cloud(header, points.reshape(-1).view(self._point), *self._size, is_dense)

    def points(self, depths: Depths, shift: Depths | None = None) -> npt.NDArray[np.float32]:
        """Return the coordinates only [m], shape (h, w, 3)."""
        cloud = np.empty((*self._size, 3), np.float32)
        self._fill(cloud, depths, shift)
        return cloud

    def _fill(self, points: npt.NDArray[np.float32], depths: Depths, shift: Depths | None) -> bool:
        """Write the coordinates, and return True if all are finite."""
        points[..., self._axis] = depths
        infinite = ~np.isfinite(depths)
        is_dense = not infinite.any()
        with np.errstate(invalid="ignore"):
            along = depths if shift is None else depths - shift
            for axis, slope in self._sides:
                np.multiply(along, slope, out=points[..., axis])
                if shift is not None:
                    points[..., axis] += shift
        if not is_dense:
            for axis, _ in self._sides:
                np.copyto(points[..., axis], depths, where=infinite)
        return is_dense

    def _pack(self, colours: Colours, out: npt.NDArray[np.float32]) -> None:
        """Pack colours as PCL does: the bytes blue, green, red, 0 interpreted as a float."""
        import cv2

        bytes_ = self._spare_colours.take()
        cv2.cvtColor(colours, cv2.COLOR_GRAY2BGRA if colours.ndim == 2 else cv2.COLOR_RGB2BGRA, bytes_)
        np.bitwise_and(bytes_.view(np.uint32)[..., 0], np.uint32(0x00FFFFFF), out=out.view(np.uint32))


_MILLIMETRES = 1000.0
_LARGEST_16 = 65535


def depths_with_nan(image: msgs.Image, near: float, far: float) -> msgs.Image:
    """Return a depth image [m] (`32FC1`) that is NaN where the depth is not between `near` and `far`."""
    depths = image_messages.pixels_of(image).copy()
    with np.errstate(invalid="ignore"):
        depths[~((depths > near) & (depths < far))] = np.nan
    return image_messages.image_message(image.header, depths, "32FC1")


def depths_in_millimetres(image: msgs.Image, near: float, far: float) -> msgs.Image:
    """Return a depth image as `16UC1` in millimetres, truncated; 0 where the depth is not from `near` to `far` [m]."""
    depths = image_messages.pixels_of(image)
    with np.errstate(invalid="ignore"):
        # a rounding error of the float must not change the result by a millimetre: 1.5 m must become 1500
        millimetres = np.floor(depths.astype(np.float64) * _MILLIMETRES + 1e-3)
        seen = (depths >= near) & (depths <= far) & (millimetres >= 0) & (millimetres <= _LARGEST_16)
    return image_messages.image_message(image.header, np.where(seen, millimetres, 0).astype(np.uint16), "16UC1")


def crop_cloud(cloud: msgs.PointCloud2, near: float, far: float) -> msgs.PointCloud2:
    """Return an organised cloud in optical axes that is NaN where the depth is not between `near` and `far` [m]."""
    data = np.array(cloud.data, dtype=np.uint8)
    axes = _cloud_axes(cloud, data)
    with np.errstate(invalid="ignore"):
        outside = ~((axes["z"] > near) & (axes["z"] < far))
    for axis in "xyz":
        axes[axis][outside] = np.nan
    return replace(cloud, data=data, is_dense=not outside.any())


def _cloud_axes(cloud: msgs.PointCloud2, data: npt.NDArray[np.uint8]) -> npt.NDArray[np.void]:
    """Return x, y and z in the bytes of a cloud, as a writable view."""
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
