"""Names, rates and camera intrinsics that all camera plugins of Gazebo Classic read."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Final

import numpy as np

from simkit.params import Params
from simkit.plugins.base import Plugin, SensorPlugin
from simkit.plugins.lookups import read_frame

EMPTY: Final = ("std_msgs/msg/Empty", "std_msgs/msg/Bool")
"""What triggers a camera of Classic; the first is Classic's own."""

_OF_ROS_1 = (
    "cameraName", "imageTopicName", "cameraInfoTopicName", "frameName", "updateRate", "hackBaseline", "robotNamespace",
    "triggerTopicName",
)  # fmt: skip
_DISTORTION = {
    "k1": "distortionK1", "k2": "distortionK2", "k3": "distortionK3", "p1": "distortionT1", "p2": "distortionT2",
}  # fmt: skip
_CROPPED = "pictures are drawn beyond their edges before the lens bends them, so nothing is black and K holds"
CROP = {"border_crop": _CROPPED, "borderCrop": _CROPPED, "CxPrime": "Classic reads it and tells <Cx>"}
"""Parameters of every camera plugin that change nothing, and why."""

_MOST_PIXELS = 1e9
FARTHEST = 1e30  # [m]; depths have 32 bits
_MOST_BENT = 1e3
_FEW_PIXELS = 0.51  # of a principal point; Classic's own default is half a pixel off the picture's middle
_LITTLE = 1e-3  # of a focal length, and of a distortion: people write 1e-8 for none


class CameraNames:
    """Where a camera's messages go.

    Attributes:
        is_ros_1: whether the file is written for ROS 1: camelCase, and no `<ros>`.
        camera: topics are below it; empty where a ROS 1 file names none.
    """

    def __init__(self, plugin: SensorPlugin, sensor: Any, *, is_ros_1: bool | None = None) -> None:
        params = plugin.params
        self._ros = plugin.ros
        if is_ros_1 is None:
            is_ros_1 = not params.has("ros") and any(params.has(name) for name in _OF_ROS_1)
        self.is_ros_1 = is_ros_1
        given = params.text("camera_name", "") or params.text("cameraName", "")
        self.camera = given or ("" if is_ros_1 else sensor.name)
        self.image = params.text("imageTopicName", "image_raw")
        self.info = params.text("cameraInfoTopicName", "camera_info")

    def topic(self, name: str, below: str = "") -> str:
        """The absolute topic of a name below the camera's (and another name below that); `/name` is absolute."""
        if name.startswith("/"):
            return self._ros.topic(name)
        return self._ros.topic("/".join(part.strip("/") for part in (self.camera, below, name) if part.strip("/")))


def is_camera(plugin: SensorPlugin, sensor: Any, wanted: str, product: str = "image") -> bool:
    """Whether the sensor has what a plugin publishes; reported where it has not."""
    fits = hasattr(sensor, "set_baseline") and product in sensor.products()
    if not fits:
        plugin.refuse(sensor, wanted)
    return fits


def name_frame(plugin: SensorPlugin, sensor: Any) -> None:
    """`<frame_name>` of all messages, else the link's name; an `<optical_frame_id>` of the camera then stays."""
    frame = read_frame(sensor, plugin.params).lstrip("/")
    is_named = any(plugin.params.has(name) for name in ("frame_name", "frameName"))
    if is_named or not sensor.optical_frame_id:
        sensor.set_frame_id(frame)
    else:
        sensor.frame_id = frame


def apply_update_rate(plugin: SensorPlugin, sensor: Any) -> None:
    """`<updateRate>` [Hz] of ROS 1 slows a sensor down; 0 is as fast as the sensor goes."""
    rate = plugin.params.number("updateRate", 0.0, minimum=0)
    plugin.params.child("alwaysOn")
    if rate > 0 and (sensor.update_rate == 0 or rate < sensor.update_rate):
        sensor.set_rate(rate)


