"""Calls /pick and /place, and compares with the truth of the simulation. The lab gives this file.

It needs two models: `tiago` and `block`, with the link `marker`.
"""

from __future__ import annotations

import math

from simkit import WorldPlugin, msgs

START, HOLD, REST = 0.2, 3.2, 0.5  # [s] before /pick, between /pick and /place, after /place
LIFTED, POSITION, ANGLE = 0.1, 0.003, 1.0  # [m], [m], [deg], what must be reached before the run goes on


class Referee(WorldPlugin):
    """Publishes on /referee/...:

    position_error, angle_error: difference between /aruco_single/pose and the marker's pose [m, deg].
    lift: height of the block over its start [m], 20 times a second.
    place_error, tilt: distance of the block from the place [m] and its tilt [deg], at the end.
    picked, placed: true when /pick or /place has ended well.
    done: true at the end. A run ends early if the marker was measured wrongly or nothing was lifted.
    """

    after_step_rate = 20.0  # [Hz]

    def load(self, parent, params):
        self.place = params.vector3("place", required=True)
        numbers = ("position_error", "angle_error", "lift", "place_error", "tilt")
        self.numbers = {name: self.advertise(f"/referee/{name}", "std_msgs/msg/Float64") for name in numbers}
        flags = ("picked", "placed", "done")
        self.flags = {name: self.advertise(f"/referee/{name}", "std_msgs/msg/Bool") for name in flags}
        self.next, self.due, self.is_over = self.call_pick, START, False
        self.height = self.sim.model("block").pose.position[2]
        self.subscribe("/pick_and_place/status", self.take_status)
        self.subscribe("/aruco_single/pose", self.take_marker)

    # ------------------------------------------------------------------ measurements

    def seen_from_base(self, link):
        return self.sim.model("tiago").link("base_footprint").pose.inverse() @ self.sim.model("block").link(link).pose

    def lift(self):
        return float(self.sim.model("block").pose.position[2] - self.height)

    def take_marker(self, message):
        error = self.seen_from_base("marker").inverse() @ msgs.pose(message)
        position = float(math.hypot(*error.position))
        angle = math.degrees(2 * math.acos(min(1.0, abs(error.quaternion[0]))))
        self.numbers["position_error"].publish({"data": position})
        self.numbers["angle_error"].publish({"data": angle})
        if position > POSITION or angle > ANGLE:
            self.stop(f"the pose of the marker is wrong by {1000 * position:.1f} mm and {angle:.1f} degrees")

    def after_step(self):
        self.numbers["lift"].publish({"data": self.lift()})
        if self.next is not None and self.sim.time >= self.due:
            call, self.next = self.next, None
            call()

    # ------------------------------------------------------------------ course of the run

    def take_status(self, message):
        task, _, state = message.data.partition(" ")
        if self.is_over:
            return
        if state == "done" and task == "pick":
            self.flags["picked"].publish({"data": True})
            self.next, self.due = self.call_place, self.sim.time + HOLD
        elif state == "done":
            self.flags["placed"].publish({"data": True})
            self.next, self.due = self.end, self.sim.time + REST
        elif state.startswith("failed"):
            self.stop(message.data)

    def call_pick(self):
        self.call("/pick")

    def call_place(self):
        if self.lift() > LIFTED:
            self.call("/place")
        else:
            self.stop("/pick has ended, but the block is not in the air")

    def call(self, service):
        answer = self.sim.call(service)
        if not answer.success:
            self.stop(f"{service} answers: {answer.message}")

    def stop(self, reason):
        print(f"{self.sim.time:.1f} s: {reason}")
        self.next, self.due, self.is_over = self.end, self.sim.time + REST, True

    def end(self):
        block = self.seen_from_base("block")
        x, y, _ = self.place
        self.numbers["place_error"].publish({"data": float(math.hypot(block.position[0] - x, block.position[1] - y))})
        self.numbers["tilt"].publish({"data": math.degrees(math.acos(min(1.0, block.matrix[2, 2])))})
        self.flags["done"].publish({"data": True})
