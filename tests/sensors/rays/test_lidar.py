"""Lidars: detected objects, range limits, and the plugin of Gazebo Classic."""

from __future__ import annotations

import math

import numpy as np
import pytest
from sensor_worlds import box, cloud, noise, sensor, world

import simkit

AHEAD = box("ahead", "3.5 0 1 0 0 0", "1 1 1", retro=70)
CAN = "<geometry><cylinder><radius>0.2</radius><length>0.4</length></cylinder></geometry>"
HOUSING = f'<collision name="c">{CAN}</collision><visual name="v">{CAN}</visual>'
TOPIC = "/world/w/model/m/link/l/sensor/s/"


def block(
    samples: int = 3,
    low: float = -math.pi / 2,
    high: float = math.pi / 2,
    rng: tuple[float, float] = (0.1, 10),
    more: str = "",
) -> str:
    return f"""<lidar><scan><horizontal>
      <samples>{samples}</samples><min_angle>{low}</min_angle><max_angle>{high}</max_angle>
      </horizontal></scan><range><min>{rng[0]}</min><max>{rng[1]}</max></range>{more}</lidar>"""


def scan_of(text: str, name: str = "m::l::s") -> object:
    with simkit.load(text) as sim:
        sim.run(0.02)
        return sim.sensor(name).latest


@pytest.mark.parametrize("kind", ["lidar", "ray", "gpu_lidar", "gpu_ray"])
def test_every_kind_sees_a_box_and_its_reflectance(kind: str) -> None:
    scan = scan_of(world(sensor(kind, block()), others=AHEAD))
    np.testing.assert_allclose(scan.ranges, (math.inf, 3.0, math.inf), atol=1e-6)
    np.testing.assert_array_equal(scan.intensities, (0, 70, 0))
    assert scan.angle_increment == pytest.approx(math.pi / 2)
    assert (scan.time_increment, scan.scan_time) == (0.0, 0.01)


@pytest.mark.parametrize("kind", ["lidar", "gpu_lidar"])
def test_walls_of_touching_boxes_are_exact_and_no_ray_slips_through_a_seam(kind: str) -> None:
    """The rays at 0°, 45°, 90°, … meet seams and corners of the walls at x, y = ±2 m."""
    walls = "".join(
        box(f"x{x}{i}", f"{x} {i + 0.5} 1 0 0 0", "1 1 1") + box(f"y{x}{i}", f"{i + 0.5} {x} 1 0 0 0", "1 1 1")
        for x in (-2.5, 2.5)
        for i in range(-3, 3)
    )
    scan = scan_of(world(sensor(kind, block(361, -math.pi, math.pi)), others=walls))
    angles = np.linspace(-math.pi, math.pi, 361)
    np.testing.assert_allclose(scan.ranges, 2.0 / np.maximum(np.abs(np.cos(angles)), np.abs(np.sin(angles))), atol=1e-6)


def test_physics_rays_see_collisions_and_rendered_ones_visuals() -> None:
    ghosts = box("solid", "2.5 0 1 0 0 0", "1 1 1", visual=False) + box(
        "picture", "0 3.5 1 0 0 0", "1 1 1", collision=False
    )
    np.testing.assert_allclose(
        scan_of(world(sensor("lidar", block()), others=ghosts)).ranges, (math.inf, 2, math.inf), atol=1e-6
    )
    np.testing.assert_allclose(
        scan_of(world(sensor("gpu_lidar", block()), others=ghosts)).ranges, (math.inf, math.inf, 3), atol=1e-6
    )


@pytest.mark.parametrize("kind", ["lidar", "gpu_lidar"])
@pytest.mark.parametrize("static", [True, False])
def test_its_own_housing_is_not_hit(kind: str, static: bool) -> None:
    text = world(sensor(kind, block(rng=(0.01, 10))), others=AHEAD, body=HOUSING, static=static)
    np.testing.assert_allclose(scan_of(text).ranges, (math.inf, 3.0, math.inf), atol=1e-3)


