"""Pictures of messages in notebooks."""

import base64
import io
import math
import re
from xml.etree import ElementTree

import numpy as np
import pytest

from simkit import msgs


def drawn_dots(text):
    """Return the places of an SVG [px]."""
    drawn = ElementTree.fromstring(text[text.index("<svg") : text.index("</svg>") + 6])
    numbers = [
        float(number) for number in re.findall(r"[-.\d]+", drawn.find(".//{*}path").attrib["d"].replace("h0", ""))
    ]
    return list(zip(numbers[::2], numbers[1::2], strict=True))


def test_a_scan_is_drawn_from_above_with_one_dot_for_each_hit():
    scan = msgs.make("sensor_msgs/msg/LaserScan", angle_increment=math.pi / 2, ranges=[1.0, 2.0, math.inf])
    text = scan._repr_html_()
    assert drawn_dots(text) == [(200, 0), (0, 100)]  # ahead: up, left: left; the sensor is at (200, 100)
    assert "farthest hit 2.00 m" in text


@pytest.mark.parametrize(
    ("frame", "ahead_and_left"), [("lidar", [(2, 0, 0), (0, 2, 0)]), ("optical", [(0, 0, 2), (-2, 0, 0)])]
)
def test_a_point_cloud_is_drawn_from_above_without_its_infinite_points(frame, ahead_and_left):
    places = np.array([*ahead_and_left, (math.nan, 1, 1)], np.float32)
    fields = [{"name": name, "offset": 4 * i, "datatype": 7, "count": 1} for i, name in enumerate("xyz")]
    cloud = msgs.make(
        "sensor_msgs/msg/PointCloud2", header={"frame_id": frame}, height=1, width=3, fields=fields, point_step=12,
        row_step=36, data=np.frombuffer(places.tobytes(), np.uint8),
    )  # fmt: skip
    text = cloud._repr_html_()
    assert "2 points" in text
    assert drawn_dots(text) == [(200, 0), (0, 200)]


def test_a_path_is_a_line_with_its_length():
    poses = [{"pose": {"position": {"x": x, "y": y}}} for x, y in ((0, 0), (3, 0), (3, 4))]
    text = msgs.make("nav_msgs/msg/Path", poses=poses)._repr_html_()
    assert drawn_dots(text) == [(200, 150), (200, 0), (0, 0)]
    assert "3 poses, 7.00 m" in text


def test_an_occupancy_grid_is_a_map_whose_first_row_is_the_lowest():
    from PIL import Image

    info = {"width": 2, "height": 2, "resolution": 0.5}
    text = msgs.make("nav_msgs/msg/OccupancyGrid", info=info, data=[100, 0, -1, 50])._repr_html_()
    data = base64.b64decode(text[text.index("base64,") + 7 : text.rindex('"')])
    picture = Image.open(io.BytesIO(data))
    assert picture.resize((2, 2), Image.Resampling.NEAREST).tobytes() == bytes([160, 127, 0, 255])
    assert "1 m × 1 m, cells of 0.5 m" in text


@pytest.mark.parametrize("name", ["sensor_msgs/msg/PointCloud2", "nav_msgs/msg/Path", "nav_msgs/msg/OccupancyGrid"])
def test_an_empty_message_is_shown_as_text(name):
    assert msgs.make(name)._repr_html_().startswith("<code>")


def test_a_long_scan_has_a_short_picture():
    scan = msgs.make("sensor_msgs/msg/LaserScan", angle_increment=0.001, ranges=np.ones(6000))
    assert len(scan._repr_html_()) < 30_000


@pytest.mark.parametrize(
    ("encoding", "pixels"),
    [("rgb8", np.full((2, 3, 3), 200, np.uint8)), ("32FC1", np.array([[1.0, np.inf], [np.nan, 4.0]], np.float32))],
)
def test_an_image_is_an_inline_png(encoding, pixels):
    from PIL import Image

    message = msgs.make(
        "sensor_msgs/msg/Image", height=pixels.shape[0], width=pixels.shape[1], encoding=encoding,
        step=pixels.nbytes // pixels.shape[0], data=np.frombuffer(pixels.tobytes(), np.uint8),
    )  # fmt: skip
    text = message._repr_html_()
    data = base64.b64decode(text[text.index("base64,") + 7 : text.rindex('"')])
    assert Image.open(io.BytesIO(data)).size == (pixels.shape[1], pixels.shape[0])
