"""Classic's camera plugins: topics, frames, CameraInfo, depths, triggers; ROS 2 and ROS 1 spellings."""

from __future__ import annotations

import math

import numpy as np
import pytest
from camera_worlds import (
    CAMERA,
    FOCAL,
    HEIGHT,
    STEREO,
    WIDTH,
    codes,
    heard,
    plugin,
    points_of,
    topics_of,
    wall,
    world,
)

import simkit
from simkit.sensors.cameras import image_messages

# ---------------------------------------------------------------------- ROS 2


def test_a_camera_publishes_below_its_name_in_its_links_frame() -> None:
    text = world("camera", CAMERA, plugin("gazebo_ros_camera"))
    with simkit.load(text) as sim:
        assert topics_of(sim) == {"/eye/image_raw": "Image", "/eye/camera_info": "CameraInfo"}
    image, info = heard(text, "/eye/image_raw", "/eye/camera_info")
    assert image.header == info.header
    assert image.header.frame_id == "eye_link"
    assert image.encoding == "rgb8"
    np.testing.assert_allclose(info.k, (FOCAL, 0, WIDTH / 2, 0, FOCAL, HEIGHT / 2, 0, 0, 1))


def test_namespace_name_frame_and_remapping() -> None:
    content = """<ros><namespace>demo</namespace><remapping>front/image_raw:=front/image_demo</remapping>
      <remapping>front/camera_info:=/info</remapping></ros>
      <camera_name>front</camera_name><frame_name>front_optical</frame_name>"""
    text = world("camera", CAMERA, plugin("gazebo_ros_camera", content))
    image, info = heard(text, "/demo/front/image_demo", "/info")
    assert image.header.frame_id == info.header.frame_id == "front_optical"


def test_frame_name_goes_before_the_cameras_optical_frame() -> None:
    block = CAMERA.replace("<camera>", "<camera><optical_frame_id>optical</optical_frame_id>")
    (image,) = heard(world("camera", block, plugin("gazebo_ros_camera")), "/eye/image_raw")
    assert image.header.frame_id == "optical"
    named = plugin("gazebo_ros_camera", "<frame_name>named</frame_name>")
    (image,) = heard(world("camera", block, named), "/eye/image_raw")
    assert image.header.frame_id == "named"


def test_hack_baseline_is_in_the_projection_matrix() -> None:
    text = world("camera", CAMERA, plugin("gazebo_ros_camera", "<hack_baseline>0.07</hack_baseline>"))
    (info,) = heard(text, "/eye/camera_info")
    assert info.p[3] == pytest.approx(-0.07 * FOCAL)


def test_intrinsics_that_differ_from_the_picture_are_reported() -> None:
    content = "<focal_length>50</focal_length><cx>17</cx><cy>11</cy>"
    text = world("camera", CAMERA, plugin("gazebo_ros_camera", content))
    (info,) = heard(text, "/eye/camera_info")
    np.testing.assert_allclose(info.k, (50, 0, 17, 0, 50, 11, 0, 0, 1))
    np.testing.assert_allclose(info.p, (50, 0, 17, 0, 0, 50, 11, 0, 0, 0, 1, 0))
    assert "SK-SENSOR-122" in codes(text)
    same = plugin("gazebo_ros_camera", f"<focal_length>{FOCAL}</focal_length>")
    assert "SK-SENSOR-122" not in codes(world("camera", CAMERA, same))


def test_classics_principal_point_needs_gazebo_quirks() -> None:
    quirks = "<gazebo_quirks>true</gazebo_quirks>"
    (info,) = heard(world("camera", CAMERA, plugin("gazebo_ros_camera"), extra=quirks), "/eye/camera_info")
    assert (info.k[2], info.k[5]) == ((WIDTH + 1) / 2, (HEIGHT + 1) / 2)


