"""RealSense plugin: four streams of a model, with the names and encodings of the device's driver."""

from __future__ import annotations

import numpy as np
from camera_worlds import CAMERA, IMAGE, WALLS, heard, plugin, points_of, topics_of

import simkit
from simkit.sensors.cameras import image_messages


def realsense(more: str = "", left_out: str = "") -> str:
    grey = f"<camera>{IMAGE % '<format>L_INT8</format>'}</camera>"
    sensors = {
        "color": ("camera", CAMERA),
        "ired1": ("camera", grey),
        "ired2": ("camera", grey),
        "depth": ("depth", CAMERA),
    }
    links = "".join(
        f'<link name="{name}_link"><sensor name="d435{name}" type="{kind}"><update_rate>50</update_rate>{block}'
        "</sensor></link>"
        for name, (kind, block) in sensors.items()
        if name != left_out
    )
    content = f"""<prefix>d435</prefix><depthUpdateRate>30</depthUpdateRate>
      <colorTopicName>color/image_raw</colorTopicName><depthTopicName>depth/image_raw</depthTopicName><depthCameraInfoTopicName>depth/camera_info</depthCameraInfoTopicName>
      <infrared1TopicName>infra1/image_raw</infrared1TopicName><infrared2TopicName>infra2/image_raw</infrared2TopicName>
      <colorOpticalframeName>color_optical</colorOpticalframeName><rangeMinDepth>0.5</rangeMinDepth>
      <rangeMaxDepth>10</rangeMaxDepth><depthOpticalframeName>depth_optical</depthOpticalframeName>{more}"""
    driver = plugin("realsense_gazebo_plugin", content)
    return (
        '<sdf version="1.6"><world name="w"><scene><ambient>1 1 1 1</ambient></scene><model name="m">'
        f"<static>true</static>{links}{driver}</model>{WALLS}</world></sdf>"
    )


def test_a_realsense_publishes_its_streams_as_the_driver_does() -> None:
    text = realsense()
    with simkit.load(text) as sim:
        assert not [d for d in sim.diagnostics if d.severity != "note"]
        assert sorted(topics_of(sim)) == sorted(
            f"/d435/{stream}/{what}"
            for stream in ("color", "depth", "infra1", "infra2")
            for what in ("image_raw", "camera_info")
        )
    names = [f"/d435/{stream}/image_raw" for stream in ("color", "infra1", "depth")]
    colour, grey, depth, info = heard(text, *names, "/d435/depth/camera_info")
    assert (colour.encoding, grey.encoding, depth.encoding) == ("rgb8", "8UC1", "16UC1")
    assert (colour.header.frame_id, depth.header.frame_id) == ("color_optical", "depth_optical")
    assert info.header == depth.header
    found = image_messages.pixels_of(depth)
    np.testing.assert_allclose(found[:, 20:], 3000, atol=1)
    np.testing.assert_allclose(found[:, 16], 6000, atol=1)
    assert not found[:, 2].any()


def test_a_realsense_publishes_its_cloud() -> None:
    more = """<pointCloud>true</pointCloud><pointCloudTopicName>depth/color/points</pointCloudTopicName>
      <pointCloudCutoff>0.3</pointCloudCutoff>"""
    (cloud,) = heard(realsense(more), "/d435/depth/color/points")
    points = points_of(cloud)
    assert cloud.header.frame_id == "depth_optical"
    np.testing.assert_allclose(points["z"][:, 20:], 3.0, atol=1e-4)
    assert np.isnan(points["z"][:, 16]).all()  # 6 m, and <pointCloudCutoffMax> is 5 m where the file says nothing


def test_a_missing_camera_of_a_realsense_is_reported() -> None:
    with simkit.load(realsense(left_out="ired2")) as sim:
        (found,) = [d for d in sim.diagnostics if d.code == "SK-SENSOR-126"]
        assert "d435ired2" in found.message
        assert "/d435/infra2/image_raw" not in sim.topics()
