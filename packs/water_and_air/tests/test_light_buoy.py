"""Light buoys of VRX: the sequence of colours on the panels."""

from __future__ import annotations

import pytest

import simkit

PANEL = "<geometry><box><size>0.1 1 1</size></box></geometry><material><diffuse>1 1 1 1</diffuse></material>"


def world(second: str = "green", panel: str = "buoy::base::panel_2") -> str:
    return f"""<sdf version="1.9"><world name="w">
<physics name="p" type="ode"><max_step_size>0.01</max_step_size></physics>
<model name="buoy"><static>true</static><link name="base"><visual name="panel_1">{PANEL}
<plugin name="vrx::LightBuoyPlugin" filename="libLightBuoyPlugin.so"><color_1>red</color_1><color_2>{second}</color_2>
<color_3>yellow</color_3><visuals><visual>buoy::base::panel_1</visual><visual>{panel}</visual></visuals></plugin></visual>
<visual name="panel_2"><pose>0 2 0 0 0 0</pose>{PANEL}</visual></link></model></world></sdf>"""


def colours(sim: simkit.Simulation) -> list[tuple[float, ...]]:
    panels = [sim.visual(f"buoy::base::panel_{n}") for n in (1, 2)]
    return [tuple(sim.mj_model.geom_rgba[panel.geoms[0]][:3].tolist()) for panel in panels]


def test_all_panels_show_three_colours_and_two_seconds_of_black() -> None:
    with simkit.load(world()) as sim:
        seen = []
        for _ in range(6):
            sim.run(0.5)
            first, other = colours(sim)
            assert first == other
            seen.append(first)
            sim.run(0.5)
    assert seen == [(1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 0, 0), (0, 0, 0), (1, 0, 0)]


def test_reset_and_restore_show_the_colour_of_their_time() -> None:
    with simkit.load(world()) as sim:
        sim.run(1.5)
        snapshot = sim.snapshot()
        sim.run(1.0)
        assert colours(sim)[0] == (1, 1, 0)
        sim.restore(snapshot)
        assert colours(sim)[0] == (0, 1, 0)
        sim.reset()
        assert colours(sim)[0] == (1, 0, 0)


def test_a_missing_panel_is_reported() -> None:
    with simkit.load(world(panel="buoy::base::panel_3")) as sim:
        (found,) = [d for d in sim.diagnostics if d.code == "SK-PLUGIN-003"]
        assert "panel_3" in found.message


def test_an_unknown_colour_is_an_error() -> None:
    with pytest.raises(simkit.LoadError, match="purple"):
        simkit.load(world("purple"))
