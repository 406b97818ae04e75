"""Bench of lab 14: it runs the functions of `simulator.py` beside simkit's physics and sensor, and compares both.

Each topic below `/bench` is a `std_msgs/msg/String`: `right`, or where your simulator first left simkit's. They are
published at 5.9 s. `pendulum`, `touch`, `height`, `rolling` and `scan` have the tolerances of the table in the README.
"""

from __future__ import annotations

import math

import simulator

from simkit import Pose, WorldPlugin

END = 5.9  # [s]
ORIGIN = (-0.5, 0.4)  # of the lidar [m]
PLANES = [  # floor and wall: normal, offset of the surface along it [m], friction coefficient
    ((0.0, 1.0), 0.0, 0.1),
    ((-1.0, 0.0), -2.0, 0.0),
]
LARGEST = 6.0  # [m]
TOLERANCES = {"pendulum": 0.01, "height": 0.015, "rolling": 0.025, "scan": 0.005}  # [rad], [m], [m], [m]


class Bench(WorldPlugin):
    def load(self, parent, params):
        self.hinge = parent.joint("pendulum::hinge")
        self.true_ball = parent.model("ball")
        speed, height = params.number("speed", required=True), params.number("height", required=True)
        angle = params.number("angle", required=True)
        self.start = speed, height, angle
        self.pendulum = simulator.Pendulum(angle, mass=1.0, length=0.5, inertia=0.004)
        self.ball = simulator.Ball((0.0, height), (speed, 0.0), mass=0.5, radius=0.1, restitution=0.6)
        self.problems = dict.fromkeys(TOLERANCES, "")
        self.touches = {"yours": None, "true": None}  # times of the first touch [s]
        self.scans = 0
        self.is_started = self.is_done = False
        self.topics = {name: self.advertise(f"/bench/{name}", "std_msgs/msg/String") for name in (*TOLERANCES, "touch")}
        self.states = self.advertise("/bench/ball", "geometry_msgs/msg/PointStamped")
        self.subscribe("/scan", self.take_scan)

    def before_step(self):
        if not self.is_started:
            speed, height, angle = self.start
            self.is_started = True
            self.sim.model("pendulum").set_joint_positions({"hinge": angle})
            self.true_ball.set_pose(Pose((0.0, 0.0, height)))
            self.true_ball.set_velocity((speed, 0.0, 0.0))

    def after_step(self):
        dt = self.sim.timestep
        simulator.swing(self.pendulum, dt)
        if self.touches["yours"] is None and simulator.detect(self.ball, PLANES):
            self.touches["yours"] = self.sim.time
        simulator.step(self.ball, PLANES, dt)
        pose = self.true_ball.pose.position
        if self.touches["true"] is None and pose[2] <= 0.1:
            self.touches["true"] = self.sim.time
        self.compare("pendulum", self.pendulum.angle, self.hinge.position, "rad")
        self.compare("height", self.ball.place[1], pose[2], "m")
        self.compare("rolling", self.ball.place[0], pose[0], "m")
        self.states.publish({"point": {"x": float(self.ball.place[0]), "z": float(self.ball.place[1])}})
        if self.sim.time >= END and not self.is_done:
            self.is_done = True
            self.report()

    def compare(self, name, yours, true, unit):
        if not self.problems[name] and not abs(yours - true) <= TOLERANCES[name]:
            self.problems[name] = f"t = {self.sim.time:.3f} s: yours {yours:.3f} {unit}, true {true:.3f} {unit}"

    def take_scan(self, message):
        """Compare each range with that of your function, for the true place of the ball."""
        x, _, z = self.true_ball.pose.position
        ball = simulator.Ball((x, z), (0.0, 0.0), mass=0.5, radius=0.1, restitution=0.6)
        self.scans += 1
        for k, true in enumerate(message.ranges):
            angle = message.angle_min + k * message.angle_increment
            yours = float(simulator.sense(ORIGIN, angle, ball, PLANES, LARGEST))
            is_same = yours == true if math.isinf(yours) or math.isinf(true) else abs(yours - true) <= 0.005
            is_edge = self.is_edge(angle, ball)
            if not is_same and not is_edge and not self.problems["scan"]:
                where = f"t = {self.sim.time:.3f} s, ray at {math.degrees(angle):.1f} degrees"
                self.problems["scan"] = f"{where}: yours {yours:.3f} m, true {true:.3f} m"

    def is_edge(self, angle, ball):
        """Check whether a ray passes within 2 mm of the edge of the ball: rounding decides what it meets."""
        x, z = ball.place[0] - ORIGIN[0], ball.place[1] - ORIGIN[1]
        aside = abs(x * math.sin(angle) - z * math.cos(angle))
        return abs(aside - ball.radius) < 0.002

    def report(self):
        if self.scans < 100:
            self.problems["scan"] = f"only {self.scans} scans came"
        for name, problem in self.problems.items():
            self.topics[name].publish({"data": problem or "right"})
        yours, true = self.touches["yours"], self.touches["true"]
        text = "right"
        if yours is None or true is None or abs(yours - true) > 0.003:
            texts = ["never" if time is None else f"at {time:.3f} s" for time in (yours, true)]
            text = f"yours touches {texts[0]}, true {texts[1]}"
        self.topics["touch"].publish({"data": text})
