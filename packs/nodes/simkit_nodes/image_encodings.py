"""Encodings of `sensor_msgs/msg/Image`, and conversions between them by the rules of `cv_bridge`."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from typing import Any, Final

import cv2
import numpy as np
import numpy.typing as npt

Image = npt.NDArray[Any]

DEPTHS: Final = {
    "8U": "uint8",
    "8S": "int8",
    "16U": "uint16",
    "16S": "int16",
    "32S": "int32",
    "32F": "float32",
    "64F": "float64",
}
"""NumPy's type by OpenCV's name."""

_COLORS: Final = {
    "mono": ("GRAY", 1),
    "rgb": ("RGB", 3),
    "bgr": ("BGR", 3),
    "rgba": ("RGBA", 4),
    "bgra": ("BGRA", 4),
}
"""OpenCV's name of the colours and the number of channels, by the name of an encoding without its bits."""

_PACKED: Final = {
    "yuv422": "YUV2{}_UYVY",
    "uyvy": "YUV2{}_UYVY",
    "yuv422_yuy2": "YUV2{}_YUY2",
    "yuyv": "YUV2{}_YUY2",
    "bayer_rggb": "BayerBG2{}",  # OpenCV names the second row from its second column on
    "bayer_bggr": "BayerRG2{}",
    "bayer_gbrg": "BayerGR2{}",
    "bayer_grbg": "BayerGB2{}",
}
"""OpenCV's conversion by the name of an encoding without its bits; the name of the colours goes between the braces."""

_GENERIC: Final = re.compile(r"(8U|8S|16U|16S|32S|32F|64F)(?:C([0-9]+))?")


class EncodingError(RuntimeError):
    """An encoding is unknown, or has no conversion to another one."""


@dataclass(frozen=True)
class Encoding:
    """Encoding of an image.

    Attributes:
        name: name in ROS.
        depth: type of the numbers, as OpenCV names it, such as `8U`.
        channels: numbers in a pixel.
        kind: name without its bits, such as `rgb`; empty for an encoding without colours, such as `32FC1`.
    """

    name: str
    depth: str
    channels: int
    kind: str

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of the numbers."""
        return np.dtype(DEPTHS[self.depth])

    @property
    def cv_type(self) -> str:
        """OpenCV's name of the type of the image, such as `8UC3`."""
        return f"{self.depth}C{self.channels}"


@cache
def encoding_of(name: str) -> Encoding:
    """Return the encoding with a name in ROS.

    Raises:
        EncodingError: there is none.
    """
    generic = _GENERIC.fullmatch(name)
    if generic is not None:
        return Encoding(name, generic[1], int(generic[2] or 1), "")
    kind = name.removesuffix("16").removesuffix("8")
    depth = "16U" if name.endswith("16") else "8U"
    if kind in _COLORS and kind != name:
        return Encoding(name, depth, _COLORS[kind][1], kind)
    if kind in _PACKED and (kind != name) is kind.startswith("bayer"):
        return Encoding(name, depth, 1 if kind.startswith("bayer") else 2, kind)
    raise EncodingError(f"Unrecognized image encoding [{name}]")


def converted(image: Image, source: str, target: str) -> Image:
    """Return a copy of an image in another encoding.

    Args:
        image: array (height, width) or (height, width, channels).
        source: encoding of the image.
        target: encoding of the result; empty for the same one.

    Raises:
        EncodingError: there is no conversion.
    """
    if target in ("", source):
        return image.copy()
    before, after = encoding_of(source), encoding_of(target)
    code = _color_code(before, after)
    if code is not None:
        image = cv2.cvtColor(image, code)
        if before.depth == after.depth:
            return image
    return _with_depth(image, after.dtype)


def _color_code(before: Encoding, after: Encoding) -> int | None:
    """Return OpenCV's conversion between the colours of two encodings; None for the same colours."""
    if not before.kind and after.kind:
        raise EncodingError(
            f"[{before.name}] is not a color format. but [{after.name}] is. The conversion does not make sense"
        )
    if not after.kind:
        if before.channels == after.channels:
            return None
        if before.kind:
            raise EncodingError(
                f"[{before.name}] is a color format but [{after.name}] is not so they must have the same OpenCV type, "
                "CV_8UC3, CV16UC1 ...."
            )
        raise EncodingError(f"[{before.name}] and [{after.name}] do not have the same number of channel")
    if before.kind == after.kind and before.kind in _COLORS:
        return None
    color = _COLORS.get(after.kind, ("", 0))[0]
    name = f"{_COLORS[before.kind][0]}2{color}" if before.kind in _COLORS else _PACKED[before.kind].format(color)
    code = getattr(cv2, f"COLOR_{name}", None) if color else None
    if code is None or (before.kind.startswith("bayer") and after.channels == 4):
        raise EncodingError(f"Unsupported conversion from [{before.name}] to [{after.name}]")
    return int(code)


def _with_depth(image: Image, dtype: np.dtype[Any]) -> Image:
    """Return an image with numbers of another type: unsigned integers of 8 and 16 bits are scaled, others rounded."""
    if image.dtype == dtype:
        return image.copy()
    if image.dtype == np.uint8 and dtype == np.uint16:
        return image.astype(np.uint16) * np.uint16(257)
    if image.dtype == np.uint16 and dtype == np.uint8:
        return ((image.astype(np.uint32) + 128) // 257).astype(np.uint8)
    if dtype.kind == "f":
        return image.astype(dtype)
    limits = np.iinfo(dtype)
    values = np.nan_to_num(np.rint(image), nan=limits.min) if image.dtype.kind == "f" else image.astype(np.int64)
    return values.clip(limits.min, limits.max).astype(dtype)
