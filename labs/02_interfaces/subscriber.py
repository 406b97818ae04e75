"""A node that adds up the numbers that it receives: your part. Run it in a terminal with `python3 subscriber.py`"""

from __future__ import annotations

from simkit import WorldPlugin


class Subscriber(WorldPlugin):
    def load(self, parent, params):
        # Exercise: open the topic /total of the type lab_interfaces/msg/Num, and subscribe to /numbers.
        pass

    def add(self, message):
        # Exercise: publish the sum of all numbers so far. The fields of a message are attributes: message.num
        pass


if __name__ == "__main__":
    from terminal import run

    run(Subscriber(), "subscriber")
