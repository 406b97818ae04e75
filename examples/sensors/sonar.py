"""A sonar that is driven past a pole in front of a wall: what it reads, and what the geometry of its cone says."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from plots import BLUE, TRUTH, figure, run, save, stamps

import simkit

WALL, POLE, RADIUS = 3.0, 1.5, 0.05  # distances of the wall and of the pole's axis, radius of the pole [m]
SPEED = 0.2  # [m/s]
WORLD = f"""
<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>
  <model name="wall"><static>true</static><pose>{WALL + 0.1} 0 0 0 0 0</pose><link name="l"><collision name="c">
    <geometry><box><size>0.2 8 2</size></box></geometry></collision></link></model>
  <model name="pole"><static>true</static><pose>{POLE} 0 0 0 0 0</pose><link name="l"><collision name="c">
    <geometry><cylinder><radius>{RADIUS}</radius><length>2</length></cylinder></geometry></collision></link></model>
  <model name="cart"><pose>0 -0.6 0 0 0 0</pose><link name="l">
    <sensor name="sonar" type="sonar">
      <preset>HC-SR04</preset>
      <sonar><axis>1 0 0</axis></sonar>
    </sensor>
  </link></model>
</world></sdf>
"""


def drive() -> tuple[np.ndarray, np.ndarray, float]:
    """Places across the pole [m], ranges there [m], half angle of the cone [rad]."""
    with simkit.load(WORLD, seed=1) as sim:
        sonar = sim.subscribe(sim.sensor("cart::l::sonar").topic)
        sim.model("cart").set_velocity(linear=(0, SPEED, 0), angular=(0, 0, 0))
        sim.run(1.2 / SPEED)
        places = -0.6 + SPEED * stamps(sonar.messages)
        return places, np.array([m.range for m in sonar.messages]), sonar.latest.field_of_view / 2


def nearest_in_cone(places: np.ndarray, half_angle: float) -> np.ndarray:
    """The nearest of wall and pole in a level section of the cone [m]."""
    angles = np.linspace(-half_angle, half_angle, 2001)
    across = places[:, None] * np.cos(angles)
    along = POLE * np.cos(angles) - places[:, None] * np.sin(angles)
    miss = np.abs(POLE * np.sin(angles) + across)
    with np.errstate(invalid="ignore"):
        pole = along - np.sqrt(RADIUS**2 - miss**2)
    return np.minimum(np.nanmin(np.where(miss < RADIUS, pole, np.inf), axis=1), WALL)


def main(out: Path) -> None:
    places, ranges, half_angle = drive()
    exact = np.linspace(-0.6, 0.6, 1200)
    fig, ax = figure(f"HC-SR04, cone of {math.degrees(2 * half_angle):.0f}°, past a pole of {2e3 * RADIUS:.0f} mm")
    ax.plot(exact, nearest_in_cone(exact, half_angle), color=TRUTH, label="nearest point in the cone")
    ax.plot(places, ranges, ".", color=BLUE, label="reading")
    ax.set(xlabel="place across the pole [m]", ylabel="range [m]", ylim=(0, 3.3))
    ax.legend(loc="lower left")
    save(fig, out)


if __name__ == "__main__":
    run(main, "sonar.png")