def test_a_housing_that_is_hidden_for_one_lidar_is_seen_by_another() -> None:
    """All other static links stay visible, and no link stays hidden after a scan."""
    link = f'<link name="l">{sensor("lidar", block())}</link>'
    other = f'<model name="n"><static>true</static><pose>-2 0 1 0 0 0</pose>{link}</model>'
    with simkit.load(world(sensor("lidar", block()), others=AHEAD + other, body=HOUSING)) as sim:
        sim.run(0.02)
        before = sim.mj_model.geom_group.copy()
        assert sim.sensor("m::l::s").latest.ranges[1] == pytest.approx(3.0)
        assert sim.sensor("n::l::s").latest.ranges[1] == pytest.approx(1.8, abs=1e-6)
        np.testing.assert_array_equal(sim.mj_model.geom_group, before)


def test_physics_rays_start_at_the_minimum_range() -> None:
    near = box("near", "0.5 0 1 0 0 0", "0.1 1 1")
    ranges = scan_of(world(sensor("lidar", block(rng=(1.0, 10))), others=AHEAD + near)).ranges
    np.testing.assert_allclose(ranges, (math.inf, 3.0, math.inf), atol=1e-6)


def test_rendered_lidars_say_minus_infinity_for_what_is_too_near() -> None:
    near = box("near", "0.5 0 1 0 0 0", "0.1 0.1 1")
    ranges = scan_of(world(sensor("gpu_lidar", block(rng=(1.0, 10))), others=AHEAD + near)).ranges
    np.testing.assert_array_equal(ranges, (math.inf, -math.inf, math.inf))


def test_a_surface_just_beyond_the_range_is_not_there() -> None:
    assert scan_of(world(sensor("lidar", block(rng=(0.1, 2.999))), others=AHEAD)).ranges[1] == math.inf
    assert scan_of(world(sensor("lidar", block(rng=(0.1, 3.001))), others=AHEAD)).ranges[1] == pytest.approx(3.0)


def test_noise_is_clamped_to_the_range_and_truth_has_none() -> None:
    text = world(sensor("lidar", block(rng=(0.1, 4), more=noise(0.01, mean=50))), others=AHEAD)
    with simkit.load(text) as sim:
        sim.run(0.02)
        latest, truth = sim.sensor("m::l::s").latest, sim.sensor("m::l::s").truth
        np.testing.assert_array_equal(latest.ranges, (math.inf, 4.0, math.inf))
        assert truth.ranges[1] == pytest.approx(3.0)
        assert truth.header.stamp.nanosec == latest.header.stamp.nanosec


def test_several_layers_give_the_middle_one_as_a_scan_and_all_as_a_cloud() -> None:
    layers = """<lidar><scan><horizontal><samples>5</samples>
      <min_angle>-0.2</min_angle><max_angle>0.2</max_angle></horizontal>
      <vertical><samples>3</samples><min_angle>-0.1</min_angle><max_angle>0.1</max_angle></vertical></scan>
      <range><min>0.1</min><max>10</max></range></lidar>"""
    wall = box("wall", "3.5 0 1 0 0 0", "1 9 9")
    with simkit.load(world(sensor("lidar", layers), others=wall)) as sim:
        points = sim.subscribe(TOPIC + "lidar/points")
        sim.run(0.02)
        scan = sim.sensor("m::l::s").latest
        assert len(scan.ranges) == 5
        assert scan.ranges[2] == pytest.approx(3.0)
        found = cloud(points.latest)
        assert found.shape == (3, 5)
        assert points.latest.is_dense
        np.testing.assert_allclose(found["x"], 3.0, atol=1e-5)
        np.testing.assert_allclose(found["z"][0, 2], -3 * math.tan(0.1), atol=1e-5)
        assert found["ring"][:, 0].tolist() == [0, 1, 2]


def test_rays_without_a_reading_keep_their_place_in_the_cloud() -> None:
    with simkit.load(world(sensor("lidar", block()), others=AHEAD)) as sim:
        points = sim.subscribe(TOPIC + "lidar/points")
        sim.run(0.02)
        found = cloud(points.latest)[0]
        assert not points.latest.is_dense
        assert np.isfinite(found["x"]).tolist() == [False, True, False]


