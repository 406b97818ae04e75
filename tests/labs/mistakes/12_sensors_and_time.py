"""Typical mistakes of the lab `12_sensors_and_time`."""

MISTAKES = {
    "ignores the bias": (
        "knows the heading to 3 degrees",
        "heading.py",
        "            if self.is_standing:\n",
        "            if False:\n",
    ),
    "corrects while the rover turns": (
        "halves the error of the odometry",
        "heading.py",
        "abs(self.speed) < STANDING and abs(turning) < STANDING",
        "True",
    ),
    "exchanges the two sensors": (
        "the tilt errs by less than a third of the accelerometer's error (0.1 rad)",
        "tilt.py",
        "share = TIME_CONSTANT / (TIME_CONSTANT + period)",
        "share = period / (TIME_CONSTANT + period)",
    ),
}
