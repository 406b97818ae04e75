"""Content of images: visuals, fog, sky, glass, shadows and lights; quality and its cost."""

from __future__ import annotations

import logging
import math
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from sensor_worlds import box, colours, sensor, world

import simkit
from simkit.errors import InputError
from simkit.sensors.cameras.overview_image import render_view
from simkit.sensors.cameras.renderer_choice import renderer_of
from simkit.sensors.cameras.rendering.view import Shot, View
from simkit.sensors.cameras.rendering.view_culling import Bounds

BLUE = (51, 102, 153)
WALL = box("wall", "3.5 0 1 0 0 0", "1 9 9", colour="1 0 0")
DOWN = '<light type="directional" name="sun"><direction>0 0 -1</direction><cast_shadows>true</cast_shadows></light>'


def scene(more: str = "", ambient: float = 1.0, light: str = "") -> str:
    colour = " ".join([str(ambient)] * 3)
    return f"<scene><ambient>{colour} 1</ambient><background>0.2 0.4 0.6 1</background>{more}</scene>{light}"


def camera(more: str = "", image: str = "", name: str = "c", pose: str = "0 0 0 0 0 0", size: int = 33) -> str:
    block = f"""<camera><horizontal_fov>1.0</horizontal_fov>{more}
      <image><width>{size}</width><height>{size}</height>{image}</image><clip><near>0.05</near><far>60</far></clip>
      </camera>"""
    return sensor("camera", block, name=name, pose=pose, extra=f"<topic>{name}</topic>")


def picture(text: str, *overrides: str, topic: str = "/c") -> npt.NDArray[np.uint8]:
    with simkit.load(text, overrides=overrides) as sim:
        images = sim.subscribe(topic)
        sim.run(0.02)
        return colours(images.messages[0])


def visual(
    name: str, pose: str, shape: str, colour: str, *, before: str = "", in_material: str = "", ambient: str = ""
) -> str:
    material = f"<diffuse>{colour}</diffuse><ambient>{ambient or colour}</ambient>{in_material}"
    return f"""<model name="{name}"><static>true</static><pose>{pose}</pose><link name="l"><visual name="v">{before}
      <geometry>{shape}</geometry><material>{material}</material></visual></link></model>"""


def slab(name: str, x: float, colour: str, transparency: float = 0.0, **more: str) -> str:
    before = f"<transparency>{transparency}</transparency>" + more.pop("before", "")
    return visual(name, f"{x} 0 1 0 0 0", "<box><size>0.01 9 9</size></box>", colour, before=before, **more)


# ---------------------------------------------------------------------- who is seen


def test_a_mask_hides_visuals_that_share_no_bit_with_it() -> None:
    front = slab("front", 2.0, "0 1 0 1", before="<visibility_flags>2</visibility_flags>")
    eyes = (
        camera(name="all")
        + camera("<visibility_mask>1</visibility_mask>", name="one")
        + camera("<visibility_mask>0x2</visibility_mask>", name="two")
    )
    with simkit.load(world(eyes, others=front + WALL, top=scene())) as sim:
        seen = {name: sim.subscribe(f"/{name}") for name in ("all", "one", "two")}
        sim.run(0.02)
        middle = {name: tuple(colours(s.messages[0])[16, 16]) for name, s in seen.items()}
    assert middle == {"all": (0, 255, 0), "one": (255, 0, 0), "two": (0, 255, 0)}


def test_a_camera_inside_its_own_body_looks_through_it() -> None:
    shell = f"""<visual name="v"><geometry><sphere><radius>0.5</radius></sphere></geometry></visual>
      <visual name="w"><geometry><box><size>0.4 0.4 0.4</size></box></geometry></visual>{camera()}"""
    seen = picture(world("", body=shell, static=False, others=WALL, top=scene() + "<gravity>0 0 0</gravity>"))
    np.testing.assert_array_equal(seen[16, 16], (255, 0, 0))


def test_a_plane_is_invisible_from_behind_if_it_is_not_double_sided() -> None:
    floor = "<plane><normal>-1 0 0</normal><size>9 9</size></plane>"
    for normal, in_material, expected in (
        ("-1 0 0", "", (0, 255, 0)),
        ("1 0 0", "", (255, 0, 0)),
        ("1 0 0", "<double_sided>true</double_sided>", (0, 255, 0)),
    ):
        shape = floor.replace("-1 0 0", normal)
        plane = visual("p", "2 0 1 0 0 0", shape, "0 1 0 1", in_material=in_material)
        seen = picture(world(camera(), others=plane + WALL, top=scene()))
        np.testing.assert_array_equal(seen[16, 16], expected)


