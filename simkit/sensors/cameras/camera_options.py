"""Options of the `<camera>` block of a file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, TypeVar

from simkit.diagnostics import did_you_mean
from simkit.params import Params
from simkit.pose import IDENTITY, Pose
from simkit.sensors.cameras import image_messages
from simkit.sensors.cameras.camera_model import MAX_PIXELS, CameraModel, read_camera_model
from simkit.sensors.cameras.saved_images import read_save
from simkit.sensors.noise import NoiseModel, read_noise
from simkit.sensors.topics_and_frames import check_topic
from simkit.sensors.visibility_mask import ALL_VISIBLE, read_visibility_mask

_DEPTH_OUTPUTS = ("depths", "points")


def read_depth_range(block: Params, model: CameraModel) -> tuple[float, float]:
    """Read the range of depths [m] of a `<camera>` block: `<depth_camera><clip>`, or else the camera's own `<clip>`."""
    depth = block.child("depth_camera")
    if depth is None:
        return model.near, model.far
    output = depth.text("output", "depths")
    if output not in _DEPTH_OUTPUTS:
        message = f"<output>{output}</output> has no effect: depths and points are always published"
        hint = "reflectance and normals of Gazebo Classic are not simulated"
        depth.diagnostics.warning("SK-SENSOR-111", message, depth.block("output").where, hint)
    clip = depth.child("clip")
    if clip is None:
        return model.near, model.far
    near, far = clip.number("near", model.near, minimum=1e-6), clip.number("far", model.far, minimum=1e-6)
    if far > near:
        return near, far
    clip.error("SK-PARAM-002", f"found depths from {near:g} to {far:g} m; expected a <far> beyond <near>")
    return model.near, model.far


ModelReader = Callable[[Params, int, int], CameraModel]


@dataclass(frozen=True, slots=True)
class CameraOptions:
    """The `<camera>` block.

    Attributes:
        model: optics of the camera.
        encoding: ROS encoding of colour images.
        noise: white noise, in m for depths; for colours, 1 is the range from black to white.
        triggered: True takes images only after a message on `trigger_topic`.
        trigger_topic: topic of the trigger; empty for the default.
        info_topic: topic of `CameraInfo`; empty for the default.
        depth_near, depth_far: range of depths [m].
        anti_aliasing: 0 draws without smooth edges. Any other number uses the samples per pixel of the world's quality.
        name: `<camera name="…">`, or empty.
        pose: pose of the camera in the sensor's frame.
        optical_frame_id: frame of images and their `CameraInfo`, z forward; empty for the sensor's frame.
        visibility_mask: mask of the visible visuals; one of its bits must be in their `<visibility_flags>`.
        save: folder where each image is saved; None saves none.
    """

    model: CameraModel
    encoding: str
    noise: NoiseModel
    triggered: bool
    trigger_topic: str
    info_topic: str
    depth_near: float
    depth_far: float
    anti_aliasing: int = 4
    name: str = ""
    pose: Pose = IDENTITY
    optical_frame_id: str = ""
    visibility_mask: int = ALL_VISIBLE
    save: Path | None = None


AnyOptions = TypeVar("AnyOptions", bound=CameraOptions)


def extend_options(options: CameraOptions, kind: type[AnyOptions], **more: Any) -> AnyOptions:
    """Return a copy of the options as an object of the class `kind`, with values for its additional fields."""
    return kind(**{field.name: getattr(options, field.name) for field in fields(CameraOptions)}, **more)


def read_camera(block: Params, read_model: ModelReader = read_camera_model, has_depth: bool = False) -> CameraOptions:
    """Read the options of a `<camera>` block.

    Args:
        block: the `<camera>` block.
        read_model: function that reads the optics for an image of a width and a height.
        has_depth: True if the sensor's `<format>` may be a format of depths.
    """
    image = block.block("image")
    width, height = image.integer("width", 320, minimum=1), image.integer("height", 240, minimum=1)
    if max(width, height) > MAX_PIXELS:
        image.error("SK-PARAM-002", f"found an image of {width}x{height}; expected up to {MAX_PIXELS}x{MAX_PIXELS}")
        width, height = min(width, MAX_PIXELS), min(height, MAX_PIXELS)
    samples = image.integer("anti_aliasing", 4, minimum=0)
    model = read_model(block, width, height)
    depth_near, depth_far = read_depth_range(block, model)
    trigger_topic, info_topic = block.text("trigger_topic", ""), block.text("camera_info_topic", "")
    check_topic(trigger_topic, block, "trigger_topic")
    check_topic(info_topic, block, "camera_info_topic")
    return CameraOptions(
        model=model,
        encoding=_read_encoding(image, has_depth),
        noise=_read_image_noise(block),
        triggered=block.boolean("triggered", False),
        trigger_topic=trigger_topic,
        info_topic=info_topic,
        depth_near=depth_near,
        depth_far=depth_far,
        anti_aliasing=samples,
        visibility_mask=read_visibility_mask(block),
        name=block.attribute("name"),
        pose=block.pose("pose"),
        optical_frame_id=block.text("optical_frame_id", ""),
        save=read_save(block),
    )


def _read_encoding(image: Params, has_depth: bool) -> str:
    """Read `<format>`, and return its name in ROS."""
    element = image.child("format")
    image_format = element.value if element is not None else "R8G8B8"
    if element is None or (has_depth and image_format in image_messages.DEPTH_FORMATS):
        return "rgb8"
    if image_format in image_messages.ENCODINGS:
        return image_messages.ENCODINGS[image_format]
    allowed = "expected one of " + ", ".join(image_messages.ENCODINGS)
    if image_format in image_messages.WITHOUT_ENCODING:
        message = f"no ROS image has <format>{image_format}</format>; images are R8G8B8 instead"
        image.diagnostics.warning("SK-SENSOR-120", message, element.where, allowed)
    else:
        message = f"found <format>{image_format}</format>, {allowed}"
        element.error("SK-PARAM-002", message, did_you_mean(image_format.upper(), image_messages.ENCODINGS))
    return "rgb8"


def _read_image_noise(block: Params) -> NoiseModel:
    noise = read_noise(block, "gaussian")
    extras = (noise.bias_mean, noise.bias_stddev, noise.precision, noise.drifts, noise.noise_density)
    if any(extras):
        message = "only <mean> and <stddev> of a camera's <noise> have an effect, as in Gazebo"
        block.diagnostics.warning("SK-SENSOR-008", message, block.block("noise").where)
    return noise
