"""MuJoCo model in the memory of the graphics library."""

from __future__ import annotations

import mujoco

from simkit.sensors.cameras.rendering import gl_context
from simkit.sensors.cameras.rendering.render_quality import Quality


class GpuModel:
    """What the graphics library holds of the newest model: smooth, and sharp for what must not be blended.

    All methods but `reserve` need the context; a second of these is only made when it is asked for.
    """

    def __init__(self, quality: Quality) -> None:
        self._quality = quality
        self._model: mujoco.MjModel | None = None
        self._contexts: dict[bool, mujoco.MjrContext] = {}
        self._width = self._height = 16

    def reserve(self, width: int, height: int) -> None:
        """Makes room for pictures of this size [px]."""
        if width > self._width or height > self._height:
            self._width, self._height = max(width, self._width), max(height, self._height)
            if self._contexts:
                with gl_context.current():
                    for context in self._contexts.values():
                        mujoco.mjr_resizeOffscreen(self._width, self._height, context)

    def context_of(self, model: mujoco.MjModel, smooth: bool) -> mujoco.MjrContext:
        """The engine's handle of the model; uploads one that is not the last one."""
        if model is not self._model:
            self.free()
            self._model = model
        smooth = smooth and self._quality.samples > 0
        if smooth not in self._contexts:
            context = _upload(model, self._quality, smooth)
            mujoco.mjr_resizeOffscreen(self._width, self._height, context)
            self._contexts[smooth] = context
        return self._contexts[smooth]

    def contexts(self) -> list[mujoco.MjrContext]:
        """The engine's handles that are there; needs no context."""
        return list(self._contexts.values())

    def free(self) -> None:
        """Gives the memory back."""
        contexts, self._contexts, self._model = list(self._contexts.values()), {}, None
        for context in contexts:
            context.free()


def _upload(model: mujoco.MjModel, quality: Quality, smooth: bool) -> mujoco.MjrContext:
    own = model.vis.quality
    kept = own.offsamples, own.shadowsize, own.numslices, own.numstacks
    own.offsamples, own.shadowsize = quality.samples if smooth else 0, quality.shadow_map
    own.numslices, own.numstacks = max(kept[2], quality.slices), max(kept[3], quality.slices // 2)
    try:
        context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
    finally:
        own.offsamples, own.shadowsize, own.numslices, own.numstacks = kept
    context.readDepthMap = mujoco.mjtDepthMap.mjDEPTH_ZEROFAR
    context.shadowScale = 1.0  # the whole cone of a spot
    return context
