"""Parameters of all camera plugins of Gazebo Classic: names, rates and intrinsics."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar, Final

import numpy as np

from simkit.params import Params
from simkit.plugins.base import Plugin, SensorPlugin
from simkit.plugins.endpoints import Endpoint, publishes
from simkit.plugins.find_entities import SensorFrameOptions
from simkit.plugins.options import Options, OptionsOf, boolean, number, text, without_effect

if TYPE_CHECKING:
    from simkit.sensors.cameras.camera_model import CameraModel
    from simkit.sensors.cameras.distortion_model import Distortion
    from simkit.sensors.cameras.rendered_camera import RenderedCamera

EMPTY: Final = ("std_msgs/msg/Empty", "std_msgs/msg/Bool")
"""Types of messages that trigger a camera of Gazebo Classic; Classic itself uses the first type."""

_OF_ROS_1 = (
    "cameraName", "imageTopicName", "cameraInfoTopicName", "frameName", "updateRate", "hackBaseline", "robotNamespace",
    "triggerTopicName",
)  # fmt: skip
_CROPPED = "pictures are rendered beyond their edges before distortion, so they have no black border and K is valid"
CROP = {"border_crop": _CROPPED, "borderCrop": _CROPPED, "CxPrime": "Classic reads this element but publishes <Cx>"}
"""Reason why a parameter of all camera plugins has no effect, by parameter name."""

_MOST_PIXELS = 1e9
FARTHEST = 1e30  # [m]; depths have 32 bits
_MOST_BENT = 1e3
# tolerance of a principal point; Classic's default differs from the picture's centre by half a pixel
_FEW_PIXELS = 0.51
_LITTLE = 1e-3  # tolerance, relative for a focal length, absolute for a distortion; files write 1e-8 for no distortion


class CameraOptions(SensorFrameOptions):
    """Options of every camera plugin: in the spelling of ROS 2, and in camelCase of ROS 1."""

    camera_name: str = text(ros_1="cameraName")
    image_topic_name: str = text("image_raw", element="imageTopicName")
    camera_info_topic_name: str = text("camera_info", element="cameraInfoTopicName")
    hack_baseline_ros_1: float = number(0.0, "m", element="hackBaseline")
    hack_baseline: float = number(0.0, "m", instead="hack_baseline_ros_1")
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
    """Topics of a camera's messages.

    Attributes:
        is_ros_1: whether the file uses the ROS 1 spelling: camelCase, and no `<ros>`.
        camera: namespace of the topics; empty if a ROS 1 file has none.
    """

    def __init__(self, plugin: CameraPlugin, sensor: RenderedCamera, *, is_ros_1: bool | None = None) -> None:
        params, options = plugin.params, plugin.options
        self._ros = plugin.ros
        if is_ros_1 is None:
            is_ros_1 = not params.has("ros") and any(params.has(name) for name in _OF_ROS_1)
        self.is_ros_1 = is_ros_1
        self.camera = options.camera_name or ("" if is_ros_1 else sensor.name)
        self.image = options.image_topic_name
        self.info = options.camera_info_topic_name

    def topic(self, name: str, below: str = "") -> str:
        """Return the absolute topic of a name below the camera's namespace and `below`; `/name` is absolute already."""
        if name.startswith("/"):
            return self._ros.topic(name)
        return self._ros.topic("/".join(part.strip("/") for part in (self.camera, below, name) if part.strip("/")))


def is_camera(plugin: SensorPlugin, sensor: RenderedCamera, required_kind: str, product: str = "image") -> bool:
    """Check whether the sensor has the product that a plugin publishes, and report an error if not."""
    fits = hasattr(sensor, "set_baseline") and product in sensor.products()
    if not fits:
        plugin.refuse(sensor, required_kind)
    return fits


def name_frame(plugin: CameraPlugin, sensor: RenderedCamera) -> None:
    """Set the frame of all messages to `<frame_name>`, else to the link's name.

    Without `<frame_name>`, messages with optical axes keep the sensor's `<optical_frame_id>`.
    """
    frame = plugin.options.frame_of(sensor).lstrip("/")
    is_named = any(plugin.params.has(name) for name in ("frame_name", "frameName"))
    if is_named or not sensor.optical_frame_id:
        sensor.set_frame_id(frame)
    else:
        sensor.frame_id = frame


def apply_update_rate(plugin: CameraPlugin, sensor: RenderedCamera) -> None:
    """Lower a sensor's rate to `<updateRate>` [Hz] of ROS 1; 0 keeps the sensor's rate."""
    rate, _ = plugin.options.update_rate, plugin.options.always_on
    if rate > 0 and (sensor.update_rate == 0 or rate < sensor.update_rate):
        sensor.set_rate(rate)


