"""What the examples here share: TIAGo in a world, and a goal for one of its trajectory controllers."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

import simkit

Vector = npt.NDArray[np.float64]
ARM = tuple(f"arm_{i}_joint" for i in range(1, 8))
FINGERS = ("gripper_left_finger_joint", "gripper_right_finger_joint")


class Point(NamedTuple):
    """One point of a trajectory.

    Attributes:
        seconds: from the trajectory's start [s].
        positions: of each of its joints [rad or m].
        velocities: the same [rad/s or m/s]; without them a cubic between positions has none to follow: it is linear.
    """

    seconds: float
    positions: Sequence[float]
    velocities: Sequence[float] = ()


def picture_of(about: str, arguments: Sequence[str], *, draws: bool = True) -> Path | None:
    """Where a script's picture is to go, as its arguments say; `--help` tells what the script does.

    Args:
        about: its docstring.
        arguments: all but its name.
        draws: whether it can draw one.
    """
    parser = argparse.ArgumentParser(description=about.partition(": `")[0])
    if draws:
        parser.add_argument("picture", nargs="?", type=Path, metavar="OUT.png", help="a picture of it")
    path: Path | None = getattr(parser.parse_args(arguments), "picture", None)
    if path is not None and path.suffix.lower() not in (".png", ".jpg"):
        parser.error(f"{path}: a picture ends in .png or .jpg")
    if path is not None and not path.resolve().parent.is_dir():
        parser.error(f"{path}: there is no folder {path.parent}")
    return path


def tiago_in(world: str = "empty", **options: Any) -> simkit.Simulation:
    """A world with TIAGo at its origin, called `tiago`."""
    sim = simkit.load(world, **options)
    sim.spawn("tiago", name="tiago")
    return sim


def duration(seconds: float) -> dict[str, int]:
    """`builtin_interfaces/Duration`."""
    nanoseconds = round(seconds * 1e9)
    return {"sec": nanoseconds // 10**9, "nanosec": nanoseconds % 10**9}


def trajectory(joints: Sequence[str], points: Sequence[Point]) -> dict[str, Any]:
    """`trajectory_msgs/JointTrajectory`."""
    return {
        "joint_names": list(joints),
        "points": [
            {"positions": list(p.positions), "velocities": list(p.velocities), "time_from_start": duration(p.seconds)}
            for p in points
        ],
    }


def follow(sim: simkit.Simulation, controller: str, joints: Sequence[str], points: Sequence[Point]) -> Any:
    """Sends a trajectory as a goal and runs until it has ended.

    Args:
        controller: `arm`, `torso`, `head` or `gripper`.

    Returns:
        The goal: its `status`, and its `result` with error code and text.
    """
    action = f"/{controller}_controller/follow_joint_trajectory"
    goal = sim.send_goal(action, {"trajectory": trajectory(joints, points)})
    return wait_for(sim, goal, points[-1].seconds + 5.0)


def wait_for(sim: simkit.Simulation, goal: Any, timeout: float) -> Any:
    """Runs until a goal has ended, or a time [s] has passed; gives it back."""
    end = sim.time + timeout
    while not goal.is_done and sim.time < end:
        sim.run(0.02)
    return goal


def move(sim: simkit.Simulation, controller: str, positions: Mapping[str, float], seconds: float) -> Any:
    """Takes the joints named to where they are wanted, within a time [s]; the others stay."""
    return follow(sim, controller, list(positions), [Point(seconds, list(positions.values()))])


def positions_of(sim: simkit.Simulation, joints: Sequence[str]) -> Vector:
    """Where the joints are [rad or m]."""
    robot = sim.model("tiago")
    return np.array([robot.joint(name).position for name in joints])
