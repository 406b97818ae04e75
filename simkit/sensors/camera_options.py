"""The `<camera>` block of a file."""

from __future__ import annotations

from dataclasses import dataclass

from simkit.params import Params
from simkit.sensors import pictures
from simkit.sensors.camera_model import MOST_PIXELS, CameraModel, read_camera_model
from simkit.sensors.noise import NoiseModel, read_noise


@dataclass(frozen=True, slots=True)
class CameraOptions:
    """The `<camera>` block.

    Attributes:
        encoding: of colour images, as ROS names it.
        noise: white noise; 1 is white for colours, 1 m for depths.
        triggered: pictures are taken only when a message on `trigger_topic` has come in.
        depth_near, depth_far: range of depths [m].
    """

    model: CameraModel
    encoding: str
    noise: NoiseModel
    triggered: bool
    trigger_topic: str
    info_topic: str
    depth_near: float
    depth_far: float


def read_options(params: Params) -> CameraOptions:
    block = params.block("camera")
    image = block.block("image")
    width, height = image.integer("width", 320, minimum=1), image.integer("height", 240, minimum=1)
    if max(width, height) > MOST_PIXELS:
        image.error("SK-PARAM-002", f"found an image of {width}x{height}, allowed is up to {MOST_PIXELS}x{MOST_PIXELS}")
        width, height = min(width, MOST_PIXELS), min(height, MOST_PIXELS)
    image.child("anti_aliasing")
    model = read_camera_model(block, width, height)
    depth = block.child("depth_camera")
    clip = depth.child("clip") if depth is not None else None
    if depth is not None:
        depth.child("output")
    return CameraOptions(
        model=model,
        encoding=pictures.ENCODINGS[image.choice("format", tuple(pictures.ENCODINGS), "R8G8B8")],
        noise=_read_image_noise(block),
        triggered=block.boolean("triggered", False),
        trigger_topic=block.text("trigger_topic", ""),
        info_topic=block.text("camera_info_topic", ""),
        depth_near=clip.number("near", 0.1, minimum=1e-6) if clip else model.near,
        depth_far=clip.number("far", 10.0, minimum=1e-6) if clip else model.far,
    )


def _read_image_noise(block: Params) -> NoiseModel:
    noise = read_noise(block, "gaussian")
    extras = (noise.bias_mean, noise.bias_stddev, noise.precision, noise.wanders, noise.noise_density)
    if any(extras):
        message = "of a camera's noise only mean and stddev are used, as in Gazebo"
        block.diagnostics.warning("SK-SENSOR-008", message, block.block("noise").where)
    save = block.child("save")
    if save is not None and save.attribute("enabled", "false") in ("true", "1"):
        block.diagnostics.warning("SK-SENSOR-009", "<save> is not used: record the topic instead", save.where)
    if save is not None:
        save.mark_all_read()
    return noise
