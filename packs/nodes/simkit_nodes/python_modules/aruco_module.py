"""Module `cv2.aruco` of a program, with functions of OpenCV 4.6 that later versions have left out.

ROS 2 Humble and Jazzy have OpenCV 4.5 and 4.6, for which most nodes that detect markers are written.
"""

from __future__ import annotations

from collections.abc import Sequence
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from simkit_nodes.python_modules import unbound

if TYPE_CHECKING:
    from simkit_nodes.programs import NodeProgram


def adapt(module: ModuleType, program: NodeProgram) -> None:
    """Add the functions that the installed OpenCV does not have."""
    import cv2

    aruco: Any = cv2.aruco

    def detect_markers(
        image: object,
        dictionary: object,
        corners: Any = None,
        ids: Any = None,
        parameters: object = None,
        *rest: object,
    ) -> Any:
        """Return the corners and the numbers of the markers in an image, and the corners of rejected candidates."""
        detector = aruco.ArucoDetector(dictionary, parameters or aruco.DetectorParameters())
        corners, ids, rejected = detector.detectMarkers(image)
        return corners, None if ids is None else ids.reshape(-1, 1), rejected  # OpenCV 5 returns a row

    def estimate_pose_single_markers(
        corners: Sequence[Any], length: float, camera_matrix: object, distortion: object, *rest: object
    ) -> tuple[Any, Any, Any]:
        """Return the rotation vectors and the positions of markers in the camera's frame, and the corners of a marker.

        Args:
            corners: corners of each marker [px].
            length: side of a marker, in the unit of the positions.
            camera_matrix: matrix of the camera.
            distortion: coefficients of the lens.
            rest: arrays of OpenCV for the results; not used.
        """
        half = length / 2
        points = np.array([[-half, half, 0], [half, half, 0], [half, -half, 0], [-half, -half, 0]], dtype=np.float64)
        poses = [cv2.solvePnP(points, np.asarray(each), camera_matrix, distortion)[1:3] for each in corners]
        vectors = np.array(poses, dtype=np.float64).reshape(-1, 2, 1, 3)
        return vectors[:, 0], vectors[:, 1], points.reshape(4, 1, 3)

    def draw_marker(dictionary: object, number: int, side: int, image: object = None, border: int = 1) -> Any:
        """Return the image of a marker with a side [px]."""
        return aruco.generateImageMarker(dictionary, number, side, image, border)

    functions = {
        "DetectorParameters_create": lambda: aruco.DetectorParameters(),
        "Dictionary_get": lambda number: aruco.getPredefinedDictionary(number),
        "detectMarkers": detect_markers,
        "drawAxis": lambda *args: cv2.drawFrameAxes(*args),
        "drawMarker": draw_marker,
        "estimatePoseSingleMarkers": estimate_pose_single_markers,
    }
    for name, function in functions.items():
        if not hasattr(aruco, name):
            setattr(module, name, unbound(function))
