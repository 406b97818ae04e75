"""Rate, latency and jitter of two sensors: your plugin. Run it with `simkit lab grade .`."""

from __future__ import annotations

from functools import partial

import numpy as np

from simkit import WorldPlugin

SENSORS = ("late", "irregular")


class Timing(WorldPlugin):
    after_step_rate = 1.0  # [Hz], calls of after_step

    def load(self, parent, params):
        self.stamps = {sensor: [] for sensor in SENSORS}  # times of the measurements [s]
        self.arrivals = {sensor: [] for sensor in SENSORS}  # times at which the messages came [s]
        self.results = {}
        for sensor in SENSORS:
            self.subscribe(f"/{sensor}", partial(self.take, sensor))
            for name in ("rate", "latency", "jitter"):
                topic = f"/timing/{sensor}/{name}"
                self.results[sensor, name] = self.advertise(topic, "std_msgs/msg/Float64")

    def take(self, sensor, message):
        stamp = message.header.stamp
        self.stamps[sensor].append(stamp.sec + stamp.nanosec * 1e-9)
        self.arrivals[sensor].append(self.sim.time)

    def after_step(self):
        for sensor in SENSORS:
            found = measure(np.array(self.stamps[sensor]), np.array(self.arrivals[sensor]))
            for name, value in zip(("rate", "latency", "jitter"), found, strict=True):
                self.results[sensor, name].publish({"data": float(value)})


def measure(stamps, arrivals):
    """Return rate [Hz], mean latency [s], and the largest deviation of an interval from the mean interval [s]."""
    # Exercise. `stamps` are the times of the measurements, `arrivals` those at which the messages came [s].
    return 0.0, 0.0, 0.0