def override_intrinsics(plugin: CameraPlugin, sensor: RenderedCamera, *, is_ros_1: bool) -> None:
    """Replace the intrinsics in `CameraInfo` by the plugin's parameters; the pictures do not change.

    The parameters are `<focalLength>`, `<Cx>` and `<Cy>` [px] (`<focal_length>`, `<cx>` and `<cy>` in ROS 2). With the
    value 0, the intrinsics of the picture are published. ROS 1 also has `<distortionK1>` … `<distortionT2>`. Classic's
    default for the principal point, (w+1)/2, is half a pixel off the centre of its own pictures. simkit uses this
    default only in a world with Gazebo's quirks.
    """
    params, options = plugin.params, plugin.options
    if is_ros_1:
        names = ("focalLength", "Cx", "Cy")
        focal, cx, cy = options.focal_length_ros_1, options.cx_ros_1, options.cy_ros_1
    else:
        names = ("focal_length", "cx", "cy")
        focal, cx, cy = options.focal_length, options.cx, options.cy
    is_off = bool(plugin.sim.world.gazebo_quirks)

    def change(model: CameraModel) -> CameraModel:
        intrinsics = model.info_model or model
        middle = ((intrinsics.width + 1) / 2, (intrinsics.height + 1) / 2) if is_off else (intrinsics.cx, intrinsics.cy)
        return replace(
            intrinsics,
            fx=focal or intrinsics.fx,
            fy=focal or intrinsics.fy,
            cx=cx or middle[0],
            cy=cy or middle[1],
            distortion=_read_distortion(options, intrinsics.distortion) if is_ros_1 else intrinsics.distortion,
        )

    drawn = sensor.options.model
    published = change(drawn)
    if published != (drawn.info_model or drawn):
        sensor.override_camera_info(change)
    _report_difference(params, drawn, published, names)


def _read_distortion(options: CameraOptions, drawn: Distortion) -> Distortion:
    """Return the distortion that a ROS 1 file sets; that of the picture if it is zero, or with `<autoDistortion>`."""
    radial = options.distortion_k1, options.distortion_k2, options.distortion_k3
    k1, k2, k3, p1, p2 = (*radial, options.distortion_t1, options.distortion_t2)
    if options.auto_distortion or max(map(abs, (k1, k2, k3, p1, p2))) < _LITTLE:
        return drawn
    return replace(drawn, k1=k1, k2=k2, k3=k3, p1=p1, p2=p2)


def _report_difference(params: Params, drawn: CameraModel, published: CameraModel, names: Sequence[str]) -> None:
    off = []
    if abs(published.fx - drawn.fx) > _LITTLE * drawn.fx:
        off.append(f"<{names[0]}>{published.fx:g} instead of {drawn.fx:g}")
    for name, value, drawn_value in ((names[1], published.cx, drawn.cx), (names[2], published.cy, drawn.cy)):
        if abs(value - drawn_value) > _FEW_PIXELS:
            off.append(f"<{name}>{value:g} instead of {drawn_value:g}")
    if np.abs(published.coefficients - drawn.coefficients).max(initial=0.0) > _LITTLE:
        off.append("a distortion that the picture does not have")
    if off:
        hint = "set <horizontal_fov>, <lens><intrinsics> and <distortion> of the sensor, which change both"
        params.warning("SK-SENSOR-122", f"CameraInfo differs from the picture: {'; '.join(off)}", hint)


def read_depths(options: Options, near: str, far: str) -> tuple[float, float]:
    """Return the nearest and the farthest depth [m] from the named fields; the far depth must exceed the near depth."""
    fields = type(options).fields()
    first: float = getattr(options, near)
    last: float = getattr(options, far)
    if last <= first:
        elements = f"<{fields[far].element}> beyond <{fields[near].element}>"
        options.params.error("SK-PARAM-002", f"found depths from {first:g} to {last:g} m; expected a {elements}")
        default_near = float(fields[near].default)
        return default_near, max(float(fields[far].default), 2 * default_near)
    return first, last if last <= FARTHEST else math.inf


def report_without_effect(plugin: Plugin, names: dict[str, str]) -> None:
    """Report each of a plugin's parameters that has no effect, with the reason."""
    params = plugin.params
    for name, why in names.items():
        child = params.child(name)
        if child is not None and child.value.strip() not in ("", "0", "0.0"):
            params.diagnostics.note("SK-SENSOR-123", f"<{name}> has no effect: {why}", child.where)
