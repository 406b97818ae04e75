"""Pinhole cameras: pixels of points, and rays of pixels.

Positions are in the optical frame of the camera [m]: x to the right, y down, z forward. Pixels are (u, v).
"""

from __future__ import annotations

import copy
import math
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt

from simkit_nodes.interfaces import ProgramMessage

__all__ = ["PinholeCameraModel", "StereoCameraModel"]

Matrix = npt.NDArray[np.float64]


def _matrix(rows: int, columns: int, values: Any) -> Any:
    """Return a `numpy.matrix`, whose `*` is the matrix product, as programs expect."""
    return np.array(values, np.float64).reshape(rows, columns).view(np.matrix)


def _field(msg: ProgramMessage, name: str) -> Any:
    """Return a field of a `CameraInfo` of ROS 2 (`k`) or of ROS 1 (`K`)."""
    return getattr(msg, name) if hasattr(msg, name) else getattr(msg, name.upper())


class PinholeCameraModel:
    """Model of a camera without lens, after the correction of its distortion."""

    def __init__(self) -> None:
        self.K: Any = None
        self.D: Any = None
        self.R: Any = None
        self.P: Any = None
        self.full_K: Any = None
        self.full_P: Any = None
        self.width: Any = None
        self.height: Any = None
        self.binning_x: Any = None
        self.binning_y: Any = None
        self.raw_roi: Any = None
        self.tf_frame: Any = None
        self.stamp: Any = None
        self.resolution: Any = None

    def fromCameraInfo(self, msg: ProgramMessage) -> None:
        """Set the model from a `sensor_msgs.msg.CameraInfo`."""
        distortion = _field(msg, "d")
        self.D = _matrix(len(distortion), 1, distortion) if len(distortion) else None
        self.R = _matrix(3, 3, _field(msg, "r"))
        self.full_K, self.full_P = _matrix(3, 3, _field(msg, "k")), _matrix(3, 4, _field(msg, "p"))
        self.K, self.P = self.full_K.copy(), self.full_P.copy()
        self.width, self.height = msg.width, msg.height
        self.resolution = (msg.width, msg.height)
        self.binning_x, self.binning_y = max(1, msg.binning_x), max(1, msg.binning_y)
        self.raw_roi = roi = copy.copy(msg.roi)
        if roi.x_offset == roi.y_offset == roi.width == roi.height == 0:  # no region means the full picture
            roi.width, roi.height = self.width, self.height
        self.tf_frame, self.stamp = msg.header.frame_id, msg.header.stamp
        for matrix in (self.K, self.P):
            matrix[0, 0] /= self.binning_x
            matrix[1, 1] /= self.binning_y
            matrix[0, 2] = (matrix[0, 2] - roi.x_offset) / self.binning_x
            matrix[1, 2] = (matrix[1, 2] - roi.y_offset) / self.binning_y

    def rectifyImage(self, raw: Any, rectified: Any) -> None:
        """Write the corrected picture of `raw` into the array `rectified`."""
        size = (self.width, self.height)
        self.mapx, self.mapy = cv2.initUndistortRectifyMap(self.K, self.D, self.R, self.P, size, cv2.CV_32FC1)
        cv2.remap(raw, self.mapx, self.mapy, cv2.INTER_CUBIC, rectified)

    def rectifyPoint(self, uv_raw: Any) -> Any:
        """Return the corrected position of a pixel."""
        source = np.array(uv_raw, np.float64).reshape(1, 1, 2)
        return cv2.undistortPoints(source, np.asarray(self.K), self.D, R=np.asarray(self.R), P=np.asarray(self.P))[0, 0]

    def project3dToPixel(self, point: Any) -> tuple[float, float]:
        """Return the pixel of a point; NaN for a point in the plane of the camera."""
        x, y, z = float(point[0]), float(point[1]), float(point[2])
        u, v, w = (float(r[0] * x + r[1] * y + r[2] * z + r[3]) for r in self.P.tolist())
        return (u / w, v / w) if w != 0 else (math.nan, math.nan)

    def projectPixelTo3dRay(self, uv: Any) -> tuple[float, float, float]:
        """Return the unit vector from the camera through a pixel."""
        x, y = (uv[0] - self.cx()) / self.fx(), (uv[1] - self.cy()) / self.fy()
        length = math.sqrt(x * x + y * y + 1)
        return x / length, y / length, 1.0 / length

    def getDeltaU(self, deltaX: float, Z: float) -> float:
        """Return the pixels across a length along x at a distance."""
        return math.inf if Z == 0 else self.fx() * deltaX / Z

    def getDeltaV(self, deltaY: float, Z: float) -> float:
        """Return the pixels across a length along y at a distance."""
        return math.inf if Z == 0 else self.fy() * deltaY / Z

    def getDeltaX(self, deltaU: float, Z: float) -> float:
        """Return the length along x of pixels at a distance."""
        return Z * deltaU / self.fx()

    def getDeltaY(self, deltaV: float, Z: float) -> float:
        """Return the length along y of pixels at a distance."""
        return Z * deltaV / self.fy()

    def fullResolution(self) -> Any:
        """Return width and height of the full picture [pixels]."""
        return self.resolution

    def intrinsicMatrix(self) -> Any:
        """Return K."""
        return self.K

    def distortionCoeffs(self) -> Any:
        """Return D."""
        return self.D

    def rotationMatrix(self) -> Any:
        """Return R."""
        return self.R

    def projectionMatrix(self) -> Any:
        """Return P."""
        return self.P

    def fullIntrinsicMatrix(self) -> Any:
        """Return K of the full picture."""
        return self.full_K

    def fullProjectionMatrix(self) -> Any:
        """Return P of the full picture."""
        return self.full_P

    def cx(self) -> float:
        """Return the column of the optical axis."""
        return float(self.P[0, 2])

    def cy(self) -> float:
        """Return the row of the optical axis."""
        return float(self.P[1, 2])

    def fx(self) -> float:
        """Return the focal length along x [pixels]."""
        return float(self.P[0, 0])

    def fy(self) -> float:
        """Return the focal length along y [pixels]."""
        return float(self.P[1, 1])

    def Tx(self) -> float:
        """Return the shift of the projection along x."""
        return float(self.P[0, 3])

    def Ty(self) -> float:
        """Return the shift of the projection along y."""
        return float(self.P[1, 3])

    def fovX(self) -> float:
        """Return the horizontal field of view [rad]."""
        return 2 * math.atan(self.width / (2 * self.fx()))

    def fovY(self) -> float:
        """Return the vertical field of view [rad]."""
        return 2 * math.atan(self.height / (2 * self.fy()))

    def tfFrame(self) -> Any:
        """Return the name of the camera's frame."""
        return self.tf_frame


