"""Cameras with wide lenses: formulas of SDF's lens models, borders of faces, black pixels, and CameraInfo."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import cv2
import numpy as np
import pytest
from sensor_worlds import box, colours, sensor, world

import simkit
from simkit_special_cameras.sensors.cube_map import CubeMap
from simkit_special_cameras.sensors.wide_angle_lens import LENSES, WideAngleModel

DARK = "<scene><ambient>1 1 1 1</ambient><background>0 0 0 1</background></scene>"
ALL_ROUND = "<cutoff_angle>3.1416</cutoff_angle>"
CUSTOM = (
    "<type>custom</type><custom_function><c1>1.05</c1><c2>4</c2><c3>{c3}</c3><f>{f}</f><fun>{fun}</fun>"
    "</custom_function>"
)
WIDTH, HEIGHT = 200, 150


def camera(lens: str, hfov: float, *, width: int = WIDTH, height: int = HEIGHT, more: str = "") -> str:
    return f"""<camera><horizontal_fov>{hfov}</horizontal_fov>
      <image><width>{width}</width><height>{height}</height></image><lens>{lens}</lens>{more}</camera>"""


def load(block: str, others: str = "", *, kind: str = "wide_angle_camera", top: str = DARK) -> Any:
    text = world(sensor(kind, block, extra="<topic>cam/image</topic>"), others=others, top=top, pose="0 0 0 0 0 0")
    return simkit.load(text)


def shown(sim: Any, *topics: str) -> list[Any]:
    subs = [sim.subscribe(f"/cam/{t}") for t in topics]
    sim.run(0.02)
    return [s.messages[0] for s in subs]


def direction(angle: float, turn: float) -> np.ndarray:
    """Return the direction at `angle` off the axis and at `turn` from the image's right edge downwards."""
    across = math.sin(angle)
    return np.array((math.cos(angle), -across * math.cos(turn), -across * math.sin(turn)))


def target(i: int, angle: float, turn: float, colour: str) -> str:
    """Return a square of 0.09 m at a distance of 1 m that faces the camera."""
    x, y, z = direction(angle, turn)
    pose = f"{x} {y} {z} 0 {-math.asin(z)} {math.atan2(y, x)}"
    return box(f"t{i}", pose, "0.001 0.09 0.09", colour=colour)


def middle(picture: np.ndarray, channel: int) -> np.ndarray:
    others = [c for c in range(3) if c != channel]
    weights = np.clip(picture[..., channel].astype(float) - picture[..., others].max(axis=-1) - 20, 0, None)
    v, u = np.mgrid[: picture.shape[0], : picture.shape[1]] + 0.5
    return np.array((np.average(u, weights=weights), np.average(v, weights=weights)))


FORMULAS = {
    "gnomonical": (math.tan, 1.8),
    "stereographic": (lambda a: 2 * math.tan(a / 2), 3.6),
    "equidistant": (lambda a: a, 4.4),
    "equisolid_angle": (lambda a: 2 * math.sin(a / 2), 4.0),
    "orthographic": (math.sin, 3.0),
}
CASES = [(f"<type>{name}</type>{ALL_ROUND}", formula, hfov) for name, (formula, hfov) in FORMULAS.items()] + [
    (CUSTOM.format(c3=0, f=1, fun="tan") + ALL_ROUND, lambda a: math.tan(a / 4), 3.05),
    (CUSTOM.format(c3=-0.1, f=1, fun="id") + ALL_ROUND, lambda a: a / 4 - 0.1, 3.05),
    (CUSTOM.format(c3=0.05, f=1, fun="sin") + ALL_ROUND, lambda a: math.sin(a / 4 + 0.05), 3.05),
]


@pytest.mark.parametrize(("lens", "formula", "hfov"), CASES, ids=[*FORMULAS, "custom-tan", "custom-id", "custom-sin"])
def test_a_target_is_where_the_lens_formula_puts_it(lens: str, formula: Any, hfov: float) -> None:
    places = [(0.62 * hfov / 2, 0.3), (0.88 * hfov / 2, 3.3), (0.7 * hfov / 2, 5.6)]
    colour = ("1 0 0", "0 1 0", "0 0 1")
    others = "".join(target(i, *place, colour[i]) for i, place in enumerate(places))
    with load(camera(lens, hfov), others) as sim:
        (image,) = shown(sim, "image")
    for channel, (angle, turn) in enumerate(places):
        radius = formula(angle) / formula(hfov / 2) * WIDTH / 2
        expected = (WIDTH / 2 + radius * math.cos(turn), HEIGHT / 2 + radius * math.sin(turn))
        np.testing.assert_allclose(middle(colours(image), channel), expected, atol=0.5)


