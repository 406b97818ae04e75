"""Colours of the software renderer beside the light of OpenGL's formulas; no OpenGL is needed."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import numpy.typing as npt
import pytest
from drawn_models import draw, model, rays, view

import simkit
from simkit.scene import Surroundings
from simkit.scene.world import Fog
from simkit.sensors.cameras.overview_image import render_view
from simkit.sensors.cameras.rendering.appearance import QUALITIES, Appearance
from simkit.sensors.cameras.rendering.sky_and_fog import sky_colour
from simkit.sensors.cameras.rendering.software.software_renderer import SoftwareRenderer
from simkit.sensors.cameras.rendering.view import Shot, look_at

Colours = npt.NDArray[np.int64]
EYE = (0.0, 0.0, 0.0)
AHEAD = (1.0, 0.0, 0.0)
WALL = '<geom type="box" size="1 90 90" pos="4 0 0" rgba="{}"/>'


def colours(bodies: str, assets: str = "", lights: str = "", ambient: float = 0.0, **more: object) -> Colours:
    world = model(bodies, assets, lights, ambient)
    found = draw(SoftwareRenderer, world, Shot(view()), EYE, AHEAD, **more)  # type: ignore[arg-type]
    assert found.colours is not None
    return found.colours.astype(int)


def test_a_matt_wall_has_ambient_light_and_the_cosine_of_the_sun() -> None:
    sun = '<light type="directional" dir="1 0 -1" diffuse=".5 .5 .5" specular="0 0 0"/>'
    found = colours(WALL.format(".8 .4 .2 1"), lights=sun, ambient=0.25)
    expected = np.array((0.8, 0.4, 0.2)) * (0.25 + 0.5 * math.sqrt(0.5)) * 255
    np.testing.assert_allclose(found.reshape(-1, 3), np.broadcast_to(expected, (19200, 3)), atol=0.6)


def test_a_side_away_from_the_sun_has_ambient_light_only() -> None:
    sun = '<light type="directional" dir="-1 0 -1" diffuse=".9 .9 .9" specular="1 1 1"/>'
    np.testing.assert_allclose(colours(WALL.format("1 1 1 1"), lights=sun, ambient=0.4), 102, atol=0.6)


def test_a_spot_light_fades_with_the_distance_and_ends_at_its_cone() -> None:
    spot = """<light type="spot" pos="0 0 0" dir="1 0 0" cutoff="15" exponent="0" attenuation="1 0.5 0"
      diffuse="1 1 1" specular="0 0 0"/>"""
    found = colours('<geom type="plane" size="9 9 1" pos="3 0 0" zaxis="-1 0 0" rgba="1 1 1 1"/>', lights=spot)
    assert found[60, 80, 0] == pytest.approx(255 / (1 + 0.5 * 3), abs=2)
    right, up = rays(view())
    outside = np.hypot(right, up) > math.tan(math.radians(15)) + 0.15  # light between corners is interpolated
    assert found[outside].max() == 0


def test_a_highlight_lies_where_the_mirrored_sun_would_be() -> None:
    shine = '<material name="shine" specular="1" shininess=".5" rgba=".1 .1 .1 1"/>'
    sun = '<light type="directional" dir="1 0 0" diffuse="0 0 0" specular="1 1 1"/>'
    found = colours('<geom type="sphere" size="1" pos="4 0 0" material="shine"/>', shine, sun)[..., 0]
    x, y = rays(view())
    inside = 16 - 15 * (1 + x * x + y * y)
    depth = (4 - np.sqrt(np.maximum(inside, 0))) / (1 + x * x + y * y)
    point = np.stack((depth, -depth * x, depth * y), axis=-1)
    to_eye = -point / np.linalg.norm(point, axis=2, keepdims=True)
    half = to_eye - np.array((1.0, 0.0, 0.0))
    half /= np.linalg.norm(half, axis=2, keepdims=True)
    gloss = 255 * np.sum((point - (4, 0, 0)) * half, axis=2) ** 64
    seen = inside > 0.5
    off = np.abs(found[seen] - gloss[seen])
    # between the corners of a triangle the gloss is interpolated
    assert off.mean() < 2
    assert off.max() < 25
    assert found[60, 80] > 235


def test_a_glowing_material_needs_no_light() -> None:
    glow = '<material name="glow" emission="1" rgba=".8 .1 .3 1"/>'
    found = colours('<geom type="box" size="1 90 90" pos="4 0 0" material="glow"/>', glow, ambient=0.0)
    np.testing.assert_allclose(found[60, 80], (204, 25.5, 76.5), atol=0.6)


def test_a_texture_repeats_over_the_side_of_a_box() -> None:
    board = """<texture name="t" type="2d" builtin="checker" width="64" height="64" rgb1="1 1 1" rgb2="0 0 0"/>
      <material name="t" texture="t" texrepeat="1 2"/>"""
    found = colours('<geom type="box" size="1 1 1" pos="4 0 0" material="t"/>', board, ambient=1.0)[..., 0]
    # the side in front is 2 m wide at 3 m: 1 repeat of two squares across, 2 repeats of two squares up
    step = 160 / 1.2 * (1 / 3)  # pixels per metre
    for across in (-0.5, 0.5):
        squares = [found[round(60 - step * up), round(80 + step * across)] for up in (-0.75, -0.25, 0.25, 0.75)]
        assert sorted(squares) == [0, 0, 255, 255]
        assert squares[0] != squares[1]
    assert (
        found[round(60 - step * 0.75), round(80 + step * 0.5)] != found[round(60 - step * 0.75), round(80 - step * 0.5)]
    )


def test_glass_before_glass_is_blended_from_the_back_to_the_front() -> None:
    glass = "".join(
        f'<geom type="box" size=".01 9 9" pos="{x} 0 0" rgba="{colour} .5"/>'
        for x, colour in ((2, "0 1 0"), (1, "0 0 1"))
    )
    found = colours(glass + WALL.format("1 0 0 1"), ambient=1.0)
    np.testing.assert_allclose(found[60, 80], (255 / 4, 255 / 4, 255 / 2), atol=1.1)


@pytest.mark.parametrize(
    ("fog", "clear"),
    [
        (Fog("linear", (0, 0, 1, 1), 1.0, 5.0), 0.5),
        (Fog("exp", (0, 0, 1, 1), density=0.2), math.exp(-0.6)),
        (Fog("exp2", (0, 0, 1, 1), density=0.2), math.exp(-0.36)),
    ],
)
def test_fog_grows_with_the_depth_and_leaves_the_background(fog: Fog, clear: float) -> None:
    surroundings = Surroundings(background=(0.0, 1.0, 0.0, 1.0), fog=fog)
    wall = '<geom type="box" size="1 .5 .5" pos="4 0 0" rgba="1 0 0 1"/>'
    found = colours(wall, ambient=1.0, surroundings=surroundings)
    np.testing.assert_allclose(found[60, 80], (255 * clear, 0, 255 * (1 - clear)), atol=0.6)
    np.testing.assert_array_equal(found[0, 0], (0, 255, 0))


def test_the_sky_is_behind_all_shapes_and_has_its_colours_by_elevation() -> None:
    found = colours('<geom type="box" size="1 .5 .5" pos="4 0 0" rgba="1 0 0 1"/>', ambient=1.0,
                    surroundings=Surroundings(sky=True))  # fmt: skip
    np.testing.assert_array_equal(found[60, 80], (255, 0, 0))
    _, up = rays(view())
    for row in (3, 110):
        expected = 255 * np.array(sky_colour(math.degrees(math.atan(up[row, 80]))))
        np.testing.assert_allclose(found[row, 80], expected, atol=4)  # the rings are a few degrees high


# ---------------------------------------------------------------------- shadows and edges

HIGH = '<light type="directional" dir="0 0 -1" diffuse=".6 .6 .6" specular="0 0 0" castshadow="true"/>'
FLOOR = '<geom type="plane" size="0 0 1" pos="0 0 -1" rgba="1 1 1 1"/>'
LID = '<geom type="box" size=".5 .5 .05" pos="4 0 1.5"/>'


def test_a_box_above_a_floor_casts_a_shadow_of_its_size() -> None:
    found = colours(FLOOR + LID, lights=HIGH, ambient=0.3, quality="gazebo")[..., 0]
    right, up = rays(view())
    with np.errstate(divide="ignore"):
        depth = np.where(up < 0, -1 / up, np.inf)
    x, y = depth - 4, -depth * right
    inside = (np.abs(x) < 0.4) & (np.abs(y) < 0.4)
    beside = (up < -0.05) & ((np.abs(x) > 0.6) | (np.abs(y) > 0.6)) & (depth < 10)
    assert inside.sum() > 100
    np.testing.assert_allclose(found[inside], 255 * 0.3, atol=1)
    np.testing.assert_allclose(found[beside], 255 * 0.9, atol=1)


def test_fast_draws_no_shadows() -> None:
    found = colours(FLOOR + LID, lights=HIGH, ambient=0.3)[..., 0]
    _, up = rays(view())
    np.testing.assert_allclose(found[up < -0.05], 255 * 0.9, atol=1)


def test_a_spot_light_casts_shadows_too() -> None:
    spot = HIGH.replace("directional", "spot").replace("dir=", 'pos="4 0 4" cutoff="60" exponent="0" dir=')
    lit, dark = (colours(FLOOR + lid, lights=spot, ambient=0.1, quality="gazebo")[..., 0] for lid in ("", LID))
    _, up = rays(view())
    below = np.argmin(np.abs(up[:, 0] + 0.25))
    assert dark[below, 80] == pytest.approx(25.5, abs=1)
    assert lit[below, 80] > 60


def test_edges_are_smooth_where_the_quality_has_several_samples() -> None:
    wall = '<geom type="box" size="1 90 90" pos="4 0 0" rgba="0 0 0 1"/>'
    edge = '<geom type="box" size=".1 3 .3" pos="2 0 0" euler="7 0 0" rgba="1 1 1 1"/>'
    fast, smooth = (colours(wall + edge, ambient=1.0, quality=name)[..., 0] for name in ("fast", "gazebo"))
    assert set(np.unique(fast)) == {0, 255}
    grey = (smooth > 0) & (smooth < 255)
    assert 150 < grey.sum() < 800
    assert set(np.unique(smooth)) <= {0, 64, 127, 128, 191, 255}  # four samples
    assert np.abs(fast.mean() - smooth.mean()) < 0.5


# ---------------------------------------------------------------------- shapes that pictures add


def test_shapes_that_pictures_add_are_drawn() -> None:
    kinds = mujoco.mjtGeom
    shapes = [
        (kinds.mjGEOM_ARROW, (0.05, 0.05, 1.0)), (kinds.mjGEOM_ARROW1, (0.05, 0.05, 1.0)),
        (kinds.mjGEOM_ARROW2, (0.05, 0.05, 0.5)), (kinds.mjGEOM_LINE, (3.0, 3.0, 0.5)),
        (kinds.mjGEOM_LINEBOX, (0.2, 0.2, 0.2)), (kinds.mjGEOM_TRIANGLE, (0.4, 0.4, 0.4)),
        (kinds.mjGEOM_CAPSULE, (0.1, 0.1, 0.2)), (kinds.mjGEOM_ELLIPSOID, (0.1, 0.2, 0.3)),
    ]  # fmt: skip
    for kind, size in shapes:

        def decorate(scene: mujoco.MjvScene, kind: int = int(kind), size: tuple[float, ...] = size) -> None:
            shape = scene.geoms[scene.ngeom]
            turn = np.array(((0.0, -0.8, 0.6), (1.0, 0.0, 0.0), (0.0, 0.6, 0.8)))
            red = np.array((1, 0, 0, 1), np.float32)
            mujoco.mjv_initGeom(shape, kind, np.array(size), np.array((2.0, 0.0, 0.0)), turn.ravel(), red)
            scene.ngeom += 1

        found = colours(WALL.format("0 0 1 1"), ambient=1.0, decorate=decorate)
        red = (found[..., 0] > 100) & (found[..., 2] < 100)
        assert red.sum() > 20, kind


def test_an_image_does_not_depend_on_the_images_before() -> None:
    """A renderer keeps triangles and shadow maps; what it keeps for one camera must not change another's image."""
    sun = HIGH.replace("0 0 -1", ".3 .2 -1")
    world = model(FLOOR + LID + '<geom type="sphere" size=".5" pos="3 1 0"/>', lights=sun)
    data = mujoco.MjData(world)
    mujoco.mj_forward(world, data)
    renderer = SoftwareRenderer(Appearance(Surroundings(), QUALITIES["gazebo"]))

    def image(x: float, y: float) -> npt.NDArray[np.uint8]:
        eye = np.array((x, y, 0.5))
        composition = renderer.composer.compose(world, data, eye, look_at(eye, np.array((4.0, 0.0, 0.0))))
        found = renderer.draw(composition, Shot(view())).colours
        assert found is not None
        return found.copy()

    first = image(0.0, 0.0)
    for x, y in ((3.0, 3.0), (100.0, 0.0), (2.5, 0.9)):
        image(x, y)
    np.testing.assert_array_equal(image(0.0, 0.0), first)