def test_only_shapes_outside_a_view_are_found() -> None:
    view = View(10, 10, -0.5, 0.5, -0.25, 0.25, 0.1, 20.0)
    centres = np.array(
        ((5.0, 0.0, 0.0), (-3.0, 0.0, 0.0), (25.0, 0.0, 0.0), (4.0, 2.5, 0.0), (4.0, 3.5, 0.0), (4.0, 0.0, 2.4))
    )
    bounds = Bounds(centres, np.full(6, 1.0))
    # the edge at the side is 0.5 / 1 away at a distance of 1: 4 · 0.5 + 1 · √1.25 = 3.12; upwards 1 + √1.0625 = 2.03
    assert bounds.outside(np.zeros(3), np.eye(3), view) == [1, 2, 4, 5]


def test_images_are_the_same_with_and_without_invisible_shapes() -> None:
    around = "".join(
        box(
            f"b{i}",
            f"{4 * math.cos(i)} {4 * math.sin(i)} {0.4 * (i % 6)} {i} 0 0",
            "0.6 0.3 0.9",
            colour=f"0 {i / 30} 1",
        )
        for i in range(30)
    )
    with simkit.load(world(camera(), others=around, top=scene(light=DOWN))) as sim:
        renderer, data = renderer_of(sim), sim.engine.physics.fresh()
        shot = Shot(View(64, 48, -0.5, 0.5, -0.4, 0.4, 0.1, 50.0), depth=True)
        taken = []
        for culled in (True, False):
            composition = renderer.composer.compose(sim.mj_model, data, np.array((0.0, 0.0, 1.0)), np.eye(3))
            assert composition.bounds is not None
            if not culled:
                composition.bounds = None
            drawn_view = renderer.draw(composition, shot)
            taken.append((drawn_view.colours.copy(), drawn_view.depths.copy()))
    np.testing.assert_array_equal(taken[0][0], taken[1][0])
    np.testing.assert_array_equal(taken[0][1], taken[1][1])


# ---------------------------------------------------------------------- glass, fog, sky


def test_half_opaque_is_half_before_a_wall_and_before_the_background() -> None:
    glass = slab("glass", 2.0, "0 1 0 1", 0.5)
    for others, behind in ((WALL, (255, 0, 0)), ("", BLUE)):
        seen = picture(world(camera(), others=glass + others, top=scene()))
        np.testing.assert_allclose(seen[16, 16], 0.5 * np.array((0, 255, 0)) + 0.5 * np.array(behind), atol=2)


def test_the_background_behind_glass_in_one_image_does_not_colour_the_background_of_the_next() -> None:
    pane = slab("pane", 1.2, "0 1 0 1", 0.5, before="<visibility_flags>2</visibility_flags>")
    eyes = camera(name="through") + camera("<visibility_mask>1</visibility_mask>", name="blind_to_it")
    with simkit.load(world(eyes, others=pane, top=scene())) as sim:
        first, other = sim.subscribe("/through"), sim.subscribe("/blind_to_it")
        sim.run(0.03)
    assert tuple(colours(first.messages[0])[0, 0]) != BLUE
    for image in other.messages:
        assert (colours(image) == BLUE).all()


def test_glass_is_drawn_from_the_back_to_the_front_whatever_its_order_in_the_file() -> None:
    green, blue = slab("g", 1.5, "0 1 0 1", 0.5), slab("b", 2.0, "0 0 1 1", 0.25)
    expected = 0.5 * np.array((0, 255, 0)) + 0.5 * (0.75 * np.array((0, 0, 255)) + 0.25 * np.array((255, 0, 0)))
    for glass in (green + blue, blue + green):
        np.testing.assert_allclose(picture(world(camera(), others=glass + WALL, top=scene()))[16, 16], expected, atol=2)


