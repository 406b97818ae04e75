"""Send goals to the navigator, and measure the results on the true pose of the robot.

The referee sends the goals of its parameter `goals` one after another: "x y yaw, x y yaw, ..." [m, rad]. Half a second
after the end of each goal it publishes:

    /referee/finished        number of goals that have ended
    /referee/succeeded       number of goals that ended with the status SUCCEEDED
    /referee/aborted         number of goals that ended with the status ABORTED
    /referee/distance        largest distance between the robot and a goal that SUCCEEDED [m]
    /referee/angle           largest angle between the robot's yaw and that of a goal that SUCCEEDED [rad]
"""

from __future__ import annotations

import math

from simkit import ModelPlugin

COUNTS = ("finished", "succeeded", "aborted")
ERRORS = ("distance", "angle")
BEGIN, REST = 1.6, 0.5  # [s]


class Referee(ModelPlugin):
    before_step_rate = 10.0  # [Hz]

    def load(self, parent, params):
        texts = [text for text in params.text("goals", "").split(",") if text.strip()]
        self.goals = [tuple(map(float, text.split())) for text in texts]
        self.values = dict.fromkeys(COUNTS, 0) | dict.fromkeys(ERRORS, 0.0)
        self.task, self.ended = None, None
        self.outputs = {name: self.advertise(f"/referee/{name}", "std_msgs/msg/Int32") for name in COUNTS}
        self.outputs |= {name: self.advertise(f"/referee/{name}", "std_msgs/msg/Float64") for name in ERRORS}

    def before_step(self):
        if self.sim.time < BEGIN:
            return
        if self.task is not None:
            if not self.task.is_done:
                return
            if self.ended is None:
                self.ended = self.sim.time
            if self.sim.time < self.ended + REST:
                return
            self.measure()
        for name, output in self.outputs.items():
            output.publish({"data": self.values[name]})
        if self.values["finished"] < len(self.goals):
            self.send(*self.goals[self.values["finished"]])

    def send(self, x, y, yaw):
        turn = {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}
        pose = {"position": {"x": x, "y": y}, "orientation": turn}
        self.task = self.sim.send_goal("/navigate_to_pose", {"pose": {"header": {"frame_id": "map"}, "pose": pose}})

    def measure(self):
        x, y, yaw = self.goals[self.values["finished"]]
        robot = self.sim.model("turtlebot3").pose
        self.values["finished"] += 1
        self.values["succeeded"] += self.task.status.name == "SUCCEEDED"
        self.values["aborted"] += self.task.status.name == "ABORTED"
        if self.task.status.name == "SUCCEEDED":
            distance = math.hypot(robot.position[0] - x, robot.position[1] - y)
            angle = abs(math.remainder(robot.rpy[2] - yaw, math.tau))
            self.values["distance"] = max(self.values["distance"], distance)
            self.values["angle"] = max(self.values["angle"], angle)
        self.task, self.ended = None, None
