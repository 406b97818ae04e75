"""A stove, its pot and somebody beside it, as a camera and a thermal camera see them: `python thermal_camera.py`."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
import plots

import simkit

SIZE = (160, 120)
EYE = f"""<pose>0 0 0.25 0 0 0</pose><update_rate>10</update_rate><camera><horizontal_fov>1.047</horizontal_fov>
  <image><width>{SIZE[0]}</width><height>{SIZE[1]}</height><format>{{}}</format></image>
  <clip><near>0.1</near><far>20</far></clip></camera>"""
THERMAL = '<plugin filename="gz-sim-thermal-system" name="gz::sim::systems::Thermal">{}</plugin>'
PLATE = "<cylinder><radius>0.22</radius><length>0.03</length></cylinder>"
POT = "<cylinder><radius>0.2</radius><length>0.3</length></cylinder>"
BODY = "<capsule><radius>0.25</radius><length>0.6</length></capsule>"
FACE = "<heat_signature>face.png</heat_signature><min_temp>296</min_temp><max_temp>308</max_temp>"


def part(name: str, pose: str, shape: str, colour: str, more: str = "") -> str:
    paint = f"<material><ambient>{colour} 1</ambient><diffuse>{colour} 1</diffuse></material>"
    visual = f"<geometry>{shape}</geometry>{paint}{THERMAL.format(more) if more else ''}"
    return f'<visual name="{name}"><pose>{pose}</pose>{visual}</visual>'


WORLD = f"""<sdf version="1.9"><world name="kitchen">
  <atmosphere type="adiabatic"><temperature>293</temperature>
    <temperature_gradient>-0.6</temperature_gradient></atmosphere>
  <light name="sun" type="directional"><direction>0.5 0.3 -1</direction></light>
  <model name="eye"><static>true</static><pose>0 0 0.8 0 0.15 0</pose><link name="l">
    <sensor name="colour" type="camera">{EYE.format("R8G8B8")}</sensor>
    <sensor name="heat" type="thermal_camera">{EYE.format("L16")}</sensor></link></model>
  <model name="kitchen"><static>true</static><link name="l">
    {part("floor", "4 0 0 0 0 0", "<plane><normal>0 0 1</normal><size>12 12</size></plane>", "0.5 0.4 0.3")}
    {part("stove", "3 0.6 0.4 0 0 0", "<box><size>0.8 0.8 0.8</size></box>", "0.9 0.9 0.9")}
    {part("plate", "2.9 0.6 0.81 0 0 0", PLATE, "0.1 0.1 0.1", "<temperature>335</temperature>")}
    {part("pot", "2.9 0.6 0.97 0 0 0", POT, "0.6 0.2 0.2", "<temperature>325</temperature>")}
    {part("body", "3 -0.7 0.7 0 0 0", BODY, "0.2 0.3 0.7", FACE)}
  </link></model></world></sdf>"""


def main(out: Path) -> None:
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        _draw_face(place / "face.png")
        (place / "kitchen.sdf").write_text(WORLD, encoding="utf-8")
        with simkit.load(place / "kitchen.sdf") as sim:
            sim.run(0.1)
            colour, heat = (sim.sensor(f"eye::l::{name}").latest for name in ("colour", "heat"))
    figure, (left, right) = plots.figure("Thermal camera: L16 in steps of 0.01 K", columns=2)
    left.imshow(np.asarray(colour.data).reshape(SIZE[1], SIZE[0], 3))
    kelvins = np.asarray(heat.data).view("<u2").reshape(SIZE[1], SIZE[0]) * 0.01
    shown = right.imshow(kelvins, cmap="inferno", vmin=280)
    figure.colorbar(shown, ax=right, label="temperature [K]", shrink=0.7)
    for ax, title in ((left, "camera"), (right, "thermal_camera")):
        ax.set(title=title, xticks=(), yticks=())
    plots.save(figure, out)


def _draw_face(path: Path) -> None:
    """A picture of temperatures: warm at the head, with cold stripes below."""
    from matplotlib import image

    rows = np.linspace(1.0, 0.2, 64)[:, None] * np.ones((1, 64))
    rows[24::8] *= 0.5
    image.imsave(path, np.repeat(rows[:, :, None], 3, axis=2))


if __name__ == "__main__":
    plots.run(main, "thermal_camera.png")
