"""Drawing of transparent shapes after all other shapes, each once, in the order from the farthest to the nearest.

The engine itself draws the back and the front of a transparent shape. A shape with an opacity of 0.5 then hides three
quarters of the scene behind it. The engine also draws transparent shapes before the background, which is then missing
behind them.
"""

from __future__ import annotations

from collections.abc import Sequence
from types import ModuleType
from typing import Final

import mujoco
import numpy as np

from simkit.linear_algebra import norm
from simkit.pose import Vector

_SPHERE, _TOP, _BOTTOM, _CYLINDER, _TUBE, _BOX = 0, 1, 2, 3, 4, 6
"""Indices of the engine's built-in shapes in its display lists."""

_KINDS = mujoco.mjtGeom
_BUILTIN: Final = {
    int(_KINDS.mjGEOM_SPHERE): _SPHERE,
    int(_KINDS.mjGEOM_ELLIPSOID): _SPHERE,
    int(_KINDS.mjGEOM_CYLINDER): _CYLINDER,
    int(_KINDS.mjGEOM_BOX): _BOX,
}
DRAWN_HERE: Final = frozenset(
    {*_BUILTIN, *map(int, (_KINDS.mjGEOM_CAPSULE, _KINDS.mjGEOM_PLANE, _KINDS.mjGEOM_MESH, _KINDS.mjGEOM_HFIELD))}
)
"""Types of shapes that `draw_transparent` draws; the engine draws the other types."""


def draw_transparent(scene: mujoco.MjvScene, context: mujoco.MjrContext, indices: Sequence[int], eye: Vector) -> None:
    """Draw shapes of a list with the view, lights and fog of the last `mjr_render`.

    Args:
        scene: scene with the shapes.
        context: MuJoCo's rendering context.
        indices: indices of shapes in the list, of types in `DRAWN_HERE`.
        eye: position of the camera [m], shape (3,). Planes are drawn first, then shapes by decreasing distance.
    """
    from OpenGL import GL

    geoms = [scene.geoms[i] for i in indices]
    plane = _KINDS.mjGEOM_PLANE
    geoms.sort(key=lambda g: -1e9 if g.type == plane else -norm(np.asarray(g.pos) - eye))
    if scene.flags[mujoco.mjtRndFlag.mjRND_FOG]:
        GL.glEnable(GL.GL_FOG)
    for light in range(scene.nlight):
        GL.glEnable(GL.GL_LIGHT0 + light)
    GL.glDepthMask(GL.GL_FALSE)
    GL.glEnable(GL.GL_BLEND)
    GL.glBlendFunc(GL.GL_SRC_ALPHA, GL.GL_ONE_MINUS_SRC_ALPHA)
    for geom in geoms:
        _draw(GL, geom, context)
    GL.glDisable(GL.GL_BLEND)
    GL.glDepthMask(GL.GL_TRUE)
    for light in range(scene.nlight):
        GL.glDisable(GL.GL_LIGHT0 + light)


def _draw(gl: ModuleType, geom: mujoco.MjvGeom, context: mujoco.MjrContext) -> None:
    rgba, both = np.asarray(geom.rgba), gl.GL_FRONT_AND_BACK
    gl.glColor4fv(rgba)
    gl.glMaterialfv(both, gl.GL_EMISSION, (*(float(geom.emission) * rgba[:3]), 1.0))
    gl.glMaterialf(both, gl.GL_SHININESS, min(128.0, 128.0 * geom.shininess))
    gl.glMaterialfv(both, gl.GL_SPECULAR, (geom.specular, geom.specular, geom.specular, 1.0))
    pose = np.eye(4, dtype=np.float32)
    pose[:3, :3], pose[:3, 3] = np.asarray(geom.mat).reshape(3, 3), geom.pos
    enabled = _bind_texture(gl, geom, context)
    gl.glPushMatrix()
    gl.glMultMatrixf(np.ascontiguousarray(pose.T))
    _call(gl, geom, context)
    gl.glPopMatrix()
    for capability in enabled:
        gl.glDisable(capability)


def _call(gl: ModuleType, geom: mujoco.MjvGeom, context: mujoco.MjrContext) -> None:
    """Draw a shape at the current pose of the OpenGL matrix stack, with the display lists of the engine."""
    kind, size, builtin = int(geom.type), [float(s) for s in geom.size], int(context.baseBuiltin)
    if kind == _KINDS.mjGEOM_PLANE:
        if geom.dataid < 0:
            gl.glScalef(size[0], size[1], 1.0)
        gl.glCallList(context.basePlane + (geom.dataid + 1 if geom.dataid >= 0 else 0))
    elif kind == _KINDS.mjGEOM_MESH:
        gl.glCallList(context.baseMesh + geom.dataid)
    elif kind == _KINDS.mjGEOM_HFIELD:
        gl.glCallList(context.baseHField + geom.dataid)
    elif kind == _KINDS.mjGEOM_CAPSULE:
        radius = (size[0] + size[1]) / 2
        gl.glScalef(*size)
        gl.glCallList(builtin + _TUBE)
        gl.glScalef(1.0, 1.0, radius / size[2])
        gl.glTranslatef(0.0, 0.0, (size[2] - radius) / radius)
        gl.glCallList(builtin + _TOP)
        gl.glTranslatef(0.0, 0.0, 2.0 * (radius - size[2]) / radius)
        gl.glCallList(builtin + _BOTTOM)
    else:
        gl.glScalef(*size)
        gl.glCallList(builtin + _BUILTIN[kind])


def _bind_texture(gl: ModuleType, geom: mujoco.MjvGeom, context: mujoco.MjrContext) -> tuple[int, ...]:
    """Apply the texture of the shape's material, and return the OpenGL capabilities to disable afterwards."""
    role = int(mujoco.mjtTextureRole.mjTEXROLE_RGB)
    number = int(context.mat_texid.reshape(-1, int(mujoco.mjtTextureRole.mjNTEXROLE))[geom.matid, role])
    if geom.matid < 0 or number < 0 or context.textureType[number] != mujoco.mjtTexture.mjTEXTURE_2D:
        return ()
    gl.glActiveTexture(gl.GL_TEXTURE0)
    gl.glEnable(gl.GL_TEXTURE_2D)
    gl.glBindTexture(gl.GL_TEXTURE_2D, int(context.texture[number]))
    if geom.texcoord:
        return (gl.GL_TEXTURE_2D,)
    repeat = np.asarray(context.mat_texrepeat).reshape(-1, 2)[geom.matid].astype(float)
    size, is_scaled = np.asarray(geom.size[:2], float), geom.dataid >= 0
    if is_scaled:
        repeat = repeat / np.where(size > 0.0, size, 1.0)
    if context.mat_texuniform[geom.matid]:
        repeat = repeat * np.where(size > 0.0, size, 1.0)
    for axis, name, sign in ((0, gl.GL_S, 0.5), (1, gl.GL_T, -0.5)):
        plane = [0.0, 0.0, 0.0, -0.5]
        plane[axis] = sign * float(repeat[axis])
        gl.glTexGenfv(name, gl.GL_OBJECT_PLANE, plane)
        gl.glEnable((gl.GL_TEXTURE_GEN_S, gl.GL_TEXTURE_GEN_T)[axis])
    return (gl.GL_TEXTURE_2D, gl.GL_TEXTURE_GEN_S, gl.GL_TEXTURE_GEN_T)
