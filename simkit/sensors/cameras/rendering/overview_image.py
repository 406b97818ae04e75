"""Image of a simulation from outside, without a camera sensor."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Final

import mujoco
import numpy as np

from simkit.compiler.geom_groups import VISUAL
from simkit.compiler.name_map import LinkBinding
from simkit.pose import Vector
from simkit.runtime import Simulation
from simkit.sensors.cameras.rendering import render_thread
from simkit.sensors.cameras.rendering.renderer import renderer_of
from simkit.sensors.cameras.rendering.view import Colours, Shot, View, look_at
from simkit.sensors.values_with_expiry import temporary_values

_DARKEST: Final = 0.12
"""Least brightest channel of a drawn colour. Images are not encoded in sRGB, like those of Gazebo Classic. Images of gz
Sim are encoded: Create 3 has the colour 3/255 and is dark grey there. Without this limit, a black model would be a
silhouette without edges. Cameras show the colours as they are."""


def render_view(
    sim: Simulation,
    width: int,
    height: int,
    *,
    eye: Vector | None = None,
    target: Vector | None = None,
    vertical_fov: float = 0.8,
    decorate: Callable[[mujoco.MjvScene], None] | None = None,
) -> Colours:
    """Draw an image of the simulation in its current state.

    Args:
        sim: simulation to draw.
        width: width of the image [px].
        height: height of the image [px].
        eye: position of the camera in the world [m]; by default to the side and above, so that everything is visible.
        target: point in the middle of the image [m]; by default the middle of the scene.
        vertical_fov: opening angle [rad].
        decorate: function that is called with the `MjvScene`, to add geoms.

    Returns:
        Colours, rows from the top, shape (height, width, 3).

    Raises:
        RenderError: there is no renderer.
    """
    model = sim.mj_model
    extent = float(model.stat.extent)
    middle = np.array(model.stat.center if target is None else target, dtype=np.float64)
    position = middle + extent * np.array((-1.1, -1.4, 1.1)) if eye is None else np.asarray(eye, dtype=np.float64)
    half = np.tan(vertical_fov / 2)
    wide = half * width / height
    distance = max(float(np.linalg.norm(middle - position)), 1e-6)
    view = View(width, height, -wide, wide, -half, half, min(0.01 * extent, 0.1 * distance), distance + 50.0 * extent)
    is_dark = model.nlight == 0

    def prepare(scene: mujoco.MjvScene) -> None:
        if is_dark:
            _add_headlight(scene)
        if decorate is not None:
            decorate(scene)

    renderer = renderer_of(sim)
    data = sim.engine.physics.fresh()
    with temporary_values(model.geom_group, _collisions_to_draw(sim), VISUAL), _visible_colours(model):
        composition = renderer.composer.compose(model, data, position, look_at(position, middle), prepare)
    render_thread.drain()  # the render thread uses the same buffers
    colours = renderer.draw(composition, Shot(view)).colours
    renderer.composer.give_back(composition)
    assert colours is not None
    return colours.copy()


def _collisions_to_draw(sim: Simulation) -> list[int]:
    """Return the collision geoms of models without any visual, which cameras do not see; static ones are left out."""
    by_model: dict[str, list[LinkBinding]] = {}
    for link in sim.engine.names.links.values():
        by_model.setdefault(link.model, []).append(link)
    invisible = (n for n, links in by_model.items() if not sim.models[n].static and not any(li.visuals for li in links))
    return [geom for name in invisible for link in by_model[name] for geom in link.geoms]


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
