"""Reader of the lights of a compiled file."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Final

from simkit.loaders.mjcf.compiled_file import CompiledFile
from simkit.pose import Pose
from simkit.scene import SceneLight
from simkit.scene.geometry import vec3
from simkit.scene.mjcf_source import MjcfElements

_TYPES: Final = {0: "spot", 1: "directional"}


def read_lights(file: CompiledFile, body: int, link: str, pose: Pose, elements: MjcfElements) -> tuple[SceneLight, ...]:
    """Return the lights of a body.

    Args:
        file: the compiled file.
        body: id of the body.
        link: scoped name of its link; empty for the lights of the world.
        pose: pose of the body in the world.
        elements: receives the names of the lights.
    """
    return tuple(_light(file, i, link, pose, elements) for i in file.lights_of.get(body, ()))


def _light(file: CompiledFile, i: int, link: str, body: Pose, elements: MjcfElements) -> SceneLight:
    model, name = file.model, file.name("LIGHT", i)
    pose = body @ Pose(model.light_pos[i])
    direction = vec3(model.light_dir[i])
    scoped = f"{link}::{name}" if link else name
    elements.lights[scoped] = (name, link)
    constant, linear, quadratic = (float(v) for v in model.light_attenuation[i])
    return SceneLight(
        name=name,
        scoped=scoped,
        type=_TYPES.get(int(model.light_type[i]), "point"),
        pose_world=pose,
        direction=direction,
        direction_world=vec3(pose.rotate(direction)),
        link=link,
        diffuse=_colour(model.light_diffuse[i]),
        specular=_colour(model.light_specular[i]),
        attenuation=(float(model.light_range[i]), constant, linear, quadratic),
        spot=(0.0, 2.0 * math.radians(float(model.light_cutoff[i])), float(model.light_exponent[i])),
        cast_shadows=bool(model.light_castshadow[i]),
        on=bool(model.light_active[i]),
        where=file.where("light", name),
    )


def _colour(rgb: Iterable[float]) -> tuple[float, float, float, float]:
    r, g, b = (float(c) for c in rgb)
    return r, g, b, 1.0
