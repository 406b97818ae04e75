"""Names, rates and camera intrinsics that all camera plugins of Gazebo Classic read."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar, Final

import numpy as np

from simkit.params import Params
from simkit.plugins.base import Plugin, SensorPlugin
from simkit.plugins.endpoints import Endpoint, publishes
from simkit.plugins.find_entities import link_name
from simkit.plugins.options import Options, OptionsOf, boolean, number, text, without_effect

if TYPE_CHECKING:
    from simkit.sensors.cameras.camera_model import CameraModel
    from simkit.sensors.cameras.rendered_camera import RenderedCamera

EMPTY: Final = ("std_msgs/msg/Empty", "std_msgs/msg/Bool")
"""What triggers a camera of Classic; the first is Classic's own."""

_OF_ROS_1 = (
    "cameraName", "imageTopicName", "cameraInfoTopicName", "frameName", "updateRate", "hackBaseline", "robotNamespace",
    "triggerTopicName",
)  # fmt: skip
_CROPPED = "pictures are drawn beyond their edges before the lens bends them, so nothing is black and K holds"
CROP = {"border_crop": _CROPPED, "borderCrop": _CROPPED, "CxPrime": "Classic reads it and tells <Cx>"}
"""Parameters of every camera plugin that change nothing, and why."""

_MOST_PIXELS = 1e9
FARTHEST = 1e30  # [m]; depths have 32 bits
_MOST_BENT = 1e3
_FEW_PIXELS = 0.51  # of a principal point; Classic's own default is half a pixel off the picture's middle
_LITTLE = 1e-3  # of a focal length, and of a distortion: people write 1e-8 for none


class CameraOptions(Options):
    """Options of every camera plugin: of ROS 2, and in camelCase of ROS 1."""

    camera_name: str = text()
    camera_name_ros_1: str = text(element="cameraName")
    image_topic_name: str = text("image_raw", element="imageTopicName")
    camera_info_topic_name: str = text("camera_info", element="cameraInfoTopicName")
    hack_baseline_ros_1: float = number(0.0, "m", element="hackBaseline")
    hack_baseline: float = number(0.0, "m", instead="hack_baseline_ros_1")
    frame_name: str = text()
    frame_name_ros_1: str = text(element="frameName")
    update_rate: float = number(0.0, "Hz", element="updateRate", minimum=0)
    always_on: bool = without_effect(element="alwaysOn")
    focal_length_ros_1: float = number(0.0, "px", element="focalLength", minimum=0, maximum=_MOST_PIXELS)
    cx_ros_1: float = number(0.0, "px", element="Cx", minimum=0, maximum=_MOST_PIXELS)
    cy_ros_1: float = number(0.0, "px", element="Cy", minimum=0, maximum=_MOST_PIXELS)
    focal_length: float = number(0.0, "px", minimum=0, maximum=_MOST_PIXELS)
    cx: float = number(0.0, "px", minimum=0, maximum=_MOST_PIXELS)
    cy: float = number(0.0, "px", minimum=0, maximum=_MOST_PIXELS)
    distortion_k1: float = number(0.0, element="distortionK1", minimum=-_MOST_BENT, maximum=_MOST_BENT)
    distortion_k2: float = number(0.0, element="distortionK2", minimum=-_MOST_BENT, maximum=_MOST_BENT)
    distortion_k3: float = number(0.0, element="distortionK3", minimum=-_MOST_BENT, maximum=_MOST_BENT)
    distortion_t1: float = number(0.0, element="distortionT1", minimum=-_MOST_BENT, maximum=_MOST_BENT)
    distortion_t2: float = number(0.0, element="distortionT2", minimum=-_MOST_BENT, maximum=_MOST_BENT)
    auto_distortion: bool = boolean(element="autoDistortion")
    border_crop: bool = without_effect()
    border_crop_ros_1: bool = without_effect(element="borderCrop")
    cx_prime: bool = without_effect(element="CxPrime")


class CameraPlugin(SensorPlugin):
    """Base of the camera plugins."""

    endpoints: ClassVar[tuple[Endpoint, ...]] = (
        publishes("{camera_name}/image_raw", "sensor_msgs/msg/Image", named_by=("imageTopicName",)),
        publishes("{camera_name}/camera_info", "sensor_msgs/msg/CameraInfo", named_by=("cameraInfoTopicName",)),
    )
    options = OptionsOf(CameraOptions)


