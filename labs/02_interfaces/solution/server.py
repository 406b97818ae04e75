"""A node with a service that adds, and an action that counts down: a solution."""

from __future__ import annotations

from simkit import WorldPlugin


class Server(WorldPlugin):
    after_step_rate = 10.0  # [Hz], calls of after_step

    def load(self, parent, params):
        self.goal, self.numbers = None, []
        self.offer("/add_three_ints", "lab_interfaces/srv/AddThreeInts", self.add)
        self.act("/countdown", "lab_interfaces/action/Countdown", self.begin, self.cancel)

    def add(self, request):
        return {"sum": request.a + request.b + request.c}

    def begin(self, goal):
        if self.goal is not None:
            goal.reject("one goal at a time")
        elif goal.request.start < 1:
            goal.reject("the start is less than 1")
        else:
            self.goal, self.numbers = goal, [goal.request.start]

    def cancel(self, goal):
        goal.canceled({"numbers": self.numbers})
        self.goal = None

    def after_step(self):
        if self.goal is None:
            return
        self.numbers.append(self.numbers[-1] - 1)
        self.goal.publish_feedback({"remaining": self.numbers[-1]})
        if self.numbers[-1] == 0:
            self.goal.succeed({"numbers": self.numbers})
            self.goal = None


if __name__ == "__main__":
    from terminal import run

    run(Server(), "server")
