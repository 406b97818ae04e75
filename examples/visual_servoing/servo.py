"""A robot looks for something orange, turns to it, and stops half a metre before it: `python servo.py [OUT.png]`.

It knows nothing but its camera: where the orange pixels are, and what the depth image says there.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from typing import Any, NamedTuple

import cv2
import numpy as np
import numpy.typing as npt

import simkit

WORLD = Path(__file__).resolve().parent / "world.sdf"
CAMERA = "turtlebot3::camera_rgb_frame::camera"
FEWER_PIXELS = [f"{CAMERA}.{s}" for s in ("update_rate=10", "camera.image.width=320", "camera.image.height=240")]
"""A quarter of the pixels, a third of the frames: enough for this, and so much less to draw."""

DISTANCE = 0.5  # [m], from the camera to where it is to stop
ORANGE = (5, 150, 80), (16, 255, 255)  # from, to: hue in halves of a degree, saturation, value
FEWEST = 30  # pixels that are something

SEARCH = 0.6  # [rad/s]
TURN = 1.5  # [rad/s for an object at the edge of the image]
DRIVE, FASTEST = 1.2, 0.22  # [1/s], [m/s]

NO_PICTURE = "the picture needs matplotlib: pip install matplotlib"


class Sight(NamedTuple):
    """What the robot made of one picture.

    Attributes:
        time: of the picture [s].
        picture: colours (h, w, 3).
        mask: 255 where it is orange (h, w).
        centroid: of the orange pixels, (column, row); None where nothing is orange.
        distance: along the camera's axis [m]; NaN where nothing is orange or has a depth.
        place: where the robot is, for the plot: x, y [m] and heading [rad].
    """

    time: float
    picture: npt.NDArray[np.uint8]
    mask: npt.NDArray[np.uint8]
    centroid: tuple[float, float] | None
    distance: float
    place: tuple[float, float, float]


class Servo:
    """Takes pictures and depths from the camera's topics and answers with velocities on `/cmd_vel`."""

    def __init__(self, sim: simkit.Simulation) -> None:
        self.sim = sim
        self.sights: list[Sight] = []
        self._picture: npt.NDArray[np.uint8] | None = None
        sim.subscribe("/camera/image_raw", self.on_picture, keep=1)
        sim.subscribe("/camera/depth/image_raw", self.on_depth, keep=1)

    @property
    def has_arrived(self) -> bool:
        """Five pictures in a row from the right distance."""
        last = self.sights[-5:]
        return len(last) == 5 and all(abs(sight.distance - DISTANCE) < 0.005 for sight in last)

    def on_picture(self, message: Any) -> None:
        self._picture = np.asarray(message.data).reshape(message.height, message.width, 3)

    def on_depth(self, message: Any) -> None:
        """Comes with each picture, right after it; so this is where things are decided."""
        if self._picture is None:
            return
        depths = np.asarray(message.data).view(np.float32).reshape(message.height, message.width)
        mask, centroid = find(self._picture)
        distance = distance_at(depths, mask, centroid)
        time = message.header.stamp.sec + message.header.stamp.nanosec * 1e-9
        pose = self.sim.model("turtlebot3").pose
        place = (pose.position[0], pose.position[1], pose.rpy[2])
        self.sights.append(Sight(time, self._picture.copy(), mask, centroid, distance, place))
        self.drive(centroid, distance, message.width)

    def drive(self, centroid: tuple[float, float] | None, distance: float, width: int) -> None:
        """Turns until something is in sight; then towards it, and forward the faster the better it is aimed."""
        linear, angular = 0.0, SEARCH
        if centroid is not None:
            aside = 1 - 2 * centroid[0] / width  # 1 at the left edge, -1 at the right one
            angular = TURN * aside
            if np.isfinite(distance):
                speed = np.clip(DRIVE * (distance - DISTANCE), -FASTEST, FASTEST)
                linear = float(speed * max(0.0, 1 - 2 * abs(aside)))
        self.sim.publish("/cmd_vel", {"linear": {"x": linear}, "angular": {"z": angular}})


def find(picture: npt.NDArray[np.uint8]) -> tuple[npt.NDArray[np.uint8], tuple[float, float] | None]:
    """The mask of what is orange, and its centroid (column, row), counted from the image's corner."""
    hsv = cv2.cvtColor(picture, cv2.COLOR_RGB2HSV)
    mask = cv2.inRange(hsv, np.array(ORANGE[0]), np.array(ORANGE[1]))
    mask = cv2.morphologyEx(mask, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))  # single pixels are noise
    moments = cv2.moments(mask, binaryImage=True)
    if moments["m00"] < FEWEST:
        return mask, None
    # the middle of the first pixel is half a pixel from the corner
    return mask, (moments["m10"] / moments["m00"] + 0.5, moments["m01"] / moments["m00"] + 0.5)


