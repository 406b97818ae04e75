"""Thermal cameras: temperatures of objects, of the air and of the sky, in steps of a resolution."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

import simkit
from simkit.runtime.handles.visual import HeatSignature

WIDTH, HEIGHT, HFOV, FAR = 64, 48, 1.047, 100.0
SPAN = 0.0065 * 2 * FAR * math.tan(HFOV / 2) * HEIGHT / WIDTH
"""Temperature difference of the standard air over the height of the view [K]."""
AIR = 288.15
BOX = "<box><size>1 1 1</size></box>"


def warm(content: str) -> str:
    return f'<plugin filename="gz-sim-thermal-system" name="gz::sim::systems::Thermal">{content}</plugin>'


def box_model(name: str, place: str, more: str = "", shape: str = BOX) -> str:
    return (
        f'<model name="{name}"><static>true</static><pose>{place}</pose><link name="l">'
        f'<visual name="v"><geometry>{shape}</geometry>{more}</visual></link></model>'
    )


def paint(colour: str) -> str:
    return f"<material><ambient>{colour} 1</ambient><diffuse>{colour} 1</diffuse></material>"


def world(
    models: str = "",
    *,
    fmt: str = "L16",
    more: str = "",
    plugin: str = "",
    top: str = "",
    kind: str = "thermal_camera",
    clip: str = f"<near>0.1</near><far>{FAR:g}</far>",
) -> str:
    set_up = f'<plugin filename="gz-sim-thermal-sensor-system" name="gz::sim::systems::ThermalSensor">{plugin}</plugin>'
    fmt = f"<format>{fmt}</format>" if fmt else ""
    return f"""<sdf version="1.9" xmlns:simkit="https://simkit.invalid"><world name="w">{top}
      <model name="eye"><static>true</static><link name="l"><sensor name="s" type="{kind}"><update_rate>20</update_rate>
        <camera><horizontal_fov>{HFOV}</horizontal_fov><image><width>{WIDTH}</width><height>{HEIGHT}</height>{fmt}</image>
        <clip>{clip}</clip>{more}</camera>{set_up if plugin else ""}</sensor></link></model>
      {models}</world></sdf>"""


def atmosphere(kelvins: float, gradient: float = 0.0) -> str:
    settings = f"<temperature>{kelvins}</temperature><temperature_gradient>{gradient}</temperature_gradient>"
    return f'<atmosphere type="adiabatic">{settings}</atmosphere>'


def pixels(message: Any) -> Any:
    kind = {"mono16": "<u2", "mono8": "u1"}[message.encoding]
    return np.asarray(message.data).view(kind).reshape(message.height, message.width).astype(int)


def first_image(text: str) -> Any:
    with simkit.load(text) as sim:
        sim.run(0.001)
        return pixels(sim.sensor("eye::l::s").latest)


MIDDLE = (HEIGHT // 2, WIDTH // 2)


# ---------------------------------------------------------------------- temperatures


def test_a_warm_box_shows_its_temperature_and_all_around_it_the_airs() -> None:
    """As in gz-sensors' own test, a box of 310 K is 3 m ahead in air of 296 K."""
    box = box_model("box", "3 0 0 0 0 0", warm("<temperature>310</temperature>"))
    picture = first_image(world(box, top=atmosphere(296)))
    half = 0.5 / 2.5 * WIDTH / 2 / math.tan(HFOV / 2)
    columns = np.flatnonzero(picture[MIDDLE[0]] == 31000)
    assert len(columns) == pytest.approx(2 * half, abs=1)
    assert set(np.unique(picture)) == {29600, 31000}
    assert picture[MIDDLE] == 31000
    assert picture[0, 0] == picture[-1, -1] == 29600


def test_without_an_atmosphere_the_air_is_the_standard_one() -> None:
    assert set(np.unique(first_image(world()))) == {28815}


@pytest.mark.parametrize(("colour", "brightness"), [("0 0 0", 0), ("1 1 1", 1), ("1 0 0", 0.299), ("0 0 1", 0.114)])
def test_objects_without_a_temperature_vary_a_little_with_their_colour(colour: str, brightness: float) -> None:
    picture = first_image(world(box_model("box", "3 0 0 0 0 0", paint(colour))))
    assert picture[MIDDLE] == pytest.approx((AIR + (brightness - 0.5) * SPAN) * 100, abs=1)
    assert picture[0, 0] == 28815


