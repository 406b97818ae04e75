"""One camera in four formats, a Bayer mosaic from near by, and its colours again: `python camera.py [OUT.png]`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cv2
import numpy as np
import plots

import simkit

FORMATS = ("R8G8B8", "L8", "BAYER_RGGB8")
WIDTH, HEIGHT = 320, 240
CORNER, ACROSS = (120, 132), 24  # row and column of what is shown from near by, and its size [px]
THINGS = (
    ("0.9 0.1 0.1", "3 0.9 0.4", "<sphere><radius>0.4</radius></sphere>"),
    ("0.1 0.6 0.2", "3.4 -0.2 0.35", "<cylinder><radius>0.3</radius><length>0.7</length></cylinder>"),
    ("0.1 0.3 0.9", "2.8 -1.1 0.3", "<box><size>0.6 0.6 0.6</size></box>"),
    ("0.9 0.8 0.1", "5.5 0.6 0.6", "<box><size>0.3 2.4 1.2</size></box>"),
)


def model(number: int, colour: str, place: str, shape: str) -> str:
    look = f"<material><ambient>{colour} 1</ambient><diffuse>{colour} 1</diffuse></material>"
    visual = f'<visual name="v"><geometry>{shape}</geometry>{look}</visual>'
    link = f'<link name="l"><pose>{place} 0 0 {0.3 * number}</pose>{visual}</link>'
    return f'<model name="thing_{number}"><static>true</static>{link}</model>'


def sensor(kind: str) -> str:
    image = f"<image><width>{WIDTH}</width><height>{HEIGHT}</height><format>{kind}</format></image>"
    return (
        f'<sensor name="{kind}" type="camera"><topic>{kind}/image</topic><update_rate>30</update_rate>'
        f"<camera><horizontal_fov>1.1</horizontal_fov>{image}<clip><far>25</far></clip></camera></sensor>"
    )


WORLD = f"""<sdf version="1.9"><world name="formats">
  <scene><ambient>0.4 0.4 0.4 1</ambient><background>0.8 0.9 1 1</background></scene>
  <light name="sun" type="directional"><diffuse>0.8 0.8 0.8 1</diffuse>
    <direction>0.4 0.3 -0.9</direction></light>
  <model name="ground"><static>true</static><link name="l"><visual name="v">
    <geometry><plane><normal>0 0 1</normal><size>20 20</size></plane></geometry>
    <material><ambient>0.75 0.72 0.68 1</ambient><diffuse>0.75 0.72 0.68 1</diffuse></material></visual></link></model>
  {"".join(model(i, *thing) for i, thing in enumerate(THINGS))}
  <model name="tripod"><static>true</static><pose>0 0 0.9 0 0.12 0</pose>
    <link name="head">{"".join(sensor(kind) for kind in FORMATS)}</link></model>
</world></sdf>"""


def main(out: Path) -> None:
    with simkit.load(WORLD, seed=1) as sim:
        subscriptions = {kind: sim.subscribe(f"/{kind}/image", keep=1) for kind in FORMATS}
        sim.step()
        colours, grey, bayer = (pixels(subscription.latest) for subscription in subscriptions.values())
    figure, axes = plots.figure("A camera's pictures, by <format>", rows=2, columns=2, figsize=(8.0, 6.2))
    (first, second), (third, fourth) = axes
    show(first, "R8G8B8", colours)
    show(second, "L8: 0.299 red + 0.587 green + 0.114 blue", grey, cmap="gray", vmin=0, vmax=255)
    row, column = CORNER
    near = np.s_[row : row + ACROSS * HEIGHT // WIDTH, column : column + ACROSS]
    show(third, f"BAYER_RGGB8, {ACROSS} pixels of a row", painted(bayer)[near])
    show(fourth, "the Bayer picture through cv2.cvtColor", cv2.cvtColor(bayer, cv2.COLOR_BayerBG2RGB))
    plots.save(figure, out, colours=256)


def pixels(image: Any) -> np.ndarray:
    """An image message as an array (h, w, 3), or (h, w) where it has one channel."""
    return np.asarray(image.data).reshape(image.height, image.width, -1).squeeze()


def painted(mosaic: np.ndarray) -> np.ndarray:
    """Each pixel of a mosaic in the colour that it measures."""
    found = np.zeros((*mosaic.shape, 3), np.uint8)
    for channel, places in enumerate((((0, 0),), ((0, 1), (1, 0)), ((1, 1),))):
        for down, right in places:
            found[down::2, right::2, channel] = mosaic[down::2, right::2]
    return found


def show(axes: Any, title: str, picture: np.ndarray, **how: Any) -> None:
    axes.imshow(picture, **how)
    axes.set(title=title, xticks=[], yticks=[])
    axes.grid(False)
    axes.spines[:].set_visible(False)


if __name__ == "__main__":
    plots.run(main, "camera.png")
