"""Reading of a camera: colours and depths, with noise that is drawn when it is asked for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from simkit.sensors.cameras.image_noise import ImageNoise


@dataclass(frozen=True)
class CameraReading:
    """Colours (h, w, 3), or brightness (h, w); depths (h, w) along the optical axis [m], None for a plain camera."""

    colours: npt.NDArray[np.uint8]
    depths: npt.NDArray[np.float32] | None


class NoisyCameraReading:
    """Colours with noise, drawn when they are first asked for."""

    def __init__(self, picture: CameraReading, noise: ImageNoise, index: int) -> None:
        self._picture, self._noise, self._index = picture, noise, index
        self._colours: npt.NDArray[np.uint8] | None = None

    @property
    def colours(self) -> npt.NDArray[np.uint8]:
        if self._colours is None:
            self._colours = self._noise.on_colours(self._picture.colours, self._index)
        return self._colours
