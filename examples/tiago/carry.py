"""TIAGo takes a bottle of 0.5 kg, lifts it 0.3 m, carries it 1 m to another table: `python carry.py [OUT.png]`.

The hand points down; the torso's lift does the going down and the lifting up, straight. Half a minute of it is holding
on: nothing but friction between two fingers and a bottle.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from moves import ARM, FINGERS, Point, Vector, follow, move, picture_of

import simkit

WORLD = Path(__file__).resolve().parent / "carry.sdf"
OVER_THE_TABLE = (1.01, 0.80, -0.41, 1.05, -1.83, 1.30, 0.0)  # the arm: hand ahead and to the right, pointing down
UP, DOWN = 0.33, 0.02  # the torso [m]
OPEN, CLOSED = 0.04, 0.015  # each finger [m]; the bottle is 0.025 in radius
DRIVE = "/mobile_base_controller/cmd_vel_unstamped"


class Carried(NamedTuple):
    """Where the bottle was at the end of each part.

    Attributes:
        places: in the world [m], by part: `on the first table`, `lifted`, `held`, `carried`, `put down`, `let go`.
        slips: how far it has moved in the hand since it was lifted [m], by part.
        tilt: of its axis at the end [rad].
        fingers: the largest difference between the two fingers while it was held [m].
    """

    places: dict[str, Vector]
    slips: dict[str, float]
    tilt: float
    fingers: float


class Carrier:
    """Takes the bottle through the parts; notes where it is."""

    def __init__(self, sim: simkit.Simulation) -> None:
        self.sim, self.robot, self.bottle = sim, sim.model("tiago"), sim.model("bottle")
        self.hand = self.robot.link("gripper_grasping_frame")
        self.places: dict[str, Vector] = {}
        self.in_hand: dict[str, Vector] = {}
        self.fingers = 0.0

    def note(self, part: str) -> None:
        """Where the bottle is in the world, and seen from the hand [m]."""
        self.places[part] = np.array(self.bottle.pose.position)
        self.in_hand[part] = np.array((self.hand.pose.inverse() @ self.bottle.pose).position)

    def torso(self, height: float) -> None:
        now = float(self.robot.joint("torso_lift_joint").position)
        move(self.sim, "torso", {"torso_lift_joint": height}, max(1.0, abs(height - now) / 0.05))

    def gripper(self, opening: float) -> None:
        move(self.sim, "gripper", dict.fromkeys(FINGERS, opening), 1.5)

    def hold(self, seconds: float) -> None:
        for _ in range(round(seconds * 10)):
            self.sim.run(0.1)
            left, right = (float(self.robot.joint(name).position) for name in FINGERS)
            self.fingers = max(self.fingers, abs(left - right))

    def drive(self, distance: float, speed: float) -> None:
        """Forward, or backward where the distance is negative [m], at a speed [m/s]."""
        start = self.robot.pose
        while True:
            left = abs(distance) - abs(float((start.inverse() @ self.robot.pose).position[0]))
            if left < 0.002:
                break
            self.command(math.copysign(min(speed, max(0.02, left)), distance), 0.0)
        self.stop()

    def turn_to(self, heading: float, speed: float) -> None:
        """To a heading in the world [rad], at most so fast [rad/s]."""
        while abs(left := math.remainder(heading - self.robot.pose.rpy[2], math.tau)) > 0.003:
            self.command(0.0, math.copysign(min(speed, max(0.03, abs(left))), left))
        self.stop()

    def command(self, linear: float, angular: float) -> None:
        """One command, and the tenth of a second that it is for."""
        self.sim.publish(DRIVE, {"linear": {"x": linear}, "angular": {"z": angular}})
        self.sim.run(0.1)

    def stop(self) -> None:
        self.command(0.0, 0.0)
        self.sim.run(1.0)


def run(seed: int = 0, hold: float = 5.0, watch: Any = None) -> Carried:
    """Everything, from the first table to the second.

    Args:
        seed: of every random stream.
        hold: how long it is held in the air before it is carried [s].
        watch: called with the simulation after each part.
    """
    with simkit.load(WORLD, seed=seed) as sim:
        sim.spawn("tiago", name="tiago")
        carrier = Carrier(sim)

        def done(part: str) -> None:
            carrier.note(part)
            if watch is not None:
                watch(sim)

        carrier.torso(UP)
        carrier.gripper(OPEN)
        follow(sim, "arm", ARM, [Point(4.0, OVER_THE_TABLE)])
        carrier.torso(DOWN)
        done("on the first table")
        carrier.gripper(CLOSED)
        carrier.torso(UP)
        done("lifted")
        carrier.hold(hold)
        done("held")
        carrier.drive(-1.0, 0.15)
        carrier.turn_to(math.pi / 2, 0.4)
        done("carried")
        carrier.torso(DOWN)
        done("put down")
        carrier.gripper(OPEN)
        carrier.torso(UP)
        done("let go")
        tilt = math.acos(min(1.0, float(carrier.bottle.pose.matrix[2, 2])))
        first = carrier.in_hand["lifted"]
        slips = {p: float(np.linalg.norm(carrier.in_hand[p] - first)) for p in ("lifted", "held", "carried")}
        return Carried(carrier.places, slips, tilt, carrier.fingers)


def main(arguments: list[str]) -> None:
    picture = picture_of(__doc__ or "", arguments)
    pictures: list[Any] = []

    def watch(sim: simkit.Simulation) -> None:
        from simkit import render_view

        view = {"eye": (2.6, -3.0, 1.9), "target": (-0.15, 0.15, 0.66), "vertical_fov": 0.56}
        shadows = {"quality": "gazebo", "passes": 16, "lit": (np.array((0.2, 0.0, 0.5)), 2.0)}
        pictures.append(render_view(sim, 400, 340, **view, **shadows))

    carried = run(watch=None if picture is None else watch)
    for part, place in carried.places.items():
        print(f"{part:20s} {place[0]:+.3f} {place[1]:+.3f} {place[2]:+.3f}")
    held, whole = (carried.slips[part] * 1000 for part in ("held", "carried"))
    print(f"slip in the hand: {held:.2f} mm while held, {whole:.2f} mm with the way; tilt {carried.tilt:.4f} rad")
    if picture is not None:
        from PIL import Image, ImageDraw, ImageFont

        rows = [np.hstack(pictures[i : i + 3]) for i in (0, 3)]
        whole_picture = Image.fromarray(np.vstack(rows))
        draw, font = ImageDraw.Draw(whole_picture), ImageFont.load_default(17)
        for number, part in enumerate(carried.places):
            draw.text((12 + number % 3 * 400, 10 + number // 3 * 340), f"{number + 1}  {part}", (32, 36, 40), font)
        whole_picture.save(picture, optimize=True)
        print(f"wrote {picture}")


if __name__ == "__main__":
    main(sys.argv[1:])
