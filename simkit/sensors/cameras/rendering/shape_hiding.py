"""Hide shapes of a composition for one view: out of sight, transparent, or in plain colours."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence

import mujoco
import numpy as np

from simkit.pose import Vector
from simkit.sensors.cameras.rendering.scene_composition import Composition
from simkit.sensors.cameras.rendering.transparency import DRAWN_HERE
from simkit.sensors.cameras.rendering.view import View

_FLAGS = mujoco.mjtRndFlag
_NOTHING = int(mujoco.mjtGeom.mjGEOM_NONE)


def shapes_out_of_sight(composition: Composition, eye: Vector, rotation: Vector, view: View) -> list[int]:
    """Places of what need not be drawn for a view: what lies outside it, and planes seen from behind."""
    bounds = composition.bounds
    outside = [] if bounds is None else bounds.outside(eye, rotation, view)
    return [*outside, *(i for i in _from_behind(composition, eye) if i not in outside)]


def _from_behind(composition: Composition, eye: Vector) -> list[int]:
    """Places of planes that are seen from behind, where they have nothing to be seen."""
    geoms, found = composition.scene.geoms, []
    for place in composition.planes:
        plane = geoms[place]
        if (eye - plane.pos) @ np.asarray(plane.mat).reshape(3, 3)[:, 2] < 0.0:
            found.append(place)
    return found


def transparent_shapes(composition: Composition) -> list[int]:
    """Places of what can be seen through and is drawn last; it has no depth."""
    geoms = composition.scene.geoms
    return [i for i in composition.glassy if int(geoms[i].type) in DRAWN_HERE]


@contextlib.contextmanager
def draw_plain_colours(scene: mujoco.MjvScene) -> Iterator[None]:
    """While it lasts, shapes are drawn in plain colours, without light and shadow."""
    kept = scene.flags.copy()
    scene.flags[_FLAGS.mjRND_SHADOW] = 0
    scene.flags[_FLAGS.mjRND_SEGMENT] = scene.flags[_FLAGS.mjRND_IDCOLOR] = 1
    try:
        yield
    finally:
        scene.flags[:] = kept


@contextlib.contextmanager
def hide_shapes(scene: mujoco.MjvScene, places: Sequence[int]) -> Iterator[None]:
    """While it lasts, these shapes of the list are not drawn."""
    geoms = scene.geoms if places else ()
    kinds = [geoms[i].type for i in places]
    for i in places:
        geoms[i].type = _NOTHING
    try:
        yield
    finally:
        for i, kind in zip(places, kinds, strict=True):
            geoms[i].type = kind


@contextlib.contextmanager
def make_transparent(scene: mujoco.MjvScene, places: Sequence[int]) -> Iterator[None]:
    """While it lasts, these shapes of the list can be seen through altogether."""
    geoms = scene.geoms if places else ()
    opacities = [float(geoms[i].rgba[3]) for i in places]
    for i in places:
        geoms[i].rgba[3] = 0.0
    try:
        yield
    finally:
        for i, opacity in zip(places, opacities, strict=True):
            geoms[i].rgba[3] = opacity
