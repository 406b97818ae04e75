"""The plugin chapter: write the plugin, name it in a world, see its effect."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import simkit

CHAPTER = Path(__file__).resolve().parents[2] / "examples" / "plugin_chapter"
WORLDS = sorted(CHAPTER.glob("*.sdf"))
GZ_HELLO = """<?xml version="1.0" ?>
<sdf version="1.4">
  <world name="default">
    <include><uri>model://ground_plane</uri></include>
    <include><uri>model://sun</uri></include>
    <plugin name="gazebo_tutorials" filename="libgazebo_tutorials.so"/>
  </world>
</sdf>
"""


def opened(name: str, **options: object) -> simkit.Simulation:
    return simkit.load(CHAPTER / f"{name}.sdf", plugin_paths=[CHAPTER], **options)  # type: ignore[arg-type]


@pytest.mark.parametrize("world", WORLDS, ids=lambda path: path.stem)
def test_each_world_runs_without_a_warning_and_repeats_after_a_reset(world: Path) -> None:
    with simkit.load(world, plugin_paths=[CHAPTER]) as sim:
        sim.run(1.2)
        assert [str(d) for d in sim.diagnostics if d.severity != "note"] == []
        first = sim.mj_data.qpos.tobytes()
        sim.reset()
        sim.run(1.2)
        assert sim.mj_data.qpos.tobytes() == first


def test_hello(capsys: pytest.CaptureFixture[str]) -> None:
    with opened("hello"):
        assert capsys.readouterr().out == "Hello, World!\n"


def test_a_world_of_gazebo_classic_that_names_the_tutorials_library_says_hello(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with simkit.load(GZ_HELLO, plugin_paths=[CHAPTER]) as sim:
        sim.run(0.1)
    assert capsys.readouterr().out == "Hello, World!\n"


def test_the_box_is_pushed_at_a_steady_velocity() -> None:
    with opened("push") as sim:
        sim.run(2.0)
        x, y, z = sim.model("box").pose.position
    # friction takes mu g dt = 9.8 mm/s in each step after the push
    assert x == pytest.approx(2.0 * (0.3 - 0.0098), rel=1e-3)
    assert (y, z) == pytest.approx((0.0, 0.25), abs=0.01)


def test_another_velocity_in_the_file_pushes_it_elsewhere() -> None:
    text = (CHAPTER / "push.sdf").read_text().replace("0.3 0 0</vel", "0 -1 0</vel")
    with simkit.load(text, plugin_paths=[CHAPTER]) as sim:
        sim.run(1.0)
        assert sim.model("box").pose.position[1] == pytest.approx(-1.0 + 0.0098, rel=1e-3)


def test_balls_drop_and_the_oldest_goes() -> None:
    with opened("factory") as sim:
        before = set(sim.models)
        sim.run(1.25)
        # a quarter of a second of free fall
        assert sim.model("ball_0").pose.position[2] == pytest.approx(1 - 0.5 * 9.8 * 0.25**2, abs=0.01)
        sim.run(0.8)
        assert sim.model("ball_0").pose.position[2] == pytest.approx(0.1, abs=0.01)  # it lies on the ground
        sim.run(3.0)
        assert set(sim.models) - before == {"ball_2", "ball_3", "ball_4"}
        sim.reset()
        assert set(sim.models) == before


def test_the_ball_floats_away_once_gravity_is_another_and_the_light_is_dim() -> None:
    with opened("edit") as sim:
        bright = np.array(sim.mj_model.light_diffuse[0])
        sim.run(1.0)
        assert sim.model("ball").pose.position == pytest.approx([0, 0, 0.1], abs=1e-3)
        sim.run(2.0)
        x, _, z = sim.model("ball").pose.position
        assert (x, z - 0.1) == pytest.approx((0.5 * 0.1 * 4, 0.5 * 0.5 * 4), rel=0.02)
        assert sim.mj_model.light_diffuse[0] == pytest.approx(0.25 * bright)


def test_the_beam_swings_until_its_damping_is_tuned() -> None:
    with opened("tune") as sim:
        angles = sim.subscribe("/angle")
        sim.publish("/angle/set", {"data": 1.0})
        sim.run(3.0)
        swinging = np.array([m.data for m in angles.messages])
        # stiffness 5, damping 0.1, inertia 0.1: the overshoot is exp(-pi zeta / sqrt(1 - zeta^2)), zeta = 0.0707
        zeta = 0.1 / (2 * math.sqrt(5 * 0.1))
        assert swinging.max() == pytest.approx(1 + math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2)), abs=0.01)
        (node,) = [n for n, parameters in sim.communication.parameters.items() if "d_gain" in parameters]
        sim.set_parameter(node, "d_gain", 2 * math.sqrt(5 * 0.1))  # critical
        sim.run(2.0)
        angles = sim.subscribe("/angle")
        sim.publish("/angle/set", {"data": -1.0})
        sim.run(3.0)
        tuned = np.array([m.data for m in angles.messages])
        assert tuned.min() > -1.001 and tuned[-1] == pytest.approx(-1.0, abs=1e-3)


def test_the_sun_crosses_the_sky_and_sensor_and_visual_follow() -> None:
    with opened("sun") as sim:
        heights = sim.subscribe("/sun/elevation")
        face = sim.visual("dial::plate::face")
        for hour, elevation in ((3, math.pi / 4), (6, math.pi / 2), (9, math.pi / 4)):
            sim.run(hour - sim.time)
            assert heights.latest is not None and heights.latest.data == pytest.approx(elevation, abs=0.02)
            shown = sim.mj_model.geom_rgba[face.geoms[0]]
            assert shown == pytest.approx([math.sin(elevation), 0.8 * math.sin(elevation), 0, 1], abs=0.02)
        assert len(heights.messages) == 91  # ten a second, and one after the first step
        assert sim.light("sun").pose.position[0] < 0  # in the west
