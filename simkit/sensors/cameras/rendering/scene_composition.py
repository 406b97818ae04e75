"""Scene of one physics state, composed by MuJoCo without OpenGL, so that another thread can draw it later."""

from __future__ import annotations

import threading
from bisect import bisect_left
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from typing import Final

import mujoco
import numpy as np

from simkit.compiler.geom_groups import DRAWN_COLLISION, VISUAL
from simkit.linear_algebra import matmul
from simkit.pose import Vector
from simkit.sensors.cameras.rendering.lights_and_shadows import Sphere, convert_point_lights, keep_strongest_lights
from simkit.sensors.cameras.rendering.transparency import DRAWN_HERE
from simkit.sensors.cameras.rendering.view import Shot, View
from simkit.sensors.cameras.rendering.view_culling import Bounds, bounds_of
from simkit.sensors.values_with_expiry import temporary_values

SOLID: Final = 0.995
"""Opacity below which the engine draws a shape as transparent."""

_ALL: Final = int(mujoco.mjtCatBit.mjCAT_ALL)
_MAX_SCENES: Final = 8  # number of scenes kept for reuse
_SPARE: Final = 16  # number of shapes that a list can contain besides the model's
_DECORATIONS: Final = 10_000
_NOWHERE: Final = 0  # a group that is never drawn
_GEOM: Final = int(mujoco.mjtObj.mjOBJ_GEOM)
_PLANE: Final = int(mujoco.mjtGeom.mjGEOM_PLANE)  # an int: an enum compares 100 times as slowly
_POINT: Final = int(mujoco.mjtLightType.mjLIGHT_POINT)


class Composition:
    """Scene of one state of a simulation: the engine's list of shapes and lights, and the sensor's pose.

    Attributes:
        position: position of the sensor in the world [m], shape (3,).
        rotation: rotation matrix of the sensor's frame (x forward, y left, z up), shape (3, 3).
        smooth: True draws smooth edges if the quality has several samples per pixel.
        glassy: indices of transparent shapes in the list.
        lit: sphere that shadows of directional lights cover; None for the scene or the part ahead of the camera.
        planes: indices of planes in the list, which are invisible from behind.
        bounds: bounds of the shapes; None if they are unknown, or if invisible shapes cast shadows.
    """

    __slots__ = ("bounds", "glassy", "is_spare", "lit", "model", "planes", "position", "rotation", "scene", "smooth")

    def __init__(self, model: mujoco.MjModel, scene: mujoco.MjvScene, position: Vector, rotation: Vector) -> None:
        self.model, self.scene, self.position, self.rotation = model, scene, position, rotation
        self.smooth = self.is_spare = True
        self.bounds: Bounds | None = None
        self.glassy: list[int] = []
        self.lit: Sphere | None = None
        self.planes: list[int] = []

    def pose_of(self, shot: Shot) -> tuple[Vector, Vector]:
        """Return the position (3,) [m] and rotation (3, 3) of a shot in the world."""
        position = self.position if shot.position is None else self.position + matmul(self.rotation, shot.position)
        return position, self.rotation if shot.rotation is None else matmul(self.rotation, shot.rotation)


class Composer:
    """Maker of compositions from reused lists of shapes. The class is thread-safe."""

    def __init__(self, flags: Sequence[mujoco.mjtRndFlag]) -> None:
        self._flags = [int(flag) for flag in flags]
        self._culls = mujoco.mjtRndFlag.mjRND_SHADOW not in flags
        self._option = visuals_only_options()
        self._aside = mujoco.MjvCamera()
        self._lock = threading.Lock()
        self._scenes: list[mujoco.MjvScene] = []
        self._scenes_model: mujoco.MjModel | None = None

    def compose(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        position: Vector,
        rotation: Vector,
        decorate: Callable[[mujoco.MjvScene], None] | None = None,
        *,
        unseen: Sequence[int] = (),
        smooth: bool = True,
    ) -> Composition:
        """Compose the scene of a state without OpenGL; the result does not depend on `data`.

        Args:
            model: compiled model.
            data: data of the model, up to date.
            position: position of the sensor in the world [m], shape (3,).
            rotation: rotation matrix of the sensor's frame (x forward, y left, z up), shape (3, 3).
            decorate: function that is called with the `MjvScene`, to add geoms.
            unseen: ids of geoms that are not drawn.
            smooth: True draws smooth edges if the quality has several samples per pixel.
        """
        scene = self._spare_scene(model) if decorate is None else self._fresh_scene(model, _DECORATIONS)
        hidden = temporary_values(model.geom_group, unseen, _NOWHERE)
        with keep_strongest_lights(model, data, position, rotation), hidden:
            mujoco.mjv_updateScene(model, data, self._option, None, self._aside, _ALL, scene)
            bounds = bounds_of(model, data, scene, self._option.geomgroup) if self._culls else None
        if _POINT in model.light_type:
            convert_point_lights(scene)
        if decorate is not None:
            decorate(scene)
        composition = Composition(
            model, scene, np.array(position, dtype=np.float64), np.array(rotation, dtype=np.float64)
        )
        composition.smooth, composition.is_spare, composition.bounds = smooth, decorate is None, bounds
        if decorate is not None or _has_transparent_geoms(model):
            composition.glassy = [i for i, g in enumerate(scene.geoms[: scene.ngeom]) if g.rgba[3] < SOLID]
        for geom in np.flatnonzero(model.geom_type == _PLANE):
            composition.planes += _scene_index(scene, int(geom))
        return composition

    def give_back(self, composition: Composition) -> None:
        """Return a composition that will not be drawn again, so that its list is reused."""
        with self._lock:
            if (
                composition.is_spare
                and composition.model is self._scenes_model
                and len(self._scenes) < _MAX_SCENES
                and all(composition.scene is not scene for scene in self._scenes)
            ):
                self._scenes.append(composition.scene)

    def _spare_scene(self, model: mujoco.MjModel) -> mujoco.MjvScene:
        """Return a list of shapes to be filled."""
        with self._lock:
            if model is not self._scenes_model:
                self._scenes, self._scenes_model = [], model
            if self._scenes:
                return self._scenes.pop()
        return self._fresh_scene(model, _SPARE)

    def _fresh_scene(self, model: mujoco.MjModel, more: int) -> mujoco.MjvScene:
        scene = mujoco.MjvScene(model, model.ngeom + model.nflex + model.nskin + more)
        scene.flags[:] = 0
        scene.flags[self._flags] = 1
        return scene