class CameraNames:
    """Where a camera's messages go.

    Attributes:
        is_ros_1: whether the file is written for ROS 1: camelCase, and no `<ros>`.
        camera: topics are below it; empty where a ROS 1 file names none.
    """

    def __init__(self, plugin: CameraPlugin, sensor: RenderedCamera, *, is_ros_1: bool | None = None) -> None:
        params, options = plugin.params, plugin.options
        self._ros = plugin.ros
        if is_ros_1 is None:
            is_ros_1 = not params.has("ros") and any(params.has(name) for name in _OF_ROS_1)
        self.is_ros_1 = is_ros_1
        self.camera = options.camera_name or options.camera_name_ros_1 or ("" if is_ros_1 else sensor.name)
        self.image = options.image_topic_name
        self.info = options.camera_info_topic_name

    def topic(self, name: str, below: str = "") -> str:
        """The absolute topic of a name below the camera's (and another name below that); `/name` is absolute."""
        if name.startswith("/"):
            return self._ros.topic(name)
        return self._ros.topic("/".join(part.strip("/") for part in (self.camera, below, name) if part.strip("/")))


def is_camera(plugin: SensorPlugin, sensor: RenderedCamera, wanted: str, product: str = "image") -> bool:
    """Whether the sensor has what a plugin publishes; reported where it has not."""
    fits = hasattr(sensor, "set_baseline") and product in sensor.products()
    if not fits:
        plugin.refuse(sensor, wanted)
    return fits


def name_frame(plugin: CameraPlugin, sensor: RenderedCamera) -> None:
    """`<frame_name>` of all messages, else the link's name; an `<optical_frame_id>` of the camera then stays."""
    frame = (plugin.options.frame_name or plugin.options.frame_name_ros_1 or link_name(sensor)).lstrip("/")
    is_named = any(plugin.params.has(name) for name in ("frame_name", "frameName"))
    if is_named or not sensor.optical_frame_id:
        sensor.set_frame_id(frame)
    else:
        sensor.frame_id = frame


def apply_update_rate(plugin: CameraPlugin, sensor: RenderedCamera) -> None:
    """`<updateRate>` [Hz] of ROS 1 slows a sensor down; 0 is as fast as the sensor goes."""
    rate, _ = plugin.options.update_rate, plugin.options.always_on
    if rate > 0 and (sensor.update_rate == 0 or rate < sensor.update_rate):
        sensor.set_rate(rate)


def override_intrinsics(plugin: CameraPlugin, sensor: RenderedCamera, *, is_ros_1: bool) -> None:
    """What the plugin's parameters make `CameraInfo` say; pictures are the sensor's own business.

    `<focalLength>`, `<Cx>`, `<Cy>` (`<focal_length>`, `<cx>`, `<cy>` in ROS 2) [px], 0 for the picture's own, and in
    ROS 1 `<distortionK1>` … `<distortionT2>`. Classic's default for the principal point, (w+1)/2, is half a pixel off
    the middle of its own pictures; it is told only in a world with Gazebo's quirks.
    """
    params, options = plugin.params, plugin.options
    if is_ros_1:
        names = ("focalLength", "Cx", "Cy")
        focal, cx, cy = options.focal_length_ros_1, options.cx_ros_1, options.cy_ros_1
    else:
        names = ("focal_length", "cx", "cy")
        focal, cx, cy = options.focal_length, options.cx, options.cy
    lens = _read_distortion(options) if is_ros_1 else {}
    is_off = bool(plugin.sim.world.gazebo_quirks)

    def change(model: CameraModel) -> CameraModel:
        own = model.info_model or model
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
    if told != (drawn.info_model or drawn):
        sensor.override_camera_info(change)
    _report_difference(params, drawn, told, names)


def _read_distortion(options: CameraOptions) -> dict[str, Any]:
    """D of ROS 1, where it says something; `<autoDistortion>` takes the lens of the sensor."""
    found = {
        "k1": options.distortion_k1,
        "k2": options.distortion_k2,
        "k3": options.distortion_k3,
        "p1": options.distortion_t1,
        "p2": options.distortion_t2,
    }
    if options.auto_distortion or max(map(abs, found.values())) < _LITTLE:
        return {}
    return found


def _report_difference(params: Params, drawn: CameraModel, told: CameraModel, names: Sequence[str]) -> None:
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


def read_depths(options: Options, near: str, far: str) -> tuple[float, float]:
    """The nearest and the farthest depth [m], by the names of their fields; the far one must be beyond the near one."""
    fields = type(options).fields()
    found: float = getattr(options, near)
    last: float = getattr(options, far)
    if last <= found:
        elements = f"<{fields[far].element}> beyond <{fields[near].element}>"
        options.params.error("SK-PARAM-002", f"found depths from {found:g} to {last:g} m, allowed is a {elements}")
        default_near = float(fields[near].default)
        return default_near, max(float(fields[far].default), 2 * default_near)
    return found, last if last <= FARTHEST else math.inf


def report_without_effect(plugin: Plugin, names: dict[str, str]) -> None:
    """Says once which of a plugin's parameters, each with its reason, change nothing here."""
    params = plugin.params
    for name, why in names.items():
        child = params.child(name)
        if child is not None and child.value.strip() not in ("", "0", "0.0"):
            params.diagnostics.note("SK-SENSOR-123", f"<{name}> has no effect: {why}", child.where)