def test_a_depth_camera_has_colours_depths_and_a_cloud_in_optical_axes() -> None:
    content = "<frame_name>optical</frame_name><max_depth>5</max_depth>"
    text = world("depth", CAMERA, plugin("gazebo_ros_camera", content))
    with simkit.load(text) as sim:
        assert topics_of(sim) == {
            "/eye/image_raw": "Image",
            "/eye/camera_info": "CameraInfo",
            "/eye/depth/image_raw": "Image",
            "/eye/depth/camera_info": "CameraInfo",
            "/eye/points": "PointCloud2",
        }
    names = ("/eye/image_raw", "/eye/depth/image_raw", "/eye/points", "/eye/depth/camera_info")
    image, depth, cloud, info = heard(text, *names)
    depths, points = image_messages.pixels_of(depth), points_of(cloud)
    right = depths[:, 20:]
    np.testing.assert_allclose(right, 3.0, atol=1e-4)
    assert (depths[:, 2] == -math.inf).all()  # 0.25 m, and <min_depth> is 0.4 m where the file says nothing
    assert (depths[:, 16] == math.inf).all()  # 6 m
    np.testing.assert_allclose(points["z"][:, 20:], right)
    columns = (np.arange(WIDTH) + 0.5 - info.k[2]) / info.k[0]
    np.testing.assert_allclose(points["x"][:, 20:], np.broadcast_to(columns[20:] * 3.0, right.shape), atol=1e-3)
    assert points["y"][-1, 25] > 0 > points["y"][0, 25]
    assert {m.header.frame_id for m in (image, depth, cloud, info)} == {"optical"}
    bytes_ = points["rgb"][:, 25].copy().view(np.uint8).reshape(-1, 4)
    np.testing.assert_array_equal(bytes_[:, 2::-1], image_messages.pixels_of(image)[:, 25])


def test_each_trigger_of_ros_2_gives_a_picture() -> None:
    content = "<camera_name>front</camera_name><triggered>true</triggered>"
    with simkit.load(world("camera", CAMERA, plugin("gazebo_ros_camera", content))) as sim:
        assert sim.topics()["/front/image_trigger"] == "std_msgs/msg/Empty"
        image = sim.subscribe("/front/image_raw")
        sim.run(0.1)
        assert not image.messages
        for _ in range(3):
            sim.publish("/front/image_trigger", {})
        sim.run(0.2)
        assert len(image.messages) == 3


def test_the_wrong_sensor_is_refused() -> None:
    imu = '<sensor name="imu" type="imu">' + plugin("gazebo_ros_camera") + "</sensor>"
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-003"):
        simkit.load(f'<sdf version="1.6"><model name="m"><link name="l">{imu}</link></model></sdf>')


# ---------------------------------------------------------------------- several cameras


def test_a_multicamera_publishes_each_camera_below_its_name() -> None:
    content = "<ros><namespace>demo</namespace></ros><camera_name>pair</camera_name>"
    text = world("multicamera", STEREO, plugin("gazebo_ros_camera", content))
    names = [f"/demo/pair/{side}/{what}" for side in ("left", "right") for what in ("image_raw", "camera_info")]
    with simkit.load(text) as sim:
        assert sorted(topics_of(sim)) == sorted(names)
    found = heard(text, *names)
    assert len({(m.header.stamp.nanosec, m.header.frame_id) for m in found}) == 1
    assert found[0].header.frame_id == "eye_link"
    assert (found[1].p[3], found[3].p[3]) == pytest.approx((0.0, -0.1 * FOCAL))


@pytest.mark.parametrize("library", ["gazebo_ros_multicamera", "gazebo_ros_triggered_multicamera"])
def test_ros_1_has_left_and_right_cameras(library: str) -> None:
    block = STEREO.replace('"left"', '"my_left"').replace('"right"', '"my_right"')
    content = """<robotNamespace>/r</robotNamespace><cameraName>stereo</cameraName>
      <imageTopicName>picture</imageTopicName><hackBaseline>0.2</hackBaseline><frameName>/left_optical</frameName>"""
    text = world("multicamera", block, plugin(library, content))
    with simkit.load(text) as sim:
        left, right = sim.subscribe("/r/stereo/left/picture"), sim.subscribe("/r/stereo/right/camera_info")
        if "triggered" in library:
            sim.run(0.1)
            assert not left.messages
            sim.publish("/r/stereo/image_trigger", {})
        sim.run(0.1)
        assert left.latest.header.frame_id == "left_optical"
        assert right.latest.p[3] == pytest.approx(-0.2 * FOCAL)


