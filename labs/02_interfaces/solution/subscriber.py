"""A node that adds up the numbers that it receives: a solution."""

from __future__ import annotations

from simkit import WorldPlugin


class Subscriber(WorldPlugin):
    def load(self, parent, params):
        self.sum = 0
        self.total = self.advertise("/total", "lab_interfaces/msg/Num")
        self.subscribe("/numbers", self.add)

    def add(self, message):
        self.sum += message.num
        self.total.publish({"num": self.sum})


if __name__ == "__main__":
    from terminal import run

    run(Subscriber(), "subscriber")
