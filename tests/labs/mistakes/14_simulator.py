"""Typical mistakes of the lab `14_simulator`."""

MISTAKES = {
    "moves with the velocity of before": (
        "the pendulum swings as simkit's, to 0.01 rad",
        "simulator.py",
        """    pendulum.rate += torque / (pendulum.inertia + pendulum.mass * pendulum.length**2) * dt
    pendulum.angle += pendulum.rate * dt
""",
        """    pendulum.angle += pendulum.rate * dt
    pendulum.rate += torque / (pendulum.inertia + pendulum.mass * pendulum.length**2) * dt
""",
    ),
    "forgets the limit of the friction": (
        "the ball is as far as simkit's, to 2.5 cm",
        "simulator.py",
        "max(-friction * push, min(friction * push, stop))",
        "stop",
    ),
    "sees behind itself": (
        "the ranges are those of simkit's lidar, to 5 mm",
        "simulator.py",
        "        if fall > 0.0:\n",
        "        if fall != 0.0:\n",
    ),
}
