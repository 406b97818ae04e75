"""Images as arrays."""

from __future__ import annotations

from simkit_nodes.message_arrays import (
    image_to_numpy,
    numpy_to_image,
)

__all__ = [
    "image_to_numpy",
    "numpy_to_image",
]
