"""`CameraInfo` messages."""

from __future__ import annotations

from typing import Any

import numpy as np

from simkit import msgs
from simkit.sensors.camera_model import CameraModel

TYPE = "sensor_msgs/msg/CameraInfo"


class CameraInfoMaker:
    """Makes the same message again and again, with a new header.

    Args:
        model: the camera.
        baseline: distance [m] to the left camera of a stereo pair; P's last column becomes -fx·baseline, with P's fx.
    """

    def __init__(self, model: CameraModel, baseline: float = 0.0) -> None:
        model = model.told or model
        self._size = model.height, model.width
        self._distortion_model = model.distortion_model
        self._d = model.coefficients
        self._k = model.matrix
        self._r = np.eye(3).reshape(9)
        self._p = model.projection
        if baseline:
            self._p[3] = -self._p[0] * baseline

    def make(self, time_ns: int, frame_id: str) -> Any:
        """The message of one picture."""
        height, width = self._size
        return msgs.make(
            TYPE,
            header=msgs.header(time_ns, frame_id),
            height=height,
            width=width,
            distortion_model=self._distortion_model,
            d=self._d.copy(),
            k=self._k.copy(),
            r=self._r.copy(),
            p=self._p.copy(),
        )
