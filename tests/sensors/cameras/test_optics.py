"""Optics of pinhole cameras: intrinsics, skew, projection and lens distortion, compared with OpenCV."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import cv2
import numpy as np
import pytest
from sensor_worlds import box, cloud, colours, depths, sensor, world

import simkit
from simkit.sensors.cameras.camera_model import CameraModel
from simkit.sensors.cameras.distortion_model import Distortion, distort, undistort
from simkit.sensors.cameras.image_distortion import ImageDistorter

DARK = "<scene><ambient>1 1 1 1</ambient><background>0 0 0 1</background></scene>"
BRIGHT = "<scene><ambient>1 1 1 1</ambient><background>0.5 0.5 0.5 1</background></scene>"
QUIRKS = "<gazebo_quirks>true</gazebo_quirks>"
LENSES = (
    Distortion(-0.2, 0.03, 0, 0.001, 0.002),
    Distortion(0.25, 0.1, 0.02, -0.003, 0.002),
    Distortion(-0.35, 0.15, -0.02, 0.0005, -0.0005),
)
ALL_LENSES = pytest.mark.parametrize("lens", LENSES, ids=("barrel", "pincushion", "strong"))


def camera(more: str = "", *, width: int = 160, height: int = 120, hfov: float = 1.2) -> str:
    return f"""<camera><horizontal_fov>{hfov}</horizontal_fov>
      <image><width>{width}</width><height>{height}</height></image>{more}</camera>"""


def load(block: str, others: str = "", *, kind: str = "camera", top: str = DARK) -> Any:
    return simkit.load(world(sensor(kind, block, extra="<topic>cam/image</topic>"), others=others, top=top))


def shown(sim: Any, *products: str) -> list[Any]:
    """Return the first message of each product of a camera."""
    found = sim.sensor("m::l::s")._topics
    subs = [sim.subscribe(found[p]) for p in products]
    sim.run(0.02)
    return [s.messages[0] for s in subs]


def distortion(lens: Distortion, more: str = "") -> str:
    names = ("k1", "k2", "k3", "p1", "p2")
    return f"<distortion>{''.join(f'<{n}>{getattr(lens, n)}</{n}>' for n in names)}{more}</distortion>"


def spots(places: Sequence[tuple[float, float]], size: float = 0.08, distance: float = 1.0) -> str:
    """Squares around (x, y) at distance 1 of the camera, x to its right and y downwards, scaled to `distance`.

    The squares are rotated, so that their edges cross pixels at many positions. The centre of a square is then known
    more exactly than one pixel.
    """
    return "".join(
        box(f"spot{i}", f"{distance} {-x * distance} {1 - y * distance} 0.5 0 0", f"0.0002 {size} {size}")
        for i, (x, y) in enumerate(places)
    )


def middles(message: Any) -> np.ndarray:
    """Return the centres (u, v) of bright spots, weighted by brightness, shape (n, 2), from left to right."""
    grey = colours(message)[..., 0].astype(float)
    count, labels = cv2.connectedComponents((grey > 60).astype(np.uint8))
    found = []
    for i in range(1, count):
        rows, columns = np.nonzero(cv2.dilate((labels == i).astype(np.uint8), np.ones((3, 3), np.uint8)))
        weights = grey[rows, columns]
        found.append((np.average(columns + 0.5, weights=weights), np.average(rows + 0.5, weights=weights)))
    return np.array(sorted(found))


def seen_by_opencv(places: Sequence[tuple[float, float]], info: Any) -> np.ndarray:
    points = np.array([(x, y, 1.0) for x, y in places])
    found, _ = cv2.projectPoints(points, np.zeros(3), np.zeros(3), np.array(info.k).reshape(3, 3), np.array(info.d))
    return np.array(sorted(found.reshape(-1, 2).tolist()))


# ---------------------------------------------------------------------- intrinsics


def info_of(block: str, *, kind: str = "camera", top: str = DARK) -> Any:
    with load(block, kind=kind, top=top) as sim:
        return shown(sim, "camera_info")[0]


@pytest.mark.parametrize("hfov", [0.001, 0.5, 2.6, 3.14])
def test_k_follows_the_opening_angle(hfov: float) -> None:
    info = info_of(camera(hfov=hfov, width=64, height=48))
    f = 32 / math.tan(hfov / 2)
    np.testing.assert_allclose(info.k, (f, 0, 32, 0, f, 24, 0, 0, 1))
    np.testing.assert_allclose(info.p, (f, 0, 32, 0, 0, f, 24, 0, 0, 0, 1, 0))
    np.testing.assert_array_equal(info.r, np.eye(3).ravel())
    assert (info.distortion_model, info.d.tolist()) == ("plumb_bob", [0.0] * 5)


@pytest.mark.parametrize("given", ["3.1416", "60", "0.0001", "-1", "nan"])
def test_an_opening_angle_that_no_pinhole_has_is_an_error(given: str) -> None:
    with pytest.raises(simkit.LoadError) as caught:
        load(camera().replace("1.2", given))
    (found,) = caught.value.diagnostics
    assert found.code == "SK-PARAM-002"
    assert given[:4] in found.message
    assert "0.001" in found.message


def test_an_opening_angle_of_a_fisheye_names_the_sensor_for_it() -> None:
    with pytest.raises(simkit.LoadError, match="wide_angle_camera"):
        load(camera(hfov=4))


@pytest.mark.parametrize("hfov", [0.02, 3.0])
def test_very_narrow_and_very_wide_images_are_in_place(hfov: float) -> None:
    f = 80 / math.tan(hfov / 2)
    place = (20 / f, -15 / f)
    with load(camera(hfov=hfov), spots([place], size=12 / f)) as sim:
        np.testing.assert_allclose(middles(*shown(sim, "image")), [(100, 45)], atol=0.5)


INTRINSICS = "<intrinsics><fx>120</fx><fy>90</fy><cx>70</cx><cy>66</cy><s>{}</s></intrinsics>"
PLACES = [(-0.4, -0.3), (-0.2, 0.35), (0.3, -0.45), (0.55, 0.4)]


@pytest.mark.parametrize("skew", [0, 25, -40])
def test_given_intrinsics_are_drawn_with_their_skew(skew: float) -> None:
    with load(camera(f"<lens>{INTRINSICS.format(skew)}</lens>"), spots(PLACES)) as sim:
        image, info = shown(sim, "image", "camera_info")
        assert not [d for d in sim.diagnostics if d.code.startswith("SK-SENSOR")]
    expected = sorted((120 * x + skew * y + 70, 90 * y + 66) for x, y in PLACES)
    np.testing.assert_allclose(middles(image), expected, atol=0.25)
    np.testing.assert_allclose(info.k, (120, skew, 70, 0, 90, 66, 0, 0, 1))
    np.testing.assert_allclose(info.p, (120, skew, 70, 0, 0, 90, 66, 0, 0, 0, 1, 0))


def test_a_skewed_view_is_wide_enough() -> None:
    model = CameraModel(160, 120, 120, 90, 70, 66, 1.2, 0.1, 100, skew=40)
    view = ImageDistorter(model).view()
    x, y = model.directions()
    assert view.left < x.min() < x.max() < view.right
    assert -view.top < y.min() < y.max() < -view.bottom


def test_p_contains_the_projection_and_the_image_follows_k() -> None:
    projection = "<projection><p_fx>100</p_fx><p_cy>55</p_cy><tx>-8</tx><ty>2</ty></projection>"
    with load(camera(f"<lens>{INTRINSICS.format(0)}{projection}</lens>"), spots(PLACES)) as sim:
        image, info = shown(sim, "image", "camera_info")
        assert [d.severity for d in sim.diagnostics if d.code == "SK-SENSOR-006"] == ["note", "note"]
    np.testing.assert_allclose(info.p, (100, 0, 70, -8, 0, 90, 55, 2, 0, 0, 1, 0))
    np.testing.assert_allclose(middles(image), sorted((120 * x + 70, 90 * y + 66) for x, y in PLACES), atol=0.25)


def test_with_gazebos_quirks_projection_draws_the_image() -> None:
    projection = "<projection><p_fx>100</p_fx><p_fy>90</p_fy><p_cx>70</p_cx><p_cy>55</p_cy></projection>"
    block = camera(f"<lens>{INTRINSICS.format(20)}{projection}</lens>")
    with load(block, spots(PLACES), top=DARK + QUIRKS) as sim:
        image, info = shown(sim, "image", "camera_info")
    np.testing.assert_allclose(middles(image), sorted((100 * x + 70, 90 * y + 55) for x, y in PLACES), atol=0.25)
    np.testing.assert_allclose(info.k, (120, 0, 70, 0, 90, 66, 0, 0, 1))
    assert info.p[6] == 55


def test_with_gazebos_quirks_skew_is_opposite_and_there_is_no_distortion() -> None:
    block = camera(f"<lens>{INTRINSICS.format(25)}</lens>{distortion(LENSES[0])}")
    with load(block, spots(PLACES), top=DARK + QUIRKS) as sim:
        image, info = shown(sim, "image", "camera_info")
    expected = sorted((120 * x - 25 * y + 70, 90 * y + 66) for x, y in PLACES)
    np.testing.assert_allclose(middles(image), expected, atol=0.25)
    assert info.k[1] == 0
    np.testing.assert_allclose(info.d, (-0.2, 0.03, 0.001, 0.002, 0))


# ---------------------------------------------------------------------- distortion


@ALL_LENSES
def test_undistorted_points_agree_with_opencv(lens: Distortion) -> None:
    y, x = np.meshgrid(np.linspace(-0.4, 0.4, 9), np.linspace(-0.5, 0.5, 11), indexing="ij")
    points = np.stack((x, y), axis=-1).reshape(-1, 1, 2)
    stop = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 500, 1e-12)
    expected = cv2.undistortPoints(points, np.eye(3), lens.coefficients, criteria=stop).reshape(9, 11, 2)
    np.testing.assert_allclose(np.stack(undistort(x, y, lens), axis=-1), expected, atol=1e-7)


@ALL_LENSES
def test_distorted_points_agree_with_opencv(lens: Distortion) -> None:
    y, x = np.meshgrid(np.linspace(-0.5, 0.5, 9), np.linspace(-0.7, 0.7, 11), indexing="ij")
    points = np.stack((x, y, np.ones_like(x)), axis=-1).reshape(-1, 1, 3)
    expected, _ = cv2.projectPoints(points, np.zeros(3), np.zeros(3), np.eye(3), lens.coefficients)
    np.testing.assert_allclose(np.stack(distort(x, y, lens), axis=-1).reshape(-1, 1, 2), expected, atol=1e-12)
    np.testing.assert_allclose(undistort(*distort(x, y, lens), lens), (x, y), atol=1e-9)


def test_beyond_the_fold_directions_are_nan() -> None:
    lens = Distortion(-0.5)  # folds back at r² = 1 / 1.5, seen at r = 0.5443
    x = np.array([[0.0, 0.544, 0.545, 2.0]])
    found, _ = undistort(x, np.zeros_like(x), lens)
    assert np.isnan(found).tolist() == [[False, False, True, True]]


@ALL_LENSES
def test_a_distorted_image_agrees_with_opencvs_projection(lens: Distortion) -> None:
    places = [(-0.6, -0.4), (-0.3, 0.1), (0.02, -0.25), (0.25, 0.42), (0.6, -0.1)]
    block = camera(distortion(lens), width=320, height=240, hfov=1.5)
    with load(block, spots(places, size=0.05)) as sim:
        image, info = shown(sim, "image", "camera_info")
    np.testing.assert_allclose(info.d, (lens.k1, lens.k2, lens.p1, lens.p2, lens.k3))
    np.testing.assert_allclose(middles(image), seen_by_opencv(places, info), atol=0.3)


@ALL_LENSES
def test_a_distorted_image_has_no_black_corners(lens: Distortion) -> None:
    with load(camera(distortion(lens), hfov=1.0), top=BRIGHT) as sim:
        (image,) = shown(sim, "image")
    assert colours(image).min() > 100


def test_distortion_is_about_the_principal_point_and_with_skew_too() -> None:
    block = camera(f"<lens>{INTRINSICS.format(25)}</lens>{distortion(LENSES[0])}")
    with load(block, spots(PLACES)) as sim:
        (image,) = shown(sim, "image")
    bent = [distort(np.array(x), np.array(y), LENSES[0]) for x, y in PLACES]
    expected = sorted((120 * x + 25 * y + 70, 90 * y + 66) for x, y in bent)
    np.testing.assert_allclose(middles(image), expected, atol=0.3)


def test_a_centre_off_the_principal_point_is_drawn_and_reported() -> None:
    with load(camera(distortion(LENSES[0], "<center>0.4 0.6</center>")), spots(PLACES)) as sim:
        image, info = shown(sim, "image", "camera_info")
        assert [d.severity for d in sim.diagnostics if d.code == "SK-SENSOR-100"] == ["warning"]
    f = info.k[0]
    off = np.array((64 - 80, 72 - 60)) / f
    bent = [np.array(distort(*np.array(p - off).reshape(2, 1), LENSES[0])).ravel() for p in np.array(PLACES)]
    expected = sorted(((b + off) * f + (80, 60)).tolist() for b in bent)
    np.testing.assert_allclose(middles(image), expected, atol=0.3)


def test_a_centre_on_the_principal_point_is_not_reported() -> None:
    lens = INTRINSICS.format(0)
    with load(camera(f"<lens>{lens}</lens>{distortion(LENSES[0], '<center>0.4375 0.55</center>')}")) as sim:
        assert "SK-SENSOR-100" not in {d.code for d in sim.diagnostics}


def test_a_lens_that_folds_back_is_reported_and_black_beyond_the_fold() -> None:
    with load(camera(distortion(Distortion(-0.5)), hfov=1.5), top=BRIGHT) as sim:
        (found,) = (d for d in sim.diagnostics if d.code == "SK-SENSOR-101")
        (image,) = shown(sim, "image")
    black = (colours(image) == 0).all(axis=-1)
    f = 80 / math.tan(0.75)
    v, u = np.mgrid[:120, :160] + 0.5
    radius = np.hypot(u - 80, v - 60) / f
    assert black[radius > 0.55].all()
    assert not black[radius < 0.535].any()
    assert f"{black.mean():.0%}"[:1] in found.message


def test_pixels_that_a_strong_lens_compresses_are_averaged() -> None:
    """Stripes are one pixel wide. In a corner, two stripes fall on one pixel and give grey instead of a pattern."""
    lens = ImageDistorter(CameraModel(160, 120, 90, 90, 80, 60, 1.4, 0.1, 100, distortion=Distortion(-0.3, 0.08)))
    view = lens.view()
    stripes = np.zeros((view.height, view.width, 3), np.uint8)
    stripes[:, ::2] = 255
    corner = lens.distort(stripes)[:12, :12, 0].astype(float)
    assert corner.mean() == pytest.approx(127.5, abs=4)
    assert corner.std() < 25
    assert lens.distort(stripes)[55:65, 75:85, 0].std() > 100


@pytest.mark.parametrize("size", [(1, 1), (1, 7), (7, 1)])
def test_the_smallest_images_are_distorted_too(size: tuple[int, int]) -> None:
    block = camera(distortion(LENSES[0]), width=size[0], height=size[1])
    with load(block, top=BRIGHT) as sim:
        (image,) = shown(sim, "image")
    assert colours(image).min() > 100


def test_pixels_that_are_not_square_are_drawn_so() -> None:
    lens = "<lens><intrinsics><fx>200</fx><fy>50</fy><cx>80</cx><cy>60</cy></intrinsics></lens>"
    with load(camera(lens), spots([(0.2, 0.4)], size=0.1)) as sim:
        image, _ = shown(sim, "image", "camera_info")
    np.testing.assert_allclose(middles(image), [(120, 80)], atol=0.3)


# ---------------------------------------------------------------------- depth


BENT = [f"<lens>{INTRINSICS.format(25)}</lens>", distortion(LENSES[0]), distortion(LENSES[1])]
BENT_IDS = ("skewed", "barrel", "pincushion")


def points_of(message: Any) -> np.ndarray:
    found = cloud(message)
    return np.stack((found["x"], found["y"], found["z"]), axis=-1).astype(np.float64)


def projected(points: np.ndarray, info: Any) -> np.ndarray:
    """Return the pixels (u, v), shape (n, 2), of points (x forward, y left, z up), from K (with skew) and D."""
    lens = Distortion(info.d[0], info.d[1], info.d[4], info.d[2], info.d[3])
    x, y = distort(-points[..., 1] / points[..., 0], -points[..., 2] / points[..., 0], lens)
    k = np.array(info.k).reshape(3, 3)
    return np.stack((k[0, 0] * x + k[0, 1] * y + k[0, 2], k[1, 1] * y + k[1, 2]), axis=-1)


@pytest.mark.parametrize("lens", BENT, ids=BENT_IDS)
def test_a_tilted_plane_stays_a_plane(lens: str) -> None:
    wall = box("wall", "3 0 1 0 0 0.5235987755982988", "0.02 20 20")
    with load(camera(lens), wall, kind="rgbd_camera") as sim:
        message, depth, info = shown(sim, "points", "depth_image", "camera_info")
    points = points_of(message)
    normal = np.array((math.cos(math.pi / 6), math.sin(math.pi / 6), 0))
    distance = points @ normal - (3 * math.cos(math.pi / 6) - 0.01)
    inside = np.s_[2:-2, 2:-2]
    assert np.abs(distance[inside]).max() < 1e-3
    np.testing.assert_array_equal(depths(depth), points[..., 0].astype(np.float32))
    v, u = np.mgrid[:120, :160] + 0.5
    np.testing.assert_allclose(projected(points, info), np.stack((u, v), axis=-1), atol=0.01)


@pytest.mark.parametrize("lens", BENT, ids=BENT_IDS)
def test_a_colours_corner_lies_at_its_own_point(lens: str) -> None:
    """A white square is in front of a red wall: white pixels have near depths, and corners project to their pixels."""
    wall = box("wall", "4 0 1 0 0 0", "0.1 20 20", colour="1 0 0")
    others = box("square", "2.01 0.3 1.4 0 0 0", "0.02 0.6 0.5") + wall
    with load(camera(lens), others, kind="rgbd_camera") as sim:
        message, image, info = shown(sim, "points", "image", "camera_info")
    points = points_of(message)
    is_white = colours(image)[..., 1] > 100
    is_near = points[..., 0] < 3
    assert (is_white != is_near).sum() <= 0.15 * cv2.Laplacian(is_near.astype(np.uint8), cv2.CV_8U).astype(bool).sum()
    corners = np.array([(2.0, y, z) for y in (0.0, 0.6) for z in (0.15, 0.65)])
    for pixel in projected(corners, info):
        assert np.abs(projected(points[is_near], info) - pixel).max(axis=1).min() < 1.0  # the next pixel's middle


@pytest.mark.parametrize("lens", BENT, ids=BENT_IDS)
def test_no_point_is_between_two_surfaces(lens: str) -> None:
    others = box("near", "1.5 0 1 0.4 0 0", "0.02 0.6 0.5") + box("wall", "4 0 1 0 0 0", "0.1 20 20")
    with load(camera(lens), others, kind="depth_camera") as sim:
        (depth,) = shown(sim, "depth_image")
    found = depths(depth)
    distance = np.minimum(np.abs(found - 1.49), np.abs(found - 3.95))
    assert distance.max() < 1e-3


def test_nothing_is_at_infinity_where_the_lens_shows_nothing() -> None:
    block, wall = camera(distortion(Distortion(-0.5)), hfov=1.5), box("wall", "4 0 1 0 0 0", "0.1 90 90")
    with load(block, wall, kind="rgbd_camera") as sim:
        depth, message = shown(sim, "depth_image", "points")
    found = depths(depth)
    assert found[0, 0] == math.inf
    assert found[60, 80] == pytest.approx(3.95, abs=1e-4)
    assert not np.isnan(points_of(message)).any()
