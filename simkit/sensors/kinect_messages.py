"""Depths as ROS drivers of structured-light cameras give them: NaN where there is none, or millimetres in 16 bits."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from simkit.sensors import pictures
from simkit.sensors.clouds import DATATYPES

_MILLIMETRES = 1000.0
_LARGEST_16 = 65535


def as_nan(image: Any, near: float, far: float) -> Any:
    """A depth image [m] (`32FC1`) that is NaN where depth is not between `near` and `far`."""
    depths = pictures.pixels_of(image).copy()
    with np.errstate(invalid="ignore"):
        depths[~((depths > near) & (depths < far))] = np.nan
    return pictures.image_message(image.header, depths, "32FC1")


def as_millimetres(image: Any, near: float, far: float) -> Any:
    """A depth image [m] as `16UC1` in whole millimetres, cut; 0 where depth is not from `near` to `far` [m]."""
    depths = pictures.pixels_of(image)
    with np.errstate(invalid="ignore"):
        # a millimetre's own rounding must not cost the next one: 1.5 m is 1500
        whole = np.floor(depths.astype(np.float64) * _MILLIMETRES + 1e-3)
        seen = (depths >= near) & (depths <= far) & (whole >= 0) & (whole <= _LARGEST_16)
    return pictures.image_message(image.header, np.where(seen, whole, 0).astype(np.uint16), "16UC1")


def without(cloud: Any, near: float, far: float) -> Any:
    """An organised cloud in optical axes, NaN where a point's depth is not between `near` and `far` [m]."""
    data = np.array(cloud.data, dtype=np.uint8)
    axes = _axes(cloud, data)
    with np.errstate(invalid="ignore"):
        outside = ~((axes["z"] > near) & (axes["z"] < far))
    for axis in "xyz":
        axes[axis][outside] = np.nan
    return replace(cloud, data=data, is_dense=not outside.any())


def _axes(cloud: Any, data: npt.NDArray[np.uint8]) -> npt.NDArray[Any]:
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
