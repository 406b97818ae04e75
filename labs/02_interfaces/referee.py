"""Referee of lab 2. It subscribes to the nodes, sends requests and goals, and publishes whether the answers are right.

All topics are of the type std_msgs/msg/String: `right`, or the first answer that is wrong and the true one.
`/referee/num`, `/referee/add_three_ints` and `/referee/countdown` are `right` if the interface has the fields of the
exercise: the referee compares the type hash by which ROS 2 tells types apart. The other topics are about:

    /referee/numbers   messages on /numbers: 1, 2, 3, …
    /referee/total     messages on /total: the sum of all numbers so far
    /referee/sums      messages on /sums: the sum of three numbers each
    /referee/remaining messages on /remaining: 4, 3, 2, 1, 0
    /referee/service   responses of the service to requests of the referee
    /referee/feedback  feedback of the action: each number one less than the one before
    /referee/result    result of the action: all numbers from the start to 0
    /referee/cancel    goals that were cancelled or rejected as they must be
"""

from __future__ import annotations

from simkit import InputError, WorldPlugin, msgs

HASHES = {
    "msg/Num": "RIHS01_189761dd11d10dd794a78f90255162e7155d856fce0c2958642732a6e7203e4c",
    "srv/AddThreeInts": "RIHS01_e731f7cb46225004ac7438e168d0d594b32345480a04ba79887f0d8639650131",
    "action/Countdown": "RIHS01_fbb6cebb1c5fc05702b2b56258f953cf7b48c7f700db33b1fbd4dcde6a239552",
}
FIELDS = {  # parts of each interface: type and name of each field
    "msg/Num": {"": "int64 num"},
    "srv/AddThreeInts": {"_Request": "int64 a, int64 b, int64 c", "_Response": "int64 sum"},
    "action/Countdown": {"_Goal": "int32 start", "_Result": "int32[] numbers", "_Feedback": "int32 remaining"},
}
TOPICS = {"num": "msg/Num", "add_three_ints": "srv/AddThreeInts", "countdown": "action/Countdown"}
ANSWERS = ("numbers", "total", "sums", "remaining", "service", "feedback", "result", "cancel")
LONG = 50  # start of the goal that is cancelled


class Referee(WorldPlugin):
    after_step_rate = 10.0  # [Hz]

    def load(self, parent, params):
        self.wrong = dict.fromkeys(ANSWERS, "")  # first wrong answer of each kind
        self.all = dict.fromkeys(ANSWERS, 0)
        self.sum = self.ticks = 0
        self.goal, self.second, self.fed = None, None, []
        self.drawn = self.random("numbers", 3)
        self.verdicts = {
            name: self.advertise(f"/referee/{name}", "std_msgs/msg/String") for name in (*ANSWERS, *TOPICS)
        }
        for name in ("numbers", "total", "sums", "remaining"):
            self.subscribe(f"/{name}", getattr(self, f"hear_{name}"))

    def compare(self, name, yours, true):
        self.all[name] += 1
        if yours != true and not self.wrong[name]:
            self.wrong[name] = f"answer {self.all[name]}: yours {yours}, true {true}"

    def hear_numbers(self, message):
        num = getattr(message, "num", 0)
        self.compare("numbers", num, self.all["numbers"] + 1)
        self.sum += num

    def hear_total(self, message):
        self.compare("total", getattr(message, "num", None), self.sum)

    def hear_sums(self, message):
        middle = 3 * self.all["sums"] + 2
        self.compare("sums", getattr(message, "num", None), 3 * middle)

    def hear_remaining(self, message):
        self.compare("remaining", getattr(message, "num", None), 4 - self.all["remaining"])

    def after_step(self):
        self.ticks += 1
        if self.ticks > 10:  # the goal of the client has ended
            self.ask_service()
            self.watch_action()
        for name, topic in self.verdicts.items():
            topic.publish({"data": self.verdict(name)})

    def verdict(self, name):
        if name in TOPICS:
            interface = TOPICS[name]
            is_right = msgs.rihs(f"lab_interfaces/{interface}") == HASHES[interface]
            true = " --- ".join(FIELDS[interface].values())
            return "right" if is_right else f"yours {fields(interface)}, true {true}"
        return self.wrong[name] or ("right" if self.all[name] else "there was no answer")

    def ask_service(self):
        a, b, c = (int(1e9 * number) for number in self.drawn.normal(self.ticks))
        try:
            response = self.sim.call("/add_three_ints", {"a": a, "b": b, "c": c})
        except InputError:  # no such service, or other fields
            response = None
        self.compare("service", getattr(response, "sum", None), a + b + c)

    def watch_action(self):
        """Send, one after the other: a goal, a second one at the same time, one to cancel, and one from 0."""
        if self.ticks == 11:
            self.goal, self.fed = self.send(6), []
        elif self.ticks == 13:
            self.second = self.send(3)
        elif self.ticks == 20 and self.goal is not None:
            self.compare("cancel", None if self.second is None else self.second.status.name, "REJECTED")
            self.compare("feedback", self.fed, [5, 4, 3, 2, 1, 0])
            self.compare("result", (self.goal.status.name, self.numbers()), ("SUCCEEDED", [6, 5, 4, 3, 2, 1, 0]))
            self.goal, self.fed = self.send(LONG), []
        elif self.ticks == 25 and self.goal is not None:
            self.goal.cancel()
        elif self.ticks == 27 and self.goal is not None:
            counted = list(range(LONG, LONG - 1 - len(self.fed), -1))
            self.compare("feedback", self.fed if len(self.fed) > 2 else "too few", counted[1:])
            self.compare("cancel", (self.goal.status.name, self.numbers()), ("CANCELED", counted))
            self.goal = self.send(0)
        elif self.ticks == 29 and self.goal is not None:
            self.compare("cancel", self.goal.status.name, "REJECTED")

    def numbers(self):
        return [int(number) for number in getattr(self.goal.result, "numbers", ())]

    def send(self, start):
        try:
            return self.sim.send_goal("/countdown", {"start": start}, self.feed)
        except InputError:  # no such action, or other fields
            return None

    def feed(self, feedback):
        self.fed.append(getattr(feedback, "remaining", None))


def fields(interface):
    """Return the fields of an interface of the student in one line."""
    parts = []
    for part in FIELDS[interface]:
        lines = msgs.definition(f"lab_interfaces/{interface}{part}").split("=" * 80)[0].splitlines()
        texts = [" ".join(line.split("#")[0].split()) for line in lines]
        parts.append(", ".join(text for text in texts if text) or "nothing")
    return " --- ".join(parts)
