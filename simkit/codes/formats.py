"""Pictures of cameras: their formats, files, rigs of several, and Classic's plugins."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import link, model, python, sensor

_SIZE = "<width>8</width><height>6</height>"


def _camera(content: str = "", image: str = "", name: str = "") -> str:
    named = f' name="{name}"' if name else ""
    return f"<camera{named}>\n  <image>{_SIZE}{image}</image>\n  {content}\n</camera>"


def _plugin(library: str, content: str) -> str:
    return f'{_camera()}\n<plugin name="driver" filename="{library}">\n  {content}\n</plugin>'


_SAVING = sensor("camera", _camera('<save enabled="true"><path>pictures</path></save>')).text
_BLOCKED = """
import simkit

sim = simkit.load("eye.sdf")
sim.run(0.01)
"""
_STEREO = """
<camera name="left"><image><width>8</width><height>6</height></image></camera>
<camera name="right">
  <pose>0 -0.1 0 0 0 -0.2</pose>
  <image><width>8</width><height>6</height></image>
</camera>
"""

CODES: tuple[Code, ...] = (
    Code(
        "SK-SENSOR-120",
        "warning",
        "an image format of SDF that no ROS message can hold; pictures are R8G8B8",
        "the formats that can be are listed",
        sensor("camera", _camera(image="<format>RGB_INT32</format>")),
    ),
    Code(
        "SK-SENSOR-121",
        "warning",
        "pictures of a camera with `<save>` can be saved no longer; the run goes on",
        "room and a folder that can be written to",
        # a file stands where the folder is to be
        python(_BLOCKED, {"eye.sdf": _SAVING, "pictures": "my notes"}),
    ),
    Code(
        "SK-SENSOR-122",
        "warning",
        "a camera plugin makes `CameraInfo` say other intrinsics or another distortion than the picture has",
        "`<horizontal_fov>`, `<lens><intrinsics>` and `<distortion>` of the sensor draw and tell it",
        sensor("camera", _plugin("libgazebo_ros_camera.so", "<focal_length>900</focal_length>")),
    ),
    Code(
        "SK-SENSOR-123",
        "note",
        "a parameter of a camera plugin changes nothing here",
        "the reason is given",
        sensor("camera", _plugin("libgazebo_ros_camera.so", "<border_crop>true</border_crop>")),
    ),
    Code(
        "SK-SENSOR-124",
        "note",
        "cameras of a `multicamera` that are not parallel; their projection matrix tells no baseline",
        "rectify the images, or make the cameras parallel",
        sensor("multicamera", _STEREO),
    ),
    Code(
        "SK-SENSOR-125",
        "warning",
        "cameras of a `multicamera` with different `<visibility_mask>`, `<anti_aliasing>`, `<trigger_topic>` or "
        "folders to save in; the first is used for all",
        "a sensor for each",
        sensor(
            "multicamera",
            f"{_camera('<visibility_mask>1</visibility_mask>', name='left')}\n{_camera(name='right')}",
        ),
    ),
    Code(
        "SK-SENSOR-126",
        "warning",
        "a RealSense plugin finds no sensor for one of its streams; the stream is left out",
        "the model's cameras are listed; names are `<prefix>` and color, depth, ired1, ired2",
        model(
            '<link name="base"/>\n'
            '<plugin filename="librealsense_gazebo_plugin.so" name="camera"><prefix>front_</prefix></plugin>'
        ),
    ),
    Code(
        "SK-SENSOR-127",
        "note",
        "cameras tell their `CameraInfo` on one topic, as in some of Gazebo's own worlds",
        "a `<camera_info_topic>` for each, where readers have to tell them apart otherwise than by frame",
        link(
            f'<sensor name="left" type="camera"><topic>left</topic>{_camera()}</sensor>\n'
            f'<sensor name="right" type="camera"><topic>right</topic>{_camera()}</sensor>'
        ),
    ),
    Code(
        "SK-SENSOR-128",
        "warning",
        "messages of two types are published on one topic; ROS gives a reader one of them only",
        "give each a topic of its own",
        sensor("camera", f"<topic>eye</topic>\n{_camera('<camera_info_topic>eye</camera_info_topic>')}"),
    ),
    Code(
        "SK-SENSOR-129",
        "note",
        "a topic's name holds characters that none may have: spaces become `_`, others are left out, as in Gazebo",
        "letters, digits and `_ / . : -`",
        sensor("camera", _camera("<triggered>true</triggered><trigger_topic>take one!</trigger_topic>")),
    ),
    Code(
        "SK-PLUGIN-012",
        "warning",
        "a topic of a plugin has characters that no name may have: spaces become `_`, others are left out",
        "letters, digits and `_ / . : -`, in names, namespaces and remappings",
        sensor("camera", _plugin("libgazebo_ros_camera.so", "<camera_name>front eye</camera_name>")),
    ),
)
