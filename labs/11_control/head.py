"""TIAGo looks at two balls: your plugin. Run it with `simkit lab grade .`"""

from __future__ import annotations

from simkit import ModelPlugin

CAMERA = "head_front_camera_rgb_optical_frame"


class Head(ModelPlugin):
    before_step_rate = 10.0  # [Hz], calls of before_step

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
        # Exercise: a goal for the action /head_controller/point_head_action: `self.sim.send_goal(action, goal)`.
        # Its fields: target (header with frame_id, point), pointing_frame, pointing_axis, max_velocity.
        pass

    def angles_to(self, place):
        """Return the angles of head_1_joint and head_2_joint [rad] at which the head looks at a place."""
        # Exercise. `self.robot.link("head_2_link").pose` is the pose of the head in the world.
        return 0.0, 0.0

    def turn_to(self, left, up):
        joints = ["head_1_joint", "head_2_joint"]
        point = {"positions": [left, up], "time_from_start": {"sec": 2}}
        trajectory = {"joint_names": joints, "points": [point]}
        self.sim.send_goal("/head_controller/follow_joint_trajectory", {"trajectory": trajectory})
