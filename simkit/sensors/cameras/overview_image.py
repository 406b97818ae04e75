"""Image of a simulation from outside, without a camera sensor."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from typing import Final, Protocol, runtime_checkable

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.geom_groups import COLLISION_CONTACT, VISUAL
from simkit.compiler.name_map import LinkBinding
from simkit.elementary_functions import tan
from simkit.linear_algebra import norm
from simkit.pose import Vector
from simkit.runtime import Simulation
from simkit.runtime.particle_clouds import has_sources
from simkit.sensors.cameras.renderer_choice import ImageRenderer, renderer_of
from simkit.sensors.cameras.rendering import render_thread
from simkit.sensors.cameras.rendering.lights_and_shadows import Sphere, suns_of
from simkit.sensors.cameras.rendering.scene_composition import Composition
from simkit.sensors.cameras.rendering.view import Colours, Depths, DrawnView, Shot, View, look_at
from simkit.sensors.particle_echoes import drawer_of_particles
from simkit.sensors.values_with_expiry import temporary_values

Distances = npt.NDArray[np.float32]
_R2: Final = np.array((0.7548776662466927, 0.5698402909980532))  # steps of a sequence that fills a square evenly
_STRAIGHT: Final = 0.01  # sine of the angle to the vertical of a view from straight above
_GOLDEN_ANGLE: Final = 2.399963229728653  # [rad] steps of a spiral that fills a disc evenly
_SUN_RADIUS: Final = 0.035  # [rad] of the disc of lights: half a shade of 7 cm behind an edge 1 m away
_DARKEST: Final = 0.12
"""Least brightest channel of a drawn colour. Images are not encoded in sRGB, like those of Gazebo Classic. Images of gz
Sim are encoded: Create 3 has the colour 3/255 and is dark grey there. Without this limit, a black model would be a
silhouette without edges. Cameras show the colours as they are."""


@runtime_checkable
class PictureShapes(Protocol):
    """Plugin that adds shapes to pictures, such as the surface of a sea."""

    def draw_shapes(self, scene: mujoco.MjvScene, eye: Vector) -> None:
        """Add shapes to a scene that is seen from `eye` [m]."""


@runtime_checkable
class SoftPictureRenderer(Protocol):
    """Renderer that draws soft shadows and smooth edges in one image, which is faster than several passes."""

    def draw_soft(self, composition: Composition, shot: Shot, directions: Sequence[Sequence[Vector]]) -> DrawnView:
        """Draw an image with the directional lights in several directions."""


def render_view(
    sim: Simulation,
    width: int,
    height: int,
    *,
    eye: Vector | None = None,
    target: Vector | None = None,
    vertical_fov: float = 0.8,
    decorate: Callable[[mujoco.MjvScene], None] | None = None,
    quality: str = "",
    passes: int = 1,
    lit: Sphere | None = None,
    distances: Distances | None = None,
    ceiling: float = math.inf,
) -> Colours:
    """Draw an image of the simulation in its current state.

    Several passes give soft shadows and smooth edges: each pass moves the image by a part of a pixel, and the
    directional lights within a small disc. The result is the mean of all passes.

    Args:
        sim: simulation to draw.
        width: width of the image [px].
        height: height of the image [px].
        eye: position of the camera in the world [m]; by default to the side and above, so that everything is visible.
        target: point in the middle of the image [m]; by default the middle of the scene.
        vertical_fov: opening angle [rad].
        decorate: function that is called with the `MjvScene`, to add geoms.
        quality: fast, gazebo or high; empty for the quality of the world, with the renderer of the cameras.
        passes: number of passes.
        lit: sphere that shadows of directional lights cover; by default as for a camera.
        distances: array that receives the distances along the line of sight [m], shape (height, width); infinite where
            nothing is drawn.
        ceiling: height above which static shapes are not drawn [m]. In a view from straight above, shapes that are only
            partly above it are cut at this height.

    Returns:
        Colours, rows from the top, shape (height, width, 3).

    Raises:
        RenderError: there is no renderer.
    """
    model = sim.mj_model
    extent = float(model.stat.extent)
    middle = np.array(model.stat.center if target is None else target, dtype=np.float64)
    position = middle + extent * np.array((-1.1, -1.4, 1.1)) if eye is None else np.asarray(eye, dtype=np.float64)
    half = tan(vertical_fov / 2)
    wide = half * width / height
    distance = max(norm(middle - position), 1e-6)
    near = min(0.01 * extent, 0.1 * distance)
    if math.hypot(*(middle - position)[:2]) < _STRAIGHT * distance and position[2] > ceiling:
        near = max(near, float(position[2]) - ceiling)
    view = View(width, height, -wide, wide, -half, half, near, distance + 50.0 * extent)
    is_dark = model.nlight == 0
    drawing_plugins = [p for p in sim.engine.structure.all_plugins() if isinstance(p, PictureShapes)]
    draw_particles = drawer_of_particles(sim, sim.time) if has_sources(sim) else None

    def prepare(scene: mujoco.MjvScene) -> None:
        if is_dark:
            _add_headlight(scene)
        for plugin in drawing_plugins:
            plugin.draw_shapes(scene, position)
        if draw_particles is not None:
            draw_particles(scene)
        if decorate is not None:
            decorate(scene)

    renderer = renderer_of(sim, quality)
    data = sim.engine.physics.fresh()
    above = _static_above(sim, ceiling)
    with (
        temporary_values(model.geom_group, _collisions_to_draw(sim), VISUAL),
        temporary_values(model.geom_group, above, COLLISION_CONTACT),
        _visible_colours(model),
    ):
        composition = renderer.composer.compose(
            model, data, position, look_at(position, middle), prepare, smooth=passes == 1
        )
    composition.lit = lit
    render_thread.drain()  # the render thread uses the same buffers
    depth = distances is not None
    if passes > 1 and isinstance(renderer, SoftPictureRenderer):
        drawn = renderer.draw_soft(composition, Shot(view, depth=depth), list(_sun_directions(composition, passes)))
        assert drawn.colours is not None
        mean, nearest = drawn.colours, drawn.depths
    else:
        mean, nearest = _mean_of_passes(renderer, composition, view, passes, depth)
    renderer.composer.give_back(composition)
    if distances is not None and nearest is not None:
        near, far = view.near, view.far
        distances[:] = np.where(nearest > 0.0, near * far / (near + nearest * (far - near)), np.inf)
    return mean


def _mean_of_passes(
    renderer: ImageRenderer, composition: Composition, view: View, passes: int, depth: bool
) -> tuple[Colours, Depths | None]:
    """Return the mean colours of passes, and the nearest raw depths if `depth` is True."""
    total = np.zeros((view.height, view.width, 3), np.float32)
    nearest = np.zeros((view.height, view.width), np.float32) if depth else None
    for shifted in _passes(composition, view, passes):
        drawn = renderer.draw(composition, Shot(shifted, depth=depth))
        assert drawn.colours is not None
        total += drawn.colours
        if nearest is not None and drawn.depths is not None:
            np.maximum(nearest, drawn.depths, out=nearest)
    return np.rint(total / passes).astype(np.uint8), nearest


def _passes(composition: Composition, view: View, count: int) -> Iterator[View]:
    """Yield the view of each pass, with the directional lights moved within a disc; restore them at the end."""
    for number, _ in enumerate(_sun_directions(composition, count)):
        across, up = (_R2 * number + 0.5) % 1.0 - 0.5 if count > 1 else (0.0, 0.0)
        x, y = across * (view.right - view.left) / view.width, up * (view.top - view.bottom) / view.height
        yield replace(view, left=view.left + x, right=view.right + x, bottom=view.bottom + y, top=view.top + y)


def _sun_directions(composition: Composition, count: int) -> Iterator[list[Vector]]:
    """Move the directional lights within a disc for each pass, and yield their directions; restore them at the end.

    The directions begin in the middle of the disc and end at its edge.
    """
    suns = suns_of(composition.scene)
    directions = [np.array(light.dir, dtype=np.float64) for light in suns]
    for number in range(count):
        turn, radius = _GOLDEN_ANGLE * number, _SUN_RADIUS * math.sqrt(number / count)
        moved = []
        for light, direction in zip(suns, directions, strict=True):
            axes = look_at(np.zeros(3), direction)
            light.dir = direction + radius * (math.cos(turn) * axes[:, 1] + math.sin(turn) * axes[:, 2])
            moved.append(np.array(light.dir, dtype=np.float64))
        yield moved
    for light, direction in zip(suns, directions, strict=True):
        light.dir = direction


def _collisions_to_draw(sim: Simulation) -> list[int]:
    """Return the collision geoms that cameras do not see and that stand for visuals.

    These are the collisions of models without any visual, except static ones, and of links whose visuals are meshes
    that are missing.
    """
    by_model: dict[str, list[LinkBinding]] = {}
    for link in sim.engine.names.links.values():
        by_model.setdefault(link.model, []).append(link)
    invisible = {n for n, links in by_model.items() if not sim.models[n].static and not any(li.visuals for li in links)}
    shown = (li for n, links in by_model.items() for li in links if n in invisible or li.has_missing_visuals)
    return [geom for link in shown for geom in link.geoms]


def _static_above(sim: Simulation, ceiling: float) -> list[int]:
    """Return the static geoms that are wholly above a height [m], without planes."""
    if not math.isfinite(ceiling):
        return []
    model, data = sim.mj_model, sim.engine.physics.fresh()
    rows = data.geom_xmat.reshape(-1, 3, 3)[:, 2]  # the vertical axis in the frame of each geom
    lowest = data.geom_xpos[:, 2] + (rows * model.geom_aabb[:, :3] - np.abs(rows) * model.geom_aabb[:, 3:]).sum(axis=1)
    is_static = (model.body_weldid[model.geom_bodyid] == 0) & (model.geom_type != int(mujoco.mjtGeom.mjGEOM_PLANE))
    return np.flatnonzero(is_static & (lowest >= ceiling)).tolist()


@contextmanager
def _visible_colours(model: mujoco.MjModel) -> Iterator[None]:
    """Brighten nearly black surfaces that do not glow, inside the `with` block; their hue becomes greyer."""
    glow = np.append(model.mat_emission, 0.0) > 0.0  # a geom without a material has the index -1
    with ExitStack() as stack:
        for colours, glows in ((model.geom_rgba, glow[model.geom_matid]), (model.mat_rgba, glow[:-1])):
            lift = _DARKEST - colours[:, :3].max(axis=1)
            dark = np.flatnonzero((lift > 0.0) & ~glows)
            visible = colours[dark] + lift[dark, None] * (1.0, 1.0, 1.0, 0.0)
            stack.enter_context(temporary_values(colours, dark, visible))
        yield


def _add_headlight(scene: mujoco.MjvScene) -> None:
    """Add a headlight: a model without a world has no sun, and without light all its sides look the same."""
    for light in scene.lights[: scene.nlight]:
        if light.headlight and not light.diffuse.any():
            light.diffuse = (0.6, 0.6, 0.6)
