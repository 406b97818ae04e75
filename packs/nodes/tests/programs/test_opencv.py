"""Programs written for the OpenCV of ROS 2 Humble and Jazzy detect markers."""

from __future__ import annotations

from collections.abc import Callable

Run = Callable[..., list[str]]


def test_a_marker_is_drawn_found_and_located_by_the_functions_of_opencv_4_6(run_program: Run) -> None:
    log = run_program(
        """
        import cv2
        import numpy as np
        from cv2 import aruco

        dictionary = aruco.Dictionary_get(aruco.DICT_4X4_50)
        image = np.full((400, 400), 255, np.uint8)
        image[100:300, 100:300] = aruco.drawMarker(dictionary, 7, 200)
        settings = aruco.DetectorParameters_create()
        corners, ids, rejected = cv2.aruco.detectMarkers(image, dictionary, parameters=settings)
        camera = np.array([[400.0, 0.0, 200.0], [0.0, 400.0, 200.0], [0.0, 0.0, 1.0]])
        rotations, positions, points = aruco.estimatePoseSingleMarkers(corners, 0.1, camera, np.zeros(5))
        picture = cv2.cvtColor(image, cv2.COLOR_GRAY2BGR)
        aruco.drawAxis(picture, camera, np.zeros(5), rotations[0], positions[0], 0.05)
        print(ids.tolist(), corners[0].tolist(), rotations.shape, points.shape, round(positions[0, 0, 2], 2))
        """
    )
    assert log == ["[[7]] [[[100.0, 100.0], [299.0, 100.0], [299.0, 299.0], [100.0, 299.0]]] (1, 1, 3) (4, 1, 3) 0.2"]


def test_a_part_of_opencv_that_is_not_installed_is_reported_with_the_package_that_has_it(run_program: Run) -> None:
    log = run_program(
        """
        import cv2

        try:
            cv2.CascadeClassifier
        except AttributeError as error:
            print("opencv-contrib-python-headless" in str(error))
        else:
            print(True)
        try:
            cv2.no_such_name
        except AttributeError as error:
            print(error)
        """
    )
    assert log == ["True", "module 'cv2' has no attribute 'no_such_name'"]


def test_a_camera_of_the_machine_stays_closed_because_a_run_does_not_depend_on_it(run_program: Run) -> None:
    """OpenCV itself ends the process with a segmentation fault for the index -1 on a machine without cameras."""
    log = run_program(
        """
        import cv2

        for index in (0, -1, "/dev/video0"):
            camera = cv2.VideoCapture(index)
            print(camera.isOpened(), camera.read())
        """
    )
    assert log == ["False (False, None)"] * 3