def test_the_temperature_span_is_the_gradient_times_the_height_of_the_view() -> None:
    white, black = box_model("a", "3 0.7 0 0 0 0", paint("1 1 1")), box_model("b", "3 -0.7 0 0 0 0", paint("0 0 0"))
    row = first_image(world(white + black, top=atmosphere(300, 0.1)))[MIDDLE[0]]
    assert row.max() - row.min() == pytest.approx(0.1 / 0.0065 * SPAN * 100, abs=2)
    assert (row.max() + row.min()) / 2 == pytest.approx(30000, abs=1)


def test_light_and_shadow_do_not_warm() -> None:
    lamp = '<light name="sun" type="directional"><direction>0.3 0.5 -1</direction></light>'
    box = box_model("box", "3 0 -1 0 0 0.5", paint("1 1 1"))
    assert set(np.unique(first_image(world(box)))) == set(np.unique(first_image(world(box, top=lamp))))


def test_an_object_in_front_hides_the_object_behind() -> None:
    hot = box_model("hot", "4 0 0 0 0 0", warm("<temperature>400</temperature>"))
    cold = box_model(
        "cold", "2 0 0 0 0 0", warm("<temperature>250</temperature>"), "<sphere><radius>0.1</radius></sphere>"
    )
    picture = first_image(world(hot + cold))
    assert picture[MIDDLE] == 25000
    assert (picture == 40000).sum() > (picture == 25000).sum() > 10


def test_objects_before_the_near_plane_are_seen_and_objects_beyond_the_far_plane_are_not() -> None:
    """As in gz-sensors' own test, one box has its face halfway to the near plane, and one is beyond the far plane."""
    clip = "<near>0.2</near><far>10</far>"
    hot = warm("<temperature>310</temperature>")
    assert first_image(world(box_model("box", "0.6 0 0 0 0 0", hot), clip=clip))[MIDDLE] == 31000
    assert first_image(world(box_model("box", "15.5 0 0 0 0 0", hot), clip=clip, top=atmosphere(296)))[MIDDLE] == 29600


# ---------------------------------------------------------------------- formats and range


def test_eight_bits_come_in_steps_of_three_kelvin() -> None:
    """As in gz-sim's own test, 600 K is step 200, 800 K is more than the last step, and -10 K is step 0."""
    temperatures = {600: 200, 800: 255, -10: 0, 310: 103}
    for kelvins, steps in temperatures.items():
        box = box_model("box", "3 0 0 0 0 0", warm(f"<temperature>{kelvins}</temperature>"))
        assert first_image(world(box, fmt="L8"))[MIDDLE] == steps


def test_a_temperature_above_the_largest_pixel_value_is_clipped() -> None:
    assert first_image(world(box_model("box", "3 0 0 0 0 0", warm("<temperature>900</temperature>"))))[MIDDLE] == 65535


def test_the_message_is_an_image_of_sixteen_bits() -> None:
    for fmt, encoding, step in (
        ("L16", "mono16", 128),
        ("L_INT16", "mono16", 128),
        ("", "mono16", 128),
        ("L8", "mono8", 64),
    ):
        with simkit.load(world(fmt=fmt)) as sim:
            sim.run(0.001)
            message = sim.sensor("eye::l::s").latest
            assert (message.encoding, message.step, message.width, message.height) == (encoding, step, WIDTH, HEIGHT)
            assert len(message.data) == step * HEIGHT
            assert not [d for d in sim.diagnostics if d.code == "SK-SENSOR-140"]


def test_the_image_and_its_camera_info_are_in_the_optical_frame_where_one_is_named() -> None:
    with simkit.load(world(more="<optical_frame_id>eye_optical</optical_frame_id>")) as sim:
        base = "/world/w/model/eye/link/l/sensor/s"
        subs = [sim.subscribe(f"{base}/{name}") for name in ("image", "camera_info")]
        sim.run(0.001)
        assert [sub.latest.header.frame_id for sub in subs] == ["eye_optical", "eye_optical"]


def test_a_format_without_temperatures_is_reported() -> None:
    with simkit.load(world(fmt="R8G8B8")) as sim:
        assert [d.code for d in sim.diagnostics] == ["SK-SENSOR-140"]
        sim.run(0.001)
        assert sim.sensor("eye::l::s").latest.encoding == "mono16"


