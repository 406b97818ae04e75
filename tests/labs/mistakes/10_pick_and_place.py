"""Typical mistakes of the lab `10_pick_and_place`."""

FILE = "pick_and_place.py"

MISTAKES = {
    "uses the camera's body frame": (
        "measures the marker to 3 mm",
        FILE,
        '"head_front_camera_rgb_optical_frame"',
        '"head_front_camera_rgb_frame"',
    ),
    "does not refine the corners": (
        "measures the marker to 3 mm",
        FILE,
        "CORNER_REFINE_APRILTAG",
        "CORNER_REFINE_NONE",
    ),
    "grasps the wide side": (
        "lifts the block 0.1 m and holds it for 3 s",
        FILE,
        "across, down = marker.matrix[:, 0],",
        "across, down = marker.matrix[:, 1],",
    ),
}