@pytest.mark.parametrize(
    ("output", "type_name"),
    [("LaserScan", "LaserScan"), ("PointCloud2", "PointCloud2"), ("PointCloud", "PointCloud"), ("Range", "Range")],
)
def test_classic_publishes_the_requested_output_type(output: str, type_name: str) -> None:
    plugin = f"""<plugin name="node" filename="libgazebo_ros_ray_sensor.so">
      <ros><remapping>~/out:=scan</remapping></ros><output_type>sensor_msgs/{output}</output_type><min_intensity>5</min_intensity></plugin>"""
    with simkit.load(world(sensor("ray", block(), extra=plugin), others=AHEAD)) as sim:
        sub = sim.subscribe("/scan")
        sim.run(0.02)
        assert sim.topics()["/scan"] == f"sensor_msgs/msg/{type_name}"
        message = sub.latest
        assert message.header.frame_id == "l"
        assert sim.sensor("m::l::s").topic == "/scan"
        if output == "LaserScan":
            np.testing.assert_array_equal(message.intensities, (5, 70, 5))
        if output == "PointCloud2":
            assert message.is_dense
            np.testing.assert_allclose(cloud(message)["x"], [[3.0]], atol=1e-6)
        if output == "PointCloud":
            assert [p.x for p in message.points] == pytest.approx([3.0])
            assert message.channels[0].name == "intensity"
        if output == "Range":
            assert message.range == pytest.approx(3.0)
            assert (message.radiation_type, message.field_of_view) == (1, pytest.approx(math.pi))


def test_bad_parameters_are_reported_together() -> None:
    bad = """<lidar><scan><horizontal><samples>0</samples>
      <min_angle>1</min_angle><max_angle>0</max_angle></horizontal></scan>
      <range><min>2</min><max>1</max></range></lidar>"""
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(world(sensor("lidar", bad)))
    assert [d.code for d in caught.value.diagnostics if d.severity == "error"] == ["SK-PARAM-002"] * 2


def test_exchanged_angles_of_a_scan_are_put_in_order_with_a_warning() -> None:
    text = world(sensor("lidar", block(low=2.27, high=-2.27)))
    with simkit.load(text) as sim:
        assert "SK-PARAM-008" in {d.code for d in sim.diagnostics if d.severity == "warning"}
        messages = sim.subscribe(TOPIC + "lidar")
        sim.run(0.02)
    message = messages.messages[-1]
    assert (message.angle_min, message.angle_max) == pytest.approx((-2.27, 2.27))


def test_a_lidar_on_a_moved_static_model_moves_along() -> None:
    with simkit.load(world(sensor("lidar", block()), others=AHEAD, body=HOUSING)) as sim:
        sim.run(0.02)
        assert sim.sensor("m::l::s").latest.ranges[1] == pytest.approx(3.0)
        sim.model("m").set_pose(simkit.Pose((1, 0, 1)))
        sim.run(0.02)
        assert sim.sensor("m::l::s").latest.ranges[1] == pytest.approx(2.0)


def test_a_spawned_box_is_seen_and_a_removed_one_is_not() -> None:
    with simkit.load(world(sensor("lidar", block()), others=AHEAD)) as sim:
        sim.run(0.02)
        sim.spawn(f'<sdf version="1.9">{box("new", "2.5 0 1 0 0 0", "1 1 1")}</sdf>')
        assert sim.sensor("m::l::s").latest.ranges[1] == pytest.approx(3.0)  # taken before
        sim.run(0.02)
        assert sim.sensor("m::l::s").latest.ranges[1] == pytest.approx(2.0)
        sim.remove("new")
        sim.run(0.02)
        assert sim.sensor("m::l::s").latest.ranges[1] == pytest.approx(3.0)