def test_range_and_resolution_are_set_by_a_plugin() -> None:
    hot, cold = (warm(f"<temperature>{t}</temperature>") for t in (700, 200))
    models = box_model("hot", "3 0.6 0 0 0 0", hot) + box_model("cold", "3 -0.6 0 0 0 0", cold)
    plugin = "<min_temp>253.15</min_temp><max_temp>673.15</max_temp><resolution>0.05</resolution>"
    row = first_image(world(models, plugin=plugin))[MIDDLE[0]]
    assert (row.max(), row.min()) == (round(673.15 / 0.05), round(253.15 / 0.05))


def test_one_end_of_the_range_leaves_the_other_open() -> None:
    hot = box_model("hot", "3 0 0 0 0 0", warm("<temperature>600</temperature>"))
    assert first_image(world(hot, plugin="<min_temp>300</min_temp>"))[MIDDLE] == 60000
    picture = first_image(world(hot, plugin="<max_temp>500</max_temp>"))
    assert (picture[MIDDLE], picture[0, 0]) == (50000, 28815)


def test_an_inverted_range_or_no_resolution_is_a_warning_and_uses_the_defaults() -> None:
    """The values are those of gz-sim's own test."""
    hot = box_model("hot", "3 0 0 0 0 0", warm("<temperature>600</temperature>"))
    plugin = "<min_temp>999</min_temp><max_temp>-590</max_temp><resolution>0</resolution>"
    with simkit.load(world(hot, fmt="L8", plugin=plugin)) as sim:
        assert [d.code for d in sim.diagnostics if d.severity != "note"] == ["SK-SENSOR-141"] * 2
        sim.run(0.001)
        assert pixels(sim.sensor("eye::l::s").latest)[MIDDLE] == 200


def test_topics_are_gazebos_and_camera_info_is_in_the_same_namespace() -> None:
    for kind in ("thermal_camera", "thermal"):
        with simkit.load(world(kind=kind)) as sim:
            base = "/world/w/model/eye/link/l/sensor/s"
            assert sim.topics()[f"{base}/image"] == "sensor_msgs/msg/Image"
            sub = sim.subscribe(f"{base}/camera_info")
            sim.run(0.001)
            assert sub.latest.k[0] == pytest.approx(WIDTH / 2 / math.tan(HFOV / 2))


# ---------------------------------------------------------------------- noise


def test_noise_is_a_part_of_the_full_range_and_fresh_in_each_image() -> None:
    noisy = world(more='<noise type="gaussian"><mean>0.001</mean><stddev>0.002</stddev></noise>')
    with simkit.load(noisy, seed=1) as sim:
        sensor, found = sim.sensor("eye::l::s"), []
        for _ in range(4):
            sim.run(0.05)
            found.append(pixels(sensor.latest) - 28815)
        assert set(np.unique(pixels(sensor.truth))) == {28815}
    draws = np.stack(found) / 65535
    assert draws.mean() == pytest.approx(0.001, abs=1e-4)
    assert draws.std() == pytest.approx(0.002, rel=0.03)
    assert abs(np.corrcoef(draws.reshape(4, -1))[np.triu_indices(4, 1)]).max() < 0.08


# ---------------------------------------------------------------------- heat signatures


def picture_of(path: Path, red: Any) -> Path:
    image = np.zeros((*np.shape(red), 3), np.uint8)
    image[..., 2] = red  # OpenCV's order
    image[..., 0] = 77  # which must not matter
    cv2.imwrite(str(path), image)
    return path


def signature(path: Path, more: str) -> str:
    return warm(f"<heat_signature>{path.name}</heat_signature>{more}")


def load_beside(folder: Path, text: str, **how: Any) -> Any:
    (folder / "w.sdf").write_text(text)
    return simkit.load(folder / "w.sdf", **how)


def shown(folder: Path, text: str) -> Any:
    with load_beside(folder, text) as sim:
        sim.run(0.001)
        return pixels(sim.sensor("eye::l::s").latest)


def test_an_even_signature_is_between_the_coldest_and_the_hottest(tmp_path: Path) -> None:
    grey = picture_of(tmp_path / "grey.png", np.full((8, 8), 102))
    box = box_model("box", "3 0 0 0 0 0", signature(grey, "<min_temp>100</min_temp><max_temp>200</max_temp>"))
    assert shown(tmp_path, world(box))[MIDDLE] == 14000


