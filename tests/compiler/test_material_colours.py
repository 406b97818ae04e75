"""Colours, glow, sides and lights, up to what a picture shows."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest

import simkit
from simkit.compiler.assets import geom_colours
from simkit.compiler.lights import spot_parameters
from simkit.errors import SimkitError
from simkit.loaders.meshes.mesh_part import MeshPart
from simkit.pose import Pose
from simkit.scene import Box, Material, SceneLight, SceneVisual
from tests.loaders.meshes.mesh_makers import QUAD, picture

RED = (1.0, 0.0, 0.0, 1.0)


def visual(material=None, **more):
    return SceneVisual("v", "m::l::v", Pose(), Box((1, 1, 1)), material, **more)


def test_the_files_material_wins_over_the_meshs_own():
    part = MeshPart(
        "p", np.zeros((3, 3)), np.zeros((1, 3), np.int32), colour=(0, 0, 1, 0.5), specular=0.4, emission=0.2
    )
    own = geom_colours(visual(), part)
    assert (own.rgba, own.specular, own.emission) == ((0, 0, 1, 0.5), 0.4, 0.2)
    given = geom_colours(visual(Material(diffuse=RED, specular=(0.1, 0.3, 0.2, 1.0))), part)
    assert (given.rgba, given.specular, given.emission) == (RED, 0.3, 0.0)


def test_transparency_takes_from_the_colours_own_opacity():
    assert geom_colours(visual(Material(diffuse=(1, 1, 1, 0.5)), transparency=0.5), None).rgba[3] == pytest.approx(0.25)


def test_what_glows_keeps_the_colour_that_it_glows_in():
    dark = geom_colours(visual(Material(diffuse=(0, 0, 0, 1), emissive=(0, 0.5, 0, 1))), None)
    assert dark.rgba == (0, 1, 0, 1) and dark.emission == pytest.approx(0.5)
    half = geom_colours(visual(Material(diffuse=(1, 1, 1, 1), emissive=(0.25, 0.25, 0.25, 1))), None)
    assert half.rgba == (1, 1, 1, 1) and half.emission == pytest.approx(0.25)


def test_roughness_widens_the_gloss():
    smooth, rough = (geom_colours(visual(Material(roughness=r)), None).shininess for r in (0.1, 0.9))
    assert smooth == pytest.approx(0.9) and rough == pytest.approx(0.1)


@pytest.mark.parametrize(("inner", "outer", "falloff"), [(0.2, 1.0, 1.0), (0.4, 0.8, 2.0), (0.0, 2.0, 0.5)])
def test_a_spot_is_as_bright_half_way_between_its_angles_as_the_file_says(inner, outer, falloff):
    cutoff, exponent = spot_parameters(SceneLight("s", "s", "spot", spot=(inner, outer, falloff)))
    assert cutoff == pytest.approx(math.degrees(outer / 2))
    assert math.cos((inner + outer) / 4) ** exponent == pytest.approx(0.5**falloff)


def test_a_spot_without_angles_has_the_renderers_own(make, compiled):
    cutoff, exponent = spot_parameters(SceneLight("s", "s", "spot"))
    assert (cutoff, exponent) == (pytest.approx(20.0), 0.0)


def test_light_settings_arrive(make, compiled):
    lamp = SceneLight(
        "p",
        "p",
        "point",
        Pose((1, 2, 3)),
        diffuse=(0.5, 0.4, 0.3, 1),
        intensity=2.0,
        attenuation=(7.0, 0.3, 0.2, 0.1),
        on=False,
    )
    model = compiled(make.model("m", make.link("m::l", Box((1, 1, 1)))), lights=(lamp,)).model
    np.testing.assert_allclose(model.light_diffuse[0], (1.0, 0.8, 0.6), rtol=1e-6)
    np.testing.assert_allclose(model.light_attenuation[0], (0.3, 0.2, 0.1), rtol=1e-6)
    assert model.light_range[0] == pytest.approx(7.0)
    assert model.light_cutoff[0] == pytest.approx(180.0)
    assert not model.light_active[0]


# ---------------------------------------------------------------------- pictures

WORLD = """<sdf version="1.9"><world name="w"><scene><ambient>0 0 0 1</ambient><background>0 0 1 1</background></scene>
{light}<model name="m"><static>true</static><pose>{pose}</pose><link name="l">{light_of_link}
<visual name="v"><geometry>{shape}</geometry>{material}</visual></link></model></world></sdf>"""
SUN = '<light type="directional" name="sun"><direction>0 1 -0.2</direction><diffuse>1 1 1 1</diffuse></light>'
BOX = "<box><size>1 1 1</size></box>"


def seen(tmp_path, shape=BOX, material="", light=SUN, light_of_link="", eye=(0.0, -3.0, 0.0), pose="0 0 0 0 0 0"):
    """A picture of the world from -y, 100 px high and wide; the box fills 46 px."""
    file = tmp_path / "w.sdf"
    file.write_text(WORLD.format(shape=shape, material=material, light=light, light_of_link=light_of_link, pose=pose))
    with simkit.load(file) as sim:
        try:
            from simkit.sensors.cameras.overview_image import render_view

            return render_view(sim, 100, 100, eye=eye, target=(0, 0, 0), vertical_fov=0.8).astype(int)
        except SimkitError as problem:
            pytest.skip(str(problem))


def is_like(pixel, colour):
    return bool(np.abs(np.asarray(pixel) / max(1, int(max(pixel))) - np.asarray(colour) / max(colour)).max() < 0.15)


def test_a_pictures_top_is_up_on_box_plane_and_mesh(tmp_path):
    picture(tmp_path / "p.png", (255, 0, 0), (0, 255, 0), side=64)
    (tmp_path / "m.mtl").write_text("newmtl m\nKd 1 1 1\nmap_Kd p.png\n")
    corners = [f"v {x - 0.5} {y} {z - 0.5}" for x, y, z in QUAD] + ["vt 0 0", "vt 1 0", "vt 1 1", "vt 0 1"]
    (tmp_path / "q.obj").write_text("mtllib m.mtl\nusemtl m\n" + "\n".join(corners) + "\nf 1/1 2/2 3/3 4/4\n")
    wears = "<material><diffuse>1 1 1 1</diffuse><pbr><metal><albedo_map>p.png</albedo_map></metal></pbr></material>"
    for shape, material in (
        (BOX, wears),
        ("<plane><normal>0 -1 0</normal><size>1 1</size></plane>", wears),
        ("<mesh><uri>q.obj</uri></mesh>", ""),
        ("<cylinder><radius>.5</radius><length>1</length></cylinder>", wears),
    ):
        image = seen(tmp_path, shape, material)
        assert is_like(image[40, 50], (255, 1, 1)), shape
        assert is_like(image[60, 50], (1, 255, 1)), shape


@pytest.mark.parametrize(
    ("material", "colour"),
    [
        ("<material><diffuse>1 0 0 1</diffuse></material>", (255, 1, 1)),
        ("<material><script><name>Gazebo/Green</name></script></material>", (1, 255, 1)),
        ("<material><diffuse>0 0 0 1</diffuse><emissive>1 1 0 1</emissive></material>", (255, 255, 1)),
    ],
)
def test_a_colour_is_seen(tmp_path, material, colour):
    assert is_like(seen(tmp_path, material=material)[50, 50], colour)


def test_a_face_is_seen_from_behind_only_when_it_is_double_sided(tmp_path):
    corners = [f"v {x - 0.5} {y} {z - 0.5}" for x, y, z in QUAD]
    (tmp_path / "q.obj").write_text("\n".join(corners) + "\nf 1 2 3 4\n")
    back = "<light type='directional' name='s'><direction>0 -1 0</direction><diffuse>1 1 1 1</diffuse></light>"
    for word, is_seen in (("false", False), ("true", True)):
        red = f"<material><diffuse>1 0 0 1</diffuse><double_sided>{word}</double_sided></material>"
        image = seen(tmp_path, "<mesh><uri>q.obj</uri></mesh>", red, light=back, eye=(0.0, 3.0, 0.0))
        assert is_like(image[50, 50], (255, 1, 1)) is is_seen


INSIDE = (
    ("<box><size>6 6 6</size></box>", 3.0),
    ("<sphere><radius>3</radius></sphere>", 3.0),
    ("<cylinder><radius>3</radius><length>6</length></cylinder>", 3.0),
    ("<capsule><radius>3</radius><length>6</length></capsule>", 3.0),
    ("<ellipsoid><radii>4 3 2</radii></ellipsoid>", 4.0),
)


@pytest.mark.parametrize("shape, away", INSIDE, ids=lambda value: str(value)[1:5])
@pytest.mark.parametrize("word, is_seen", [("false", False), ("true", True)])
def test_who_stands_in_a_shape_sees_it_only_when_it_is_double_sided(shape, away, word, is_seen):
    visual = f"""<visual name="v"><geometry>{shape}</geometry>
      <material><double_sided>{word}</double_sided></material></visual>"""
    eye = """<sensor name="s" type="depth_camera"><update_rate>10</update_rate>
      <camera><image><width>9</width><height>9</height></image></camera></sensor>"""
    text = f"""<sdf version="1.9"><world name="w"><model name="m"><static>true</static>
      <link name="l">{visual}{eye}</link></model></world></sdf>"""
    with simkit.load(text) as sim:
        sim.run(0.01)
        middle = sim.sensor("m::l::s").true_depth[4, 4]
    assert middle == pytest.approx(away if is_seen else np.inf, rel=1e-3)


def lamp(kind, pose, more=""):
    return f"""<light type="{kind}" name="lamp"><pose>{pose}</pose><direction>0 1 0</direction>
    <diffuse>1 1 1 1</diffuse>
    <attenuation><range>20</range><constant>1</constant><linear>0</linear><quadratic>0</quadratic></attenuation>
    {more}</light>"""


WHITE = "<material><diffuse>.8 .8 .8 1</diffuse></material>"


def test_a_point_light_shines_all_around(tmp_path):
    for at in ("0 -2 0 0 0 0", "-2 -2 1 0 0 0", "2 -2 -1 0 0 0"):
        assert seen(tmp_path, material=WHITE, light=lamp("point", at))[50, 50].min() > 80
    assert seen(tmp_path, material=WHITE, light=lamp("point", "0 3 0 0 0 0"))[50, 50].max() < 30


def test_a_lamp_fades_with_distance(tmp_path):
    near = lamp("point", "0 -2.5 0 0 0 0")
    full = seen(tmp_path, material=WHITE, light=near)[50, 50, 0]
    # 1 / (1 + 0.5 · 2) at two metres
    faded = seen(tmp_path, material=WHITE, light=near.replace("<linear>0", "<linear>0.5"))[50, 50, 0]
    assert faded == pytest.approx(full / 2, rel=0.1)


def test_a_spot_lights_what_lies_in_its_cone(tmp_path):
    cone = "<spot><inner_angle>.1</inner_angle><outer_angle>.3</outer_angle><falloff>1</falloff></spot>"
    assert seen(tmp_path, material=WHITE, light=lamp("spot", "0 -3 0 0 0 0", cone))[50, 50].min() > 80
    assert seen(tmp_path, material=WHITE, light=lamp("spot", "3 -3 0 0 0 0", cone))[50, 50].max() < 30


def test_a_small_spot_on_a_large_plane_is_seen(tmp_path):
    floor = "<plane><normal>0 -1 0</normal><size>100 100</size></plane>"
    cone = "<spot><inner_angle>.3</inner_angle><outer_angle>.5</outer_angle><falloff>1</falloff></spot>"
    spot = lamp("spot", "0.7 -3 0.3 0 0 0", cone)  # 0.77 m across its middle
    image = seen(tmp_path, floor, WHITE, spot, eye=(0.0, -6.0, 0.0))
    assert image[:, :, 0].max() > 60


def test_a_script_scales_its_picture(tmp_path):
    picture(tmp_path / "p.png", (255, 0, 0), (0, 255, 0), side=64)
    (tmp_path / "s.material").write_text(
        "material Own/Small { technique { pass { texture_unit { texture p.png \n scale 0.5 0.5 \n } } } }"
    )
    wears = "<material><script><uri>s.material</uri><name>Own/Small</name></script></material>"
    image = seen(tmp_path, BOX, wears)  # the picture's upper half is red; now it is there twice each way
    # about the middle of the box lies the middle of the picture
    rows = [28 + round(44 * part) for part in (0.12, 0.37, 0.62, 0.87)]
    assert [is_like(image[row, 50], (255, 1, 1)) for row in rows] == [False, True, False, True]


def test_a_bare_model_is_lit_from_the_eye(tmp_path):
    file = tmp_path / "m.sdf"
    file.write_text(
        '<sdf version="1.9"><model name="m"><static>true</static><link name="l"><visual name="v"><geometry>'
        f"<sphere><radius>0.5</radius></sphere></geometry>{WHITE}</visual></link></model></sdf>"
    )
    with simkit.load(file) as sim:
        try:
            from simkit.sensors.cameras.overview_image import render_view

            image = render_view(sim, 100, 100, eye=(0.0, -3.0, 0.0), target=(0, 0, 0), vertical_fov=0.8).astype(int)
        except SimkitError as problem:
            pytest.skip(str(problem))
    assert image[50, 50, 0] - image[50, 32, 0] > 25


def test_a_light_that_is_off_does_not_shine(tmp_path):
    off = lamp("point", "0 -2 0 0 0 0", "<light_on>false</light_on>")
    assert seen(tmp_path, material=WHITE, light=off)[50, 50].max() < 30


def test_a_light_on_a_link_stands_where_the_link_stands(tmp_path):
    turned = seen(
        tmp_path, material=WHITE, light="", light_of_link=lamp("point", "2 0 0 0 0 0"), pose="0 0 0 0 0 -1.5707963"
    )
    assert turned[50, 50].min() > 80


def test_a_light_on_a_moving_link_goes_with_it(make, compiled):
    scene_light = SceneLight("p", "m::l::p", "point", Pose((0, 0, 1)), link="m::l")
    c = compiled(make.model("m", make.link("m::l", Box((1, 1, 1)), lights=(scene_light,))), gravity=(0.0, 0.0, -9.8))
    mujoco.mj_step(c.model, c.data, 200)
    mujoco.mj_forward(c.model, c.data)
    assert c.data.light_xpos[0, 2] - c.data.qpos[2] == pytest.approx(1.0)
    assert c.data.qpos[2] < -0.1


@pytest.mark.parametrize("colour", ["0 0 0 1", "0.0118 0.0118 0.0118 1"])
def test_the_edges_of_a_black_model_are_seen(tmp_path, colour):
    material = f"<material><diffuse>{colour}</diffuse><specular>0 0 0 1</specular></material>"
    sun = SUN.replace("0 1 -0.2", "0.1 0.2 -1")
    image = seen(tmp_path, material=material, light=sun, eye=(0.0, -2.5, 2.0))
    top, front = image[45, 50], image[70, 50]
    assert top.min() >= 25 and top.max() - top.min() <= 2, "the lit top is dark grey"
    assert top.max() <= 40 and int(top.min()) - int(front.max()) >= 10, "the front is darker"


def test_a_black_model_stays_black_in_the_compiled_world(make, compiled):
    black = visual(Material(diffuse=(0, 0, 0, 1)))
    assert geom_colours(black, None).rgba == (0, 0, 0, 1)
