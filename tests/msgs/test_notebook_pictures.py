"""Pictures of scans and images in notebooks."""

import base64
import io
import math
from xml.etree import ElementTree

import numpy as np
import pytest

from simkit import msgs


def test_a_scan_is_drawn_with_one_dot_for_each_hit():
    scan = msgs.make("sensor_msgs/msg/LaserScan", angle_increment=math.pi / 2, ranges=[1.0, 2.0, math.inf])
    text = scan._repr_html_()
    drawn = ElementTree.fromstring(text[text.index("<svg") : text.index("</svg>") + 6])
    assert [path.attrib["transform"] for path in drawn.iter("path")] == ["rotate(-0.0)", "rotate(-90.0)"]
    assert "farthest hit 2.00 m" in text


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
