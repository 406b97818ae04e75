"""A node that publishes the numbers 1, 2, 3, …: a solution."""

from __future__ import annotations

from simkit import WorldPlugin


class Publisher(WorldPlugin):
    after_step_rate = 10.0  # [Hz], calls of after_step

    def load(self, parent, params):
        self.num = 0
        self.numbers = self.advertise("/numbers", "lab_interfaces/msg/Num")

    def after_step(self):
        self.num += 1
        self.numbers.publish({"num": self.num})


if __name__ == "__main__":
    from terminal import run

    run(Publisher(), "publisher")
