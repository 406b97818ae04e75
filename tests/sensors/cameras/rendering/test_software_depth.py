"""Depths and ids of the software renderer beside the geometry of the shapes; no OpenGL is needed."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from drawn_models import Depths, draw, metres, model, rays, view

from simkit.sensors.cameras.rendering.software.software_renderer import SoftwareRenderer
from simkit.sensors.cameras.rendering.view import Shot, View

EYE = (0.0, 0.0, 0.0)
AHEAD = (1.0, 0.0, 0.0)
DEPTH = Shot(view(), depth=True)


def depths(bodies: str, shot: Shot = DEPTH, assets: str = "", **more: object) -> Depths:
    return metres(draw(SoftwareRenderer, model(bodies, assets), shot, EYE, AHEAD, **more))  # type: ignore[arg-type]


def nearer_root(a: Depths, b: Depths, c: float) -> Depths:
    """Return the nearer solution of a·z² + 2·b·z + c = 0, infinite without one."""
    inside = b * b - a * c
    return np.where(inside > 0, (-b - np.sqrt(np.abs(inside))) / a, np.inf)


def compare(found: Depths, expected: Depths, share: float = 0.0) -> None:
    """Compare depths where both show the shape; its edge may differ in a share of the pixels."""
    both = np.isfinite(found) & np.isfinite(expected)
    assert both.sum() > 200
    assert (np.isfinite(found) != np.isfinite(expected)).mean() <= share
    # 1e-6: single precision of the raw depths
    np.testing.assert_allclose(found[both], expected[both], rtol=2e-6)


@pytest.mark.parametrize("distance", [0.3, 3.0, 50.0])
def test_a_wall_has_the_same_depth_at_every_pixel(distance: float) -> None:
    found = depths(f'<geom type="box" size="1 90 90" pos="{1 + distance} 0 0"/>')
    np.testing.assert_allclose(found, distance, rtol=1e-6)


def test_a_floor_below_the_camera_is_a_plane_up_to_the_horizon() -> None:
    found = depths('<geom type="plane" size="0 0 1" pos="0 0 -0.2"/>')
    _, up = rays(DEPTH.view)
    expected = np.where(up < 0, -0.2 / np.minimum(up, -1e-9), np.inf)
    seen = expected < 20.0
    # 0.05 mm + 0.01 %: a row of pixels near the horizon spans metres
    np.testing.assert_allclose(found[seen], expected[seen], atol=5e-5, rtol=1e-4)
    assert np.isinf(found[up > 0]).all()


@pytest.mark.parametrize(("size", "position"), [("0.4", "2 0.3 0.1"), ("1.5", "4 0 0"), ("0.05", "0.5 0 0")])
def test_a_sphere_has_the_depth_of_a_sphere_and_not_of_its_triangles(size: str, position: str) -> None:
    found = depths(f'<geom type="sphere" size="{size}" pos="{position}"/>')
    x, y = rays(DEPTH.view)
    centre, radius = np.array(position.split(), float), float(size)
    # the frame of the view: x forward, y left, z up
    b = -(centre[0] - x * centre[1] + y * centre[2])
    compare(found, nearer_root(1 + x * x + y * y, b, float(centre @ centre) - radius**2), share=0.003)


def test_an_upright_cylinder_is_round() -> None:
    found = depths('<geom type="cylinder" size="0.5 5" pos="2 0 0"/>')
    x, _ = rays(DEPTH.view)
    compare(found, nearer_root(1 + x * x, np.full(x.shape, -2.0), 4 - 0.25), share=0.02)


def test_a_capsule_is_a_cylinder_with_two_half_spheres() -> None:
    found = depths('<geom type="capsule" size="0.3 0.4" pos="2 0 0"/>')
    x, y = rays(DEPTH.view)
    side = nearer_root(1 + x * x, np.full(x.shape, -2.0), 4 - 0.09)
    expected = np.where(np.abs(side * y) <= 0.4, side, np.inf)
    for up in (0.4, -0.4):
        cap = nearer_root(1 + x * x + y * y, -(2 + y * up), 4 + up * up - 0.09)
        expected = np.where(np.isinf(expected) & (cap * y * np.sign(up) > 0.4), cap, expected)
    compare(found, expected, share=0.005)


def test_an_ellipsoid_that_is_turned_keeps_its_surface() -> None:
    found = depths('<geom type="ellipsoid" size="0.2 0.4 0.6" pos="2 0 0" euler="0 0 90"/>')
    x, y = rays(DEPTH.view)
    scale = np.array((0.4, 0.2, 0.6)) ** -2.0  # after the turn
    compare(found, nearer_root(scale[0] + scale[1] * x * x + scale[2] * y * y, np.full(x.shape, -2 * scale[0]),
                               4 * scale[0] - 1), share=0.005)  # fmt: skip


def test_a_height_field_has_the_depth_of_its_triangles() -> None:
    field = '<hfield name="h" nrow="2" ncol="2" size="1 1 1 0.1" elevation="0 1 0 1"/>'
    # a ramp from 0 at x = 2 to 1 at x = 4, seen from its foot: z = (x - 2) / 2 - 0.3
    found = depths('<geom type="hfield" hfield="h" pos="3 0 -0.3"/>', assets=field)
    x, y = rays(DEPTH.view)
    on_ramp = (np.abs(x) < 0.2) & (y > -0.1) & (y < 0.15)
    expected = -1.3 / (y - 0.5)  # depth · y = (depth - 2) / 2 - 0.3
    np.testing.assert_allclose(found[on_ramp], expected[on_ramp], rtol=1e-5)


def test_an_image_with_its_middle_aside_shows_the_same_depths() -> None:
    wall = '<geom type="box" size="1 90 90" pos="4 0 0" euler="0 0 20"/>'
    wide = depths(wall, Shot(view(160, 120, -0.6, 0.6), depth=True))
    aside = depths(wall, Shot(View(80, 120, 0.0, 0.6, -0.45, 0.45, DEPTH.view.near, DEPTH.view.far), depth=True))
    np.testing.assert_allclose(aside, wide[:, 80:], rtol=1e-5)


def test_depths_far_from_the_origin_of_the_world_are_as_exact_as_near_it() -> None:
    world = model('<geom type="box" size="1 9 9" pos="100004 -50000 20"/>')
    found = metres(draw(SoftwareRenderer, world, DEPTH, (100000.0, -50000.0, 20.0), (100001.0, -50000.0, 20.0)))
    # the engine itself stores positions in single precision: 8 mm at 100 km
    np.testing.assert_allclose(found, 3.0, atol=8e-3)


def test_a_shape_around_the_camera_is_invisible_from_inside() -> None:
    found = depths('<geom type="sphere" size="0.3"/><geom type="box" size="1 90 90" pos="4 0 0"/>')
    np.testing.assert_allclose(found, 3.0, rtol=1e-6)


def test_a_long_box_that_begins_behind_the_camera_has_no_holes() -> None:
    found = depths('<geom type="box" size="30 0.5 0.1" pos="0 0 -0.5"/>')
    x, y = rays(DEPTH.view)
    with np.errstate(divide="ignore"):
        expected = np.where(y < 0, -0.4 / y, np.inf)
    on_top = (np.abs(expected * x) < 0.49) & (expected < 29)
    assert on_top.sum() > 2000
    np.testing.assert_allclose(found[on_top], expected[on_top], rtol=1e-5)


def test_depths_end_at_the_far_plane() -> None:
    seen = view(far=10.0)
    found = depths('<geom type="box" size="1 90 90" pos="13 0 0"/><geom type="sphere" size="1" pos="8 0 0"/>',
                   Shot(seen, depth=True))  # fmt: skip
    assert np.isinf(found[0, 0])
    assert found[60, 80] == pytest.approx(7.0, abs=2e-3)


def test_glass_has_ids_but_no_depth() -> None:
    bodies = '<geom type="box" size=".1 1 1" pos="2 0 0" rgba="0 1 0 .4"/><geom type="box" size="1 9 9" pos="4 0 0"/>'
    assert depths(bodies)[60, 80] == pytest.approx(3.0)
    found = draw(SoftwareRenderer, model(bodies), Shot(view(), ids=True), EYE, AHEAD).ids
    assert found is not None
    assert found[60, 80] == 0
    assert found[0, 0] == 1


@pytest.mark.parametrize("quality", ["fast", "gazebo"])
def test_depths_alone_and_beside_colours_are_equal(quality: str) -> None:
    bodies = '<geom type="plane" size="0 0 1" pos="0 0 -1"/><geom type="sphere" size=".5" pos="3 0 0"/>'
    alone = depths(bodies, Shot(view(), depth=True, sharp=True), quality=quality)
    # the floor is divided more finely where it shines, so only its rounding differs
    np.testing.assert_allclose(alone, depths(bodies, quality=quality), rtol=1e-6)


def test_ids_name_the_geom_at_each_pixel() -> None:
    world = model('<geom type="box" size="1 90 90" pos="6 0 0"/><geom type="sphere" size=".5" pos="3 0 0"/>')
    found = draw(SoftwareRenderer, world, Shot(view(), ids=True), EYE, AHEAD).ids
    assert found is not None
    assert found[60, 80] == 1
    assert found[5, 5] == 0
    assert set(np.unique(found)) == {0, 1}


def test_a_cloth_is_drawn() -> None:
    cloth = """<mujoco><worldbody><light type="directional" dir="1 0 -1"/>
      <flexcomp name="cloth" type="grid" count="4 4 1" spacing=".4 .4 .4" pos="3 0 0" euler="0 90 0" dim="2"
        radius=".01" rgba="1 0 0 1"><edge equality="false"/></flexcomp></worldbody></mujoco>"""
    world = mujoco.MjModel.from_xml_string(cloth)
    found = draw(SoftwareRenderer, world, DEPTH, EYE, AHEAD)
    assert found.colours is not None
    red, green, _ = found.colours[60, 80].astype(int)
    assert red > 2 * green
    # the middle of the cloth, within its thickness
    assert metres(found)[60, 80] == pytest.approx(3.0, abs=0.011)


def test_a_cable_is_drawn_as_tubes() -> None:
    cable = """<mujoco><worldbody><light type="directional" dir="1 0 -1"/>
      <flexcomp name="cable" type="grid" count="6 1 1" spacing=".2 .2 .2" pos="3 0 0" euler="0 0 90" dim="1"
        radius=".05" rgba="1 0 0 1"><edge equality="false"/></flexcomp></worldbody></mujoco>"""
    world = mujoco.MjModel.from_xml_string(cable)
    found = metres(draw(SoftwareRenderer, world, DEPTH, EYE, AHEAD))
    # half a pixel beside the middle, on one of 24 sides
    assert found[60, 80] == pytest.approx(2.951, abs=0.001)
    assert np.isinf(found[50, 80])


def test_a_skin_is_drawn_where_its_bones_are() -> None:
    skin = """<mujoco><worldbody><light type="directional" dir="1 0 -1"/>
      <body name="a" pos="3 0 0"><geom size=".01" group="5"/></body></worldbody>
      <deformable><skin name="s" rgba="1 0 0 1" vertex="0 -.5 -.5  0 .5 -.5  0 .5 .5  0 -.5 .5" face="0 2 1 0 3 2">
      <bone body="a" bindpos="0 0 0" bindquat="1 0 0 0" vertid="0 1 2 3" vertweight="1 1 1 1"/></skin></deformable>
      </mujoco>"""
    found = metres(draw(SoftwareRenderer, mujoco.MjModel.from_xml_string(skin), DEPTH, EYE, AHEAD))
    np.testing.assert_allclose(found[50:70, 70:90], 3.0, rtol=1e-6)
