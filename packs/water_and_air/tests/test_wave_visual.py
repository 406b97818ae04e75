"""Waves in pictures: the tiles lie on the surface and replace the flat visual."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

import simkit

SEA = """<sdf version="1.9"><world name="w"><model name="sea"><static>true</static><link name="l"><visual name="v">
<geometry><plane><size>100 100</size></plane></geometry>
<material><ambient>1 0 0 1</ambient><diffuse>1 0 0 1</diffuse></material>
<plugin filename="libWaveVisual.so" name="vrx::WaveVisual"><shader><vertex>a.glsl</vertex></shader><wavefield><wave>
<model>CWR</model><number>1</number><amplitude>0.5</amplitude><period>5</period><tau>0</tau></wave></wavefield>
</plugin></visual></link></model></world></sdf>"""


def tiles(sim: simkit.Simulation) -> list[mujoco.MjvGeom]:
    (plugin,) = [p for p in sim.engine.structure.all_plugins() if hasattr(p, "draw_shapes")]
    scene = mujoco.MjvScene(sim.mj_model, 10_000)
    plugin.draw_shapes(scene, np.array((0.0, 0.0, 3.0)))
    return list(scene.geoms[: scene.ngeom])


def test_the_tiles_lie_on_the_waves() -> None:
    with simkit.load(SEA) as sim:
        assert not [d for d in sim.diagnostics if d.severity != "note"]
        sim.run(2.0)
        wavenumber = (2 * np.pi / 5) ** 2 / 9.8
        places = np.array([tile.pos for tile in tiles(sim)])
        phases = wavenumber * places[:, 0] - 2 * np.pi / 5 * 2.0
        assert places[:, 2] == pytest.approx(0.5 * np.cos(phases), abs=1e-5)
        normals = np.array([np.asarray(tile.mat).reshape(3, 3)[:, 2] for tile in tiles(sim)])
        slopes = -normals[:, 0] / normals[:, 2]
        assert slopes == pytest.approx(-0.5 * wavenumber * np.sin(phases), abs=0.01)
        assert normals[:, 1] == pytest.approx(np.zeros(len(normals)), abs=0.01)


def test_a_picture_shows_the_waves_instead_of_the_visual() -> None:
    with simkit.load(SEA) as sim:
        image = simkit.render_view(sim, 64, 48, eye=(0.0, 0.0, 5.0), target=(3.0, 0.0, 0.0))
        red, green, blue = np.asarray(image)[24, 32].tolist()[:3]
        assert blue > red
        assert green > red