def test_without_scale_to_hfov_the_focal_length_decides() -> None:
    lens = CUSTOM.format(c3=0, f=1.5, fun="tan") + "<scale_to_hfov>false</scale_to_hfov>"
    with load(camera(lens, 1.0), target(0, 1.1, 0.4, "1 0 0")) as sim:
        (image,) = shown(sim, "image")
    radius = 1.05 * 1.5 * math.tan(1.1 / 4) * WIDTH / 2
    expected = (WIDTH / 2 + radius * math.cos(0.4), HEIGHT / 2 + radius * math.sin(0.4))
    np.testing.assert_allclose(middle(colours(image), 0), expected, atol=0.5)


@pytest.mark.parametrize("size", [(1, 1), (1, 7), (7, 1)])
def test_the_smallest_images_are_drawn(size: tuple[int, int]) -> None:
    block = camera("<type>equidistant</type>", 0.5, width=size[0], height=size[1])
    with load(block, box("wall", "2 0 0 0 0 0", "0.1 90 90")) as sim:
        (image,) = shown(sim, "image")
    assert (image.width, image.height) == size
    assert np.asarray(image.data).min() > 50


def test_behind_is_seen_too() -> None:
    with load(camera(f"<type>equidistant</type>{ALL_ROUND}", 6.2832), target(0, 2.9, 0.0, "1 0 0")) as sim:
        (image,) = shown(sim, "image")
        assert len(sim.sensor("m::l::s").shots()) == 6
    red = (colours(image)[..., 0] > 60) & (colours(image)[..., 1] < 40)
    v, u = np.argwhere(red).mean(axis=0) + 0.5
    assert math.hypot(u - 100, v - 75) == pytest.approx(2.9 / math.pi * 100, abs=1.0)
    assert u > 190


# ---------------------------------------------------------------------- seams


def around(lens: str, hfov: float) -> Any:
    """Load a camera inside six walls of one colour."""
    shape = "<geometry><box><size>0.1 12 12</size></box></geometry>"
    glow = "".join(f"<{n}>0 0 0 1</{n}>" for n in ("ambient", "diffuse", "specular"))
    glow += "<emissive>0.6 0.6 0.6 1</emissive>"
    wall = f'<visual name="v{{i}}"><pose>{{p}}</pose>{shape}<material>{glow}</material></visual>'
    sides = ("5 0 0 0 0 0", "-5 0 0 0 0 0", "0 5 0 0 0 1.5707963", "0 -5 0 0 0 1.5707963")
    poses = (*sides, "0 0 5 0 1.5707963 0", "0 0 -5 0 1.5707963 0")
    parts = "".join(wall.format(i=i, p=p) for i, p in enumerate(poses))
    return load(camera(lens, hfov), f'<model name="r"><static>true</static><link name="l">{parts}</link></model>')


@pytest.mark.parametrize("size", ["", "<env_texture_size>64</env_texture_size>"])
def test_no_border_of_two_faces_shows(size: str) -> None:
    with around(f"<type>equidistant</type>{ALL_ROUND}{size}", 5.5) as sim:
        (image,) = shown(sim, "image")
    picture = colours(image)
    v, u = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    inside = np.hypot(u - WIDTH / 2, v - HEIGHT / 2) < math.pi / 2.75 * WIDTH / 2 - 3
    assert np.unique(picture[inside].reshape(-1, 3), axis=0).shape == (1, 3)
    assert picture[75, 100].min() > 100


def test_a_bar_is_continuous_across_the_border_of_two_faces() -> None:
    """The bar is 1 m above the axis, from the front to the far left; at y = 2 it crosses the border of two faces."""
    bar = box("bar", "2 2 1 0 0 0", "0.01 5 0.12")
    with load(camera("<type>equidistant</type>", 3.1), bar) as sim:
        (image,) = shown(sim, "image")
    picture = colours(image)[..., 0].astype(float)
    expected, found = [], []
    for y in np.linspace(0.3, 4.2, 60):
        angle = math.atan2(math.hypot(y, 1), 2)
        radius = angle / 1.55 * WIDTH / 2
        u, v = WIDTH / 2 - radius * y / math.hypot(y, 1), HEIGHT / 2 - radius / math.hypot(y, 1)
        rows = np.arange(max(0, int(v) - 6), min(HEIGHT, int(v) + 7))
        weights = np.clip(picture[rows, int(u)], 0, None)
        expected.append(v)
        found.append(np.average(rows + 0.5, weights=weights))
    np.testing.assert_allclose(found, expected, atol=0.75)  # half of it is where within a pixel a column is looked at