class StereoCameraModel:
    """Model of two cameras side by side."""

    def __init__(self) -> None:
        self.left, self.right = PinholeCameraModel(), PinholeCameraModel()
        self.Q: Any = None

    def fromCameraInfo(self, left_msg: Any, right_msg: Any) -> None:
        """Set the model from two `sensor_msgs.msg.CameraInfo`."""
        self.left.fromCameraInfo(left_msg)
        self.right.fromCameraInfo(right_msg)
        self.Q = np.zeros((4, 4))
        self.Q[0, 0] = self.Q[1, 1] = 1.0
        self.Q[0, 3], self.Q[1, 3] = -self.right.cx(), -self.right.cy()
        self.Q[2, 3] = self.right.fx()
        self.Q[3, 2] = -self.right.fx() / self.right.Tx()

    def tfFrame(self) -> Any:
        """Return the name of the left camera's frame."""
        return self.left.tfFrame()

    def project3dToPixel(self, point: Any) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return the pixels of a point in the left and in the right picture."""
        return self.left.project3dToPixel(point), self.right.project3dToPixel(point)

    def projectPixelTo3d(self, left_uv: Any, disparity: float) -> tuple[float, float, float]:
        """Return the point of a pixel of the left picture and a disparity [pixels]; zeros for a point far away."""
        values = (left_uv[0], left_uv[1], disparity, 1.0)
        x, y, z, w = (math.fsum(row[i] * values[i] for i in range(4)) for row in self.Q.tolist())
        return (x / w, y / w, z / w) if w != 0 else (0.0, 0.0, 0.0)

    def getZ(self, disparity: float) -> float:
        """Return the distance of a disparity [pixels]."""
        return math.inf if disparity == 0 else -self.right.Tx() / disparity

    def getDisparity(self, Z: float) -> float:
        """Return the disparity [pixels] of a distance."""
        return math.inf if Z == 0 else -self.right.Tx() / Z
