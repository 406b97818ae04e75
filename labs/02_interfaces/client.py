"""A node that uses the service and the action of the server: your part. Run it with `python3 client.py`"""

from __future__ import annotations

from simkit import WorldPlugin


class Client(WorldPlugin):
    after_step_rate = 10.0  # [Hz], calls of after_step

    def load(self, parent, params):
        # Exercise: open the topics /sums and /remaining of the type lab_interfaces/msg/Num, and subscribe to /numbers.
        # The server may start after this node, so requests and goals belong into `after_step`.
        pass

    def after_step(self):
        # Exercise 1: when three new numbers are there, let /add_three_ints add them, and publish the sum on /sums.
        # Exercise 2: send one goal to /countdown, with start 5, and give `self.show` as the function for the feedback.
        pass

    def show(self, feedback):
        # Exercise: publish the remaining number on /remaining.
        pass


if __name__ == "__main__":
    from terminal import run

    run(Client(), "client")
