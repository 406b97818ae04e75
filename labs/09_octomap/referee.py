"""Referee of lab 9: stretches the arm out to the right, and compares the map with the true shapes. Given.

/referee/table_cells  part of the visible cells of the table's top that /octomap_point_cloud_centers has
/referee/wrong_cells  part of the free cells around the table that it has
/referee/pose_error   distance of the tool from its goal [m], or 1 if it is turned by more than 0.5 degrees
"""

from __future__ import annotations

import math

import numpy as np
from voxel_tools import CAMERA, CELL, GOAL

from simkit import ModelPlugin

# half sizes [m], position [m] and yaw [rad] of the shapes; cylinders and the edges of the book are a little larger here
BOXES = {
    "top": ((0.3, 0.55, 0.02), (0.95, 0, 0.76), 0.0),
    "milk": ((0.0325, 0.0325, 0.1), (0.82, -0.18, 0.88), 0.0),
    "can": ((0.033, 0.033, 0.06), (0.8, 0.2, 0.84), 0.0),
    "bottle": ((0.03, 0.03, 0.12), (0.98, -0.02, 0.9), 0.0),
    "weight": ((0.03, 0.03, 0.04), (0.94, -0.32, 0.82), 0.0),
    "book": ((0.075, 0.105, 0.015), (1.1, 0.2, 0.795), 0.3),
    **{f"leg {x} {y}": ((0.03, 0.03, 0.37), (x, y, 0.37), 0.0) for x in (0.71, 1.19) for y in (-0.49, 0.49)},
}
LOW, HIGH = np.array([0.5, -0.7, 0.3]), np.array([1.4, 0.7, 1.3])  # [m], the region that is compared


def distances(points, box):
    """Return the distance of points (n, 3) from a box [m]; 0 inside."""
    half, centre, yaw = box
    p = points - centre
    c, s = math.cos(yaw), math.sin(yaw)
    p = np.stack([c * p[:, 0] + s * p[:, 1], c * p[:, 1] - s * p[:, 0], p[:, 2]], axis=1)
    return np.linalg.norm(np.maximum(np.abs(p) - half, 0), axis=1)


def indices(points):
    """Return the whole numbers (n, 3) of the cells in which points lie."""
    return np.floor(points / CELL + 1e-6).astype(int)


class Referee(ModelPlugin):
    after_step_rate = 20.0  # [Hz]

    def load(self, parent, params):
        self.robot = parent
        parent.joint("torso_lift_joint").set_position(0.1)
        self.out = {
            name: self.advertise(f"/referee/{name}", "std_msgs/msg/Float64")
            for name in ("table_cells", "wrong_cells", "pose_error")
        }
        self.subscribe("/octomap_point_cloud_centers", self.take_map)

    def after_step(self):
        off = self.tool().inverse() @ GOAL
        turned = 2 * math.acos(min(1.0, abs(off.quaternion[0])))
        error = float(np.linalg.norm(off.position)) if turned < math.radians(0.5) else 1.0
        self.out["pose_error"].publish({"data": error})

    def tool(self):
        return self.robot.link("base_footprint").pose.inverse() @ self.robot.link("arm_tool_link").pose

    def take_map(self, message):
        points = np.frombuffer(message.data, "<f4").reshape(-1, 3).astype(float)
        occupied = set(map(tuple, indices(points)))
        grid = (
            np.stack(np.meshgrid(*(np.arange(a, b, CELL) for a, b in zip(LOW, HIGH))), axis=-1).reshape(-1, 3)
            + CELL / 2
        )
        away = np.min([distances(grid, box) for box in BOXES.values()], axis=0)
        free = set(map(tuple, indices(grid[away > 1.2 * CELL])))
        self.out["wrong_cells"].publish({"data": len(free & occupied) / len(free)})
        top = self.visible_top()
        found = [any((x, y, z + k) in occupied for k in (-1, 0, 1)) for x, y, z in indices(top)]
        self.out["table_cells"].publish({"data": float(np.mean(found))})

    def visible_top(self):
        """Return points of the table's top, one in each cell, to which no other shape hides the view of the camera."""
        x, y = np.arange(0.65 + CELL / 2, 1.25, CELL), np.arange(-0.55 + CELL / 2, 0.55, CELL)
        x, y = np.meshgrid(x, y)
        points = np.stack([x.ravel(), y.ravel(), np.full(x.size, 0.78)], axis=1)
        eye = np.array((self.robot.link("base_footprint").pose.inverse() @ self.robot.link(CAMERA).pose).position)
        hidden = np.zeros(len(points), bool)
        for name, box in BOXES.items():
            if name != "top" and not name.startswith("leg"):
                for s in np.linspace(0, 0.6, 61):  # from the table towards the eye
                    hidden |= distances(points + (eye - points) * s, box) < CELL
        return points[~hidden]
