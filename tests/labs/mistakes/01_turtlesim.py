"""Typical mistakes of the lab `01_turtlesim`."""

BY_TIME = """\
phase, side = self.sim.time % 4.0, int(self.sim.time // 4.0)
        drives, turns = phase < 2.0 and side < 4, phase >= 2.0 and side < 4
        forward, turning = (1.0 if drives else 0.0), (3.1416 / 4 if turns else 0.0)"""

MISTAKES = {
    "drives by time": (
        "closes the square to 1 cm",
        "square.py",
        "forward, turning = self.speeds() if self.pose is not None else (0.0, 0.0)",
        BY_TIME,
    ),
    "drives while it turns": (
        "takes no detours",
        "square.py",
        "min(SPEED_GAIN * distance, 1.0) if abs(error) < 0.02 else 0.0",
        "min(SPEED_GAIN * distance, 2.0)",
    ),
    "publishes nothing at the end": (
        "has stopped",
        "square.py",
        "        self.command.publish",
        "        self.next < len(CORNERS) and self.command.publish",
    ),
}
