"""TIAGo chooses one of 24 grasps of a can, shows all as arrows, and lifts the can: `python grasps.py [--web]`.

The grasps come from a sphere round the can, as in PAL's tutorial of pick and place. Red arrows on the topic `/grasps`
are grasps that the arm reaches without a collision, grey ones are out of reach, and the green one is the best: the
joints move least. Needs the packages of the labs (`pin`, `coal`).
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from moves import FINGERS, Vector, move, wait_for

import simkit
from simkit import Pose, msgs

WORLD = Path(__file__).resolve().parent / "grasps.sdf"
OBJECT, GROUP, HAND = "can", "torso_arm", "gripper_grasping_frame"
AZIMUTHS = [math.radians(angle) for angle in range(0, 360, 45)]  # of the direction in which the hand moves
PITCHES = [math.radians(angle) for angle in (10, 50, 90)]  # below the horizontal
REACH = 0.085  # [m] from the origin of the hand's frame to the middle of the can: 15 mm less than to the fingertips
APPROACH, LIFT = 0.10, 0.12  # [m]
OPEN, CLOSED = 0.045, 0.025  # position of each finger [m]; the can is 0.066 m wide
FAILURE = 99999  # error code of MoveIt, for example without the packages of the labs
COLOURS = {"best": (0.1, 0.8, 0.1), "reached": (0.9, 0.1, 0.1), "out of reach": (0.5, 0.5, 0.5)}


@dataclass
class Grasp:
    """Grasp with its poses of the hand.

    Attributes:
        pose: pose of the hand's frame at the can, in the frame of the base.
        before: pose before the way to the can.
        joints: positions of the group's joints in `before`; empty if the arm does not reach both poses.
        cost: largest change of a joint on the way to `before` [rad or m]; infinite if it is out of reach.
    """

    pose: Pose
    before: Pose
    joints: dict[str, float]
    cost: float = math.inf


class Picker:
    """Robot with its planner, in a world with the object."""

    def __init__(self, sim: simkit.Simulation) -> None:
        self.sim, self.robot = sim, sim.model("tiago")
        self.markers = sim.advertise("/grasps", "visualization_msgs/msg/MarkerArray", latched=True)

    def grasps(self) -> list[Grasp]:
        """Return all grasps of the object, the best first."""
        place = (self.robot.link("base_footprint").pose.inverse() @ self.sim.model(OBJECT).pose).position
        found = [self.judged(grasp_towards(place, a, p)) for p in PITCHES for a in AZIMUTHS]
        return sorted(found, key=lambda grasp: grasp.cost)

    def judged(self, grasp: Grasp) -> Grasp:
        """Return a grasp with the joints that it needs."""
        before = self.inverse(grasp.before)
        if before is not None and self.inverse(grasp.pose, before) is not None:
            now = {name: float(self.robot.joint(name).position) for name in before}
            grasp.joints, grasp.cost = before, max(abs(before[name] - now[name]) for name in before)
        return grasp

    def inverse(self, pose: Pose, seed: dict[str, float] | None = None) -> dict[str, float] | None:
        """Return positions of the joints for a pose of the hand without a collision; None if there are none."""
        request: dict[str, Any] = {
            "group_name": GROUP,
            "ik_link_name": HAND,
            "avoid_collisions": True,
            "pose_stamped": {"header": {"frame_id": "base_footprint"}, "pose": msgs.pose_message(pose)},
        }
        if seed is not None:
            request["robot_state"] = {"joint_state": {"name": list(seed), "position": list(seed.values())}}
        answer = self.sim.call("/compute_ik", {"ik_request": request})
        if answer.error_code.val == FAILURE:
            raise SystemExit(answer.error_code.message)
        if answer.error_code.val != 1:
            return None
        state = answer.solution.joint_state
        return dict(zip(state.name, np.asarray(state.position).tolist(), strict=True))

    def show(self, grasps: list[Grasp]) -> None:
        """Publish an arrow for each grasp, from the hand towards the object."""
        rows = []
        for number, grasp in enumerate(grasps):
            kind = "out of reach" if not grasp.joints else "best" if number == 0 else "reached"
            red, green, blue = COLOURS[kind]
            rows.append(
                {
                    "header": {"frame_id": "base_footprint"},
                    "ns": "grasps",
                    "id": number,
                    "pose": msgs.pose_message(grasp.before),
                    "scale": {"x": APPROACH, "y": 0.012, "z": 0.012},
                    "color": {"r": red, "g": green, "b": blue, "a": 1.0},
                }
            )
        self.markers.publish({"markers": rows})

    def pick(self, grasp: Grasp) -> None:
        """Take the object: over it, straight to it, close the fingers, straight up."""
        constraints = [{"joint_name": name, "position": value} for name, value in grasp.joints.items()]
        request = {"group_name": GROUP, "goal_constraints": [{"joint_constraints": constraints}]}
        check(wait_for(self.sim, self.sim.send_goal("/move_action", {"request": request}), 60.0))
        self.straight(grasp.pose)
        move(self.sim, "gripper", dict.fromkeys(FINGERS, CLOSED), 1.5)
        self.straight(Pose(grasp.pose.position + np.array((0.0, 0.0, LIFT)), grasp.pose.quaternion))

    def straight(self, pose: Pose) -> None:
        """Move the hand on a straight line."""
        request = {
            "group_name": GROUP,
            "link_name": HAND,
            "header": {"frame_id": "base_footprint"},
            "waypoints": [msgs.pose_message(pose)],
            "max_step": 0.01,
            "max_velocity_scaling_factor": 0.3,
        }
        line = self.sim.call("/compute_cartesian_path", request)
        if line.fraction < 0.999:
            raise SystemExit(f"only {line.fraction:.0%} of a straight line is possible")
        goal = self.sim.send_goal("/execute_trajectory", {"trajectory": line.solution})
        check(wait_for(self.sim, goal, 30.0))


def grasp_towards(place: Vector, azimuth: float, pitch: float) -> Grasp:
    """Return the grasp of a hand that moves in a direction; its fingers close horizontally."""
    turn = Pose.from_rpy(0, 0, 0, 0.0, pitch, azimuth)  # the x axis points out of the hand, y is horizontal
    ahead = turn.rotate((1.0, 0.0, 0.0))
    pose = Pose(place - REACH * ahead, turn.quaternion)
    return Grasp(pose, Pose(pose.position - APPROACH * ahead, turn.quaternion), {})


def check(goal: Any) -> None:
    if goal.status.name != "SUCCEEDED":
        raise SystemExit(f"a goal ended with {goal.status.name}: {goal.reason}")


def run(*, web: bool = False) -> tuple[list[Grasp], float]:
    """Return the grasps, the best first, and how far the can was lifted [m]."""
    with simkit.load(WORLD) as sim:
        if web:
            print(sim.view())
        picker = Picker(sim)
        sim.run(0.5)
        move(sim, "gripper", dict.fromkeys(FINGERS, OPEN), 1.5)  # the collisions are checked with open fingers
        before = float(sim.model(OBJECT).pose.position[2])
        grasps = picker.grasps()
        picker.show(grasps)
        if not grasps[0].joints:
            raise SystemExit("the arm reaches no grasp")
        picker.pick(grasps[0])
        sim.run(1.0)
        lifted = float(sim.model(OBJECT).pose.position[2]) - before
        while web:
            sim.run(0.1)
            time.sleep(0.1)
        return grasps, lifted


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition(": `")[0])
    parser.add_argument("--web", action="store_true", help="show the world in the browser, until Ctrl-C")
    grasps, lifted = run(web=parser.parse_args(arguments).web)
    reached = [grasp for grasp in grasps if grasp.joints]
    best = grasps[0]
    x, y, z = best.pose.rotate((1.0, 0.0, 0.0))
    print(f"{len(reached)} of {len(grasps)} grasps are reached")
    print(
        f"the best one moves along ({x:+.2f}, {y:+.2f}, {z:+.2f}) and turns no joint by more than {best.cost:.2f} rad"
    )
    print(f"the can was lifted by {lifted:.3f} m")


if __name__ == "__main__":
    main(sys.argv[1:])
