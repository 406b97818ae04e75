"""Images of the software renderer beside those of OpenGL, for one world with all kinds of shapes and materials.

Measured differences are in docs/rendering.md; the limits here are about twice as large.
"""

from __future__ import annotations

import mujoco
import numpy as np
import numpy.typing as npt
import pytest
from drawn_models import SUN, draw, metres, model, view
from renderer import NEEDS_GL

from simkit.scene import Surroundings
from simkit.scene.world import Fog
from simkit.sensors.cameras.rendering.renderer import Renderer
from simkit.sensors.cameras.rendering.software.software_renderer import SoftwareRenderer
from simkit.sensors.cameras.rendering.view import DrawnView, Shot

pytestmark = NEEDS_GL

EYE = (-4.0, -2.5, 2.6)
TARGET = (0.0, 0.0, 0.4)
WIDE = view(320, 240, -0.6, 0.5)
ASSETS = """
  <texture name="board" type="2d" builtin="checker" rgb1="1 .2 .1" rgb2=".1 .3 1" width="64" height="64"/>
  <texture name="cube" type="cube" builtin="gradient" rgb1="1 .2 .1" rgb2=".1 .3 1" width="64" height="64"/>
  <material name="board" texture="board" texrepeat="2 3" specular=".3" shininess=".4"/>
  <material name="metres" texture="board" texrepeat="2 2" texuniform="true"/>
  <material name="cube" texture="cube"/> <material name="cube metres" texture="cube" texuniform="true"/>
  <material name="shine" specular="1" shininess=".15" rgba=".2 .6 .3 1"/>
  <material name="glow" emission=".8" rgba=".8 .1 .3 1"/>
  <hfield name="hills" nrow="5" ncol="6" size="1 .8 .5 .1"
    elevation="0 0 1 2 0 1  0 2 3 1 1 0  1 0 0 2 3 1  2 1 0 1 0 0  0 1 2 2 1 0"/>
  <mesh name="mapped" vertex="0 0 0 1 0 0 0 1 0 0 0 1" texcoord="0 0 1 0 0 1 1 1" face="0 2 1 0 1 3 0 3 2 1 2 3"/>
  <mesh name="smooth" builtin="sphere" params="3" scale=".3 .3 .3"/>
  <mesh name="edged" builtin="cone" params="7 0.8" scale=".3 .3 .3"/>"""
SHAPES = """
  <geom type="plane" size="4 4 .5" material="metres"/>
  <geom type="box" size=".3 .4 .5" pos="-1 -1 .5" material="board" euler="0 0 20"/>
  <geom type="sphere" size=".4" pos="-1 .5 .4" material="metres"/>
  <geom type="box" size=".3 .3 .3" pos="0 1.2 .3" material="cube" euler="10 0 30"/>
  <geom type="ellipsoid" size=".3 .4 .5" pos="0 -.4 .5" material="cube metres"/>
  <geom type="capsule" size=".2 .4" pos="1 -1 .6" material="board" euler="40 0 0"/>
  <geom type="cylinder" size=".3 .4" pos="1 .6 .4" material="shine"/>
  <geom type="sphere" size=".2" pos=".4 .2 .9" material="glow"/>
  <geom type="hfield" hfield="hills" pos="2.5 0 .1" rgba=".3 .5 .2 1"/>
  <geom type="mesh" mesh="mapped" pos="-2 1.2 .1" material="board"/>
  <geom type="mesh" mesh="smooth" pos="-2 -.2 .3" material="shine"/>
  <geom type="mesh" mesh="edged" pos="-2.4 .4 .3" rgba=".9 .6 .1 1"/>
  <geom type="box" size=".02 .6 .6" pos="-.5 -.2 .6" rgba=".2 .8 .9 .4"/>"""
TWO = (
    SUN
    + """<light type="spot" pos="-2 -2 3" dir="1 1 -1.4" cutoff="60" exponent="2" attenuation=".6 .1 .02"
  diffuse=".4 .4 .3" specular=".3 .3 .3"/>"""
)


