"""Referee of the lab: it compares with the true pose of the ball, moves the ball once, and publishes what it measures.

| topic below `/referee` | content |
|---|---|
| `in_sight` | true while the whole ball is in the image |
| `sight_error` | from the place on `/ball` to the true place in the image [pixels], while the ball is in sight |
| `distance_error` | error of the distance on `/ball`, as a share of the true distance |
| `saturation` | largest share of a speed limit in the newest command: at most 1 |
| `error` | the true errors of the features: coordinates in the image, distance [m] |
| `first_decay`, `second_decay` | measured decay rate divided by the gain; of several errors the one farthest from 1 |
| `first_misfit`, `second_misfit` | largest distance of an error from its exponential, as a share of its first value |

`in_sight` is a `std_msgs/msg/Bool`, `error` a `Float64MultiArray`, and the others are `Float64`. The second part begins
when the referee moves the ball and sets the parameter `gain` of the student's node. A decay is known when the errors
have fallen to a sixth.
"""

from __future__ import annotations

import math

import numpy as np

from simkit import ModelPlugin, Pose

SETTLING = 0.4  # [s] after the start or a saturated command: the drives still accelerate
SPAN = 6.0  # a decay is measured until the error has fallen by this factor
LEAST = {"x": 0.08, "y": 0.08, "distance": 0.06}  # errors at the start of a decay that are large enough to measure

FLOATS = "sight_error distance_error saturation first_decay first_misfit second_decay second_misfit"


class Referee(ModelPlugin):
    after_step_rate = 50.0  # [Hz]

    def load(self, parent, params):
        self.camera = params.text("camera", required=True)  # link with x to the right, y down, z along the view
        self.radius = params.number("radius", required=True)  # of the ball [m]
        self.features = params.text("features", required=True).split()  # of x, y and distance
        self.least = np.array([LEAST[feature] for feature in self.features])
        self.distance = params.number("distance", 0.0)  # wanted distance of the ball [m]
        self.limits = np.array(params.text("limits", required=True).split(), float)  # of the speeds in a command
        self.node = params.text("node", required=True)  # of the student's plugin
        self.gains = params.vector("gains", 2)  # of the two parts [1/s]
        self.second_begin = params.number("second_begin", required=True)  # [s]
        self.second_place = params.vector3("second_place", required=True)  # of the ball [m]
        self.part, self.begin, self.saturated_at = "first", 0.0, 0.0
        self.samples = []  # of the part, since the last saturated command: time, errors
        self.measured = set()  # parts whose decay is known
        self.view = None  # half of the width and of the height of the image at a distance of 1 m [m]
        self.subscribe(params.text("camera_info", required=True), self.take_info)
        self.subscribe("/ball", self.take_ball)
        self.subscribe(params.text("command", required=True), self.take_command)
        types = {"in_sight": "Bool", "error": "Float64MultiArray", **dict.fromkeys(FLOATS.split(), "Float64")}
        self.topics = {name: self.advertise(f"/referee/{name}", f"std_msgs/msg/{kind}") for name, kind in types.items()}

    def publish(self, name, value):
        self.topics[name].publish({"data": value})

    def take_info(self, message):
        self.focal = message.k[0]  # [pixels]
        self.view = message.width / 2 / self.focal, message.height / 2 / self.focal

    def true_ball(self):
        """Return the place of the ball in the frame of the camera: to the right, down, ahead [m]."""
        return (self.sim.link(self.camera).pose.inverse() @ self.sim.model("ball").pose).position

    def is_in_sight(self, right, down, ahead):
        half_width, half_height = (ahead * half - self.radius for half in self.view)
        return bool(abs(right) < half_width and abs(down) < half_height)

    def take_ball(self, message):
        stamp = message.header.stamp
        if self.view is None or stamp.sec + stamp.nanosec * 1e-9 < self.begin:
            return  # from an image before the ball was moved
        right, down, ahead = self.true_ball()
        if not self.is_in_sight(right, down, ahead):
            return  # the middle of the visible part is not the middle of the ball
        aside = math.hypot(message.point.x - right / ahead, message.point.y - down / ahead)
        self.publish("sight_error", aside * self.focal)
        self.publish("distance_error", abs(message.point.z / ahead - 1))

    def take_command(self, message):
        speeds = message.command if hasattr(message, "command") else (message.linear.x, message.angular.z)
        share = float(np.max(np.abs(speeds) / self.limits, initial=0.0))
        self.publish("saturation", share)
        if share > 0.999:
            self.saturated_at = self.sim.time

    def after_step(self):
        if self.view is None:
            return
        if self.part == "first" and self.sim.time >= self.second_begin:
            self.part, self.begin = "second", self.sim.time
            self.sim.model("ball").set_pose(Pose(tuple(self.second_place)))
            self.sim.set_parameter(self.node, "gain", float(self.gains[1]))
        right, down, ahead = self.true_ball()
        self.publish("in_sight", self.is_in_sight(right, down, ahead))
        errors = {"x": right / ahead, "y": down / ahead, "distance": ahead - self.distance}
        errors = [errors[feature] for feature in self.features]
        self.publish("error", errors)
        if self.sim.time < max(self.begin, self.saturated_at) + SETTLING:
            self.samples = []
        elif self.part not in self.measured:
            self.samples.append((self.sim.time, errors))
            self.measure(self.gains[0 if self.part == "first" else 1])

    def measure(self, gain):
        """Publish the decay of a part when its errors have fallen: fitted, and compared with the exponential."""
        first, last = (np.array(self.samples[k][1]) for k in (0, -1))
        measured = np.abs(first) > self.least  # smaller errors are those of pixels
        if not measured.any() or np.any(np.abs(last)[measured] * SPAN > np.abs(first)[measured]):
            return
        times = np.array([time for time, _ in self.samples]) - self.samples[0][0]
        rates, misfits = [], []
        for values in np.array([errors for _, errors in self.samples]).T[measured]:
            share = values / values[0]
            count = int(np.argmax(np.abs(share) < 1 / SPAN))
            rates.append(-np.polyfit(times[:count], np.log(np.abs(share[:count])), 1)[0] / gain)
            misfits.append(np.max(np.abs(share - np.exp(-gain * times))[:count]))
        self.publish(f"{self.part}_decay", float(max(rates, key=lambda rate: abs(rate - 1))))
        self.publish(f"{self.part}_misfit", float(max(misfits)))
        self.measured.add(self.part)
