"""Smooth edges: the mean of several samples in the pixels in which these differ."""

from __future__ import annotations

from typing import Final

import numpy as np

from simkit.sensors.cameras.rendering.software.colour_image import ColourImage
from simkit.sensors.cameras.rendering.software.frame import Frame
from simkit.sensors.cameras.rendering.software.vectors import Floats

_FOUR: Final = ((-0.125, -0.375), (0.375, -0.125), (-0.375, 0.125), (0.125, 0.375))
"""Places of four samples in a pixel [px], to the right and downwards, as graphics libraries choose them."""
_EIGHT: Final = (
    (0.0625, -0.1875), (-0.0625, 0.1875), (0.3125, 0.0625), (-0.1875, -0.3125),
    (-0.3125, 0.3125), (-0.4375, -0.0625), (0.1875, 0.4375), (0.4375, -0.4375),
)  # fmt: skip
_SAME: Final = np.float32(1.5 / 255.0)  # difference of colours below which a pixel counts as even
_NEAR: Final = np.float32(0.05)  # relative difference of depths below which a pixel counts as even


def smooth(picture: ColourImage, frame: Frame, image: Floats, samples: int) -> Floats:
    """Return an image with smooth edges.

    Args:
        picture: colours of the view.
        frame: frame of the image.
        image: colours at the middle of each pixel, shape (height, width, 3).
        samples: number of samples per pixel.
    """
    places = _FOUR if samples <= len(_FOUR) else _EIGHT
    centre, keys = picture.draw_basic(frame)
    total = np.zeros_like(image)
    frames = [frame.moved(*place) for place in places]
    uneven = np.zeros(keys.shape, bool)
    for moved in frames:
        colours, moved_keys = picture.draw_basic(moved)
        uneven |= (np.abs(colours - centre) > _SAME).any(axis=2)
        uneven |= np.abs(moved_keys - keys) > -_NEAR * np.maximum(keys, moved_keys)
    for moved in frames:
        colours, _ = picture.draw(moved, uneven)
        np.clip(colours, 0.0, 1.0, out=colours)
        total += colours
    mixed = image.copy()
    mixed[uneven] = total[uneven] * np.float32(1.0 / len(frames))
    return mixed
