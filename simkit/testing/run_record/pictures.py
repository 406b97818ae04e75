"""Pictures made small, hashed by tiles, and compared by structure."""

from __future__ import annotations

import zlib
from typing import Any, Final

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]
TILE: Final = 32
"""Length of a tile's side [px]."""


def tile_hashes(image: Array, tile: int = TILE) -> npt.NDArray[np.uint32]:
    """A hash of each tile of a picture, shape (rows, columns); the last ones may be smaller.

    Args:
        image: shape (height, width) or (height, width, channels), of any type.
        tile: length of a tile's side [px].
    """

    rows, columns = -(-image.shape[0] // tile), -(-image.shape[1] // tile)
    found = np.empty((rows, columns), np.uint32)
    for row in range(rows):
        for column in range(columns):
            part = image[row * tile : (row + 1) * tile, column * tile : (column + 1) * tile]
            found[row, column] = zlib.crc32(np.ascontiguousarray(part).tobytes())
    return found


def shrink(image: Array, longest: int) -> Array:
    """A small picture: the mean of the pixels under each of its own, of its type.

    Of depths the mean is of those that are finite; where there are none, the first of them (infinite or not a number).

    Args:
        image: shape (height, width) or (height, width, channels), uint8, uint16 or float32.
        longest: of its sides [px]; a picture that is smaller stays.
    """
    height, width = image.shape[:2]
    factor = longest / max(height, width, 1)
    if factor >= 1.0:
        return image
    rows = np.arange(max(1, round(height * factor))) * height // max(1, round(height * factor))
    columns = np.arange(max(1, round(width * factor))) * width // max(1, round(width * factor))
    if np.issubdtype(image.dtype, np.integer):
        total = _block_sum(image.astype(np.int64), rows, columns)
        count = np.outer(np.diff([*rows, height]), np.diff([*columns, width]))
        count = count.reshape(count.shape + (1,) * (image.ndim - 2))
        return np.asarray(((2 * total + count) // (2 * count)).astype(image.dtype))
    finite = np.isfinite(image)
    total = _block_sum(np.where(finite, image, 0).astype(np.float64), rows, columns)
    hits = _block_sum(finite.astype(np.int64), rows, columns)
    first = image[np.ix_(rows, columns)]
    return np.asarray(np.where(hits > 0, total / np.maximum(hits, 1), first).astype(image.dtype))


def _block_sum(values: Array, rows: Array, columns: Array) -> Array:
    """The sum over blocks that begin at these rows and columns."""
    return np.asarray(np.add.reduceat(np.add.reduceat(values, rows, axis=0), columns, axis=1))


def structural_similarity(golden: Array, run: Array, peak: float = 255.0) -> float:
    """Structural similarity of two pictures of one size, up to 1 for equal ones.

    Args:
        golden, run: shape (height, width) or (height, width, channels).
        peak: greatest value.

    Source: Wang, Bovik, Sheikh, Simoncelli, "Image quality assessment: from error visibility to structural
    similarity", IEEE Trans. Image Processing 13(4), 2004: Gaussian window of 11 px, 1.5 px; K = 0.01, 0.03.
    """
    import cv2

    a, b = golden.astype(np.float64), run.astype(np.float64)

    def blur(image: Array) -> Array:
        return np.asarray(cv2.GaussianBlur(image, (11, 11), 1.5, borderType=cv2.BORDER_REFLECT_101))

    mean_a, mean_b = blur(a), blur(b)
    variance_a, variance_b = blur(a * a) - mean_a**2, blur(b * b) - mean_b**2
    covariance = blur(a * b) - mean_a * mean_b
    c1, c2 = (0.01 * peak) ** 2, (0.03 * peak) ** 2
    found = ((2 * mean_a * mean_b + c1) * (2 * covariance + c2)) / (
        (mean_a**2 + mean_b**2 + c1) * (variance_a + variance_b + c2)
    )
    return float(found.mean())
