"""Pixels of image messages as NumPy arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from simkit.argument_checks import wrong_type
from simkit.errors import ArgumentValueError
from simkit.msgs.message_builder import builder_of
from simkit.msgs.message_types import Message
from simkit.number_text import counted

if TYPE_CHECKING:
    from simkit.msgs.message_classes import CompressedImage
    from simkit.msgs.message_classes import Image as ImageMessage

Pixels = npt.NDArray[Any]
_CHANNELS: Final = {"mono": 1, "rgb": 3, "bgr": 3, "rgba": 4, "bgra": 4}
_ENCODINGS: Final = {
    f"{order}{bits}": (f"u{bits // 8}", count) for order, count in _CHANNELS.items() for bits in (8, 16)
}
_SIZES: Final = {"8U": "u1", "8S": "i1", "16U": "u2", "16S": "i2", "32S": "i4", "32F": "f4", "64F": "f8"}
_PACKED: Final = {"uyvy": "UYVY", "yuv422": "UYVY", "yuyv": "YUY2", "yuv422_yuy2": "YUY2"}
"""OpenCV's names of encodings with two bytes per pixel, a brightness and a part of the colour."""
_DEPTH_HEAD: Final = 12  # [bytes] head of a `compressedDepth` image: format, and two parameters of the inverse depth


def image(message: ImageMessage | CompressedImage) -> Pixels:
    """Return the pixels of an image, with the channels in the order red, green, blue (and alpha).

    Args:
        message: `sensor_msgs/msg/Image` or `CompressedImage` (JPEG, PNG, or `compressedDepth`).

    Returns:
        New array, shape (height, width, channels), or (height, width) with one channel: grey values, depths in metres
        (32FC1) or in millimetres (16UC1). The numbers are those of the message: uint8, uint16 or float32. Images of
        `bgr8` and `bgra8` are reordered, Bayer and YUV images are converted. Channels without names (`8UC3`) keep
        their order.

    Raises:
        ArgumentTypeError: the message is not an image.
        ArgumentValueError: the encoding is unknown, or the data do not fit it.
    """
    picture: Message = message
    name = getattr(picture, "__msgtype__", "")
    if name == "sensor_msgs/msg/CompressedImage":
        return _in_rgb_order(decode_compressed(picture))
    if name != "sensor_msgs/msg/Image":
        raise wrong_type("the image", "a sensor_msgs/msg/Image or CompressedImage", message)
    import cv2

    encoding = str(picture.encoding)
    if encoding in _PACKED:
        packed = _rows(picture, "u1", 2, encoding)
        return np.asarray(cv2.cvtColor(packed, getattr(cv2, f"COLOR_YUV2RGB_{_PACKED[encoding]}")))
    values = read_pixels(picture)[0]
    if encoding.startswith("bayer_"):
        pattern = encoding.removeprefix("bayer_").rstrip("0123456789").upper()
        return np.asarray(cv2.cvtColor(values, getattr(cv2, f"COLOR_Bayer{pattern}2RGB")))
    return _in_rgb_order(values) if encoding.startswith("bgr") else values.copy()


def _in_rgb_order(values: Pixels) -> Pixels:
    """Return a copy of pixels with the blue channel first, with the red channel first."""
    return values.copy() if values.ndim == 2 else values[:, :, [2, 1, 0, 3][: values.shape[2]]].copy()


def read_pixels(message: ImageMessage) -> tuple[Pixels, str]:
    """Return the values of an image and the order of its channels.

    Returns:
        Values, shape (height, width) or (height, width, channels), and the order: gray, rgb or bgr. The array may share
        the memory of the message.

    Raises:
        ArgumentValueError: the encoding is unknown, or the image has too few bytes.
    """
    encoding = str(message.encoding)
    kind, channels = _layout(encoding)
    values = _rows(message, kind, channels, encoding)
    order = "rgb" if encoding.startswith("rgb") else "gray" if channels == 1 else "bgr"
    return (values[:, :, 0] if channels == 1 else values), order


