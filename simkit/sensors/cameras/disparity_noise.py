"""Noise of depths that a stereo camera or a projected pattern finds by triangulation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from simkit.params import Params
from simkit.runtime.engine.random_streams import RandomStreams
from simkit.sensors.cameras.camera_model import CameraModel
from simkit.sensors.cameras.image_noise import ImageNoise
from simkit.sensors.cameras.rendering.view import Depths
from simkit.sensors.noise import NoiseModel


@dataclass(frozen=True, slots=True)
class DisparityOptions:
    """`<disparity_noise>` of a camera with depths.

    Attributes:
        stddev: of disparities [px].
        step: disparities are multiples of it [px]; 0 is any.
        baseline: between the two eyes, or eye and projector [m].
        focal_length: of the pixels that disparities are counted in [px].
    """

    stddev: float
    step: float
    baseline: float
    focal_length: float


def read_disparity_noise(block: Params, model: CameraModel) -> DisparityOptions | None:
    """The options of a `<camera>` block, None where there are none."""
    noise = block.child("disparity_noise")
    if noise is None:
        return None
    return DisparityOptions(
        stddev=noise.number("stddev", 0.0, minimum=0.0, maximum=1e6),
        step=noise.number("step", 0.0, minimum=0.0, maximum=1e6),
        baseline=noise.number("baseline", required=True, minimum=1e-6, maximum=1e6),
        focal_length=noise.number("focal_length", model.fx, minimum=1e-3, maximum=1e9),
    )


class DisparityNoise:
    """Gaussian noise on the disparity d = f·B/z of every pixel, which is then rounded to whole steps.

    To first order the deviation of a depth is z²/(f·B) times that of a disparity, and the distance of neighbouring
    depths z²/(f·B) times a step. A disparity of 0 or less is a depth of +inf.

    Args:
        options: of the camera.
        streams: the simulation's.
        scoped: the sensor's name.
    """

    def __init__(self, options: DisparityOptions, streams: RandomStreams, scoped: str) -> None:
        length = options.focal_length * options.baseline  # [px·m]
        model = NoiseModel(stddev=options.stddev / length)
        self._noise = ImageNoise(model, streams, f"{scoped}/disparity")
        self._step = np.float32(options.step / length)
        self.is_silent = self._noise.is_silent and options.step == 0

    def on_depths(self, depths: Depths, index: int) -> Depths:
        """Depths [m], shape (h, w), of sample `index`; infinite ones stay."""
        one, infinite = np.float32(1.0), np.isinf(depths)
        with np.errstate(divide="ignore", over="ignore"):
            inverse = np.divide(one, depths)
            found = inverse if self._noise.is_silent else self._noise.on_depths(inverse, index)
            if self._step > 0:
                found /= self._step
                np.rint(found, out=found)
                found *= self._step
            lost = found <= 0
            np.divide(one, found, out=found)
        np.copyto(found, np.float32(np.inf), where=lost)
        np.copyto(found, depths, where=infinite)
        return found
