"""Read colours and depths from the frame buffer, and convert its depths to metres."""

from __future__ import annotations

import ctypes
import functools
import math
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.sensors.cameras.rendering.view import Colours, Depths

_ROWS = 32  # at once: they fit into a processor's cache, and OpenCV wakes no threads for so few


def read(
    colours: Colours,
    depths: Depths | None,
    rectangle: mujoco.MjrRect,
    context: mujoco.MjrContext,
    background: Colours | None = None,
) -> None:
    """Reads the picture, bottom row first; the context is current, and its offscreen buffer is the one drawn to.

    Where nothing is to be resolved, colours are read as they are kept, in four bytes a pixel: to leave the fourth out
    afterwards takes a fifth of the time that the graphics library takes for it. The fourth tells what was drawn to.

    Args:
        colours: to be written to, shape (h, w, 3).
        depths: to be written to, shape (h, w); None where they are not wanted.
        rectangle: the picture's.
        context: the engine's.
        background: colour of what was not drawn to, shape (3,); without it that is as it is. Not with multisampling.
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
    """Room for a picture as the library keeps it; whoever reads has the context, so one is enough."""
    return np.empty((height, width, 4), np.uint8)


@functools.lru_cache(maxsize=8)
def _plain_row(width: int, colour: tuple[int, int, int]) -> Colours:
    return np.tile(np.array(colour, np.uint8), (_ROWS, width, 1))


@functools.cache
def _read_pixels() -> Any:
    """The library's own function: PyOpenGL's looks closely at the array, which takes as long as reading."""
    from OpenGL.raw.GL.VERSION import GL_1_0

    return GL_1_0.glReadPixels


_DEPTH_ROWS = 32  # at once: so many fit into a processor's cache, and what is done to them costs no more memory traffic
_NEARER = 0.1  # of the near plane: where it is drawn from; Gazebo takes 0.9, and what houses a lens is not to blind it
_STEP = 2.0**-24  # of raw depths: half of the last bit of a number just above 1
_ROUNDING = 2.0**-21  # of a depth, in 32 bits


def clip_planes(near: float, far: float) -> tuple[float, float]:
    """Clip planes to be drawn with, so that what is nearer than `near` is seen and depths are exact.

    The near plane is a power of two and the far plane has few digits, so that their sum and difference have no rounding
    error and every graphics library gets the same quotient. The far plane is moved away by what the quotient may lose
    (0.6 % for 0.1 and 100 m).

    Args:
        near, far: what is to be seen [m].
    """
    drawn = 2.0 ** math.floor(math.log2(near * _NEARER))
    reciprocal = 1.0 / far - _STEP / drawn
    if reciprocal <= _STEP / drawn:
        return drawn, drawn * 2.0**30  # what is a far plane here is nowhere for 32 bits
    mantissa, exponent = math.frexp(1.0 / reciprocal)
    return drawn, math.ldexp(math.ceil(mantissa * 2.0**12), exponent - 12)


def depth_limits(highest: float, reach: float, stretch: Depths) -> Depths:
    """From which depth on [m] there is nothing, for each pixel; for `depths_in_metres` and `clip_depths`.

    Args:
        highest: the farthest depth along the optical axis that there is [m].
        reach: at this distance from the camera, and farther, there is nothing [m].
        stretch: distance over depth of each pixel, shape (h, w).
    """
    after = np.nextafter(np.float32(highest), np.float32(np.inf))
    limit: Depths = np.minimum(np.float32(reach * (1 - _ROUNDING)) / stretch, after)
    return limit


def depths_in_metres(
    raw: Depths,
    near: float,
    far: float,
    lowest: float = 0.0,
    limit: Depths | None = None,
    out: Depths | None = None,
    *,
    least: float = 0.0,
) -> Depths:
    """Distances along the optical axis [m] of raw depths.

    Args:
        raw: shape (h, w), of a picture; 0 is nothing.
        near, far: clip planes of the picture [m].
        lowest: what is nearer becomes -inf [m].
        limit: what is as far or farther becomes +inf [m], shape (h, w); None is all that there is.
        out: contiguous, shape (h, w), to be written to.
        least: the smallest of `limit`, where it is known.
    """
    import cv2

    if out is None:
        out = np.empty(raw.shape, np.float32)
    slope, offset = _depth_line(near, far)
    infinite = _constant_row(raw.shape[1], np.inf)
    with np.errstate(divide="ignore"):
        for first in range(0, len(raw), _DEPTH_ROWS):
            rows = slice(first, first + _DEPTH_ROWS)
            part = out[rows]
            np.add(raw[rows], offset, out=part)
            np.divide(slope, part, out=part)
            if limit is not None:
                _clip_rows(part, lowest, limit[rows], least)
            else:
                cv2.copyTo(infinite[: len(part)], cv2.compare(np.ascontiguousarray(raw[rows]), 0.0, cv2.CMP_EQ), part)
    return out


def clip_depths(depths: Depths, lowest: float, limit: Depths, *, least: float = 0.0) -> Depths:
    """+inf from `limit` on, whose smallest value is `least`, -inf nearer than `lowest` [m], in place; shapes (h, w)."""
    for first in range(0, len(depths), _DEPTH_ROWS):
        rows = slice(first, first + _DEPTH_ROWS)
        _clip_rows(depths[rows], lowest, limit[rows], least)
    return depths


def _clip_rows(part: Depths, lowest: float, limit: Depths, least: float) -> None:
    """The same for a few rows."""
    import cv2

    if np.maximum.reduce(part, axis=None) >= least:  # else the limit itself need not be fetched from memory
        cv2.copyTo(_constant_row(part.shape[1], np.inf)[: len(part)], cv2.compare(part, limit, cv2.CMP_GE), part)
    nearest = np.float32(lowest)
    if lowest > 0 and np.minimum.reduce(part, axis=None) < nearest:
        too_near = cv2.compare(part, float(nearest), cv2.CMP_LT)
        cv2.copyTo(_constant_row(part.shape[1], -np.inf)[: len(part)], too_near, part)


def _depth_line(near: float, far: float) -> tuple[np.float32, np.float32]:
    """z = slope/(raw + offset), as the graphics library has it.

    Its matrix is that of `glFrustum`, moved and scaled by ½ (mjr_render): raw = slope/z - offset with slope =
    near·far/(far - near) and offset = ½·((far + near)/(far - near) - 1), where the quotient has 32 bits.
    """
    near, far = float(np.float32(near)), float(np.float32(far))
    quotient = float(np.float32((far + near) / (far - near)))
    return np.float32(near * far / (far - near)), np.float32(0.5 * (quotient - 1.0))


@functools.lru_cache(maxsize=8)
def _constant_row(width: int, value: float) -> Depths:
    return np.full((_DEPTH_ROWS, width), value, dtype=np.float32)
