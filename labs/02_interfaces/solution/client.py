"""A node that lets a service add the numbers that it receives, and sends the goal of a countdown: a solution."""

from __future__ import annotations

from simkit import WorldPlugin


class Client(WorldPlugin):
    after_step_rate = 10.0  # [Hz], calls of after_step

    def load(self, parent, params):
        self.heard, self.goal = [], None
        self.sums = self.advertise("/sums", "lab_interfaces/msg/Num")
        self.remaining = self.advertise("/remaining", "lab_interfaces/msg/Num")
        self.subscribe("/numbers", self.hear)

    def hear(self, message):
        self.heard.append(message.num)

    def after_step(self):
        if self.goal is None:
            self.goal = self.sim.send_goal("/countdown", {"start": 5}, self.show)
        while len(self.heard) >= 3:
            a, b, c = self.heard[:3]
            del self.heard[:3]
            response = self.sim.call("/add_three_ints", {"a": a, "b": b, "c": c})
            self.sums.publish({"num": response.sum})

    def show(self, feedback):
        self.remaining.publish({"num": feedback.remaining})


if __name__ == "__main__":
    from terminal import run

    run(Client(), "client")
