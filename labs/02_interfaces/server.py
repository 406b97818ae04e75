"""A node with a service that adds, and an action that counts down: your part. Run it with `python3 server.py`"""

from __future__ import annotations

from simkit import WorldPlugin


class Server(WorldPlugin):
    after_step_rate = 10.0  # [Hz], calls of after_step

    def load(self, parent, params):
        self.goal = None  # the goal that the node executes
        # Exercise: offer the service /add_three_ints and the action /countdown, with the types of lab_interfaces.

    def add(self, request):
        # Exercise: return the response as a dict, {"field": value}. The fields of the request are its attributes.
        return {}

    def begin(self, goal):
        # A new goal: goal.request has the fields of the goal. `goal.reject("reason")` refuses it; else keep it.
        # Exercise: one goal at a time, and none whose start is less than 1.
        pass

    def cancel(self, goal):
        # The client cancels the goal. `goal.canceled({"field": value})` ends it with what is there so far.
        pass

    def after_step(self):
        # Exercise: the next number. `goal.publish_feedback({...})` sends it; `goal.succeed({...})` ends the goal.
        pass


if __name__ == "__main__":
    from terminal import run

    run(Server(), "server")
