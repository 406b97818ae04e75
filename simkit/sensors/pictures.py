"""`Image` messages from arrays, and the pixel formats of SDF."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from simkit import msgs

TYPE = "sensor_msgs/msg/Image"

ENCODINGS = {
    "R8G8B8": "rgb8", "RGB_INT8": "rgb8", "B8G8R8": "bgr8", "BGR_INT8": "bgr8", "L8": "mono8", "L_INT8": "mono8",
    "L16": "mono16", "L_INT16": "mono16", "BAYER_RGGB8": "bayer_rggb8", "BAYER_BGGR8": "bayer_bggr8",
    "BAYER_GBRG8": "bayer_gbrg8", "BAYER_GRBG8": "bayer_grbg8", "R_FLOAT32": "rgb8",
}  # fmt: skip
"""SDF's image formats and what ROS calls them; a float format is a depth camera's, whose colours are plain."""


def is_grey(encoding: str) -> bool:
    return encoding.startswith("mono")


def grey(colours: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
    """Brightness, shape (h, w), by the weights of Rec. 601."""
    import cv2

    return np.asarray(cv2.cvtColor(colours, cv2.COLOR_RGB2GRAY), dtype=np.uint8)


def image_message(header: Any, pixels: npt.NDArray[Any], encoding: str) -> Any:
    """A message of pixels, shape (h, w) or (h, w, 3), in their own byte order (little-endian)."""
    data = np.ascontiguousarray(pixels)
    height, width = data.shape[:2]
    return msgs.type_of(TYPE)(
        header, height, width, encoding, 0, data.nbytes // height, data.reshape(-1).view(np.uint8)
    )


def colour_message(header: Any, colours: npt.NDArray[np.uint8], encoding: str) -> Any:
    """A message of colours (h, w, 3), or of brightness (h, w) for a grey encoding."""
    if encoding == "bgr8":
        return image_message(header, colours[..., ::-1], encoding)
    if encoding == "mono16":
        return image_message(header, colours.astype(np.uint16) * 257, encoding)
    if encoding.startswith("bayer_"):
        return image_message(header, _mosaic(colours, encoding), encoding)
    return image_message(header, colours, encoding)


def _mosaic(colours: npt.NDArray[np.uint8], encoding: str) -> npt.NDArray[np.uint8]:
    """One colour per pixel, in squares of four named row by row."""
    out = np.empty(colours.shape[:2], dtype=np.uint8)
    for place, letter in enumerate(encoding[len("bayer_") : -1]):
        row, column = divmod(place, 2)
        out[row::2, column::2] = colours[row::2, column::2, "rgb".index(letter)]
    return out