# ---------------------------------------------------------------------- ROS 1


def test_ros_1s_camera_publishes_in_its_spelling() -> None:
    content = """<alwaysOn>true</alwaysOn><updateRate>10</updateRate><cameraName>rrbot/camera1</cameraName>
      <imageTopicName>image_raw</imageTopicName><cameraInfoTopicName>camera_info</cameraInfoTopicName>
      <frameName>camera_link</frameName><hackBaseline>0.07</hackBaseline><distortionK1>0.0</distortionK1>
      <distortionK2>0.00000001</distortionK2><distortionK3>0.0</distortionK3><distortionT1>0.0</distortionT1>
      <distortionT2>0.0</distortionT2><CxPrime>0</CxPrime><Cx>0.0</Cx><Cy>0.0</Cy><focalLength>0.0</focalLength>"""
    with simkit.load(world("camera", CAMERA, plugin("gazebo_ros_camera", content))) as sim:
        assert not [d for d in sim.diagnostics if d.code.startswith(("SK-SENSOR", "SK-PARAM"))]
        image, info = sim.subscribe("/rrbot/camera1/image_raw"), sim.subscribe("/rrbot/camera1/camera_info")
        sim.run(1.0)
        assert len(image.messages) == pytest.approx(10, abs=1)  # the slower of 50 and 10 Hz
        assert image.latest.header.frame_id == "camera_link"
        assert info.latest.p[3] == pytest.approx(-0.07 * FOCAL)
        assert not info.latest.d.any()


def test_ros_1_without_a_camera_name_publishes_in_its_namespace() -> None:
    content = "<robotNamespace>r</robotNamespace><cameraInfoTopicName>/told/info</cameraInfoTopicName>"
    with simkit.load(world("camera", CAMERA, plugin("gazebo_ros_camera", content))) as sim:
        assert sorted(topics_of(sim)) == ["/r/image_raw", "/told/info"]


def test_a_distortion_of_ros_1_that_the_picture_lacks_is_reported() -> None:
    content = "<cameraName>c</cameraName><distortionK1>-0.2</distortionK1>%s"
    text = world("camera", CAMERA, plugin("gazebo_ros_camera", content % ""))
    (info,) = heard(text, "/c/camera_info")
    np.testing.assert_allclose(info.d, (-0.2, 0, 0, 0, 0))
    assert "SK-SENSOR-122" in codes(text)
    drawn = CAMERA.replace("</camera>", "<distortion><k1>-0.1</k1></distortion></camera>")
    auto = world("camera", drawn, plugin("gazebo_ros_camera", content % "<autoDistortion>true</autoDistortion>"))
    (info,) = heard(auto, "/c/camera_info")
    np.testing.assert_allclose(info.d, (-0.1, 0, 0, 0, 0))
    assert "SK-SENSOR-122" not in codes(auto)


@pytest.mark.parametrize("library", ["gazebo_ros_depth_camera", "gazebo_ros_openni_kinect"])
def test_ros_1s_depth_cameras_have_nan_outside_the_depth_range(library: str) -> None:
    content = """<cameraName>kinect</cameraName><imageTopicName>rgb/image_raw</imageTopicName>
      <depthImageTopicName>/deep</depthImageTopicName><pointCloudTopicName>depth/points</pointCloudTopicName>
      <cameraInfoTopicName>rgb/camera_info</cameraInfoTopicName><frameName>optical</frameName>"""
    text = world("depth", CAMERA, plugin(library, content))
    names = ["/kinect/rgb/image_raw", "/kinect/rgb/camera_info", "/deep", "/kinect/depth/camera_info"]
    with simkit.load(text) as sim:
        assert sorted(topics_of(sim)) == sorted([*names, "/kinect/depth/points"])
    image, _, depth, info, cloud = heard(text, *names, "/kinect/depth/points")
    assert {m.header.frame_id for m in (image, depth, info, cloud)} == {"optical"}
    depths, points = image_messages.pixels_of(depth), points_of(cloud)
    assert depth.encoding == "32FC1"
    np.testing.assert_allclose(depths[:, 20:], 3.0, atol=1e-4)
    assert np.isnan(depths[:, 2]).all()
    if "kinect" in library:
        assert np.isnan(depths[:, 16]).all()  # 6 m, and <pointCloudCutoffMax> is 5 m where the file says nothing
    else:
        np.testing.assert_allclose(depths[:, 16], 6.0, atol=1e-3)
    for axis in "xyz":
        np.testing.assert_array_equal(np.isnan(points[axis]), np.isnan(depths))
    np.testing.assert_array_equal(points["z"], depths)
    assert not cloud.is_dense


