"""Typical mistakes of the lab `05_mapping`."""

MISTAKES = {
    "adds the rays from the robot and not from its lidar": (
        "95 % of the occupied cells are true to 5 cm",
        "mapping.py",
        "planar(robot @ lidar)",
        "planar(robot)",
    ),
    "takes the ends of rays without an echo for walls": (
        "95 % of the occupied cells are true to 5 cm",
        "mapping.py",
        "self.cells((x + length * cosine)[hit], (y + length * sine)[hit])",
        "self.cells(x + length * cosine, y + length * sine)",
    ),
    "looks for the position and leaves the heading to the odometry": (
        "the heading error is at most a third of that of the odometry",
        "mapping.py",
        "turn * left]",
        "0.0 * left]",
    ),
}
