"""Move the left arm of Baxter until its hand camera sees the ball in the middle: a solution."""

from __future__ import annotations

import numpy as np

from simkit import ModelPlugin

DISTANCE = 0.25  # [m], from the camera to the ball, along the view
CAMERA = "left_hand_camera"  # frame with x to the right, y down, z along the view
JOINTS = {  # joint -> link that it moves; the axis of the joint is the z axis of the link
    "left_s0": "left_upper_shoulder",
    "left_s1": "left_lower_shoulder",
    "left_e0": "left_upper_elbow",
    "left_e1": "left_lower_elbow",
    "left_w0": "left_upper_forearm",
    "left_w1": "left_lower_forearm",
    "left_w2": "left_wrist",
}
VELOCITY_MODE = 2


class Arm(ModelPlugin):
    before_step_rate = 20.0  # [Hz], calls of before_step: Baxter stops 0.2 s after the last command

    def load(self, parent, params):
        self.gain = self.declare("gain", 0.5, minimum=0.0, description="decay rate of the errors [1/s]")
        self.highest_speed = self.declare("highest_speed", 0.15, minimum=0.0, description="of a joint [rad/s]")
        self.enable = self.advertise("/robot/set_super_enable", "std_msgs/msg/Bool")
        self.command = self.advertise("/robot/limb/left/joint_command", "baxter_core_msgs/msg/JointCommand")
        self.ball = None  # newest message on /ball
        self.subscribe("/ball", self.take_ball)
        self.enabled = False

    def take_ball(self, message):
        self.ball = message.point

    def before_step(self):
        if not self.enabled:
            self.enable.publish({"data": True})
            self.enabled = True
        elif self.ball is not None:
            speeds = self.limited(self.speeds(self.ball.x, self.ball.y, self.ball.z))
            self.command.publish({"mode": VELOCITY_MODE, "names": list(JOINTS), "command": speeds})

    def camera_jacobian(self):
        """Return the 6 x 7 matrix from joint speeds to the velocity of the camera in its own frame [m/s, rad/s]."""
        columns = []
        for link in JOINTS.values():
            pose = self.sim.tf.lookup(CAMERA, link)
            axis = pose.transform((0.0, 0.0, 1.0)) - pose.position
            columns.append([*np.cross(pose.position, axis), *axis])
        return np.array(columns).T

    def speeds(self, x, y, distance):
        """Return the speeds of the joints [rad/s] for a ball at the image coordinates x, y and a distance [m]."""
        errors = np.array([x, y, distance - DISTANCE])
        interaction = np.array(
            [
                [-1 / distance, 0, x / distance, x * y, -(1 + x * x), y],
                [0, -1 / distance, y / distance, 1 + y * y, -x * y, -x],
                [0, 0, -1, -y * distance, x * distance, 0],
            ]
        )
        return -self.gain.value * np.linalg.pinv(interaction @ self.camera_jacobian()) @ errors

    def limited(self, speeds):
        """Return the speeds, all reduced by the same factor if one of them exceeds the limit."""
        return speeds / max(1.0, np.max(np.abs(speeds)) / self.highest_speed.value)
