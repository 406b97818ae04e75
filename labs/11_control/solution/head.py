"""TIAGo looks at two balls: a solution."""

from __future__ import annotations

import math

from simkit import ModelPlugin

CAMERA = "head_front_camera_rgb_optical_frame"


class Head(ModelPlugin):
    before_step_rate = 10.0  # [Hz]

    def load(self, parent, params):
        self.robot = parent
        self.done = 0  # number of balls at which the head was sent to look

    def before_step(self):
        if self.done == 0 and self.sim.time > 1.0:
            self.point_at(self.place_of("left_ball"))
            self.done = 1
        elif self.done == 1 and self.sim.time > 6.0:
            self.turn_to(*self.angles_to(self.place_of("right_ball")))
            self.done = 2

    def place_of(self, ball):
        """Return x, y, z of a ball in the frame `base_footprint` [m]; the lab gives it."""
        return (self.robot.pose.inverse() @ self.sim.model(ball).pose).position

    def point_at(self, place):
        x, y, z = place
        target = {"header": {"frame_id": "base_footprint"}, "point": {"x": x, "y": y, "z": z}}
        goal = {"target": target, "pointing_frame": CAMERA, "pointing_axis": {"z": 1.0}, "max_velocity": 1.0}
        self.sim.send_goal("/head_controller/point_head_action", goal)

    def angles_to(self, place):
        """Return the angles of head_1_joint and head_2_joint [rad] at which the head looks at a place."""
        head = (self.robot.pose.inverse() @ self.robot.link("head_2_link").pose).position
        x, y, z = place - head
        return math.atan2(y, x), math.atan2(z, math.hypot(x, y))

    def turn_to(self, left, up):
        joints = ["head_1_joint", "head_2_joint"]
        point = {"positions": [left, up], "time_from_start": {"sec": 2}}
        trajectory = {"joint_names": joints, "points": [point]}
        self.sim.send_goal("/head_controller/follow_joint_trajectory", {"trajectory": trajectory})
