"""A solution: forward while the way ahead is free, else a turn to where there is more room."""

from __future__ import annotations

import math

import numpy as np

from simkit import Model, ModelPlugin, Params

AHEAD = math.radians(35.0)
CLEAR = 0.55  # [m] ahead that is enough to drive on


class Wander(ModelPlugin):
    """`speed` [m/s] forward."""

    before_step_rate = 10.0

    def load(self, parent: Model, params: Params) -> None:
        self.speed = params.number("speed", 0.18, minimum=0.0)
        self.scan = self.subscribe("/scan", keep=1)
        self.command = self.advertise("/cmd_vel", "geometry_msgs/msg/Twist")
        self.turn = 0.0

    def before_step(self) -> None:
        scan = self.scan.latest
        if scan is None:
            return self.command.publish({})
        ranges = np.where(np.isfinite(scan.ranges), scan.ranges, scan.range_max)
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        angles = (angles + math.pi) % (2.0 * math.pi) - math.pi
        if ranges[abs(angles) < AHEAD].min() > CLEAR:
            self.turn = 0.0
            return self.command.publish({"linear": {"x": self.speed}})
        if not self.turn:  # once begun, a turn goes on the same way
            left = ranges[(angles > 0.0) & (angles < 1.6)].mean()
            right = ranges[(angles < 0.0) & (angles > -1.6)].mean()
            self.turn = 0.9 if left > right else -0.9
        return self.command.publish({"angular": {"z": self.turn}})
