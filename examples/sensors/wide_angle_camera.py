"""A tiled room through SDF's lenses, and how far from the middle of the picture each shows an angle off the axis."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from plots import TRUTH, figure, run, save

import simkit

SIZE = 320  # [px]
LENSES = {  # type: opening angle [rad], SDF's formula of the lens
    "gnomonical": (1.9, np.tan),
    "stereographic": (3.14, lambda angle: 2 * np.tan(angle / 2)),
    "equidistant": (3.14, lambda angle: angle),
    "equisolid_angle": (3.14, lambda angle: 2 * np.sin(angle / 2)),
    "orthographic": (3.14, np.sin),
}
ROOM = (4.0, 4.0, 3.0)  # [m]


def visual(name: str, position: tuple[float, ...], size: tuple[float, ...], colour: str) -> str:
    place, extent = (" ".join(f"{v:g}" for v in values) for values in (position, size))
    return f"""<visual name="{name}"><pose>{place} 0 0 0</pose><geometry><box><size>{extent}</size></box></geometry>
      <material><ambient>{colour} 1</ambient><diffuse>{colour} 1</diffuse></material></visual>"""


def room() -> str:
    """Tiles of half a metre on every wall, in one colour and its shade."""
    colours = (
        ("0.85 0.45 0.35", "0.7 0.3 0.25"),
        ("0.45 0.7 0.5", "0.3 0.55 0.35"),
        ("0.75 0.75 0.75", "0.5 0.5 0.55"),
    )
    tiles: list[str] = []
    for axis, shades in enumerate(colours):
        first, second = (a for a in range(3) if a != axis)
        for i, j, side in np.ndindex(int(ROOM[first] / 0.5), int(ROOM[second] / 0.5), 2):
            position, size = [0.0] * 3, [0.5] * 3
            position[axis], size[axis] = (side - 0.5) * ROOM[axis], 0.02
            position[first] = 0.25 + 0.5 * i - ROOM[first] / 2
            position[second] = 0.25 + 0.5 * j - ROOM[second] / 2
            tiles.append(visual(f"t{len(tiles)}", tuple(position), tuple(size), shades[(i + j) % 2]))
    return f'<model name="room"><static>true</static><link name="l">{"".join(tiles)}</link></model>'


def sensor(lens: str, hfov: float) -> str:
    return f"""<sensor name="{lens}" type="wide_angle_camera"><update_rate>10</update_rate><topic>{lens}/image</topic>
      <camera><horizontal_fov>{hfov}</horizontal_fov><image><width>{SIZE}</width><height>{SIZE}</height></image>
      <lens><type>{lens}</type></lens></camera></sensor>"""


WORLD = f"""
<sdf version="1.9"><world name="w">
  <scene><ambient>1 1 1 1</ambient></scene>
  {room()}
  <model name="eye"><static>true</static><pose>-0.8 0.3 -0.2 0 0 0.15</pose><link name="l">
    {"".join(sensor(lens, hfov) for lens, (hfov, _) in LENSES.items())}
  </link></model>
</world></sdf>
"""


def pictures() -> dict[str, Any]:
    """The picture of each lens, shape (SIZE, SIZE, 3)."""
    with simkit.load(WORLD) as sim:
        subscriptions = {lens: sim.subscribe(f"/{lens}/image") for lens in LENSES}
        sim.run(0.1)
        return {lens: np.asarray(found.latest.data).reshape(SIZE, SIZE, 3) for lens, found in subscriptions.items()}


def main(out: Path) -> None:
    fig, axes = figure("A room through SDF's lenses", 2, 3, figsize=(8.0, 5.6))
    *shown, formulas = axes.ravel()
    styles = ("-", "--", "-.", ":", (0, (6, 1)))
    for ax, style, (lens, picture) in zip(shown, styles, pictures().items(), strict=True):
        hfov, formula = LENSES[lens]
        ax.imshow(picture, extent=(-1, 1, -1, 1))
        for angle in np.radians((30, 60)):  # circles of equal angle off the axis
            radius = formula(angle) / formula(hfov / 2)
            ax.add_patch(_circle(radius))
        ax.set(title=f"{lens}, {math.degrees(hfov):.0f}°", xlim=(-1, 1), ylim=(-1, 1))
        ax.axis("off")
        angles = np.linspace(0, hfov / 2, 100)
        formulas.plot(np.degrees(angles), formula(angles) / formula(hfov / 2), color=TRUTH, linestyle=style, label=lens)
    formulas.set(title="where an angle is seen", xlabel="angle off the axis [°]", ylabel="half widths", xlim=(0, 90))
    formulas.legend(fontsize=7)
    save(fig, out)


def _circle(radius: float) -> Any:
    from matplotlib.patches import Circle

    return Circle((0, 0), radius, fill=False, color=TRUTH, linewidth=0.8, linestyle="--")


if __name__ == "__main__":
    run(main, "wide_angle_camera.png")
