"""Noise of depths that a stereo camera or a projected pattern measures by triangulation."""

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
        stddev: standard deviation of disparities [px].
        step: quantisation step of disparities [px]; 0 for none.
        baseline: distance between the two cameras, or between camera and projector [m].
        focal_length: focal length of the pixels in which disparities are measured [px].
    """

    stddev: float
    step: float
    baseline: float
    focal_length: float


def read_disparity_noise(block: Params, model: CameraModel) -> DisparityOptions | None:
    """Read the options of a `<camera>` block; return None if it has none."""
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

    To first order, the standard deviation of a depth is z²/(f·B) times the standard deviation of a disparity. Two
    neighbouring depths differ by z²/(f·B) times a step. A disparity of 0 or less gives a depth of +inf.

    Args:
        options: options of the camera.
        streams: random streams of the simulation.
        scoped: scoped name of the sensor.
    """

    def __init__(self, options: DisparityOptions, streams: RandomStreams, scoped: str) -> None:
        length = options.focal_length * options.baseline  # [px·m]
        model = NoiseModel(stddev=options.stddev / length)
        self._noise = ImageNoise(model, streams, f"{scoped}/disparity")
        self._step = np.float32(options.step / length)
        self.is_silent = self._noise.is_silent and options.step == 0

    def on_depths(self, depths: Depths, index: int) -> Depths:
        """Return depths [m], shape (h, w), of sample `index` with noise; infinite depths stay infinite."""
        unit, infinite = np.float32(1.0), np.isinf(depths)
        with np.errstate(divide="ignore", over="ignore"):
            inverse = np.divide(unit, depths)
            disparities = inverse if self._noise.is_silent else self._noise.on_depths(inverse, index)
            if self._step > 0:
                disparities /= self._step
                np.rint(disparities, out=disparities)
                disparities *= self._step
            lost = disparities <= 0
            np.divide(unit, disparities, out=disparities)
        np.copyto(disparities, np.float32(np.inf), where=lost)
        np.copyto(disparities, depths, where=infinite)
        return disparities