@pytest.mark.parametrize(
    "shape",
    [
        "<sphere><radius>1.5</radius></sphere>",
        "<cylinder><radius>1.5</radius><length>3</length></cylinder>",
        "<capsule><radius>1</radius><length>3</length></capsule>",
        "<ellipsoid><radii>1 2 1.5</radii></ellipsoid>",
        "<cone><radius>2</radius><length>3</length></cone>",
        "<plane><normal>-1 0 0</normal><size>4 4</size></plane>",
    ],
)
def test_every_shape_of_glass_lies_where_the_same_shape_lies_when_it_is_opaque(shape: str) -> None:
    places = []
    for transparency in ("0", "0.5"):
        before = f"<transparency>{transparency}</transparency>"
        thing = visual("t", "6 0.5 1.2 0.3 0.2 0.1", shape, "0 1 0 1", before=before)
        seen = picture(world(camera(), others=thing, top=scene()))
        places.append((seen != BLUE).any(axis=2))
    assert 20 < places[0].sum() < 800
    np.testing.assert_array_equal(places[0], places[1])


@pytest.mark.parametrize(
    ("fog", "share"),
    [
        ("<type>linear</type><start>1</start><end>5</end>", (2.995 - 1) / 4),
        ("<type>exp</type><density>0.3</density>", 1 - math.exp(-0.3 * 2.995)),
        ("<type>exp2</type><density>0.3</density>", 1 - math.exp(-((0.3 * 2.995) ** 2))),
        ("<type>none</type>", 0.0),
    ],
)
@pytest.mark.parametrize("quality", ["fast", "gazebo"])
def test_fog_thickens_with_depth_by_its_type(fog: str, share: float, quality: str) -> None:
    text = world(camera(), others=slab("w", 3.0, "1 0 0 1"), top=scene(f"<fog><color>0 0 1 1</color>{fog}</fog>"))
    seen = picture(text, f"scene.quality={quality}")
    np.testing.assert_allclose(seen[16, 16], (255 * (1 - share), 0, 255 * share), atol=2)


def test_a_sky_is_above_the_horizon_and_stays_behind_everything() -> None:
    eye = camera(pose="0 0 0 0 -0.3 0")
    seen = picture(world(eye, others=slab("low", 20.0, "1 0 0 1"), top=scene("<sky/>"))).astype(int)
    np.testing.assert_array_equal(seen[20, 16], (255, 0, 0))
    zenith = picture(world(camera(pose="0 0 0 0 -1.5707963 0"), top=scene("<sky/>"))).astype(int)[16, 16]
    assert zenith[2] > zenith[0] + 80 and (seen[0, 16] != BLUE).all()
    same = picture(world(eye, others=slab("low", 20.0, "1 0 0 1"), top=scene()), "scene.sky=true")
    np.testing.assert_array_equal(same, seen)


# ---------------------------------------------------------------------- quality


def shadowed(quality: str, more: str = "", light: str = DOWN, hat: str = "", box_flags: str = "") -> int:
    """Red of the floor below a slab that hangs over it; 255 in the sun, 76 without it."""
    floor = visual("floor", "3 0 0 0 0 0", "<box><size>9 9 0.01</size></box>", "1 0 0 1")
    over = visual("over", "3 0 2.5 0 0 0", "<box><size>1.6 1.6 0.1</size></box>", "0 1 0 1", before=box_flags)
    eye = camera(pose=f"0 0 0 0 {math.atan2(1, 3)} 0")
    text = world(eye, others=floor + over + hat, top=scene(more, 0.3, light))
    return int(picture(text, f"scene.quality={quality}")[16, 16, 0])


def test_shadows_are_drawn_if_quality_and_file_enable_them() -> None:
    assert shadowed("fast") == 255
    assert shadowed("gazebo") == pytest.approx(76, abs=2)
    assert shadowed("high") == pytest.approx(76, abs=2)
    assert shadowed("gazebo", "<shadows>false</shadows>") == 255
    assert shadowed("gazebo", light=DOWN.replace("true", "false")) == 255
    assert shadowed("gazebo", box_flags="<cast_shadows>false</cast_shadows>") == 255


def test_glass_casts_a_shadow_if_it_is_more_than_half_opaque() -> None:
    assert shadowed("gazebo", box_flags="<transparency>0.3</transparency>") == pytest.approx(76, abs=2)
    assert shadowed("gazebo", box_flags="<transparency>0.7</transparency>") == 255


def test_shadows_around_the_camera_are_there_in_a_world_of_a_kilometre() -> None:
    far = "".join(box(f"f{i}", f"{300 * math.cos(i)} {300 * math.sin(i)} 5 0 0 0", "10 10 10") for i in range(6))
    assert shadowed("gazebo", hat=far) == pytest.approx(76, abs=2)