def test_a_mesh_and_another_at_the_same_place_are_not_confused() -> None:
    """The list of shapes of another composition may have another mesh in the same row."""
    assets = """<mesh name="a" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/>
      <mesh name="b" vertex="0 0 0 2 0 0 0 2 0 0 0 2"/>"""
    both = '<geom type="mesh" mesh="a" pos="3 0 0"/><geom type="mesh" mesh="b" pos="3 0 0"/>'
    world = model(both, assets)
    data = mujoco.MjData(world)
    mujoco.mj_forward(world, data)
    renderer = SoftwareRenderer(Appearance(Surroundings(), QUALITIES["fast"]))
    sizes = []
    for unseen in ((1,), (0,)):
        composition = renderer.composer.compose(world, data, np.zeros(3), np.eye(3), unseen=unseen)
        ids = renderer.draw(composition, Shot(view(), ids=True)).ids
        assert ids is not None
        sizes.append(int((ids >= 0).sum()))
    assert sizes[1] > 2 * sizes[0] > 0


def test_an_empty_world_is_its_background() -> None:
    for quality in ("fast", "gazebo"):
        found = colours("", quality=quality, surroundings=Surroundings(background=(0.2, 0.4, 0.6, 1.0)))
        np.testing.assert_array_equal(found, np.broadcast_to((51, 102, 153), found.shape))