def override_intrinsics(plugin: SensorPlugin, sensor: Any, *, is_ros_1: bool) -> None:
    """What the plugin's parameters make `CameraInfo` say; pictures are the sensor's own business.

    `<focalLength>`, `<Cx>`, `<Cy>` (`<focal_length>`, `<cx>`, `<cy>` in ROS 2) [px], 0 for the picture's own, and in
    ROS 1 `<distortionK1>` … `<distortionT2>`. Classic's default for the principal point, (w+1)/2, is half a pixel off
    the middle of its own pictures; it is told only in a world with Gazebo's quirks.
    """
    params = plugin.params
    names = ("focalLength", "Cx", "Cy") if is_ros_1 else ("focal_length", "cx", "cy")
    focal, cx, cy = (params.number(name, 0.0, minimum=0, maximum=_MOST_PIXELS) for name in names)
    lens = _read_distortion(params) if is_ros_1 else {}
    is_off = bool(plugin.sim.world.gazebo_quirks)

    def change(model: Any) -> Any:
        own = model.told or model
        middle = ((own.width + 1) / 2, (own.height + 1) / 2) if is_off else (own.cx, own.cy)
        return replace(
            own,
            fx=focal or own.fx,
            fy=focal or own.fy,
            cx=cx or middle[0],
            cy=cy or middle[1],
            distortion=replace(own.distortion, **lens),
        )

    drawn = sensor.options.model
    told = change(drawn)
    if told != (drawn.told or drawn):
        sensor.override_camera_info(change)
    _report_difference(params, drawn, told, names)


def _read_distortion(params: Params) -> dict[str, float]:
    """D of ROS 1, where it says something; `<autoDistortion>` takes the lens of the sensor."""
    found = {
        name: params.number(element, 0.0, minimum=-_MOST_BENT, maximum=_MOST_BENT)
        for name, element in _DISTORTION.items()
    }
    if params.boolean("autoDistortion", False) or max(map(abs, found.values())) < _LITTLE:
        return {}
    return found


def _report_difference(params: Params, drawn: Any, told: Any, names: Sequence[str]) -> None:
    off = []
    if abs(told.fx - drawn.fx) > _LITTLE * drawn.fx:
        off.append(f"<{names[0]}>{told.fx:g}, where the picture has {drawn.fx:g}")
    for name, value, own in ((names[1], told.cx, drawn.cx), (names[2], told.cy, drawn.cy)):
        if abs(value - own) > _FEW_PIXELS:
            off.append(f"<{name}>{value:g}, where the picture has {own:g}")
    if np.abs(told.coefficients - drawn.coefficients).max(initial=0.0) > _LITTLE:
        off.append("a distortion that the picture does not have")
    if off:
        message = f"CameraInfo is made to say {'; '.join(off)}"
        hint = "<horizontal_fov>, <lens><intrinsics> and <distortion> of the sensor draw and tell it"
        params.diagnostics.warning("SK-SENSOR-122", message, params.where, hint)


def read_depths(
    params: Params, near: str, far: str, default_near: float, default_far: float = math.inf
) -> tuple[float, float]:
    """Two elements with the nearest and the farthest depth [m]; the far one has to be beyond the near one."""
    found = params.number(near, default_near, minimum=0, maximum=FARTHEST)
    last = params.number(far, default_far, minimum=0, finite=False)
    if last <= found:
        message = f"found depths from {found:g} to {last:g} m, allowed is a <{far}> beyond <{near}>"
        params.error("SK-PARAM-002", message)
        return default_near, max(default_far, 2 * default_near)
    return found, last if last <= FARTHEST else math.inf


def report_without_effect(plugin: Plugin, names: dict[str, str]) -> None:
    """Says once which of a plugin's parameters, each with its reason, change nothing here."""
    params = plugin.params
    for name, why in names.items():
        child = params.child(name)
        if child is not None and child.value.strip() not in ("", "0", "0.0"):
            params.diagnostics.note("SK-SENSOR-123", f"<{name}> has no effect: {why}", child.where)
