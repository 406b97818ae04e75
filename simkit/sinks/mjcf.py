"""The compiled world as MJCF, for MuJoCo alone."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from simkit.errors import InputError

if TYPE_CHECKING:
    from simkit.runtime import Simulation


def write_mjcf(sim: Simulation, path: Path) -> int:
    """Writes `path`, and its textures into a folder beside it; meshes are inside the file.

    Returns:
        How many texture files were written.

    Raises:
        InputError: SK-CLI-016 it cannot be written.
    """
    import cv2

    # A copy: naming files in the spec of a running simulation would change what a later spawn compiles.
    spec = sim.compiled.builder.spec.copy()
    folder = path.with_name(path.stem + "_assets")
    written = 0
    try:
        for texture in spec.textures:
            if texture.file or not len(texture.data):
                continue
            pixels = np.frombuffer(bytes(texture.data), np.uint8).reshape(
                texture.height, texture.width, texture.nchannel
            )
            if texture.height == 6 * texture.width:
                pixels = pixels[: texture.width]  # the six sides of a cube are the same picture
            folder.mkdir(exist_ok=True)
            file = folder / f"texture_{written}.png"
            if not cv2.imwrite(str(file), pixels[:, :, ::-1]):
                raise OSError(f"cannot write {file}")
            texture.file, texture.data = f"{folder.name}/{file.name}", b""
            texture.width = texture.height = texture.nchannel = 0
            written += 1
        spec.modelfiledir = str(path.absolute().parent)
        spec.compile()
        path.write_text(spec.to_xml(), encoding="utf-8")
    except OSError as error:
        raise InputError(f"SK-CLI-016 cannot write {path}: {error.strerror or error}", "SK-CLI-016") from None
    return written
