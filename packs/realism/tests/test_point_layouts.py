"""Clouds have the fields of drivers, with the time and the ring of each point; scans follow patterns."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import simkit
from simkit import InputError, LoadError, msgs
from simkit_realism.scan_patterns import TablePattern, read_table

WORLD = """<sdf version="1.9" xmlns:simkit="simkit"><world name="w">
  <model name="m"><static>true</static><link name="l">
    <sensor name="s" type="gpu_lidar"><update_rate>10</update_rate><topic>lidar</topic>
      <lidar><scan><horizontal><samples>8</samples><min_angle>-3.14159265</min_angle><max_angle>2.35619449</max_angle>
        </horizontal><vertical><samples>3</samples><min_angle>-0.1</min_angle><max_angle>0.1</max_angle></vertical>
        </scan><range><min>0.1</min><max>10</max></range></lidar>{elements}</sensor></link></model>
  <model name="wall"><static>true</static><pose>2.5 0 0 0 0 0</pose><link name="l"><visual name="v">
    <laser_retro>50</laser_retro><geometry><box><size>1 20 6</size></box></geometry></visual></link></model>
</world></sdf>"""
LAYOUTS = {
    "velodyne": (22, "x y z intensity ring time", [0, 4, 8, 12, 16, 18]),
    "ouster": (48, "x y z intensity t reflectivity ring ambient range", [0, 4, 8, 16, 20, 24, 26, 28, 32]),
    "hesai": (26, "x y z intensity ring timestamp", [0, 4, 8, 12, 16, 18]),
    "livox": (26, "x y z intensity tag line timestamp", [0, 4, 8, 12, 16, 17, 18]),
    "xyz": (12, "x y z", [0, 4, 8]),
}


def cloud_of(elements: str, time: float = 0.25) -> object:
    with simkit.load(WORLD.format(elements=elements)) as sim:
        clouds = sim.subscribe("/lidar/points")
        sim.run(time)
        return clouds.latest


@pytest.mark.parametrize("name", LAYOUTS)
def test_a_cloud_has_the_fields_and_offsets_of_the_driver(name: str) -> None:
    cloud = cloud_of(f"<simkit:sweep>true</simkit:sweep><simkit:point_layout>{name}</simkit:point_layout>")
    step, names, offsets = LAYOUTS[name]
    assert cloud.point_step == step
    assert [field.name for field in cloud.fields] == names.split()
    assert [field.offset for field in cloud.fields] == offsets
    assert len(cloud.data) == cloud.row_step * cloud.height == step * cloud.width * cloud.height


def test_velodynes_times_are_seconds_after_the_stamp_in_the_order_of_firing() -> None:
    cloud = cloud_of("<simkit:sweep>true</simkit:sweep><simkit:point_layout>velodyne</simkit:point_layout>")
    points = msgs.points(cloud)
    # one turn in 0.1 s has 8 columns; the wall is in front, in the columns of -45°, 0° and 45°
    assert points["time"] == pytest.approx(np.repeat([3, 4, 5], 3) * 0.1 / 8, abs=1e-7)
    assert points["ring"].tolist() == [0, 1, 2] * 3
    assert points["x"] == pytest.approx(2.0, abs=1e-6)


def test_an_ouster_cloud_has_a_row_for_each_ring_from_the_top() -> None:
    cloud = cloud_of("<simkit:sweep>true</simkit:sweep><simkit:point_layout>ouster</simkit:point_layout>")
    points = msgs.points(cloud).reshape(3, 8)
    assert (cloud.height, cloud.width, cloud.is_dense) == (3, 8, False)
    assert points["ring"][:, 0].tolist() == [0, 1, 2]
    assert points["z"][0, 4] > 0 > points["z"][2, 4]
    assert points["t"][1].tolist() == [round(column * 1e8 / 8) for column in range(8)]
    assert points["range"][1].tolist()[3:6] == [2828, 2000, 2828]
    assert np.isnan(points["x"][:, :3]).all() and (points["range"][:, :3] == 0).all()


def test_timestamps_of_hesai_are_seconds_and_those_of_livox_nanoseconds_of_the_clock() -> None:
    hesai = msgs.points(cloud_of("<simkit:point_layout>hesai</simkit:point_layout>"))
    assert hesai["timestamp"] == pytest.approx(0.2, abs=1e-12)
    assert len(hesai) == 9
    livox = msgs.points(cloud_of("<simkit:point_layout>livox</simkit:point_layout>"))
    assert (livox["timestamp"] == 200_000_000).all()
    assert len(livox) == 24 and (livox["x"] == 0).sum() == 15


def test_livoxs_own_message_has_offsets_in_nanoseconds() -> None:
    message = cloud_of("<simkit:sweep>true</simkit:sweep><simkit:point_layout>livox_custom</simkit:point_layout>")
    assert msgs.type_name(message) == "livox_ros_driver2/msg/CustomMsg"
    assert message.timebase == 100_000_000 and message.point_num == len(message.points) == 24
    assert [point.offset_time for point in message.points[::3]] == [round(column * 1e8 / 8) for column in range(8)]
    assert {point.reflectivity for point in message.points} == {0, 50}


def test_an_unknown_layout_is_an_error_that_lists_all() -> None:
    with pytest.raises(LoadError, match="SK-SENSOR-280.*expected one of xyz, velodyne"):
        simkit.load(WORLD.format(elements="<simkit:point_layout>velo</simkit:point_layout>"), strict=True)


PATTERN = """<simkit:scan_pattern><samples>4</samples><file>{file}</file></simkit:scan_pattern>
<simkit:point_layout>velodyne</simkit:point_layout>"""


def test_each_scan_has_the_next_rows_of_a_table_and_then_the_first_again(tmp_path: Path) -> None:
    rows = [(azimuth, zenith) for zenith in (90, 88) for azimuth in (0, 5, 355)]
    text = "Time/s,Azimuth/deg,Zenith/deg\n" + "".join(f"{i},{a},{z}\n" for i, (a, z) in enumerate(rows))
    (tmp_path / "pattern.csv").write_text(text, encoding="utf-8")
    (tmp_path / "w.sdf").write_text(WORLD.format(elements=PATTERN.format(file="pattern.csv")), encoding="utf-8")
    with simkit.load(tmp_path / "w.sdf") as sim:
        clouds = sim.subscribe("/lidar/points")
        sim.run(0.35)
        scans = [msgs.points(cloud) for cloud in clouds.messages]
    seen = [
        (np.degrees(np.arctan2(p["y"], p["x"])), np.degrees(np.arcsin(p["z"] / np.hypot(p["x"], p["y"]))))
        for s in scans
        for p in s
    ]
    for number, (azimuth, elevation) in enumerate(seen):
        expected = rows[number % len(rows)]
        assert azimuth == pytest.approx((expected[0] + 180) % 360 - 180, abs=1e-4)
        assert elevation == pytest.approx(90 - expected[1], abs=2e-3)
    assert scans[0]["time"] == pytest.approx(np.arange(4) * 0.025, abs=1e-7)


def test_a_rosette_fills_its_cone_and_repeats_no_ray() -> None:
    rosette = """<simkit:scan_pattern><samples>400</samples><rosette><rate_1>121.5667</rate_1><rate_2>-77.7333</rate_2>
      <deflection_1>0.1675</deflection_1><deflection_2>0.1675</deflection_2></rosette></simkit:scan_pattern>"""
    with simkit.load(WORLD.format(elements=rosette)) as sim:
        lidar = sim.sensor("m::l::s")
        first, second = lidar.ray_pattern(1).directions, lidar.ray_pattern(2).directions
    angles = np.degrees(np.arccos(np.concatenate((first, second))[:, 0]))
    assert 18.5 < angles.max() < 19.3  # 2 · 0.1675 rad are 19.2°
    assert np.abs(first - second).max() > 0.01


@pytest.mark.parametrize(
    ("element", "text"),
    [
        (
            "<simkit:scan_pattern><samples>4</samples><file>none.csv</file></simkit:scan_pattern>",
            "SK-SENSOR-281.*none.csv",
        ),
        ("<simkit:scan_pattern><samples>4</samples></simkit:scan_pattern>", "SK-SENSOR-282.*found no pattern"),
        ("<simkit:scan_pattern><file>none.csv</file></simkit:scan_pattern>", "SK-SENSOR-282.*no <samples>"),
    ],
)
def test_a_pattern_without_file_samples_or_shape_is_an_error(element: str, text: str) -> None:
    with pytest.raises(LoadError, match=text):
        simkit.load(WORLD.format(elements=element), strict=True)


LIVOX = """<sdf version="1.6"><world name="w"><model name="m"><static>true</static><link name="l">
<sensor type="ray" name="laser_livox"><update_rate>10</update_rate>
<plugin name="c" filename="liblivox_laser_simulation.so"><ray><scan><horizontal><samples>100</samples></horizontal>
<vertical><samples>360</samples></vertical></scan><range><min>0.1</min><max>200</max></range></ray>
<samples>6</samples><downsample>2</downsample><csv_file_name>package://livox/scan_mode/p.csv</csv_file_name>
<ros_topic>scan</ros_topic>{more}</plugin></sensor></link></model>
<model name="wall"><static>true</static><link name="l"><collision name="a"><pose>3 0 0 0 0 0</pose><geometry><box>
<size>2 20 6</size></box></geometry></collision></link></model></world></sdf>"""


@pytest.mark.parametrize(("kind", "type_name"), [(1, "PointCloud2"), (3, "CustomMsg"), (0, "PointCloud")])
def test_the_livox_plugin_of_gazebo_follows_its_table(tmp_path: Path, kind: int, type_name: str) -> None:
    (tmp_path / "livox" / "scan_mode").mkdir(parents=True)
    (tmp_path / "livox" / "package.xml").write_text("<package><name>livox</name></package>", encoding="utf-8")
    rows = "".join(f"{i},{azimuth},90\n" for i, azimuth in enumerate((0, 1, 10, 11, 180, 181)))
    table = tmp_path / "livox" / "scan_mode" / "p.csv"
    table.write_text("Time/s,Azimuth/deg,Zenith/deg\n" + rows, encoding="utf-8")
    more = f"<publish_pointcloud_type>{kind}</publish_pointcloud_type>"
    with simkit.load(LIVOX.format(more=more), resource_paths=[tmp_path]) as sim:
        clouds = sim.subscribe("/scan")
        sim.run(0.15)
        cloud = clouds.latest
        assert type(cloud).__name__.endswith(type_name) and cloud.header.frame_id == "laser_livox"
        if kind == 1:
            points = msgs.points(cloud)
            assert points["x"] == pytest.approx([2, 2, 0], abs=1e-6)
            assert points["y"] == pytest.approx([0, 2 * np.tan(np.radians(10)), 0], abs=1e-6)


def test_a_stride_of_any_length_goes_round_the_table(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text("azimuth/deg,elevation/deg\n0,0\n1,0\n2,0\n", encoding="utf-8")
    azimuths, elevations = read_table(tmp_path / "p.csv")
    pattern = TablePattern(azimuths, elevations, 2, 10**20 + 1)  # 10²⁰ + 1 is 2 more than a multiple of 3
    assert np.degrees(pattern.angles(1, 0.1)[0]) == pytest.approx([0, 2])
    assert np.degrees(pattern.angles(2, 0.1)[0]) == pytest.approx([1, 0])


def test_a_table_without_rows_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text("azimuth/deg,elevation/deg\n", encoding="utf-8")
    with pytest.raises(InputError, match="no row"):
        read_table(tmp_path / "p.csv")
