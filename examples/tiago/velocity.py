"""TIAGo's base by velocity commands: forward, backward, and a stop when nobody commands: `python velocity.py`."""

from __future__ import annotations

import math
import sys
from typing import NamedTuple

from moves import picture_of, tiago_in

import simkit

RATE = 3.0  # [Hz]
TOPIC = "/mobile_base_controller/cmd_vel_unstamped"


class Stretch(NamedTuple):
    """What became of some seconds of driving.

    Attributes:
        forward, aside: how far it came, along its heading at the start and to the left of it [m].
        turned: [rad].
        speed: forward at the end [m/s].
    """

    forward: float
    aside: float
    turned: float
    speed: float


def drive(sim: simkit.Simulation, linear: float, angular: float, seconds: float, rate: float = RATE) -> Stretch:
    """Publishes one velocity again and again, as `ros2 topic pub --rate 3` does.

    The base stops by itself when no command came for 0.25 s: at 3 Hz it slows a little before each one.

    Args:
        linear, angular: [m/s], [rad/s]; with `rate` 0 nothing is published.
        seconds: how long.
        rate: of the commands [Hz].
    """
    robot = sim.model("tiago")
    before, odometry = robot.pose, sim.subscribe("/mobile_base_controller/odom", keep=1)
    for _ in range(round(seconds * (rate or 1.0))):
        if rate:
            sim.publish(TOPIC, {"linear": {"x": linear}, "angular": {"z": angular}})
        sim.run(1.0 / (rate or 1.0))
    moved = before.inverse() @ robot.pose
    speed = odometry.latest.twist.twist.linear.x if odometry.latest is not None else math.nan
    return Stretch(float(moved.position[0]), float(moved.position[1]), float(moved.rpy[2]), float(speed))


def run(seed: int = 0) -> dict[str, Stretch]:
    """Forward, nothing, backward, nothing, a turn to the left, nothing."""
    with tiago_in("empty", seed=seed) as sim:
        sim.run(1.0)
        parts = {}
        for name, (linear, angular) in {"forward": (0.5, 0.0), "backward": (-0.15, 0.0), "left": (0.0, 0.5)}.items():
            parts[name] = drive(sim, linear, angular, 3.0)
            parts[f"after {name}"] = drive(sim, 0.0, 0.0, 2.0, rate=0.0)
        return parts


def main(arguments: list[str]) -> None:
    picture_of(__doc__ or "", arguments, draws=False)
    for name, part in run().items():
        print(
            f"{name:16s} {part.forward:+.3f} m ahead, {part.aside:+.4f} m aside, {part.turned:+.3f} rad, "
            f"then {part.speed:+.3f} m/s"
        )


if __name__ == "__main__":
    main(sys.argv[1:])
