"""A room as an ideal depth camera and three kinds of real ones see it: `python depth_artefacts.py [OUT.png]`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import plots

import simkit

BOX = """<model name="{0}"><static>true</static><pose>{1}</pose><link name="l"><visual name="v"><geometry><box>
  <size>{2}</size></box></geometry></visual></link></model>"""
BOXES = (
    ("floor", "2 0 -0.05 0 0 0", "20 20 0.1"), ("wall", "3.05 0 1 0 0 0", "0.1 9 9"),
    ("side", "2 -1.4 1 0 0 0", "4 0.1 9"), ("crate", "1.8 0.55 0.3 0 0 0.6", "0.5 0.5 0.6"),
    ("post", "1.0 -0.25 0.5 0 0 0", "0.06 0.06 2"),
)  # fmt: skip
STEREO = """<simkit:depth_error><coefficient>0.0022</coefficient><correlation_length>7</correlation_length>
  </simkit:depth_error>
  <simkit:occlusion_shadow><baseline>0.05</baseline></simkit:occlusion_shadow>
  <simkit:depth_holes><probability>0.04</probability><correlation_length>9</correlation_length><incidence>
  <start>1.3</start><end>1.5</end></incidence></simkit:depth_holes>"""
X3 = """<simkit:depth_error><scale>-0.011858</scale><stddev>0.002</stddev><coefficient>0.0019</coefficient>
  <exponent>2.36</exponent></simkit:depth_error>
  <simkit:occlusion_shadow><baseline>-0.075</baseline><margin>1000</margin></simkit:occlusion_shadow>
  <simkit:depth_holes><probability>0.05</probability><correlation_length>5</correlation_length><border>0 21 0 0</border>
  <incidence><start>1.05</start><end>1.13</end></incidence>
  <wedge><start>0.6</start><end>0.363</end><direction>0.785</direction></wedge></simkit:depth_holes>"""
FLIGHT = """<simkit:flying_pixels><width>2</width></simkit:flying_pixels>
  <simkit:multipath><radius>12</radius><strength>2</strength></simkit:multipath>
  <simkit:phase_wrap><range>3.2</range></simkit:phase_wrap>
  <simkit:depth_error><stddev>0.004</stddev><incidence_exponent>1</incidence_exponent></simkit:depth_error>
  <simkit:depth_holes><vignetting>0.9</vignetting><correlation_length>3</correlation_length></simkit:depth_holes>"""
CAMERAS = {"ideal": "", "stereo, 50 mm": STEREO, "structured light: the X3's": X3, "time of flight, 3.2 m": FLIGHT}
WORLD = """<sdf version="1.9" xmlns:simkit="simkit"><world name="room">
  <model name="rig"><static>true</static><pose>0 0 0.35 0 0.05 0</pose><link name="l">{}</link></model>{}
</world></sdf>"""
SENSOR = """<sensor name="s{}" type="depth_camera"><topic>d{}</topic><camera><horizontal_fov>1.06406</horizontal_fov>
  <image><width>320</width><height>240</height></image><clip><near>0.1</near><far>8</far></clip></camera>{}</sensor>"""


def main(out: Path) -> None:
    sensors = "".join(SENSOR.format(i, i, artefacts) for i, artefacts in enumerate(CAMERAS.values()))
    with simkit.load(WORLD.format(sensors, "".join(BOX.format(*box) for box in BOXES)), seed=1) as sim:
        sim.run(0.1)
        images = [np.array(sim.sensor(f"rig::l::s{i}").depth) for i in range(len(CAMERAS))]
    figure, axes = plots.figure("One room, four depth cameras", columns=2, rows=2, figsize=(8.0, 5.8))
    for axis, name, image in zip(axes.flat, CAMERAS, images, strict=True):
        seen = np.isfinite(image)
        shown = axis.imshow(np.where(seen, image, np.nan), cmap="viridis_r", vmin=0, vmax=4, interpolation="none")
        axis.set(title=f"{name}: {seen.mean():.0%} valid", xlabel="column [px]", ylabel="row [px]")
        axis.grid(visible=False)
    figure.colorbar(shown, ax=axes, shrink=0.6, label="depth [m]")
    plots.save(figure, out)


if __name__ == "__main__":
    plots.run(main, "depth_artefacts.png")