@pytest.mark.parametrize("direction", ["0.4 0.3 -0.9", "-0.5 0.4 -0.9", "0.4 0.3 -0.3"])
def test_sunlit_ground_casts_no_shadow_on_itself(direction: str) -> None:
    floor = visual("floor", "0 0 0 0 0 0", "<plane><normal>0 0 1</normal><size>100 100</size></plane>", "1 1 1 1")
    crate = visual("crate", "0 0 0.5 0 0 0", "<box><size>1 1 1</size></box>", "1 0 0 1")
    sun = DOWN.replace("0 0 -1", direction)
    seen = {}
    for name, others in (("bare", floor), ("both", floor + crate)):
        text = world(camera(pose="0 0 7 0 1.5707963 0", size=161), others=others, top=scene("", 0.3, sun))
        ground = picture(text, "scene.quality=gazebo").astype(int)
        seen[name] = ground[..., 1][ground[..., 0] - ground[..., 1] < 10]  # all but the red crate
    sunlit = int(np.median(seen["bare"]))
    assert sunlit > 120
    assert (np.abs(seen["bare"] - sunlit) < 10).all()
    assert 0.002 < (seen["both"] < sunlit - 40).mean() < 0.1  # the crate's own


def test_edges_are_smooth_at_gazebos_quality_where_the_camera_does_not_say_otherwise() -> None:
    edge = visual("e", "2 0 1 0.3 0 0", "<box><size>0.2 0.6 0.6</size></box>", "1 1 1 1")
    counts = []
    for quality, image in (("fast", ""), ("gazebo", ""), ("gazebo", "<anti_aliasing>0</anti_aliasing>")):
        seen = picture(world(camera(image=image), others=edge, top=scene()), f"scene.quality={quality}")
        counts.append(len(np.unique(seen.reshape(-1, 3), axis=0)))
    assert counts[0] == counts[2] == 2 < counts[1]


def test_the_quality_and_its_missing_features_are_logged_once_with_the_renderer(
    caplog: pytest.LogCaptureFixture,
) -> None:
    with caplog.at_level(logging.INFO, "simkit"):
        picture(world(camera() + camera(name="d"), top=scene()))
        picture(world(camera(), top=scene("<quality>gazebo</quality>")))
    said = [r.getMessage() for r in caplog.records if r.getMessage().startswith("renderer: ")]
    assert len(said) == 2
    assert "quality fast, without shadows and smooth edges" in said[0]
    assert "quality gazebo, with shadows" in said[1]


def test_an_unknown_quality_is_rejected() -> None:
    with pytest.raises(InputError, match="expected one of fast, gazebo, high"):
        simkit.load(world(""), overrides=["scene.quality=best"])
    with pytest.raises(simkit.LoadError, match="fast, gazebo, high"):
        simkit.load(world("", top=scene("<quality>best</quality>")))


# ---------------------------------------------------------------------- lights


def lamp(number: int, pose: str, more: str = "", kind: str = "point") -> str:
    fade = "<range>30</range><constant>0.5</constant><linear>0.1</linear><quadratic>0.1</quadratic>"
    return f"""<light type="{kind}" name="lamp{number}"><pose>{pose}</pose><diffuse>1 1 1 1</diffuse>
      <attenuation>{fade}</attenuation>{more}</light>"""


def test_of_many_lights_a_camera_gets_those_that_are_near_it() -> None:
    far = "".join(lamp(i, f"{300 + i} 0 1 0 0 0") for i in range(130))
    near = lamp(500, "1 0 1.5 0 0 0")
    with simkit.load(world(camera(), others=WALL, top=scene(ambient=0.0, light=far + near))) as sim:
        images = sim.subscribe("/c")
        sim.run(0.02)
        assert colours(images.messages[0])[16, 16, 0] > 100
        assert "SK-RENDER-012" in {d.code for d in sim.diagnostics}
        assert sim.mj_model.light_active.all()


def test_a_suns_direction_decides_which_side_is_bright() -> None:
    sun = '<light type="directional" name="s"><direction>1 0 0</direction><diffuse>1 1 1 1</diffuse></light>'
    assert picture(world(camera(), others=WALL, top=scene(ambient=0.2, light=sun)))[16, 16, 0] == 255
    away = sun.replace("1 0 0</dir", "-1 0 0</dir")
    assert picture(world(camera(), others=WALL, top=scene(ambient=0.2, light=away)))[16, 16, 0] == 51


