"""Background of an image, which is a colour or a sky, and fog."""

from __future__ import annotations

import itertools
import math
from typing import Final

import mujoco

from simkit.scene import Surroundings
from simkit.scene.world import Fog

_ZENITH: Final = (0.26, 0.47, 0.80)
_HORIZON: Final = (0.78, 0.87, 0.95)
_BELOW: Final = (0.55, 0.58, 0.60)
SKY_SIDES: Final = 24  # number of sides of the sky
SKY_ELEVATIONS: Final = (-90.0, -12.0, -2.0, 0.0, 4.0, 10.0, 20.0, 35.0, 60.0, 90.0)
"""Elevations [degrees] of the rings of the sky."""


class Background:
    """Painter of the empty pixels, because the engine clears them to black and supports only textures as a sky.

    The background is a display list, because painting empty pixels on the processor takes as long as the whole image.
    """

    def __init__(self, surroundings: Surroundings) -> None:
        self._background, self._is_sky = surroundings.background[:3], surroundings.sky
        self._list = 0

    @property
    def is_plain(self) -> bool:
        """True if the background has one colour."""
        return not self._is_sky

    def draw(self) -> None:
        """Draw the background after `mjr_render`, with the view of that call."""
        from OpenGL import GL

        if not self._list:
            self._list = _sky() if self._is_sky else _plain(self._background)
        GL.glCallList(self._list)

    def free(self) -> None:
        """Free the display list; a current context is needed."""
        from OpenGL import GL

        number, self._list = self._list, 0
        if number:
            GL.glDeleteLists(number, 1)


def enable_fog(fog: Fog, scene: mujoco.MjvScene, context: mujoco.MjrContext) -> None:
    """Make the next `mjr_render` draw fog."""
    from OpenGL import GL

    scene.flags[mujoco.mjtRndFlag.mjRND_FOG] = 1
    context.fogRGBA[:] = fog.colour  # the engine restores this colour after drawing shadows
    GL.glFogi(GL.GL_FOG_MODE, {"linear": GL.GL_LINEAR, "exp": GL.GL_EXP, "exp2": GL.GL_EXP2}[fog.type])
    GL.glFogfv(GL.GL_FOG_COLOR, fog.colour)
    GL.glFogf(GL.GL_FOG_START, fog.start)
    GL.glFogf(GL.GL_FOG_END, max(fog.end, fog.start + 1e-3))
    GL.glFogf(GL.GL_FOG_DENSITY, fog.density)


def _begin() -> int:
    """Begin a display list that changes only colours, and only of pixels that were not drawn to."""
    from OpenGL import GL

    number = int(GL.glGenLists(1))
    GL.glNewList(number, GL.GL_COMPILE)
    for switch in (GL.GL_LIGHTING, GL.GL_TEXTURE_2D, GL.GL_CULL_FACE, GL.GL_BLEND, GL.GL_FOG):
        GL.glDisable(switch)
    GL.glEnable(GL.GL_DEPTH_TEST)
    GL.glDepthFunc(GL.GL_GEQUAL)
    GL.glDepthMask(GL.GL_FALSE)
    return number


def _end() -> None:
    from OpenGL import GL

    # state that later shapes need; saving and restoring all state breaks colours in Mesa
    for switch in (GL.GL_LIGHTING, GL.GL_CULL_FACE):
        GL.glEnable(switch)
    GL.glDisable(GL.GL_DEPTH_CLAMP)
    GL.glDepthMask(GL.GL_TRUE)
    GL.glEndList()


def _plain(colour: tuple[float, float, float]) -> int:
    """Return a display list with one triangle over the whole image, at the far end of the depths."""
    from OpenGL import GL

    number = _begin()
    for matrix in (GL.GL_PROJECTION, GL.GL_MODELVIEW):
        GL.glMatrixMode(matrix)
        GL.glPushMatrix()
        GL.glLoadIdentity()
    GL.glColor3f(*colour)
    GL.glBegin(GL.GL_TRIANGLES)
    for x, y in ((-1.0, -1.0), (3.0, -1.0), (-1.0, 3.0)):
        GL.glVertex3f(x, y, 0.0)
    GL.glEnd()
    for matrix in (GL.GL_PROJECTION, GL.GL_MODELVIEW):
        GL.glMatrixMode(matrix)
        GL.glPopMatrix()
    _end()
    return number


def _sky() -> int:
    """Return a display list with coloured rings from below to the zenith, at infinity (w = 0 gives the far depth)."""
    from OpenGL import GL

    number = _begin()
    GL.glEnable(GL.GL_DEPTH_CLAMP)
    for low, high in itertools.pairwise(SKY_ELEVATIONS):
        GL.glBegin(GL.GL_TRIANGLE_STRIP)
        for side in range(SKY_SIDES + 1):
            turn = 2.0 * math.pi * (side % SKY_SIDES) / SKY_SIDES
            for rise in (low, high):
                angle = math.radians(rise)
                flat = math.cos(angle)
                GL.glColor3f(*sky_colour(rise))
                GL.glVertex4f(flat * math.cos(turn), flat * math.sin(turn), math.sin(angle), 0.0)
        GL.glEnd()
    _end()
    return number


def sky_colour(rise: float) -> tuple[float, float, float]:
    """Return the sky's colour at an elevation [degrees]: paler towards the horizon, haze below."""
    if rise < 0.0:
        share, ends = min(1.0, -rise / 12.0), (_HORIZON, _BELOW)
    else:
        share, ends = math.sqrt(math.sin(math.radians(rise))), (_HORIZON, _ZENITH)
    red, green, blue = ((1.0 - share) * a + share * b for a, b in zip(*ends, strict=True))
    return red, green, blue
