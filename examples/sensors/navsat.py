"""A car that drives a circle, as two receivers and the map see it: `python navsat.py [OUT.png]`."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import plots

import simkit

RADIUS, SPEED = 30.0, 8.0  # m, m/s
NOISE = '<noise type="gaussian"><stddev>{}</stddev>{}</noise>'
WANDER = (
    "<dynamic_bias_stddev>0.6</dynamic_bias_stddev><dynamic_bias_correlation_time>60</dynamic_bias_correlation_time>"
)


def receiver(name: str, noise: str) -> str:
    return f"""<sensor name="{name}" type="navsat"><update_rate>5</update_rate><topic>{name}</topic><navsat>
      <position_sensing><horizontal>{noise}</horizontal></position_sensing></navsat></sensor>"""


WORLD = f"""<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>
  <spherical_coordinates><latitude_deg>47.4</latitude_deg><longitude_deg>8.5</longitude_deg><elevation>488</elevation>
  </spherical_coordinates>
  <model name="car"><pose>{RADIUS} 0 0 0 0 1.5707963</pose><link name="body">
    {receiver("white", NOISE.format(0.8, ""))}{receiver("wandering", NOISE.format(0.1, WANDER))}
  </link></model></world></sdf>"""


def metres(message: object, origin: tuple[float, float]) -> tuple[float, float]:
    """East and north of the origin, by the radii of curvature there."""
    latitude, longitude = origin
    north = math.radians(message.latitude - latitude) * 6370140.0  # type: ignore[attr-defined]
    east = math.radians(message.longitude - longitude) * 6389719.0 * math.cos(math.radians(latitude))  # type: ignore[attr-defined]
    return east, north


def main(out: Path) -> None:
    found: dict[str, list[tuple[float, float]]] = {"truth": [], "white": [], "wandering": []}
    with simkit.load(WORLD, seed=2) as sim:
        eyes = {name: sim.sensor(f"car::body::{name}") for name in ("white", "wandering")}
        car = sim.model("car")
        for _ in range(118):
            angle = sim.time * SPEED / RADIUS
            car.set_pose(
                simkit.Pose.from_rpy(RADIUS * math.cos(angle), RADIUS * math.sin(angle), 0, 0, 0, angle + 1.5708)
            )
            sim.run(0.2)
            for name, eye in eyes.items():
                found[name].append(metres(eye.latest, (47.4, 8.5)))
            found["truth"].append(metres(eyes["white"].truth, (47.4, 8.5)))
    figure, axes = plots.figure("Satellite navigation: a circle of 30 m, five fixes a second", columns=2)
    true = np.array(found["truth"])
    for ax, (name, title) in zip(
        axes, (("white", "white noise, 0.8 m"), ("wandering", "0.1 m and a bias that wanders")), strict=True
    ):
        values = np.array(found[name])
        ax.plot(*true.T, color=plots.TRUTH, label="truth")
        ax.plot(*values.T, ".", markersize=4, label="fix")
        ax.set_title(title)
        ax.set_aspect("equal")
        ax.set_xlabel("east [m]")
        ax.legend(loc="center")
    axes[0].set_ylabel("north [m]")
    plots.save(figure, out)


if __name__ == "__main__":
    plots.run(main, "navsat.png")
