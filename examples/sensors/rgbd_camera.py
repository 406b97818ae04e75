"""Colours, depths and the cloud of one picture: `python rgbd_camera.py [OUT.png]`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import plots

import simkit


def thing(name: str, pose: str, shape: str, colour: str) -> str:
    return f"""<model name="{name}"><static>true</static><pose>{pose}</pose><link name="l"><visual name="v">
      <geometry>{shape}</geometry><material><ambient>{colour} 1</ambient><diffuse>{colour} 1</diffuse></material>
      </visual></link></model>"""


THINGS = (
    thing("table", "1.5 0 0.35 0 0 0", "<box><size>1 1.4 0.7</size></box>", "0.65 0.5 0.35")
    + thing("ball", "1.3 0.35 0.8 0 0 0", "<sphere><radius>0.1</radius></sphere>", "0.85 0.1 0.1")
    + thing(
        "can", "1.4 -0.05 0.8 0 0 0", "<cylinder><radius>0.07</radius><length>0.2</length></cylinder>", "0.1 0.3 0.85"
    )
    + thing("box", "1.35 -0.4 0.79 0 0 0.6", "<box><size>0.18 0.18 0.18</size></box>", "0.1 0.65 0.25")
    + thing("wall", "2.6 0 1 0 0 0", "<box><size>0.1 4 2</size></box>", "0.75 0.75 0.7")
)
WORLD = f"""<sdf version="1.9"><world name="kitchen">
  <light name="sun" type="directional"><direction>0.4 0.3 -0.85</direction></light>
  <model name="rig"><static>true</static><pose>0 0 1.3 0 0.35 0</pose><link name="l">
    <sensor name="rgbd" type="rgbd_camera"><update_rate>30</update_rate><topic>rgbd</topic><camera>
      <horizontal_fov>1.05</horizontal_fov><image><width>320</width><height>240</height></image>
      <depth_camera><clip><near>0.3</near><far>5</far></clip></depth_camera></camera>
    </sensor></link></model>
  {THINGS}</world></sdf>"""


def main(out: Path) -> None:
    with simkit.load(WORLD, seed=1) as sim:
        camera = sim.sensor("rig::l::rgbd")
        sim.run(0.04)
        image, depth, points = camera.latest, camera.depth, camera.points
        pose = camera.pose
    colours = image.data.reshape(image.height, image.width, 3)
    figure, (left, middle, right) = plots.figure(
        "RGB-D camera: each pixel has a colour, a depth and a point",
        columns=3,
        width_ratios=(1, 1.2, 1),
        figsize=(8, 3.1),
    )
    left.imshow(colours)
    left.set(title="image", xlabel="column [px]", ylabel="row [px]")
    shown = middle.imshow(np.where(np.isfinite(depth), depth, np.nan), cmap="viridis_r", interpolation="none")
    middle.set(title="depth [m]", xlabel="column [px]")
    figure.colorbar(shown, ax=middle, shrink=0.75)
    for ax in (left, middle):
        ax.grid(visible=False)
    hit = np.isfinite(depth)
    world = points[hit] @ pose.matrix.T + pose.position
    some = np.random.default_rng(0).permutation(len(world))[:12000]
    some = some[np.argsort(world[some, 2])]  # what is higher hides what is below
    right.scatter(world[some, 1], world[some, 0], s=2, c=colours[hit][some] / 255, edgecolors="none")
    right.set(title="cloud, from above", xlabel="y [m]", ylabel="x [m]", xlim=(1.3, -1.3))
    right.set_aspect("equal")
    plots.save(figure, out, colours=160)


if __name__ == "__main__":
    plots.run(main, "rgbd_camera.png")
