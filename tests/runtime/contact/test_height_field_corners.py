"""Boxes that are smaller than a cell of a height map stand on their corners."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import simkit

CELLS, CELL, HEIGHT = 16, 0.15, 0.3  # [m]


BOX = "<box><size>0.02 0.02 0.4</size></box>"


def load(
    folder: Path, levels: np.ndarray, places: list[tuple[float, float, float]], surface: str = ""
) -> simkit.Simulation:
    """Load a height map of grey values with one slender model at each place."""
    from PIL import Image

    Image.fromarray(levels.astype(np.uint8)).save(folder / "ground.png")
    side = CELLS * CELL
    models = "".join(
        f"""<model name="plant_{i}"><pose>{x} {y} {z} 0 0 {0.7 * i}</pose><link name="l"><inertial>
        <pose>0 0 0.01 0 0 0</pose><mass>0.3</mass>
        <inertia><ixx>0.0033</ixx><iyy>0.0033</iyy><izz>0.00002</izz></inertia></inertial>
        <collision name="c"><pose>0 0 0.2 0 0 0</pose><geometry>{BOX}</geometry>{surface}</collision></link></model>"""
        for i, (x, y, z) in enumerate(places)
    )
    path = folder / "world.sdf"
    path.write_text(f"""<sdf version="1.9"><world name="w">
      <physics type="ode"><max_step_size>0.005</max_step_size></physics>
      <model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><heightmap>
      <uri>ground.png</uri><size>{side} {side} {HEIGHT}</size></heightmap></geometry></collision></link></model>
      {models}</world></sdf>""")
    return simkit.load(path)


def test_slender_plants_stand_anywhere_on_a_field(tmp_path: Path) -> None:
    """In the middle of a cell, at its border and on its diagonal; the engine has one contact a cell."""
    flat = np.full((CELLS + 1, CELLS + 1), 127)
    flat[0, 0] = 0
    flat[-1, -1] = 255
    level = HEIGHT * 127 / 255
    places = [(0.03 * i + 0.01, 0.02 * i - 0.2, level + 1e-4) for i in range(12)]
    with load(tmp_path, flat, places) as sim:
        sim.run(3.0)
        for i, (x, y, _) in enumerate(places):
            assert sim.model(f"plant_{i}").pose.position == pytest.approx((x, y, level), abs=0.002)


def test_a_box_slides_down_a_ramp_over_the_borders_of_cells(tmp_path: Path) -> None:
    """With friction 0.05 on the slope 1 : 8, a box slides g (sin a - mu cos a) t²/2 along the slope."""
    ramp = np.tile(np.linspace(0, 255, CELLS + 1), (CELLS + 1, 1)).round()
    surface = "<surface><friction><ode><mu>0.05</mu><mu2>0.05</mu2></ode></friction></surface>"
    slope = HEIGHT / (CELLS * CELL)
    with load(tmp_path, ramp, [(0.8, 0.1, (0.8 + 0.5 * CELLS * CELL) * slope + 0.003)], surface) as sim:
        sim.run(0.5)
        start, speed = np.array(sim.model("plant_0").pose.position), sim.link("plant_0::l").linear_velocity
        sim.run(0.5)
        way = np.linalg.norm(np.array(sim.model("plant_0").pose.position) - start)
        angle = np.arctan(slope)
        expected = 0.5 * np.linalg.norm(speed) + 9.8 * (np.sin(angle) - 0.05 * np.cos(angle)) * 0.5**2 / 2
    assert way == pytest.approx(expected, rel=0.1)


def test_a_reset_and_a_snapshot_repeat_the_contacts_bit_for_bit(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    levels = rng.integers(100, 140, (CELLS + 1, CELLS + 1))
    levels[0, 0], levels[-1, -1] = 0, 255
    with load(tmp_path, levels, [(0.1 * i - 0.3, 0.07 * i, 0.2) for i in range(6)]) as sim:
        sim.run(0.3)
        state = sim.snapshot()
        sim.run(0.5)
        poses = [sim.model(f"plant_{i}").pose for i in range(6)]
        sim.restore(state)
        sim.run(0.5)
        assert [sim.model(f"plant_{i}").pose for i in range(6)] == poses
        sim.reset()
        sim.run(0.8)
        assert [sim.model(f"plant_{i}").pose for i in range(6)] == poses
        assert min(pose.position[2] for pose in poses) > HEIGHT * 90 / 255