def test_a_signature_is_mapped_onto_the_surface_like_a_texture(tmp_path: Path) -> None:
    """Seen from -x, the left edge of the image is at the box's +y side, and the first row is at the top."""
    red = np.zeros((64, 64))
    red[:32, :32], red[:32, 32:], red[32:, :32], red[32:, 32:] = 0, 51, 102, 255
    path = picture_of(tmp_path / "quarters.png", red)
    box = box_model("box", "3 0 0 0 0 0", signature(path, "<min_temp>200</min_temp><max_temp>300</max_temp>"))
    picture = shown(tmp_path, world(box))
    (row, column), d = MIDDLE, 4
    corners = [picture[row + a, column + b] for a in (-d, d) for b in (-d, d)]
    assert corners == [20000, 22000, 24000, 30000]


def test_a_signature_is_looked_up_exactly_where_a_ray_hits(tmp_path: Path) -> None:
    """The image is a linear slope, so the face is 0 K warmer at its left edge and 100 K warmer at its right edge."""
    slope = np.tile(np.linspace(0, 255, 256).round(), (4, 1))
    path = picture_of(tmp_path / "slope.png", slope)
    shape = "<box><size>0.2 2 2</size></box>"
    plate = box_model(
        "p", "3 0 0 0 0.4 0.3", signature(path, "<min_temp>250</min_temp><max_temp>350</max_temp>"), shape
    )
    picture = shown(tmp_path, world(plate))
    from simkit import Pose

    pose = Pose.from_rpy(3, 0, 0, 0, 0.4, 0.3)
    f = WIDTH / 2 / math.tan(HFOV / 2)
    for row, column in ((24, 20), (24, 32), (15, 40), (33, 28)):
        way = np.array((1, -(column + 0.5 - WIDTH / 2) / f, -(row + 0.5 - HEIGHT / 2) / f))
        # the face at -x of the plate: n·(t·way - p) = -0.1
        normal, right = pose.rotate((1, 0, 0)), pose.rotate((0, -1, 0))
        t = (normal @ pose.position - 0.1) / (normal @ way)
        across = right @ (t * way - pose.position) / 2 + 0.5
        assert picture[row, column] == pytest.approx(25000 + 10000 * (across * 256 - 0.5) / 255, abs=8)


