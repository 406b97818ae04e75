"""Heights from the grey values of an image."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from simkit.compiler.meshes.part import Floats, MeshFileError
from simkit.scene import Heightmap

LARGEST: Final = 4097
_LARGEST_FILE: Final = 256 << 20
_FORMATS: Final = ("PNG", "JPEG", "TIFF", "BMP", "TGA", "GIF", "PPM", "WEBP")


def heights(shape: Heightmap) -> Floats:
    """Rows from -y to +y, scaled so that the highest value is 1, as Gazebo does.

    8-bit and 16-bit images, and TIFF with floating point numbers; colours count by their brightness.

    Raises:
        MeshFileError: the file is no such image, or too large; its size is known before anything is unpacked.
    """
    import warnings

    from PIL import Image

    try:
        if shape.file.stat().st_size > _LARGEST_FILE:
            raise MeshFileError(f"is larger than {_LARGEST_FILE >> 20} MiB")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            with Image.open(shape.file, formats=_FORMATS) as image:
                if image.width > LARGEST or image.height > LARGEST:
                    raise MeshFileError(f"is {image.width}×{image.height}; at most {LARGEST}×{LARGEST} is taken")
                grey = _grey(image)
    except MeshFileError:
        raise
    except OSError as problem:
        text = problem.strerror or "it is no PNG, JPEG or TIFF image"
        raise MeshFileError(f"cannot be read: {text}") from None
    except Exception as problem:  # noqa: BLE001 -- a decoder of broken data raises whatever it likes
        raise MeshFileError(f"cannot be read: {' '.join(str(problem).split())[:200]}") from None
    if grey.ndim != 2 or min(grey.shape) < 2:
        raise MeshFileError("is smaller than 2×2")
    if not np.isfinite(grey).all():
        raise MeshFileError("has heights that are not finite")
    most = float(np.abs(grey).max()) if float(grey.max()) <= 0.0 else float(grey.max())
    return np.ascontiguousarray(grey[::-1]) / (most if most > 0.0 else 1.0)


def _grey(image: Any) -> Floats:
    if image.mode in ("L", "F") or image.mode.startswith("I"):
        return np.asarray(image, float)
    return np.asarray(image.convert("L"), float)
