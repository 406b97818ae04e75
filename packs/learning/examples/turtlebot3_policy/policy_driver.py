"""Plugin that drives a TurtleBot3 to goals with a trained policy: `simkit run world.sdf --plugin-path .`.

`train_turtlebot3.py` trains the policy. Its weights are NumPy arrays in `policy.npz`, so that playing it needs
no Gymnasium, and gives the same bits in every run.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

import simkit

LOW = np.array([0.0, -1.0, -1.0, *[0.12] * 36, -1.0, -4.0])
HIGH = np.array([6.0, 1.0, 1.0, *[3.5] * 36, 1.0, 4.0])
SPEED, TURN = 0.26, 1.5  # [m/s], [rad/s]
REACHED = 0.25  # [m]


class PolicyDriver(simkit.ModelPlugin):
    """Drives to each of some goals in turn, and stops at the last.

    `<goal>x y</goal>`, repeated: goals in the world [m]. `<policy>`: file beside this one.
    """

    after_step_rate = 5.0

    def load(self, parent: Any, params: Any) -> None:
        self.robot = parent
        self.goals = [goal.vector("goal", 2) for goal in params.each("goal")]
        with np.load(Path(__file__).parent / params.text("policy", "policy.npz")) as file:
            self.layers = [(file[f"weight_{n}"].astype(float), file[f"bias_{n}"].astype(float)) for n in range(3)]
        self.scans = self.sim.subscribe("/scan", keep=1)
        self.velocity = self.advertise("/cmd_vel", "geometry_msgs/msg/Twist")
        self.reached = 0

    def after_step(self) -> None:
        """Send the velocity for the present scan and goal."""
        if self.scans.latest is None:
            return
        forward = turn = 0.0
        if self.reached < len(self.goals):
            goal = self.goals[self.reached]
            if math.dist(self.robot.pose.position[:2], goal) < REACHED:
                self.reached += 1
                self.log.info(f"reached the goal {self.reached} of {len(self.goals)}")
            else:
                forward, turn = self.act(self.observe(goal))
        self.velocity.publish({"linear": {"x": forward}, "angular": {"z": turn}})

    def observe(self, goal: tuple[float, ...]) -> np.ndarray:
        """Return the observation of `simkit/TurtleBot3Goal-v0`, scaled to -1 and 1: goal, scan, velocity."""
        pose, link = self.robot.pose, self.robot.link("base_footprint")
        yaw = float(pose.rpy[2])
        x, y = goal[0] - pose.position[0], goal[1] - pose.position[1]
        bearing = math.atan2(y, x) - yaw
        velocity = link.linear_velocity
        forward = float(velocity[0] * math.cos(yaw) + velocity[1] * math.sin(yaw))
        nearest = np.minimum.reduceat(self.scans.latest.ranges, np.arange(36) * 10)
        values = [math.hypot(x, y), math.cos(bearing), math.sin(bearing), *nearest, forward, link.angular_velocity[2]]
        return 2.0 * (np.clip(values, LOW, HIGH) - LOW) / (HIGH - LOW) - 1.0

    def act(self, values: np.ndarray) -> tuple[float, float]:
        """Return forward speed [m/s] and yaw rate [rad/s]."""
        for weight, bias in self.layers[:-1]:
            values = np.tanh(weight @ values + bias)
        weight, bias = self.layers[-1]
        action = np.clip(weight @ values + bias, -1.0, 1.0)
        return SPEED * float(action[0] + 1.0) / 2.0, TURN * float(action[1])