@pytest.mark.parametrize(
    "shape",
    [
        "<sphere><radius>0.5</radius></sphere>",
        "<cylinder><radius>0.5</radius><length>1</length></cylinder>",
        "<capsule><radius>0.4</radius><length>0.6</length></capsule>",
    ],
)
def test_every_shape_shows_its_signature_upright(shape: str, tmp_path: Path) -> None:
    red = np.zeros((32, 32))
    red[16:] = 255
    path = picture_of(tmp_path / "halves.png", red)
    hot = signature(path, "<min_temp>200</min_temp><max_temp>400</max_temp>")
    column = shown(tmp_path, world(box_model("thing", "3 0 0 0 0 0", hot, shape)))[:, WIDTH // 2]
    found = column[(column < 25000) | (column > 35000)]
    assert len(found) >= 10
    assert (np.diff(found) >= 0).all()
    assert (found[0], found[-1]) == (20000, 40000)


def test_a_plane_shows_its_signature_once_over_its_size(tmp_path: Path) -> None:
    """The camera looks from above, and the plane's x axis points to the top of the image."""
    red = np.zeros((32, 32))
    red[:, 16:] = 255  # at +x of the plane
    path = picture_of(tmp_path / "halves.png", red)
    hot = signature(path, "<min_temp>200</min_temp><max_temp>400</max_temp>")
    floor = box_model("floor", "3 0 -1 0 0 0", hot, "<plane><normal>0 0 1</normal><size>2 2</size></plane>")
    column = shown(tmp_path, world(floor))[:, WIDTH // 2]
    f = WIDTH / 2 / math.tan(HFOV / 2)
    depth = f / (np.arange(HEIGHT) + 0.5 - HEIGHT / 2)
    assert set(column[(depth > 2.1) & (depth < 2.9)]) == {20000}
    assert set(column[(depth > 3.1) & (depth < 3.9)]) == {40000}


def test_a_mesh_has_its_signature_by_texture_coordinates_or_its_mean_without_them(tmp_path: Path) -> None:
    """A square faces the camera; its texture coordinates show only the left half of the heat image, rotated."""
    red = np.zeros((32, 32))
    red[:, 16:], red[16:, :16] = 255, 51
    path = picture_of(tmp_path / "picture.png", red)
    corners = "v 0 0.5 -0.5\nv 0 -0.5 -0.5\nv 0 -0.5 0.5\nv 0 0.5 0.5\n"
    coordinates = "vt 0.45 0.95\nvt 0.05 0.95\nvt 0.05 0.05\nvt 0.45 0.05\n"
    (tmp_path / "worn.obj").write_text(f"{corners}{coordinates}f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n")
    (tmp_path / "bare.obj").write_text(f"{corners}f 1 2 3\nf 1 3 4\n")
    hot = signature(path, "<min_temp>200</min_temp><max_temp>300</max_temp>")
    found = {}
    for name in ("worn", "bare"):
        shape = f"<mesh><uri>{name}.obj</uri><scale>1 2 2</scale></mesh>"
        picture = shown(tmp_path, world(box_model("square", "3 0 0 0 0 0", hot, shape)))
        found[name] = picture[MIDDLE[0] - 6, MIDDLE[1]], picture[MIDDLE[0] + 6, MIDDLE[1]]
    assert found["worn"] == (22000, 20000)
    assert found["bare"] == (25500, 25500)


def test_missing_ends_of_a_heat_signature_are_the_temperature_of_the_air(tmp_path: Path) -> None:
    red = picture_of(tmp_path / "red.png", np.full((8, 8), 255))
    top = atmosphere(300)
    for ends, expected in (("", 30000), ("<max_temp>310</max_temp>", 31000), ("<max_temp>290</max_temp>", 30000)):
        assert (
            shown(tmp_path, world(box_model("box", "3 0 0 0 0 0", signature(red, ends)), top=top))[MIDDLE] == expected
        )


def test_a_signature_that_moves_turns_with_its_body(tmp_path: Path) -> None:
    red = np.zeros((32, 32))
    red[:, 16:] = 255
    path = picture_of(tmp_path / "halves.png", red)
    hot = signature(path, "<min_temp>200</min_temp><max_temp>400</max_temp>")
    cube = f"""<model name="cube"><pose>3 0 0 0 0 0</pose><link name="l"><visual name="v">
      <geometry>{BOX}</geometry>{hot}</visual></link></model>"""
    with load_beside(tmp_path, world(cube, top="<gravity>0 0 0</gravity>")) as sim:
        sim.run(0.001)
        before = pixels(sim.sensor("eye::l::s").latest)[MIDDLE[0], [28, 35]].tolist()
        sim.model("cube").set_velocity((0, 0, 0), (math.pi, 0, 0))
        sim.run(1.05)
        after = pixels(sim.sensor("eye::l::s").latest)[MIDDLE[0], [28, 35]].tolist()
    assert (before, after) == ([20000, 40000], [40000, 20000])


# ---------------------------------------------------------------------- Gazebo's quirks


def test_gazebo_has_temperatures_of_eight_bits_and_a_cold_sky() -> None:
    quirks = "<simkit:gazebo_quirks>true</simkit:gazebo_quirks>"
    box = box_model("box", "3 0 0 0 0 0", warm("<temperature>310</temperature>"))
    noise = '<noise type="gaussian"><stddev>0.01</stddev></noise>'
    picture = first_image(world(box, more=noise, top=quirks + atmosphere(296, 0.1)))
    assert picture[MIDDLE] == round(round(310 / 655.35 * 255) * 257)
    # width over height, 4:3, is 1 in whole numbers
    assert picture[0, 0] == pytest.approx((296 - 0.1 * FAR * math.tan(HFOV / 2)) * 100, abs=1)
    assert len(np.unique(picture)) == 2


def test_temperatures_may_change_as_it_runs(tmp_path: Path) -> None:
    red = picture_of(tmp_path / "red.png", np.full((8, 8), 255))
    with simkit.load(world(box_model("box", "3 0 0 0 0 0", warm("<temperature>310</temperature>")))) as sim:
        sensor = sim.sensor("eye::l::s")
        sim.run(0.05)
        sim.contents.temperatures["box::l::v"] = 350
        assert pixels(sensor.latest)[MIDDLE] == 31000  # which was taken before
        sim.run(0.05)
        assert pixels(sensor.latest)[MIDDLE] == 35000
        kept = sim.snapshot()
        sim.contents.temperatures["box::l::v"] = HeatSignature(red, 200, 420)
        sim.run(0.05)
        assert pixels(sensor.latest)[MIDDLE] == 42000
        del sim.contents.temperatures["box::l::v"]
        sim.run(0.05)
        assert pixels(sensor.latest)[MIDDLE] == pytest.approx(AIR * 100, abs=50)
        sim.restore(kept)
        sim.run(0.05)
        assert pixels(sensor.latest)[MIDDLE] == 35000
        sim.reset()
        sim.run(0.05)
        assert pixels(sensor.latest)[MIDDLE] == 31000