def both(shot: Shot, lights: str = SUN, bodies: str = SHAPES, **more: object) -> tuple[DrawnView, DrawnView]:
    world = model(bodies, ASSETS, lights)
    gl, software = (draw(kind, world, shot, EYE, TARGET, **more) for kind in (Renderer, SoftwareRenderer))  # type: ignore[arg-type]
    return gl, software


def difference(pair: tuple[DrawnView, DrawnView]) -> npt.NDArray[np.int64]:
    gl, software = (found.colours for found in pair)
    assert gl is not None
    assert software is not None
    return np.abs(gl.astype(int) - software)


@pytest.mark.parametrize(
    ("lights", "surroundings", "quality", "mean", "share"),
    [
        (SUN, Surroundings(), "fast", 0.5, 0.012),
        ("", Surroundings(), "fast", 0.5, 0.012),
        (TWO, Surroundings(), "fast", 1.5, 0.03),
        (SUN, Surroundings(sky=True, fog=Fog("exp", (0.7, 0.7, 0.9, 1.0), density=0.2)), "fast", 0.3, 0.01),
        (SUN, Surroundings(fog=Fog("exp2", (0.7, 0.7, 0.9, 1.0), density=0.2)), "fast", 0.3, 0.01),
        (SUN, Surroundings(fog=Fog("linear", (0.7, 0.7, 0.9, 1.0), 2.0, 6.0)), "fast", 0.3, 0.01),
        (SUN, Surroundings(), "gazebo", 1.6, 0.06),
    ],
    ids=["sun", "no light", "sun and spot", "fog and sky", "fog exp2", "fog linear", "shadows"],
)
def test_colours_are_those_of_opengl(
    lights: str, surroundings: Surroundings, quality: str, mean: float, share: float
) -> None:
    found = difference(both(Shot(WIDE), lights, surroundings=surroundings, quality=quality))
    assert found.mean() < mean
    assert (found.max(axis=2) > 8).mean() < share


def test_depths_of_flat_shapes_are_those_of_opengl() -> None:
    flat = "\n".join(line for line in SHAPES.splitlines() if "box" in line or "plane" in line or "mesh" in line)
    shot = Shot(WIDE, depth=True, sharp=True)
    gl, software = (metres(found) for found in both(shot, bodies=flat))
    both_see = np.isfinite(gl) & np.isfinite(software)
    assert (np.isfinite(gl) != np.isfinite(software)).mean() < 0.002
    off = np.abs(gl[both_see] - software[both_see])
    assert np.quantile(off, 0.98) < 2e-4  # edges of shapes are the rest


def test_ids_are_those_of_opengl_away_from_edges() -> None:
    gl, software = (found.ids for found in both(Shot(WIDE, ids=True)))
    assert gl is not None
    assert software is not None
    inside = np.ones(gl.shape, bool)
    for axis in (0, 1):
        for step in (-1, 1):
            inside &= np.roll(gl, step, axis) == gl
    assert (gl != software)[inside].sum() <= 8
    assert set(np.unique(gl)) == set(np.unique(software))


def test_a_corner_is_flat_where_its_normal_is_far_from_the_faces() -> None:
    """MuJoCo draws a corner of a mesh with the face's normal if the cosine between the two is below 0.8."""
    found = difference(both(Shot(WIDE), bodies='<geom type="mesh" mesh="edged" pos="0 0 .5" rgba=".9 .6 .1 1"/>'))
    assert found.mean() < 0.05


def test_a_flex_is_drawn_as_by_opengl() -> None:
    cloth = """<mujoco><visual><headlight ambient=".3 .3 .3" diffuse="0 0 0" specular="0 0 0"/></visual>
      <worldbody><light type="directional" dir="1 .5 -1" diffuse=".6 .6 .6"/>
      <flexcomp name="cloth" type="grid" count="5 5 1" spacing=".3 .3 .3" pos="0 0 .5" dim="2" radius=".01"
        rgba="1 .3 .1 1"><edge equality="false"/></flexcomp></worldbody></mujoco>"""
    world = mujoco.MjModel.from_xml_string(cloth)
    pair = [draw(kind, world, Shot(WIDE), EYE, TARGET) for kind in (Renderer, SoftwareRenderer)]
    found = difference((pair[0], pair[1]))
    assert (found.max(axis=2) > 8).mean() < 0.01
