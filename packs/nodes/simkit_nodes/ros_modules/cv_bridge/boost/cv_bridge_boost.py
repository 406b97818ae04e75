"""Types and conversions of images."""

from __future__ import annotations

from typing import Any

import cv2

from simkit_nodes.image_encodings import converted, encoding_of

__all__ = ["cvtColor2", "getCvType"]


def getCvType(encoding: str) -> int:
    """Return OpenCV's type of an encoding.

    Raises:
        RuntimeError: the encoding is unknown.
    """
    return int(getattr(cv2, f"CV_{encoding_of(encoding).cv_type}"))


def cvtColor2(source: Any, encoding_in: str, encoding_out: str) -> Any:
    """Return a copy of an image in another encoding.

    Raises:
        RuntimeError: there is no conversion.
    """
    return converted(source, encoding_in, encoding_out)
