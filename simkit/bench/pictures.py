"""Pictures by hand: the engine's own passes, and the tightest code that makes the same readings of them."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import Any

import mujoco
import numpy as np

from simkit.sensors.rendered import RenderedSensor
from simkit.sensors.rendering import gl, thread
from simkit.sensors.rendering.composition import visuals_only
from simkit.sensors.rendering.renderer import renderer_of
from simkit.sensors.rendering.view import aim

_ALL = int(mujoco.mjtCatBit.mjCAT_ALL)
_SPARE = 16


class BarePass:
    """One picture of the engine's own: drawn, colour and depth read as the driver gives them.

    That is bottom row first, black where there is nothing, depth not in metres. Model and context are of its own, with
    the simulation's multisampling and shadow maps.

    Args:
        sim: the simulation.
        sensor: a camera that one picture is drawn for; its view and pose are taken.
        model, data: to be drawn; the simulation's by default.
    """

    def __init__(self, sim: Any, sensor: RenderedSensor, model: Any = None, data: Any = None) -> None:
        thread.drain()
        self.model = sim.mj_model if model is None else model
        self.data = sim.fresh_data() if data is None else data
        self.sensor = sensor
        (shot,) = sensor.shots()
        self.view, self._has_depth = shot.view, shot.depth
        size = self.view.height, self.view.width
        self.colours = np.empty((*size, 3), np.uint8)
        self.depths = np.empty(size, np.float32)
        self._rectangle = mujoco.MjrRect(0, 0, self.view.width, self.view.height)
        self._option, self._aside = visuals_only(), mujoco.MjvCamera()
        self._scene = mujoco.MjvScene(self.model, self.model.ngeom + _SPARE)
        composition = renderer_of(sim).compose(self.model, self.data, *sensor._frame_in_world(self.data))
        self._scene.flags[:] = composition.scene.flags
        with self.current():
            self._context = _upload(self.model, renderer_of(sim))
            mujoco.mjr_resizeOffscreen(self.view.width, self.view.height, self._context)

    @contextlib.contextmanager
    def current(self) -> Iterator[None]:
        """While it lasts, `draw` may be called."""
        with gl.current():
            yield

    def draw(self) -> None:
        """The picture of `data` as they are now."""
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)
        mujoco.mjv_updateScene(self.model, self.data, self._option, None, self._aside, _ALL, self._scene)
        aim(self._scene, *self.sensor._frame_in_world(self.data), self.view)
        mujoco.mjr_render(self._rectangle, self._scene, self._context)
        depths = self.depths if self._has_depth else None
        mujoco.mjr_readPixels(self.colours, depths, self._rectangle, self._context)

    def draw_many(self, count: int) -> None:
        """So many pictures, in one go."""
        with self.current():
            for _ in range(count):
                self.draw()

    def reading(self, random: np.random.Generator) -> Callable[[], Any]:
        """What takes a whole reading: drawn, the right way up, depths in metres, noise added; arrays of its own."""
        view, noise = self.view, self.sensor.options.noise
        slope = np.float32(view.near * view.far / (view.far - view.near))
        offset = np.float32(view.near / (view.far - view.near))
        far = np.float32(self.sensor.options.depth_far)
        spread, shape = np.float32(noise.stddev), self.depths.shape

        def read() -> Any:
            with self.current():
                self.draw()
            colours = self.colours[::-1]
            if noise.stddev:
                added = random.standard_normal(shape, np.float32) * (spread * 255)
                colours = np.clip(colours + added[..., None], 0, 255).astype(np.uint8)
            else:
                colours = colours.copy()
            if not self._has_depth:
                return colours
            depths = self.depths[::-1] + offset
            np.divide(slope, depths, out=depths)
            if noise.stddev:
                depths += random.standard_normal(shape, np.float32) * spread
            depths[depths > far] = np.inf
            return colours, depths

        return read

    def free(self) -> None:
        """Gives the graphics memory back."""
        with self.current():
            self._context.free()


def _upload(model: Any, renderer: Any) -> Any:
    """The engine's context with as many samples and as large a shadow map as the simulation's cameras have."""
    own, wanted = model.vis.quality, renderer._appearance.quality
    kept = own.offsamples, own.shadowsize
    own.offsamples, own.shadowsize = wanted.samples, wanted.shadow_map
    try:
        context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
    finally:
        own.offsamples, own.shadowsize = kept
    context.readDepthMap = mujoco.mjtDepthMap.mjDEPTH_ZEROFAR
    return context
