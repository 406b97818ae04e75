"""Fields of messages that plugins and sensors of this pack fill with vectors."""

from __future__ import annotations

import numpy as np

from simkit.extend import Vector


def xyz(vector: Vector) -> dict[str, float]:
    """Return the fields of a `Vector3` or `Point`."""
    return dict(zip("xyz", vector.tolist(), strict=True))


def diagonal(size: int, *values: float) -> Vector:
    """Return a covariance matrix as a list of numbers, with the values on its diagonal."""
    matrix: Vector = np.diag(np.array(values, float)).reshape(size)
    return matrix
