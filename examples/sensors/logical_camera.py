"""A logical camera turns about and tells which boxes are in its frustum: `python logical_camera.py [OUT.png]`."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import plots

import simkit

FOV, NEAR, FAR = 1.0, 0.5, 4.0
PLACES = {"crate": (2.6, 1.1), "barrel": (1.2, -2.0), "cone": (3.0, -1.6), "pallet": (-2.2, 1.6), "rack": (0.6, 3.0)}
BOX = """<model name="{}"><pose>{} {} 0.5 0 0 0</pose><static>true</static><link name="base">
  <visual name="v"><geometry><box><size>0.4 0.4 1</size></box></geometry></visual></link></model>"""
WORLD = f"""<sdf version="1.9"><world name="hall"><gravity>0 0 0</gravity>
  <model name="robot"><pose>0 0 0.5 0 0 -1.2</pose><link name="head">
    <sensor name="eye" type="logical_camera"><update_rate>20</update_rate><logical_camera>
      <near>{NEAR}</near><far>{FAR}</far><horizontal_fov>{FOV}</horizontal_fov><aspect_ratio>1.5</aspect_ratio>
    </logical_camera></sensor></link></model>
  {"".join(BOX.format(name, *place) for name, place in PLACES.items())}</world></sdf>"""


def main(out: Path) -> None:
    with simkit.load(WORLD) as sim:
        sim.model("robot").set_velocity((0, 0, 0), (0, 0, 1.0))
        images = sim.subscribe(sim.sensor("robot::head::eye").topic)
        sim.run(math.tau)
        heading = sim.model("robot").pose.rpy[2]
    figure, (map_, when) = plots.figure("Logical camera: turning once about in 6.3 s", columns=2)
    half, reach = FOV / 2, np.array((NEAR, FAR, FAR, NEAR, NEAR))
    sides = heading + np.array((-half, -half, half, half, -half))
    reach = reach / math.cos(half)  # near and far are planes
    map_.fill(reach * np.cos(sides), reach * np.sin(sides), alpha=0.25, color=plots.SKY)
    map_.plot(0, 0, "^", color=plots.TRUTH)
    for row, (name, (x, y)) in enumerate(PLACES.items()):
        map_.plot(x, y, "s", markersize=9)
        map_.annotate(name, (x, y), (8, 6), textcoords="offset points")
        seen = [m for m in images.messages if any(model.name == name for model in m.model)]
        when.plot(plots.stamps(seen), [row] * len(seen), "s", markersize=5)
    map_.set(xlabel="x [m]", ylabel="y [m]", title="the frustum at the end", xlim=(-3.5, 5), ylim=(-4.8, 4))
    map_.set_aspect("equal")
    when.set(xlabel="time [s]", title="what is in it", xlim=(0, math.tau), yticks=range(len(PLACES)))
    when.set_yticklabels(PLACES)
    plots.save(figure, out)


if __name__ == "__main__":
    plots.run(main, "logical_camera.png")
