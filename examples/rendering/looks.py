"""The same world at two qualities, and in fog, side by side: `python looks.py [FOLDER]` writes the pictures."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import cv2
import numpy as np

import simkit

HERE = Path(__file__).resolve().parent
QUALITIES = ("fast", "gazebo")
EYE = """<sdf version="1.9"><model name="eye"><static>true</static><pose>{pose}</pose><link name="link">
  <sensor name="camera" type="camera"><topic>camera</topic><update_rate>10</update_rate><camera>
    <horizontal_fov>1.2</horizontal_fov><image><width>420</width><height>300</height></image>
    <clip><near>0.05</near><far>100</far></clip></camera></sensor></link></model></sdf>"""
FOG = "<fog><type>exp</type><color>0.7 0.8 0.9 1</color><density>0.12</density></fog>"


def picture(source: Any, quality: str, eye: str = "") -> Any:
    """What the camera on the topic `camera` sees: red, green, blue, shape (300, 420, 3)."""
    with simkit.load(source, overrides=[f"scene.quality={quality}"]) as sim:
        if eye:
            sim.spawn(EYE.format(pose=eye))
        images = sim.subscribe("/camera", keep=1)
        sim.run(0.2)
        return images.latest.data.reshape(images.latest.height, images.latest.width, 3)


def main(out: Path) -> None:
    own = (HERE / "world.sdf").read_text(encoding="utf-8")
    foggy = own.replace("<sky/>", FOG)
    sources = {
        "looks.png": [picture(own, quality) for quality in QUALITIES],
        "fog.png": [picture(foggy, quality) for quality in QUALITIES],
        "house.png": [picture("turtlebot3_house", quality, "-5.2 -4.8 4.2 0 0.62 0.8") for quality in QUALITIES],
    }
    for name, pictures in sources.items():
        gap = np.full((300, 8, 3), 255, np.uint8)
        together = np.hstack([pictures[0], gap, pictures[1]])[..., ::-1]
        cv2.imwrite(str(out / name), together, [cv2.IMWRITE_PNG_COMPRESSION, 9])


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path())