def test_only_faces_that_are_seen_are_drawn() -> None:
    def shots(name: str, hfov: float, cutoff: float = math.pi / 2) -> list[Any]:
        lens = LENSES[name].scaled_to(hfov)
        model = WideAngleModel(64, 64, 1, 1, 32, 32, hfov, 0.1, 100, lens=replace(lens, cutoff=cutoff))
        return CubeMap(model).shots

    assert [len(shots("stereographic", h)) for h in (1.0, 2.0, 3.1)] == [1, 5, 5]
    assert len(shots("equidistant", 6.2, 0.8)) == 1
    assert len(shots("equidistant", 6.2, 3.2)) == 6
    front, *sides = shots("equidistant", 3.1)
    assert all(s.view.width * s.view.height < 0.8 * front.view.width * front.view.height for s in sides)


def test_a_face_has_the_size_of_the_file() -> None:
    lens = LENSES["equidistant"].scaled_to(3.1)
    model = WideAngleModel(64, 64, 1, 1, 32, 32, 3.1, 0.1, 100, lens=lens, face_size=128)
    front = CubeMap(model).shots[0].view
    assert front.width == pytest.approx(128, abs=6)
    assert (front.right - front.left) / front.width == pytest.approx(2 / 128, rel=0.02)


# ---------------------------------------------------------------------- what is black


def test_beyond_the_cutoff_angle_it_is_black() -> None:
    with around("<type>equidistant</type><cutoff_angle>1.0</cutoff_angle>", 4.0) as sim:
        (image,) = shown(sim, "image")
    v, u = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    radius = np.hypot(u - WIDTH / 2, v - HEIGHT / 2) / (WIDTH / 2)
    picture = colours(image)[..., 0]
    assert (picture[radius > 0.5] == 0).all()
    full = picture[radius < 0.48]
    assert full.min() == full.max() > 100
    rim = picture[(radius > 0.485) & (radius < 0.497)]
    assert (
        0 < rim.min() < rim.max() < full.max()
    )  # the image fades within the last fiftieth of the radius, as in Gazebo


def test_an_orthographic_lens_shows_a_disc() -> None:
    with around("<type>orthographic</type>", math.pi) as sim:
        (image,) = shown(sim, "image")
    picture = colours(image)[..., 0]
    assert picture[75, 3:-3].min() > 50
    assert picture[0, 0] == picture[-1, -1] == 0


# ---------------------------------------------------------------------- CameraInfo


@pytest.mark.parametrize("name", ["stereographic", "equidistant", "equisolid_angle", "orthographic"])
def test_camera_info_is_opencvs_fisheye(name: str) -> None:
    formula, _ = FORMULAS[name]
    with load(camera(f"<type>{name}</type>", 3.0)) as sim:
        (info,) = shown(sim, "camera_info")
    assert info.distortion_model == "equidistant"
    angles = np.linspace(0.05, 1.45, 30)
    points = np.array([(math.sin(a) * 0.8, math.sin(a) * 0.6, math.cos(a)) for a in angles]).reshape(-1, 1, 3)
    k = np.array(info.k).reshape(3, 3)
    found, _ = cv2.fisheye.projectPoints(points, np.zeros(3), np.zeros(3), k, np.array(info.d))
    radii = np.array([formula(a) / formula(1.5) * WIDTH / 2 for a in angles])
    expected = np.stack((100 + 0.8 * radii, 75 + 0.6 * radii), axis=-1)
    np.testing.assert_allclose(found.reshape(-1, 2), expected, atol=0.05)
    if name == "equidistant":
        np.testing.assert_array_equal(info.d, np.zeros(4))
    np.testing.assert_allclose(np.array(info.p).reshape(3, 4)[:, :3], k)


def test_a_gnomonical_lens_is_a_pinhole() -> None:
    with load(camera("<type>gnomonical</type>", 1.2)) as sim:
        (info,) = shown(sim, "camera_info")
    assert (info.distortion_model, info.d.tolist()) == ("plumb_bob", [0.0] * 5)
    assert info.k[0] == pytest.approx(100 / math.tan(0.6), rel=1e-6)


