"""Cameras with depth."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import sensor

_IMAGE = "<image><width>64</width><height>48</height></image>"


def _camera(content: str) -> str:
    return f"<camera>\n  {_IMAGE}\n  {content}\n</camera>"


CODES: tuple[Code, ...] = (
    Code(
        "SK-SENSOR-110",
        "note",
        "a `depth_camera` has a range of depths in `<depth_camera><clip>`: it bounds them here, and nothing in Gazebo",
        "write the range in the camera's own `<clip>`; with `<simkit:gazebo_quirks>` it bounds nothing here either",
        sensor("depth_camera", _camera("<depth_camera><clip><near>0.2</near><far>5</far></clip></depth_camera>")),
    ),
    Code(
        "SK-SENSOR-111",
        "warning",
        "an `<output>` of a depth camera that is neither depths nor points, and changes nothing",
        "depths and points are always there; reflectance and normals of Gazebo Classic are not simulated",
        sensor("depth_camera", _camera("<depth_camera><output>reflectance</output></depth_camera>")),
    ),
    Code(
        "SK-SENSOR-112",
        "note",
        "a cloud of a Gazebo Classic plugin, which has z forward whatever its frame is, is in the frame of a link that "
        "has not: it shows turned, as in Gazebo Classic",
        "`<frame_name>` (`<frameName>`) of a link that is turned to the sensor's by an rpy of -1.5708 0 -1.5708",
        sensor("depth", _camera("") + '\n<plugin name="driver" filename="libgazebo_ros_camera.so"/>'),
    ),
)
