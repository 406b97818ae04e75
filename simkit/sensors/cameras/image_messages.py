"""Conversion of arrays into `Image` messages, and of camera models into `CameraInfo` messages."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.sensors.cameras.array_pool import AnyArray
from simkit.sensors.cameras.camera_model import CameraModel

IMAGE_TYPE = "sensor_msgs/msg/Image"

ENCODINGS: Mapping[str, str] = {
    "R8G8B8": "rgb8", "RGB_INT8": "rgb8", "B8G8R8": "bgr8", "BGR_INT8": "bgr8",
    "L8": "mono8", "L_INT8": "mono8", "L16": "mono16", "L_INT16": "mono16", "L_UINT16": "mono16",
    "RGBA_INT8": "rgba8", "BGRA_INT8": "bgra8",
    "R16G16B16": "rgb16", "RGB_INT16": "rgb16", "BGR_INT16": "bgr16",
    "R_FLOAT32": "32FC1", "RGB_FLOAT32": "32FC3",
    "BAYER_RGGB8": "bayer_rggb8", "BAYER_BGGR8": "bayer_bggr8",
    "BAYER_GBRG8": "bayer_gbrg8", "BAYER_GRBG8": "bayer_grbg8",
}  # fmt: skip
"""ROS encodings by the image formats of SDF (sdformat, Camera.cc, and Classic's spellings)."""

WITHOUT_ENCODING = ("R_FLOAT16", "RGB_FLOAT16", "RGB_INT32", "BGR_INT32")
"""Image formats of SDF that no `Image` message can contain."""

DEPTH_FORMATS = ("R_FLOAT32", "R_FLOAT16")
"""Formats of depth cameras that refer to the depths; the colours of such a camera are `rgb8`."""

_WHITE_16 = 65535 // 255  # factor from 8 to 16 bits that keeps white white


def is_grey(encoding: str) -> bool:
    """Check whether an encoding contains brightness only."""
    return encoding.startswith("mono")


def grey(colours: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
    """Return the brightness, shape (h, w), by the weights of Rec. 601."""
    import cv2

    return np.asarray(cv2.cvtColor(colours, cv2.COLOR_RGB2GRAY), dtype=np.uint8)


# pixels of an image: bytes, integers or floats, depending on its encoding
Pixels = AnyArray


def image_message(header: msgs.Header, pixels: Pixels, encoding: str) -> msgs.Image:
    """Return an `Image` of pixels, shape (h, w) or (h, w, n), little-endian like the array."""
    data = np.ascontiguousarray(pixels)
    height, width = data.shape[:2]
    return msgs.Image(header, height, width, encoding, 0, data.nbytes // height, data.reshape(-1).view(np.uint8))


def colour_message(header: msgs.Header, colours: npt.NDArray[np.uint8], encoding: str) -> msgs.Image:
    """Return a message of colours (h, w, 3), or of brightness (h, w) for a grey encoding.

    White is 65535 with 16 bits and 1 with floats. A single float channel is red, as in a render target of SDF's
    `R_FLOAT32`.
    """
    return image_message(header, _encode_colours(colours, encoding), encoding)


def _encode_colours(colours: npt.NDArray[np.uint8], encoding: str) -> Pixels:
    import cv2

    if encoding.startswith("bayer_"):
        return _bayer_mosaic(colours, encoding)
    if encoding.startswith("bgr") and encoding != "bgra8":
        colours = np.asarray(cv2.cvtColor(colours, cv2.COLOR_RGB2BGR), dtype=np.uint8)
    if encoding.endswith("16"):
        return colours * np.uint16(_WHITE_16)
    if encoding == "rgba8":
        return np.asarray(cv2.cvtColor(colours, cv2.COLOR_RGB2RGBA), dtype=np.uint8)
    if encoding == "bgra8":
        return np.asarray(cv2.cvtColor(colours, cv2.COLOR_RGB2BGRA), dtype=np.uint8)
    if encoding == "32FC1":
        return colours[..., 0] * np.float32(1 / 255)
    if encoding == "32FC3":
        return colours * np.float32(1 / 255)
    return colours


def _bayer_mosaic(colours: npt.NDArray[np.uint8], encoding: str) -> npt.NDArray[np.uint8]:
    """Return one colour per pixel, in squares of four that the encoding names row by row."""
    out = np.empty(colours.shape[:2], dtype=np.uint8)
    for index, letter in enumerate(encoding[len("bayer_") : -1]):
        row, column = divmod(index, 2)
        out[row::2, column::2] = colours[row::2, column::2, "rgb".index(letter)]
    return out


_PIXELS: Mapping[str, tuple[str, int]] = {
    "rgb8": ("u1", 3), "bgr8": ("u1", 3), "rgba8": ("u1", 4), "bgra8": ("u1", 4), "mono8": ("u1", 1),
    "8UC1": ("u1", 1), "mono16": ("<u2", 1), "16UC1": ("<u2", 1), "rgb16": ("<u2", 3), "bgr16": ("<u2", 3),
    "32FC1": ("<f4", 1), "32FC3": ("<f4", 3),
}  # fmt: skip


def pixels_of(message: msgs.Image) -> Pixels:
    """Return the pixels of an `Image`, shape (h, w), or (h, w, n) with several channels."""
    kind, channels = _PIXELS.get(message.encoding, ("u1", 1))
    flat = np.asarray(message.data, dtype=np.uint8).view(kind)
    shape = (message.height, message.width) + ((channels,) if channels > 1 else ())
    return flat.reshape(shape)


CAMERA_INFO_TYPE = "sensor_msgs/msg/CameraInfo"


class CameraInfoMaker:
    """Factory of `CameraInfo` messages that differ only in their headers.

    Args:
        model: model of the camera.
        baseline: distance [m] to the left camera of a stereo pair; P's last column becomes -fx·baseline, with P's fx.
    """

    def __init__(self, model: CameraModel, baseline: float = 0.0) -> None:
        model = model.info_model or model
        self._size = model.height, model.width
        self._distortion_model = model.distortion_model
        self._d = model.coefficients
        self._k = model.matrix
        self._r = np.eye(3).reshape(9)
        self._p = model.projection
        if baseline:
            self._p[3] = -self._p[0] * baseline

    def make(self, time_ns: int, frame_id: str) -> msgs.CameraInfo:
        """Return the message of one image."""
        height, width = self._size
        message: msgs.CameraInfo = msgs.make(
            CAMERA_INFO_TYPE,
            header=msgs.header(time_ns, frame_id),
            height=height,
            width=width,
            distortion_model=self._distortion_model,
            d=self._d.copy(),
            k=self._k.copy(),
            r=self._r.copy(),
            p=self._p.copy(),
        )
        return message