def test_hits_names_the_object_of_each_ray() -> None:
    scene = AHEAD + box("left", "0 3.5 1 0 0 0", "1 1 1")
    for kind, part in (("lidar", "c"), ("gpu_lidar", "v")):
        with simkit.load(world(sensor(kind, block(rng=(0.1, 10))), others=scene)) as sim:
            lidar = sim.sensor("m::l::s")
            assert lidar.hits is None
            sim.run(0.02)
            assert lidar.hits.tolist() == ["", f"ahead::l::{part}", f"left::l::{part}"]


def test_an_object_that_is_too_near_has_a_name_and_one_too_far_has_none() -> None:
    scene = box("near", "1.0 0 1 0 0 0", "1 0.1 1") + box("far", "0 9 1 0 0 0", "1 1 1")
    with simkit.load(world(sensor("gpu_lidar", block(rng=(1.0, 5))), others=scene)) as sim:
        sim.run(0.02)
        assert sim.sensor("m::l::s").latest.ranges.tolist() == [math.inf, -math.inf, math.inf]
        assert sim.sensor("m::l::s").hits.tolist() == ["", "near::l::v", ""]


def test_a_reading_that_is_read_later_has_the_names_at_its_time() -> None:
    """The sample had no reader. Later a box was spawned, so that geom ids changed."""
    with simkit.load(world(sensor("lidar", block(), rate=1), others=AHEAD)) as sim:
        sim.run(0.5)
        sim.spawn(f'<sdf version="1.9">{box("aaa", "2.5 0 1 0 0 0", "1 1 1")}</sdf>')
        assert sim.sensor("m::l::s").hits.tolist() == ["", "ahead::l::c", ""]
        assert sim.sensor("m::l::s").latest.ranges[1] == pytest.approx(3.0)
        sim.run(0.6)
        assert sim.sensor("m::l::s").hits.tolist() == ["", "aaa::l::c", ""]
        sim.remove("aaa")
        assert sim.sensor("m::l::s").hits.tolist() == ["", "aaa::l::c", ""]


def flagged(flags: str) -> str:
    return box("ahead", "2.5 0 1 0 0 0", "1 1 1").replace(
        '<visual name="v">', f'<visual name="v"><visibility_flags>{flags}</visibility_flags>'
    )


@pytest.mark.parametrize(
    ("mask", "flags", "distance"),
    [("1", "1", 2.0), ("1", "2", 3.0), ("3", "2", 2.0), ("0xFE", "1", 3.0), ("4294967295", "0", 3.0), ("-1", "8", 2.0)],
)
def test_a_rendered_lidar_sees_visuals_that_share_a_bit_with_its_mask(mask: str, flags: str, distance: float) -> None:
    behind = box("behind", "3.5 0 1 0 0 0", "1 1 1")
    text = block(more=f"<visibility_mask>{mask}</visibility_mask>")
    assert scan_of(world(sensor("gpu_lidar", text), others=flagged(flags) + behind)).ranges[1] == pytest.approx(
        distance
    )
    with simkit.load(world(sensor("lidar", text), others=flagged(flags) + behind)) as sim:
        sim.run(0.02)
        assert sim.sensor("m::l::s").latest.ranges[1] == pytest.approx(2.0)
        assert ("SK-SENSOR-004" in [d.code for d in sim.diagnostics]) == (mask not in ("4294967295", "-1"))


@pytest.mark.parametrize("mask", ["all", "", "1_0", "\u0661", "4294967296", "-2"])
def test_a_mask_that_is_no_number_is_an_error(mask: str) -> None:
    with pytest.raises(simkit.LoadError, match="visibility_mask"):
        simkit.load(world(sensor("gpu_lidar", block(more=f"<visibility_mask>{mask}</visibility_mask>"))))


@pytest.mark.parametrize("flags", ["1e30", "-2", "4294967296", "two"])
def test_flags_beyond_32_bits_are_an_error(flags: str) -> None:
    with pytest.raises(simkit.LoadError, match="visibility_flags"):
        simkit.load(world(sensor("gpu_lidar", block()), others=flagged(flags)))


