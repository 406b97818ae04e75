"""Reading of colours and depths from the frame buffer."""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Callable

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.sensors.cameras.rendering.view import Colours, Depths

_ROWS = 32  # rows at once: they fit into a processor's cache, and OpenCV uses one thread for so few


def read(
    colours: Colours,
    depths: Depths | None,
    rectangle: mujoco.MjrRect,
    context: mujoco.MjrContext,
    background: Colours | None = None,
) -> None:
    """Read the drawn image from the offscreen buffer, bottom row first; the OpenGL context must be current.

    Without multisampling, colours are read in their stored format of four bytes per pixel. Removing the fourth byte
    afterwards takes a fifth of the time that the graphics library needs for it. The fourth byte marks the drawn pixels.

    Args:
        colours: output array, shape (h, w, 3).
        depths: output array, shape (h, w); None reads no depths.
        rectangle: rectangle of the image.
        context: MuJoCo's rendering context.
        background: colour for pixels without a shape, shape (3,); None does not change them. Multisampling ignores
            this argument.
    """
    if context.offSamples:
        mujoco.mjr_readPixels(colours, depths, rectangle, context)
        return
    import cv2
    from OpenGL import GL

    if depths is not None:
        mujoco.mjr_readPixels(None, depths, rectangle, context)
    width, height = int(rectangle.width), int(rectangle.height)
    four = _rgba_buffer(height, width)
    GL.glBindFramebuffer(GL.GL_READ_FRAMEBUFFER, context.offFBO)
    GL.glReadBuffer(GL.GL_COLOR_ATTACHMENT0)
    _read_pixels()(0, 0, width, height, GL.GL_RGBA, GL.GL_UNSIGNED_BYTE, ctypes.c_void_p(four.ctypes.data))
    plain = None if background is None else _plain_row(width, tuple(background.tolist()))
    for first in range(0, height, _ROWS):
        rows = slice(first, min(first + _ROWS, height))
        part = colours[rows]
        cv2.cvtColor(four[rows], cv2.COLOR_RGBA2RGB, part)
        if plain is None:
            continue
        drawn = cv2.extractChannel(four[rows], 3)
        if not np.minimum.reduce(drawn, axis=None):
            cv2.copyTo(plain[: len(part)], cv2.compare(drawn, 0, cv2.CMP_EQ), part)


@functools.lru_cache(maxsize=4)
def _rgba_buffer(height: int, width: int) -> npt.NDArray[np.uint8]:
    """Return a buffer for an image in its stored format; one is enough, because only one thread has the context."""
    return np.empty((height, width, 4), np.uint8)


@functools.lru_cache(maxsize=8)
def _plain_row(width: int, colour: tuple[int, int, int]) -> Colours:
    return np.tile(np.array(colour, np.uint8), (_ROWS, width, 1))


@functools.cache
def _read_pixels() -> Callable[..., None]:
    """Return glReadPixels without PyOpenGL's wrapper, whose check of the array takes as long as the read itself."""
    from OpenGL.raw.GL.VERSION import GL_1_0

    read: Callable[..., None] = GL_1_0.glReadPixels
    return read