def _rows(message: ImageMessage, kind: str, channels: int, encoding: str) -> Pixels:
    """Return the values of an image, shape (height, width, channels), without the padding at the end of its rows."""
    dtype = np.dtype(kind).newbyteorder(">" if message.is_bigendian else "<")
    height, width = int(message.height), int(message.width)
    row, step = width * channels * dtype.itemsize, int(message.step) or width * channels * dtype.itemsize
    data = np.asarray(message.data).view(np.uint8).ravel()
    if step < row or data.size < step * (height - 1) + row or not height or not width:
        raise ArgumentValueError(f"an image of {width} × {height} {encoding} has {counted(data.size, 'byte')}")
    rows = np.lib.stride_tricks.as_strided(data, (height, row), (step, 1))
    values = np.ascontiguousarray(rows).view(dtype).astype(dtype.newbyteorder("="), copy=False)
    return values.reshape(height, width, channels)


def _layout(encoding: str) -> tuple[str, int]:
    """Return the NumPy type of an encoding's values, and the number of its channels."""
    layout = _ENCODINGS.get(encoding)
    if layout is not None:
        return layout
    if encoding.removeprefix("bayer_") in {f"{p}{bits}" for p in ("rggb", "bggr", "gbrg", "grbg") for bits in (8, 16)}:
        return ("u2" if encoding.endswith("16") else "u1"), 1
    size, _, channels = encoding.partition("C")
    if size in _SIZES and (channels in ("", "1", "2", "3", "4")):
        return _SIZES[size], int(channels or 1)
    raise ArgumentValueError(f"unknown encoding {encoding!r:.80} of an image; for example rgb8, mono8, 16UC1 or 32FC1")


def decode_compressed(message: CompressedImage) -> Pixels:
    """Decode a compressed image, with the blue channel first.

    Raises:
        ArgumentValueError: the data are not an image that can be decoded.
    """
    import cv2

    data, is_depth = bytes(message.data), "compressedDepth" in str(message.format)
    content = np.frombuffer(data[_DEPTH_HEAD if is_depth else 0 :], np.uint8)
    try:
        decoded = cv2.imdecode(content, cv2.IMREAD_UNCHANGED)
    except cv2.error:  # no bytes, or a size beyond OpenCV's limits
        decoded = None
    if decoded is None:
        raise ArgumentValueError(f"a compressed image of the format {str(message.format)!r:.80} cannot be decoded")
    values = np.asarray(decoded)
    if not is_depth or "32FC1" not in str(message.format):
        return values
    scale, offset = np.frombuffer(data[4:_DEPTH_HEAD], "<f4")
    with np.errstate(divide="ignore", invalid="ignore"):
        depths = scale / (values.astype(np.float32) - offset)
    return np.where(values > 0, depths, np.float32(np.nan))  # an inverse depth of 0 is an unknown depth


def image_message(pixels: Pixels, encoding: str, header: Message = None) -> ImageMessage:
    """Return a `sensor_msgs/msg/Image` with a copy of pixels.

    Args:
        pixels: array, shape (height, width) or (height, width, channels), in the channel order of the encoding.
        encoding: ROS encoding, such as `rgb8`, `mono8`, `16UC1` or `32FC1`.
        header: time and frame, from `msgs.header`; None for time 0 and no frame.

    Raises:
        ArgumentValueError: the encoding is unknown, or the array does not fit it.
    """
    kind, channels = _layout(str(encoding))
    values = np.asarray(pixels)
    shape = values.shape + (1,) * (values.ndim == 2)
    if values.dtype != np.dtype(kind) or len(shape) != 3 or shape[2] != channels or not values.size:
        expected = f"{np.dtype(kind)} of shape (height, width{f', {channels}' if channels > 1 else ''})"
        raise ArgumentValueError(f"pixels of {encoding} must be {expected}, got {values.dtype} of shape {values.shape}")
    content = np.ascontiguousarray(values, np.dtype(kind).newbyteorder("<")).reshape(-1).view(np.uint8).copy()
    height, width = shape[:2]
    fields = {"height": height, "width": width, "encoding": encoding, "step": content.size // height, "data": content}
    head = {} if header is None else {"header": header}
    message: ImageMessage = builder_of("sensor_msgs/msg/Image").build(fields | head)
    return message
