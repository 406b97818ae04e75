"""Referee of lab 11: gives the reference, sets gains during the run, and measures the response to each step.

It measures the true position of the carriage for 3 s after each step N, and then publishes:

| topic | type | meaning |
|---|---|---|
| /reference | Float64 | where the carriage shall be [m]; once for each step |
| /referee/step_N/rise_time | Float64 | first time at the final position, after the step [s] |
| /referee/step_N/overshoot | Float64 | largest way beyond the final position, as a share of the step |
| /referee/step_N/steady_error | Float64 | reference minus final position [m] |
"""

from __future__ import annotations

import numpy as np

from simkit import WorldPlugin

FLOAT = "std_msgs/msg/Float64"
STEPS = [  # time of the step [s], reference [m], gains that are set on line 3 s before the step
    (3.0, 0.2, {}),
    (9.0, 0.4, {"kp": 288.0, "kd": 15.2}),
    (15.0, 0.6, {"ki": 600.0}),
    (21.0, 1.6, {}),
    (27.0, 0.6, {}),  # only ends the measurement of the one before
]
LEAD = 3.0  # [s]; the response to a step is measured for as long
QUANTITIES = ("rise_time", "overshoot", "steady_error")


class Referee(WorldPlugin):
    def load(self, parent, params):
        self.joint = parent.joint("lift::slide")
        self.reference = self.advertise("/reference", FLOAT)
        self.results = [
            {name: self.advertise(f"/referee/step_{k}/{name}", FLOAT) for name in QUANTITIES}
            for k in range(1, len(STEPS))
        ]
        self.next_step, self.next_gains, self.goal = 0, 0, 0.0
        self.positions = []  # [m], one each millisecond since the step

    def before_step(self):
        time = self.sim.time + 1e-9
        if self.next_gains < len(STEPS) and time >= STEPS[self.next_gains][0] - LEAD:
            if self.positions:
                self.publish_results(self.results[self.next_step - 1])
            self.set_gains(STEPS[self.next_gains][2])
            self.next_gains += 1
        if self.next_step < len(STEPS) and time >= STEPS[self.next_step][0]:
            self.goal, self.positions = STEPS[self.next_step][1], []
            self.next_step += 1
            self.reference.publish({"data": self.goal})
        self.positions.append(self.joint.position)

    def set_gains(self, gains):
        """Set live parameters of the student's plugin, as `simkit param set` does."""
        for node, names in self.sim.communication.parameters.items():
            for name, value in gains.items():
                if name in names:
                    self.sim.set_parameter(node, name, value)

    def publish_results(self, topics):
        positions = np.array(self.positions)
        first, final = positions[0], positions[-500:].mean()
        response = (positions - first) / (final - first) if abs(final - first) > 1e-6 else np.zeros(len(positions))
        k = int(np.argmax(response >= 1.0))  # the first sample that is there
        rise = (k - (response[k] - 1.0) / (response[k] - response[k - 1])) * self.sim.timestep if k else np.inf
        found = {"rise_time": rise, "overshoot": response.max() - 1.0, "steady_error": self.goal - final}
        for name, value in found.items():
            topics[name].publish({"data": float(value)})
