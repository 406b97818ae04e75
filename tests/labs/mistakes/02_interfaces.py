"""Typical mistakes of the lab `02_interfaces`."""

COUNT = "        self.numbers.append(self.numbers[-1] - 1)\n"
TELL = '        self.goal.publish_feedback({"remaining": self.numbers[-1]})\n'

MISTAKES = {
    "has a sum that is too short": (
        "AddThreeInts.srv has the fields of the exercise",
        "lab_interfaces/srv/AddThreeInts.srv",
        "int64 sum",
        "int32 sum",
    ),
    "sends the feedback before it counts": (
        "the feedback of the action comes in order",
        "server.py",
        COUNT + TELL,
        TELL + COUNT,
    ),
    "asks for numbers twice": (
        "the client publishes the sum of three numbers each",
        "client.py",
        "del self.heard[:3]",
        "del self.heard[:1]",
    ),
}
