"""Typical mistakes of the lab `11_control`."""

MISTAKES = {
    "forgets that the rail brakes": (
        "overshoots by 16.3 %",
        "pid.py",
        'self.declare("kd", 12.0',
        'self.declare("kd", 16.0',
    ),
    "integrates beyond the limit": (
        "a step of 1 m, beyond the limit of the motor, overshoots by less than 30 %",
        "pid.py",
        "if force == wanted:",
        "if True:",
    ),
    "sends velocities too seldom": (
        "drives steadily at 0.3 m/s",
        "base.py",
        "before_step_rate = 20.0",
        "before_step_rate = 3.0",
    ),
}
