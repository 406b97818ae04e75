"""A node that publishes the numbers 1, 2, 3, …: your part. Run it in a terminal with `python3 publisher.py`"""

from __future__ import annotations

from simkit import WorldPlugin


class Publisher(WorldPlugin):
    after_step_rate = 10.0  # [Hz], calls of after_step

    def load(self, parent, params):
        # Exercise: open the topic /numbers of your type lab_interfaces/msg/Num.
        pass

    def after_step(self):
        # Exercise: publish the next number.
        pass


if __name__ == "__main__":
    from terminal import run

    run(Publisher(), "publisher")