def test_a_picture_with_several_passes_has_soft_shadows() -> None:
    lid = visual_box("lid", "0 0 1", "1 1 0.1")
    floor = visual_box("floor", "0 0 -0.05", "20 20 0.1")
    sun = """<light type="directional" name="sun"><direction>0 0 -1</direction><cast_shadows>true</cast_shadows>
      <diffuse>.6 .6 .6 1</diffuse><specular>0 0 0 1</specular></light>"""
    scene = "<scene><ambient>.3 .3 .3 1</ambient></scene>"
    text = f'<sdf version="1.9"><world name="w">{scene}{sun}{lid}{floor}</world></sdf>'
    with simkit.load(text, renderer="software") as sim:
        shown = [
            render_view(
                sim, 200, 200, eye=np.array((0.0, -3.0, 0.6)), target=np.zeros(3), quality="gazebo", passes=passes,
                lit=(np.zeros(3), 3.0),
            )[..., 0].astype(int)
            for passes in (1, 16)
        ]  # fmt: skip
    dark, light = shown[0][100, 100], shown[0][190, 100]
    assert light > dark + 100
    # grey pixels of the floor: the edge of the shadow is a step, or a slope of 7 cm
    grey = [int(((part[85:] > dark + 15) & (part[85:] < light - 15)).sum()) for part in shown]
    assert grey[1] > 100 > 2 * grey[0]


def visual_box(name: str, position: str, size: str) -> str:
    shape = f"<geometry><box><size>{size}</size></box></geometry>"
    material = "<material><ambient>1 1 1 1</ambient><diffuse>1 1 1 1</diffuse></material>"
    return f"""<model name="{name}"><static>true</static><pose>{position} 0 0 0</pose>
      <link name="l"><visual name="v">{shape}{material}</visual></link></model>"""