def test_depths_may_be_16_bit_millimetres() -> None:
    content = "<cameraName>k</cameraName><useDepth16UC1Format>true</useDepth16UC1Format>"
    (depth,) = heard(world("depth", CAMERA, plugin("gazebo_ros_openni_kinect", content)), "/k/depth/image_raw")
    depths = image_messages.pixels_of(depth)
    assert (depth.encoding, depth.step) == ("16UC1", 2 * WIDTH)
    np.testing.assert_allclose(depths[:, 20:], 3000, atol=1)
    assert not depths[:, [2, 16]].any()


def test_unsupported_topics_of_ros_1s_depth_camera_are_reported() -> None:
    content = "<cameraName>k</cameraName><reflectanceTopicName>reflectance</reflectanceTopicName>"
    assert "SK-SENSOR-123" in codes(world("depth", CAMERA, plugin("gazebo_ros_depth_camera", content)))


def test_a_depth_plugin_needs_a_depth_camera() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-003"):
        simkit.load(world("camera", CAMERA, plugin("gazebo_ros_openni_kinect")))


def test_ros_1s_triggered_camera_needs_a_message() -> None:
    content = "<cameraName>c</cameraName><triggerTopicName>go</triggerTopicName>"
    with simkit.load(world("camera", CAMERA, plugin("gazebo_ros_triggered_camera", content))) as sim:
        image = sim.subscribe("/c/image_raw")
        sim.run(0.1)
        assert not image.messages
        sim.publish("/c/go", {})
        sim.publish("/c/go", {})
        sim.run(0.1)
        assert len(image.messages) == 1


def test_prosilica_streams_pictures() -> None:
    content = "<cameraName>p</cameraName><pollServiceName>request_image</pollServiceName>"
    text = world("camera", CAMERA, plugin("gazebo_ros_prosilica", content))
    (image,) = heard(text, "/p/image_raw")
    assert image.width == WIDTH
    assert "SK-SENSOR-123" in codes(text)


# ---------------------------------------------------------------------- life


def test_reset_restore_and_spawn_keep_the_settings_of_the_plugin() -> None:
    content = "<cameraName>k</cameraName><updateRate>20</updateRate>"
    with simkit.load(world("depth", CAMERA, plugin("gazebo_ros_openni_kinect", content))) as sim:
        depth = sim.subscribe("/k/depth/image_raw")
        sim.run(0.2)
        first, before = [bytes(m.data) for m in depth.messages], sim.snapshot()
        sim.spawn(f'<sdf version="1.6">{wall(2.0, -1.0, 1.0, "1 1 1")}</sdf>')
        sim.run(0.1)
        assert image_messages.pixels_of(depth.latest)[12, 20] == pytest.approx(2.0, abs=1e-3)
        sim.restore(before)
        sim.reset()
        count = len(depth.messages)
        sim.run(0.2)
        assert [bytes(m.data) for m in depth.messages[count:]] == first


@pytest.mark.parametrize(
    ("library", "content"),
    [
        ("gazebo_ros_camera", "<min_depth>2</min_depth><max_depth>1</max_depth>"),
        ("gazebo_ros_openni_kinect", "<pointCloudCutoff>6</pointCloudCutoff>"),
    ],
)
def test_an_empty_depth_range_is_an_error(library: str, content: str) -> None:
    with pytest.raises(simkit.LoadError, match="expected a .* beyond"):
        simkit.load(world("depth", CAMERA, plugin(library, content)))
