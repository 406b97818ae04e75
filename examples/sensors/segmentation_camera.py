"""Labelled things on a table, by label and one by one: `python segmentation_camera.py [OUT.png]`."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import plots

import simkit

LABEL = '<plugin filename="gz-sim-label-system" name="gz::sim::systems::Label"><label>{}</label></plugin>'
SHAPES = {
    "crate": "<box><size>0.3 0.3 0.3</size></box>",
    "can": "<cylinder><radius>0.1</radius><length>0.34</length></cylinder>",
    "ball": "<sphere><radius>0.17</radius></sphere>",
}
NUMBERS = {"table": 10, "crate": 40, "can": 80, "ball": 120}
PLACES = {
    "crate": [(1.6, 0.55, 0.2), (2.3, -0.6, 0.6)],
    "can": [(1.5, 0.0, 0.0), (1.9, 0.25, 0.0), (2.2, 0.05, 0.0)],
    "ball": [(1.6, -0.4, 0.0)],
}
TABLE = f"""<model name="table"><static>true</static><pose>2 0 0 0 0 0</pose><link name="top">
  <visual name="v"><geometry><box><size>1.6 2 0.04</size></box></geometry>
  <material><ambient>0.5 0.35 0.2 1</ambient><diffuse>0.6 0.45 0.3 1</diffuse></material></visual></link>
  {LABEL.format(NUMBERS["table"])}</model>"""
COLOURS = {"crate": "0.2 0.4 0.7", "can": "0.8 0.3 0.2", "ball": "0.3 0.6 0.3"}


def thing(kind: str, number: int, x: float, y: float, yaw: float) -> str:
    colour = f"<ambient>{COLOURS[kind]} 1</ambient><diffuse>{COLOURS[kind]} 1</diffuse>"
    return f"""<model name="{kind}_{number}"><static>true</static><pose>{x} {y} 0.19 0 0 {yaw}</pose><link name="l">
      <visual name="v"><geometry>{SHAPES[kind]}</geometry><material>{colour}</material></visual></link>
      {LABEL.format(NUMBERS[kind])}</model>"""


def eye(name: str, kind: str, block: str = "") -> str:
    optics = "<horizontal_fov>1.1</horizontal_fov><image><width>320</width><height>240</height></image>"
    return f"""<sensor name="{name}" type="{kind}"><topic>{name}</topic><update_rate>10</update_rate>
      <camera>{optics}{block}</camera></sensor>"""


def world(sensors: str) -> str:
    """A table seen by sensors above its near edge."""
    things = "".join(thing(k, i, *place) for k, places in PLACES.items() for i, place in enumerate(places))
    return f"""<sdf version="1.9"><world name="kitchen">
      <light name="sun" type="directional"><direction>0.4 0.3 -1</direction></light>{TABLE}{things}
      <model name="rig"><static>true</static><pose>0.2 0 1.1 0 0.55 0</pose><link name="l">{sensors}</link></model>
      </world></sdf>"""


def pixels(message: object) -> np.ndarray:
    return np.asarray(message.data).reshape(message.height, message.width, 3)  # type: ignore[attr-defined]


def main(out: Path) -> None:
    eyes = eye("camera", "camera") + eye("semantic", "segmentation_camera")
    eyes += eye("panoptic", "segmentation_camera", "<segmentation_type>panoptic</segmentation_type>")
    with simkit.load(world(eyes), seed=1) as sim:
        topics = ("/camera", "/semantic/colored_map", "/panoptic/colored_map")
        seen = [sim.subscribe(topic) for topic in topics]
        labels = sim.subscribe("/semantic/labels_map")
        sim.run(0.01)
        pictures = [pixels(s.messages[-1]) for s in seen]
        told = pixels(labels.messages[-1])[..., 0]
    figure, axes = plots.figure(
        "Segmentation: labels, and things of one label told apart", columns=3, figsize=(8.0, 2.8)
    )
    titles = ("what a camera sees", "semantic", "panoptic")
    for ax, picture, title in zip(axes, pictures, titles, strict=True):
        ax.imshow(picture)
        ax.set(title=title, xticks=[], yticks=[])
        ax.grid(False)
        ax.spines[:].set_visible(False)
    for name, number in NUMBERS.items():
        inside = cv2.distanceTransform((told == number).astype(np.uint8), cv2.DIST_L2, 3)
        row, column = np.unravel_index(inside.argmax(), inside.shape)
        axes[1].annotate(f"{name} {number}", (column, row), color="white", ha="center", va="center", fontsize=7)
    plots.save(figure, out)


if __name__ == "__main__":
    plots.run(main, "segmentation_camera.png")
