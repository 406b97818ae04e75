"""Turning blades as cameras with errors see them: `python colour_artefacts.py [OUT.png]`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import plots

import simkit

SHUTTER = """<simkit:shutter><type>{}</type><line_time>{}</line_time><exposure>{}</exposure>
  <sub_frames>128</sub_frames></simkit:shutter>"""
DARK = """<simkit:vignetting/><simkit:exposure_control><exposure_value>-2.5</exposure_value></simkit:exposure_control>
  <simkit:image_sensor><full_well>2000</full_well><read_noise>5</read_noise></simkit:image_sensor>"""
CAMERAS = {
    "global shutter": "",
    "rolling shutter, 0.2 ms a line": SHUTTER.format("rolling", 0.0002, 0),
    "exposure of 20 ms": SHUTTER.format("global", 0, 0.02),
    "-2.5 EV, cos⁴ law, 2000 electrons": DARK,
}
COLOURS = ((0.7, 0.1, 0.1), (0.7, 0.6, 0.1), (0.1, 0.2, 0.7))  # of the blades
SPEED = 25.0  # [rad/s]
SENSOR = """<sensor name="s{0}" type="camera"><update_rate>10</update_rate><topic>image{0}</topic>
  <camera><horizontal_fov>1.1</horizontal_fov><image><width>320</width><height>240</height></image></camera>{1}</sensor>"""
BLADE = """<visual name="b{0}"><pose>0 0 0 {1} 0 0</pose><geometry><box><size>0.02 1.4 0.12</size></box></geometry>
  <material><ambient>{2} 1</ambient><diffuse>{2} 1</diffuse></material></visual>"""
WORLD = """<sdf version="1.9" xmlns:simkit="simkit"><world name="fan"><gravity>0 0 0</gravity>
  <scene><background>0.82 0.88 0.95</background></scene><include><uri>model://ground_plane</uri></include>
  <model name="eye"><static>true</static><pose>0 0 1 0 0 0</pose><link name="l">{}</link></model>
  <model name="fan"><pose>2.4 0 1.2 0 0 0</pose><link name="l"><inertial><mass>1</mass></inertial>{}</link></model>
</world></sdf>"""


def main(out: Path) -> None:
    sensors = "".join(SENSOR.format(i, errors) for i, errors in enumerate(CAMERAS.values()))
    blades = "".join(BLADE.format(i, i * np.pi / 3, " ".join(map(str, colour))) for i, colour in enumerate(COLOURS))
    with simkit.load(WORLD.format(sensors, blades), seed=1) as sim:
        images = [sim.subscribe(f"/image{i}", keep=1) for i in range(len(CAMERAS))]
        sim.model("fan").set_velocity((0.0, 0.0, 0.0), angular=(SPEED, 0.0, 0.0))
        sim.run(0.2)
        pictures = [np.asarray(found.latest.data).reshape(240, 320, 3) for found in images]
    figure, axes = plots.figure("Turning blades, four cameras", columns=2, rows=2, figsize=(6.4, 5.2))
    for axis, name, picture in zip(axes.flat, CAMERAS, pictures, strict=True):
        axis.imshow(picture)
        axis.set_title(name)
        axis.axis("off")
    plots.save(figure, out, colours=192)


if __name__ == "__main__":
    plots.run(main, "colour_artefacts.png")
