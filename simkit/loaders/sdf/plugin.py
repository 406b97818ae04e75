"""Reader of `<plugin>`: name, file name and the block of parameters."""

from __future__ import annotations

from collections.abc import Sequence

from simkit.params import Params
from simkit.scene import ScenePlugin

PARTICLE_EMITTER = "simkit-particle-emitter"
"""Library name of the plugin that simulates a `<particle_emitter>`."""


def read_plugins(elements: Sequence[Params], scoped: str) -> tuple[ScenePlugin, ...]:
    """Return the plugins in document order; a plugin without a file name is an error."""
    plugins = []
    for element in elements:
        filename = element.attribute("filename").strip()
        if not filename:
            element.error("SK-SDF-026", f"<plugin name={element.attribute('name')!r}> needs filename=")
            continue
        plugins.append(ScenePlugin(element.attribute("name"), filename, scoped, element, element.where))
    return tuple(plugins)


def read_particle_emitters(elements: Sequence[Params], scoped: str) -> tuple[ScenePlugin, ...]:
    """Return the plugin of each `<particle_emitter>`, whose parameters are those of the emitter."""
    names = (element.attribute("name") or "emitter" for element in elements)
    return tuple(
        ScenePlugin(name, PARTICLE_EMITTER, scoped, element, element.where)
        for name, element in zip(names, elements, strict=True)
    )