def distance_at(
    depths: npt.NDArray[np.float32], mask: npt.NDArray[np.uint8], centroid: tuple[float, float] | None
) -> float:
    """The median depth [m] of the orange pixels next to the centroid: noise is averaged, the background left out."""
    if centroid is None:
        return float("nan")
    column, row = int(centroid[0]), int(centroid[1])
    around = np.s_[max(row - 4, 0) : row + 5, max(column - 4, 0) : column + 5]
    near = depths[around][mask[around] > 0]
    near = near[np.isfinite(near)]
    return float(np.median(near)) if len(near) else float("nan")


def run(seed: int = 0, timeout: float = 40.0) -> list[Sight]:
    """Drives until the robot stands where it should; all that it saw on the way."""
    with simkit.load(WORLD, seed=seed, overrides=FEWER_PIXELS) as sim:
        servo = Servo(sim)
        sim.run_until(lambda _: servo.has_arrived, timeout)
        return servo.sights


# ---------------------------------------------------------------------- the picture


def draw(sights: list[Sight], out: Path) -> None:
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    first = next(i for i, sight in enumerate(sights) if sight.centroid is not None)
    shown = [first, first + (len(sights) - first) // 4, len(sights) - 1]
    plt.rcParams.update({"font.size": 9, "axes.titlelocation": "left", "axes.titlesize": "medium"})
    figure = plt.figure(figsize=(8.0, 5.4), dpi=110, layout="constrained")
    figure.suptitle("To the orange thing, by camera alone", fontsize="large")
    grid = figure.add_gridspec(2, 6, height_ratios=(1, 1.25))
    for k, index in enumerate(shown):
        draw_sight(figure.add_subplot(grid[0, 2 * k : 2 * k + 2]), sights[index], "abc"[k])
    draw_path(figure.add_subplot(grid[1, :3]), sights, shown)
    draw_distance(figure.add_subplot(grid[1, 3:]), sights, shown)
    figure.savefig(out, pil_kwargs={"optimize": True})
    plt.close(figure)
    print(f"wrote {out}")


def draw_sight(axes: Any, sight: Sight, letter: str) -> None:
    """The camera's picture with the outline of what is orange, and a cross at its centroid."""
    height, width = sight.mask.shape
    axes.imshow(sight.picture, extent=(0, width, height, 0))
    for outline in cv2.findContours(sight.mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[0]:
        closed = np.vstack([outline[:, 0], outline[:1, 0]]) + 0.5
        axes.plot(closed[:, 0], closed[:, 1], color="white", linewidth=1.2)
    axes.axvline(width / 2, color="black", linewidth=0.6, linestyle=":")
    if sight.centroid is not None:
        axes.plot(*sight.centroid, "+", color="black", markersize=11, markeredgewidth=1.5)
    axes.set(title=f"{letter}: {sight.time:.1f} s, {sight.distance:.2f} m", xticks=[], yticks=[])


def draw_path(axes: Any, sights: list[Sight], shown: list[int]) -> None:
    import matplotlib.pyplot as plt

    x, y, heading = np.array([sight.place for sight in sights]).T
    axes.add_patch(plt.Circle((1.7, 1.1), 0.1, color="#ff6b0d"))
    axes.add_patch(plt.Circle((1.7, 1.1), 0.1 + DISTANCE, fill=False, linestyle=":", color="#888888"))
    axes.plot(x, y, color="#0072b2")
    axes.quiver(x[shown], y[shown], np.cos(heading[shown]), np.sin(heading[shown]), scale=12, width=0.008, zorder=3)
    for k, index in enumerate(shown):
        axes.annotate("abc"[k], (x[index], y[index]), xytext=(0, -14), textcoords="offset points")
    axes.set(xlabel="x [m]", ylabel="y [m]", title="path, and the circle of 0.5 m", xlim=(-0.5, 2.5), ylim=(-0.5, 1.8))
    axes.set_aspect("equal")
    axes.grid(alpha=0.3)


def draw_distance(axes: Any, sights: list[Sight], shown: list[int]) -> None:
    times = [sight.time for sight in sights]
    axes.plot(times, [sight.distance for sight in sights], color="#0072b2")
    axes.axhline(DISTANCE, color="#888888", linestyle=":")
    for k, index in enumerate(shown):
        axes.annotate("abc"[k], (times[index], sights[index].distance), xytext=(2, 6), textcoords="offset points")
    axes.set(xlabel="time [s]", ylabel="[m]", title="distance, from the depth image", ylim=(0, None), xlim=(0, None))
    axes.grid(alpha=0.3)


def main(arguments: list[str]) -> None:
    if len(arguments) > 1:
        sys.exit("usage: python servo.py [OUT.png]")
    can_draw = importlib.util.find_spec("matplotlib") is not None
    if arguments and not can_draw:
        sys.exit(NO_PICTURE)
    seen = run()
    if not seen or seen[-1].centroid is None:
        sys.exit("found nothing orange")
    print(f"stopped after {seen[-1].time:.1f} s, {seen[-1].distance:.3f} m before it")
    if can_draw:
        draw(seen, Path(arguments[0] if arguments else "servo.png"))
    else:
        print(NO_PICTURE, file=sys.stderr)


if __name__ == "__main__":
    main(sys.argv[1:])