def test_a_lens_that_ros_cannot_describe_is_reported() -> None:
    with load(camera(f"<type>stereographic</type>{ALL_ROUND}", 5.8)) as sim:
        assert [d.severity for d in sim.diagnostics if d.code == "SK-SENSOR-102"] == ["note"]


def test_with_gazebos_quirks_the_cutoff_is_a_right_angle_and_k_is_sdfs_default() -> None:
    block = camera("<type>equidistant</type><cutoff_angle>1</cutoff_angle><scale_to_hfov>false</scale_to_hfov>", 3.0)
    with load(block, top=DARK + "<gazebo_quirks>true</gazebo_quirks>") as sim:
        (info,) = shown(sim, "camera_info")
        model = sim.sensor("m::l::s").options.model
    assert info.k.tolist() == [277, 0, 160, 0, 277, 120, 0, 0, 1]
    assert (info.distortion_model, info.d.tolist()) == ("plumb_bob", [0.0] * 5)
    assert model.lens.cutoff == pytest.approx(math.pi / 2)
    assert float(model.lens.radius(np.array(1.5))) == pytest.approx(1.0)


# ---------------------------------------------------------------------- files


@pytest.mark.parametrize("kind", ["wide_angle_camera", "wideanglecamera"])
def test_topics_and_the_default_lens(kind: str) -> None:
    text = world(sensor(kind, "<camera><image><width>16</width><height>12</height></image></camera>"))
    with simkit.load(text) as sim:
        prefix = "/world/w/model/m/link/l/sensor/s/"
        assert {f"{prefix}image", f"{prefix}camera_info"} <= set(sim.topics())
        model = sim.sensor("m::l::s").options.model
        assert (model.lens.type, model.lens.cutoff, model.hfov) == ("stereographic", math.pi / 2, 1.047)


@pytest.mark.parametrize(
    ("lens", "hfov", "words"),
    [
        ("<type>gnomonical</type>", 3.3, ("gnomonical", "3.14")),
        ("<type>orthographic</type>", 4.0, ("orthographic", "3.14")),
        ("<type>fisheye</type>", 1.0, ("fisheye", "equisolid_angle")),
        ("<type>equidistant</type>", 7.0, ("7", "6.28")),
        (CUSTOM.format(c3=0, f=0, fun="tan"), 1.0, ("<f>0</f>",)),
        (CUSTOM.format(c3=9, f=1, fun="sin"), 1.0, ("c3 9",)),
        (CUSTOM.format(c3=0, f=1, fun="cos"), 1.0, ("cos", "sin, tan, id")),
        ("<env_texture_size>0</env_texture_size>", 1.0, ("env_texture_size", "8")),
    ],
)
def test_bad_lenses_are_errors(lens: str, hfov: float, words: tuple[str, ...]) -> None:
    with pytest.raises(simkit.LoadError) as caught:
        load(camera(lens, hfov))
    (found,) = caught.value.diagnostics
    assert found.code == "SK-PARAM-002"
    assert all(word in found.message for word in words)


def test_elements_without_effect_on_a_wide_lens_are_reported() -> None:
    lens = "<type>equidistant</type><custom_function><c1>2</c1></custom_function><intrinsics><fx>9</fx></intrinsics>"
    more = "<distortion><k1>0.1</k1></distortion>"
    with load(camera(lens, 3.0, more=more)) as sim:
        found = [d.message for d in sim.diagnostics if d.code == "SK-SENSOR-103"]
        assert not [d for d in sim.diagnostics if d.code == "SK-PARAM-003"]
    assert [any(f"<{n}>" in m for m in found) for n in ("custom_function", "intrinsics", "distortion")] == [True] * 3


def test_noise_and_grey_formats_work_as_for_any_camera() -> None:
    block = camera("<type>equidistant</type>", 3.0, more='<noise type="gaussian"><stddev>0.05</stddev></noise>')
    block = block.replace("<image>", "<image><format>L8</format>")
    with load(block, top=DARK.replace("0 0 0 1</background>", "0.5 0.5 0.5 1</background>")) as sim:
        (image,) = shown(sim, "image")
        truth = sim.sensor("m::l::s").truth
    assert image.encoding == "mono8"
    difference = colours(image).astype(float)[70:80] - colours(truth)[70:80]
    assert difference.std() == pytest.approx(0.05 * 255, rel=0.1)
