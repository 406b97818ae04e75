"""What a RealSense D435 sees of an aisle, and how its error grows with depth: `python depth_camera.py [OUT.png]`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import plots

import simkit

BLOCKS = "".join(
    f"""<model name="block{i}"><static>true</static><pose>{1.2 + 0.9 * i} {(-1) ** i * 0.55} 0.3 0 0 {0.3 * i}</pose>
      <link name="l"><visual name="v"><geometry><box><size>0.4 0.4 0.6</size></box></geometry></visual></link>
      </model>"""
    for i in range(6)
)
WORLD = f"""<sdf version="1.9" xmlns:simkit="simkit"><world name="aisle">
  <model name="rig"><static>true</static><pose>0 0 0.8 0 0.08 0</pose><link name="l">
    <sensor name="d435" type="depth_camera"><topic>depth</topic>
      <simkit:preset>D435</simkit:preset>
    </sensor></link></model>
  <model name="floor"><static>true</static><link name="l"><visual name="v">
    <geometry><plane><size>60 60</size></plane></geometry></visual></link></model>
  <model name="wall"><static>true</static><pose>7.5 0 1.5 0 0 0</pose><link name="l"><visual name="v">
    <geometry><box><size>0.2 12 3</size></box></geometry></visual></link></model>
  {BLOCKS}</world></sdf>"""


def main(out: Path) -> None:
    with simkit.load(WORLD, seed=1) as sim:
        camera = sim.sensor("rig::l::d435")
        sim.run(0.1)
        found, true, focal = camera.depth, camera.true_depth, camera.options.model.fx
    hit = np.isfinite(found) & (found > 0) & np.isfinite(true)  # 0 in the shadow of the second camera
    figure, (image, errors) = plots.figure("Depth camera: the D435's disparity noise", columns=2, width_ratios=(3, 2))
    shown = image.imshow(np.where(hit, found, np.nan), cmap="viridis_r", interpolation="none")
    image.set(title="depth [m]; white: no value", xlabel="column [px]", ylabel="row [px]")
    image.grid(visible=False)
    figure.colorbar(shown, ax=image, shrink=0.6)
    some = np.random.default_rng(0).permutation(np.flatnonzero(hit))[:4000]
    errors.plot(true.flat[some], 1000 * (found.flat[some] - true.flat[some]), ".", markersize=2, color=plots.BLUE)
    depth = np.linspace(true[hit].min(), true[hit].max(), 50)
    deviation = 1000 * depth**2 / (focal * 0.05) * 0.08
    for sign in (-1, 1):
        errors.plot(depth, sign * deviation, color=plots.TRUTH, label="± z²·0.08 px/(f·50 mm)" if sign > 0 else None)
    errors.set(title="reading less truth [mm]", xlabel="depth [m]")
    errors.legend(loc="upper left")
    plots.save(figure, out)


if __name__ == "__main__":
    plots.run(main, "depth_camera.png")
