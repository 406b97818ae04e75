"""Balls at known distances, and how far apart a stereo pair sees them: `python multicamera.py [OUT.png]`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import plots

import simkit

BASELINE = 0.12  # [m]
WIDTH, HEIGHT, FOV = 640, 240, 1.2
ROW = 34  # [px], from one ball to the next, upwards
FOCAL = WIDTH / (2 * np.tan(FOV / 2))  # [px]
BALLS = {1.0: -0.4, 1.4: 0.55, 2.0: -0.25, 2.8: 1.3, 4.0: 0.45, 5.6: -1.6, 8.0: 2.6}  # distance -> place across [m]


def ball(number: int, distance: float, across: float) -> str:
    height = 1 + (number - 3) * ROW / FOCAL * distance
    look = "<material><ambient>0.1 0.1 0.1 1</ambient><diffuse>0.1 0.1 0.1 1</diffuse></material>"
    shape = f"<geometry><sphere><radius>{12 / FOCAL * distance:g}</radius></sphere></geometry>"
    return (
        f'<model name="ball_{number}"><static>true</static><pose>{distance} {across} {height} 0 0 0</pose>'
        f'<link name="l"><visual name="v">{shape}{look}</visual></link></model>'
    )


def camera(name: str, y: float) -> str:
    return (
        f'<camera name="{name}"><pose>0 {y} 0 0 0 0</pose><horizontal_fov>{FOV}</horizontal_fov>'
        f"<image><width>{WIDTH}</width><height>{HEIGHT}</height></image></camera>"
    )


WORLD = f"""<sdf version="1.9"><world name="stereo">
  <scene><ambient>1 1 1 1</ambient><background>0.85 0.9 0.95 1</background></scene>
  {"".join(ball(i, *place) for i, place in enumerate(BALLS.items()))}
  <model name="head"><static>true</static><pose>0 0 1 0 0 0</pose><link name="l">
    <sensor name="eyes" type="multicamera"><topic>eyes</topic><update_rate>30</update_rate>
      {camera("left", BASELINE / 2)}{camera("right", -BASELINE / 2)}</sensor></link></model>
</world></sdf>"""


def main(out: Path) -> None:
    with simkit.load(WORLD) as sim:
        images = {side: sim.subscribe(f"/eyes/{side}/image", keep=1) for side in ("left", "right")}
        infos = sim.subscribe("/eyes/right/camera_info", keep=1)
        sim.step()
        left, right = (pixels(images[side].latest) for side in ("left", "right"))
        projection = infos.latest.p
    focal, baseline = projection[0], -projection[3] / projection[0]
    found = {z: middle(left, i) - middle(right, i) for i, z in enumerate(BALLS)}
    figure, (seen, curve) = plots.figure(
        "A stereo pair's disparity tells distance", rows=2, figsize=(8.0, 6.0), height_ratios=(1, 1.1)
    )
    seen.imshow(np.dstack([left[..., 0], right[..., 1:]]))
    seen.set(title="red: left camera, cyan: right camera", xticks=[], yticks=[])
    seen.grid(False)
    distances = np.linspace(0.9, 9, 200)
    label = f"f·B / z with f = {focal:.1f} px and B = {baseline:.2f} m of CameraInfo"
    curve.plot(distances, focal * baseline / distances, color=plots.TRUTH, label=label)
    curve.plot(list(found), list(found.values()), "o", color=plots.RED, label="middles of the balls, left less right")
    curve.set(xlabel="distance z [m]", ylabel="disparity [px]")
    curve.legend()
    plots.save(figure, out)


def pixels(image: Any) -> np.ndarray:
    return np.asarray(image.data).reshape(image.height, image.width, 3)


def middle(picture: np.ndarray, number: int) -> float:
    """Column [px] of the middle of a ball, by the rows that it is in."""
    row = HEIGHT // 2 - (number - 3) * ROW
    _, columns = np.nonzero(picture[row - ROW // 2 : row + ROW // 2, :, 0] < 100)
    return float(columns.mean() + 0.5)


if __name__ == "__main__":
    plots.run(main, "multicamera.png")
