"""Conversion between messages with images and arrays."""

from __future__ import annotations

from array import array
from typing import Any

import cv2
import numpy as np

from simkit_nodes.image_encodings import DEPTHS, EncodingError, Image, converted, encoding_of
from simkit_nodes.interfaces import ProgramMessage
from simkit_nodes.program_messages import new_message

__all__ = ["CvBridge", "CvBridgeError"]


class CvBridgeError(TypeError):
    """An image cannot be converted."""


class CvBridge:
    """Converter of images.

    Attributes:
        cvtype_to_name: name such as `8UC3` by OpenCV's type.
        cvdepth_to_numpy_depth: name of NumPy's type by OpenCV's type of a number.
        numpy_type_to_cvtype: OpenCV's name by NumPy's, and back.
    """

    def __init__(self) -> None:
        names = [f"{depth}C{channels}" for depth in DEPTHS for channels in (1, 2, 3, 4)]
        self.cvtype_to_name: dict[int, str] = {getattr(cv2, f"CV_{name}"): name for name in names}
        self.cvdepth_to_numpy_depth: dict[int, str] = {getattr(cv2, f"CV_{d}"): dtype for d, dtype in DEPTHS.items()}
        self.numpy_type_to_cvtype: dict[str, str] = {dtype: d for d, dtype in DEPTHS.items()} | DEPTHS

    def dtype_with_channels_to_cvtype2(self, dtype: Any, n_channels: int) -> str:
        """Return OpenCV's name, such as `8UC3`, of NumPy's type and a number of channels."""
        return f"{self.numpy_type_to_cvtype[dtype.name]}C{n_channels}"

    def cvtype2_to_dtype_with_channels(self, cvtype: int) -> tuple[str, int]:
        """Return the name of NumPy's type, and the number of channels, of OpenCV's type."""
        depth, _, channels = self.cvtype_to_name[cvtype].partition("C")
        return DEPTHS[depth], int(channels)

    def encoding_to_cvtype2(self, encoding: str) -> int:
        """Return OpenCV's type of an encoding.

        Raises:
            CvBridgeError: the encoding is unknown.
        """
        try:
            return int(getattr(cv2, f"CV_{encoding_of(encoding).cv_type}"))
        except EncodingError as error:
            raise CvBridgeError(error) from None

    def encoding_to_dtype_with_channels(self, encoding: str) -> tuple[str, int]:
        """Return the name of NumPy's type, and the number of channels, of an encoding.

        Raises:
            CvBridgeError: the encoding is unknown.
        """
        try:
            known = encoding_of(encoding)
        except EncodingError as error:
            raise CvBridgeError(error) from None
        return known.dtype.name, known.channels

    # ------------------------------------------------------------------ messages to arrays

    def imgmsg_to_cv2(self, img_msg: Any, desired_encoding: str = "passthrough") -> Image:
        """Return the image of a `sensor_msgs.msg.Image`.

        Args:
            img_msg: message.
            desired_encoding: encoding of the result. With `passthrough`, it is that of the message, and the result
                shares the memory of the message, as in ROS.

        Raises:
            CvBridgeError: the encoding is unknown, or there is no conversion.
        """
        name, channels = self.encoding_to_dtype_with_channels(img_msg.encoding)
        dtype = np.dtype(name).newbyteorder(">" if img_msg.is_bigendian else "<")
        height, width, data = img_msg.height, img_msg.width, img_msg.data
        if isinstance(data, list):
            data = np.asarray(data, dtype)
        columns = img_msg.step // dtype.itemsize // channels
        shape = (height, columns) if channels == 1 else (height, columns, channels)
        image: Image = np.ascontiguousarray(np.ndarray(shape, dtype, buffer=data)[:, :width])
        if not dtype.isnative:
            image = image.astype(dtype.newbyteorder("="))
        if desired_encoding == "passthrough":
            return image
        return _converted(image, img_msg.encoding, desired_encoding)

    def compressed_imgmsg_to_cv2(self, cmprs_img_msg: Any, desired_encoding: str = "passthrough") -> Image:
        """Return the image of a `sensor_msgs.msg.CompressedImage`.

        Args:
            cmprs_img_msg: message with a JPEG or PNG image, or another one that OpenCV reads.
            desired_encoding: encoding of the result; `passthrough` for `bgr8`, or what the file has.

        Raises:
            CvBridgeError: there is no conversion.
        """
        image: Any = cv2.imdecode(np.frombuffer(cmprs_img_msg.data, np.uint8), cv2.IMREAD_UNCHANGED)
        return image if desired_encoding == "passthrough" else _converted(image, "bgr8", desired_encoding)

    # ------------------------------------------------------------------ arrays to messages

    def cv2_to_imgmsg(self, cvim: Any, encoding: str = "passthrough", header: ProgramMessage = None) -> Any:
        """Return a `sensor_msgs.msg.Image` with an image.

        Args:
            cvim: image.
            encoding: encoding of the image; with `passthrough`, OpenCV's name such as `8UC3`.
            header: header of the message.

        Raises:
            TypeError: the image is no array.
            CvBridgeError: the encoding is unknown, or the array has another type.
        """
        if not isinstance(cvim, (np.ndarray, np.generic)):
            raise TypeError("Your input type is not a numpy array")
        message = new_message("sensor_msgs/msg/Image")
        shape: tuple[int, ...] = cvim.shape
        message.height, message.width = shape[:2]
        if header is not None:
            message.header = header
        cv_type = self.dtype_with_channels_to_cvtype2(cvim.dtype, 1 if len(shape) < 3 else shape[2])
        message.encoding = cv_type if encoding == "passthrough" else encoding
        if encoding != "passthrough" and self.cvtype_to_name[self.encoding_to_cvtype2(encoding)] != cv_type:
            raise CvBridgeError(f"encoding specified as {encoding}, but image has incompatible type {cv_type}")
        if cvim.dtype.byteorder == ">":
            message.is_bigendian = True
        message.data = _octets(np.ascontiguousarray(cvim), message.data)
        message.step = len(message.data) // message.height
        return message

    def cv2_to_compressed_imgmsg(self, cvim: Any, dst_format: str = "jpg") -> Any:
        """Return a `sensor_msgs.msg.CompressedImage` with an image.

        Args:
            cvim: image.
            dst_format: extension of the file format, such as `jpg` or `png`.

        Raises:
            TypeError: the image is no array.
        """
        if not isinstance(cvim, (np.ndarray, np.generic)):
            raise TypeError("Your input type is not a numpy array")
        message = new_message("sensor_msgs/msg/CompressedImage")
        message.format = dst_format
        message.data = _octets(cv2.imencode(f".{dst_format}", cvim)[1], message.data)
        return message


def _converted(image: Image, source: str, target: str) -> Image:
    try:
        return converted(image, source, target)
    except EncodingError as error:
        raise CvBridgeError(error) from None


def _octets(values: Image, like: Any) -> Any:
    """Return a copy of the bytes of an array, in the type that the field of a message has."""
    if isinstance(like, bytes):
        return values.tobytes()
    octets = array("B")
    octets.frombytes(values.reshape(-1).view(np.uint8).data)
    return octets