@pytest.mark.parametrize("transparency", [0.5, 1.0])
def test_transparent_visuals_are_seen(transparency: float) -> None:
    """Gazebo draws all visuals opaque for its lidars."""
    glass = AHEAD.replace('<visual name="v">', f'<visual name="v"><transparency>{transparency}</transparency>')
    assert scan_of(world(sensor("gpu_lidar", block()), others=glass)).ranges[1] == pytest.approx(3.0)


def test_gazebos_quirks_limit_reflectance_and_drop_quantised_noise() -> None:
    bright = box("ahead", "3.5 0 1 0 0 0", "1 1 1", retro=5000)
    quantised = noise(0.1, more="<precision>0.07</precision>").replace('"gaussian"', '"gaussian_quantized"')
    for quirks, retro in ((False, 5000.0), (True, 2000.0)):
        top = f"<gazebo_quirks>{str(quirks).lower()}</gazebo_quirks>"
        with simkit.load(world(sensor("gpu_lidar", block(more=quantised)), others=bright, top=top)) as sim:
            sim.run(0.02)
            lidar = sim.sensor("m::l::s")
            assert lidar.latest.intensities[1] == retro
            assert (lidar.latest.ranges[1] == lidar.truth.ranges[1]) == quirks


def test_readers_change_no_reading() -> None:
    moving = box("loose", "3.5 0 1 0 0 0", "1 1 1").replace("<static>true</static>", "")
    text = world(sensor("lidar", block(samples=30, more=noise(0.01)), rate=20), others=moving)
    with simkit.load(text, seed=3) as read, simkit.load(text, seed=3) as unread:
        read.subscribe(TOPIC + "lidar/points")
        tap = read.subscribe(TOPIC + "lidar")
        read.run(0.5)
        unread.run(0.5)
        one, other = tap.latest, unread.sensor("m::l::s").latest
        assert one.ranges.tobytes() == other.ranges.tobytes()
        assert read.sensor("m::l::s").truth.ranges.tobytes() == unread.sensor("m::l::s").truth.ranges.tobytes()


def velodyne(more: str = "") -> str:
    layers = """<ray><scan><horizontal><samples>5</samples><min_angle>-0.2</min_angle><max_angle>0.2</max_angle>
      </horizontal><vertical><samples>3</samples><min_angle>-0.1</min_angle><max_angle>0.1</max_angle></vertical></scan>
      <range><min>0.1</min><max>10</max></range></ray>"""
    plugin = f"""<plugin name="v" filename="libgazebo_ros_velodyne_laser.so"><topicName>/velodyne_points</topicName>
      <frameName>velodyne</frameName><max_range>3.02</max_range>{more}</plugin>"""
    return world(sensor("ray", layers, extra=plugin), others=box("wall", "3.5 0 1 0 0 0", "1 9 9"))


def test_the_velodyne_plugin_gives_points_within_its_range_layer_by_layer() -> None:
    with simkit.load(velodyne()) as sim:
        points = sim.subscribe("/velodyne_points")
        sim.run(0.02)
        message, found = points.latest, cloud(points.latest)[0]
        assert (message.header.frame_id, message.point_step, message.height) == ("velodyne", 32, 1)
        ranges = np.sqrt(found["x"] ** 2 + found["y"] ** 2 + found["z"] ** 2)
        assert (ranges < 3.02).all()
        assert found["ring"].tolist() == [0, 1, 1, 1, 2]
        np.testing.assert_allclose(found["x"], 3.0, atol=1e-5)


def test_an_organised_velodyne_cloud_has_a_point_for_every_ray() -> None:
    more = "<organize_cloud>true</organize_cloud><gaussianNoise>0.001</gaussianNoise>"
    with simkit.load(velodyne(more)) as sim:
        points = sim.subscribe("/velodyne_points")
        sim.run(0.02)
        found = cloud(points.latest)
        assert found.shape == (3, 5)
        assert not points.latest.is_dense
        assert np.isfinite(found["x"]).sum(axis=1).tolist() == [1, 3, 1]
        assert 1e-5 < np.nanstd(found["x"]) < 5e-3
