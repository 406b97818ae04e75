"""Renderer that a caller of `simkit.load` requests, which has priority over the renderer of the file."""

from __future__ import annotations

from dataclasses import replace

from simkit.run_spec import RendererName
from simkit.scene import SceneWorld


def with_renderer(world: SceneWorld, name: RendererName | None) -> SceneWorld:
    """Return a world with the requested renderer; None keeps the renderer of the file.

    Raises:
        RenderError: SK-RENDER-001 OpenGL is requested and cannot be opened. A file that requests OpenGL raises this
            error only when an image is read, because a run without images does not need it.
    """
    if name is None:
        return world
    if name == "gl":
        from simkit.sensors.cameras.rendering.gl_context import ensure_open

        ensure_open()
    return replace(world, renderer=name)