def test_ambient_and_diffuse_colours_count_each_under_their_own_light() -> None:
    dim = slab("w", 3.0, "0.8 0.8 0.8 1", ambient="0.2 0.2 0.2 1")
    assert picture(world(camera(), others=dim, top=scene(ambient=0.5)))[16, 16, 0] == pytest.approx(255 * 0.1, abs=1)
    sun = '<light type="directional" name="s"><direction>1 0 0</direction><diffuse>.5 .5 .5 1</diffuse></light>'
    both = picture(world(camera(), others=dim, top=scene(ambient=0.5, light=sun)))[16, 16, 0]
    assert both == pytest.approx(255 * (0.1 + 0.4), abs=2)


def test_a_lamp_on_a_moving_link_lights_the_objects_near_it() -> None:
    body = lamp(1, "0 0 0 0 0 0") + "<inertial><mass>1</mass></inertial>"
    carrier = f'<model name="k"><pose>-40 0 1 0 0 0</pose><link name="l"><gravity>false</gravity>{body}</link></model>'
    with simkit.load(world(camera(), others=carrier + WALL, top=scene(ambient=0.0))) as sim:
        images = sim.subscribe("/c")
        sim.run(0.02)
        sim.model("k").set_pose(simkit.Pose((0.5, 0, 1.2)))
        sim.run(0.02)
        dark, bright = (int(colours(m)[16, 16, 0]) for m in (images.messages[0], images.messages[-1]))
    assert dark < 5 and bright > 100


# ---------------------------------------------------------------------- sizes, structure, overview


def test_cameras_of_many_sizes_share_one_world() -> None:
    eyes = "".join(camera(name=f"c{i}", size=9 + 11 * i) for i in range(16))
    with simkit.load(world(eyes, others=WALL, top=scene())) as sim:
        subs = [sim.subscribe(f"/c{i}") for i in range(16)]
        sim.run(0.02)
        for i, sub in enumerate(subs):
            seen = colours(sub.messages[0])
            assert seen.shape == (9 + 11 * i, 9 + 11 * i, 3)
            assert (seen == (255, 0, 0)).all()


@pytest.mark.parametrize("quality", ["fast", "gazebo"])
def test_images_follow_spawn_remove_set_pose_and_restore(quality: str) -> None:
    text = world(camera(), others=WALL, top=scene(light=DOWN))
    with simkit.load(text, overrides=[f"scene.quality={quality}"]) as sim:
        images = sim.subscribe("/c")

        def next_colour() -> Any:
            sim.run(0.02)
            return tuple(int(v) for v in colours(images.messages[-1])[16, 16])

        red = next_colour()
        kept = sim.snapshot()
        sim.spawn(f'<sdf version="1.9">{slab("g", 2.0, "0 1 0 1")}</sdf>')
        green = next_colour()
        sim.model("g").set_pose(simkit.Pose((-5, 0, 1)))
        moved = next_colour()
        sim.model("g").set_pose(simkit.Pose((2, 0, 1)))
        back = next_colour()
        sim.remove("g")
        gone = next_colour()
        sim.restore(kept)
        restored = next_colour()
    assert red[0] > 200 and green[1] > 200
    assert (moved, back, gone, restored) == (red, green, red, red)


def test_a_decorated_view_has_room_for_more_than_two_thousand_shapes() -> None:
    import mujoco

    def dots(scene: Any) -> None:
        for i in range(5000):
            assert scene.ngeom < scene.maxgeom
            geom = scene.geoms[scene.ngeom]
            place = np.array((2.0, (i % 100) / 50 - 1, i / 2500))
            size, colour = np.full(3, 0.02), np.array((0, 1, 0, 1), np.float32)
            mujoco.mjv_initGeom(geom, mujoco.mjtGeom.mjGEOM_SPHERE, size, place, np.eye(3).reshape(-1), colour)
            scene.ngeom += 1

    with simkit.load(world("", others=WALL, top=scene())) as sim:
        seen = render_view(sim, 60, 60, eye=np.array((0, 0, 1.0)), target=np.array((3.0, 0, 1.0)), decorate=dots)
    assert (seen[..., 1] > 200).mean() > 0.5