def _has_transparent_geoms(model: mujoco.MjModel) -> bool:
    return bool((model.geom_rgba[:, 3] < SOLID).any() or (model.mat_rgba[:, 3] < SOLID).any())


def _scene_index(scene: mujoco.MjvScene, geom: int) -> list[int]:
    """Return the index of a geom in the scene's list, as a list that is empty if the scene does not contain the geom.

    The search is binary, because geoms are at the beginning of the scene's list in the order of their ids.
    """
    geoms = scene.geoms
    index = bisect_left(range(min(geom, scene.ngeom)), geom, key=lambda i: geoms[i].objid)
    is_listed = index < scene.ngeom and geoms[index].objid == geom and geoms[index].objtype == _GEOM
    return [index] if is_listed else []


def visuals_only_options() -> mujoco.MjvOption:
    """Return the engine's options that draw only the visuals that cameras see, without decorations."""
    option = mujoco.MjvOption()
    option.flags[:] = 0
    flags = mujoco.mjtVisFlag
    shown = flags.mjVIS_TEXTURE, flags.mjVIS_STATIC, flags.mjVIS_SKIN, flags.mjVIS_FLEXEDGE, flags.mjVIS_FLEXSKIN
    option.flags[list(map(int, shown))] = 1
    for groups in (option.geomgroup, option.sitegroup, option.jointgroup, option.tendongroup, option.actuatorgroup):
        groups[:] = 0
    for groups in (option.flexgroup, option.skingroup):  # MJCF's default groups, because only MJCF has flexes and skins
        groups[:] = 0
        groups[:3] = 1
    option.geomgroup[[DRAWN_COLLISION, VISUAL]] = 1
    return option


_FLAGS = mujoco.mjtRndFlag
_NOTHING = int(mujoco.mjtGeom.mjGEOM_NONE)


def shapes_out_of_sight(composition: Composition, eye: Vector, rotation: Vector, view: View) -> list[int]:
    """Return the indices of shapes that a view need not draw: those outside it, and planes seen from behind."""
    bounds = composition.bounds
    outside = [] if bounds is None else bounds.outside(eye, rotation, view)
    return [*outside, *(i for i in _from_behind(composition, eye) if i not in outside)]


def _from_behind(composition: Composition, eye: Vector) -> list[int]:
    """Return the indices of planes seen from behind, where they are invisible."""
    geoms, indices = composition.scene.geoms, []
    for index in composition.planes:
        plane = geoms[index]
        if matmul(eye - plane.pos, np.asarray(plane.mat).reshape(3, 3)[:, 2]) < 0.0:
            indices.append(index)
    return indices


def transparent_shapes(composition: Composition) -> list[int]:
    """Return the indices of transparent shapes, which are drawn last and without depth."""
    geoms = composition.scene.geoms
    return [i for i in composition.glassy if int(geoms[i].type) in DRAWN_HERE]


def draw_plain_colours(scene: mujoco.MjvScene) -> AbstractContextManager[None]:
    """Draw shapes in plain colours, without light and shadow, inside the `with` block."""
    return temporary_values(scene.flags, (_FLAGS.mjRND_SHADOW, _FLAGS.mjRND_SEGMENT, _FLAGS.mjRND_IDCOLOR), (0, 1, 1))


@contextmanager
def hide_shapes(scene: mujoco.MjvScene, indices: Sequence[int]) -> Iterator[None]:
    """Exclude shapes of the list from drawing, inside the `with` block."""
    geoms = scene.geoms if indices else ()
    kinds = [geoms[i].type for i in indices]
    for i in indices:
        geoms[i].type = _NOTHING
    try:
        yield
    finally:
        for i, kind in zip(indices, kinds, strict=True):
            geoms[i].type = kind


@contextmanager
def make_transparent(scene: mujoco.MjvScene, indices: Sequence[int]) -> Iterator[None]:
    """Make shapes of the list fully transparent, inside the `with` block."""
    geoms = scene.geoms if indices else ()
    opacities = [float(geoms[i].rgba[3]) for i in indices]
    for i in indices:
        geoms[i].rgba[3] = 0.0
    try:
        yield
    finally:
        for i, opacity in zip(indices, opacities, strict=True):
            geoms[i].rgba[3] = opacity
