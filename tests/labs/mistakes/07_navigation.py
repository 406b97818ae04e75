"""Typical mistakes of the lab `07_navigation`."""

MISTAKES = {
    "measures the distance in cells": (
        "writes costs that fall linearly beyond it",
        "navigate.py",
        "grid.resolution * distance_transform_edt(",
        "distance_transform_edt(",
    ),
    "does not look for a wall in the line": (
        "stays in its place when a wall is in the line",
        "navigate.py",
        "return [] if (grid.costs(points) >= INSCRIBED).any() else points",
        "return points",
    ),
    "does not turn at the goal": (
        "stops within 10 cm and 5 degrees of each goal",
        "navigate.py",
        "return 0.0, self.turn(self.path[-1, 2] - pose.yaw)",
        "return 0.0, 0.0",
    ),
}
