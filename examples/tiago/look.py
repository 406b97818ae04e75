"""TIAGo looks at a point in front of it, then at a pixel of its own picture: `python look.py [OUT.png]`."""

from __future__ import annotations

import math
import sys
from typing import Any, NamedTuple

import numpy as np
from moves import Vector, duration, picture_of, tiago_in, wait_for

import simkit

BALL = """<sdf version="1.9"><model name="ball"><static>true</static><pose>{0} {1} {2} 0 0 0</pose><link name="link">
  <visual name="v"><geometry><sphere><radius>0.06</radius></sphere></geometry>
    <material><ambient>0.9 0.3 0 1</ambient><diffuse>0.9 0.3 0 1</diffuse></material></visual></link></model></sdf>"""
PLACE = (1.5, 0.6, 0.7)  # [m], of the ball, in the world; the robot stands at its origin
FRAME = "head_front_camera_rgb_optical_frame"
IMAGE, INFO = "/head_front_camera/rgb/image_raw", "/head_front_camera/rgb/camera_info"


class Sight(NamedTuple):
    """Where the camera looks.

    Attributes:
        angle: between the camera's axis and the direction to the ball [rad].
        pixel: the ball's middle in the picture, column and row; NaN where it is not in it.
        picture: colours (480, 640, 3).
    """

    angle: float
    pixel: tuple[float, float]
    picture: Any


def look_at(sim: simkit.Simulation, frame: str, point: tuple[float, float, float]) -> Any:
    """Sends a point [m] in a frame to the head, whose camera is to look at it."""
    goal = sim.send_goal(
        "/head_controller/point_head_action",
        {
            "target": {"header": {"frame_id": frame}, "point": dict(zip("xyz", point, strict=True))},
            "pointing_frame": FRAME,
            "pointing_axis": {"z": 1.0},
            "min_duration": duration(1.0),
            "max_velocity": 1.0,
        },
    )
    wait_for(sim, goal, 10.0)
    sim.run(0.5)
    return goal


def ray_of(pixel: tuple[float, float], info: Any) -> tuple[float, float, float]:
    """The point a metre ahead of the camera that is seen at a pixel: through the matrix K of its `camera_info`."""
    k = np.asarray(info.k).reshape(3, 3)
    return (float((pixel[0] - k[0, 2]) / k[0, 0]), float((pixel[1] - k[1, 2]) / k[1, 1]), 1.0)


def sight(sim: simkit.Simulation, images: Any) -> Sight:
    sim.run(0.1)
    message = images.latest
    picture = np.asarray(message.data).reshape(message.height, message.width, 3)
    if message.encoding == "bgr8":  # as TIAGo's camera sends it
        picture = picture[..., ::-1]
    return Sight(angle_to_ball(sim), middle_of_orange(picture), picture)


def angle_to_ball(sim: simkit.Simulation) -> float:
    pose = sim.model("tiago").link(FRAME).pose
    way: Vector = np.array(PLACE) - pose.position
    return math.acos(min(1.0, float(way @ pose.matrix[:, 2] / np.linalg.norm(way))))


def middle_of_orange(picture: Any) -> tuple[float, float]:
    """Column and row of the middle of all that is orange."""
    red, green, blue = (picture[..., i].astype(int) for i in range(3))
    rows, columns = np.nonzero((red > 2 * blue + 30) & (red > green + 30))
    return (float(columns.mean()), float(rows.mean())) if len(rows) else (math.nan, math.nan)


def run(seed: int = 0) -> list[Sight]:
    """What it sees straight ahead, after it was told where the ball is, turned aside, and led back by the picture."""
    with tiago_in("empty", seed=seed) as sim:
        sim.spawn(BALL.format(*PLACE))
        images, infos = sim.subscribe(IMAGE, keep=1), sim.subscribe(INFO, keep=1)
        sim.run(0.5)
        seen = [sight(sim, images)]
        look_at(sim, "base_footprint", PLACE)
        seen.append(sight(sim, images))
        look_at(sim, "base_footprint", (1.5, 0.3, 0.9))
        seen.append(sight(sim, images))
        look_at(sim, FRAME, ray_of(seen[-1].pixel, infos.latest))
        seen.append(sight(sim, images))
        return seen


def main(arguments: list[str]) -> None:
    picture = picture_of(__doc__ or "", arguments)
    seen = run()
    for name, view in zip(("ahead", "told where it is", "aside", "led by the picture"), seen, strict=True):
        at = ", ".join(f"{p:.1f}" for p in view.pixel)
        print(f"{name:20s} {math.degrees(view.angle):6.2f} degrees off the ball, which is at pixel {at}")
    if picture is not None:
        import cv2

        cv2.imwrite(str(picture), np.hstack([view.picture[::2, ::2] for view in seen])[..., ::-1])
        print(f"wrote {picture}")


if __name__ == "__main__":
    main(sys.argv[1:])
